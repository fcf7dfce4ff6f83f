//! Timing of any configuration, from its bits alone: the longest path between flip-flops of one clock.
//!
//! It knows nothing of the flow. On files of the vendor's tools it says what the wire model makes of paths
//! that are known to meet their clocks, and on the flow's own files it checks the flow's figures.
//! Paths through three-state buses, pads and block memories are not followed.

use super::delays::{
    self, BYPASS_SETUP, BYPASS_TO_CARRY, CARRY, CARRY_TO_OUTPUT, CLOCK_TO_OUTPUT, ENABLE_SETUP, OUTPUT_SETUP,
    RESET_SETUP, TABLE, TABLE_TO_CARRY, TABLE_TO_SUM, WIDE,
};
use crate::configuration::Configuration;
use crate::device::{BelKind, Device, PipKind, TileId, WireFamily, WireId};
use crate::element::{FOutput, GOutput, Slice};
use std::collections::{BTreeMap, BTreeSet};

/// Global clocks.
const CLOCKS: usize = 4;

/// The longest path of a clock.
#[derive(Clone, Debug, Default, Eq, PartialEq)]
pub struct Longest {
    /// Its delay by the model, in ps.
    pub delay: u32,
    /// Part of it in wires, in ps.
    pub wires: u32,
    /// Tables and carries entered on the way.
    pub levels: u32,
    /// Flip-flops of the clock.
    pub flip_flops: usize,
}

/// Time at a wire or pin: delay, part in wires, levels.
type Time = (u32, u32, u32);

