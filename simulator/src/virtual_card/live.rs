//! A configured FPGA in time: clocks pass, encoders turn, duties drive.

use super::Machine;
use crate::error::FpgaError;
use crate::fpga::{BitTrue, Fpga};
use driver::Registers;
use fixed_kin::card::Pins;
use fixed_kin::kicker::State;
use fixed_kin::registers::{KICKER_STATE, KICKER_STATUS, MIN_TICK_PERIOD, TICK_PERIOD, TIME};

/// An FPGA with a clock that runs, and a robot on its pins.
pub trait Live: Send {
    /// Lets clocks pass up to this one, counted from configuration.
    ///
    /// # Errors
    /// A simulation that fails, or an encoder faster than its filter.
    fn run_to(&mut self, clock: u64, clock_hz: f64, machine: &mut Machine) -> Result<(), FpgaError>;

    /// Reads a register.
    ///
    /// # Errors
    /// A simulation that fails.
    fn read(&mut self, offset: u16) -> Result<u32, FpgaError>;

    /// Writes a register.
    ///
    /// # Errors
    /// A simulation that fails.
    fn write(&mut self, offset: u16, data: u32) -> Result<(), FpgaError>;

    /// Pulses of the kicker's trigger since configuration.
    fn kicks(&self) -> u32;
}

/// The bit-true FPGA, control tick by control tick; it keeps up with real time.
///
/// Registers read as of the last control tick, but for `time`, which runs.
#[derive(Debug)]
pub struct BitTrueLive {
    fpga: BitTrue,
    /// Clock of the last control tick, and now.
    tick: u64,
    now: u64,
    failed: Option<String>,
    kicks: u32,
    kicking: bool,
}

impl Default for BitTrueLive {
    fn default() -> Self {
        Self::new()
    }
}

impl BitTrueLive {
    /// Just configured.
    #[must_use]
    pub fn new() -> Self {
        Self { fpga: BitTrue::new(), tick: 0, now: 0, failed: None, kicks: 0, kicking: false }
    }

    /// Its pins other than the encoders.
    pub fn pins(&mut self) -> &mut Pins {
        &mut self.fpga.pins
    }

    /// A pulse may be shorter than a tick, but the lock-out after it is not.
    fn count_kicks(&mut self) -> Result<(), FpgaError> {
        let state = KICKER_STATE.of(self.fpga.read(KICKER_STATUS.offset)?);
        let kicking = state >= State::Pulse as u32;
        self.kicks += u32::from(kicking && !self.kicking);
        self.kicking = kicking;
        Ok(())
    }
}

impl Live for BitTrueLive {
    fn run_to(&mut self, clock: u64, clock_hz: f64, machine: &mut Machine) -> Result<(), FpgaError> {
        self.now = clock.max(self.now);
        if let Some(error) = &self.failed {
            return Err(FpgaError::Emit(error.clone()));
        }
        loop {
            let period = self.fpga.read(TICK_PERIOD.offset)?.max(MIN_TICK_PERIOD);
            if self.tick + u64::from(period) > self.now {
                return Ok(());
            }
            self.tick += u64::from(period);
            let duties = self.fpga.duties()?;
            machine.step(&duties, f64::from(period) / clock_hz);
            self.fpga.pins.encoder_errors = machine.illegal_steps();
            if let Some(sensor) = machine.take_imu() {
                self.fpga = std::mem::take(&mut self.fpga).with_imu(sensor);
            }
            if let Some(sensor) = self.fpga.imu() {
                sensor.feel(&machine.motion(), clock_hz);
            }
            if let Err(error) = self.fpga.advance(&machine.positions()) {
                self.failed = Some(error.to_string());
                return Err(error);
            }
            self.count_kicks()?;
        }
    }

    fn read(&mut self, offset: u16) -> Result<u32, FpgaError> {
        Ok(match offset {
            o if o == TIME.offset => self.now as u32,
            _ => self.fpga.read(offset)?,
        })
    }

    fn write(&mut self, offset: u16, data: u32) -> Result<(), FpgaError> {
        Ok(self.fpga.write(offset, data)?)
    }

    fn kicks(&self) -> u32 {
        self.kicks
    }
}
