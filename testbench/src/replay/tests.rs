use super::*;
use crate::closed_loop::Drive;
use crate::fpga::QUIET_CLOCKS;
use fixed_kin::speed::SpeedMode;
use model::run::DataSet;
use std::path::Path;

fn shipped() -> DataSet {
    DataSet::open(Path::new(env!("CARGO_MANIFEST_DIR")).join("../data/runs/wheel-skew")).unwrap()
}

/// What rounding comes to in LSB of duty: set point and speed are each off by up to a LSB, kp makes
/// 16 of one at once, and without a robot that answers ki = 0.086 adds it up tick by tick.
fn bound(ticks: usize) -> f64 {
    2.0 * 16.2 + 2.0 * 0.087 * ticks as f64
}

#[test]
fn every_measured_duty_is_within_the_rounding_of_the_log() {
    let set = shipped();
    let mut ticks = 0;
    for run in &set.runs {
        let replayed = replay(BitTrue::new(), &set.robot, run, Part::default(), |_| {}).unwrap();
        assert_eq!((replayed.quantum, replayed.wheels.len()), (0.001, 3));
        for wheel in &replayed.wheels {
            assert_eq!(wheel.law.beyond, 0, "{}: {wheel:?}", run.name);
            assert!(lsb(wheel.arithmetic.max) < bound(run.len()), "{}: {wheel:?}", run.name);
            // They may tip what the log rounded near a tie, and no more.
            assert!(wheel.fpga.max <= 0.0005 + wheel.arithmetic.max, "{}: {wheel:?}", run.name);
            assert!(wheel.fpga.beyond < wheel.fpga.ticks / 40, "{}: {wheel:?}", run.name);
            ticks += wheel.fpga.ticks;
        }
    }
    assert!(ticks > 70_000, "{ticks}");
}

#[test]
fn a_part_gives_what_the_whole_gives_there() {
    let set = shipped();
    let whole = replay(BitTrue::new(), &set.robot, &set.runs[0], Part::default(), |_| {}).unwrap();
    let quiet = BitTrue::new().with_quiet_clocks(QUIET_CLOCKS);
    let part = replay(quiet, &set.robot, &set.runs[0], Part { from: 2_345, ticks: Some(500) }, |_| {}).unwrap();
    assert_eq!(part.ticks, 500);
    for (part, whole) in part.duty.iter().zip(&whole.duty) {
        assert_eq!(part[..], whole[2_345..2_845]);
    }
    let late =
        replay(BitTrue::new(), &set.robot, &set.runs[0], Part { from: 10_000_000, ticks: None }, |_| {}).unwrap();
    assert!(late.skipped.unwrap().contains("only 6700 ticks"));
}

#[test]
fn our_own_log_replays_bit_for_bit() {
    let drive = Drive { speed_mode: SpeedMode::Difference, limit_s: 3.0, ..Drive::fig_6() };
    let driven = drive.run(BitTrue::new(), |_| {}).unwrap();
    let mut file = Vec::new();
    driven.run.write_to(&mut file).unwrap();
    let run = Run::from_reader(&file[..], Path::new("run.csv")).unwrap();
    let robot = Robot::parse(&driven.robot.to_toml(), Path::new("robot.toml")).unwrap();
    let replayed = replay(BitTrue::new(), &robot, &run, Part::default(), |_| {}).unwrap();
    for wheel in &replayed.wheels {
        assert!(wheel.fpga.max < 1e-9 && wheel.fpga.ticks == 3_000, "{wheel:?}");
    }
}

#[test]
fn a_wrong_gain_is_seen() {
    let mut set = shipped();
    set.robot.pi.kp *= 1.01;
    let replayed = replay(BitTrue::new(), &set.robot, &set.runs[0], Part::default(), |_| {}).unwrap();
    assert!(replayed.wheels.iter().all(|w| w.fpga.beyond > 100 && w.law.beyond > 100));
}

#[test]
fn logs_without_what_it_takes_are_skipped_with_a_reason() {
    let drive = Drive { speed_mode: SpeedMode::CountAndTime, limit_s: 0.2, ..Drive::fig_6() };
    let driven = drive.run(BitTrue::new(), |_| {}).unwrap();
    let replayed = replay(BitTrue::new(), &driven.robot, &driven.run, Part::default(), |_| {}).unwrap();
    assert!(replayed.skipped.unwrap().contains("racbot gap compares it"));
    let mut set = shipped();
    let run = &mut set.runs[0];
    run.reference.clear();
    let replayed = replay(BitTrue::new(), &set.robot, run, Part::default(), |_| {}).unwrap();
    assert!(replayed.skipped.unwrap().contains("ref_1"));
    let mut without_duty = shipped().runs.remove(1);
    without_duty.duty.clear();
    let replayed = replay(BitTrue::new(), &set.robot, &without_duty, Part::default(), |_| {}).unwrap();
    assert!(replayed.wheels.iter().all(|w| w.fpga.ticks == 0 && w.arithmetic.ticks == 6_000));
}
