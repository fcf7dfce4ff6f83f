//! Options about the FPGA.

use crate::terminal::Failure;
use clap::ValueEnum;
use fixed_kin::speed::SpeedMode;
use simulator::fpga::{Fpga, Kind};

/// What computes behind the card's registers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum FpgaChoice {
    /// The bit-true model in fixed-point arithmetic: fast, needs nothing
    #[default]
    BitTrue,
    /// The rust-hdl description, simulated clock by clock: slow, needs nothing
    RustHdl,
    /// The emitted Verilog, compiled: needs Verilator
    Verilog,
    /// The circuit decoded from the committed bitstream: slow, needs nothing
    Bitstream,
}

impl FpgaChoice {
    pub(crate) fn kind(self) -> Kind {
        match self {
            Self::BitTrue => Kind::BitTrue,
            Self::RustHdl => Kind::RustHdl,
            Self::Verilog => Kind::Verilog,
            Self::Bitstream => Kind::Bitstream,
        }
    }

    /// A new FPGA, just configured.
    pub(crate) fn open(self) -> Result<Box<dyn Fpga>, Failure> {
        self.kind().open().map_err(Failure::data)
    }
}

/// How the FPGA measures speeds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum SpeedChoice {
    /// Count difference of a control tick; the log then tells all the FPGA knew
    #[default]
    Difference,
    /// Counts between edges over the time between them: smooth at low speed
    CountAndTime,
}

impl From<SpeedChoice> for SpeedMode {
    fn from(choice: SpeedChoice) -> Self {
        match choice {
            SpeedChoice::Difference => Self::Difference,
            SpeedChoice::CountAndTime => Self::CountAndTime,
        }
    }
}
