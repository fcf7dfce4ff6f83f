//! Three-state buffers on the buses of a row.
//!
//! Four buses run through every row; bus 0 of a column is bus 1 of the next, and so on, so that after four columns
//! every bus has had every number. Buffer 0 drives bus 0 or 2, buffer 1 bus 1 or 3; bus 2 comes out at each logic
//! block (OUT_TBUF). A row's buses are cut between two columns unless joined.

use super::Place;
use crate::configuration::{AttributeError, Configuration};
use crate::device::{Device, TileId};

/// A three-state buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct TriState {
    /// Drives bus 0 (buffer 0) or 1 (buffer 1).
    pub drives_low_bus: bool,
    /// Drives bus 2 (buffer 0) or 3 (buffer 1).
    pub drives_high_bus: bool,
    /// Inverter before I.
    pub invert_i: bool,
    /// Inverter before T; the buffer is off while T is 1.
    pub invert_t: bool,
}

impl TriState {
    /// Reads buffer 0 or 1 of a tile.
    ///
    /// # Errors
    /// When the tile has no such buffer.
    pub fn read(
        device: &Device,
        configuration: &Configuration,
        tile: TileId,
        index: u8,
    ) -> Result<Self, AttributeError> {
        let at = Place::new(device, tile, format!("TBUF[{index}]"));
        Ok(Self {
            drives_low_bus: at.flag(configuration, "OUT_A")?,
            drives_high_bus: at.flag(configuration, "OUT_B")?,
            invert_i: at.flag(configuration, "INV.I")?,
            invert_t: at.flag(configuration, "INV.T")?,
        })
    }

    /// Writes buffer 0 or 1 of a tile.
    ///
    /// # Errors
    /// When the tile has no such buffer.
    pub fn write(
        &self,
        device: &Device,
        configuration: &mut Configuration,
        tile: TileId,
        index: u8,
    ) -> Result<(), AttributeError> {
        let at = Place::new(device, tile, format!("TBUF[{index}]"));
        at.set(configuration, "OUT_A", self.drives_low_bus)?;
        at.set(configuration, "OUT_B", self.drives_high_bus)?;
        at.set(configuration, "INV.I", self.invert_i)?;
        at.set(configuration, "INV.T", self.invert_t)
    }
}
