//! The device's wires and switches as plain lists, for the search.

use crate::device::{Device, PipId, PipKind, WireFamily, WireId};
use crate::flow::timing::delays;

/// Most pass gates in series.
pub const GATES: u8 = 6;

/// What kind of way an arc is.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) enum Way {
    /// A multiplexer, buffer or permanent connection.
    Driven,
    /// Into a single-length wire through a switch, one way.
    Entry,
    /// A pass gate between single-length wires.
    Gate,
}

/// A wire.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lane {
    pub(super) columns: (u8, u8),
    pub(super) rows: (u8, u8),
    /// Delay in ps.
    pub(super) delay: u16,
    /// Price where nobody else wants it.
    pub(super) price: u16,
    pub(super) family: WireFamily,
}

pub(super) struct Fabric {
    first: Vec<u32>,
    to: Vec<u32>,
    pip: Vec<u32>,
    way: Vec<Way>,
    pub(super) lanes: Vec<Lane>,
}

impl Fabric {
    pub(super) fn of(device: &Device) -> Self {
        let wires = device.wire_count() as u32;
        let (mut ways, mut known) = (Vec::with_capacity(device.pip_count()), 0);
        for (tile, _) in device.tiles() {
            for pip in &device.class(tile).pips {
                ways.push(match pip.kind {
                    PipKind::Gate { .. } => Way::Gate,
                    PipKind::Switch { .. } => Way::Entry,
                    PipKind::Mux { .. } | PipKind::Buffer { .. } | PipKind::Joined => Way::Driven,
                });
            }
            known += device.class(tile).pips.len();
        }
        debug_assert_eq!(known, device.pip_count());
        let arcs = device.arc_count();
        let mut fabric = Self {
            first: Vec::with_capacity(wires as usize + 1),
            to: Vec::with_capacity(arcs),
            pip: Vec::with_capacity(arcs),
            way: Vec::with_capacity(arcs),
            lanes: Vec::with_capacity(wires as usize),
        };
        for wire in 0..wires {
            fabric.first.push(fabric.to.len() as u32);
            for arc in device.arcs(WireId(wire)) {
                fabric.to.push(arc.to.0);
                fabric.pip.push(arc.pip.0);
                fabric.way.push(ways[arc.pip.0 as usize]);
            }
            let seen = device.wire(WireId(wire));
            fabric.lanes.push(Lane {
                columns: seen.columns,
                rows: seen.rows,
                delay: delays::wire(seen.family) as u16,
                price: price(seen.family),
                family: seen.family,
            });
        }
        fabric.first.push(fabric.to.len() as u32);
        fabric
    }

    pub(super) fn wires(&self) -> usize {
        self.lanes.len()
    }

    /// Arcs that leave a wire: where to, through what, how.
    pub(super) fn arcs(&self, wire: u32) -> impl Iterator<Item = (u32, PipId, Way)> + '_ {
        let range = self.first[wire as usize] as usize..self.first[wire as usize + 1] as usize;
        range.map(|arc| (self.to[arc], PipId(self.pip[arc]), self.way[arc]))
    }

    /// Cells between a wire and a place, at least.
    pub(super) fn distance(&self, wire: u32, to: (u8, u8)) -> u32 {
        let lane = &self.lanes[wire as usize];
        let gap = |(low, high): (u8, u8), at: u8| u32::from(low.saturating_sub(at).max(at.saturating_sub(high)));
        gap(lane.columns, to.0) + gap(lane.rows, to.1)
    }
}

/// Prices follow what a wire takes from others: a long line is one of twelve in its row or column.
fn price(family: WireFamily) -> u16 {
    match family {
        WireFamily::LongHorizontal | WireFamily::LongVertical => 40,
        WireFamily::Hex | WireFamily::HexOneWay => 12,
        WireFamily::Single => 10,
        WireFamily::BlockRamBus => 4,
        _ => 1,
    }
}
