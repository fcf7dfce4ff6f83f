//! `body-drag`: the floor holds the body back, whichever way it goes.

use runs::robot::Robot;

use crate::drive::{DriveModel, smooth_sign};
use crate::effect::{Effect, Form, Link, Parameter, Sizes, Values};

/// A carpet, a skirt or a caster that holds the body back, whichever way it goes.
pub(super) struct BodyDrag;

impl Effect for BodyDrag {
    fn name(&self) -> &str {
        "body-drag"
    }

    fn equation(&self) -> &str {
        "force -force_n v / |v| on the body at its centre, v its velocity"
    }

    fn reference(&self) -> &str {
        "-"
    }

    fn link(&self) -> Link {
        Link::Drive
    }

    fn forms(&self, robot: &Robot) -> Vec<Form> {
        self.forms_in(robot, &Sizes::of(robot))
    }

    fn forms_in(&self, robot: &Robot, sizes: &Sizes) -> Vec<Form> {
        let w = sizes.body_n(robot);
        vec![Form::whole(vec![Parameter::new("force_n", 0.005 * w, [-0.05 * w, w], 0.012 * w)])]
    }

    fn is_load(&self) -> bool {
        true
    }

    fn drive(&self, values: &Values, model: &mut DriveModel) {
        let force = values.get("force_n");
        model.loads.push(Box::new(move |now, loads| {
            let speed = now.twist.speed();
            if speed > 0.0 {
                let per_speed = -force * smooth_sign(speed, now.sliding()) / speed;
                loads.body[0] += per_speed * now.twist.vx;
                loads.body[1] += per_speed * now.twist.vy;
            }
        }));
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some((
            "pull the robot over the floor with a spring scale, its motors disconnected, and once more on a smooth one",
            5.0,
        ))
    }
}
