//! What a wire takes over a distance where nobody is in its way: the fastest ways through the fabric from a few
//! slices to all others. The placer judges places by it.

use super::fabric::{Fabric, GATES, Way};
use crate::device::{BelKind, Device, WireFamily};
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Columns and rows of distances.
const SIZE: (usize, usize) = (46, 30);
/// Where ways begin: near the corners, so that every distance occurs, and in the middle.
const SOURCES: [(u8, u8); 6] = [(3, 2), (42, 2), (3, 27), (42, 27), (20, 14), (27, 15)];
const OUTPUTS: [&str; 2] = ["X", "YQ"];
const INPUTS: [&str; 4] = ["F1", "F3", "G2", "G4"];

/// Delays in ps by distance in columns and rows.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct Reach {
    delays: Vec<u32>,
}

impl Reach {
    /// Measures the device.
    #[must_use]
    pub fn of(device: &Device) -> Self {
        let fabric = Fabric::of(device);
        let mut sums = vec![(0_u64, 0_u64); SIZE.0 * SIZE.1];
        for (column, row) in SOURCES {
            let Some(tile) = device.tile_at("CLB", column, row) else { continue };
            for output in OUTPUTS {
                let Some(source) = device.pin(tile, BelKind::Slice, 0, output) else { continue };
                let times = times(&fabric, source.0);
                for (to, _) in device.tiles_of("CLB") {
                    let place = device.tile(to);
                    let at = (column.abs_diff(place.column), row.abs_diff(place.row));
                    for input in INPUTS {
                        let wire = device.pin(to, BelKind::Slice, 1, input);
                        let time = wire.map_or(u32::MAX, |wire| times[wire.0 as usize]);
                        if time < u32::MAX {
                            let entry = &mut sums[usize::from(at.0) * SIZE.1 + usize::from(at.1)];
                            *entry = (entry.0 + u64::from(time), entry.1 + 1);
                        }
                    }
                }
            }
        }
        let mut delays: Vec<u32> = sums.iter().map(|(sum, count)| (sum / (*count).max(1)) as u32).collect();
        // Distances between no two slices are those to pads and memories: as far as the next shorter one.
        for at in 0..delays.len() {
            if sums[at].1 == 0 {
                let shorter = [at.checked_sub(SIZE.1), (!at.is_multiple_of(SIZE.1)).then(|| at - 1)];
                delays[at] = shorter.into_iter().flatten().map(|before| delays[before]).max().unwrap_or(0);
            }
        }
        Self { delays }
    }

    /// Delay over a distance, in ps.
    #[must_use]
    pub fn delay(&self, from: (u8, u8), to: (u8, u8)) -> u32 {
        let at = |one: u8, other: u8, size: usize| usize::from(one.abs_diff(other)).min(size - 1);
        self.delays[at(from.0, to.0, SIZE.0) * SIZE.1 + at(from.1, to.1, SIZE.1)]
    }
}

/// Earliest time at every wire.
fn times(fabric: &Fabric, source: u32) -> Vec<u32> {
    let mut times = vec![(u32::MAX, 0_u8); fabric.wires()];
    let mut heap = BinaryHeap::from([(Reverse(0_u32), source)]);
    times[source as usize].0 = 0;
    while let Some((Reverse(time), wire)) = heap.pop() {
        let (known, gates) = times[wire as usize];
        if known < time {
            continue;
        }
        for (to, _, way) in fabric.arcs(wire) {
            let lane = &fabric.lanes[to as usize];
            let clock = matches!(lane.family, WireFamily::ClockLeaf | WireFamily::ClockRoot);
            let gates = if way == Way::Gate { gates + 1 } else { 0 };
            let next = time + u32::from(lane.delay);
            if !clock && gates <= GATES && next < times[to as usize].0 {
                times[to as usize] = (next, gates);
                heap.push((Reverse(next), to));
            }
        }
    }
    times.into_iter().map(|(time, _)| time).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flow::timing::delays;

    #[test]
    fn farther_takes_longer_and_a_neighbour_costs_two_multiplexers() {
        let reach = Reach::of(Device::xc2s200());
        // Some neighbours are joined directly, without a wire between.
        let least = delays::wire(WireFamily::OutputMux) + delays::wire(WireFamily::Input);
        assert!(reach.delay((5, 5), (6, 5)) >= least);
        assert!(reach.delay((5, 5), (6, 5)) < reach.delay((5, 5), (17, 5)));
        assert!(reach.delay((5, 5), (17, 5)) < reach.delay((5, 5), (29, 25)));
        assert_eq!(reach.delay((5, 5), (17, 9)), reach.delay((17, 9), (5, 5)));
    }
}
