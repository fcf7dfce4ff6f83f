//! `wheel-order`: axes that drive and count each other's wheels, or turn the other way; or set points that are
//! computed for each other's wheels. Cables (`cable_i`) and set points (`axis_i`) are two things: either, or both.

use runs::robot::Robot;

use crate::drive::DriveModel;
use crate::effect::{Effect, Form, Link, Values};
use crate::motion::MotionModel;

/// Wheels in another order than the model's.
pub(super) struct WheelOrder;

impl Effect for WheelOrder {
    fn name(&self) -> &str {
        "wheel-order"
    }

    fn equation(&self) -> &str {
        "axis i drives and counts wheel |cable_i|, or its set point is that of wheel |axis_i|; inverted where negative; all orders and signs are tried"
    }

    fn link(&self) -> Link {
        Link::Command
    }

    fn forms(&self, _robot: &Robot) -> Vec<Form> {
        Vec::new()
    }

    fn motion(&self, values: &Values, model: &mut MotionModel) {
        model.wheels = reordered(&model.wheels, values);
    }

    fn drive(&self, values: &Values, model: &mut DriveModel) {
        model.wheels = reordered(&model.wheels, values);
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("run one axis at a time and look which wheel turns", 1.0))
    }
}

fn reordered(wheels: &[runs::geometry::Wheel], values: &Values) -> Vec<runs::geometry::Wheel> {
    (0..wheels.len())
        .map(|i| {
            let cable = values.find(&format!("cable_{}", i + 1)).unwrap_or(i as f64 + 1.0);
            let index = (cable.abs().round() as usize).clamp(1, wheels.len()) - 1;
            let mut wheel = wheels[index];
            if cable < 0.0 {
                wheel.drive_rad += std::f64::consts::PI;
            }
            wheel
        })
        .collect()
}
