//! Verdicts on logs in which there is little to compare, or the same twice.

use std::path::Path;

use gap::{Analysis, Options, Verdict, analyse};
use runs::DataSet;

fn example() -> DataSet {
    DataSet::open(Path::new(env!("CARGO_MANIFEST_DIR")).join("../data/runs/wheel-skew")).unwrap()
}

fn done(set: &DataSet) -> Analysis {
    analyse(set, &Options::default()).unwrap()
}

#[test]
fn a_robot_that_never_moved_is_not_compared() {
    let mut set = example();
    for run in &mut set.runs {
        run.counts.iter_mut().for_each(|c| c.fill(7));
        run.duty.iter_mut().chain(&mut run.reference).for_each(|d| d.fill(0.0));
        run.command.iter_mut().flatten().for_each(|c| c.fill(0.0));
        let first = run.camera[0].pose;
        run.camera.iter_mut().for_each(|c| c.pose = first);
    }
    let a = done(&set);
    assert_eq!(a.verdict, Verdict::NotCompared, "{}", a.terminal_summary());
    assert!(a.remarks.iter().any(|r| r.contains("no wheel turns")), "{:?}", a.remarks);
    assert_eq!(a.to_json()["verdict"], "not-compared");
}

/// What the motors were told and where the robot went, without what its wheels did.
#[test]
fn duties_without_counts_say_what_to_log() {
    let mut set = example();
    for run in &mut set.runs {
        run.reference.clear();
        run.measured.clear();
        (run.counts, run.count_gaps) = (Vec::new(), Vec::new());
    }
    let a = done(&set);
    assert_eq!(a.verdict, Verdict::NotCompared, "{}", a.terminal_summary());
    assert!(a.remarks.iter().any(|r| r.starts_with("No encoder counts or wheel speeds beside")), "{:?}", a.remarks);
}

/// Steps on a lifted motor with 48 counts a turn, a row a millisecond, its rotor's inertia so many times the file's and without the
/// file's friction.
fn steps(voltages: &[f64], rows: usize, inertia: f64) -> DataSet {
    let mut set = example();
    set.robot = set.robot.first_axes(1);
    set.robot.support = runs::robot::Support::Blocks;
    set.robot.encoder_counts_per_motor_rev = 48.0;
    let (r, k) = (set.robot.motor.resistance_ohm, set.robot.motor.torque_constant);
    let inertia = inertia * set.robot.motor.rotor_inertia;
    set.runs.truncate(voltages.len());
    for (run, step) in set.runs.iter_mut().zip(voltages) {
        let volts = |row: usize| step * if row < rows / 2 { 1.0 } else { 2.0 };
        let (mut speed, mut angle, mut counts, mut duty) = (0.0, 0.0, Vec::new(), Vec::new());
        for row in 0..rows {
            counts.push((angle * 48.0 / std::f64::consts::TAU).floor() as i64);
            duty.push(volts(row) / set.robot.supply_v);
            for _ in 0..10 {
                speed += 1e-4 * k * (volts(row) - k * speed) / r / inertia;
                angle += 1e-4 * speed;
            }
        }
        run.t = (0..rows).map(|row| row as f64 * 1e-3).collect();
        (run.counts, run.count_gaps, run.duty) = (vec![counts], vec![Vec::new()], vec![duty]);
        (run.command, run.supply_v, run.has_camera) = (None, None, false);
        run.reference.clear();
        run.measured.clear();
        run.camera.clear();
    }
    set
}

/// Of one step of 0.3 s a rotor of twice the inertia would not show, and that nothing shows is no agreement.
#[test]
fn logs_too_short_to_show_anything_are_not_compared() {
    let mut set = steps(&[2.1], 300, 1.0);
    set.robot.motor.friction_torque = 0.0;
    let a = done(&set);
    assert_eq!(a.verdict, Verdict::NotCompared, "{}", a.terminal_summary());
    assert!(a.remarks.iter().any(|r| r.starts_with("Compared next to nothing on the drive link")), "{:?}", a.remarks);
}

/// Three steps of 0.4 s show a friction, and an inertia or what does the same.
#[test]
fn three_steps_of_less_than_half_a_second_show_the_inertia() {
    let set = steps(&[2.1, 1.5, -1.7], 420, 1.3);
    let a = done(&set);
    let inertia = |set: &Vec<String>| set.iter().any(|n| n == "rotor-inertia");
    let named = a.effects.iter().any(|e| e.name == "rotor-inertia") || a.alternatives.iter().any(inertia);
    let friction = -set.robot.gear_ratio * set.robot.motor.friction_torque;
    let found = a.effects.iter().find(|e| e.name == "coulomb-friction").and_then(|e| e.parameters[0].2.ends());
    let held = found.is_some_and(|[low, high]| low < friction && friction < high && high < 0.0);
    assert!(named && held, "{}", a.terminal_summary());
}

#[test]
fn times_in_milliseconds_are_not_compared() {
    let mut set = example();
    for run in &mut set.runs {
        run.t.iter_mut().for_each(|t| *t *= 1000.0);
    }
    let a = done(&set);
    assert_eq!(a.verdict, Verdict::NotCompared, "{}", a.terminal_summary());
    assert!(a.effects.is_empty() && a.remarks.iter().any(|r| r.contains("milliseconds")), "{:?}", a.remarks);
}

#[test]
fn a_recording_written_twice_gives_the_verdict_of_one() {
    let set = example();
    let mut twice = set.clone();
    for run in &set.runs {
        let mut copy = run.clone();
        copy.name += "_copy";
        twice.runs.push(copy);
    }
    let names = |a: &Analysis| a.effects.iter().map(|e| e.name.clone()).collect::<Vec<_>>();
    let (once, twice) = (done(&set), done(&twice));
    assert_eq!((once.verdict, names(&once)), (twice.verdict, names(&twice)), "{}", twice.terminal_summary());
}
