//! A motor of the size of a thumb behind a gear of 50, with an encoder of 28 counts, on blocks: it turns round where its
//! friction is a good part of all that it does.

use super::common::{names, of_files, with_dry_friction};
use gap::{Analysis, Interval};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use runs::Run;

/// Supply, V, resistance, ohm, motor constant, Nm/A, gear, inertia of the load and of the rotor, kg m².
const VOLT: f64 = 6.0;
const OHM: f64 = 15.0;
const KT: f64 = 0.0038;
const GEAR: f64 = 50.0;
const LOAD: f64 = 2e-5;
const ROTOR: f64 = 2e-8;
/// Friction at the motor that the file knows, Nm, and at the wheel that it does not: 8 % of the stall torque.
const KNOWN: f64 = 1e-4;
const DRY: f64 = 0.08 * GEAR * KT * VOLT / OHM;
const COUNTS: f64 = 28.0 * GEAR;

/// Twelve seconds of levels, ramps and waves of the duty, either way, of a motor with so much friction at the wheel, Nm, that
/// the file does not know, and so many counts a turn of the wheel.
fn run(index: u64, seed: u64, unknown: f64, counted: f64) -> Run {
    let mut rng = ChaCha8Rng::seed_from_u64(10 * seed + index);
    let mut run = Run { name: format!("run-{index}"), ..Run::default() };
    let (mut speed, mut angle) = (0.0_f64, 0.0_f64);
    let (mut duties, mut counts) = (Vec::new(), Vec::new());
    let (mut from, mut to, mut kind, mut size) = (0, 60, 1.0, 0.0);
    for row in 0..2400 {
        if row == to {
            (from, to) = (row, row + rng.random_range(60..180));
            kind = rng.random_range(0.0..1.0);
            size = -f64::copysign(rng.random_range(0.16..0.8), size);
        }
        let [past, length] = [row - from, to - from].map(f64::from);
        let part = past / length;
        let duty: f64 = match kind {
            k if k < 0.7 => size,
            k if k < 0.85 => size * part,
            _ => size * (std::f64::consts::TAU * (1.0 + 3.0 * part) * 0.005 * past).sin(),
        };
        let duty = (1000.0 * duty).round() / 1000.0;
        run.t.push(0.005 * f64::from(row));
        counts.push((angle * counted / std::f64::consts::TAU).floor() as i64);
        duties.push(duty);
        for _ in 0..50 {
            let torque = GEAR * KT * (duty * VOLT - KT * GEAR * speed) / OHM;
            let next = with_dry_friction(speed, torque, GEAR * KNOWN + unknown, LOAD + GEAR * GEAR * ROTOR, 1e-4);
            angle += 0.5e-4 * (speed + next);
            speed = next;
        }
    }
    run.duty = vec![duties];
    run.counts = vec![counts];
    run.count_gaps = vec![Vec::new()];
    run
}

/// With a file whose motor constant is so many times that of the motor.
fn analysed(seed: u64, unknown: f64, counted: f64, constant: f64) -> Analysis {
    let text = format!(
        "encoder_counts_per_motor_rev = 28\ngear_ratio = {GEAR}\nsupply_v = {VOLT}\nsupport = \"blocks\"\nduty_quantum = 0.001\n\
         wheel_radius_m = 1\nwheel_inertia_kg_m2 = {LOAD}\n[motor]\nresistance_ohm = {OHM}\ntorque_constant = {}\n\
         rotor_inertia = {ROTOR}\nfriction_torque = {KNOWN}\n[[wheel]]\nx_m = 0\ny_m = 0\ndrive_deg = 0\n",
        constant * KT
    );
    of_files(&text, (0..3).map(|index| run(index, seed, unknown, counted)))
}

/// What is wrong with analyses that should name one effect of one size.
fn faults(name: &str, truth: f64, analysed: impl Fn(u64) -> Analysis + Sync) -> String {
    let fault = |seed: u64| {
        let a = analysed(seed);
        let right = names(&a) == [name]
            && matches!(a.effects[0].parameters[0].2, Interval::Ci95([low, high]) if (low..=high).contains(&truth));
        (!right).then(|| format!("{seed}: {}", a.terminal_summary()))
    };
    (1..5_u64).into_par_iter().filter_map(fault).collect::<Vec<_>>().join("\n")
}

/// Where the wheel turns round, counts do not say which way friction acts, and a warmer motor with a lighter rotor fitted what
/// that leaves.
#[test]
fn friction_is_no_warm_motor_with_a_light_rotor() {
    assert_eq!(faults("coulomb-friction", DRY, |seed| analysed(seed, DRY, COUNTS, 1.0)), "");
}

/// Twice the counts are half the motor constant, a quarter of the inertia and half the friction, all three by one number.
#[test]
fn twice_the_counts_are_no_three_effects() {
    assert_eq!(faults("encoder-scale", 1.0, |seed| analysed(seed, 0.0, 2.0 * COUNTS, 1.0)), "");
}

/// A constant that was guessed from another motor's.
#[test]
fn a_motor_constant_that_is_far_too_large_is_no_bridge() {
    assert_eq!(faults("torque-constant", 1.0 / 3.5 - 1.0, |seed| analysed(seed, 0.0, COUNTS, 3.5)), "");
}
