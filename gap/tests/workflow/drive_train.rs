//! A drive train of 50 kg as SysId characterises it: slow ramps of the voltage and steps, on the floor, with a coarse
//! encoder or with speeds alone.

use gap::{Analysis, Interval, Verdict};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use runs::Run;

use super::common::{names, of_files, with_dry_friction};

/// Supply, V, resistance, ohm, motor constant, Nm/A, gear, radius of a wheel, m, mass, kg.
const VOLT: f64 = 12.0;
const OHM: f64 = 0.114;
const KT: f64 = 0.0195;
const GEAR: f64 = 8.46;
const RADIUS: f64 = 0.076;
const MASS: f64 = 50.0;
/// Friction at a wheel that the file does not know, Nm, as of 0.7 V.
const DRY: f64 = GEAR * KT * 0.7 / OHM;
/// Counts of a turn of the wheel: 42 of the motor's.
const COUNTS: f64 = 42.0 * GEAR;

/// What a log has of the wheels.
#[derive(Clone, Copy, PartialEq)]
enum Logged {
    Counts,
    /// Mean speeds of 40 ms.
    Speeds,
}

/// A robot with so much friction that the file does not know, Nm, and so many counts a turn of the wheel.
#[derive(Clone, Copy)]
struct Truth {
    dry: f64,
    counts: f64,
}

fn run(name: &str, seed: u64, logged: Logged, truth: Truth, seconds: f64, volts: impl Fn(f64) -> f64) -> Run {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut run = Run { name: name.to_owned(), ..Run::default() };
    let (mut speed, mut angle) = (0.0_f64, 0.0_f64);
    let (mut duties, mut angles) = (Vec::new(), Vec::new());
    // Both wheels drive alike: each has half the robot.
    let inertia = 0.5 * MASS * RADIUS * RADIUS;
    for row in 0..(seconds / 0.005) as usize {
        let t = 0.005 * row as f64;
        run.t.push(t + rng.random_range(-2e-4..2e-4));
        duties.push(volts(t) / VOLT);
        angles.push(angle);
        for _ in 0..20 {
            let torque = GEAR * KT * (volts(t) - KT * GEAR * speed) / OHM;
            let next = with_dry_friction(speed, torque, truth.dry, inertia, 2.5e-4);
            angle += 1.25e-4 * (speed + next);
            speed = next;
        }
    }
    // Poles are not where they should be by up to three counts.
    let counted =
        angles.iter().map(|a| (a * truth.counts / std::f64::consts::TAU + rng.random_range(-3.0..3.0)).floor());
    let counted: Vec<f64> = counted.collect();
    run.duty = vec![duties.clone(), duties];
    if logged == Logged::Counts {
        run.counts = vec![counted.iter().map(|c| *c as i64).collect(); 2];
        run.count_gaps = vec![Vec::new(); 2];
    } else {
        let per_count = std::f64::consts::TAU / COUNTS;
        let mean = |k: usize| (counted[k] - counted[k.saturating_sub(8)]) * per_count / 0.04;
        run.speed = vec![(0..counted.len()).map(mean).collect(); 2];
    }
    run
}

fn characterised(seed: u64, logged: Logged, truth: Truth) -> Analysis {
    let text = format!(
        "encoder_counts_per_wheel_rev = {COUNTS}\ngear_ratio = {GEAR}\nsupply_v = {VOLT}\nwheel_radius_m = {RADIUS}\n\
         mass_kg = {MASS}\nyaw_inertia_kg_m2 = 3\n[motor]\nresistance_ohm = {OHM}\ntorque_constant = {KT}\n\
         rotor_inertia = 0\nfriction_torque = 0\n[[wheel]]\nx_m = 0.26\ny_m = 0\ndrive_deg = 90\n\
         [[wheel]]\nx_m = -0.26\ny_m = 0\ndrive_deg = 90\n"
    );
    let step = |t: f64| if t > 0.1 { 7.0 } else { 0.0 };
    let runs = [
        run("slow-forward", 4 * seed, logged, truth, 18.0, |t| 0.25 * t),
        run("slow-backward", 4 * seed + 1, logged, truth, 18.0, |t| -0.25 * t),
        run("fast-forward", 4 * seed + 2, logged, truth, 4.0, step),
        run("fast-backward", 4 * seed + 3, logged, truth, 4.0, |t| -step(t)),
    ];
    of_files(&text, runs)
}

/// A heavy robot speeds up slowly, and a coarse encoder says next to nothing of that within an eighth of a second: in test
/// functions of that length its friction of 0.06 duty was noise, and the verdict that it agrees. Where its size does not show
/// on four runs, that is said.
#[test]
fn friction_of_a_heavy_robot_shows_through_a_coarse_encoder() {
    for (seed, logged) in [(1, Logged::Counts), (2, Logged::Counts), (1, Logged::Speeds)] {
        let a = characterised(seed, logged, Truth { dry: DRY, counts: COUNTS });
        if a.verdict == Verdict::Unexplained {
            let mut said =
                a.unexplained.iter().filter(|u| u.structure.contains("coulomb-friction closes a part of it"));
            assert!(said.next().is_some(), "{seed}: {}", a.terminal_summary());
            continue;
        }
        assert!(matches!(a.verdict, Verdict::MissingEffect | Verdict::Ambiguous), "{seed}: {}", a.terminal_summary());
        let dry = a.effects.iter().find(|e| e.name == "coulomb-friction");
        let within = dry.is_some_and(|e| match e.parameters[0].2 {
            Interval::Ci95([low, high]) => (low..=high).contains(&DRY),
            _ => false,
        });
        let tied = a.alternatives.iter().any(|set| set.iter().any(|name| name == "coulomb-friction"));
        assert!(within || dry.is_none() && tied, "{seed}: {DRY} {:?}\n{}", names(&a), a.terminal_summary());
    }
}

/// Without a camera all wheels of a robot that turn as much faster or slower are those of another motor in another robot; what a
/// decoder makes of counts is likelier.
#[test]
fn twice_or_half_the_counts_of_all_wheels_are_a_decoder_s() {
    for (seed, factor) in [(5, 2.0), (6, 0.5)] {
        let a = characterised(seed, Logged::Counts, Truth { dry: 0.0, counts: factor * COUNTS });
        let said = a.terminal_summary();
        assert_eq!(names(&a), ["encoder-scale"], "{said}");
        let Interval::Ci95([low, high]) = a.effects[0].parameters[0].2 else { panic!("{said}") };
        assert!(low <= factor - 1.0 && factor - 1.0 <= high, "{said}");
    }
}
