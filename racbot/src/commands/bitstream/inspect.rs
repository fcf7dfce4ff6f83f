//! `racbot bitstream inspect`

use super::{decoded, wrong};
use crate::terminal::{Answer, Failure, Table};
use bitstream::report::Report;
use clap::Args;
use std::fmt::Write;
use std::path::PathBuf;

/// Options of `bitstream inspect`.
#[derive(Args, Debug)]
pub(crate) struct Options {
    /// Bitstream: .bit, or a PROM file without header
    #[arg(value_name = "FILE")]
    bitstream: PathBuf,
}

impl Options {
    pub(crate) fn run(&self) -> Result<Answer, Failure> {
        let report = decoded(&self.bitstream)?.report;
        let json = serde_json::to_value(&report).map_err(Failure::data)?;
        let wrong = wrong(&self.bitstream, &report.faults);
        Ok(Answer { text: text(&report), json, wrong })
    }
}

fn text(report: &Report) -> String {
    let mut text = String::new();
    if let Some([design, part, date, time]) = &report.header {
        let _ = writeln!(text, "design     {design} for {part}, {date} {time}");
    }
    let order = if report.prom_order { ", in the order of bits of a PROM" } else { "" };
    let _ = writeln!(
        text,
        "bitstream  {} bytes{order}, {} packets, {} CRC words right, COR {:08x}, CTL {:08x}",
        report.bytes, report.packets, report.crc_checks, report.options, report.control
    );
    let _ = writeln!(
        text,
        "frames     {} bits set, {} unexplained, {} of those that are always set missing\n",
        report.ones, report.unexplained, report.absent
    );
    let mut used = Table::new(1, &["used", "number", "of", "%"]);
    for (name, number, of) in report.used.iter().filter(|(_, number, _)| *number > 0) {
        let share = if *of > 0 { format!("{:.0}", 100.0 * *number as f64 / *of as f64) } else { String::new() };
        let of = if *of > 0 { of.to_string() } else { String::new() };
        used.row([(*name).to_owned(), number.to_string(), of, share]);
    }
    text.push_str(&used.render());
    text.push('\n');
    let mut pads = Table::new(6, &["pin", "direction", "standard", "slew", "pull", "registers"]);
    for pad in &report.pads {
        let pin = format!("P{}", pad.pin);
        let cells = [pin, pad.direction.into(), pad.standard.clone(), pad.slew.into(), pad.pull.into()];
        pads.row(cells.into_iter().chain([pad.registers.clone()]));
    }
    text.push_str(&pads.render());
    text
}
