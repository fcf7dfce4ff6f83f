//! A servo axis with a pendulum or a spring, by equations of motion that share nothing with the model.

use std::f64::consts::TAU;
use std::path::{Path, PathBuf};

use super::common::{names, of_files, with_dry_friction};

use gap::{Analysis, Interval, Options, Verdict, analyse};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use runs::robot::Robot;
use runs::{DataSet, Run};

/// A geared servo, by its output shaft.
#[derive(Clone, Copy, Debug)]
struct Servo {
    /// Torque with sine and cosine of the angle, N m.
    gravity: [f64; 2],
    /// Stiffness of a spring, N m/rad, and its torque where the angle is 0, N m.
    spring: [f64; 2],
    /// Share of the transmitted torque that the gear loses.
    loss: f64,
    /// Dry friction that the file does not know, N m.
    dry: f64,
    /// Inertia of the load, kg m², and what of it the file knows.
    load: [f64; 2],
    /// Mean angle in rad that the loop holds it about, and how far it swings; `None` for duties without a loop.
    about: Option<[f64; 2]>,
    /// Standard deviation of the torque that nobody explains, N m, new every 10 ms.
    scatter: f64,
    /// Counts a turn.
    counts: f64,
}

const QUIET: Servo = Servo {
    gravity: [0.0; 2],
    spring: [0.0; 2],
    loss: 0.0,
    dry: 0.0,
    load: [2e-3; 2],
    about: Some([0.4, 1.3]),
    scatter: 0.004,
    counts: 4096.0,
};
/// Torque per volt at standstill and per speed, N m/V and N m s/rad, and supply, V: 0.6 N m at most, 16 rad/s.
const KT_R: f64 = 0.05;
const DAMPING: f64 = 0.038;
const VOLT: f64 = 12.0;

fn run(servo: Servo, seed: u64) -> Run {
    let tick = 0.004;
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut run = Run { name: format!("run_{seed}"), ..Run::default() };
    let phases: Vec<f64> = (0..5).map(|_| rng.random_range(0.0..TAU)).collect();
    let waves = [(0.31, 1.0), (0.73, 0.6), (1.37, 0.3), (2.3, 0.12), (0.17, 0.8)];
    let wave = |t: f64| waves.iter().zip(&phases).map(|((f, a), p)| a * (TAU * f * t + p).sin() / 1.6).sum::<f64>();
    let (mut angle, mut speed, mut push) = (0.0_f64, 0.0_f64, 0.0);
    let (mut duties, mut counted) = (Vec::new(), Vec::new());
    for k in 0..5000 {
        let t = tick * f64::from(k);
        let duty = match servo.about {
            Some([mean, swing]) => 2.5 * (mean + swing * wave(t) - angle),
            None => 0.7 * wave(t),
        };
        let duty = (duty.clamp(-1.0, 1.0) * 1e3).round() / 1e3;
        run.t.push(t);
        duties.push(duty);
        counted.push((angle / TAU * servo.counts).floor() as i64);
        if k % 3 == 0 {
            push = servo.scatter * (0..12).map(|_| rng.random_range(-0.5..0.5)).sum::<f64>();
        }
        let step = tick / 40.0;
        for _ in 0..40 {
            let weight = servo.gravity[0] * angle.sin() + servo.gravity[1] * angle.cos();
            let held = weight + servo.spring[1] - servo.spring[0] * angle + push;
            let winding = KT_R * VOLT * duty - DAMPING * speed;
            let torque = winding + held;
            // What the rotor leaves of the winding's torque passes through the gear.
            let inertia = servo.load[0] + ROTOR;
            let transmitted = winding - ROTOR * torque / inertia;
            let friction = servo.dry + servo.loss * transmitted.abs();
            let sticks = speed == 0.0 && torque.abs() < friction;
            let sense = if speed == 0.0 { torque.signum() } else { speed.signum() };
            let next = if sticks { 0.0 } else { speed + step * (torque - friction * sense) / inertia };
            let next = if speed * next < 0.0 { 0.0 } else { next };
            angle += 0.5 * step * (speed + next);
            speed = next;
        }
    }
    run.duty = vec![duties];
    run.counts = vec![counted];
    run
}

