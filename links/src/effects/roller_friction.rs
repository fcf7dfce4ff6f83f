//! `roller-friction`: rollers that resist being rolled sideways.

use runs::geometry::Wheel;
use runs::robot::Robot;

use crate::drive::{DriveModel, smooth_sign};
use crate::effect::{Effect, Form, Link, Parameter, Sizes, Values};

/// Rollers that resist being rolled sideways.
pub(super) struct RollerFriction;

impl Effect for RollerFriction {
    fn name(&self) -> &str {
        "roller-friction"
    }

    fn equation(&self) -> &str {
        "force -force_n sign(v) at each contact along the direction its rollers roll in"
    }

    fn reference(&self) -> &str {
        "Siciliano et al., Springer Handbook of Robotics, ch. 17"
    }

    fn link(&self) -> Link {
        Link::Drive
    }

    fn forms(&self, robot: &Robot) -> Vec<Form> {
        self.forms_in(robot, &Sizes::of(robot))
    }

    fn forms_in(&self, robot: &Robot, sizes: &Sizes) -> Vec<Form> {
        // Force at a contact, of the weight or of what the drive gives there.
        let w = sizes.weight_n / robot.wheel_count() as f64;
        let w = w.max(2.2 * sizes.drive_nm / robot.wheel_radius_m);
        vec![Form::whole(vec![Parameter::new("force_n", 0.01 * w, [-0.05 * w, w], 0.018 * w)])]
    }

    fn is_load(&self) -> bool {
        true
    }

    fn drive(&self, values: &Values, model: &mut DriveModel) {
        let force = values.get("force_n");
        let rows: Vec<[f64; 3]> = model.wheels.iter().map(Wheel::free_row).collect();
        model.loads.push(Box::new(move |now, loads| {
            for (row, v) in rows.iter().zip(now.sideways) {
                let f = -force * smooth_sign(*v, now.sliding());
                for (slot, r) in loads.body.iter_mut().zip(row) {
                    *slot += f * r;
                }
            }
        }));
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("pull the robot along a wheel axle with a spring scale", 5.0))
    }
}
