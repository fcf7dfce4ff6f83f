//! How fast the simulator is: elements are microseconds of the robot's life.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use std::hint::black_box;
use truth::{Drive, Kind, draw, simulate};

fn speed(c: &mut Criterion) {
    let case = draw(1, &Kind::EffectFree).expect("an effect-free case can always be drawn");
    let seconds: f64 = case.drives.iter().map(Drive::seconds).sum();
    let mut group = c.benchmark_group("truth");
    group.sample_size(10).throughput(Throughput::Elements((1e6 * seconds) as u64));
    group.bench_function("effect-free set", |b| b.iter(|| simulate(black_box(&case))));
    group.finish();
}

criterion_group!(benches, speed);
criterion_main!(benches);
