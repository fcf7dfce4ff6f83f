//! `wheel-angle`: wheels mounted at another angle round the centre.

use runs::geometry::Wheel;
use runs::robot::Robot;

use crate::drive::DriveModel;
use crate::effect::{Effect, Form, Link, Parameter, Values, turn_wheels, wheel_name};
use crate::motion::MotionModel;

/// Wheels mounted at another angle round the centre.
pub(super) struct WheelAngle;

impl Effect for WheelAngle {
    fn name(&self) -> &str {
        "wheel-angle"
    }

    fn equation(&self) -> &str {
        "mount and drive direction of wheel i turned together, counter-clockwise, by angle_i about the centre"
    }

    fn reference(&self) -> &str {
        "paper, section 3, equation (6)"
    }

    fn link(&self) -> Link {
        Link::Motion
    }

    fn forms(&self, robot: &Robot) -> Vec<Form> {
        vec![Form::each(robot, |i| {
            Parameter::new(wheel_name("angle", i, "rad"), 0.01, [-0.6, 0.6], 0.4_f64.to_radians())
        })]
    }

    fn motion(&self, values: &Values, model: &mut MotionModel) {
        turn_wheels(&mut model.wheels, |i, w| mount(w, values.wheel("angle", i, "rad")));
    }

    fn drive(&self, values: &Values, model: &mut DriveModel) {
        turn_wheels(&mut model.wheels, |i, w| mount(w, values.wheel("angle", i, "rad")));
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("measure the mounts on the base plate", 10.0))
    }
}

fn mount(wheel: &mut Wheel, angle: f64) {
    let (s, c) = angle.sin_cos();
    (wheel.x_m, wheel.y_m) = (c * wheel.x_m - s * wheel.y_m, s * wheel.x_m + c * wheel.y_m);
    wheel.drive_rad += angle;
}
