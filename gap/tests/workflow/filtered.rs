//! Speeds that a firmware filters before it logs them.

use gap::{Analysis, Interval, Verdict};
use model::manoeuvre::Manoeuvre;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use runs::Run;
use runs::robot::Robot;

use super::common::{cut_all, names, of_files, simulate, with, with_dry_friction};

const VOLT: f64 = 12.0;
const OHM: f64 = 3.8;
const KT: f64 = 0.0083;
const GEAR: f64 = 9.68;
/// At the motor shaft, kg m².
const ROTOR: f64 = 4e-7;

/// What a motor is like beyond its file, and how its speed is logged.
#[derive(Clone, Copy, Default)]
struct Logged {
    /// Time constant of a low-pass, s.
    filter_s: f64,
    /// That of another after it, s.
    again_s: f64,
    /// Length of a mean, s.
    mean_s: f64,
    /// Age of the duty that acts, s.
    late_s: f64,
    /// Inertia, relative.
    heavier: f64,
}

/// A lifted motor under steps of its duty, with noise of the logged speed in rad/s.
fn steps(seed: u64, logged: Logged, noise: f64) -> Analysis {
    let text = format!(
        "encoder_counts_per_motor_rev = 2048\ngear_ratio = {GEAR}\nsupply_v = {VOLT}\nsupport = \"blocks\"\n\
         wheel_radius_m = 0.03\n[motor]\nresistance_ohm = {OHM}\ntorque_constant = {KT}\nrotor_inertia = {ROTOR}\n\
         friction_torque = 0\n[[wheel]]\nx_m = 0\ny_m = 0\ndrive_deg = 0\n"
    );
    let run = |n| {
        let mut rng = ChaCha8Rng::seed_from_u64(10 * seed + n);
        let mut run = Run { name: format!("{n}"), ..Run::default() };
        let (mut speed, mut seen, mut duty) = (0.0_f64, [0.0; 2], 0.0);
        let (mut duties, mut speeds, mut past) = (Vec::<f64>::new(), Vec::new(), Vec::new());
        for row in 0..4000_usize {
            if row % 250 == 0 {
                duty = rng.random_range(-0.8..0.8);
            }
            run.t.push(row as f64 * 1e-3);
            duties.push(duty);
            past.push(seen[1]);
            let meant = &past[row.saturating_sub((logged.mean_s * 1e3) as usize)..];
            speeds.push(meant.iter().sum::<f64>() / meant.len() as f64 + noise * rng.random_range(-1.0..1.0));
            let acts = row.checked_sub((logged.late_s * 1e3) as usize).map_or(0.0, |k| duties[k]);
            for _ in 0..10 {
                let torque = KT * (VOLT * acts - KT * GEAR * speed) / OHM;
                speed += 1e-4 * torque / ROTOR / (1.0 + logged.heavier) / GEAR;
                let mut input = speed;
                for (out, s) in seen.iter_mut().zip([logged.filter_s, logged.again_s]) {
                    *out += if s > 0.0 { 1e-4 * (input - *out) / s } else { input - *out };
                    input = *out;
                }
            }
        }
        (run.duty, run.speed) = (vec![duties], vec![speeds]);
        run
    };
    of_files(&text, (0..4).map(run))
}

const PLAIN: Logged = Logged { filter_s: 0.0, again_s: 0.0, mean_s: 0.0, late_s: 0.0, heavier: 0.0 };
/// Time constant of the motor, s.
const OWN_S: f64 = ROTOR * OHM / (KT * KT);

/// Whether a parameter's interval holds a value.
fn holds(a: &Analysis, name: &str, value: f64) -> bool {
    let effect = a.effects.iter().find(|e| e.name == name);
    effect.is_some_and(|e| matches!(e.parameters[0].2, Interval::Ci95([low, high]) if low <= value && value <= high))
}

