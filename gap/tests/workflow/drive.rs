//! The drive link by itself.

use std::sync::Arc;

use super::common::{RICH, cut_all, names, of_files, simulate, value, with, with_dry_friction};
use super::scale::servo;
use estimation::statistics::rms;
use gap::problem::Problem;
use gap::state::{Active, State};
use gap::thresholds::Thresholds;
use gap::{Interval, Options, analyse};
use links::drive::{DriveLink, DriveModel};
use links::effect::{Effect, Form, Link, Values};
use links::pieces::{PIECE, segments};
use model::manoeuvre::Manoeuvre;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use runs::robot::{Robot, Support};
use runs::{Logs, Run};

/// Unexplained torque of all wheels, Nm RMS, where the model knows the skews in rad.
fn unexplained(skew_rad: [f64; 3]) -> f64 {
    let names = ["skew_1_rad", "skew_2_rad", "skew_3_rad"];
    let parameters: Vec<(&str, f64)> = names.into_iter().zip(skew_rad).collect();
    let set = simulate(&with(&Robot::racbot(), "wheel-skew", &parameters), &[Manoeuvre::Chirp], 7);
    let set = Logs::from(&set);
    let pieces = segments(&set.robot, &set.robot.geometry().unwrap(), &set.logs, PIECE);
    let mut model = DriveModel::new(&set.robot);
    model.wheels.iter_mut().zip(skew_rad).for_each(|(wheel, skew)| wheel.drive_rad -= skew);
    let residuals = DriveLink::new(&pieces, &model).unwrap().residuals(&model).unwrap();
    let counted = residuals.torque.iter().flatten().zip(residuals.weights.iter().flatten());
    rms(counted.filter(|(_, weight)| **weight > 0.0).map(|(torque, _)| *torque))
}

#[test]
fn skews_that_are_known_leave_nothing_in_the_drive() {
    let (straight, skewed) = (unexplained([0.0; 3]), unexplained([0.14, -0.1, 0.07]));
    assert!(skewed < 1.3 * straight, "{skewed} Nm with skews that the model knows, {straight} without any");
}

/// Unexplained torque of a model, Nm RMS where it counts.
fn left(link: &DriveLink, model: &DriveModel) -> f64 {
    let residuals = link.residuals(model).unwrap();
    let counted = residuals.torque.iter().flatten().zip(residuals.weights.iter().flatten());
    rms(counted.filter(|(_, weight)| **weight > 0.0).map(|(torque, _)| *torque))
}

/// Motors on thin cables accelerate a robot as a heavier one, and turn it as one harder to turn: one cause, and not two.
#[test]
fn resistance_is_named_and_no_mass_with_inertia() {
    for (seed, scale) in [(1, 0.4), (2, -0.3), (3, 0.25)] {
        let truth = with(&Robot::racbot(), "winding-resistance", &[("scale", scale)]);
        let mut set = simulate(&truth, &RICH, seed);
        cut_all(&mut set, 5.0);
        let a = analyse(&set, &Options::default()).unwrap();
        assert_eq!(names(&a), ["winding-resistance"], "{seed}: {}", a.terminal_summary());
        let Interval::Ci95([low, high]) = a.effects[0].parameters[0].2 else { panic!("{:?}", a.effects[0]) };
        assert!((low..=high).contains(&scale), "{seed}: {low} to {high} instead of {scale}");
    }
}

/// Frictions, and what takes torque away as friction does: near-twins of the truth below.
const TAKE_TORQUE: [&str; 17] = [
    "coulomb-friction",
    "viscous-friction",
    "stribeck-friction",
    "asymmetric-friction",
    "gear-efficiency",
    "heading-drag",
    "roller-friction",
    "dead-band",
    "bridge-drop",
    "drive-curve",
    "battery-sag",
    "supply-voltage",
    "current-limit",
    "motor-heating",
    "torque-constant",
    "winding-resistance",
    "probe-late-friction",
];

