//! `racbot load`

use crate::card::CardOptions;
use crate::terminal::{Answer, Failure, entry};
use clap::Args;
use driver::bitstream::{Bitstream, Order};
use driver::design::content_hash;
use driver::load::{Loaded, load};
use driver::pci::Use;
use serde_json::json;
use std::path::PathBuf;
use std::time::Duration;

/// Options of `load`.
#[derive(Args, Debug)]
pub(crate) struct Options {
    /// Bitstream: .bit, or a PROM file without header; the built-in card has its own
    #[arg(value_name = "FILE")]
    bitstream: Option<PathBuf>,

    #[command(flatten)]
    card: CardOptions,

    /// Load even where the right design runs already
    #[arg(long)]
    force: bool,

    /// Hash the design must answer with, in hexadecimal; without it that of the committed gateware
    #[arg(long, value_name = "HASH", value_parser = hash)]
    hash: Option<u32>,

    /// Check the file and stop; touch no card
    #[arg(long)]
    check: bool,

    /// Tries before giving up
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = clap::value_parser!(u32).range(1..=10))]
    tries: u32,
}

fn hash(text: &str) -> Result<u32, String> {
    let digits = text.trim_start_matches("0x");
    u32::from_str_radix(digits, 16).map_err(|_| format!("'{text}' is no hash: eight hexadecimal digits, as 64136e1e"))
}

impl Options {
    pub(crate) fn run(&self) -> Result<Answer, Failure> {
        // The file first: a bad one must not touch a card.
        let file = self.bitstream.as_deref().map(Bitstream::open).transpose().map_err(Failure::data)?;
        if self.check {
            let Some(file) = &file else { return Err(Failure::usage("--check needs a FILE")) };
            return Ok(Answer { text: self.describe(file), json: self.file_json(file), wrong: None });
        }
        let bitstream = match file {
            Some(file) => file,
            None => self.built_in()?,
        };
        let mut open = self.card.open(Use::Drive)?;
        let expected = self.hash.unwrap_or_else(content_hash);
        let options = driver::load::Options {
            force: self.force,
            content_hash: Some(expected),
            tries: self.tries,
            clock_time: Duration::from_millis(50),
        };
        let loaded = load(&mut open.card, &bitstream, &options, |_| {})
            .map_err(|error| Failure::data(format!("{}: {error}", open.name)))?;
        let text = format!("card     {}, Mesa 4I65\n{}{}", open.name, self.describe(&bitstream), done(&loaded));
        let identity = loaded.identity;
        let json = json!({
            "card": open.name, "file": self.file_json(&bitstream), "kept": loaded.kept, "tries": loaded.tries,
            "transfer_s": loaded.transfer.as_secs_f64(), "ready_enabled": loaded.ready_enabled,
            "content_hash": format!("{:08x}", identity.content_hash), "map_version": identity.version,
            "axes": identity.axes, "clock_hz": loaded.clock_hz,
        });
        Ok(Answer { text, json, wrong: None })
    }

    fn built_in(&self) -> Result<Bitstream, Failure> {
        #[cfg(feature = "simulation")]
        if self.card.is_built_in() {
            return Ok(simulator::circuit::committed());
        }
        Err(Failure::usage("which FILE is to be loaded?"))
    }

    fn describe(&self, bitstream: &Bitstream) -> String {
        let name =
            self.bitstream.as_ref().map_or("generated/rac4i65.bit, built in".to_owned(), |p| p.display().to_string());
        let what = match (&bitstream.header, bitstream.order) {
            (Some(header), _) => format!("{} for {}, {} {}", header.design, header.part, header.date, header.time),
            (None, Order::Prom) => "PROM order, no header".to_owned(),
            (None, Order::Bit) => "no header".to_owned(),
        };
        let summary = &bitstream.summary;
        let checked = format!(
            "{} bytes, {} packets, {} CRC words right",
            bitstream.lanes().len(),
            summary.packets,
            summary.crc_checks
        );
        entry("file", &name) + &entry("says", &what) + &entry("checked", &checked)
    }

    fn file_json(&self, bitstream: &Bitstream) -> serde_json::Value {
        let header = bitstream.header.as_ref();
        json!({
            "file": self.bitstream.as_ref().map(|file| file.to_string_lossy()), "design": header.map(|h| &h.design), "part": header.map(|h| &h.part),
            "date": header.map(|h| &h.date), "time": header.map(|h| &h.time), "bytes": bitstream.lanes().len(),
            "prom_order": bitstream.order == Order::Prom, "packets": bitstream.summary.packets,
            "crc_checks": bitstream.summary.crc_checks,
        })
    }
}

fn done(loaded: &Loaded) -> String {
    let how = if loaded.kept {
        "kept, the right design runs already (--force loads anyway)".to_owned()
    } else {
        let ready = if loaded.ready_enabled > 0 { ", READY# switched on" } else { "" };
        format!("in {:.3} s, try {}{ready}", loaded.transfer.as_secs_f64(), loaded.tries)
    };
    format!("loaded   {how}\n{}", design(&loaded.identity, loaded.clock_hz))
}

/// What runs, in two lines.
pub(super) fn design(identity: &driver::Identity, clock_hz: f64) -> String {
    let committed = if identity.content_hash == content_hash() { ", the committed gateware" } else { "" };
    let (major, minor) = (identity.version >> 16, identity.version & 0xFFFF);
    format!(
        "design   hash {:08x}{committed}, map {major}.{minor}, {} axes\nclock    {:.4} MHz measured, {:.4} nominal\n",
        identity.content_hash,
        identity.axes,
        clock_hz / 1e6,
        f64::from(identity.clock_hz) / 1e6
    )
}
