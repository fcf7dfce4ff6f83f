//! The XC2S200 in its PQ208 package: tiles, wires, switches, bits and pads.
//!
//! | what | how many | source |
//! |---|---|---|
//! | columns × rows | 46 × 30 | Project Combine |
//! | logic blocks (2 slices, 2 three-state buffers each) | 42 × 28 = 1,176 | Xilinx DS001 |
//! | block RAM of 4,096 bits | 14 | Xilinx DS001 |
//! | delay-locked loops, global clocks | 4, 4 | Xilinx DS001 |
//! | tiles, of 29 kinds | 1,523 | Project Combine |
//! | wires | 285,264 | counted |
//! | switches | 1.7 million, 1.2 of them inputs of multiplexers | counted |
//! | configuration bits | 2,314 frames × 540 | Xilinx XAPP151 |
//!
//! Column 0 is the west side, row 0 the south side. Inputs and outputs stand on the rim, block RAM in columns 1
//! and 44, logic in X2..X43, Y1..Y28. The clock tree's root is in the middle (X23, Y13).
//!
//! The table `data/xc2s200.txt` comes from Project Combine, which found it out by experiments on the vendor's
//! tools; its head says under which licence, and explains its notation.

mod class;
mod database;
mod family;
mod frames;
mod graph;
mod pads;
mod wires;

pub use class::{Attribute, BelKind, Choice, ClassBel, ClassPip, Coding, Pin, PipKind, TileBit, TileClass};
pub use family::WireFamily;
pub use frames::{Bit, CONTENT_FRAMES, FIRST_CONTENT_FRAME, FRAME_BITS, FRAMES, FrameAddress, FrameColumn, ROW_BITS};
pub use graph::{Arc, Pip};
pub use pads::{Pad, PadSite, Standard};
pub use wires::Wire;

use database::{Database, Name};
use std::collections::HashMap;
use std::sync::LazyLock;
use wires::Wiring;

/// A wire of the device, 0..[`Device::wire_count`]; the same on every run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct WireId(pub u32);

/// A switch of the device, 0..[`Device::pip_count`]; the same on every run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct PipId(pub u32);

/// A tile of the device, 0..1,523; the same on every run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct TileId(pub u16);

/// A tile: where it stands, and where its bits and wires are.
#[derive(Clone, Debug)]
pub struct Tile {
    /// Its kind, index into [`Device::classes`].
    pub class: u16,
    /// Column in the grid of tiles, from 0.
    pub column: u8,
    /// Row in the grid of tiles, from 0.
    pub row: u8,
    /// First bit of each of its rectangles.
    rectangles: Vec<Bit>,
    /// First of its wires in the list of all tiles' wires.
    first_wire: u32,
    /// First of its switches.
    first_pip: u32,
}

/// The XC2S200 as a graph: tiles, wires, pips, bits, pads.
#[derive(Debug)]
pub struct Device {
    grid: (u8, u8),
    columns: Vec<FrameColumn>,
    classes: Vec<TileClass>,
    tiles: Vec<Tile>,
    tiles_by_place: HashMap<(&'static str, u8, u8), TileId>,
    wire_names: Vec<&'static str>,
    names: HashMap<&'static str, Name>,
    wires: Vec<Wire>,
    /// For every cell and name, the wire.
    ids: Vec<u32>,
    /// Wires of all tiles, class by class as [`TileClass::wires`]; `u32::MAX` is none.
    tile_wires: Vec<u32>,
    graph: graph::Graph,
    pads: Vec<Pad>,
    standards: Vec<Standard>,
}

impl Device {
    /// The device. Its tables are read once a process: about 0.2 s and 50 MB.
    ///
    /// # Panics
    /// When the table that is part of this crate is damaged; a test reads it whole.
    #[must_use]
    pub fn xc2s200() -> &'static Self {
        static DEVICE: LazyLock<Device> = LazyLock::new(Device::build);
        &DEVICE
    }

    fn build() -> Self {
        let database = Database::read();
        let columns = frames::columns(database.grid, &database.block_ram);
        let classes: Vec<TileClass> =
            database.classes.iter().map(|class| TileClass::read(class, &database.names)).collect();
        let mut wiring = Wiring::new(&database);
        let (mut tiles, mut tile_wires) = (Vec::new(), Vec::new());
        let (mut tiles_by_place, mut pips) = (HashMap::new(), 0);
        for raw in &database.tiles {
            let class = &classes[raw.class];
            let rectangles =
                class.rectangles.iter().map(|name| frames::rectangle(&columns, name, raw.at, &raw.cells)).collect();
            let tile = Tile {
                class: raw.class as u16,
                column: raw.at.0,
                row: raw.at.1,
                rectangles,
                first_wire: tile_wires.len() as u32,
                first_pip: pips,
            };
            let wires = class
                .wires
                .iter()
                .map(|(cell, name)| wiring.find(raw.cells[usize::from(*cell)], *name).map_or(u32::MAX, |wire| wire.0));
            tile_wires.extend(wires);
            pips += class.pips.len() as u32;
            tiles_by_place.insert((class.name, raw.at.0, raw.at.1), TileId(tiles.len() as u16));
            tiles.push(tile);
        }
        let (wires, ids) = wiring.into_parts();
        let graph = graph::Graph::build(&classes, &tiles, &tile_wires, wires.len(), pips);
        let pads = pads::pads(&database.pads, &tiles_by_place);
        let standards = pads::standards(&database.standards);
        Self {
            grid: database.grid,
            columns,
            classes,
            tiles,
            tiles_by_place,
            wire_names: database.wires.iter().map(|(name, _)| *name).collect(),
            names: database.names,
            wires,
            ids,
            tile_wires,
            graph,
            pads,
            standards,
        }
    }

