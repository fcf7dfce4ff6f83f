//! A gear with play between two bodies that both rub: flanks are springs of 3000 Nm/rad, steps of 5 µs.

use gap::{Analysis, Interval, Verdict};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use runs::Run;

use super::common::{names, of_files, with_dry_friction};

/// Supply, V, resistance, ohm, motor constant, Nm/A, gear, inertia of the rotor, kg m², counts of its encoder.
const VOLT: f64 = 24.0;
const OHM: f64 = 1.2;
const KT: f64 = 0.04;
const GEAR: f64 = 20.0;
const ROTOR: f64 = 3e-5;
const COUNTS: f64 = 2000.0;
/// Of the flanks, Nm/rad and Nm s/rad.
const FLANK: f64 = 3000.0;
const DAMPED: f64 = 2.0;
const STEPS: u32 = 400;

/// Play, rad at the motor, friction of rotor and load and what of it the file knows, Nm, inertia of the load, kg m².
#[derive(Clone, Copy)]
struct Truth {
    play: f64,
    of_rotor: f64,
    of_load: f64,
    known: f64,
    load: f64,
}

fn run(index: u64, seed: u64, truth: Truth) -> Run {
    let mut rng = ChaCha8Rng::seed_from_u64(10 * seed + index);
    let mut run = Run { name: format!("run-{index}"), ..Run::default() };
    let half = 0.5 * truth.play / GEAR;
    let (mut rotor, mut load, mut ahead, mut angle) = (0.0_f64, 0.0_f64, 0.0_f64, 0.0_f64);
    let (mut level, mut next, mut duties, mut counts) = (0.0, 0.3, Vec::new(), Vec::new());
    let (rate, most) = (rng.random_range(0.3..0.5), rng.random_range(0.2..0.45));
    for row in 0..6000 {
        let t = 0.002 * f64::from(row);
        if t >= next {
            level = rng.random_range(-0.45..0.45);
            next = t + rng.random_range(0.3..1.0);
        }
        let duty = if index < 3 { level } else { most * (std::f64::consts::TAU * rate * t).sin() };
        run.t.push(t);
        duties.push(duty);
        counts.push((angle * GEAR * COUNTS / std::f64::consts::TAU).floor() as i64);
        let step = 0.002 / f64::from(STEPS);
        for _ in 0..STEPS {
            let torque = (duty * VOLT - KT * GEAR * rotor) / OHM * KT * GEAR;
            let bent = ahead - ahead.clamp(-half, half);
            let pushed = FLANK * bent + DAMPED * (rotor - load);
            // Flanks do not pull.
            let passed = if bent * pushed > 0.0 { pushed } else { 0.0 };
            rotor = with_dry_friction(rotor, torque - passed, truth.of_rotor, ROTOR * GEAR * GEAR, step);
            load = with_dry_friction(load, passed, truth.of_load, truth.load, step);
            angle += step * rotor;
            ahead += step * (rotor - load);
        }
    }
    run.duty = vec![duties];
    run.counts = vec![counts];
    run.count_gaps = vec![Vec::new()];
    run
}

fn analysed(seed: u64, truth: Truth) -> Analysis {
    let text = format!(
        "encoder_counts_per_motor_rev = {COUNTS}\ngear_ratio = {GEAR}\nsupply_v = {VOLT}\nsupport = \"blocks\"\n\
         control_rate_hz = 500\nwheel_radius_m = 0.05\nwheel_inertia_kg_m2 = {}\n[motor]\nresistance_ohm = {OHM}\n\
         torque_constant = {KT}\nrotor_inertia = {ROTOR}\nfriction_torque = {}\n[[wheel]]\nx_m = 0\ny_m = 0\n\
         drive_deg = 0\n",
        truth.load,
        truth.known / GEAR
    );
    let runs: Vec<Run> = (0..5).into_par_iter().map(|index| run(index, seed, truth)).collect();
    of_files(&text, runs)
}

/// Whether an effect's parameter has an interval that holds its true size.
fn holds(a: &Analysis, name: &str, parameter: &str, size: f64) -> bool {
    let mut all = a.effects.iter().filter(|e| e.name == name).flat_map(|e| &e.parameters);
    all.any(|(name, _, interval)| {
        name == parameter && matches!(interval, Interval::Ci95([low, high]) if *low <= size && size <= *high)
    })
}

/// Play of five times its limit beside friction that the file knows was fitted and not named.
#[test]
fn play_is_named_wherever_the_friction_sits() {
    let cases = [(1, 1.0, 1.0, 0.03), (2, 0.3, 1.5, 0.02), (3, 2.5, 0.3, 0.03), (4, 0.3, 2.5, 0.03)];
    let faults = cases.into_par_iter().filter_map(|(seed, of_rotor, of_load, load)| {
        let truth = Truth { play: 1.2, of_rotor, of_load, known: of_rotor + of_load, load };
        let a = analysed(seed, truth);
        let right = names(&a) == ["gear-backlash"]
            && holds(&a, "gear-backlash", "play_rad", truth.play)
            && holds(&a, "gear-backlash", "load_friction_nm", of_load);
        (!right).then(|| format!("{seed}: {}", a.terminal_summary()))
    });
    assert_eq!(faults.collect::<Vec<_>>().join("\n"), "");
}

#[test]
fn friction_that_nobody_knew_is_named_beside_the_play() {
    let truth = Truth { play: 1.2, of_rotor: 0.2, of_load: 1.5, known: 0.0, load: 0.04 };
    let a = analysed(5, truth);
    let mut found = names(&a);
    found.sort_unstable();
    assert_eq!(found, ["coulomb-friction", "gear-backlash"], "{}", a.terminal_summary());
    assert!(holds(&a, "coulomb-friction", "torque_nm", 1.7), "{}", a.terminal_summary());
    assert!(holds(&a, "gear-backlash", "play_rad", truth.play), "{}", a.terminal_summary());
    assert!(holds(&a, "gear-backlash", "load_friction_nm", truth.of_load), "{}", a.terminal_summary());
}

#[test]
fn a_gear_without_play_has_none() {
    let faults =
        [(6, 1.0, 1.0, 0.03), (7, 0.3, 2.5, 0.01)].into_par_iter().filter_map(|(seed, of_rotor, of_load, load)| {
            let a = analysed(seed, Truth { play: 0.0, of_rotor, of_load, known: of_rotor + of_load, load });
            (a.verdict != Verdict::Agrees).then(|| format!("{seed}: {}", a.terminal_summary()))
        });
    assert_eq!(faults.collect::<Vec<_>>().join("\n"), "");
}
