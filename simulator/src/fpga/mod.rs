//! One seam, four FPGAs behind it: the same registers, encoders that turn, control ticks that pass.
//!
//! | backend | what it is | needs |
//! |---|---|---|
//! | [`BitTrue`] | `fixed_kin::card::Card`, tick by tick | nothing |
//! | [`RustHdl`] | the rust-hdl core, clock by clock, through its bus pins | nothing |
//! | [`Verilog`] | the emitted Verilog, compiled, through its bus pins | Verilator |
//! | [`Decoded`] | the circuit decoded from the committed bitstream, through its bus pins | nothing |
//!
//! Encoders move linearly within a control period; the first [`Fpga::quiet_clocks`] of it they stand
//! still, because a host that talks over real bus pins takes clocks after each tick.

mod bit_true;
mod decoded;
pub mod edges;
mod forward;
mod pin_level;
mod ports;
mod rust_hdl;
mod verilog;

pub use crate::error::FpgaError;
pub use bit_true::BitTrue;
pub use decoded::Decoded;
pub use pin_level::QUIET_CLOCKS;
pub use rust_hdl::RustHdl;
pub use verilog::Verilog;

use crate::imu::VirtualImu;
use driver::Registers;
use fixed_kin::AXES;
use fixed_kin::format::Duty;
use fixed_kin::modulation::{Modulation, modulate};
use fixed_kin::registers::{
    PWM_PERIOD, Register, SNAPSHOT_DUTY, SNAPSHOT_SEQUENCE, SNAPSHOT_STATUS, SNAPSHOT_WORDS, STATUS_ARMED,
};
use std::fmt;
use std::str::FromStr;

/// An FPGA with encoders on its pins.
pub trait Fpga: Registers {
    /// Its name.
    fn kind(&self) -> Kind;

    /// Lets one control period pass, in which the encoders move to these positions (counts; the
    /// counter shows the floor), and the program after it.
    ///
    /// # Errors
    /// [`FpgaError`] where the simulation fails or an encoder moves too fast.
    fn advance(&mut self, positions: &[f64; AXES]) -> Result<(), FpgaError>;

    /// The inertial sensor on the pins, if there is one.
    fn imu(&mut self) -> Option<&mut VirtualImu> {
        None
    }

    /// Clocks at the start of a period in which encoders stand still.
    fn quiet_clocks(&self) -> u32;

    /// Duties in [−1, 1] that the last control tick computed; all zero while the outputs are off.
    ///
    /// # Errors
    /// [`FpgaError`] where the simulation fails.
    fn duties(&mut self) -> Result<[f64; AXES], FpgaError> {
        let mut words = [0; SNAPSHOT_WORDS];
        self.read_block(SNAPSHOT_SEQUENCE.offset, &mut words)?;
        let word = |register: &Register, index| words[usize::from(register.at(index) - SNAPSHOT_SEQUENCE.offset) / 4];
        if !STATUS_ARMED.is_set(word(&SNAPSHOT_STATUS, 0)) {
            return Ok([0.0; AXES]);
        }
        let period = self.read(PWM_PERIOD.offset)? as u16;
        Ok(std::array::from_fn(|axis| {
            share(modulate(Duty::from_bits(word(&SNAPSHOT_DUTY, axis) as i32), period), period)
        }))
    }
}

/// The share of the PWM period in which an H-bridge drives, with its direction.
fn share(pwm: Modulation, period: u16) -> f64 {
    let share = if period == 0 { 0.0 } else { f64::from(pwm.compare) / f64::from(period) };
    if pwm.reverse { -share } else { share }
}

/// What stands for the FPGA.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Kind {
    /// The bit-true model.
    #[default]
    BitTrue,
    /// The rust-hdl simulation.
    RustHdl,
    /// Compiled Verilog.
    Verilog,
    /// The circuit of the committed bitstream.
    Bitstream,
}

impl Kind {
    /// From the fastest to the one nearest to the card.
    pub const ALL: [Self; 4] = [Self::BitTrue, Self::RustHdl, Self::Verilog, Self::Bitstream];

    /// A new FPGA of this kind, just configured.
    ///
    /// # Errors
    /// A missing tool, by the name of its package.
    pub fn open(self) -> Result<Box<dyn Fpga>, FpgaError> {
        Ok(match self {
            Self::BitTrue => Box::new(BitTrue::new()),
            Self::RustHdl => Box::new(RustHdl::new()),
            Self::Verilog => Box::new(Verilog::new()?),
            Self::Bitstream => Box::new(Decoded::new()?),
        })
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::BitTrue => "bit-true",
            Self::RustHdl => "rust-hdl",
            Self::Verilog => "verilog",
            Self::Bitstream => "bitstream",
        })
    }
}

impl FromStr for Kind {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        Self::ALL
            .into_iter()
            .find(|kind| kind.to_string() == text)
            .ok_or_else(|| format!("no FPGA is called '{text}'; choose bit-true, rust-hdl, verilog or bitstream"))
    }
}

/// Refuses a motion whose edges are closer than the filter lets pass.
fn check_motion(axis: usize, from: f64, to: f64, period: u32, quiet: u32, filter: u8) -> Result<(), FpgaError> {
    let counts = (to - from).abs();
    let span = f64::from(period.saturating_sub(quiet).max(1));
    if counts.is_finite() && counts * f64::from(u32::from(filter) + 2) <= span {
        return Ok(());
    }
    Err(FpgaError::TooFast { axis: axis + 1, counts, period })
}
