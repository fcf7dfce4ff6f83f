//! The three-state buses of the rows.
//!
//! Bus n of a column is bus n + 1 of the next one; bus 3 goes on as bus 0 of the next only where it is joined. The
//! bit that joins stands one column to the west, next to the one of the west side's own bus.

use super::extract::{Extractor, Inner};
use super::routing::Output;
use super::{CellKind, NetId, Signal};
use crate::device::{BelKind, TileId};
use crate::element::TriState;

/// Buses in a row.
const BUSES: usize = 4;

impl Extractor<'_> {
    /// A tap of a bus: OUT of a logic block is bus 2, the sides have all four.
    pub(super) fn bus_output(&mut self, output: Output, net: NetId) {
        let bus = match self.pin_name(output) {
            "BUS0" => 0,
            "BUS1" => 1,
            "BUS3" => 3,
            _ => 2,
        };
        let row = self.device.tile(output.tile).row;
        let tiles = self.row(row);
        let Some(at) = tiles.iter().position(|tile| *tile == output.tile) else { return };
        let segment = self.segment(&tiles, at * BUSES + bus);
        let first = segment[0];
        let key = (tiles[0], 0, Inner::Bus(first as u32));
        let place = format!("X{}Y{row}_B{}", self.device.tile(tiles[first / BUSES]).column, first % BUSES);
        let bus_net = match self.inner.get(&key) {
            Some(net) => *net,
            None => {
                let bus_net = self.net(format!("{place}_BUS"));
                self.inner.insert(key, bus_net);
                let drivers = self.drivers(&tiles, &segment);
                self.cell(&place, CellKind::Bus { drivers, output: bus_net });
                bus_net
            }
        };
        self.alias(&place, Signal::Net(bus_net), net);
    }

    /// Tiles of a row that have buses, from west to east.
    fn row(&self, row: u8) -> Vec<TileId> {
        (0..self.device.grid().0)
            .filter_map(|column| {
                ["IO_W", "CLB", "IO_E"].into_iter().find_map(|class| self.device.tile_at(class, column, row))
            })
            .collect()
    }

    /// All buses that are one with this one, as tile × 4 + bus, the lowest first.
    fn segment(&self, tiles: &[TileId], start: usize) -> Vec<usize> {
        let mut segment = vec![start];
        let mut at = start;
        // Westwards: bus n is bus n - 1 of the tile before, bus 0 its bus 3 if joined.
        while let Some(before) = (at / BUSES).checked_sub(1) {
            at = match at % BUSES {
                0 if self.joined(tiles, before) => before * BUSES + BUSES - 1,
                0 => break,
                bus => before * BUSES + bus - 1,
            };
            segment.push(at);
        }
        at = start;
        while at / BUSES + 1 < tiles.len() {
            let after = at / BUSES + 1;
            at = match at % BUSES {
                3 if self.joined(tiles, after - 1) => after * BUSES,
                3 => break,
                bus => after * BUSES + bus + 1,
            };
            segment.push(at);
        }
        segment.sort_unstable();
        segment
    }

    /// Whether bus 3 of a tile goes on as bus 0 of the next.
    fn joined(&self, tiles: &[TileId], at: usize) -> bool {
        let (tile, name) = match at {
            0 => (tiles[0], "TBUS:JOINER"),
            _ => (tiles[at - 1], "TBUS:JOINER_E"),
        };
        self.configuration.number(self.device, tile, name).is_ok_and(|value| value != 0)
    }

    fn drivers(&mut self, tiles: &[TileId], segment: &[usize]) -> Vec<(Signal, Signal)> {
        let mut drivers = Vec::new();
        for place in segment {
            let (tile, bus) = (tiles[place / BUSES], place % BUSES);
            let index = (bus % 2) as u8;
            let Ok(buffer) = TriState::read(self.device, self.configuration, tile, index) else { continue };
            if if bus < 2 { buffer.drives_low_bus } else { buffer.drives_high_bus } {
                let data = self.input(tile, BelKind::TriState, index, "I", buffer.invert_i);
                let off = self.input(tile, BelKind::TriState, index, "T", buffer.invert_t);
                drivers.push((data, off));
            }
        }
        drivers
    }
}
