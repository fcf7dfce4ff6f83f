//! `carpet-grain`: a carpet that drags along one direction of the field only.

use runs::robot::Robot;

use crate::drive::{DriveModel, smooth_sign};
use crate::effect::{Effect, Form, Link, Parameter, Sizes, Values};

/// A carpet that drags along one direction of the field only.
pub(super) struct CarpetGrain;

impl Effect for CarpetGrain {
    fn name(&self) -> &str {
        "carpet-grain"
    }

    fn equation(&self) -> &str {
        "force -force_n sign(v . g) g, g the direction azimuth_rad in the world"
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
        (0..8)
            .map(|k| {
                let azimuth = Parameter::new("azimuth_rad", 0.1, [-3.2, 3.2], f64::INFINITY)
                    .from(f64::from(k) * std::f64::consts::FRAC_PI_8);
                Form::whole(vec![Parameter::new("force_n", 0.005 * w, [0.0, w], 0.012 * w).from(0.02 * w), azimuth])
            })
            .collect()
    }

    fn drive(&self, values: &Values, model: &mut DriveModel) {
        let (force, azimuth) = (values.get("force_n"), values.get("azimuth_rad"));
        let g = [azimuth.cos(), azimuth.sin()];
        model.loads.push(Box::new(move |now, loads| {
            let v = now.world_velocity();
            let f = -force * smooth_sign(v[0] * g[0] + v[1] * g[1], 2.0 * now.sliding());
            loads.push_world(now.facing, [f * g[0], f * g[1]]);
        }));
    }

    fn period(&self, parameter: &str) -> Option<f64> {
        // A grain drags to and fro alike.
        (parameter == "azimuth_rad").then_some(std::f64::consts::PI)
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("pull the robot along and across the carpet with a spring scale", 5.0))
    }
}
