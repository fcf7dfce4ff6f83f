//! Hides effects in simulated logs, lets the gap workflow look for them, and prints how often it is right.

use std::process::ExitCode;
use std::time::Duration;

use clap::Parser;
use indicatif::{ProgressBar, ProgressStyle};
use testbench::blind::{self, BlindError, Plan, Series};

/// Blind bench of the gap workflow.
#[derive(Debug, Parser)]
#[command(name = "blind", version, about)]
struct Args {
    /// Sets that hide nothing
    #[arg(long, default_value_t = 0)]
    effect_free: usize,
    /// Sets of every effect at every size
    #[arg(long, default_value_t = 0)]
    single: usize,
    /// Sizes of the single effects
    #[arg(long, value_delimiter = ',', default_value = "1,2,3,4,5", value_parser = clap::value_parser!(u8).range(1..=5))]
    sizes: Vec<u8>,
    /// Single effects to be hidden [default: all]
    #[arg(long, value_delimiter = ',', value_parser = known)]
    only: Vec<String>,
    /// Sets with two effects
    #[arg(long, default_value_t = 0)]
    pairs: usize,
    /// Sizes of both effects of a pair, in turn [default: each drawn, 2 to 5]
    #[arg(long, value_delimiter = ',', value_parser = clap::value_parser!(u8).range(1..=5))]
    pair_sizes: Vec<u8>,
    /// Sets with an effect that no catalogue lists
    #[arg(long, default_value_t = 0)]
    outside: usize,
    /// Sets with one effect and no rotation
    #[arg(long, default_value_t = 0)]
    translations_only: usize,
    /// Sets with data or truth spoiled on purpose: a right answer is a fault
    #[arg(long, default_value_t = 0)]
    ablations: usize,
    /// Motors and drive trains of any size that hide nothing
    #[arg(long, default_value_t = 0)]
    axes_free: usize,
    /// Motors and drive trains of any size with every effect at every size
    #[arg(long, default_value_t = 0)]
    axes: usize,
    /// Motors and drive trains of any size with two effects
    #[arg(long, default_value_t = 0)]
    axis_pairs: usize,
    /// Begin no set after this many minutes
    #[arg(long)]
    minutes: Option<f64>,
    /// File to which every score is added as soon as it is known; what it holds already is not tried again
    #[arg(long, value_name = "FILE")]
    scores: Option<std::path::PathBuf>,
    /// Sets at a time; 0 = one a core
    #[arg(long, default_value_t = 0)]
    workers: usize,
    /// Seed of the whole series
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Write the table to docs/measured/blind.md, too; to blind-axes.md where there are axes alone
    #[arg(long)]
    measured: bool,
    /// JSON instead of the table
    #[arg(long)]
    json: bool,
}

fn known(name: &str) -> Result<String, String> {
    if truth::axis::names().any(|known| known == name) {
        return Ok(name.to_owned());
    }
    truth::find(name).map(|e| e.name.to_owned()).map_err(|e| e.to_string())
}

fn main() -> ExitCode {
    match run(Args::parse()) {
        Ok(code) => code,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::from(1)
        }
    }
}

fn run(args: Args) -> Result<ExitCode, BlindError> {
    let plan = Plan {
        effect_free: args.effect_free,
        single: args.single,
        sizes: args.sizes,
        only: args.only,
        pairs: args.pairs,
        pair_sizes: args.pair_sizes,
        outside: args.outside,
        translations_only: args.translations_only,
        ablations: args.ablations,
        axes_free: args.axes_free,
        axes: args.axes,
        axis_pairs: args.axis_pairs,
        ..Plan::new(args.seed)
    };
    let sets = plan.tasks().len();
    if sets == 0 {
        eprintln!("error: nothing to do; try --effect-free 20 --single 1");
        return Ok(ExitCode::from(2));
    }
    // indicatif draws nothing where standard error is no terminal.
    let style = ProgressStyle::with_template("{pos:>5} of {len} sets [{bar:30}] {percent:>3} % {eta:>4}");
    let bar = ProgressBar::new(sets as u64)
        .with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()).progress_chars("=> "));
    let series = Series {
        budget: args.minutes.map(|m| Duration::from_secs_f64(60.0 * m.max(0.0))),
        scores: args.scores,
        workers: args.workers,
    };
    let report = blind::run(&plan, &series, |done| bar.set_position(done as u64))?;
    bar.finish_and_clear();
    if args.measured {
        // Where the scores are kept is no part of what was measured.
        let mut given = std::env::args().skip(1);
        let mut command = Vec::new();
        while let Some(argument) = given.next() {
            match argument.as_str() {
                "--scores" => drop(given.next()),
                "--measured" => {}
                _ => command.push(argument),
            }
        }
        report.measured(&command.join(" "));
    }
    if args.json {
        println!("{:#}", report.to_json());
    } else {
        print!("{}", report.table());
    }
    Ok(ExitCode::SUCCESS)
}
