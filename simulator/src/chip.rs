//! A whole chip behind its pins: compiled Verilog, or the circuit of a bitstream.

use crate::cosim::{Change, Layout, Session};
use crate::error::FpgaError;

/// A simulated chip whose pins have columns in a [`Layout`].
pub trait Chip: Send {
    /// Columns of its stimulus and of its response.
    fn layout(&self) -> &Layout;

    /// Rising edges of the local bus clock since configuration.
    fn clock(&self) -> u64;

    /// Sets an input column from now on.
    ///
    /// # Errors
    /// A simulation that fails.
    fn set(&mut self, column: usize, value: u32) -> Result<(), FpgaError>;

    /// Sets an input by name.
    ///
    /// # Errors
    /// No such input, or a simulation that fails.
    fn set_port(&mut self, name: &str, value: u32) -> Result<(), FpgaError> {
        let column = self.layout().input(name)?;
        self.set(column, value)
    }

    /// Output columns as they are.
    ///
    /// # Errors
    /// A simulation that fails.
    fn get(&mut self, columns: &[usize]) -> Result<Vec<u32>, FpgaError>;

    /// Input changes at clocks to come; whatever lets clocks pass plays them.
    ///
    /// # Errors
    /// A simulation that fails.
    fn schedule(&mut self, changes: &[Change]) -> Result<(), FpgaError>;

    /// Lets clocks pass.
    ///
    /// # Errors
    /// A simulation that fails.
    fn run(&mut self, clocks: u64) -> Result<(), FpgaError>;

    /// Notes changes of these output columns from now on.
    ///
    /// # Errors
    /// A simulation that fails.
    fn record(&mut self, columns: &[usize]) -> Result<(), FpgaError>;

    /// The changes noted since the last call, in order of time.
    ///
    /// # Errors
    /// A simulation that fails.
    fn take_recorded(&mut self) -> Result<Vec<Change>, FpgaError>;

    /// Reads consecutive words over the local bus in one burst.
    ///
    /// # Errors
    /// A simulation that fails, or a design that breaks the rules of the bus.
    fn read(&mut self, offset: u16, words: &mut [u32]) -> Result<(), FpgaError>;

    /// Writes a word over the local bus.
    ///
    /// # Errors
    /// As [`Self::read`].
    fn write(&mut self, offset: u16, data: u32) -> Result<(), FpgaError>;
}

/// Lines of a robot at rest and ready to drive: no emergency stop, the host in command, radio idle, no ball, the
/// capacitor empty, encoders at the beginning of a line, no inertial sensor.
const READY: [(&str, u32); 11] = [
    ("emergency_stop", 0),
    ("host_select", 1),
    ("radio_rx", 1),
    ("ball_sensor", 0),
    ("kicker_full", 0),
    ("robot_number", 0),
    ("encoder_a", 0),
    ("encoder_b", 0),
    ("encoder_index", 0),
    ("imu_miso", 1),
    ("imu_ready", 1),
];

/// Puts a chip into a robot at rest, ready to drive.
///
/// # Errors
/// A simulation that fails.
pub fn release(chip: &mut dyn Chip) -> Result<(), FpgaError> {
    READY.into_iter().try_for_each(|(name, level)| chip.set_port(name, level))
}

impl Chip for Session {
    fn layout(&self) -> &Layout {
        Session::layout(self)
    }
    fn clock(&self) -> u64 {
        Session::clock(self)
    }
    fn set(&mut self, column: usize, value: u32) -> Result<(), FpgaError> {
        Ok(Session::set(self, &[(column, value)])?)
    }
    fn get(&mut self, columns: &[usize]) -> Result<Vec<u32>, FpgaError> {
        Ok(Session::get(self, columns)?)
    }
    fn schedule(&mut self, changes: &[Change]) -> Result<(), FpgaError> {
        Ok(Session::schedule(self, changes)?)
    }
    fn run(&mut self, clocks: u64) -> Result<(), FpgaError> {
        Ok(Session::run(self, clocks)?)
    }
    fn record(&mut self, columns: &[usize]) -> Result<(), FpgaError> {
        Ok(Session::record(self, columns)?)
    }
    fn take_recorded(&mut self) -> Result<Vec<Change>, FpgaError> {
        Ok(Session::take_recorded(self)?)
    }
    fn read(&mut self, offset: u16, words: &mut [u32]) -> Result<(), FpgaError> {
        words.copy_from_slice(&self.bus_burst_read(offset.into(), words.len() as u32)?);
        Ok(())
    }
    fn write(&mut self, offset: u16, data: u32) -> Result<(), FpgaError> {
        Ok(self.bus_write(offset.into(), data)?)
    }
}
