//! `racbot bitstream`

mod build;

use crate::terminal::{Answer, Failure};
use clap::{Args, Subcommand};

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
}

impl Options {
    pub(crate) fn run(&self) -> Result<Answer, Failure> {
        match &self.what {
            What::Build(options) => options.run(),
        }
    }
}
