//! An axis behind a current controller, read over a bus by a computer with its own mind about time, by equations of
//! motion that share nothing with the model.

use std::f64::consts::TAU;

use super::common::{names, of_files, of_files_by, with_dry_friction};

use gap::{Analysis, Interval, Options};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use runs::Run;

/// An axis by its shaft, and who reads it.
#[derive(Clone, Copy, Debug)]
struct Axis {
    /// Torque constant, Nm/A, and inertia, kg m².
    kt: f64,
    inertia: f64,
    /// Dry and viscous friction that no file knows, Nm and Nm s.
    dry: f64,
    viscous: f64,
    /// Current at most, A.
    most: f64,
    /// Fastest of the waves of the current, Hz.
    fastest: f64,
    /// Counts a turn.
    counts: f64,
    /// Shortest and longest time between rows, s, and by how much a stamp is late at most.
    rows: [f64; 2],
    late: f64,
    seconds: f64,
    /// Whether the amplifier holds what a row tells it until the next; else a row says what the current was.
    held: bool,
    /// Whether a row says what the amplifier held until then, as of a controller that reads its sensors first.
    until: bool,
    /// Rows from one reading of the current to the next: what is between repeats it.
    reads: usize,
}

/// A brushless motor alone.
const MOTOR: Axis = Axis {
    kt: 0.11,
    inertia: 3.8e-4,
    dry: 0.042,
    viscous: 0.006,
    most: 4.0,
    fastest: 3.0,
    counts: 16384.0,
    rows: [0.004, 0.011],
    late: 1e-3,
    seconds: 40.0,
    held: false,
    until: false,
    reads: 1,
};

fn run(axis: Axis, seed: u64) -> Run {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let waves: Vec<[f64; 3]> = (0..14)
        .map(|_| {
            [axis.fastest * rng.random_range(0.02..1.0_f64), rng.random_range(0.5..1.0), rng.random_range(0.0..TAU)]
        })
        .collect();
    let wave = |t: f64| axis.most * waves.iter().map(|[f, a, p]| a * (TAU * f * t + p).sin()).sum::<f64>() / 4.0;
    let mut run = Run { name: format!("run_{seed}"), ..Run::default() };
    let (mut angle, mut speed, mut t, mut next) = (0.0_f64, 0.0_f64, 0.0, 0.0);
    let (mut currents, mut counted) = (Vec::new(), Vec::new());
    let mut told = 0.0;
    let step = 1e-4;
    while t < axis.seconds {
        if t >= next {
            next += rng.random_range(axis.rows[0]..=axis.rows[1]);
            run.t.push(t + axis.late * rng.random_range(0.0..1.0));
            let was = told;
            told = wave(t);
            let read = if axis.until { was } else { told } + 0.01 * axis.most * rng.random_range(-1.0..1.0);
            let last = currents.last().copied().filter(|_| currents.len() % axis.reads != 0);
            currents.push(last.unwrap_or(read));
            counted.push((angle / TAU * axis.counts).floor() as i64);
        }
        let current = if axis.held { told } else { wave(t) };
        let torque = axis.kt * current - axis.viscous * speed;
        let after = with_dry_friction(speed, torque, axis.dry, axis.inertia, step);
        angle += 0.5 * step * (speed + after);
        (speed, t) = (after, t + step);
    }
    run.current = vec![currents];
    run.counts = vec![counted];
    run
}

/// A data set with a file that has so much of the inertia and of the dry friction.
fn done(axis: Axis, [inertia, friction]: [f64; 2], seed: u64) -> Analysis {
    let text = format!(
        "encoder_counts_per_wheel_rev = {}\ngear_ratio = 1\nsupport = \"blocks\"\nwheel_radius_m = 1\nwheel_inertia_kg_m2 = 0\n[motor]\n\
         torque_constant = {}\nrotor_inertia = {}\nfriction_torque = {}\n[[wheel]]\nx_m = 0\ny_m = 0\ndrive_deg = 0\n",
        axis.counts,
        axis.kt,
        inertia * axis.inertia,
        friction * axis.dry
    );
    of_files(&text, (0..3).map(|k| run(axis, 10 * seed + k)))
}

