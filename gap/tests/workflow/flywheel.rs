//! A flywheel as SysId characterises it: two slow ramps of the voltage and two steps, and speeds alone.

use super::common::{names, of_files, with_dry_friction};
use gap::{Analysis, Interval};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use runs::Run;

/// Supply, V, resistance, ohm, motor constant, Nm/A, gear, and inertia of the load and of the rotor, kg m².
const VOLT: f64 = 12.0;
const OHM: f64 = 0.114;
const KT: f64 = 0.0181;
const GEAR: f64 = 5.45;
const LOAD: f64 = 4e-3;
const ROTOR: f64 = 3e-5;
/// Friction that the file does not know: 6 % of the supply, Nm, and viscous, Nm s.
const DRY: f64 = GEAR * KT * 0.72 / OHM;
const VISCOUS: f64 = 0.0095;
/// Standard deviation of a speed, rad/s: a count of 4096 within 5 ms.
const SPEED: f64 = 0.3;

fn run(name: &str, seed: u64, seconds: f64, volts: impl Fn(f64) -> f64) -> Run {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut run = Run { name: name.to_owned(), ..Run::default() };
    let (mut speed, mut angle, mut before, mut held) = (0.0_f64, 0.0, 0.0, 0.0);
    let (mut duties, mut speeds) = (Vec::new(), Vec::new());
    let inertia = LOAD + GEAR * GEAR * ROTOR;
    for row in 0..(seconds / 0.005) as usize {
        let t = 0.005 * row as f64;
        // The controller sends a mean speed every fourth row.
        if row % 4 == 0 {
            let noise = 12.0_f64.sqrt() / 2.0 * (0..4).map(|_| rng.random_range(-0.5..0.5)).sum::<f64>();
            held = if speed == 0.0 { 0.0 } else { (angle - before) / 0.02 + SPEED * noise };
            before = angle;
        }
        run.t.push(t + rng.random_range(-3e-4..3e-4));
        duties.push(volts(t) / VOLT);
        speeds.push(held);
        for _ in 0..20 {
            let torque = GEAR * KT * (volts(t) - KT * GEAR * speed) / OHM - VISCOUS * speed;
            let next = with_dry_friction(speed, torque, DRY, inertia, 2.5e-4);
            angle += 1.25e-4 * (speed + next);
            speed = next;
        }
    }
    run.duty = vec![duties];
    run.speed = vec![speeds];
    run
}

fn characterised(seed: u64) -> Analysis {
    let text = format!(
        "encoder_counts_per_wheel_rev = 4096\ngear_ratio = {GEAR}\nsupply_v = {VOLT}\nsupport = \"blocks\"\n\
         wheel_radius_m = 1\nwheel_inertia_kg_m2 = {LOAD}\n[motor]\nresistance_ohm = {OHM}\ntorque_constant = {KT}\n\
         rotor_inertia = {ROTOR}\nfriction_torque = 0\n[[wheel]]\nx_m = 0\ny_m = 0\ndrive_deg = 0\n"
    );
    let step = |t: f64| if t > 0.004 { 7.0 } else { 0.0 };
    let runs = [
        run("slow-forward", 4 * seed, 20.0, |t| 0.25 * t),
        run("slow-backward", 4 * seed + 1, 15.0, |t| -0.25 * t),
        run("fast-forward", 4 * seed + 2, 6.0, step),
        run("fast-backward", 4 * seed + 3, 5.5, |t| -step(t)),
    ];
    of_files(&text, runs)
}

/// Margins for what is not named let a bridge that is not linear, with friction of Stribeck, pass for both.
#[test]
fn dry_and_viscous_friction_are_no_bridge() {
    let faults: Vec<String> = (1..4_u64)
        .into_par_iter()
        .filter_map(|seed| {
            let a = characterised(seed);
            let named = |name: &str, truth: f64| {
                a.effects.iter().filter(|e| e.name == name).any(|e| match e.parameters[0].2 {
                    Interval::Ci95([low, high]) => (low..=high).contains(&truth),
                    _ => false,
                })
            };
            let tied = |one: &str, other: &str| {
                a.alternatives.iter().any(|set| [one, other].iter().all(|n| set.iter().any(|s| s == n)))
            };
            // A wheel that turns one way in a run tells dry friction from a dead band at its very start only.
            let dry = named("coulomb-friction", DRY)
                || named("dead-band", DRY / (GEAR * KT / OHM) / VOLT) && tied("dead-band", "coulomb-friction");
            (!dry || !named("viscous-friction", VISCOUS))
                .then(|| format!("{seed}: {:?}\n{}", names(&a), a.terminal_summary()))
        })
        .collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}
