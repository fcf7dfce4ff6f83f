//! What effects say of themselves, by which derivatives are worked out once, holds for the torques that they make.

use std::borrow::Cow;
use std::sync::Arc;

use model::effects::Applied;
use model::manoeuvre::{Manoeuvre, simulate};
use runs::Log;
use runs::frames::Pose;
use runs::robot::Robot;

use super::{DriveLink, DriveModel};
use crate::effect::Effect;
use crate::pieces::{PIECE, Pieces, segments};
use crate::values::Values;

/// A model with effects at values, named as their parameters are.
fn with(robot: &Robot, effects: &[(&dyn Effect, Values)]) -> DriveModel {
    let mut model = DriveModel::new(robot);
    for (effect, values) in effects {
        effect.drive(values, &mut model);
        model.effects.push((effect.name().to_owned(), values.clone()));
    }
    model
}

fn on_a_drive(of: impl Fn(&Robot, &Pieces)) {
    let robot = Robot::racbot();
    let run = simulate(Manoeuvre::StopAndGo, &Applied::of(&robot), &robot, Pose::default(), 1).unwrap();
    let logs = [Log::from(Cow::Owned(run))];
    of(&robot, &segments(&robot, &robot.geometry().unwrap(), &logs, PIECE));
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
    on_a_drive(|robot, pieces| {
        let segment = pieces.get(0);
        let base = DriveModel::new(robot).forces(&segment);
        let moved = moved(robot, |e| e.is_inertia());
        assert!(moved.len() >= 2);
        for (effect, values) in moved {
            let model = with(robot, &[(&*effect, values)]);
            assert!(model.torques_stand_alone());
            assert!(model.forces(&segment) == base, "{}", effect.name());
        }
    });
}

#[test]
fn what_a_load_or_a_bridge_changes_no_other_load_does() {
    on_a_drive(|robot, pieces| {
        let link = DriveLink::new(pieces, &DriveModel::new(robot)).unwrap();
        let loads: Vec<_> = ["coulomb-friction", "viscous-friction"].map(|n| crate::effects::find(n).unwrap()).into();
        let values =
            [Values(vec![("torque_nm".to_owned(), 0.004)]), Values(vec![("coefficient_nms".to_owned(), 2e-4)])];
        let besides: Vec<(&dyn Effect, Values)> = loads.iter().map(|e| &**e).zip(values).collect();
        let left = |effects: &[(&dyn Effect, Values)]| link.residuals(&with(robot, effects)).unwrap().torque.concat();
        let (nothing, loaded) = (left(&[]), left(&besides));
        let moved = moved(robot, |e| e.is_load() || e.before_current());
        assert!(moved.len() > 30, "{}", moved.len());
        for (effect, values) in moved {
            let own = [(&*effect, values)];
            let both: Vec<_> = besides.iter().cloned().chain(own.iter().cloned()).collect();
            let (alone, both) = (left(&own), left(&both));
            let change = alone.iter().zip(&nothing).map(|(a, b)| a - b);
            let beside = both.iter().zip(&loaded).map(|(a, b)| a - b);
            let largest = change.clone().fold(0.0_f64, |most, x| most.max(x.abs()));
            let apart = change.zip(beside).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
            assert!(apart <= 1e-9 * largest.max(1e-3), "{} {:?}: {apart} of {largest} Nm", effect.name(), own[0].1);
        }
    });
}

#[test]
fn what_a_bridge_or_a_camera_changes_no_load_of_the_motion_does() {
    on_a_drive(|robot, pieces| {
        let link = DriveLink::new(pieces, &DriveModel::new(robot)).unwrap();
        let left = |effects: &[(&dyn Effect, Values)]| link.residuals(&with(robot, effects)).unwrap().torque.concat();
        let loads = moved(robot, |e| e.is_load() && !e.looks_at_motors());
        let nothing = left(&[]);
        let changes = |besides: &[f64], effects: &[(&dyn Effect, Values)]| -> Vec<f64> {
            left(effects).iter().zip(besides).map(|(with, without)| with - without).collect()
        };
        let alone: Vec<Vec<f64>> = loads.iter().map(|(e, v)| changes(&nothing, &[(&**e, v.clone())])).collect();
        for name in ["winding-resistance", "battery-sag", "dead-band", "current-limit"] {
            let bridge = crate::effects::find(name).unwrap();
            let values = moved(robot, |e| e.name() == name).remove(0).1;
            assert!(bridge.before_current() && DriveModel::is_changed_by(robot, &*bridge, &values), "{name}");
            let other = left(&[(&*bridge, values.clone())]);
            assert!(other != nothing);
            for ((load, at), alone) in loads.iter().zip(&alone) {
                let beside = changes(&other, &[(&*bridge, values.clone()), (&**load, at.clone())]);
                let largest = alone.iter().fold(1e-3_f64, |most, x| most.max(x.abs()));
                let apart = alone.iter().zip(&beside).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
                assert!(apart <= 1e-9 * largest, "{} beside {name}: {apart} of {largest} Nm", load.name());
            }
        }
        for (effect, values) in
            moved(robot, |e| ["camera-latency", "marker-offset", "lens-distortion"].contains(&e.name()))
        {
            assert!(!DriveModel::is_changed_by(robot, &*effect, &values), "{}", effect.name());
        }
    });
}
