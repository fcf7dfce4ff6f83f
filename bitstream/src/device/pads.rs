//! Pads: what is bonded to the pins of the PQ208 package, and what the pads can be.

use super::{Device, TileId};
use std::collections::HashMap;

/// Where a pad stands in the device.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PadSite {
    /// An input/output block.
    Io {
        /// Tile with its flip-flops and wires.
        tile: TileId,
        /// Tile with its buffer and driver.
        buffer: TileId,
        /// Which block of the tile, 1..=3.
        index: u8,
    },
    /// The input of a global clock.
    Clock {
        /// Tile at the end of the centre column.
        tile: TileId,
        /// Which block of the tile.
        index: u8,
        /// Number of the global clock it feeds directly, 0..4.
        clock: u8,
    },
    /// Supply, configuration, boundary scan, or nothing.
    Fixed(&'static str),
}

/// A pin of the package.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pad {
    /// Number of the pin, 1..=208.
    pub pin: u8,
    /// What is bonded to it.
    pub site: PadSite,
}

/// What an input/output standard sets.
///
/// Values by which the vendor's tools make the standards of DS001, "Versatile I/O", found by Project Combine.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Standard {
    /// Name, with the drive in mA where there is a choice: `LVTTL.12`.
    pub name: &'static str,
    /// Value of PDRIVE.
    pub pull_up: u8,
    /// Value of NDRIVE.
    pub pull_down: u8,
    /// Value of IOSTD_MISC.
    pub misc: u8,
    /// Value of OUTPUT_MISC.
    pub output_misc: u8,
    /// Value of SLEW, slow.
    pub slow: u8,
    /// Value of SLEW, fast.
    pub fast: u8,
}

/// Clock input, class of its tile, block, number of its global clock. Pins 80, 77, 182 and 185: DS001 pin tables;
/// 182 and 185 feed the clock that the card's maker has on them in 22 files.
const CLOCK_PADS: [(&str, &str, u8, u8, u8); 4] = [
    ("CLK4", "CLK_S_V", 0, 0, 0),
    ("CLK5", "CLK_S_V", 0, 1, 1),
    ("CLK1", "CLK_N_V", 29, 0, 2),
    ("CLK0", "CLK_N_V", 29, 1, 3),
];
/// Column of the clock inputs' tiles.
const CLOCK_COLUMN: u8 = 23;
/// Last column and row of the grid.
const RIM: (u8, u8) = (45, 29);

pub(super) fn pads(
    bonds: &[(&'static str, &'static str)],
    tiles: &HashMap<(&'static str, u8, u8), TileId>,
) -> Vec<Pad> {
    let site = |what: &'static str| {
        if let Some((_, class, row, index, clock)) = CLOCK_PADS.iter().copied().find(|pad| pad.0 == what) {
            return tiles.get(&(class, CLOCK_COLUMN, row)).map(|tile| PadSite::Clock { tile: *tile, index, clock });
        }
        let (place, index) = what.strip_prefix("IOB_")?.split_once('_')?;
        let at: u8 = place[1..].parse().ok()?;
        let (class, buffer, column, row) = match place.as_bytes()[0] {
            b'W' => ("IO_W", "IOB_W_V", 0, at),
            b'E' => ("IO_E", "IOB_E_V", RIM.0, at),
            b'S' => ("IO_S", "IOB_S_V", at, 0),
            _ => ("IO_N", "IOB_N_V", at, RIM.1),
        };
        let tile = |class| tiles.get(&(class, column, row)).copied();
        Some(PadSite::Io { tile: tile(class)?, buffer: tile(buffer)?, index: index.parse().ok()? })
    };
    let pad = |(pin, what): &(&'static str, &'static str)| {
        let site = site(what).unwrap_or(PadSite::Fixed(what));
        Some(Pad { pin: pin.strip_prefix('P')?.parse().ok()?, site })
    };
    bonds.iter().filter_map(pad).collect()
}

pub(super) fn standards(rows: &[(&'static str, &'static str, u8)]) -> Vec<Standard> {
    let value = |parameter: &str, name: &str| {
        let found = |name: &str| rows.iter().find(|row| row.0 == parameter && row.1 == name);
        // What does not depend on the drive stands under the name without it.
        found(name).or_else(|| found(name.split('.').next().unwrap_or(name))).map(|row| row.2)
    };
    let standard = |row: &(&'static str, &'static str, u8)| {
        let name = row.1;
        Some(Standard {
            name,
            pull_up: value("PDRIVE", name)?,
            pull_down: value("NDRIVE", name)?,
            misc: value("IOSTD_MISC", name)?,
            output_misc: value("OUTPUT_MISC", name)?,
            slow: value("SLEW", &format!("{name}.SLOW"))?,
            fast: value("SLEW", &format!("{name}.FAST"))?,
        })
    };
    rows.iter().filter(|row| row.0 == "PDRIVE").filter_map(standard).collect()
}

impl Device {
    /// Pins of the package.
    #[must_use]
    pub fn pads(&self) -> &[Pad] {
        &self.pads
    }

    /// A pin of the package by its number, 1..=208.
    #[must_use]
    pub fn pad(&self, pin: u8) -> Option<Pad> {
        self.pads.iter().copied().find(|pad| pad.pin == pin)
    }

    /// Input/output standards.
    #[must_use]
    pub fn standards(&self) -> &[Standard] {
        &self.standards
    }

    /// A standard by its name: `LVTTL.12`, `PCI33_3`.
    #[must_use]
    pub fn standard(&self, name: &str) -> Option<&Standard> {
        self.standards.iter().find(|standard| standard.name == name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_package_has_208_pins_and_140_for_users() {
        let device = Device::xc2s200();
        assert_eq!(device.pads().len(), 208);
        let io = device.pads().iter().filter(|pad| matches!(pad.site, PadSite::Io { .. })).count();
        let clocks = device.pads().iter().filter(|pad| matches!(pad.site, PadSite::Clock { .. })).count();
        assert_eq!((io, clocks), (140, 4));
    }

    #[test]
    fn standards_have_their_strengths() {
        let device = Device::xc2s200();
        assert_eq!(device.standards().len(), 22, "{:?}", device.standards());
        let lvttl = device.standard("LVTTL.24").expect("the standard");
        assert_eq!((lvttl.pull_up, lvttl.pull_down, lvttl.fast, lvttl.slow), (0b1100, 0b10010, 0, 15));
        assert_eq!(device.standard("PCI33_5").map(|standard| standard.misc), Some(0b011));
    }
}