/// Inertia of the rotor at the output shaft, kg m².
const ROTOR: f64 = 1e-3;

/// Gear 100, 2 ohm: 0.001 N m/A at the motor.
fn file(servo: Servo) -> String {
    format!(
        "encoder_counts_per_wheel_rev = {}\ngear_ratio = 100\nsupply_v = {VOLT}\nsupport = \"blocks\"\n\
         control_rate_hz = 250\nwheel_radius_m = 0.01\nwheel_inertia_kg_m2 = {}\ngear_efficiency = {}\n[motor]\nresistance_ohm = 2\n\
         torque_constant = {}\nback_emf_constant = {}\nrotor_inertia = {}\nfriction_torque = 0\n\
         [[wheel]]\nx_m = 0\ny_m = 0.1\ndrive_deg = 0\n",
        servo.counts,
        servo.load[1],
        1.0 - servo.loss,
        2.0 * KT_R / 100.0,
        DAMPING / KT_R / 100.0,
        ROTOR / 1e4,
    )
}

fn set(servo: Servo, seed: u64) -> DataSet {
    let robot = Robot::parse_partial(&file(servo), Path::new("robot.toml")).unwrap();
    let runs = (0..3).map(|k| run(servo, 10 * seed + k)).collect();
    DataSet { folder: PathBuf::from("servo"), robot, runs }
}

fn done(set: &DataSet) -> Analysis {
    analyse(set, &Options::default()).unwrap()
}

/// What is wrong with the size of a hidden load, if anything.
fn fault(a: &Analysis, truth: [f64; 2]) -> Option<String> {
    fault_of(a, "gravity-load", ["sin_1_nm", "cos_1_nm"], truth)
}

fn fault_of(a: &Analysis, effect: &str, parameters: [&str; 2], truth: [f64; 2]) -> Option<String> {
    let found = a.effects.iter().find(|e| e.name == effect)?;
    parameters.iter().zip(truth).find_map(|(name, truth)| {
        let (_, value, interval) = found.parameters.iter().find(|(n, ..)| n == name)?;
        let Interval::Ci95([low, high]) = interval else { return Some(format!("{name}: {interval:?}")) };
        let within = (*low..=*high).contains(&truth);
        (!within).then(|| format!("{name} is {value} in {low} to {high} instead of {truth}"))
    })
}

