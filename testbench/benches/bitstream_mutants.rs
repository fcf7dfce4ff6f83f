//! Flips seeded configuration bits of used tiles of the committed bitstream and says what notices each: the decoder,
//! the proof against the netlist of yosys, or nothing, because the circuit is proven to be the same.
//!
//! ```sh
//! cargo bench -p testbench --bench bitstream_mutants -- [COUNT [SEED]]
//! ```

use bitstream::configuration::Configuration;
use bitstream::device::{Bit, Device};
use bitstream::flow::Progress;
use bitstream::flow::netlist::Netlist as Gold;
use bitstream::flow::prove::prove;
use bitstream::netlist::extract;
use hdl::design::{COMMITTED_VERILOG, NAME};
use measured::Table;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use simulator::gateware;
use std::collections::BTreeMap;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use testbench::netlist::Netlist;

/// Bits that are flipped, one at a time.
const COUNT: u64 = 2_000;

fn main() {
    // Cargo gives benches `--bench`.
    let numbers: Vec<u64> = std::env::args().skip(1).filter_map(|text| text.parse().ok()).collect();
    let (count, seed) = (numbers.first().copied().unwrap_or(COUNT), numbers.get(1).copied().unwrap_or(1));
    let json = Netlist::of(COMMITTED_VERILOG, NAME).unwrap_or_else(|error| panic!("{error}")).json();
    let (built, _) = gateware::bitstream(&json, gateware::SEED, &mut Progress::silent()).expect("a design");
    assert!(built.proof.holds(), "the design itself is not proven");
    let (gold, constraints) =
        (Gold::from_yosys(&json, NAME).expect("a netlist"), gateware::constraints().expect("pins"));
    let device = Device::xc2s200();
    // Used tiles: those in which a bit differs from the blank device.
    let blank = Configuration::blank(device);
    let mut bits: Vec<(Bit, String)> = Vec::new();
    for (tile, _) in device.tiles() {
        let class = device.class(tile);
        let own =
            || class.attributes.iter().flat_map(|attribute| attribute.bits.iter().map(move |bit| (attribute, *bit)));
        if own().any(|(_, bit)| built.configuration.bit(device.bit(tile, bit)) != blank.bit(device.bit(tile, bit))) {
            bits.extend(own().map(|(attribute, bit)| (device.bit(tile, bit), attribute.name.clone())));
        }
    }
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let chosen: Vec<usize> = (0..count).map(|_| (random.next_u64() % bits.len() as u64) as usize).collect();
    let next = AtomicUsize::new(0);
    let table: Mutex<BTreeMap<String, [usize; 3]>> = Mutex::default();
    std::thread::scope(|scope| {
        for _ in 0..std::thread::available_parallelism().map_or(2, usize::from) {
            scope.spawn(|| {
                while let Some(at) = chosen.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let (bit, attribute) = &bits[*at];
                    let mut broken = built.configuration.clone();
                    broken.set_bit(*bit, !broken.bit(*bit));
                    let verdict = match extract(device, &broken) {
                        Err(_) => 0,
                        Ok(found) if !prove(device, &gold, &constraints, &built.drivers, &found).holds() => 1,
                        Ok(_) => 2,
                    };
                    let kind = attribute.split(['.', ':', '[']).next().unwrap_or("").to_owned();
                    table.lock().expect("no panic").entry(kind).or_default()[verdict] += 1;
                }
            });
        }
    });
    let table = table.into_inner().expect("no panic");
    let row = |kind: &str, counts: &[usize; 3]| {
        let sum: usize = counts.iter().sum();
        std::iter::once(kind.to_owned()).chain([sum, counts[0], counts[1], counts[2]].map(|n| n.to_string())).collect()
    };
    let mut rows: Vec<Vec<String>> = table.iter().map(|(kind, counts)| row(kind, counts)).collect();
    let all = table.values().fold([0; 3], |sum, counts| std::array::from_fn(|n| sum[n] + counts[n]));
    rows.push(row("all", &all));
    Table {
        name: "bitstream-mutants",
        title: &format!("{count} single bits of the {} in used tiles, flipped one at a time", bits.len()),
        command: "cargo bench -p testbench --bench bitstream_mutants",
        columns: &[
            "kind of attribute",
            "flipped",
            "noticed by the decoder",
            "by the proof",
            "proven to be the same circuit",
        ],
    }
    .write(&rows);
}
