//! Mistakes in the columns of an inertial sensor are found, and said with what to write; none is found in good ones.

use model::effects::Applied;
use model::manoeuvre::{Manoeuvre, simulate};
use model::setup::{Mistake, mistakes};
use runs::frames::Pose;
use runs::robot::{ImuMount, Robot, SensorName};
use runs::{DataSet, Logs, Run};

fn set() -> DataSet {
    let robot = Robot { imu: SensorName::new("icm-42688-p").map(ImuMount::upright), ..Robot::racbot() };
    let drive = |m| simulate(m, &Applied::of(&robot), &robot, Pose::new(0.4, 0.2, 1.0), 5).unwrap();
    DataSet { folder: "set".into(), runs: vec![drive(Manoeuvre::Spin), drive(Manoeuvre::StopAndGo)], robot }
}

fn found(spoil: impl Fn(&mut Run)) -> Vec<Mistake> {
    let mut set = set();
    set.runs.iter_mut().for_each(spoil);
    mistakes(&Logs::from(&set))
}

fn every(axes: &mut Option<[Vec<f64>; 3]>, change: impl Fn([f64; 3]) -> [f64; 3]) {
    let axes = axes.as_mut().unwrap();
    for k in 0..axes[0].len() {
        let row = change([0, 1, 2].map(|i| axes[i][k]));
        axes.iter_mut().zip(row).for_each(|(axis, value)| axis[k] = value);
    }
}

#[test]
fn good_columns_have_none_and_neither_have_absent_ones() {
    assert_eq!(found(|_| {}), []);
    assert_eq!(found(|run| (run.gyro, run.acceleration) = (None, None)), []);
    // One axis alone, and half of its rows.
    let alone = |run: &mut Run| {
        run.acceleration = None;
        every(&mut run.gyro, |[_, _, z]| [f64::NAN, f64::NAN, z]);
        run.gyro.iter_mut().for_each(|axes| axes[2].iter_mut().step_by(2).for_each(|z| *z = f64::NAN));
    };
    assert_eq!(found(alone), []);
    // A driver that takes gravity away.
    assert_eq!(found(|run| every(&mut run.acceleration, |[x, y, z]| [x, y, z - 9.81])), []);
}

/// What was done, the kind that names it, its column, a word of the remedy.
type Case = (fn(&mut Run), &'static str, &'static str, &'static str);

#[test]
fn units_signs_and_axes_are_said_with_the_column_and_what_to_write() {
    let cases: [Case; 9] = [
        (|run| every(&mut run.gyro, |v| v.map(f64::to_degrees)), "gyro-unit", "gyro_z", "0.0174533"),
        (|run| every(&mut run.gyro, |v| v.map(|x| 1e3 * x.to_degrees())), "gyro-unit", "gyro_z", "0.0000174533"),
        (|run| every(&mut run.gyro, |v| v.map(f64::to_radians)), "gyro-unit", "gyro_z", "57.29578"),
        (|run| every(&mut run.gyro, |[x, y, z]| [x, -y, -z]), "gyro-sign", "gyro_z", "counter-clockwise"),
        (|run| every(&mut run.gyro, |[x, y, z]| [z, y, -x]), "gyro-axes", "gyro_x", "gyro_z"),
        (|run| every(&mut run.gyro, |[x, y, z]| [x, -z, y]), "gyro-axes", "gyro_y", "sign changed"),
        (|run| every(&mut run.acceleration, |v| v.map(|x| x / 9.806_65)), "acc-unit", "acc_z", "9.80665"),
        (|run| every(&mut run.acceleration, |v| v.map(|x| -x)), "acc-sign", "acc_z", "signs"),
        (|run| every(&mut run.acceleration, |[x, y, z]| [x, -z, y]), "acc-axes", "acc_y", "acc_z points up"),
    ];
    for (spoil, kind, column, remedy) in cases {
        let mistakes = found(spoil);
        let said = mistakes.iter().map(|m| format!("[{}] {}", m.kind, m.sentence())).collect::<Vec<_>>();
        let [one] = &mistakes[..] else { panic!("{kind}: {said:?}") };
        assert!(one.kind == kind && one.column == column && one.remedy.contains(remedy), "{kind}: {said:?}");
    }
}
