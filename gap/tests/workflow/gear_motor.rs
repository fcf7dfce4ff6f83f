//! A gear motor of 12 V on a bench, with an encoder of 48 counts: levels with stops, random levels and a sweep, as a team
//! would drive it. Iron and a gear that rubs more one way are in it, as in any.

use super::common::{names, of_files, with_dry_friction};
use gap::{Analysis, Interval};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use runs::Run;

/// Supply, V, resistance, ohm, motor constant, Nm/A, gear, inertia of the load and of the rotor, kg m², friction at the
/// motor, Nm.
const VOLT: f64 = 12.0;
const OHM: f64 = 2.4;
const KT: f64 = 0.016;
const GEAR: f64 = 30.0;
const LOAD: f64 = 9e-4;
const ROTOR: f64 = 1.4e-6;
const KNOWN: f64 = 8e-4;
const COUNTS: f64 = 48.0 * GEAR;
/// What iron takes at the wheel, Nm s, and what more the gear rubs one way than the other, as a share.
const IRON: f64 = 0.001 * GEAR * GEAR * KT * KT / OHM;
const ONE_WAY: f64 = 0.03;
const ROW_S: f64 = 0.01;

/// What differs from the file: the supply, as a factor, and frictions at the wheel, Nm and Nm s.
#[derive(Clone, Copy)]
struct Truth {
    supply: f64,
    dry: f64,
    viscous: f64,
}

fn run(index: u64, seed: u64, truth: Truth) -> Run {
    let mut rng = ChaCha8Rng::seed_from_u64(10 * seed + index);
    let mut run = Run { name: format!("run-{index}"), ..Run::default() };
    let (mut speed, mut angle, mut current, mut asked) = (0.0_f64, 0.0_f64, 0.0_f64, 0.0_f64);
    let (mut duties, mut counts) = (Vec::new(), Vec::new());
    let (mut to, mut level, mut step) = (40, 0.0, 0_u32);
    let rate = if index.is_multiple_of(2) { 2.7 } else { 5.4 };
    for row in 0..1200 {
        let t = ROW_S * f64::from(row);
        if row >= to {
            step += 1;
            level = match index % 3 {
                0 if step.is_multiple_of(2) => 0.0,
                0 => 0.18 * f64::from(1 + step / 2 % 5) * if step / 2 % 2 == 0 { 1.0 } else { -1.0 },
                _ => rng.random_range(-0.9..0.9),
            };
            to = row + if level == 0.0 { 45 } else { rng.random_range(50..150) };
        }
        asked += (level - asked).clamp(-rate * ROW_S, rate * ROW_S);
        let sweep = 0.7 * (std::f64::consts::TAU * (0.2 + 0.06 * t) * t).sin();
        let duty = if index % 3 == 2 { sweep } else { asked };
        let duty = (255.0 * duty).round() / 255.0;
        run.t.push(t);
        counts.push((angle * COUNTS / std::f64::consts::TAU).floor() as i64);
        duties.push(duty);
        for _ in 0..100 {
            let ends = (duty * VOLT * truth.supply - KT * GEAR * speed) / OHM;
            current = ends + (current - ends) * (-1e-4 * OHM / 1e-4_f64).exp();
            let torque = GEAR * KT * current - (IRON + truth.viscous) * speed;
            let dry = GEAR * KNOWN * (1.0 + ONE_WAY * speed.signum()) + truth.dry;
            let next = with_dry_friction(speed, torque, dry, LOAD + GEAR * GEAR * ROTOR, 1e-4);
            angle += 0.5e-4 * (speed + next);
            speed = next;
        }
    }
    run.duty = vec![duties];
    run.counts = vec![counts];
    run.count_gaps = vec![Vec::new()];
    run
}

fn analysed(seed: u64, truth: Truth) -> Analysis {
    let text = format!(
        "encoder_counts_per_motor_rev = 48\ngear_ratio = {GEAR}\nsupply_v = {VOLT}\nsupport = \"blocks\"\n\
         duty_quantum = 0.003922\nwheel_radius_m = 0.05\nwheel_inertia_kg_m2 = {LOAD}\n[motor]\nresistance_ohm = {OHM}\n\
         torque_constant = {KT}\nrotor_inertia = {ROTOR}\nfriction_torque = {KNOWN}\n[[wheel]]\nx_m = 0\ny_m = 0\n\
         drive_deg = 0\n"
    );
    of_files(&text, (0..6).map(|index| run(index, seed, truth)))
}

/// What is wrong with analyses that should name effects of these sizes.
fn faults(expected: &[(&str, f64)], truth: Truth, seeds: [u64; 3]) -> String {
    let fault = |seed: u64| {
        let a = analysed(seed, truth);
        let holds = |(name, size): &(&str, f64)| {
            a.effects.iter().any(|e| {
                e.name == *name
                    && matches!(e.parameters[0].2, Interval::Ci95([low, high]) if (low..=high).contains(size))
            })
        };
        let right = names(&a).len() == expected.len() && expected.iter().all(holds);
        (!right).then(|| format!("{seed}: {}", a.terminal_summary()))
    };
    seeds.into_par_iter().filter_map(fault).collect::<Vec<_>>().join("\n")
}

/// A supply that is higher by a share is a motor of a smaller constant and less resistance, to the last digit: the one has
/// the name.
#[test]
fn a_full_battery_is_no_motor_of_two_other_constants() {
    let truth = Truth { supply: 1.15, dry: 0.0, viscous: 0.0 };
    assert_eq!(faults(&[("supply-voltage", 0.15)], truth, [3, 10, 11]), "");
}

/// Friction of a tenth of the stall torque, and a viscous one of 5 % of it at full speed.
#[test]
fn two_frictions_are_no_four_laws() {
    let expected = [("coulomb-friction", 0.19), ("viscous-friction", 0.0062)];
    assert_eq!(faults(&expected, Truth { supply: 1.0, dry: 0.19, viscous: 0.0062 }, [4, 6, 22]), "");
}
