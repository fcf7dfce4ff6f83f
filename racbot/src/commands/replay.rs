//! `racbot replay`

use super::fpga_options::FpgaChoice;
use crate::terminal::progress::Progress;
use crate::terminal::{Answer, Failure, Table, Target};
use clap::Args;
use runs::robot::Robot;
use runs::{DataSet, Run};
use serde_json::{Value, json};
use simulator::fpga::Kind;
use simulator::replay::picture::duties;
use simulator::replay::{Deviation, Part, Replayed, WheelAgreement, lsb, replay};
use std::fmt::Write as _;
use std::path::PathBuf;
use std::time::Instant;

/// Options of `replay`.
#[derive(Args, Debug)]
pub(crate) struct Options {
    /// Folder with robot.toml and runs (*.csv)
    #[arg(value_name = "DATASET")]
    data_set: PathBuf,

    /// Another robot.toml than the data set's own
    #[arg(long, value_name = "FILE")]
    robot: Option<PathBuf>,

    /// FPGA to feed the logs through
    #[arg(long, value_enum, default_value_t)]
    fpga: FpgaChoice,

    /// First tick of every run
    #[arg(long, value_name = "TICK", default_value_t = 0)]
    from: usize,

    /// Ticks of every run [default: all; 2000 on verilog, 20 on rust-hdl]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    ticks: Option<u32>,

    /// Folder for a picture of every run
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,

    #[command(flatten)]
    target: Target,
}

impl Options {
    pub(crate) fn run(&self) -> Result<Answer, Failure> {
        let set = match &self.robot {
            None => DataSet::open(&self.data_set)?,
            Some(file) => DataSet::open_as(&self.data_set, Robot::load(file)?)?,
        };
        let part = Part { from: self.from, ticks: self.ticks() };
        let mut results = Vec::new();
        let begun = Instant::now();
        for run in &set.runs {
            results.push(self.replay(&set, run, part)?);
        }
        let seconds = begun.elapsed().as_secs_f64();
        let mut text = self.text(&set.robot, &results, seconds);
        if let Some(out) = &self.out {
            for (run, replayed) in set.runs.iter().zip(&results).filter(|(_, r)| r.skipped.is_none()) {
                for wheel in 0..replayed.wheels.len() {
                    let path = out.join(format!("{}-wheel-{}.svg", run.name, wheel + 1));
                    self.target.save(&path, &duties(run, replayed, wheel))?;
                }
            }
            let _ = writeln!(text, "\nwritten: a picture of every run and wheel in {}", out.display());
        }
        let runs: Vec<Value> = results.iter().map(to_json).collect();
        let json = json!({
            "fpga": self.fpga.kind().to_string(),
            "duty_lsb": 2_f64.powi(-24),
            "runs": runs,
            "seconds": seconds,
        });
        Ok(Answer { text, json, wrong: None })
    }

    fn ticks(&self) -> Option<usize> {
        self.ticks.map(|ticks| ticks as usize).or(match self.fpga.kind() {
            Kind::BitTrue => None,
            Kind::Verilog => Some(2_000),
            Kind::Bitstream => Some(200),
            Kind::RustHdl => Some(20),
        })
    }

    fn replay(&self, set: &DataSet, run: &Run, part: Part) -> Result<Replayed, Failure> {
        let left = run.len().saturating_sub(part.from);
        let ticks = part.ticks.map_or(left, |ticks| ticks.min(left));
        let progress = Progress::new(format!("{} through {}", run.name, self.fpga.kind()), ticks as u64);
        let at = |done: usize| progress.at(done as u64);
        replay(self.fpga.open()?, &set.robot, run, part, at)
            .map_err(|error| Failure::about(&self.data_set, format!("{}: {error}", run.name)))
    }

