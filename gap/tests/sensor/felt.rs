//! Simulated robots with an inertial sensor, whose truth is known.

use std::path::PathBuf;

use gap::{Analysis, Options, analyse};
use model::effects::Applied;
use model::imu::{Imu, ImuModel};
use model::manoeuvre::{Manoeuvre, simulate};
use model::plant::{Contact, Creep};
use runs::DataSet;
use runs::frames::Pose;
use runs::robot::{Effect, EffectParameter, ImuMount, Robot, SensorName};

/// An effect with its parameters.
pub(super) type Hidden<'a> = (&'a str, &'a [(&'a str, f64)]);

/// The paper's robot with a sensor in its centre.
pub(super) fn robot() -> Robot {
    Robot { imu: SensorName::new("icm-42688-p").map(ImuMount::upright), ..Robot::racbot() }
}

/// Effects as a robot's file has them.
pub(super) fn effects(hidden: &[Hidden]) -> Vec<Effect> {
    let effect = |(name, parameters): &Hidden| {
        let parameter =
            |(n, v): &(&str, f64)| ((*n).to_owned(), EffectParameter { value: *v, ..EffectParameter::default() });
        Effect { name: (*name).to_owned(), parameters: parameters.iter().map(parameter).collect(), ..Effect::default() }
    };
    hidden.iter().map(effect).collect()
}

/// The same as it truly is, with one part of the sensor's type.
pub(super) fn truth(hidden: &[Hidden], part: u64) -> Applied {
    let mut applied = Applied::of(&Robot { effects: effects(hidden), ..robot() });
    assert!(applied.unsupported.is_empty(), "{:?}", applied.unsupported);
    applied.imu.part = part;
    if applied.contact == Contact::Rolling {
        // Contacts creep a little, as all do.
        applied.contact = Contact::Friction { friction_coefficient: 0.9, creep: Creep::at_rest(3e-4) };
    }
    applied
}

/// What the sensor of a robot truly differs by, its part's tolerances included.
pub(super) fn sensor(applied: &Applied) -> Imu {
    Imu::new(ImuModel::icm_42688_p(applied.robot.control_rate_hz), applied.imu.part).with_deviations(&applied.imu)
}

/// Logs of a robot; each seed drives from elsewhere.
pub(super) fn set(applied: &Applied, drives: &[Manoeuvre], seed: u64) -> DataSet {
    let nominal = robot();
    let run = |(k, m): (usize, &Manoeuvre)| {
        let seed = 100 * seed + k as u64;
        let mut run = simulate(*m, applied, &nominal, Pose::new(0.3, -0.2, 0.4 + seed as f64), seed).unwrap();
        run.name = format!("{}_{seed}", m.name());
        run
    };
    DataSet { folder: PathBuf::from("simulated"), runs: drives.iter().enumerate().map(run).collect(), robot: nominal }
}

/// The same without the sensor's columns.
pub(super) fn numb(mut set: DataSet) -> DataSet {
    for run in &mut set.runs {
        (run.gyro, run.acceleration, run.imu_temp) = (None, None, None);
    }
    set
}

/// The same without a camera.
pub(super) fn blind(mut set: DataSet) -> DataSet {
    for run in &mut set.runs {
        run.camera.clear();
        run.has_camera = false;
    }
    set
}

/// What the analysis says.
pub(super) fn done(set: &DataSet) -> Analysis {
    analyse(set, &Options::default()).unwrap()
}

/// Names of the effects that were found.
pub(super) fn names(a: &Analysis) -> Vec<&str> {
    a.effects.iter().map(|e| e.name.as_str()).collect()
}

/// A parameter of what was found: its estimate and the ends of its interval.
pub(super) fn estimate(a: &Analysis, parameter: &str) -> (f64, [f64; 2]) {
    let all = a.effects.iter().flat_map(|e| &e.parameters);
    let found = all.filter(|p| p.0 == parameter).map(|p| (p.1, p.2.ends().unwrap_or([p.1; 2]))).next();
    found.unwrap_or((f64::NAN, [f64::NAN; 2]))
}
