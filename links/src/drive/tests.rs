//! What effects say of themselves, by which derivatives are worked out once, holds for the torques that they make.

use std::borrow::Cow;
use std::sync::Arc;

use model::effects::Applied;
use model::manoeuvre::{Manoeuvre, simulate};
use runs::Log;
use runs::frames::Pose;
use runs::robot::{EffectParameter, Robot, Support};

use super::{DriveLink, DriveModel};
use crate::effect::{Effect, Form};
use crate::pieces::{PIECE, Pieces, segments};
use crate::values::Values;

/// A model with effects at values, none of which is known to be in proportion to anything.
fn with(robot: &Robot, effects: &[(&dyn Effect, Values)]) -> DriveModel {
    let mut model = DriveModel::new(robot);
    for (effect, values) in effects {
        effect.drive(values, &mut model);
        model.bending.push((effect.name().to_owned(), values.clone()));
    }
    model
}

/// A robot with the logs of one on the floor, whatever it stands on.
fn on_a_drive(robot: &Robot, of: impl Fn(&Robot, &Pieces)) {
    let driven = Robot::racbot();
    let run = simulate(Manoeuvre::StopAndGo, &Applied::of(&driven), &driven, Pose::default(), 1).unwrap();
    let logs = [Log::from(Cow::Owned(run))];
    of(robot, &segments(robot, &robot.geometry().unwrap(), &logs, PIECE));
}

/// Every parameter of the forms of some effects, moved by its scale.
fn moved(robot: &Robot, which: impl Fn(&dyn Effect) -> bool) -> Vec<(Arc<dyn Effect>, Values)> {
    let mut out = Vec::new();
    for effect in crate::effects::catalogue().into_iter().map(Arc::from).filter(|e: &Arc<dyn Effect>| which(&**e)) {
        for form in effect.forms(robot) {
            for p in &form.free {
                let start = form.free.iter().map(|f| (f.name.clone(), f.start.unwrap_or(0.0)));
                let mut values = Values(form.fixed.iter().cloned().chain(start).collect());
                values.set(&p.name, values.get(&p.name) + p.scale);
                out.push((effect.clone(), values));
            }
        }
    }
    out
}

#[test]
fn inertias_alone_leave_torques_as_they_are() {
    on_a_drive(&Robot::racbot(), |robot, pieces| {
        let segment = pieces.get(0);
        let nominal = DriveModel::new(robot);
        let base = nominal.forces(&segment);
        let moved = moved(robot, |e| ["rotor-inertia", "yaw-inertia"].contains(&e.name()));
        assert!(moved.len() >= 2);
        for (effect, values) in moved {
            let mut model = DriveModel::new(robot);
            model.add(&*effect, &values, &Form::default());
            assert!(model.torques_stand_alone());
            assert!(model.forces(&segment) == base, "{}", effect.name());
            assert!(model.torques_identity() == nominal.torques_identity(), "{}", effect.name());
        }
    });
}

#[test]
fn what_a_load_or_a_camera_changes_leaves_the_torques_that_are_kept() {
    let robot = Robot::racbot();
    let nominal = DriveModel::new(&robot);
    let changed = |which: &dyn Fn(&dyn Effect) -> bool| -> Vec<(String, [bool; 2])> {
        let of = |(effect, values): (Arc<dyn Effect>, Values)| {
            let mut model = DriveModel::new(&robot);
            model.add(&*effect, &values, &Form::default());
            let torques = model.torques_identity() != nominal.torques_identity();
            (effect.name().to_owned(), [torques, model.motion_identity() != nominal.motion_identity()])
        };
        moved(&robot, which).into_iter().map(of).collect()
    };
    let loads = changed(&|e| e.is_load());
    assert!(loads.len() > 30 && loads.iter().all(|(_, changed)| *changed == [false; 2]), "{loads:?}");
    let cameras = changed(&|e| ["camera-latency", "marker-offset", "lens-distortion"].contains(&e.name()));
    assert!(cameras.len() >= 3 && cameras.iter().all(|(_, changed)| *changed == [false; 2]), "{cameras:?}");
    // Nor does a bridge change what loads look at.
    let bridges = changed(&|e| ["winding-resistance", "battery-sag", "dead-band", "current-limit"].contains(&e.name()));
    assert!(bridges.len() >= 4 && bridges.iter().all(|(_, changed)| *changed == [true, false]), "{bridges:?}");
}

#[test]
fn what_is_worked_out_once_is_what_each_model_gives() {
    let on_blocks = |gear_efficiency| Robot { support: Support::Blocks, gear_efficiency, ..Robot::racbot() };
    for robot in [Robot::racbot(), on_blocks(1.0), on_blocks(0.8)] {
        what_is_worked_out_once_of(&robot);
    }
}

