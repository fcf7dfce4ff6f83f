//! `sideways-creep`: rollers that give way when the robot moves sideways.

use runs::robot::Robot;

use crate::effect::{Effect, Form, Link, Parameter, Values};
use crate::motion::MotionModel;

/// Rollers that give way (or roll on a larger circle) when the robot moves sideways.
pub(super) struct SidewaysCreep;

impl Effect for SidewaysCreep {
    fn name(&self) -> &str {
        "sideways-creep"
    }

    fn equation(&self) -> &str {
        "the robot moves (1 + scale) times as far sideways (body x) as its wheels say"
    }

    fn reference(&self) -> &str {
        "Sousa, Petry and Moreira 2022 (calibration of omnidirectional odometry); Han et al. 2009 (slip of mecanum rollers)"
    }

    fn link(&self) -> Link {
        Link::Motion
    }

    fn forms(&self, robot: &Robot) -> Vec<Form> {
        // Two driven wheels move nothing sideways.
        if robot.wheel_count() < 3 {
            return Vec::new();
        }
        vec![Form::whole(vec![Parameter::new("scale", 0.01, [-0.3, 0.3], 0.01)])]
    }

    fn motion(&self, values: &Values, model: &mut MotionModel) {
        model.sideways_scale *= 1.0 + values.get("scale");
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("drive 2 m sideways and 2 m forwards along a tape measure", 5.0))
    }
}
