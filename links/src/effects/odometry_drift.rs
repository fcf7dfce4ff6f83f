//! `odometry-drift`: dead reckoning whose heading drifts with time, as by a gyroscope with a bias.

use runs::robot::Robot;

use crate::effect::{Effect, Form, Link, Parameter, Values};
use crate::motion::MotionModel;

/// Rate that matters, rad/s: 3.4 degrees a minute, some of the bias of a cheap gyroscope after it was zeroed at rest.
const MATERIAL: f64 = 0.001;
/// Rate that no gyroscope has as a bias, rad/s.
const MOST: f64 = 0.2;

/// Heading of the odometry that drifts with time.
pub(super) struct OdometryDrift;

impl Effect for OdometryDrift {
    fn name(&self) -> &str {
        "odometry-drift"
    }

    fn equation(&self) -> &str {
        "the heading of the robot's odometry lags by rate_rad_s in every second, moving or not"
    }

    fn reference(&self) -> &str {
        "Borenstein and Feng 1996, Gyrodometry"
    }

    fn link(&self) -> Link {
        Link::Motion
    }

    fn forms(&self, _robot: &Robot) -> Vec<Form> {
        vec![Form::whole(vec![Parameter::new("rate_rad_s", 0.005, [-MOST, MOST], MATERIAL)])]
    }

    fn motion(&self, values: &Values, model: &mut MotionModel) {
        let rate = values.get("rate_rad_s");
        // What each wheel turns while the body turns by a radian on the spot.
        let Ok(geometry) = runs::geometry::Geometry::new(model.wheels.clone(), model.wheel_radius_m) else { return };
        let turn: Vec<f64> = geometry.inverse().column(2).iter().map(|t| t * rate).collect();
        model.angles.push(Box::new(move |segment, angles| {
            for (angle, turn) in angles.iter_mut().zip(&turn) {
                angle.iter_mut().zip(&segment.t).for_each(|(a, t)| *a += turn * (t - segment.t[0]));
            }
        }));
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("let the robot stand for a minute and read the heading of its odometry", 1.0))
    }
}
