//! Writes data sets with hidden effects under opaque names, and their truth into a separate file.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{Parser, ValueEnum};
use serde::Serialize;
use truth::{Conditions, Error, Kind, Truth};

/// Columns that a log may lack.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Group {
    /// cam_x, cam_y, cam_theta
    Camera,
    /// duty_1 ...
    Duty,
    /// cmd_vx, cmd_vy, cmd_w
    Commands,
}

/// Data sets of a simulated robot in which effects are hidden.
#[derive(Debug, Parser)]
#[command(name = "truth", version, about)]
struct Args {
    /// Folder for the sets, set-0001 and so on
    #[arg(long, required_unless_present = "list")]
    out: Option<PathBuf>,
    /// How many sets
    #[arg(long, default_value_t = 1)]
    count: u32,
    /// Seed of the whole series
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Seed of one set, as scores of the blind bench give it, in place of a series
    #[arg(long, conflicts_with = "count")]
    set: Option<u64>,
    /// effect-free, single[:EFFECT[:SIZE]], pair[:A+B[:SIZE]], look-alike[:SIZE], outside[:NAME[:SIZE]],
    /// ablation[:NAME], mixed, or axis[:A[+B][:SIZE]], a motor of any size; several take turns
    #[arg(long, value_parser = |text: &str| text.parse::<Kind>().map_err(|e| e.to_string()))]
    kind: Vec<Kind>,
    /// Where the truth goes [default: truth-SEED.json in the folder of the sets, outside every set]
    #[arg(long)]
    truth: Option<PathBuf>,
    /// Control and log rate in Hz
    #[arg(long, default_value_t = 1000.0)]
    rate: f64,
    /// Runs without rotation
    #[arg(long)]
    translations_only: bool,
    /// Wheels off the floor
    #[arg(long)]
    blocks: bool,
    /// 3 or 4
    #[arg(long, default_value_t = 3)]
    wheels: usize,
    /// Columns to leave out
    #[arg(long, value_delimiter = ',')]
    without: Vec<Group>,
    /// Always the robot of the example sets
    #[arg(long)]
    standard_robot: bool,
    /// Add the columns of an inertial sensor
    #[arg(long)]
    inertial: bool,
    /// Prints every effect with its sizes and stops
    #[arg(long)]
    list: bool,
}

/// The truth file.
#[derive(Serialize)]
struct Sealed {
    seed: u64,
    units: &'static str,
    sets: Vec<SealedSet>,
}

#[derive(Serialize)]
struct SealedSet {
    set: String,
    #[serde(flatten)]
    truth: Truth,
}

fn main() -> ExitCode {
    match run(&Args::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::from(if matches!(error, Error::Conditions(_)) { 2 } else { 1 })
        }
    }
}

fn run(args: &Args) -> Result<(), Error> {
    if args.list {
        list();
        return Ok(());
    }
    let out = args.out.as_deref().unwrap_or(Path::new("."));
    let conditions = Conditions {
        rate_hz: args.rate,
        translations_only: args.translations_only,
        blocks: args.blocks,
        wheels: args.wheels,
        camera: !args.without.contains(&Group::Camera),
        duty: !args.without.contains(&Group::Duty),
        commands: !args.without.contains(&Group::Commands),
        standard_robot: args.standard_robot,
        inertial: args.inertial,
    };
    let kinds = if args.kind.is_empty() { vec![Kind::Mixed] } else { args.kind.clone() };
    let mut sets = Vec::new();
    for (index, kind) in (0..args.count).zip(kinds.iter().cycle()) {
        let set = format!("set-{:04}", index + 1);
        let seed = args.set.unwrap_or_else(|| truth::set_seed(args.seed, u64::from(index)));
        let truth = truth::make(seed, kind, &conditions, &out.join(&set))?;
        sets.push(SealedSet { set, truth });
    }
    let path = args.truth.clone().unwrap_or_else(|| out.join(format!("truth-{}.json", args.seed)));
    let sealed = Sealed { seed: args.seed, units: "SI, rad; wheels from 1; relative parameters as fractions", sets };
    std::fs::write(&path, serde_json::to_string_pretty(&sealed)? + "\n").map_err(|e| Error::File(path.clone(), e))?;
    println!("{} sets in {}, truth in {}", args.count, out.display(), path.display());
    Ok(())
}

fn list() {
    println!("{:<20} {:<10} sizes 1 to 5; what they are", "effect", "link");
    let show = |entry: &truth::Entry| {
        let sizes: Vec<String> = entry.sizes.iter().map(f64::to_string).collect();
        let link = format!("{:?}", entry.link).to_lowercase();
        println!("{:<20} {link:<10} {}; {}", entry.name, sizes.join(" "), entry.meaning);
    };
    truth::catalogue().for_each(show);
    println!("\noutside the catalogue");
    truth::outside().for_each(show);
    println!("\nof an axis\n{}", truth::axis::names().collect::<Vec<_>>().join("\n"));
}
