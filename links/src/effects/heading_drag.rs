//! `heading-drag`: friction of a wheel that depends on the heading, as a dragging cable gives.

use runs::robot::Robot;

use crate::drive::DriveModel;
use crate::effect::{Effect, Form, Link, Parameter, Sizes, Values};

/// Friction of a wheel that depends on the heading, as a dragging cable gives.
pub(super) struct HeadingDrag;

impl Effect for HeadingDrag {
    fn name(&self) -> &str {
        "heading-drag"
    }

    fn equation(&self) -> &str {
        "torque -(mean_nm + cos_nm cos(n theta) + sin_nm sin(n theta)) sign(w) at all wheels, theta the heading"
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

    fn forms_in(&self, _robot: &Robot, sizes: &Sizes) -> Vec<Form> {
        let drive = sizes.drive_nm;
        [1.0, 2.0, 3.0]
            .into_iter()
            .map(|n| {
                let p = |name: &str| Parameter::new(name, 0.01 * drive, [-drive, drive], 0.03 * drive);
                Form::whole(vec![
                    p("cos_nm"),
                    p("sin_nm"),
                    Parameter::new("mean_nm", 0.01 * drive, [-drive, drive], f64::INFINITY),
                ])
                .fixing("harmonic", n)
            })
            .collect()
    }

    fn is_load(&self) -> bool {
        true
    }

    fn drive(&self, values: &Values, model: &mut DriveModel) {
        let (a, b, n) = (values.get("cos_nm"), values.get("sin_nm"), values.find("harmonic").unwrap_or(1.0));
        let mean = values.get("mean_nm");
        model.loads.push(Box::new(move |now, loads| {
            let [c, s] = now.facing_times(n);
            let t = mean + a * c + b * s;
            for i in 0..now.sign.len() {
                loads.wheel[i] -= t * now.sign[i];
            }
        }));
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("the same drive with the cable taken off", 3.0))
    }
}
