//! `roller-ripple`: a rolling radius that varies with the angle of the wheel.

use runs::robot::Robot;

use crate::effect::{Effect, Form, Link, Parameter, Values, wheel_name};
use crate::motion::MotionModel;

/// A rolling radius that varies with the angle of the wheel.
pub(super) struct RollerRipple;

impl Effect for RollerRipple {
    fn name(&self) -> &str {
        "roller-ripple"
    }

    fn equation(&self) -> &str {
        "radius r (1 + cos_i cos(order phi_i) + sin_i sin(order phi_i))"
    }

    fn reference(&self) -> &str {
        "omni wheels as polygons"
    }

    fn link(&self) -> Link {
        Link::Motion
    }

    fn forms(&self, robot: &Robot) -> Vec<Form> {
        let _ = robot;
        [1.0]
            .into_iter()
            .map(|order| {
                let p = |stem: &str, i| Parameter::new(wheel_name(stem, i, ""), 0.01, [-0.3, 0.3], 0.03);
                let mut free = Vec::new();
                for i in 0..robot.wheel_count() {
                    free.push(p("cos", i));
                    free.push(p("sin", i));
                }
                Form { wheels: (0..robot.wheel_count()).collect(), free, fixed: vec![("order".to_owned(), order)] }
            })
            .collect()
    }

    fn motion(&self, values: &Values, model: &mut MotionModel) {
        let values = values.clone();
        model.angles.push(Box::new(move |segment, angles| {
            let order = values.get("order").max(1.0);
            for (i, angle) in angles.iter_mut().enumerate() {
                let (a, b) = (values.wheel("cos", i, ""), values.wheel("sin", i, ""));
                if a == 0.0 && b == 0.0 {
                    continue;
                }
                for (x, phi) in angle.iter_mut().zip(&segment.angle[i]) {
                    let (s, c) = (order * phi).sin_cos();
                    *x += (a * s - b * c) / order;
                }
            }
        }));
    }
}
