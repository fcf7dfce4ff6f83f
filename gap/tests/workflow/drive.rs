//! The drive link by itself.

use super::common::{names, simulate, with};
use gap::drive::{DriveLink, DriveModel, further, runaway};
use gap::effect::{Effect, Link, Values};
use gap::pieces::{PIECE, segments};
use gap::statistics::rms;
use model::manoeuvre::Manoeuvre;
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

/// Frictions, and what takes torque away as friction does: near-twins of the truth below.
const TAKE_TORQUE: [&str; 13] = [
    "coulomb-friction",
    "viscous-friction",
    "stribeck-friction",
    "asymmetric-friction",
    "gear-efficiency",
    "heading-drag",
    "roller-friction",
    "dead-band",
    "drive-curve",
    "battery-sag",
    "motor-heating",
    "torque-constant",
    "probe-late-friction",
];

/// Wheels off the floor whose friction, unknown to the model, takes half of what the motors can give: a rotor of any
/// other inertia, or any other effect at any value, explains none of it.
#[test]
fn no_effect_buys_the_metric_by_predicting_nothing() {
    let nominal = Robot { support: Support::Blocks, ..Robot::racbot() };
    let truth = with(&nominal, "coulomb-friction", &[("torque_nm", 0.03)]);
    let set = simulate(&truth, &[Manoeuvre::Blocks], 7);
    let logs = Logs::from(&set);
    let pieces = segments(&set.robot, &set.robot.geometry().unwrap(), &logs.logs, PIECE);
    let base = DriveModel::new(&set.robot);
    let link = DriveLink::new(&pieces, &base).unwrap();
    let open = left(&link, &base);
    let away = runaway(&link, &base).unwrap();
    let mut tried = 0;
    let other = |e: &dyn Effect| e.link() == Link::Drive && !TAKE_TORQUE.contains(&e.name());
    for effect in gap::effects::catalogue().iter().filter(|effect| other(effect.as_ref())) {
        for form in effect.forms(&set.robot) {
            for share in [0.0, 0.02, 0.1, 0.3, 0.6, 0.9, 1.0] {
                let mut values = Values(form.fixed.clone());
                for p in &form.free {
                    values.set(&p.name, p.bounds[0] + share * (p.bounds[1] - p.bounds[0]));
                }
                let mut model = DriveModel::new(&set.robot);
                effect.drive(&values, &mut model);
                let Some(worse) = runaway(&link, &model) else { continue };
                tried += 1;
                let closes = left(&link, &model) < 0.8 * open && !further(&worse, &away, 0.0);
                assert!(!closes, "{} {values:?}: {} Nm of {open}", effect.name(), left(&link, &model));
            }
        }
    }
    assert!(tried > 50, "{tried}");
    // What it is does close it.
    let mut model = DriveModel::new(&set.robot);
    gap::effects::find("coulomb-friction").unwrap().drive(&Values(vec![("torque_nm".to_owned(), 0.03)]), &mut model);
    let closed = left(&link, &model);
    assert!(closed < 0.2 * open && !further(&runaway(&link, &model).unwrap(), &away, 0.0), "{closed} of {open}");
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
