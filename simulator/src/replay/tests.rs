use super::*;
use crate::closed_loop::Drive;
use crate::fpga::QUIET_CLOCKS;
use fixed_kin::speed::SpeedMode;
use runs::{DataSet, Run};
use std::path::Path;

const TABLE: measured::Table<'_> = measured::Table {
    name: "replay",
    title: "Duties of the shipped log, replayed by the FPGA's arithmetic",
    command: "cargo test --release -p simulator --lib replay",
    columns: &["run", "digit of the log", "largest difference from the log", "from floating point"],
};

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
        let worst = |of: &dyn Fn(&WheelAgreement) -> f64| replayed.wheels.iter().map(of).fold(0.0, f64::max);
        TABLE.check_row(&[
            run.name.clone(),
            replayed.quantum.to_string(),
            format!("{:.6}", worst(&|wheel| wheel.fpga.max)),
            format!("{:.6}", worst(&|wheel| wheel.arithmetic.max)),
        ]);
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

/// Without the rows that `keep` refuses.
fn with_rows(run: &Run, keep: impl Fn(usize) -> bool) -> Run {
    let mut run = run.clone();
    let rows: Vec<usize> = (0..run.len()).filter(|row| keep(*row)).collect();
    let pick = |column: &mut Vec<f64>| *column = rows.iter().map(|row| column[*row]).collect();
    run.reference.iter_mut().chain(&mut run.duty).chain(&mut run.supply_v).for_each(pick);
    run.command.iter_mut().flatten().for_each(pick);
    run.counts.iter_mut().for_each(|column| *column = rows.iter().map(|row| column[*row]).collect());
    pick(&mut run.t);
    run
}

#[test]
fn behind_a_gap_the_rounded_duties_tell_the_integrators() {
    let set = shipped();
    for run in &set.runs {
        // Begins in motion, lacks single ticks and a longer stretch, and a counter begins anew.
        let mut part = with_rows(run, |row| row > 1_234 && row % 701 != 0 && !(3_000..3_050).contains(&row));
        part.counts[1].iter_mut().skip(2_500).for_each(|count| *count -= run.counts[1][3_790]);
        let replayed = replay(BitTrue::new(), &set.robot, &part, Part::default(), |_| {}).unwrap();
        assert!(replayed.gaps.pauses >= 6 && replayed.gaps.missing >= 55, "{:?}", replayed.gaps);
        // At full drive, which is half of two of the runs, a duty tells nothing.
        let full = (0..part.len()).filter(|row| part.duty.iter().any(|duty| duty[*row].abs() >= 0.999)).count();
        assert!(replayed.telling < 4 * replayed.gaps.pauses + full / 2, "{}: {}", run.name, replayed.telling);
        for wheel in &replayed.wheels {
            assert_eq!(wheel.fpga.ticks, part.len() - replayed.telling);
            // Half a quantum more where hardly a duty between two gaps is below full drive.
            assert!(wheel.fpga.max < 0.001 + wheel.arithmetic.max, "{}: {wheel:?}", run.name);
            assert!(wheel.fpga.beyond < wheel.fpga.ticks / 30, "{}: {wheel:?}", run.name);
        }
        let from = replay(BitTrue::new(), &set.robot, &part, Part { from: 2_222, ticks: Some(700) }, |_| {}).unwrap();
        for (part, whole) in from.duty.iter().zip(&replayed.duty) {
            assert!(part.iter().zip(&whole[2_222..]).all(|(a, b)| a == b || (a.is_nan() && b.is_nan())));
        }
    }
}

#[test]
fn outputs_that_were_off_clear_the_loops() {
    let drive = Drive { speed_mode: SpeedMode::Difference, limit_s: 2.0, ..Drive::fig_6() };
    let driven = drive.run(BitTrue::new(), |_| {}).unwrap();
    let mut run = driven.run;
    // The card goes off at 1 s and the robot is put back to where it started; then the same once more.
    run.duty.iter_mut().chain(&mut run.reference).for_each(|column| {
        column.copy_within(0..900, 1_100);
        column[1_000..1_100].fill(0.0);
    });
    for column in &mut run.counts {
        let still = column[999];
        let again: Vec<i64> = column[..900].iter().map(|count| still + count).collect();
        column[1_000..1_100].fill(still);
        column[1_100..2_000].copy_from_slice(&again);
    }
    let replayed = replay(BitTrue::new(), &driven.robot, &run, Part::default(), |_| {}).unwrap();
    assert!(replayed.off >= 1, "{replayed:?}");
    for wheel in &replayed.wheels {
        assert!(wheel.fpga.max < 1e-9 && wheel.fpga.ticks > 1_850, "{wheel:?}");
    }
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