/// What is named, with its first size.
fn sizes_of(a: &Analysis) -> Vec<(String, f64)> {
    a.effects.iter().map(|e| (e.name.clone(), e.parameters[0].1)).collect()
}

/// What is wrong with a size that must be named, if anything.
fn fault(a: &Analysis, effect: &str, truth: f64) -> Option<String> {
    let Some(found) = a.effects.iter().find(|e| e.name == effect) else {
        return Some(format!("{effect} is not among {:?}", names(a)));
    };
    let (name, value, interval) = &found.parameters[0];
    let Interval::Ci95([low, high]) = interval else { return Some(format!("{name}: {interval:?}")) };
    (!(*low..=*high).contains(&truth)).then(|| format!("{name} is {value} in {low} to {high} instead of {truth}"))
}

/// Friction is no play in which stamps seem to rattle; and of what a bridge does before its current is measured nothing is
/// left to name.
#[test]
fn friction_behind_measured_currents_is_no_play_and_no_bridge() {
    let faults: Vec<String> = (1..4_u64)
        .into_par_iter()
        .flat_map(|seed| {
            let a = done(MOTOR, [1.0, 0.0], seed);
            let named = names(&a);
            let mut faults = Vec::new();
            for other in ["gear-backlash", "dead-band", "drive-curve", "battery-sag", "motor-heating"] {
                let listed = a.alternatives.iter().any(|set| set.iter().any(|n| n == other));
                faults.extend((listed || named.contains(&other)).then(|| other.to_owned()));
            }
            let friction = ["coulomb-friction", "viscous-friction"].iter().all(|n| named.contains(n));
            faults.extend((!friction).then(|| format!("named {:?}", sizes_of(&a))));
            faults.extend(a.links.iter().any(|l| !l.after.is_finite()).then(|| "no figure".to_owned()));
            faults.into_iter().map(|f| format!("{seed}: {f}")).collect::<Vec<_>>()
        })
        .collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// What is wrong with the frictions named for an axis whose file knows none.
fn friction_faults(axis: Axis, seed: u64) -> Vec<String> {
    let a = done(axis, [1.0, 0.0], seed);
    let other = names(&a).iter().find(|n| !["coulomb-friction", "viscous-friction"].contains(n)).copied();
    let truths = [("coulomb-friction", axis.dry), ("viscous-friction", axis.viscous)];
    let sizes = truths.iter().filter_map(|(name, truth)| fault(&a, name, *truth));
    let all = sizes.chain(other.map(|name| format!("{name} is named")));
    all.map(|what| format!("{seed}, held {}: {what}", axis.held)).collect()
}

/// Friction has its size whether the currents were measured or are what the amplifier was told and holds.
#[test]
fn friction_has_its_size_behind_measured_and_behind_held_currents() {
    let axis = Axis { fastest: 8.0, rows: [0.0198, 0.0202], late: 2e-4, ..MOTOR };
    let cases: Vec<(u64, bool)> = (41..44).flat_map(|seed| [(seed, false), (seed, true)]).collect();
    let faults: Vec<String> =
        cases.into_par_iter().flat_map(|(seed, held)| friction_faults(Axis { held, ..axis }, seed)).collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// And where they are what flowed until their row: then no machine is early.
#[test]
fn friction_has_its_size_behind_currents_that_flowed_until_their_row() {
    let axis = Axis { fastest: 8.0, rows: [0.0198, 0.0202], late: 2e-4, held: true, until: true, ..MOTOR };
    let faults: Vec<String> = (44..47_u64).into_par_iter().flat_map(|seed| friction_faults(axis, seed)).collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// A drive that tells its current every tenth of a second, in a log of 77 rows a second.
#[test]
fn friction_has_its_size_behind_currents_that_are_read_now_and_then() {
    let axis = Axis { fastest: 1.5, rows: [0.0128, 0.0132], late: 2e-4, reads: 8, ..MOTOR };
    let faults: Vec<String> = (61..64_u64).into_par_iter().flat_map(|seed| friction_faults(axis, seed)).collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// A file that says two and a half times the friction is told that it is too much, and by how much.
#[test]
fn friction_that_the_file_has_too_much_of_is_taken_back() {
    let faults: Vec<String> = (51..54_u64)
        .into_par_iter()
        .flat_map(|seed| {
            let a = done(MOTOR, [1.0, 2.5], seed);
            let sizes = [("coulomb-friction", -1.5 * MOTOR.dry), ("viscous-friction", MOTOR.viscous)];
            let faults = sizes.into_iter().filter_map(|(n, t)| fault(&a, n, t));
            faults.map(|f| format!("{seed}: {f}")).collect::<Vec<_>>()
        })
        .collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// With friction of unknown size a rotor as heavy as the motor is weaker does the same.
#[test]
fn a_weaker_motor_and_a_heavier_rotor_are_a_tie_behind_currents() {
    for (seed, known) in [(21, 0.6), (22, 0.75)] {
        let a = done(Axis { fastest: 8.0, ..MOTOR }, [known, 0.0], seed);
        let both = ["torque-constant", "rotor-inertia"];
        let named = names(&a).iter().any(|n| both.contains(n));
        let tied = a.alternatives.iter().any(|set| both.iter().all(|n| set.iter().any(|s| s == n)));
        assert!(named && tied, "{known}: {:?} {:?}", names(&a), a.alternatives);
    }
}

/// A vehicle of 143 kg with 138 counts a turn, 20 rows a second: a count is 5 rad/s² over the usual test function, and its
/// motor gives a tenth of that.
#[test]
fn a_heavy_axis_with_a_coarse_encoder_is_looked_at_for_longer() {
    let vehicle = Axis {
        kt: 1.0,
        inertia: 11.5,
        dry: 4.0,
        viscous: 0.5,
        most: 60.0,
        fastest: 0.25,
        counts: 138.0,
        rows: [0.03, 0.1],
        late: 0.004,
        seconds: 120.0,
        held: false,
        until: false,
        reads: 1,
    };
    let faults: Vec<String> = (31..34_u64)
        .into_par_iter()
        .flat_map(|seed| {
            let a = done(vehicle, [1.0, 0.0], seed);
            let other = names(&a).iter().any(|n| !["coulomb-friction", "viscous-friction"].contains(n));
            let sizes = [("coulomb-friction", vehicle.dry), ("viscous-friction", vehicle.viscous)];
            let mut faults: Vec<String> =
                sizes.iter().filter(|(n, _)| names(&a).contains(n)).filter_map(|(n, t)| fault(&a, n, *t)).collect();
            faults
                .extend((other || names(&a).is_empty()).then(|| format!("named {:?}: {:?}", names(&a), a.unexplained)));
            faults.into_iter().map(|f| format!("{seed}: {f}")).collect::<Vec<_>>()
        })
        .collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// Torque constant, inertia and friction times one factor change nothing: a rotor 5 % heavier than in the file was named
/// with a motor 20 % stronger and a rotor 27 % heavier. Sizes are beside the file's torque constant, and who has a size is
/// tied with it; a file that has no viscous friction is told that alone.
#[test]
fn behind_currents_a_common_factor_of_motor_and_rotor_is_not_named() {
    let heavier = [(0.0, 0.006), (0.85, 0.0), (1.2, 0.006), (1.0, 0.0)].map(|(known, viscous)| (0.95, known, viscous));
    let right = [(1.0, 1.0, 0.006), (1.0, 1.0, 0.0)];
    let cases: Vec<_> = heavier.into_iter().chain(right).flat_map(|c| [200_u64, 202].map(|seed| (c, seed))).collect();
    let faults: Vec<String> = cases
        .into_par_iter()
        .flat_map(|((inertia, known, viscous), seed)| {
            let axis = Axis { viscous, seconds: 20.0, ..MOTOR };
            let a = done(axis, [inertia, known], seed);
            let both = ["torque-constant", "rotor-inertia"];
            let named: Vec<&str> = names(&a).into_iter().filter(|n| both.contains(n)).collect();
            let tied = a.alternatives.iter().any(|set| both.iter().all(|n| set.iter().any(|s| s == n)));
            let mut faults: Vec<String> = Vec::new();
            faults.extend((named.len() > 1 || named.len() == 1 && !tied).then(|| format!("{named:?} tied {tied}")));
            faults.extend((inertia == 1.0 && !named.is_empty()).then(|| format!("{named:?} on a right file")));
            faults.extend(if viscous > 0.0 { fault(&a, "viscous-friction", viscous) } else { None });
            let rotor = named.contains(&"rotor-inertia");
            faults.extend(if rotor { fault(&a, "rotor-inertia", 1.0 / inertia - 1.0) } else { None });
            let case = format!("{inertia} {known} {viscous} {seed}");
            faults.into_iter().map(|f| format!("{case}: {f}")).collect::<Vec<_>>()
        })
        .collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// A file with a fiftieth or a tenth of the inertia, and without the viscous friction: beside torques in the inertia as found
/// the friction closed less than 1 % of a gap of 3709 floors, and 6271 mNm of friction were said to lack where the motor
/// gives 440.
#[test]
fn what_friction_closes_is_not_told_in_the_torque_of_a_wrong_inertia() {
    for (seed, known) in [(300, 0.02), (301, 0.1)] {
        let axis = Axis { seconds: 20.0, dry: 0.15, ..MOTOR };
        let a = done(axis, [known, 1.0], seed);
        let gain = |name: &str| a.effects.iter().find(|e| e.name == name).map_or(f64::NAN, |e| e.gain);
        assert!(gain("viscous-friction") > 0.3 && gain("rotor-inertia") > 0.1, "{}", a.terminal_summary());
        let drive = a.links.iter().find(|l| l.link == links::effect::Link::Drive).unwrap();
        let most = axis.kt * axis.most;
        assert!(drive.rms[0][0] < most, "{} Nm of {most}: {}", drive.rms[0][0], a.terminal_summary());
    }
}

/// A friction behind a current controller takes amperes, and no duty that nobody logged.
#[test]
fn what_currents_lack_is_said_in_amperes() {
    let a = done(Axis { seconds: 15.0, dry: 0.22, ..MOTOR }, [1.0, 0.0], 400);
    let text = a.terminal_summary();
    let plain = text.split_whitespace().collect::<Vec<_>>().join(" ");
    // 0.22 Nm and what the viscous friction takes, 0.12 Nm, by 0.11 Nm/A.
    let amps = plain.split("needs ").nth(1).and_then(|rest| rest.split(' ').next()).and_then(|a| a.parse::<f64>().ok());
    assert!(plain.contains("A more current than the model") && !plain.contains("more duty"), "{text}");
    assert!(amps.is_some_and(|a| (2.5..3.7).contains(&a)), "{text}");
    // A friction is the sum of one of one sense and a weight, which is no tie of this log.
    assert!(!a.alternatives.iter().flatten().any(|name| name == "hanging-load"), "{text}");
}

/// A motor from rest to a speed and on to a higher one, by two currents that its frictions take nearly whole: 42 mNm forwards
/// and 28 backwards, a tenth more while it is cold, and in proportion to the speed; cogs besides.
fn run_up([first, then]: [f64; 2], rng: &mut ChaCha8Rng) -> Run {
    let (kt, inertia, viscous, step) = (0.0458, 1.2e-4, 6.7e-5, 2e-4);
    let dry = if first > 0.0 { 0.0416 } else { 0.0275 };
    let (mut angle, mut speed) = (0.0_f64, 0.0_f64);
    let mut run = Run { name: format!("run_{then}"), ..Run::default() };
    let (mut currents, mut counted) = (Vec::new(), Vec::new());
    for row in 0..20_000 {
        let t = f64::from(row) * 1e-3;
        let given = if t < 10.0 { first } else { then };
        run.t.push(t);
        // A reading scatters by a tenth of an ampere from end to end.
        currents.push(given / kt + 0.1 * rng.random_range(-1.0..1.0));
        counted.push((angle / TAU * 1e4).floor() as i64);
        let rubs = dry * (1.0 + 0.1 * (-t / 3.0_f64).exp());
        for _ in 0..5 {
            let torque = given + 0.008 * (2.0 * angle).sin() - viscous * speed;
            let after = with_dry_friction(speed, torque, rubs, inertia, step);
            angle += 0.5 * step * (speed + after);
            speed = after;
        }
    }
    run.current = vec![currents];
    run.counts = vec![counted];
    run
}

/// Of a drive that begins at rest and ends at a speed what is too heavy to move leaves little: a motor of a tenth of its
/// constant stood for frictions that nobody told, had no name at its bound, and sixteen times the inertia had one.
#[test]
fn frictions_that_take_nearly_all_torque_are_no_inertia() {
    let text = "encoder_counts_per_wheel_rev = 10000\ngear_ratio = 1\nsupport = \"blocks\"\nwheel_radius_m = 1\n\
        wheel_inertia_kg_m2 = 0\n[motor]\ntorque_constant = 0.0458\nrotor_inertia = 0.00012\nfriction_torque = 0\n\
        [[wheel]]\nx_m = 0\ny_m = 0\ndrive_deg = 0\n";
    let levels = [[0.051, 0.0545], [0.0505, 0.058], [0.051, 0.0625]].into_iter().chain([
        [-0.038, -0.0425],
        [-0.0385, -0.041],
        [-0.0375, -0.0435],
    ]);
    let mut rng = ChaCha8Rng::seed_from_u64(500);
    let a = of_files(text, levels.map(|l| run_up(l, &mut rng)));
    let said = a.terminal_summary();
    assert!(!names(&a).contains(&"rotor-inertia") && !names(&a).contains(&"torque-constant"), "{said}");
    // The friction of a cold start is none of the catalogue, and part of it looks like one that does not grow with speed.
    let coulomb = a.effects.iter().find(|e| e.name == "coulomb-friction").unwrap();
    assert!((coulomb.parameters[0].1 / 0.028 - 1.0).abs() < 0.15, "{said}");
    assert_eq!(fault(&a, "asymmetric-friction", 0.0141), None, "{said}");
}

/// A servo whose friction rises and falls as it turns, under a loop of its speed alone, logged by the torques of its drive.
fn servo(seed: u64) -> Run {
    const STEP_S: f64 = 2e-4;
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut run = Run { name: format!("run_{seed}"), ..Run::default() };
    let (mut angle, mut speed, mut ripple, mut set) = (0.0, 0.0, 0.0, 0.0);
    let (mut torques, mut counted, mut asked) = (Vec::new(), Vec::new(), Vec::new());
    for k in 0..(60.0 / STEP_S) as u32 {
        let t = f64::from(k) * STEP_S;
        // Held for a second, then on at 4 rad/s²: to 2, 4, 6, 8 rad/s either way.
        let goal = [2.0, 4.0, 6.0, 8.0, 4.0, -2.0, -4.0, -6.0, -8.0, -4.0][(t / 3.0) as usize % 10];
        set += f64::clamp(goal - set, -4.0 * STEP_S, 4.0 * STEP_S);
        let torque = GAIN * (set - speed);
        if k % 100 == 0 {
            run.t.push(t);
            torques.push(torque + 0.02 * rng.random_range(-1.0..1.0));
            counted.push((angle / TAU * 65536.0_f64).floor() as i64);
            asked.push(set);
        }
        // Comes and goes within a fifth of a second.
        ripple += STEP_S / 0.2 * -ripple
            + (2.0 * STEP_S / 0.2).sqrt() * RIPPLE_NM * 3.0_f64.sqrt() * rng.random_range(-1.0..1.0);
        let after = with_dry_friction(speed, torque + ripple, SERVO_DRY_NM, SERVO_INERTIA, STEP_S);
        angle += 0.5 * STEP_S * (speed + after);
        speed = after;
    }
    (run.current, run.counts, run.reference) = (vec![torques], vec![counted], vec![asked]);
    run
}

const GAIN: f64 = 1.0;
const RIPPLE_NM: f64 = 0.06;
const SERVO_DRY_NM: f64 = 0.45;
const SERVO_INERTIA: f64 = 0.016;

/// Fitted to its torques, which answer the ripple, a servo is one of half the torque constant and half the friction, and
/// leaves no answer: the set points make its sizes.
#[test]
fn a_motor_that_was_fitted_to_the_answers_of_its_loop_is_told_by_its_set_points() {
    let text = format!(
        "encoder_counts_per_wheel_rev = 65536\ngear_ratio = 1\nsupport = \"blocks\"\nwheel_radius_m = 1\n[motor]\n\
         torque_constant = 1\nrotor_inertia = {SERVO_INERTIA}\nfriction_torque = 0\n[[wheel]]\nx_m = 0\ny_m = 0\ndrive_deg = 0\n"
    );
    let by_set_points = of_files_by(&text, (0..3).map(|k| servo(50 + k)), &Options::default());
    assert_eq!(names(&by_set_points), ["coulomb-friction"], "{}", by_set_points.terminal_summary());
    assert!((sizes_of(&by_set_points)[0].1 / SERVO_DRY_NM - 1.0).abs() < 0.1, "{}", by_set_points.terminal_summary());
}

/// A joint of an arm that is swung slowly to and fro behind a stiff loop: its inertia takes a hundredth of
/// what its frictions take.
fn swung(seed: u64) -> Run {
    let (kt, inertia, dry, viscous) = (11.5, 0.2, 2.8, 3.5);
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let phases: [f64; 3] = std::array::from_fn(|_| rng.random_range(0.0..TAU));
    let waves = [(0.09, 0.45), (0.13, 0.25), (0.21, 0.1)];
    // Angle and its two derivatives; it sets out from rest.
    let of = |t: f64, order: i32| {
        let wave = |((f, a), p): (&(f64, f64), &f64)| {
            let w = TAU * f;
            a * w.powi(order) * (w * t + p + f64::from(order) * 0.25 * TAU).sin()
        };
        waves.iter().zip(&phases).map(wave).sum::<f64>()
    };
    let mut run = Run { name: format!("run_{seed}"), ..Run::default() };
    let (mut currents, mut counted, mut wander) = (Vec::new(), Vec::new(), 0.0);
    for row in 0..6000 {
        let t = 0.01 * f64::from(row);
        let [angle, speed, gain] = [0, 1, 2].map(|order| of(t, order));
        // A gear that is not the same all the way round.
        wander += 0.02 * (0.35 * rng.random_range(-1.0..1.0) - wander);
        let torque =
            inertia * gain + dry * (speed / 0.01).tanh() + viscous * speed + 0.1 * (30.0 * angle).sin() + wander;
        run.t.push(t);
        currents.push(torque / kt + 0.02 * rng.random_range(-1.0..1.0));
        counted.push((angle / TAU * 65536.0).round() as i64);
    }
    run.current = vec![currents];
    run.counts = vec![counted];
    run
}

/// A motor without torque explains that frictions take all of it: it fitted best at the bound of what is physical, had no name,
/// and what it had stood for had none either, 66 floors from the drive.
#[test]
fn frictions_have_their_names_where_a_motor_without_torque_would_do() {
    let text = "encoder_counts_per_wheel_rev = 65536\ngear_ratio = 1\nsupport = \"blocks\"\nwheel_radius_m = 1\n\
        wheel_inertia_kg_m2 = 0\n[motor]\ntorque_constant = 11.5\nrotor_inertia = 0.2\nfriction_torque = 0\n\
        [[wheel]]\nx_m = 0\ny_m = 0\ndrive_deg = 0\n";
    for seed in [600, 601, 602] {
        let a = of_files(text, [swung(seed)]);
        let said = a.terminal_summary();
        for (name, size) in [("coulomb-friction", 2.8), ("viscous-friction", 3.5)] {
            let found = a.effects.iter().find(|e| e.name == name);
            assert!(found.is_some_and(|e| (e.parameters[0].1 / size - 1.0).abs() < 0.1), "{seed}: {name}\n{said}");
        }
    }
}
