//! `racbot bitstream`

mod build;
mod decode;
mod inspect;

use crate::terminal::{Answer, Failure};
use bitstream::container::Bitstream;
use bitstream::device::Device;
use bitstream::report::Decoded;
use clap::{Args, Subcommand};
use std::path::Path;

/// Options of `bitstream`.
#[derive(Args, Debug)]
pub(crate) struct Options {
    #[command(subcommand)]
    what: What,
}

#[derive(Debug, Subcommand)]
enum What {
    /// Make a bitstream of the gateware with open tools only: yosys, then pack, place and route
    Build(build::Options),
    /// Turn a bitstream back into its circuit, as Verilog that simulates
    Decode(decode::Options),
    /// Show what a bitstream is, what it uses and how its pads are set
    Inspect(inspect::Options),
}

impl Options {
    pub(crate) fn run(&self) -> Result<Answer, Failure> {
        match &self.what {
            What::Build(options) => options.run(),
            What::Decode(options) => options.run(),
            What::Inspect(options) => options.run(),
        }
    }
}

/// Reads a file and decodes it.
fn decoded(file: &Path) -> Result<Decoded, Failure> {
    let bitstream = Bitstream::open(file).map_err(Failure::data)?;
    Decoded::new(Device::xc2s200(), &bitstream).map_err(|error| Failure::about(file, error))
}

/// Why a bitstream is no circuit, if it is none.
fn wrong(file: &Path, faults: &[String]) -> Option<String> {
    const SHOWN: usize = 10;
    let first = faults.iter().take(SHOWN).map(|fault| format!("\n  {fault}")).collect::<String>();
    let more = match faults.len() {
        0 => return None,
        count if count > SHOWN => format!("\n  and {} more", count - SHOWN),
        _ => String::new(),
    };
    Some(format!("{}: the frames are whole, but make no circuit:{first}{more}", file.display()))
}
