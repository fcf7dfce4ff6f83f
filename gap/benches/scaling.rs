//! Time of a whole analysis against the length of the logs and the size of the catalogue.

use std::hint::black_box;
use std::path::PathBuf;
use std::sync::Arc;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};

use gap::user::UserEffect;
use gap::{Options, analyse};
use model::effects::Applied;
use model::manoeuvre::{Manoeuvre, simulate};
use runs::DataSet;
use runs::frames::Pose;
use runs::robot::{Effect, EffectParameter, Robot};

/// Runs of the robot with a camera 30 ms late, four for each step of length, 7 s or so each.
fn logs(times: usize) -> DataSet {
    let late = EffectParameter { value: 0.03, ..EffectParameter::default() };
    let effect = Effect {
        name: "camera-latency".to_owned(),
        parameters: vec![("latency_s".to_owned(), late)],
        ..Effect::default()
    };
    let robot = Robot::racbot();
    let applied = Applied::of(&Robot { effects: vec![effect], ..robot.clone() });
    let drives = [Manoeuvre::Square, Manoeuvre::StopAndGo, Manoeuvre::Spin, Manoeuvre::StopAndGo];
    let runs = (0..4 * times).map(|k| {
        let start = Pose::new(0.2, -0.3, 0.7 * k as f64);
        simulate(drives[k % 4], &applied, &robot, start, k as u64).expect("the built-in robot")
    });
    DataSet { folder: PathBuf::from("bench"), runs: runs.collect(), robot }
}

/// More effects, each with a law of its own.
fn more(n: usize) -> Options {
    let effects = (0..n).map(|k| {
        let text = format!(
            "name = \"extra-{k}\"\ntorque = \"-c * sin(w * {} + {k})\"\n[parameters]\nc = {{ scale = 1e-3, material = 5e-3 }}\n",
            0.1 * (k + 1) as f64
        );
        Arc::new(UserEffect::parse(&text).expect("an effect")) as Arc<dyn links::effect::Effect>
    });
    Options { effects: effects.collect(), ..Options::default() }
}

fn length(c: &mut Criterion) {
    let mut group = c.benchmark_group("length of the logs");
    group.sample_size(10);
    for times in [1, 4, 16] {
        let set = logs(times);
        let seconds: f64 = set.runs.iter().map(runs::Run::duration_s).sum();
        group.throughput(Throughput::Elements(seconds as u64));
        group.bench_function(BenchmarkId::from_parameter(format!("{times}x, {seconds:.0} s")), |b| {
            b.iter(|| analyse(black_box(&set), &Options::default()).expect("an analysis"));
        });
    }
    group.finish();
}

fn catalogue(c: &mut Criterion) {
    let mut group = c.benchmark_group("size of the catalogue");
    group.sample_size(10);
    let (set, own) = (logs(1), links::effects::catalogue().len());
    for times in [1, 4, 16] {
        let options = more((times - 1) * own / 4);
        group.bench_function(BenchmarkId::from_parameter(format!("{} effects", own + options.effects.len())), |b| {
            b.iter(|| analyse(black_box(&set), &options).expect("an analysis"));
        });
    }
    group.finish();
}

criterion_group!(benches, length, catalogue);
criterion_main!(benches);
