//! `wheel-radius-common`: all wheels larger or smaller by the same share.

use runs::robot::Robot;

use crate::drive::DriveModel;
use crate::effect::{Effect, Form, Link, Parameter, Values};
use crate::motion::MotionModel;

/// All wheels larger or smaller by the same share.
pub(super) struct WheelRadiusCommon;

impl Effect for WheelRadiusCommon {
    fn name(&self) -> &str {
        "wheel-radius-common"
    }

    fn equation(&self) -> &str {
        "r becomes r (1 + scale) for all wheels"
    }

    fn reference(&self) -> &str {
        "Borenstein and Feng 1996, UMBmark"
    }

    fn link(&self) -> Link {
        Link::Motion
    }

    fn forms(&self, _robot: &Robot) -> Vec<Form> {
        vec![Form::whole(vec![Parameter::new("scale", 0.01, super::SIZES, 0.004)])]
    }

    fn motion(&self, values: &Values, model: &mut MotionModel) {
        model.distance_scale.iter_mut().for_each(|s| *s *= 1.0 + values.get("scale"));
    }

    fn drive(&self, values: &Values, model: &mut DriveModel) {
        model.radius_scale.iter_mut().for_each(|s| *s *= 1.0 + values.get("scale"));
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("measure the wheels with a calliper, or drive 2 m along a tape measure", 3.0))
    }
}