    /// Columns and rows.
    #[must_use]
    pub fn grid(&self) -> (u8, u8) {
        self.grid
    }

    /// Kinds of tiles.
    #[must_use]
    pub fn classes(&self) -> &[TileClass] {
        &self.classes
    }

    /// Tiles with their numbers, from 0.
    pub fn tiles(&self) -> impl Iterator<Item = (TileId, &Tile)> {
        self.tiles.iter().enumerate().map(|(n, tile)| (TileId(n as u16), tile))
    }

    /// Tiles of a class, by name.
    pub fn tiles_of<'a>(&'a self, class: &'a str) -> impl Iterator<Item = (TileId, &'a Tile)> {
        self.tiles().filter(move |(_, tile)| self.classes[usize::from(tile.class)].name == class)
    }

    /// What stands at a place of the grid.
    #[must_use]
    pub fn tile(&self, tile: TileId) -> &Tile {
        &self.tiles[usize::from(tile.0)]
    }

    /// The tile of a class at a place; the logic block at X2Y1 is `("CLB", 2, 1)`.
    #[must_use]
    pub fn tile_at(&self, class: &'static str, column: u8, row: u8) -> Option<TileId> {
        self.tiles_by_place.get(&(class, column, row)).copied()
    }

    /// The kind of a tile.
    #[must_use]
    pub fn class(&self, tile: TileId) -> &TileClass {
        &self.classes[usize::from(self.tile(tile).class)]
    }

    /// A tile for messages: `CLB X2Y1`.
    #[must_use]
    pub fn describe_tile(&self, tile: TileId) -> String {
        let found = self.tile(tile);
        format!("{} X{}Y{}", self.class(tile).name, found.column, found.row)
    }

    /// Where a bit of a tile stands among the frames.
    #[must_use]
    pub fn bit(&self, tile: TileId, bit: TileBit) -> Bit {
        let first = self.tile(tile).rectangles[usize::from(bit.rectangle)];
        Bit { frame: first.frame + u16::from(bit.frame), bit: first.bit + u16::from(bit.bit) }
    }

    /// A wire of a tile by its index in the tile's class; none where the device ends.
    #[must_use]
    pub fn tile_wire(&self, tile: TileId, wire: u16) -> Option<WireId> {
        let id = self.tile_wires[self.tile(tile).first_wire as usize + usize::from(wire)];
        (id != u32::MAX).then_some(WireId(id))
    }

    /// The wire of an element's pin.
    #[must_use]
    pub fn pin(&self, tile: TileId, kind: BelKind, index: u8, pin: &str) -> Option<WireId> {
        let bel = self.class(tile).bel(kind, index)?;
        let pin = bel.pins.iter().find(|candidate| candidate.name == pin)?;
        self.tile_wire(tile, pin.wire)
    }

    /// Wires there are.
    #[must_use]
    pub fn wire_count(&self) -> usize {
        self.wires.len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_device_has_its_parts() {
        let device = Device::xc2s200();
        assert_eq!(device.tiles_of("CLB").count(), 1_176);
        assert_eq!(device.tiles_of("BRAM_W").count() + device.tiles_of("BRAM_E").count(), 14);
        assert_eq!(device.tiles_of("DLL_S").count() + device.tiles_of("DLL_N").count(), 4);
        assert_eq!(device.tiles().count(), 1_523);
        assert_eq!(device.wire_count(), 285_264);
    }

    #[test]
    fn no_two_attributes_share_a_bit_unless_they_are_one_switch() {
        let device = Device::xc2s200();
        let mut owners: HashMap<Bit, (TileId, usize)> = HashMap::new();
        for (id, _) in device.tiles() {
            for (n, attribute) in device.class(id).attributes.iter().enumerate() {
                for bit in attribute.bits.iter().map(|bit| device.bit(id, *bit)) {
                    assert!(usize::from(bit.frame) < FRAMES && usize::from(bit.bit) < FRAME_BITS);
                    if let Some((other, m)) = owners.insert(bit, (id, n)) {
                        let other = &device.class(other).attributes[m];
                        assert_eq!(other.bits, attribute.bits, "{} and {}", other.name, attribute.name);
                    }
                }
            }
        }
    }

    #[test]
    fn a_wire_has_a_name_in_every_cell_it_crosses() {
        let device = Device::xc2s200();
        let single = device.wire_at(5, 5, "SINGLE_E[3]").expect("a wire");
        assert_eq!(device.wire_at(6, 5, "SINGLE_W[3]"), Some(single));
        assert_eq!(device.wire(single).columns, (5, 6));
        let long = device.wire_at(20, 7, "LH[0]").expect("a wire");
        assert_eq!(device.wire(long).family, WireFamily::LongHorizontal);
        assert!(device.wire(long).columns.1 - device.wire(long).columns.0 > 30);
        assert_eq!(device.describe_wire(single), "X5Y5.SINGLE_E[3]");
        assert_eq!(device.wire_at(99, 5, "LH[0]"), None);
    }
}
