//! A gear motor logged at 50 Hz whose duties act half a row later than logged: steps of a duty are no straight line in a latency.

use super::common::{names, of_files};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use runs::Run;

/// Resistance, ohm, motor constant, Nm/A, gear, counts a turn of the motor, inertia of rotor and load, kg m², and friction at the
/// motor, Nm.
const OHM: f64 = 26.0;
const KT: f64 = 0.0021;
const GEAR: f64 = 136.0;
const COUNTS: f64 = 12.0;
const ROTOR: f64 = 1.6e-9;
const LOAD: f64 = 2e-6;
const DRY: f64 = 1.6e-5;
const VOLT: f64 = 5.0;
const LATENCY_S: f64 = 0.01;

/// Twenty seconds of duties that step every one or two.
fn run(seed: u64) -> Run {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut run = Run { name: format!("run-{seed}"), ..Run::default() };
    let (mut angle, mut speed, mut duty, mut sent, mut until) = (0.0_f64, 0.0_f64, 0.0, 0.0, 40_u32);
    let (mut duties, mut counts) = (Vec::new(), Vec::new());
    for row in 0..1000 {
        if row == until {
            duty = if duty == 0.0 { (rng.random_range(-0.9_f64..0.9) * 255.0).round() / 255.0 } else { 0.0 };
            until += rng.random_range(50..100);
        }
        run.t.push(0.02 * f64::from(row));
        counts.push((angle * GEAR * COUNTS / std::f64::consts::TAU).floor() as i64);
        duties.push(duty);
        for step in 0..200 {
            let acts = if 1e-4 * f64::from(step) < LATENCY_S { sent } else { duty };
            let inertia = LOAD + GEAR * GEAR * ROTOR;
            let torque = GEAR * KT * (acts * VOLT - KT * GEAR * speed) / OHM;
            let dry = GEAR * DRY;
            let free = speed + 1e-4 * torque / inertia;
            speed = if free.abs() < 1e-4 * dry / inertia { 0.0 } else { free - 1e-4 * dry / inertia * free.signum() };
            angle += 1e-4 * speed;
        }
        sent = duty;
    }
    run.duty = vec![duties];
    run.counts = vec![counts];
    run.count_gaps = vec![Vec::new()];
    run
}

#[test]
fn half_a_row_of_latency_is_named_or_tied_with_what_does_the_same() {
    let text = format!(
        "encoder_counts_per_motor_rev = {COUNTS}\ngear_ratio = {GEAR}\nsupply_v = {VOLT}\nsupport = \"blocks\"\n\
         control_rate_hz = 50\nduty_quantum = 0.0039215686\nwheel_radius_m = 1\nwheel_inertia_kg_m2 = {LOAD}\n[motor]\n\
         resistance_ohm = {OHM}\ntorque_constant = {KT}\nrotor_inertia = {ROTOR}\nfriction_torque = {DRY}\n[[wheel]]\nx_m = 0\n\
         y_m = 0\ndrive_deg = 0\n"
    );
    for seed in [10, 20, 30, 40, 50, 60] {
        let a = of_files(&text, (0..4).map(|index| run(seed + index)));
        let late = |name: &str| name == "actuation-latency";
        let tied = |name: &str| {
            a.alternatives.iter().any(|set| [name, "actuation-latency"].iter().all(|n| set.iter().any(|s| s == n)))
        };
        let named = names(&a);
        assert!(!named.is_empty() && named.iter().all(|n| late(n) || tied(n)), "{seed}: {}", a.terminal_summary());
    }
}
