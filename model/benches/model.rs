//! Speed of the plant, the skew estimate and the fusion filter.

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};

use model::calibration::estimate_skew;
use model::camera::CameraModel;
use model::fusion::{Fusion, FusionOptions};
use model::odometry::Estimate;
use model::plant::{Contact, Creep, Plant};
use model::simulation::{VirtualRobot, calibration_drive};
use runs::frames::{Pose, Twist};
use runs::robot::Robot;

/// A second of driving at 1 kHz: the time per iteration is the inverse of the real-time factor.
fn plant(c: &mut Criterion) {
    let robot = Robot::racbot();
    let contacts = [
        ("rolling", Contact::Rolling),
        ("slipping", Contact::Friction { friction_coefficient: 0.5, creep: Creep::at_rest(0.003) }),
    ];
    let mut group = c.benchmark_group("plant, 1 s at 1 kHz, 3 wheels");
    for (name, contact) in contacts {
        group.bench_function(name, |b| {
            let mut plant = Plant::new(&robot).expect("the built-in robot").with_contact(contact);
            b.iter(|| {
                for k in 0..1000_u32 {
                    let a = f64::from(k) * 0.01;
                    plant.step(&[0.3 * a.sin(), 0.4 * a.cos(), -0.2], 7.2, 0.001);
                }
                black_box(plant.pose())
            });
        });
    }
    group.finish();
}

fn estimate(c: &mut Criterion) {
    let robot = Robot::racbot();
    let camera = CameraModel::of(&robot);
    let mut v = VirtualRobot::new(&robot, Contact::Rolling, camera, Pose::default(), 1).expect("the built-in robot");
    calibration_drive(&mut v, 0.8, 30.0, &robot.geometry().expect("the built-in robot"));
    let runs = [v.into_log()];
    let mut group = c.benchmark_group("calibration");
    group.sample_size(20);
    group.bench_function("skew estimate from 30 s", |b| b.iter(|| black_box(estimate_skew(&robot, &runs))));
    group.finish();
}

/// A control tick with odometry, and a camera frame every 16 ticks that is 20 ms late.
fn fusion(c: &mut Criterion) {
    let robot = Robot { camera_latency_s: 0.02, ..Robot::racbot() };
    let g = robot.geometry().expect("the built-in robot");
    let mut group = c.benchmark_group("fusion");
    group.throughput(Throughput::Elements(1));
    for (name, every) in [("tick, frame every 16th", 16), ("tick and late frame", 1)] {
        group.bench_function(name, |b| {
            let options = FusionOptions { gate: f64::INFINITY, ..FusionOptions::of(&robot) };
            let mut fusion =
                Fusion::new(&g, robot.counts_per_wheel_rad(), options, Estimate::new(Pose::default(), [0.01; 3]));
            let wheels = g.wheel_speeds(Twist::new(0.3, 0.6, 1.0));
            let mut k = 0_u32;
            b.iter(|| {
                k += 1;
                let t = f64::from(k) * 0.001;
                let counts = [0, 1, 2].map(|i| (wheels[i] * t * 1209.0) as i64);
                fusion.predict(t, &counts);
                if k.is_multiple_of(every) {
                    black_box(fusion.correct(t, fusion.pose()));
                }
            });
        });
    }
    group.finish();
}

criterion_group!(benches, plant, estimate, fusion);
criterion_main!(benches);