/// Wheels off the floor whose friction, unknown to the model, takes half of what the motors can give: a rotor of any
/// other inertia, or any other effect at any value, explains none of it. Some leave less in one measure; none in all.
#[test]
fn no_effect_buys_the_metric_by_predicting_nothing() {
    let nominal = Robot { support: Support::Blocks, ..Robot::racbot() };
    let truth = with(&nominal, "coulomb-friction", &[("torque_nm", 0.03)]);
    let set = simulate(&truth, &[Manoeuvre::Blocks], 7);
    let logs = Logs::from(&set);
    let pieces = segments(&set.robot, &set.robot.geometry().unwrap(), &logs.logs, PIECE);
    let link = DriveLink::new(&pieces, &DriveModel::new(&set.robot)).unwrap();
    let problem = Problem::Drive(&link);
    let bare = State { robot: set.robot.clone(), active: Vec::new() };
    let state = |effect: &Arc<dyn Effect>, form: Form, values: Values| {
        let active = Active { values, ..Active::new(effect.clone(), form) };
        State { robot: set.robot.clone(), active: vec![active] }
    };
    let rms = |state: &State| left(&link, &state.drive(None));
    let open = rms(&bare);
    let (mut tried, mut bought) = (0, 0);
    let other = |e: &dyn Effect| e.link() == Link::Drive && !TAKE_TORQUE.contains(&e.name());
    let catalogue: Vec<Arc<dyn Effect>> = links::effects::catalogue().into_iter().map(Arc::from).collect();
    for effect in catalogue.iter().filter(|effect| other(effect.as_ref())) {
        for form in effect.forms(&set.robot) {
            for share in [0.0, 0.02, 0.1, 0.3, 0.6, 0.9, 1.0] {
                let mut values = Values(form.fixed.clone());
                for p in &form.free {
                    values.set(&p.name, p.bounds[0] + share * (p.bounds[1] - p.bounds[0]));
                }
                let with = state(effect, form.clone(), values.clone());
                if with.drive(None).mechanics().is_none() {
                    continue;
                }
                tried += 1;
                let closes = rms(&with) < 0.8 * open;
                bought += usize::from(closes);
                let refused = problem.runs_away(&with, &bare, &Thresholds::default());
                assert!(refused || !closes, "{} {values:?}: {} Nm of {open}", effect.name(), rms(&with));
            }
        }
    }
    assert!(tried > 50 && bought > 0, "{tried} {bought}");
    // What it is does close it.
    let friction = catalogue.iter().find(|e| e.name() == "coulomb-friction").unwrap();
    let form = friction.forms(&set.robot).swap_remove(0);
    let true_one = state(friction, form, Values(vec![("torque_nm".to_owned(), 0.03)]));
    assert!(
        rms(&true_one) < 0.2 * open && !problem.runs_away(&true_one, &bare, &Thresholds::default()),
        "{} of {open}",
        rms(&true_one)
    );
}

/// A robot with friction that its file does not know gets friction, whatever its inertia.
#[test]
fn unknown_friction_is_no_inertia() {
    let nominal = Robot { support: Support::Blocks, ..Robot::racbot() };
    let truth = with(&nominal, "coulomb-friction", &[("torque_nm", 0.03)]);
    let mut set = simulate(&truth, &[Manoeuvre::Blocks, Manoeuvre::Blocks], 8);
    cut_all(&mut set, 9.0);
    let a = gap::analyse(&set, &gap::Options::default()).unwrap();
    let found = names(&a);
    assert_eq!(found.first(), Some(&"coulomb-friction"), "{}", a.terminal_summary());
    // Wheels that stick between moves leave room for a little viscous friction beside it.
    assert!(found[1..].iter().all(|name| *name == "viscous-friction"), "{}", a.terminal_summary());
}

/// Every `n`th row of a log.
fn thinned(run: &mut Run, n: usize) {
    fn thin<T: Copy>(column: &mut Vec<T>, n: usize) {
        *column = column.iter().step_by(n).copied().collect();
    }
    thin(&mut run.t, n);
    run.command.iter_mut().flatten().for_each(|c| thin(c, n));
    run.reference.iter_mut().chain(&mut run.duty).chain(&mut run.measured).for_each(|c| thin(c, n));
    run.counts.iter_mut().for_each(|c| thin(c, n));
    run.supply_v.iter_mut().for_each(|c| thin(c, n));
    run.camera.iter_mut().for_each(|c| c.tick = c.tick.div_ceil(n));
    run.camera.retain(|c| c.tick < run.t.len());
}

/// Rows of a log every hundredth of a second, while the loop ran every thousandth.
#[test]
fn rows_further_apart_than_the_control_period_are_no_inertia() {
    let mut set = simulate(&Robot::racbot(), &[Manoeuvre::Star, Manoeuvre::StopAndGo, Manoeuvre::Chirp], 9);
    set.runs.iter_mut().for_each(|r| {
        thinned(r, 10);
        r.camera.clear();
    });
    let a = gap::analyse(&set, &gap::Options::default()).unwrap();
    assert!(names(&a).is_empty(), "{}", a.terminal_summary());
}

