//! What bounds a design's speed: the slowest paths by the registers that they begin and end at, before it is placed
//! (every connection takes the same), or placed and routed.
//!
//! ```sh
//! cargo run --release -p bitstream --example slowest -- netlist.json design.ucf TOP [PS | SEED route]
//! ```

use bitstream::device::Device;
use bitstream::flow::Progress;
use bitstream::flow::constraints::Constraints;
use bitstream::flow::logic::Logic;
use bitstream::flow::netlist::Netlist;
use bitstream::flow::nets::Nets;
use bitstream::flow::pack::Packed;
use bitstream::flow::place::{Design, Placement};
use bitstream::flow::reach::Reach;
use bitstream::flow::route::Routing;
use bitstream::flow::timing::{Graph, Report, TimedPath};
use std::collections::BTreeMap;

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let read = |at: usize| std::fs::read_to_string(&arguments[at]).expect("a file");
    let (json, ucf) = (read(0), read(1));
    let number = |at: usize| arguments.get(at).map_or(1_500, |text| text.parse().expect("a number"));
    let constraints = Constraints::parse(&ucf).expect("constraints");
    let netlist = Netlist::from_yosys(&json, &arguments[2]).expect("a netlist");
    let logic = Logic::of(netlist).expect("logic");
    let packed = Packed::of(&logic).expect("slices");
    let nets = Nets::of(&logic, &packed);
    let graph = Graph::of(&logic, &packed, &nets, &constraints);
    println!("{} slices", packed.slices().count());
    let wires = if arguments.len() > 4 {
        let design = Design { logic: &logic, packed: &packed, nets: &nets, graph: &graph, constraints: &constraints };
        let mut line = |_: bitstream::flow::Stage, _: u32, text: &str| eprintln!("{text}");
        let mut progress = Progress::new(&mut line);
        let device = Device::xc2s200();
        let placement = Placement::of(device, &design, number(3).into(), &mut progress).expect("a placement");
        let estimate = Report::of(&graph, &placement.estimate(&nets, &Reach::of(device)));
        // Pads are due by an offset, so that the least slack is seldom of the slowest path between registers.
        let tell = |when: &str, report: &Report| {
            for domain in &report.domains {
                let inside = domain.inside.as_ref().map_or(0, |path| path.delay);
                let slack = domain.worst.first().map_or(0, TimedPath::slack);
                println!("{when}, {}: {inside} ps between registers, least slack {slack} ps", domain.port);
            }
        };
        tell("placed", &estimate);
        let routed = Routing::of(device, &design, &placement, &mut progress).expect("a routing").delays;
        tell("routed", &Report::of(&graph, &routed));
        routed
    } else {
        vec![number(3); graph.connections()]
    };
    let name = |path: &TimedPath, last: bool| {
        let nets: Vec<&str> =
            path.steps.iter().filter_map(|step| step.net.map(|net| logic.nets[net.index()].as_str())).collect();
        let text = if last { nets.last() } else { nets.first() };
        text.map_or("?", |text| text.split('[').next().unwrap_or(text)).to_owned()
    };
    for domain in &Report::with_paths(&graph, &wires, usize::MAX).domains {
        let mut groups: BTreeMap<(String, String), (u32, usize, &TimedPath)> = BTreeMap::new();
        for path in &domain.worst {
            let entry = groups.entry((name(path, false), name(path, true))).or_insert((path.delay, 0, path));
            entry.1 += 1;
        }
        let mut sorted: Vec<_> = groups.into_iter().collect();
        sorted.sort_by_key(|(_, (delay, ..))| std::cmp::Reverse(*delay));
        let slow = domain.worst.iter().filter(|path| path.delay * 10 > domain.period * 6).count();
        println!("{}: {slow} ends above 60 %", domain.port);
        for ((from, to), (delay, ends, path)) in sorted.into_iter().take(40) {
            let wires: u32 = path.steps.iter().map(|step| step.wire).sum();
            println!("{delay:6} {wires:6} {ends:4} {:3} {from} -> {to}", path.steps.len());
        }
        for path in domain.worst.iter().take(2) {
            for step in &path.steps {
                let net = step.net.map_or("(carry)", |net| &logic.nets[net.index()]);
                println!("    {:6} +{:5} {net}", step.driven, step.wire);
            }
        }
    }
}
