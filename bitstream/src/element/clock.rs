//! Clock pads, global buffers and delay-locked loops.

use super::{InputBuffer, Place};
use crate::configuration::{AttributeError, Configuration};
use crate::device::{Device, TileId};

/// A global clock pad.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ClockPad {
    /// What turns the voltage at its pad into a bit.
    pub input: InputBuffer,
}

impl ClockPad {
    /// Reads pad 0 or 1 of the tile at an end of the centre column.
    ///
    /// # Errors
    /// When the tile has no such pad.
    pub fn read(
        device: &Device,
        configuration: &Configuration,
        tile: TileId,
        index: u8,
    ) -> Result<Self, AttributeError> {
        let at = Place::new(device, tile, format!("GCLK_IO[{index}]"));
        Ok(Self { input: at.choice(configuration, "IBUF", InputBuffer::named)? })
    }

    /// Writes pad 0 or 1 of the tile at an end of the centre column.
    ///
    /// # Errors
    /// When the tile has no such pad.
    pub fn write(
        &self,
        device: &Device,
        configuration: &mut Configuration,
        tile: TileId,
        index: u8,
    ) -> Result<(), AttributeError> {
        let at = Place::new(device, tile, format!("GCLK_IO[{index}]"));
        at.choose(configuration, "IBUF", self.input.name())
    }
}

/// Settings of a global clock buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct GlobalBuffer {
    /// Its output is 1 while it is not enabled; otherwise 0.
    pub disabled_high: bool,
    /// Inverter before CE; not routed, CE is 1.
    pub invert_ce: bool,
}

impl GlobalBuffer {
    /// Reads buffer 0 or 1 of the tile at an end of the centre column.
    ///
    /// # Errors
    /// When the tile has no such buffer.
    pub fn read(
        device: &Device,
        configuration: &Configuration,
        tile: TileId,
        index: u8,
    ) -> Result<Self, AttributeError> {
        let at = Place::new(device, tile, format!("BUFG[{index}]"));
        Ok(Self {
            disabled_high: at.flag(configuration, "DISABLE_ATTR")?,
            invert_ce: at.flag(configuration, "INV.CE")?,
        })
    }
}

/// A delay-locked loop, as far as it is read.
///
/// The meaning of the remaining attributes is not published; a configuration keeps them as they are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Dll {
    /// The feedback input is CLK2X; otherwise CLK0.
    pub feedback_2x: bool,
    /// Outputs have their duty cycle corrected to one half.
    pub duty_cycle_correction: bool,
    /// For clocks above 60 MHz (DS001, "DLL timing parameters").
    pub high_frequency: bool,
    /// CLKDV divides by a whole number; otherwise by one and a half, two and a half, ...
    pub divides_whole: bool,
    /// One less than the divisor of CLKDV, rounded up.
    pub divide_count: u8,
    /// Inverter before RST.
    pub invert_rst: bool,
}

impl Dll {
    /// Reads the loop of a tile.
    ///
    /// # Errors
    /// When the tile has no loop.
    pub fn read(device: &Device, configuration: &Configuration, tile: TileId) -> Result<Self, AttributeError> {
        let at = Place::new(device, tile, "DLL".to_owned());
        Ok(Self {
            feedback_2x: at.is(configuration, "CLK_FEEDBACK", "2X")?,
            duty_cycle_correction: at.number(configuration, "DUTY_CYCLE_CORRECTION")? != 0,
            high_frequency: at.flag(configuration, "HIGH_FREQUENCY")?,
            divides_whole: at.is(configuration, "CLKDV_MODE", "INT")?,
            divide_count: at.number(configuration, "CLKDV_COUNT_MAX")? as u8,
            invert_rst: at.flag(configuration, "INV.RST")?,
        })
    }
}
