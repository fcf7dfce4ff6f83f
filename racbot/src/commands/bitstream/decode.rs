//! `racbot bitstream decode`

use super::{decoded, wrong};
use crate::terminal::{Answer, Failure, Target};
use bitstream::verilog::emit;
use clap::Args;
use serde_json::json;
use std::path::PathBuf;

/// Options of `bitstream decode`.
#[derive(Args, Debug)]
pub(crate) struct Options {
    /// Bitstream: .bit, or a PROM file without header
    #[arg(value_name = "FILE")]
    bitstream: PathBuf,

    /// Verilog file to write
    #[arg(long, value_name = "OUT")]
    verilog: PathBuf,

    /// Name of the module
    #[arg(long, value_name = "NAME", default_value = "fpga", value_parser = module)]
    module: String,

    #[command(flatten)]
    target: Target,
}

fn module(text: &str) -> Result<String, String> {
    let letter = |c: char| c.is_ascii_alphabetic() || c == '_';
    let fits = text.chars().next().is_some_and(letter) && text.chars().all(|c| letter(c) || c.is_ascii_digit());
    if fits { Ok(text.to_owned()) } else { Err(format!("'{text}' is no name of a Verilog module")) }
}

impl Options {
    pub(crate) fn run(&self) -> Result<Answer, Failure> {
        Target::check_apart([&self.bitstream], [&self.verilog])?;
        self.target.check_free([&self.verilog])?;
        let decoded = decoded(&self.bitstream)?;
        let report = &decoded.report;
        let Some(netlist) = &decoded.netlist else {
            return Err(Failure::data(wrong(&self.bitstream, &report.faults).unwrap_or_default()));
        };
        self.target.save(&self.verilog, &emit(netlist, &self.module))?;
        let text = format!(
            "{}: module {}, {} cells, {} nets, {} pads\n",
            self.verilog.display(),
            self.module,
            netlist.cells.len(),
            netlist.nets.len(),
            netlist.pads.len()
        );
        let json = json!({
            "file": self.bitstream.to_string_lossy(), "verilog": self.verilog.to_string_lossy(), "module": self.module,
            "cells": netlist.cells.len(),
            "nets": netlist.nets.len(), "pads": netlist.pads.len(),
        });
        Ok(Answer { text, json, wrong: wrong(&self.bitstream, &report.faults) })
    }
}
