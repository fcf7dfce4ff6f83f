//! `racbot bitstream build`

use crate::terminal::progress::Progress as Bar;
use crate::terminal::{Answer, Failure, Table, Target};
use bitstream::flow::timing::{DomainReport, TimedPath};
use bitstream::flow::{Built, Progress, SLICES, Stage, floorplan, synthesis};
use clap::Args;
use hdl::design::{COMMITTED_VERILOG, NAME};
use serde_json::{Value, json};
use simulator::gateware::{self, SEED};
use std::path::PathBuf;

/// Options of `bitstream build`.
#[derive(Args, Debug)]
pub(crate) struct Options {
    /// Seed of the placement; another seed gives another, equally valid bitstream
    #[arg(long, value_name = "N", default_value_t = SEED)]
    seed: u64,

    /// File to write
    #[arg(long, value_name = "FILE", default_value = "generated/rac4i65.bit")]
    out: PathBuf,

    /// Write nothing; fail if FILE is not what would be written
    #[arg(long)]
    check: bool,

    /// Also write a floor plan, an SVG picture
    #[arg(long, value_name = "FILE")]
    floor_plan: Option<PathBuf>,

    /// Also write where every net is driven: net, place, element, pin, flip-flop, with tabs between
    #[arg(long, value_name = "FILE")]
    drivers: Option<PathBuf>,

    /// Also write the netlist that it was made from, as yosys has it (JSON)
    #[arg(long, value_name = "FILE")]
    netlist: Option<PathBuf>,

    #[command(flatten)]
    target: Target,
}

impl Options {
    pub(crate) fn run(&self) -> Result<Answer, Failure> {
        let pictures = [&self.floor_plan, &self.drivers, &self.netlist];
        let written = (!self.check).then_some(&self.out).into_iter();
        self.target.check_free(written.chain(pictures.into_iter().flatten()))?;
        let bar = Bar::new("synthesis", 100);
        let mut tell = |stage: Stage, percent: u32, _: &str| {
            bar.rename(stage.name());
            bar.at(percent.into());
        };
        let mut progress = Progress::new(&mut tell);
        let about = |error| Failure::about(&std::env::temp_dir(), error);
        let folder = tempfile::Builder::new().prefix("racbot-bitstream-").tempdir().map_err(about)?;
        let json =
            synthesis::synthesise(COMMITTED_VERILOG, NAME, folder.path(), &mut progress).map_err(Failure::data)?;
        drop(folder);
        let (built, file) = gateware::bitstream(&json, self.seed, &mut progress).map_err(Failure::data)?;
        drop(bar);
        let proof = &built.proof;
        let mut wrong = proof.differences.first().map(|first| {
            format!("{} parts are not proven equal to the netlist, the first: {first}", proof.differences.len())
        });
        if self.check {
            let found = std::fs::read(&self.out).map_err(|error| Failure::about(&self.out, error))?;
            if found != file {
                wrong = Some(format!(
                    "{}: is not what the gateware makes; run racbot bitstream build --force --out {}",
                    self.out.display(),
                    self.out.display()
                ));
            }
        } else {
            self.target.save(&self.out, &file)?;
        }
        if let Some(path) = &self.floor_plan {
            self.target.save(path, &floorplan::svg(&built))?;
        }
        if let Some(path) = &self.drivers {
            let lines = built.drivers.iter().map(|driver| {
                let (x, y) = driver.at;
                let cell = driver.flip_flop.as_deref().unwrap_or("");
                format!("{}\tX{x}Y{y}\t{}\t{}\t{cell}\n", driver.net, driver.element, driver.pin)
            });
            self.target.save(path, &lines.collect::<String>())?;
        }
        if let Some(path) = &self.netlist {
            self.target.save(path, &json)?;
        }
        Ok(Answer { text: text(&built, file.len()), json: report(&built, file.len(), self.seed), wrong })
    }
}

fn text(built: &Built, bytes: usize) -> String {
    let used = &built.resources;
    let mut table = Table::new(1, &["part", "used", "of"]);
    for (name, number, of) in [
        ("slices", used.slices, SLICES),
        ("tables", used.tables, 2 * SLICES),
        ("flip-flops", used.flip_flops, 2 * SLICES),
        ("carries", used.carries, 2 * SLICES),
        ("block memories", used.memories, 14),
        ("pads", used.pads, 144),
    ] {
        table.row([name.to_owned(), number.to_string(), of.to_string()]);
    }
    let mut clocks = Table::new(2, &["clock", "between", "period ns", "path ns", "slack ns", "steps"]);
    let ns = |ps: i64| format!("{:.2}", ps as f64 / 1e3);
    for domain in &built.timing.domains {
        for (row, (between, path)) in domain.told().enumerate() {
            let port = if row == 0 { domain.port.clone() } else { String::new() };
            let (delay, steps) = (ns(path.delay.into()), path.steps.len().to_string());
            clocks.row([port, between.to_owned(), ns(domain.period.into()), delay, ns(path.slack()), steps]);
        }
    }
    format!(
        "{}\n{} nets on {} wires, legal after {} rounds\nat most {} pass gates in series and {} wires joined by them\n\n\
         decoded and proven equal to the netlist of yosys: {} flip-flops, {} memories, {} pads,\n\
         {} functions for all {} rows of their tables; {} flip-flops reach no pad\n\n\
         {}\nDelays of logic: data sheet DS001-3, speed grade -5. Delays of wires: a model\n\
         that files known to run bound; never measured, never tried on silicon.\n{bytes} bytes\n",
        table.render(),
        used.nets,
        used.wires,
        used.rounds,
        built.extremes.gates,
        built.extremes.joined,
        built.proof.flip_flops,
        built.proof.memories,
        built.proof.pads,
        built.proof.functions,
        built.proof.rows,
        built.proof.unobservable.len(),
        clocks.render(),
    )
}

fn report(built: &Built, bytes: usize, seed: u64) -> Value {
    let used = &built.resources;
    let clock = |domain: &DomainReport| {
        let told = |path: &TimedPath| {
            let steps = path.steps.iter().map(|step| {
                let net = step.net.map_or("(carry)", |net| &built.logic.nets[net.index()]);
                json!({ "net": net, "driven_ps": step.driven, "wire_ps": step.wire })
            });
            let steps: Vec<Value> = steps.collect();
            json!({ "delay_ps": path.delay, "due_ps": path.due, "slack_ps": path.slack(), "steps": steps })
        };
        let worst: Vec<Value> = domain.worst.iter().map(told).collect();
        json!({
            "port": domain.port, "period_ps": domain.period, "slowest_inside": domain.inside.as_ref().map(told), "worst": worst,
        })
    };
    json!({
        "bytes": bytes,
        "seed": seed,
        "used": {
            "slices": used.slices, "tables": used.tables, "flip_flops": used.flip_flops, "carries": used.carries,
            "memories": used.memories, "pads": used.pads, "nets": used.nets, "wires": used.wires,
        },
        "rounds": used.rounds,
        "gates_in_series": built.extremes.gates,
        "wires_joined": built.extremes.joined,
        "clocks": built.timing.domains.iter().map(clock).collect::<Vec<_>>(),
        "proof": {
            "differences": built.proof.differences,
            "flip_flops": built.proof.flip_flops, "memories": built.proof.memories, "pads": built.proof.pads,
            "functions": built.proof.functions, "rows": built.proof.rows, "unobservable": built.proof.unobservable,
        },
        "yosys": synthesis::version(),
    })
}
