//! The bit-true model as an FPGA.

use super::edges::Counter;
use super::{Fpga, FpgaError, Kind};
use crate::imu::VirtualImu;
use driver::{BusError, Registers};
use fixed_kin::AXES;
use fixed_kin::card::{Card, Pins};
use fixed_kin::control::TickOutputs;

/// `fixed_kin::card::Card` with encoders.
#[derive(Clone, Debug)]
pub struct BitTrue {
    card: Card,
    counters: [Counter; AXES],
    quiet: u32,
    outputs: TickOutputs,
    /// Pins other than the encoders and the inertial sensor's.
    pub pins: Pins,
    imu: Option<VirtualImu>,
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
            imu: None,
        }
    }

    /// With an inertial sensor on its pins.
    #[must_use]
    pub fn with_imu(mut self, sensor: VirtualImu) -> Self {
        self.imu = Some(sensor);
        self
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
        let port = self.card.imu();
        if let Some(sensor) = &mut self.imu
            && let Some(command) = port.take()
        {
            port.answer(sensor.access(command));
        }
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
        if let (Some(sensor), Some(first)) = (&self.imu, self.card.imu_reads()) {
            self.pins.imu = sensor.sample(first);
        }
        self.outputs = self.card.tick(&self.pins);
        Ok(())
    }

    fn imu(&mut self) -> Option<&mut VirtualImu> {
        self.imu.as_mut()
    }

    fn quiet_clocks(&self) -> u32 {
        self.quiet
    }

    fn duties(&mut self) -> Result<[f64; AXES], FpgaError> {
        if !self.card.armed() {
            return Ok([0.0; AXES]);
        }
        let period = self.card.pwm_period();
        Ok(self.outputs.modulation.map(|modulation| super::share(modulation, period)))
    }
}
