//! How fast the virtual robot is: `cargo bench -p testbench`.
//!
//! Throughput is in control ticks; at 1 kHz a thousand of them are a second of the robot's life.

use criterion::{BatchSize, Criterion, Throughput, criterion_group, criterion_main};
use driver::{Board, Registers, Scale, Settings};
use fixed_kin::AXES;
use fixed_kin::card::{Card, Pins};
use fixed_kin::control::{Core, SetPointMode, TickInputs};
use fixed_kin::speed::{EncoderSample, SpeedMode};
use model::plant::Plant;
use runs::frames::{Pose, Twist};
use runs::robot::Robot;
use simulator::closed_loop::{Drive, VirtualRobot, whole_tick_clock_hz};
use simulator::fpga::{BitTrue, Fpga};
use std::hint::black_box;
use std::time::Duration;

const TICKS: usize = 1_000;

fn scale() -> Scale {
    let robot = Robot::racbot();
    Scale::new(&robot, whole_tick_clock_hz(robot.control_rate_hz)).expect("the built-in robot fits")
}

/// The arithmetic of a control tick of all axes: speed, kinematics both ways, PI, PWM.
fn core(c: &mut Criterion) {
    let scale = scale();
    let mut group = c.benchmark_group("core");
    group.throughput(Throughput::Elements(TICKS as u64));
    for (name, speed_mode) in [("difference", SpeedMode::Difference), ("count-and-time", SpeedMode::CountAndTime)] {
        group.bench_function(name, |b| {
            let twist = scale.twist_words(Twist::new(0.5, 1.0, 2.0));
            let mut inputs = TickInputs {
                tick_period: scale.tick_period,
                speed_mode,
                set_point_mode: SetPointMode::Twist,
                set_points: [twist[0], twist[1], twist[2], 0],
                set_points_valid: true,
                armed: true,
                pwm_period: 1_667,
                ..TickInputs::default()
            };
            let mut core = Core::default();
            b.iter(|| {
                for tick in 0..TICKS as u32 {
                    inputs.now = (tick * scale.tick_period) & 0xFF_FFFF;
                    for (axis, encoder) in inputs.encoders.iter_mut().enumerate() {
                        let count = encoder.count.wrapping_add(20 + axis as u16);
                        *encoder = EncoderSample {
                            count,
                            edge_time: inputs.now.wrapping_sub(99) & 0xFF_FFFF,
                            direction: true,
                        };
                    }
                    black_box(core.tick(scale.configuration(), &inputs));
                }
            });
        });
    }
    group.finish();
}

/// A card with its registers and safety, driven as by the driver.
fn armed<R: Registers>(bus: R, first: impl FnOnce(&mut R)) -> Board<R> {
    let mut board = Board::new(bus);
    board.configure(&scale(), &Settings::default()).expect("configures");
    first(&mut board.bus);
    board.arm().expect("arms");
    board
}

/// The whole card with a set point a tick over its registers, with and without encoders that turn.
fn card(c: &mut Criterion) {
    let scale = scale();
    let mut group = c.benchmark_group("card");
    group.throughput(Throughput::Elements(TICKS as u64));
    group.bench_function("tick", |b| {
        let mut board = armed(Card::new(0), |card| {
            card.tick(&Pins::default());
        });
        let mut pins = Pins::default();
        b.iter(|| {
            board.set_twist(&scale, Twist::new(0.5, 1.0, 2.0)).expect("commits");
            for tick in 0..TICKS {
                // A host that sets a new command every 20 ms.
                if tick % 20 == 0 {
                    board.set_twist(&scale, Twist::new(0.5, 1.0, 2.0)).expect("commits");
                }
                for encoder in &mut pins.encoders {
                    encoder.count = encoder.count.wrapping_add(20);
                }
                black_box(board.bus.tick(&pins));
            }
        });
    });
    group.bench_function("set points, edges, tick, snapshot", |b| {
        let mut board = armed(BitTrue::new(), |fpga| fpga.advance(&[0.0; AXES]).expect("rests"));
        let mut positions = [0.0; AXES];
        b.iter(|| {
            for tick in 0..TICKS {
                board.set_twist(&scale, Twist::new(0.5, 1.0, 2.0)).expect("commits");
                let step = if tick % 2 == 0 { 25.3 } else { -25.3 };
                positions = positions.map(|position| position + step);
                board.bus.advance(&positions).expect("turns");
                black_box(board.snapshot().expect("answers"));
            }
        });
    });
    group.finish();
}

/// Driver, registers, FPGA, motors, body and encoders.
fn closed_loop(c: &mut Criterion) {
    let mut group = c.benchmark_group("closed loop");
    group.throughput(Throughput::Elements(TICKS as u64));
    group.bench_function("dynamics", |b| {
        let robot = Robot::racbot();
        let scale = scale();
        let start = || {
            let plant = Plant::new(&robot).expect("drives").at(Pose::default());
            let period = Duration::from_secs_f64(scale.tick_s());
            let robot = VirtualRobot::new(BitTrue::new(), plant, robot.supply_v, period);
            (armed(robot.clone(), |_| robot.tick().expect("ticks")), robot)
        };
        b.iter_batched(
            start,
            |(mut board, robot)| {
                for _ in 0..TICKS {
                    board.set_twist(&scale, Twist::new(0.4, 0.6, 1.0)).expect("commits");
                    robot.tick().expect("ticks");
                    black_box(board.snapshot().expect("answers"));
                }
                robot
            },
            BatchSize::LargeInput,
        );
    });
    group.throughput(Throughput::Elements(1_000));
    group.bench_function("with controller, odometry and log", |b| {
        let drive = Drive { limit_s: 1.0, ..Drive::fig_6() };
        b.iter(|| drive.run(BitTrue::new(), |_| {}).expect("drives"));
    });
    group.finish();
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(30);
    targets = core, card, closed_loop
}
criterion_main!(benches);
