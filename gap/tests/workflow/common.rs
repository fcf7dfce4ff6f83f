//! Simulated data sets whose truth is known.

use std::path::{Path, PathBuf};

use gap::{Analysis, Options, analyse};
use model::effects::Applied;
use model::manoeuvre::{self, Manoeuvre};
use model::plant::{Contact, Creep};
use runs::frames::Pose;
use runs::output::Existing;
use runs::robot::{Effect, EffectParameter, Robot};
use runs::{DataSet, Run};

/// The example set whose hidden skews are +4, −3 and +2 degrees.
pub(super) fn example() -> DataSet {
    DataSet::open(Path::new(env!("CARGO_MANIFEST_DIR")).join("../data/runs/wheel-skew")).unwrap()
}

/// A robot with one effect more.
pub(super) fn with(robot: &Robot, name: &str, parameters: &[(&str, f64)]) -> Robot {
    let parameters = parameters
        .iter()
        .map(|(n, v)| ((*n).to_owned(), EffectParameter { value: *v, ..EffectParameter::default() }))
        .collect();
    let effect = Effect { name: name.to_owned(), parameters, ..Effect::default() };
    let mut truth = robot.clone();
    truth.effects.push(effect);
    truth
}

/// A run of the true robot. Contacts creep a little, as all do.
pub(super) fn run(truth: &Robot, manoeuvre: Manoeuvre, seed: u64) -> Run {
    let mut applied = Applied::of(truth);
    assert!(applied.unsupported.is_empty(), "{:?}", applied.unsupported);
    if applied.contact == Contact::Rolling {
        applied.contact = Contact::Friction { friction_coefficient: 0.9, creep: Creep::at_rest(3e-4) };
    }
    driven(truth, &applied, manoeuvre, seed)
}

/// A run of a robot whose contacts roll without creep.
pub(super) fn rolling(truth: &Robot, manoeuvre: Manoeuvre, seed: u64) -> Run {
    driven(truth, &Applied::of(truth), manoeuvre, seed)
}

fn driven(truth: &Robot, applied: &Applied, manoeuvre: Manoeuvre, seed: u64) -> Run {
    let nominal = Robot { effects: Vec::new(), ..truth.clone() };
    let start = Pose::new(0.3, -0.2, 0.4 + seed as f64);
    let mut run = manoeuvre::simulate(manoeuvre, applied, &nominal, start, seed).unwrap();
    run.name = format!("{}_{seed}", manoeuvre.name());
    run
}

/// The first seconds of a run.
pub(super) fn cut(run: &mut Run, seconds: f64) {
    let n = run.t.partition_point(|t| *t < seconds);
    run.t.truncate(n);
    run.command.iter_mut().flatten().for_each(|c| c.truncate(n));
    for columns in [&mut run.reference, &mut run.duty] {
        columns.iter_mut().for_each(|c| c.truncate(n));
    }
    run.counts.iter_mut().for_each(|c| c.truncate(n));
    run.supply_v.iter_mut().for_each(|c| c.truncate(n));
    run.camera.retain(|c| c.tick < n);
}

/// The first seconds of every run.
pub(super) fn cut_all(set: &mut DataSet, seconds: f64) {
    set.runs.iter_mut().for_each(|run| cut(run, seconds));
}

/// Logs of the true robot, described by the nominal one.
pub(super) fn simulate(truth: &Robot, manoeuvres: &[Manoeuvre], seed: u64) -> DataSet {
    let runs = manoeuvres.iter().enumerate().map(|(k, m)| run(truth, *m, 100 * seed + k as u64)).collect();
    let robot = Robot { effects: Vec::new(), ..truth.clone() };
    DataSet { folder: PathBuf::from("simulated"), robot, runs }
}

/// What is said of a robot.toml and logs, written and read as those of a user.
pub(super) fn of_files(robot: &str, runs: impl IntoIterator<Item = Run>) -> Analysis {
    of_files_by(robot, runs, &Options::default())
}

/// The same by what somebody chose.
pub(super) fn of_files_by(robot: &str, runs: impl IntoIterator<Item = Run>, options: &Options) -> Analysis {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("robot.toml"), robot).unwrap();
    for run in runs {
        run.save(folder.path().join(format!("{}.csv", run.name)), Existing::Refuse).unwrap();
    }
    analyse(&DataSet::open(folder.path()).unwrap(), options).unwrap()
}

/// Speed of an axis (rad/s) `step` seconds later, under a torque and a dry friction (Nm) that holds it where it stands.
pub(super) fn with_dry_friction(speed: f64, torque: f64, dry: f64, inertia: f64, step: f64) -> f64 {
    let sticks = speed == 0.0 && torque.abs() < dry;
    let sense = if speed == 0.0 { torque.signum() } else { speed.signum() };
    let after = if sticks { 0.0 } else { speed + step * (torque - dry * sense) / inertia };
    if speed * after < 0.0 { 0.0 } else { after }
}

pub(super) const RICH: [Manoeuvre; 3] = [Manoeuvre::Star, Manoeuvre::Spin, Manoeuvre::Chirp];

pub(super) fn names(a: &Analysis) -> Vec<&str> {
    a.effects.iter().map(|e| e.name.as_str()).collect()
}

pub(super) fn value(a: &Analysis, parameter: &str) -> f64 {
    let all = a.effects.iter().flat_map(|e| &e.parameters);
    all.filter(|p| p.0 == parameter).map(|p| p.1).next().unwrap_or(f64::NAN)
}