fn what_is_worked_out_once_of(robot: &Robot) {
    on_a_drive(robot, |robot, pieces| {
        let nominal = DriveModel::new(robot);
        let [link, fresh] = [(); 2].map(|()| DriveLink::new(pieces, &nominal).unwrap());
        // What was kept of one model serves the next: every effect beside others of every kind.
        let named = |name: &str, n: usize| {
            let effect: Arc<dyn Effect> = Arc::from(crate::effects::find(name).unwrap());
            let form = effect.forms(robot).remove(n);
            let mut values = Values(form.fixed.clone());
            form.free.iter().for_each(|p| values.set(&p.name, p.start.unwrap_or(0.0) + 1.7 * p.scale));
            (effect, values, form)
        };
        let beside = [
            vec![],
            vec![named("coulomb-friction", 0), named("rotor-inertia", 0)],
            vec![named("viscous-friction", 1), named("winding-resistance", 0), named("encoder-eccentricity", 0)],
            vec![named("wheel-radius", 0), named("dead-band", 0), named("stribeck-friction", 0)],
        ];
        let mut looked = 0;
        for others in &beside {
            for effect in crate::effects::catalogue().into_iter().map(Arc::<dyn Effect>::from) {
                for form in effect.forms(robot) {
                    let mut values = Values(form.fixed.clone());
                    form.free.iter().for_each(|p| values.set(&p.name, p.start.unwrap_or(0.0) + p.scale));
                    let own = (effect.clone(), values, form);
                    let all = || others.iter().chain([&own]);
                    let [mut parted, mut given] = [(); 2].map(|()| DriveModel::new(robot));
                    all().for_each(|(effect, values, form)| parted.add(&**effect, values, form));
                    all().for_each(|(effect, values, _)| given.add(&**effect, values, &Form::default()));
                    let effects: Vec<_> = all().map(|(effect, values, _)| (&**effect, values.clone())).collect();
                    let left = |link: &DriveLink, model: &DriveModel| -> Option<Vec<f64>> {
                        Some(link.residuals(model)?.torque.concat())
                    };
                    let Some(whole) = left(&fresh, &with(robot, &effects)) else { continue };
                    let largest = whole.iter().fold(1e-3_f64, |most, x| most.max(x.abs()));
                    for model in [parted, given] {
                        let left = left(&link, &model).unwrap();
                        let apart = left.iter().zip(&whole).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
                        assert!(apart <= 1e-9 * largest, "{} {:?}: {apart} of {largest} Nm", own.0.name(), own.1);
                    }
                    looked += 1;
                }
            }
        }
        assert!(looked > 400, "{looked}");
    });
}

#[test]
fn counts_that_an_encoder_loses_are_no_torque_of_its_motor() {
    let [lossy, exact] = [0.1, 0.0].map(|loss| {
        let robot = Robot::racbot();
        let lost = [("loss_1", loss), ("threshold_rad_s", 4.0)];
        let parameters = lost.map(|(n, value)| (n.to_owned(), EffectParameter { value, ..EffectParameter::default() }));
        let loses = runs::robot::Effect {
            name: "encoder-loss".to_owned(),
            parameters: parameters.into_iter().collect(),
            ..runs::robot::Effect::default()
        };
        let truth = Robot { effects: vec![loses], ..robot.clone() };
        let run = simulate(Manoeuvre::Chirp, &Applied::of(&truth), &robot, Pose::default(), 1).unwrap();
        let logs = [Log::from(Cow::Owned(run))];
        let pieces = segments(&robot, &robot.geometry().unwrap(), &logs, PIECE);
        let nominal = DriveModel::new(&robot);
        let effect: Arc<dyn Effect> = Arc::from(crate::effects::find("encoder-loss").unwrap());
        let mut knows = DriveModel::new(&robot);
        let values = Values(lost.iter().map(|(n, v)| ((*n).to_owned(), *v)).collect());
        knows.add(&*effect, &values, &Form::default());
        let link = DriveLink::new(&pieces, &nominal).unwrap();
        [&nominal, &knows].map(|model| {
            let torques = link.residuals(model).unwrap().torque.concat();
            (torques.iter().map(|t| t * t).sum::<f64>() / torques.len() as f64).sqrt()
        })
    });
    // Beside what the speed of the threshold leaves open.
    assert!(lossy[0] > 10.0 * exact[0] && lossy[1] < 0.5 * lossy[0], "{lossy:?} {exact:?}");
}

/// Of a motor alone, and of one that is all but done within a row.
#[test]
fn between_rows_a_back_emf_is_an_inertia() {
    let robot = Robot { support: Support::Blocks, ..Robot::racbot() };
    let model = DriveModel::new(&robot);
    let plain = model.mechanics().unwrap();
    let motor_s = plain.inertia[(0, 0)] / model.axes[0].braking(model.gear_ratio);
    for (rows, off) in [(0.0, 1e-12), (0.5, 1e-4), (1.5, 2e-3), (4.0, 0.02)] {
        let bent = model.mechanics().unwrap().between_rows(&model, rows * motor_s).unwrap();
        let wanted = if rows == 0.0 { 1.0 } else { 0.5 * rows / (0.5_f64 * rows).tanh() };
        let of = [bent.inertia[(0, 0)] / plain.inertia[(0, 0)], plain.response[(0, 0)] / bent.response[(0, 0)]];
        assert!(of.iter().all(|of| (of / wanted - 1.0).abs() < off), "{rows}: {of:?} {wanted}");
    }
}
