//! `racbot demo`

use crate::demo::{Part, Report};
use crate::terminal::{Answer, Failure, Table, Target};
use clap::Args;
use serde_json::{Value, json};
use std::path::PathBuf;
use std::time::Instant;

/// Options of `demo`.
#[derive(Args, Clone, Debug)]
pub(crate) struct Options {
    /// Folder for the report [default: out/demo, or the first free of out/demo-2 ...]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,

    #[command(flatten)]
    target: Target,

    /// Folder of the committed gateware, to check where it exists
    #[arg(long, value_name = "DIR", default_value = GENERATED)]
    generated: PathBuf,

    /// Control ticks to simulate in rust-hdl, clock by clock, of each of two drives
    #[arg(long, value_name = "N", default_value_t = TICKS, value_parser = clap::value_parser!(u32).range(1..=100_000))]
    ticks: u32,
}

const TICKS: u32 = 12;
const OUT: &str = "out/demo";
const GENERATED: &str = "generated";

impl Default for Options {
    fn default() -> Self {
        Self { out: None, target: Target::default(), generated: GENERATED.into(), ticks: TICKS }
    }
}

impl Options {
    pub(crate) fn run(&self) -> Result<Answer, Failure> {
        let begun = Instant::now();
        let (target, out) = (self.target, self.target.place(self.out.as_deref(), OUT));
        target.check_free([out.join("index.html"), out.join("board/runs/run_01.csv")])?;
        let mut report = Report::default();
        report.check_generated(&self.generated)?;
        report.board(&out.join("board"), target.existing())?;
        report.drive()?;
        report.cross_check(self.ticks)?;
        report.replay()?;
        let index = out.join("index.html");
        for (name, content) in report.files() {
            target.save(&out.join(name), &content)?;
        }
        let seconds = begun.elapsed().as_secs_f64();
        let parts = &report.parts;
        let text = format!("{}\nreport   {}\ntook     {seconds:.1} s\n", table(parts).render(), index.display());
        let wrong = parts.iter().find(|part| !part.good).map(|part| format!("demo: {}: {}", part.name, part.outcome));
        let parts: Vec<Value> = parts.iter().map(Part::to_json).collect();
        let json =
            json!({ "parts": parts, "report": index.to_string_lossy(), "seconds": seconds, "good": wrong.is_none() });
        Ok(Answer { text, json, wrong })
    }
}

fn table(parts: &[Part]) -> Table {
    let mut table = Table::new(3, &["part", "result", ""]);
    for part in parts {
        for (row, detail) in part.details.iter().enumerate() {
            let name = if row == 0 { part.name } else { "" };
            let mark = match (row, part.good) {
                (0, true) => "ok",
                (0, false) => "WRONG",
                _ => "",
            };
            table.row([name.to_owned(), detail.clone(), mark.to_owned()]);
        }
    }
    table
}
