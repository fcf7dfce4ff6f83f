//! The whole flow, from a netlist to a configuration and what is known of it: its time, and the proof that its
//! bits, decoded, are the netlist.

use super::constraints::Constraints;
use super::driver::Driver;
use super::logic::Logic;
use super::netlist::{Net, Netlist};
use super::nets::{Nets, Part};
use super::pack::Packed;
use super::place::{Design, MEMORY_SITES, Placement};
use super::prove::{Proof, prove};
use super::route::{Extremes, Routing, Terminals, check};
use super::timing::{Graph, Report};
use super::{FlowError, Progress, Stage, bits};
use crate::configuration::Configuration;
use crate::device::Device;

/// What a design takes of the device.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub struct Resources {
    /// Slices of 2,352.
    pub slices: usize,
    /// Tables of 4,704.
    pub tables: usize,
    /// Flip-flops of 4,704.
    pub flip_flops: usize,
    /// Bits of carry.
    pub carries: usize,
    /// Block memories of 14.
    pub memories: usize,
    /// Pads of 144.
    pub pads: usize,
    /// Nets through the interconnect.
    pub nets: usize,
    /// Wires that they take.
    pub wires: usize,
    /// Rounds of the router.
    pub rounds: usize,
}

/// A design as bits, and where its parts went.
#[derive(Clone, Debug)]
pub struct Built {
    /// All bits.
    pub configuration: Configuration,
    /// What it takes.
    pub resources: Resources,
    /// Pass gates in series and wires joined, at most.
    pub extremes: Extremes,
    /// The slowest paths of each clock under the model of wires.
    pub timing: Report,
    /// Where every net is driven.
    pub drivers: Vec<Driver>,
    /// Whether the decoded bits are the netlist.
    pub proof: Proof,
    /// What was mapped: tables, chains, flip-flops.
    pub logic: Logic,
    /// Its slices.
    pub packed: Packed,
    /// Which pins each net joins.
    pub nets: Nets,
    /// Where everything stands.
    pub placement: Placement,
}

/// Builds a design.
///
/// # Errors
/// See [`FlowError`].
pub fn build(
    json: &str,
    top: &str,
    constraints: &Constraints,
    seed: u64,
    progress: &mut Progress<'_>,
) -> Result<Built, FlowError> {
    progress.tell(Stage::Pack, 0, || format!("netlist of {} bytes", json.len()));
    let device = Device::xc2s200();
    let netlist = Netlist::from_yosys(json, top)?;
    let logic = Logic::of(netlist.clone())?;
    let packed = Packed::of(&logic)?;
    let nets = Nets::of(&logic, &packed);
    if let Some(name) = nets.undriven(&logic, &packed).first() {
        return Err(FlowError::Netlist { what: format!("nothing drives net {name}") });
    }
    let graph = Graph::of(&logic, &packed, &nets, constraints);
    let design = Design { logic: &logic, packed: &packed, nets: &nets, graph: &graph, constraints };
    let placement = Placement::of(device, &design, seed, progress)?;
    let routing = Routing::of(device, &design, &placement, progress)?;
    progress.tell(Stage::Bits, 0, || "setting bits".into());
    let terminals = Terminals::of(device, &design, &placement)?;
    let extremes = check(device, &routing, &terminals)?;
    let configuration = bits::configure(device, &design, &placement, &routing)?;
    let halves = || packed.slices().flat_map(|slice| &slice.halves);
    let resources = Resources {
        slices: packed.slices().count(),
        tables: halves().filter(|half| half.tabled).count(),
        flip_flops: halves().filter(|half| half.flop.is_some()).count(),
        carries: logic.chains.iter().map(|chain| chain.bits.len()).sum(),
        memories: logic.memories.len(),
        pads: logic.pads.len(),
        nets: nets.general.len(),
        wires: routing.used(&terminals),
        rounds: routing.rounds,
    };
    let drivers = drivers(&logic, &packed, &placement);
    progress.tell(Stage::Proof, 0, || "decoding and proving".into());
    let decoded = crate::netlist::extract(device, &configuration)
        .map_err(|faults| FlowError::Faulty { faults: faults.iter().map(ToString::to_string).collect() })?;
    let proof = prove(device, &netlist, constraints, &drivers, &decoded);
    let timing = Report::of(&graph, &routing.delays);
    Ok(Built { configuration, resources, extremes, timing, drivers, proof, logic, packed, nets, placement })
}

fn drivers(logic: &Logic, packed: &Packed, placement: &Placement) -> Vec<Driver> {
    let mut drivers = Vec::new();
    for (column, slices) in packed.columns.iter().enumerate() {
        for (row, slice) in slices.slices.iter().enumerate() {
            let at = placement.at(Part::Slice(column as u32, row as u16));
            let element = format!("SLICE[{}]", placement.columns[column].slice);
            let cell = |net: Net| {
                let flops = slice.halves.iter().filter_map(|half| half.flop);
                flops.filter(|flop| flop.output == net).map(|flop| logic.flip_flops[flop.index].name.clone()).next()
            };
            // Carries that stay in the slice count too: proofs cut there.
            let carries = slice.halves.iter().zip(["CF", "CG"]);
            let carries = carries.filter_map(|(half, pin)| Some((pin, half.carry.filter(|_| half.selects)?)));
            drivers.extend(slice.sources().into_iter().chain(carries).map(|(pin, net)| Driver {
                net: logic.nets[net.index()].clone(),
                at,
                element: element.clone(),
                pin: pin.to_owned(),
                flip_flop: cell(net),
            }));
        }
    }
    for (index, memory) in logic.memories.iter().enumerate() {
        let at = MEMORY_SITES[placement.memories[index]];
        for (port, side) in memory.ports.iter().zip(['A', 'B']) {
            let outputs = port.iter().flat_map(|port| port.output.iter().enumerate());
            drivers.extend(outputs.filter_map(|(bit, net)| {
                let net = logic.nets[(*net)?.index()].clone();
                Some(Driver { net, at, element: "BRAM".into(), pin: format!("DO{side}{bit}"), flip_flop: None })
            }));
        }
    }
    drivers.sort();
    drivers
}
