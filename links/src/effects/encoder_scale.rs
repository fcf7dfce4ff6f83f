//! `encoder-scale`: more or fewer counts a wheel turn than stated.

use runs::robot::Robot;

use crate::drive::DriveModel;
use crate::effect::{Effect, Form, Link, Parameter, Values, wheel_name};
use crate::motion::MotionModel;

/// More or fewer counts a wheel turn than stated.
pub(super) struct EncoderScale {
    /// The link that shows it: a camera, or for an axis alone its drive.
    pub(super) on: Link,
}

impl Effect for EncoderScale {
    fn name(&self) -> &str {
        "encoder-scale"
    }

    fn equation(&self) -> &str {
        "a wheel turn gives (1 + scale_i) times the counts stated, and the controller reckons with (1 + loop_scale) times them: wrong counts per turn or gear ratio"
    }

    fn reference(&self) -> &str {
        "data sheets of encoder and gear"
    }

    fn link(&self) -> Link {
        self.on
    }

    fn stands_for_several(&self) -> bool {
        // To an axis alone they are as much more braking by the back-EMF and inertia.
        self.on == Link::Drive
    }

    fn forms(&self, robot: &Robot) -> Vec<Form> {
        // A decoder may count one of four edges, or all where the file has one.
        let scale = |name: String| Parameter::new(name, 0.01, [-0.8, 3.5], 0.004);
        let p = |i| scale(wheel_name("scale", i, ""));
        let mut forms = vec![Form::whole(vec![scale("scale".to_owned())])];
        forms.extend(Form::alone(robot, p));
        forms.push(Form::each(robot, p));
        forms
    }

    fn motion(&self, values: &Values, model: &mut MotionModel) {
        for i in 0..model.wheels.len() {
            model.distance_scale[i] /= 1.0 + values.wheel("scale", i, "");
        }
    }

    fn drive(&self, values: &Values, model: &mut DriveModel) {
        for i in 0..model.wheels.len() {
            model.axes[i].encoder_scale /= 1.0 + values.wheel("scale", i, "");
        }
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("turn the wheel by hand ten times and read the counter", 2.0))
    }
}