/// Three sizes, with the counter's zero elsewhere each time, in a loop that holds it and without one.
#[test]
fn a_pendulum_is_named_with_its_size_and_then_agrees() {
    let sizes = [[-0.06, 0.03], [-0.15, -0.1], [0.1, 0.28]];
    let cases = sizes.iter().flat_map(|size| [QUIET.about, None].map(|about| (*size, about)));
    let cases: Vec<_> = cases.enumerate().collect();
    let faults: Vec<String> = cases
        .into_par_iter()
        .filter_map(|(k, (gravity, about))| {
            let logs = set(Servo { gravity, about, ..QUIET }, 20 + k as u64);
            let a = done(&logs);
            let again = done(&DataSet { robot: a.robot.clone(), ..logs });
            let wrong = match () {
                () if names(&a) != ["gravity-load"] => Some(format!("named {:?}", names(&a))),
                () if again.verdict != Verdict::Agrees => Some(format!("then {}", again.terminal_summary())),
                () => fault(&a, gravity),
            };
            wrong.map(|wrong| format!("{gravity:?} {about:?}: {wrong}\n{}", a.terminal_summary()))
        })
        .collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// Pendulums that weigh more than twice what their motor lifts, and are swung up by and by.
#[test]
fn a_pendulum_too_heavy_for_its_motor_is_named_with_its_size() {
    let faults: Vec<String> = [[-1.5, 0.3], [0.9, 1.6]]
        .into_par_iter()
        .enumerate()
        .filter_map(|(k, gravity)| {
            let a = done(&set(Servo { gravity, load: [0.03; 2], about: None, ..QUIET }, 90 + k as u64));
            let named = names(&a) == ["gravity-load"];
            let wrong = if named { fault(&a, gravity) } else { Some(format!("named {:?}", names(&a))) };
            wrong.map(|wrong| format!("{gravity:?}: {wrong}\n{}", a.terminal_summary()))
        })
        .collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// A load that is heavier than its file has it: the rotor, a third of the whole, is named for it, and the whole is said.
#[test]
fn a_rotor_that_stands_for_its_load_says_what_both_turn_as() {
    let a = done(&set(Servo { load: [5e-3, 2e-3], ..QUIET }, 130));
    assert_eq!(names(&a), ["rotor-inertia"], "{}", a.terminal_summary());
    let said = a.remarks.iter().find(|r| r.starts_with("rotor-inertia stands for rotor and load")).expect("no remark");
    let both = said.split("turn as ").nth(1).and_then(|rest| rest.split(' ').next()).unwrap();
    let both: f64 = both.parse().unwrap();
    assert!((both / 6e-3 - 1.0).abs() < 0.1 && said.contains("3.000e-3"), "{said}");
}

/// Lifts and winches: of a weight that pulls one way a dead band was made.
#[test]
fn a_weight_on_a_rope_is_named_with_its_size_and_then_agrees() {
    let about = Some([0.0, 9.0]);
    let cases = [(0.2, 0.0, about), (-0.1, 0.04, about), (0.3, 0.0, Some([0.4, 3.0])), (-0.05, 0.0, None)];
    let faults: Vec<String> = cases
        .into_par_iter()
        .enumerate()
        .filter_map(|(k, (torque, dry, about))| {
            let logs = set(Servo { spring: [0.0, torque], dry, about, ..QUIET }, 110 + k as u64);
            let a = done(&logs);
            let again = done(&DataSet { robot: a.robot.clone(), ..logs });
            let mut found = names(&a);
            found.sort_unstable();
            let wanted: &[&str] = if dry > 0.0 { &["coulomb-friction", "hanging-load"] } else { &["hanging-load"] };
            let interval = a.effects.iter().find(|e| e.name == "hanging-load").map(|e| e.parameters[0].2);
            let wrong = match interval {
                _ if found != wanted => Some(format!("named {found:?}")),
                Some(Interval::Ci95([low, high])) if !(low..=high).contains(&torque) => {
                    Some(format!("{low} to {high}"))
                }
                _ if again.verdict != Verdict::Agrees => Some(format!("then {}", again.terminal_summary())),
                _ if a.remarks.iter().any(|r| r.contains("Drive it both ways")) => Some("one way".to_owned()),
                _ => None,
            };
            wrong.map(|wrong| format!("{torque} {dry} {about:?}: {wrong}\n{}", a.terminal_summary()))
        })
        .collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// Friction that nobody told beside it.
#[test]
fn a_pendulum_is_named_beside_friction() {
    let faults: Vec<String> = [QUIET.about, None]
        .into_par_iter()
        .filter_map(|about| {
            let gravity = [-0.2, 0.05];
            let logs = set(Servo { gravity, about, dry: 0.04, ..QUIET }, 3);
            let a = done(&logs);
            let mut found = names(&a);
            found.sort_unstable();
            let wrong =
                if found == ["coulomb-friction", "gravity-load"] { fault(&a, gravity) } else { Some(String::new()) };
            wrong.map(|wrong| format!("{about:?}: {wrong}\n{}", a.terminal_summary()))
        })
        .collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// Axes without a weight.
#[test]
fn no_weight_is_named_where_there_is_none() {
    let controls = [
        QUIET,
        Servo { about: None, ..QUIET },
        Servo { about: Some([0.0, 0.2]), ..QUIET },
        Servo { dry: 0.05, ..QUIET },
        Servo { dry: 0.05, about: None, ..QUIET },
        Servo { load: [3e-3, 2e-3], ..QUIET },
        Servo { load: [3e-3, 2e-3], dry: 0.03, about: None, ..QUIET },
        Servo { scatter: 0.03, ..QUIET },
    ];
    let faults: Vec<String> = controls
        .into_par_iter()
        .enumerate()
        .filter_map(|(k, servo)| {
            let a = done(&set(servo, 40 + k as u64));
            ["gravity-load", "joint-spring"]
                .iter()
                .any(|name| names(&a).contains(name))
                .then(|| format!("{servo:?}:\n{}", a.terminal_summary()))
        })
        .collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// With a gear that loses a quarter of what it carries, and says so: friction that goes with the held torque.
#[test]
fn a_lossy_gear_carries_a_pendulum_without_friction_of_its_own() {
    let faults: Vec<String> = [QUIET.about, None]
        .into_par_iter()
        .filter_map(|about| {
            let gravity = [-0.2, 0.05];
            let logs = set(Servo { gravity, about, loss: 0.25, ..QUIET }, 5);
            let a = done(&logs);
            let wrong = if names(&a) == ["gravity-load"] { fault(&a, gravity) } else { Some(String::new()) };
            wrong.map(|wrong| format!("{about:?}: {wrong}\n{}", a.terminal_summary()))
        })
        .collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// Over two turns a spring is no pendulum; within half a radian nobody can tell, and the two are a tie.
#[test]
fn a_spring_is_named_over_turns_and_tied_with_a_weight_within_a_little() {
    let cases =
        [([0.04, 0.02], Some([0.4, 3.0])), ([0.12, -0.1], Some([-0.3, 2.0])), ([0.08, 0.032], Some([0.4, 0.15]))];
    let faults: Vec<String> = cases
        .into_par_iter()
        .enumerate()
        .filter_map(|(k, (spring, about))| {
            let logs = set(Servo { spring, about, ..QUIET }, 70 + k as u64);
            let a = done(&logs);
            let tie: Vec<String> = ["gravity-load", "joint-spring"].map(str::to_owned).into();
            let tied = a.alternatives.iter().any(|set| tie.iter().all(|name| set.contains(name)));
            let parameters = ["stiffness_1_nm_per_rad", "preload_1_nm"];
            let wrong = match about {
                Some([_, swing]) if swing < 1.0 => {
                    (names(&a).len() != 1 || !tied).then(|| format!("no tie: {:?}", a.alternatives))
                }
                _ if names(&a) != ["joint-spring"] || tied => Some(format!("named {:?}", names(&a))),
                _ => fault_of(&a, "joint-spring", parameters, spring),
            };
            wrong.map(|wrong| format!("{spring:?} {about:?}: {wrong}\n{}", a.terminal_summary()))
        })
        .collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// What no law of speed and current predicts is no scatter where it has its name: the verdict was that these are not the currents of
/// this drive, beside a spring that closed 99 % of the gap.
#[test]
fn a_spring_that_takes_most_of_the_torque_is_no_scatter() {
    for (seed, stiffness, swing) in [(91, 0.05, 8.0), (92, 0.03, 15.0)] {
        let servo = Servo { spring: [stiffness, 0.0], about: Some([0.0, swing]), ..QUIET };
        let behind_currents = |mut run: Run| {
            let speed =
                |k: usize| (run.counts[0][k] - run.counts[0][k.saturating_sub(1)]) as f64 * TAU / 4096.0 / 0.004;
            let torque = |k: usize| KT_R * VOLT * run.duty[0][k] - DAMPING * speed(k);
            run.current = vec![(0..run.t.len()).map(|k| torque(k) / 0.1).collect()];
            run.duty.clear();
            run
        };
        let a = of_files(&file(servo), set(servo, seed).runs.into_iter().map(behind_currents));
        let said = a.terminal_summary();
        assert_eq!(names(&a)[0], "joint-spring", "{said}");
        assert!(a.unexplained.is_empty() && !a.remarks.iter().any(|r| r.contains("scatters by")), "{said}");
    }
}

/// Potentiometers of 100 steps a turn, which make one in as many ms as a speed was smoothed over.
#[test]
fn an_axis_with_a_coarse_encoder_that_turns_slowly_is_compared() {
    let slow = Servo { counts: 102.4, about: Some([0.1, 1.0]), ..QUIET };
    let faults: Vec<String> = [0.12, 0.2, 0.0, 0.0]
        .into_par_iter()
        .enumerate()
        .filter_map(|(k, dry)| {
            let a = done(&set(Servo { dry, ..slow }, 150 + k as u64));
            let wanted: &[&str] = if dry > 0.0 { &["coulomb-friction"] } else { &[] };
            let wrong = match () {
                () if dry == 0.0 && a.verdict == Verdict::NotCompared => Some("compared nothing".to_owned()),
                () if names(&a) != wanted => Some(format!("named {:?}", names(&a))),
                () => a.effects.iter().find_map(|e| {
                    let Interval::Ci95([low, high]) = e.parameters[0].2 else { return Some(format!("{e:?}")) };
                    (!(low..=high).contains(&dry)).then(|| format!("{low} to {high}"))
                }),
            };
            wrong.map(|wrong| format!("{dry}: {wrong}\n{}", a.terminal_summary()))
        })
        .collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// A joint of an arm by its torques, swept once there and back at 0.4 rad/s between -1.4 and 3.5 rad: dry friction, a cable
/// that pulls like a spring, and a weight.
fn swept(seed: u64) -> Analysis {
    let (tick, ticks, inertia, dry) = (0.005, 4880, 0.01, 0.072);
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let (mut angle, mut speed, mut push) = (-1.4_f64, 0.0_f64, 0.0);
    let mut run = Run { name: format!("sweep_{seed}"), ..Run::default() };
    let (mut torques, mut counted) = (Vec::new(), Vec::new());
    for k in 0..ticks {
        let (back, sense) = if k < ticks / 2 { (k, 1.0) } else { (ticks - k, -1.0) };
        let wanted = -1.4 + 0.4 * tick * f64::from(back);
        let torque: f64 = 3.0 * (wanted - angle) + 0.35 * (0.4 * sense - speed);
        let torque = (torque.clamp(-1.0, 1.0) * 1e4).round() / 1e4;
        if k % 4 == 0 {
            push = 0.012 * (0..12).map(|_| rng.random_range(-0.5..0.5)).sum::<f64>();
        }
        run.t.push(tick * f64::from(k));
        torques.push(torque);
        counted.push((angle / TAU * 65536.0).floor() as i64);
        let step = tick / 20.0;
        for _ in 0..20 {
            let load = 0.048 - 0.058 * angle + 0.03 * angle.sin() - 0.056 * angle.cos();
            let next = with_dry_friction(speed, torque + load + push, dry, inertia, step);
            angle += 0.5 * step * (speed + next);
            speed = next;
        }
    }
    run.current = vec![torques];
    run.counts = vec![counted];
    let robot = "encoder_counts_per_wheel_rev = 65536\ngear_ratio = 1\nsupport = \"blocks\"\nwheel_radius_m = 1\n\
                 [motor]\ntorque_constant = 1\nrotor_inertia = 0.01\nfriction_torque = 0\n\
                 [[wheel]]\nx_m = 0\ny_m = 0\ndrive_deg = 0\n";
    of_files(robot, [run])
}

/// What took the place of another law has equals of its own, and none was looked for: of ten such arms one had its dry
/// friction and a load, the others a viscous friction or no load.
#[test]
fn friction_of_an_arm_is_dry_beside_its_loads() {
    let found: Vec<Vec<String>> =
        (0..10).into_par_iter().map(|seed| names(&swept(seed)).iter().map(ToString::to_string).collect()).collect();
    let both = |found: &&Vec<String>| ["coulomb-friction", "joint-spring"].iter().all(|n| found.iter().any(|f| f == n));
    let right = found.iter().filter(both).count();
    assert!(right >= 3, "{right} of 10: {found:?}");
}
