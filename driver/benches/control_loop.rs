//! What a control tick of the host costs: the whole loop over a bit-true card, and the bus transfers alone.

#[path = "../tests/treadmill/mod.rs"]
mod treadmill;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use driver::drive::{NoSource, Plan};
use driver::realtime::Clock;
use driver::{Board, Scale, Settings};
use model::trajectory::SetPoint;
use runs::frames::Twist;
use runs::robot::Robot;
use std::hint::black_box;
use std::sync::atomic::AtomicBool;
use std::time::Duration;
use treadmill::{CLOCK_HZ, Treadmill};

/// Ticks of a measurement.
const TICKS: u32 = 2_000;

fn whole_loop(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("control tick");
    group.throughput(Throughput::Elements(TICKS.into()));
    for (name, fused) in [("loop, odometry", false), ("loop, camera fusion", true)] {
        let plan = Plan {
            limit_s: f64::from(TICKS) * 1e-3,
            fused,
            ..Plan::new(&Robot::racbot(), &[SetPoint::pass(90.0, 0.0, 1.0, 0.0)])
        };
        let never = AtomicBool::new(false);
        group.bench_function(name, |bencher| {
            bencher.iter(|| {
                let card = Treadmill::new();
                let mut clock = card.clone();
                plan.drive(Board::new(card), &mut clock, CLOCK_HZ, &mut NoSource, None, &never).unwrap()
            });
        });
    }
    let scale = Scale::new(&Robot::racbot(), CLOCK_HZ).unwrap();
    group.bench_function("card and bus alone", |bencher| {
        bencher.iter(|| {
            let card = Treadmill::new();
            let (mut clock, mut board) = (card.clone(), Board::new(card));
            board.configure(&scale, &Settings::default()).unwrap();
            for tick in 1..=TICKS {
                clock.sleep_until(Duration::from_millis(tick.into()));
                black_box(board.snapshot().unwrap());
                board.set_twist(&scale, Twist::default()).unwrap();
            }
        });
    });
    group.finish();
}

criterion_group!(benches, whole_loop);
criterion_main!(benches);
