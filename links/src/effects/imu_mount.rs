//! `imu-mount`: an inertial sensor that is turned on the robot, or sits elsewhere.

use runs::robot::Robot;

use crate::effect::{Effect, Form, Link, Parameter, Sizes, Values};
use crate::motion::MotionModel;

/// Angle that matters, rad: three standard deviations of soldering and mounting (0.5°).
const MATERIAL_RAD: f64 = 0.026;
/// Share of the distance from the centre to a wheel by which a place matters, as that of a marker plate, ...
const MATERIAL_PLACE: f64 = 0.03;
/// ... but no less than this, m: 1 % of the acceleration that drives a robot at 10 rad/s.
const LEAST_PLACE_M: f64 = 0.003;

/// An inertial sensor that is turned on the robot, or sits elsewhere.
pub(super) struct ImuMount;

impl Effect for ImuMount {
    fn name(&self) -> &str {
        "imu-mount"
    }

    fn equation(&self) -> &str {
        "sensor is turned by the rotation vector (x_rad, y_rad, z_rad) in the body frame and sits (x_m, y_m) from its place"
    }

    fn reference(&self) -> &str {
        "Titterton and Weston 2004, size effect and misalignment"
    }

    fn link(&self) -> Link {
        Link::Gyroscope
    }

    fn also(&self) -> Option<Link> {
        Some(Link::Accelerometer)
    }

    fn forms(&self, robot: &Robot) -> Vec<Form> {
        let rim = Sizes::of(robot).rim_m;
        let angle = |name| Parameter::new(name, 0.01, [-0.6, 0.6], MATERIAL_RAD);
        let material = (MATERIAL_PLACE * rim).max(LEAST_PLACE_M);
        let place = |name| Parameter::new(name, 0.025 * rim, [-4.0 * rim, 4.0 * rim], material);
        vec![
            Form::whole(vec![angle("x_rad"), angle("y_rad")]),
            Form::whole(vec![angle("z_rad")]),
            Form::whole(vec![place("x_m"), place("y_m")]),
            Form::whole(vec![angle("x_rad"), angle("y_rad"), angle("z_rad"), place("x_m"), place("y_m")]),
        ]
    }

    fn motion(&self, values: &Values, model: &mut MotionModel) {
        let angles = ["x_rad", "y_rad", "z_rad"].map(|name| values.get(name));
        model.sensor.turned_rad.iter_mut().zip(angles).for_each(|(own, more)| *own += more);
        let place = ["x_m", "y_m"].map(|name| values.get(name));
        model.sensor.place_m.iter_mut().zip(place).for_each(|(own, more)| *own += more);
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("lay the board on a flat square, and measure the chip's place with a calliper", 5.0))
    }
}