struct Decoded<'a> {
    device: &'a Device,
    slices: BTreeMap<(TileId, u8), Slice>,
    /// For every input wire that is reached: source wire and delay on the way.
    reached: BTreeMap<WireId, (WireId, u32)>,
    /// Source wires that something reads.
    used: BTreeSet<WireId>,
    /// Slice and output of a source wire.
    makers: BTreeMap<WireId, (TileId, u8, &'static str)>,
    /// Arrival at an output or carry, by launching clock; `None` while it is computed.
    known: BTreeMap<(TileId, u8, &'static str), [Option<Time>; CLOCKS]>,
}

/// The longest path of each of the four global clocks.
#[must_use]
pub fn longest(device: &Device, configuration: &Configuration) -> [Longest; CLOCKS] {
    let mut decoded = Decoded::of(device, configuration);
    let mut longest = <[Longest; CLOCKS]>::default();
    let slices: Vec<(TileId, u8)> = decoded.slices.keys().copied().collect();
    for (tile, index) in slices {
        let Some(clock) = decoded.clock(tile, index) else { continue };
        longest[clock].flip_flops += 1;
        for (time, setup) in decoded.ends(tile, index) {
            if let Some((delay, wires, levels)) = time[clock] {
                let delay = delay + setup;
                if delay > longest[clock].delay {
                    longest[clock] = Longest { delay, wires, levels, ..longest[clock].clone() };
                }
            }
        }
    }
    longest
}

fn later(one: [Option<Time>; CLOCKS], other: [Option<Time>; CLOCKS]) -> [Option<Time>; CLOCKS] {
    std::array::from_fn(|clock| one[clock].max(other[clock]))
}

fn after(times: [Option<Time>; CLOCKS], delay: u32, wires: u32, level: u32) -> [Option<Time>; CLOCKS] {
    times.map(|time| time.map(|(at, in_wires, levels)| (at + delay + wires, in_wires + wires, levels + level)))
}

const NEVER: [Option<Time>; CLOCKS] = [None; CLOCKS];
const TABLES: [[&str; 4]; 2] = [["F1", "F2", "F3", "F4"], ["G1", "G2", "G3", "G4"]];

impl<'a> Decoded<'a> {
    fn of(device: &'a Device, configuration: &Configuration) -> Self {
        let mut decoded = Self {
            device,
            slices: BTreeMap::new(),
            reached: BTreeMap::new(),
            used: BTreeSet::new(),
            makers: BTreeMap::new(),
            known: BTreeMap::new(),
        };
        let mut ways: BTreeMap<WireId, Vec<WireId>> = BTreeMap::new();
        for (tile, _) in device.tiles() {
            for (number, pip) in device.class(tile).pips.iter().enumerate() {
                if !configuration.conducts(device, tile, pip.kind) {
                    continue;
                }
                let Some(pip) = device.tile_pip(tile, number as u32) else { continue };
                ways.entry(pip.from).or_default().push(pip.to);
                if matches!(pip.kind, PipKind::Gate { .. }) {
                    ways.entry(pip.to).or_default().push(pip.from);
                }
            }
        }
        for (tile, _) in device.tiles_of("CLB") {
            for index in 0..2 {
                let Ok(slice) = Slice::read(device, configuration, tile, index) else { continue };
                decoded.slices.insert((tile, index), slice);
                for output in ["X", "Y", "XQ", "YQ", "XB", "YB"] {
                    if let Some(wire) = device.pin(tile, BelKind::Slice, index, output) {
                        decoded.makers.insert(wire, (tile, index, output));
                        decoded.spread(wire, &ways);
                    }
                }
            }
        }
        for number in 0..device.wire_count() as u32 {
            let wire = WireId(number);
            if device.wire(wire).family == WireFamily::ClockRoot {
                decoded.spread(wire, &ways);
            }
        }
        decoded
    }

    /// Follows a source through the switches that conduct.
    fn spread(&mut self, source: WireId, ways: &BTreeMap<WireId, Vec<WireId>>) {
        let mut queue = vec![(source, 0)];
        while let Some((wire, time)) = queue.pop() {
            for to in ways.get(&wire).into_iter().flatten() {
                if *to != source && !self.reached.contains_key(to) {
                    let time = time + delays::wire(self.device.wire(*to).family);
                    self.reached.insert(*to, (source, time));
                    if self.device.wire(*to).family == WireFamily::Input {
                        self.used.insert(source);
                    }
                    queue.push((*to, time));
                }
            }
        }
    }

    /// Number of the global clock at a slice.
    fn clock(&self, tile: TileId, index: u8) -> Option<usize> {
        let wire = self.device.pin(tile, BelKind::Slice, index, "CLK")?;
        let (root, _) = self.reached.get(&wire)?;
        let name = self.device.describe_wire(*root);
        name.split_once("GCLK_ROOT[")?.1.strip_suffix(']')?.parse().ok()
    }

    /// Arrival at an input pin.
    fn input(&mut self, tile: TileId, index: u8, pin: &str) -> [Option<Time>; CLOCKS] {
        let wire = self.device.pin(tile, BelKind::Slice, index, pin);
        let Some((source, delay)) = wire.and_then(|wire| self.reached.get(&wire).copied()) else { return NEVER };
        let Some((tile, index, output)) = self.makers.get(&source).copied() else { return NEVER };
        after(self.output(tile, index, output), 0, delay, 0)
    }

    fn inputs(&mut self, tile: TileId, index: u8, pins: &[&str]) -> [Option<Time>; CLOCKS] {
        pins.iter().fold(NEVER, |times, pin| later(times, self.input(tile, index, pin)))
    }

    /// Arrival at an output, or at a carry: C0, C1, C2.
    fn output(&mut self, tile: TileId, index: u8, name: &'static str) -> [Option<Time>; CLOCKS] {
        let key = (tile, index, name);
        if let Some(times) = self.known.get(&key) {
            return *times;
        }
        // A loop of logic has no longest path: it counts as never.
        self.known.insert(key, NEVER);
        let slice = self.slices[&(tile, index)];
        let half = usize::from(matches!(name, "Y" | "YQ" | "YB" | "C2"));
        let times = match name {
            "XQ" | "YQ" => self.clock(tile, index).map_or(NEVER, |clock| {
                let mut times = NEVER;
                times[clock] = Some((CLOCK_TO_OUTPUT, 0, 0));
                times
            }),
            "X" if slice.x == FOutput::F5 => {
                let both = self.inputs(tile, index, &["F1", "F2", "F3", "F4", "G1", "G2", "G3", "G4", "BX"]);
                after(both, WIDE, 0, 1)
            }
            "X" | "Y" => {
                let sum = if half == 0 { slice.x == FOutput::Xor } else { slice.y == GOutput::Xor };
                let tables = self.inputs(tile, index, &TABLES[half]);
                if sum {
                    let carry = self.output(tile, index, ["C0", "C1"][half]);
                    later(after(tables, TABLE_TO_SUM, 0, 1), after(carry, CARRY_TO_OUTPUT, 0, 0))
                } else {
                    after(tables, TABLE, 0, 1)
                }
            }
            "XB" | "YB" if half == 0 || !slice.yb_is_by => {
                after(self.output(tile, index, ["C1", "C2"][half]), CARRY_TO_OUTPUT, 0, 0)
            }
            "C0" if slice.carry_from_bx => after(self.input(tile, index, "BX"), BYPASS_TO_CARRY, 0, 1),
            "C0" => {
                let at = self.device.tile(tile);
                match self.device.tile_at("CLB", at.column, at.row.wrapping_sub(1)) {
                    Some(below) => self.output(below, index, "C2"),
                    None => NEVER,
                }
            }
            "C1" | "C2" => {
                let before = self.output(tile, index, ["C0", "C1"][half]);
                let selects = if half == 0 { slice.f_selects_carry } else { slice.g_selects_carry };
                let tables = if selects { self.inputs(tile, index, &TABLES[half]) } else { NEVER };
                later(after(before, CARRY, 0, 0), after(tables, TABLE_TO_CARRY, 0, 1))
            }
            _ => NEVER,
        };
        self.known.insert(key, times);
        times
    }

    /// Arrivals and set-up times at the ends in a slice.
    fn ends(&mut self, tile: TileId, index: u8) -> Vec<([Option<Time>; CLOCKS], u32)> {
        let slice = self.slices[&(tile, index)];
        let mut ends = vec![
            (self.input(tile, index, "CE"), ENABLE_SETUP),
            (self.input(tile, index, "SR"), RESET_SETUP),
            (self.input(tile, index, "BX"), BYPASS_SETUP),
            (self.input(tile, index, "BY"), BYPASS_SETUP),
        ];
        for (output, register, bypassed) in
            [("X", "XQ", slice.x_register_takes_bx), ("Y", "YQ", slice.y_register_takes_by)]
        {
            let wire = self.device.pin(tile, BelKind::Slice, index, register);
            let read = wire.is_some_and(|wire| self.used.contains(&wire));
            if !bypassed && read {
                ends.push((self.output(tile, index, output), OUTPUT_SETUP));
            }
        }
        ends
    }
}
