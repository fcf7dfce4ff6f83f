//! A motor's step response alone, from rest or from full speed the other way: the commonest log of a bench.

use super::common::{names, of_files, with_dry_friction};
use gap::{Analysis, Interval, Verdict};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use runs::Run;

/// Supply, V, resistance, ohm, motor constant, Nm/A, and gear.
const VOLT: f64 = 24.0;
const OHM: f64 = 0.6;
const KT: f64 = 0.0251;
const GEAR: f64 = 3.0;
/// Inertia of all that turns, at the motor shaft, kg m², and friction at the output shaft, Nm.
const INERTIA: f64 = 4e-5;
const DRY: f64 = 0.04;
/// Duty of the steps, and the row, s, in which the encoder's count is a speed of 0.767 rad/s.
const DUTY: f64 = 0.15;
const ROW_S: f64 = 0.00215;
const COUNT: f64 = 0.767;

fn step(index: usize, seed: u64) -> Run {
    let mut rng = ChaCha8Rng::seed_from_u64(100 * seed + index as u64);
    let mut run = Run { name: format!("step-{}", index + 1), ..Run::default() };
    let (duty, mut speed) = if index.is_multiple_of(2) { (DUTY, 0.0) } else { (-DUTY, 43.0) };
    let (mut duties, mut speeds) = (Vec::new(), Vec::new());
    for row in 0..465 {
        run.t.push(ROW_S * f64::from(row));
        duties.push(duty);
        speeds.push(((speed / COUNT + rng.random_range(-0.5..0.5)).round()) * COUNT);
        for _ in 0..20 {
            let torque = GEAR * KT * (duty * VOLT - KT * GEAR * speed) / OHM;
            speed = with_dry_friction(speed, torque, DRY, GEAR * GEAR * INERTIA, ROW_S / 20.0);
        }
    }
    run.duty = vec![duties];
    run.speed = vec![speeds];
    run
}

/// With so many times too little inertia in the file.
fn analysed(factor: f64, seed: u64) -> Analysis {
    let text = format!(
        "encoder_counts_per_motor_rev = 4096\ngear_ratio = {GEAR}\nsupply_v = {VOLT}\nsupport = \"blocks\"\n\
         wheel_radius_m = 1\n[motor]\nresistance_ohm = {OHM}\ntorque_constant = {KT}\nrotor_inertia = {}\n\
         friction_torque = 0\n[[wheel]]\nx_m = 0\ny_m = 0\ndrive_deg = 0\n",
        INERTIA / factor
    );
    of_files(&text, (0..6).map(|i| step(i, seed)))
}

/// A gripper or a wheel on the shaft that nobody wrote into the file, beside a friction that nobody wrote either.
#[test]
fn a_load_that_the_file_lacks_is_found() {
    let cases: Vec<(f64, u64)> = [2.0, 3.0, 5.0].into_iter().flat_map(|factor| [1, 2].map(|s| (factor, s))).collect();
    let fault = |(factor, seed): (f64, u64)| {
        let a = analysed(factor, seed);
        let sized = |name: &str, truth: f64, off: f64| {
            a.effects.iter().filter(|e| e.name == name).any(|e| {
                let (_, value, interval) = &e.parameters[0];
                matches!(interval, Interval::Ci95(_)) && (value - truth).abs() < off
            })
        };
        let found = sized("rotor-inertia", factor - 1.0, 0.12 * factor) && sized("coulomb-friction", DRY, 0.25 * DRY);
        (!found).then(|| format!("{factor}, {seed}: {:?}\n{}", names(&a), a.terminal_summary()))
    };
    let faults: Vec<String> = cases.into_par_iter().filter_map(fault).collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// One way, a step a run, each with another voltage.
#[derive(Clone, Copy)]
struct OneWay {
    seed: u64,
    rows: u32,
    /// What the bridge gives more than its duty.
    more: f64,
    /// Drag by the square of the speed, Nm s²/rad².
    drag_nms2: f64,
}

impl OneWay {
    fn run(self, index: usize) -> Run {
        let mut rng = ChaCha8Rng::seed_from_u64(self.seed + index as u64);
        let mut run = Run { name: format!("step-{}", index + 1), ..Run::default() };
        let duty = 0.25 + 0.1 * index as f64;
        let (mut duties, mut speeds, mut speed) = (Vec::new(), Vec::new(), 0.0_f64);
        for row in 0..self.rows {
            run.t.push(0.01 * f64::from(row));
            duties.push(duty);
            speeds.push(speed + rng.random_range(-0.3..0.3));
            for _ in 0..20 {
                let torque = GEAR * KT * ((duty + self.more) * VOLT - KT * GEAR * speed) / OHM;
                let left = torque - self.drag_nms2 * speed * speed;
                speed = with_dry_friction(speed, left, 0.01, 40.0 * GEAR * GEAR * INERTIA, 0.01 / 20.0);
            }
        }
        run.duty = vec![duties];
        run.speed = vec![speeds];
        run
    }

    fn told(self) -> Analysis {
        let text = format!(
            "encoder_counts_per_motor_rev = 4096\ngear_ratio = {GEAR}\nsupply_v = {VOLT}\nsupport = \"blocks\"\n\
             wheel_radius_m = 1\n[motor]\nresistance_ohm = {OHM}\ntorque_constant = {KT}\nrotor_inertia = {}\n\
             friction_torque = 0\n[[wheel]]\nx_m = 0\ny_m = 0\ndrive_deg = 0\n",
            40.0 * INERTIA
        );
        of_files(&text, (0..8).map(|index| self.run(index)))
    }
}

/// A fan: the drag that grows with the square of the speed is another friction in each step.
#[test]
fn runs_that_have_a_level_each_are_of_one_machine() {
    let said = |a: &Analysis| a.unexplained.iter().any(|u| u.structure.starts_with("the runs differ"));
    for seed in [1, 2] {
        let a = OneWay { seed: 7000 + 100 * seed, rows: 60, more: 0.0, drag_nms2: 2e-4 }.told();
        assert!(!said(&a), "{}", a.terminal_summary());
    }
}

/// A geared motor that ran one way in ten steps had a weight of 25 mNm, for it was faster at small voltages than at large; and
/// this one a dry friction of -140 mNm beside a file without any.
#[test]
fn a_weight_that_helps_one_way_alone_may_be_the_bridge() {
    let a = OneWay { seed: 900, rows: 120, more: 0.05, drag_nms2: 0.0 }.told();
    assert_eq!(names(&a), ["hanging-load"], "{}", a.terminal_summary());
    let tie = ["hanging-load", "dead-band"].map(str::to_owned).to_vec();
    assert!(a.alternatives.contains(&tie) && a.verdict == Verdict::Ambiguous, "{}", a.terminal_summary());
    assert!(a.remarks.iter().any(|r| r.contains("Drive it both ways")), "{:?}", a.remarks);
}
