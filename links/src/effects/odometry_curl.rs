//! `odometry-curl`: dead reckoning that turns too little or too much for every metre of the way.

use runs::robot::Robot;

use crate::effect::{Effect, Form, Link, Parameter, Values};
use crate::motion::MotionModel;

/// Turn per metre that matters, rad/m: after 10 m the robot is 10 cm beside its way.
const MATERIAL: f64 = 0.002;
/// Turn per metre beyond which no robot drives what it believes to be a straight line: a quarter turn in 3 m.
const MOST: f64 = 0.5;

/// What unequal wheels do to the odometry of a robot that logs nothing of its wheels. Beside the scales of way and turn
/// (`wheel-radius-common`, `body-radius`, `sideways-creep`) this is what a linear law of the twist has that rolls.
pub(super) struct OdometryCurl;

impl Effect for OdometryCurl {
    fn name(&self) -> &str {
        "odometry-curl"
    }

    fn equation(&self) -> &str {
        "the robot turns so many radians further than its odometry says for every metre forward (body y) and sideways \
         (body x): on two wheels the right radius larger than the left by curl times the track, as a share"
    }

    fn reference(&self) -> &str {
        "Borenstein and Feng 1996, UMBmark (unequal wheel diameters)"
    }

    fn link(&self) -> Link {
        Link::Motion
    }

    fn forms(&self, _robot: &Robot) -> Vec<Form> {
        let p = |name| Parameter::new(name, 0.005, [-MOST, MOST], MATERIAL);
        let (forward, sideways) = (p("forward_rad_per_m"), p("sideways_rad_per_m"));
        vec![Form::whole(vec![forward.clone()]), Form::whole(vec![forward, sideways])]
    }

    fn motion(&self, values: &Values, model: &mut MotionModel) {
        model.curl[0] += values.find("sideways_rad_per_m").unwrap_or(0.0);
        model.curl[1] += values.get("forward_rad_per_m");
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("drive 5 m along a straight line on the floor by odometry alone, and measure the turn at its end", 3.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_metre_turns_the_robot() {
        let robot = Robot::racbot();
        let mut model = MotionModel::new(&robot);
        let before = model.columns().unwrap();
        let values = Values(vec![("forward_rad_per_m".to_owned(), 0.01), ("sideways_rad_per_m".to_owned(), -0.02)]);
        OdometryCurl.motion(&values, &mut model);
        for (a, b) in before.iter().zip(model.columns().unwrap()) {
            assert_eq!([a[0], a[1]], [b[0], b[1]]);
            assert!((b[2] - a[2] - 0.01 * a[1] + 0.02 * a[0]).abs() < 1e-15);
        }
    }
}