const FOREIGN: &str = "are these the duties of this drive?";

/// Values between -0.5 and 0.5, each held for some ticks.
fn wandering(ticks: usize, held: usize, seed: u64) -> impl Iterator<Item = f64> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let values = std::iter::repeat_with(move || rng.random_range(-0.5..0.5));
    values.flat_map(move |value| std::iter::repeat_n(value, held)).take(ticks)
}

/// Duties that have nothing to do with what a heavy axis did.
#[test]
fn duties_of_another_drive_are_asked_about() {
    let mut set = servo(1e-3, 1e-3, 1e-5, 4e-3);
    for (seed, run) in (1..).zip(&mut set.runs) {
        run.duty[0] = wandering(run.t.len(), 100, seed).collect();
    }
    let a = gap::analyse(&set, &gap::Options::default()).unwrap();
    assert_eq!(a.verdict, gap::Verdict::Unexplained, "{}", a.terminal_summary());
    assert!(a.unexplained.iter().any(|u| u.structure.contains(FOREIGN)), "{}", a.terminal_summary());
}

/// An amplifier whose voltage wanders by a tenth scatters, and is still this drive's.
#[test]
fn a_drive_that_scatters_is_not_called_another() {
    let mut set = servo(2e-5, 2e-5, 1e-5, 4e-3);
    for (seed, run) in (1..).zip(&mut set.runs) {
        let ticks = run.t.len();
        run.duty[0].iter_mut().zip(wandering(ticks, 30, seed)).for_each(|(duty, off)| *duty += 0.2 * off);
    }
    let a = gap::analyse(&set, &gap::Options::default()).unwrap();
    assert!(a.remarks.iter().any(|r| r.contains("smaller effects do not show")), "{:?}", a.remarks);
    assert!(!a.unexplained.iter().any(|u| u.structure.contains(FOREIGN)), "{}", a.terminal_summary());
}

/// One step of the duty of a slow axis behind an encoder of 127 counts a turn, the last of which flickers.
#[test]
fn a_coarse_encoder_is_not_called_another_drive() {
    let text = "encoder_counts_per_wheel_rev = 127\ngear_ratio = 17.4\nsupply_v = 24\nsupport = \"blocks\"\nwheel_radius_m = 1\n\
                wheel_inertia_kg_m2 = 0.0109\n[motor]\nresistance_ohm = 80\ntorque_constant = 0.139\n\
                rotor_inertia = 6.4e-6\nfriction_torque = 7.5e-4\n[[wheel]]\nx_m = 0\ny_m = 0\ndrive_deg = 90\n";
    for seed in 0..4 {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let mut run = Run { name: "step".into(), ..Run::default() };
        let (mut speed, mut angle) = (0.0_f64, 0.0);
        let (mut duties, mut counts) = (Vec::new(), Vec::new());
        for row in 0..510_u32 {
            let duty = if row < 18 { 0.0 } else { 0.456 };
            run.t.push(0.01 * f64::from(row));
            duties.push(duty);
            counts.push((angle * 127.0 / std::f64::consts::TAU + rng.random_range(-0.6..0.6)).floor() as i64);
            for _ in 0..10 {
                let torque = 17.4 * 0.139 * (24.0 * duty - 0.139 * 17.4 * speed) / 80.0;
                speed = with_dry_friction(speed, torque, 17.4 * 7.5e-4, 0.0109 + 17.4 * 17.4 * 6.4e-6, 1e-3);
                angle += 1e-3 * speed;
            }
        }
        (run.duty, run.counts, run.count_gaps) = (vec![duties], vec![counts], vec![Vec::new()]);
        let a = of_files(text, [run]);
        assert!(names(&a).is_empty() && a.verdict != gap::Verdict::Unexplained, "{seed}: {}", a.terminal_summary());
    }
}

/// The motor of another winding: a straight line from the file leads far out of bounds, and its loop makes wheels and rotors
/// chatter.
#[test]
fn a_motor_far_stronger_than_the_file_s_has_its_size() {
    let scale = -0.63;
    for seed in [31, 32] {
        let stronger = with(&Robot::racbot(), "winding-resistance", &[("scale", scale)]);
        let mut set = simulate(&stronger, &RICH, seed);
        cut_all(&mut set, 8.0);
        let a = analyse(&set, &Options::default()).unwrap();
        assert!(names(&a).contains(&"winding-resistance"), "{}", a.terminal_summary());
        assert!((value(&a, "scale") - scale).abs() < 0.03, "{}", a.terminal_summary());
    }
}