    fn text(&self, robot: &Robot, results: &[Replayed], seconds: f64) -> String {
        let mut text = format!("{} through the {} FPGA\n", self.data_set.display(), self.fpga.kind());
        let quantum = results.iter().map(|r| r.quantum).fold(0.0, f64::max);
        let _ = writeln!(text, "duties logged to {}; 1 LSB of the FPGA is 2^-24 = 6.0e-8\n", rounded(quantum));
        text += &table(results).render();
        for remark in results.iter().filter_map(|r| remark(r).map(|what| format!("{}: {what}\n", r.name))) {
            text += &remark;
        }
        for skipped in results.iter().filter_map(|r| r.skipped.as_ref().map(|why| format!("{}: {why}\n", r.name))) {
            text += &skipped;
        }
        text += "\nmax, RMS   FPGA against the log, as duty and in LSB of the FPGA\n";
        text += "beyond     ticks with more than half of the log's rounding between them\n";
        let law: usize = results.iter().flat_map(|r| &r.wheels).map(|w| w.law.beyond).sum();
        let _ = writeln!(text, "law        robot.toml's law in floating point against the log; {law} beyond");
        text += "FPGA-law   what the FPGA's arithmetic adds, at most\n";
        if was_count_and_time(robot) {
            text += "The log was made with speeds by count and time, which counts alone do not tell;\n";
            text += "log with --speed-mode difference to compare bit for bit.\n";
        }
        let ticks: usize = results.iter().map(|r| r.ticks).sum();
        let _ = writeln!(text, "took       {seconds:.2} s for {ticks} ticks");
        text
    }
}

/// What is to be said of a run that is not whole.
fn remark(replayed: &Replayed) -> Option<String> {
    let gaps = replayed.gaps.words().map(|gaps| format!("{gaps}; after each the duties tell the integrators"));
    let telling = (replayed.telling > 0).then(|| format!("{} rows only tell them", replayed.telling));
    let off = (replayed.off > 0).then(|| format!("outputs off on {} rows", replayed.off));
    let parts: Vec<String> = gaps.into_iter().chain(telling).chain(off).collect();
    (!parts.is_empty()).then(|| parts.join("; "))
}

/// Whether the FPGA that made the log had measured speeds in another way.
fn was_count_and_time(robot: &Robot) -> bool {
    robot.pi.registers.iter().any(|(name, word)| name == "count_and_time" && *word == 1)
}

/// One row a wheel, and one for all together.
fn table(results: &[Replayed]) -> Table {
    let headings = ["run", "w", "ticks", "max", "LSB", "RMS", "LSB", "beyond", "law max", "FPGA-law"];
    let mut table = Table::new(1, &headings);
    let mut all = WheelAgreement::default();
    for replayed in results {
        for (wheel, agreement) in replayed.wheels.iter().enumerate() {
            all = all.with(*agreement);
            table.row(row(&replayed.name, &(wheel + 1).to_string(), agreement));
        }
    }
    table.row(row("all", "", &all));
    table
}

fn row(run: &str, wheel: &str, agreement: &WheelAgreement) -> [String; 10] {
    let WheelAgreement { fpga, law, arithmetic } = agreement;
    let compared = fpga.ticks > 0;
    let or_dash = |text: String| if compared { text } else { "-".to_owned() };
    [
        run.to_owned(),
        wheel.to_owned(),
        arithmetic.ticks.to_string(),
        or_dash(format!("{:.6}", fpga.max)),
        or_dash(format!("{:.0}", lsb(fpga.max))),
        or_dash(format!("{:.6}", fpga.rms())),
        or_dash(format!("{:.0}", lsb(fpga.rms()))),
        or_dash(fpga.beyond.to_string()),
        or_dash(format!("{:.6}", law.max)),
        format!("{:.0} LSB", lsb(arithmetic.max)),
    ]
}

/// A quantum as people write it.
fn rounded(quantum: f64) -> String {
    if quantum >= 1e-6 { format!("{quantum}") } else { format!("{quantum:.1e}") }
}

fn to_json(replayed: &Replayed) -> Value {
    let deviation = |d: &Deviation| {
        json!({
            "ticks": d.ticks, "max": d.max, "max_lsb": lsb(d.max), "at_tick": d.at,
            "rms": d.rms(), "rms_lsb": lsb(d.rms()), "beyond": d.beyond,
        })
    };
    let wheels: Vec<Value> = replayed
        .wheels
        .iter()
        .map(|w| {
            json!({
                "fpga_against_log": deviation(&w.fpga),
                "law_against_log": deviation(&w.law),
                "fpga_against_law": deviation(&w.arithmetic),
            })
        })
        .collect();
    json!({
        "run": replayed.name, "from": replayed.from, "ticks": replayed.ticks,
        "gaps": replayed.gaps.pauses, "missing_ticks": replayed.gaps.missing, "counter_resets": replayed.gaps.resets,
        "rows_that_only_tell": replayed.telling, "rows_off": replayed.off,
        "duty_quantum": replayed.quantum, "skipped": replayed.skipped, "wheels": wheels,
    })
}
