//! The bit-true model as an FPGA.

use super::edges::Counter;
use super::{Fpga, FpgaError, Kind};
use driver::{BusError, Registers};
use fixed_kin::AXES;
use fixed_kin::card::{Card, Pins};
use fixed_kin::control::TickOutputs;
use fixed_kin::registers::PWM_PERIOD;

/// `fixed_kin::card::Card` with encoders.
#[derive(Clone, Debug)]
pub struct BitTrue {
    card: Card,
    counters: [Counter; AXES],
    quiet: u32,
    outputs: TickOutputs,
    /// Pins other than the encoders.
    pub pins: Pins,
}

impl Default for BitTrue {
    fn default() -> Self {
        Self::new()
    }
}

impl BitTrue {
    /// A card just configured with the committed design.
    #[must_use]
    pub fn new() -> Self {
        Self {
            card: Card::new(hdl::design::content_hash()),
            counters: [Counter::default(); AXES],
            quiet: 0,
            outputs: TickOutputs::default(),
            pins: Pins::default(),
        }
    }

    /// The same with encoders that stand still for some clocks after each tick, as before pin-level
    /// backends.
    #[must_use]
    pub fn with_quiet_clocks(mut self, clocks: u32) -> Self {
        self.quiet = clocks;
        self
    }
}

impl Registers for BitTrue {
    fn read(&mut self, offset: u16) -> Result<u32, BusError> {
        Ok(self.card.read(offset))
    }
    fn write(&mut self, offset: u16, data: u32) -> Result<(), BusError> {
        self.card.write(offset, data);
        Ok(())
    }
    fn read_block(&mut self, offset: u16, words: &mut [u32]) -> Result<(), BusError> {
        self.card.read_block(offset, words);
        Ok(())
    }
}

impl Fpga for BitTrue {
    fn kind(&self) -> Kind {
        Kind::BitTrue
    }

    fn advance(&mut self, positions: &[f64; AXES]) -> Result<(), FpgaError> {
        let period = self.card.tick_period();
        let now = self.card.time().wrapping_add(period);
        let filter = self.card.encoder_filter();
        for (axis, (counter, &to)) in self.counters.iter_mut().zip(positions).enumerate() {
            super::check_motion(axis, counter.position, to, period, self.quiet, filter)?;
            self.pins.encoders[axis] = counter.advance(to, now, period, self.quiet, filter);
        }
        self.outputs = self.card.tick(&self.pins);
        Ok(())
    }

    fn quiet_clocks(&self) -> u32 {
        self.quiet
    }

    fn duties(&mut self) -> Result<[f64; AXES], FpgaError> {
        if !self.card.armed() {
            return Ok([0.0; AXES]);
        }
        let period = self.card.read(PWM_PERIOD.offset) as u16;
        Ok(self.outputs.modulation.map(|modulation| super::share(modulation, period)))
    }
}