#[test]
fn a_low_pass_on_speeds_is_named_with_its_time_constant() {
    let cases = [(0.005, 1.0), (0.01, 0.3), (0.01, 2.0), (0.05, 1.0), (0.1, 0.3)];
    let faults: Vec<String> = cases
        .into_par_iter()
        .enumerate()
        .filter_map(|(k, (filter_s, noise))| {
            let a = steps(20 + k as u64, Logged { filter_s, ..PLAIN }, noise);
            let right = names(&a) == ["speed-filter"] && holds(&a, "speed-filter", filter_s);
            (!right).then(|| format!("{filter_s} {noise}: {:?} {}", a.effects, a.terminal_summary()))
        })
        .collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn what_is_no_low_pass_is_not_called_one() {
    let a = steps(1, PLAIN, 0.3);
    assert_eq!((a.verdict, &names(&a)[..]), (Verdict::Agrees, &[][..]), "{}", a.terminal_summary());
    for noise in [0.3, 2.0] {
        let a = steps(2, Logged { heavier: 0.8, ..PLAIN }, noise);
        let right = names(&a) == ["rotor-inertia"] && holds(&a, "rotor-inertia", 0.8);
        let tied = a.alternatives.iter().flatten().any(|name| name == "speed-filter");
        assert!(right && !tied, "{noise}: {}", a.terminal_summary());
        assert!(!a.remarks.iter().any(|r| r.contains("filter")), "{:?}", a.remarks);
        let a = steps(3, Logged { late_s: 0.02, ..PLAIN }, noise);
        assert!(names(&a) == ["actuation-latency"], "{noise}: {}", a.terminal_summary());
    }
    // A mean is as late throughout as a delay.
    let a = steps(4, Logged { mean_s: 0.04, ..PLAIN }, 1.0);
    let said = a.remarks.iter().any(|r| (38..=41).any(|ms| r.contains(&format!("a mean of {ms} ms"))));
    assert!(said && a.verdict == Verdict::Ambiguous, "{}", a.terminal_summary());
}

#[test]
fn a_filter_as_slow_as_its_motor_may_be_either() {
    for (seed, filter_s, heavier) in [(5, 0.02, 0.0), (6, 0.03, 0.0), (7, 0.05, 0.5), (8, 0.012, 0.4)] {
        let a = steps(seed, Logged { filter_s, heavier, ..PLAIN }, 1.0);
        let tied = a
            .alternatives
            .iter()
            .any(|set| ["speed-filter", "rotor-inertia"].iter().all(|n| set.contains(&(*n).to_owned())));
        // Of which of the two that are named, and of the two exchanged, one is the truth.
        let exchanged = a.remarks.iter().find_map(|r| {
            let (_, after) = r.split_once("a speed-filter of ")?;
            let (ms, inertia) = after.split_once(" ms with ")?;
            Some((ms.parse::<f64>().ok()?, inertia.to_owned()))
        });
        let is_true = holds(&a, "speed-filter", filter_s) && (heavier == 0.0 || holds(&a, "rotor-inertia", heavier));
        let other_is_true = exchanged.is_some_and(|(ms, inertia)| {
            let turns = inertia
                .split_once(" of ")
                .and_then(|(_, r)| r.split_once(" %"))
                .map_or(0.0, |(p, _)| p.parse::<f64>().unwrap());
            (1e-3 * ms / filter_s - 1.0).abs() < 0.12 && ((1.0 + 0.01 * turns) / (1.0 + heavier) - 1.0).abs() < 0.12
        });
        assert!(OWN_S > 0.02 && a.verdict == Verdict::Ambiguous, "{}", a.terminal_summary());
        assert!(is_true && (tied || heavier > 0.0) || other_is_true, "{filter_s} {heavier}: {}", a.terminal_summary());
    }
}

/// A filter of second order is one of first order and a delay, about.
#[test]
fn two_filters_are_a_filter_and_a_delay() {
    let a = steps(9, Logged { filter_s: 0.01, again_s: 0.01, ..PLAIN }, 1.0);
    assert_eq!(names(&a), ["speed-filter", "actuation-latency"], "{}", a.terminal_summary());
    let late: f64 = a.effects.iter().map(|e| e.parameters[0].1).sum();
    assert!((late - 0.02).abs() < 0.002 && a.verdict == Verdict::Ambiguous, "{late}");
    assert!(a.remarks.iter().any(|r| r.contains("or filters twice")), "{:?}", a.remarks);
}

/// A robot with a camera whose firmware logs speeds through a low-pass, or late, in place of counts.
fn driven(seed: u64, name: &str, parameter: &str, seconds: f64) -> Analysis {
    let robot = Robot::racbot();
    let truth = with(&robot, name, &[(parameter, seconds)]);
    let drives = [Manoeuvre::Square, Manoeuvre::StopAndGo, Manoeuvre::Star, Manoeuvre::Chirp];
    let mut set = simulate(&truth, &drives, seed);
    cut_all(&mut set, 7.0);
    let per_count = 1.0 / robot.counts_per_wheel_rad();
    let runs = set.runs.into_iter().map(|mut run| {
        let speed = |i: usize| {
            let counts = run.cumulative(i);
            let turned = |k: usize| per_count * (counts[k] - counts[k.saturating_sub(1)]);
            (0..run.t.len()).map(|k| turned(k) / (run.t[1] - run.t[0])).collect()
        };
        run.speed = (0..robot.wheel_count()).map(speed).collect();
        run.counts.clear();
        run
    });
    of_files(&set.robot.to_toml(), runs)
}

/// Against a camera a low-pass is a delay; the drive shows its shape.
#[test]
fn a_low_pass_on_the_speeds_of_a_robot_is_no_late_counts() {
    let faults: Vec<String> = [0.01, 0.02, 0.04]
        .into_par_iter()
        .enumerate()
        .flat_map(|(k, seconds)| {
            let filter = driven(60 + k as u64, "speed-filter", "time_s", seconds);
            let lag = driven(60 + k as u64, "encoder-lag", "latency_s", seconds);
            let right = names(&filter) == ["speed-filter"] && holds(&filter, "speed-filter", seconds);
            let said = format!("{seconds}: {:?} {}", filter.effects, filter.terminal_summary());
            let late = names(&lag) == ["encoder-lag"] && holds(&lag, "encoder-lag", seconds);
            let lags = format!("{seconds} late: {:?} {}", lag.effects, lag.terminal_summary());
            [(!right).then_some(said), (!late).then_some(lags)].into_iter().flatten().collect::<Vec<_>>()
        })
        .collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// A delay of two time constants, beside which 20 ms between rows hide how a motor starts: three times its inertia left less
/// than a straight line through no delay promised.
#[test]
fn a_delay_longer_than_the_motor_takes_is_no_inertia() {
    let faults = [1, 2, 3].into_par_iter().filter_map(|seed| {
        let a = delayed_winch(seed);
        let right = names(&a) == ["actuation-latency"] && holds(&a, "actuation-latency", WINCH_LATE_S);
        (!right).then(|| format!("{seed}: {:?} {}", a.effects, a.terminal_summary()))
    });
    let faults: Vec<String> = faults.collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// Delay of a geared motor's duties, s.
const WINCH_LATE_S: f64 = 0.035;

/// That motor under sines that get faster, and steps, in rows of 20 ms.
fn delayed_winch(seed: u64) -> Analysis {
    let [volt, ohm, kt, gear, rotor, load, dry] = [24.0, 0.9, 0.055, 60.0, 3e-5, 0.12, 0.9];
    let counts = 48.0 * gear / std::f64::consts::TAU;
    let text = format!(
        "encoder_counts_per_motor_rev = 48\ngear_ratio = {gear}\nsupply_v = {volt}\nsupport = \"blocks\"\n\
         wheel_radius_m = 1\ncontrol_rate_hz = 50\nwheel_inertia_kg_m2 = {load}\n[motor]\nresistance_ohm = {ohm}\n\
         torque_constant = {kt}\nrotor_inertia = {rotor}\nfriction_torque = {}\n[[wheel]]\nx_m = 0\ny_m = 0\n\
         drive_deg = 0\n",
        dry / gear
    );
    let inertia = load + gear * gear * rotor;
    let run = |n: u64| {
        let mut rng = ChaCha8Rng::seed_from_u64(10 * seed + n);
        let mut run = Run { name: format!("{n}"), ..Run::default() };
        let (mut angle, mut speed, mut level) = (0.0_f64, 0.0_f64, 0.0);
        let (mut duties, mut seen) = (vec![0.0_f64], Vec::new());
        for row in 0..1500_u32 {
            let at = f64::from(row % 300) / 50.0;
            if row % 30 == 0 {
                level = rng.random_range(-0.8..0.8);
            }
            let asked = if at < 2.0 { 0.65 * (std::f64::consts::TAU * (0.4 + 0.8 * at) * at).sin() } else { level };
            run.t.push(0.02 * f64::from(row));
            seen.push((angle * counts).floor() as i64);
            duties.push(asked);
            for step in 0..200 {
                // The row in which a duty acts begins 35 ms after its own.
                let late = usize::from(step < 150) + 1;
                let duty = duties[(row as usize + 1).saturating_sub(late)];
                let torque = gear * kt * (volt * duty - kt * gear * speed) / ohm + 0.2 * rng.random_range(-1.0..1.0);
                speed = with_dry_friction(speed, torque, dry, inertia, 1e-4);
                angle += 1e-4 * speed;
            }
        }
        duties.remove(0);
        (run.duty, run.counts) = (vec![duties], vec![seen]);
        run
    };
    of_files(&text, (0..3).map(run))
}
