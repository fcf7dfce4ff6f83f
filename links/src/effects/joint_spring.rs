//! `joint-spring`: a spring on the shaft of an axis, such as one that returns or balances it.

use runs::robot::Robot;

use crate::drive::DriveModel;
use crate::effect::{Effect, Form, Link, Parameter, Sizes, Values, wheel_name};

/// A spring on the shaft of an axis. Within a radian or so a mass beside the shaft does the same.
pub(super) struct JointSpring;

/// How many radians from the spring's rest the counter's zero may be: an encoder of many turns counts from anywhere.
const PRELOADS: f64 = 100.0;

impl Effect for JointSpring {
    fn name(&self) -> &str {
        "joint-spring"
    }

    fn equation(&self) -> &str {
        "torque preload_i_nm - stiffness_i_nm_per_rad theta_i at the output shaft of an axis on blocks, theta_i its angle by \
         the log's counts, whose zero the preload holds"
    }

    fn reference(&self) -> &str {
        "Hooke's law"
    }

    fn link(&self) -> Link {
        Link::Drive
    }

    fn forms(&self, robot: &Robot) -> Vec<Form> {
        self.forms_in(robot, &Sizes::of(robot))
    }

    fn forms_in(&self, robot: &Robot, sizes: &Sizes) -> Vec<Form> {
        let (drive, reach) = (sizes.drive_nm, sizes.reach_rad.max(sizes.count_rad));
        // What the motor can just not wind as far as it went.
        let stiffest = sizes.carried_nm() / reach;
        Form::axes(robot, |i| {
            let stiffness = wheel_name("stiffness", i, "nm_per_rad");
            let preloads = [-PRELOADS * stiffest, PRELOADS * stiffest];
            [
                Parameter::new(stiffness, 0.01 * drive / reach, [0.0, stiffest], 0.03 * drive / reach),
                // Where it is slack is no size: without a stiffness there is no spring.
                Parameter::new(wheel_name("preload", i, "nm"), 0.01 * drive, preloads, f64::INFINITY),
            ]
        })
    }

    fn is_load(&self) -> bool {
        true
    }

    fn is_carried(&self) -> bool {
        true
    }

    fn drive(&self, values: &Values, model: &mut DriveModel) {
        let of = |i| [values.wheel("stiffness", i, "nm_per_rad"), values.wheel("preload", i, "nm")];
        let springs: Vec<[f64; 2]> = (0..model.wheels.len()).map(of).collect();
        model.loads.push(Box::new(move |now, loads| {
            for (i, [stiffness, preload]) in springs.iter().enumerate() {
                if *stiffness != 0.0 || *preload != 0.0 {
                    loads.carried[i] += preload - stiffness * now.segment.shaft_angle(i, now.tick);
                }
            }
        }));
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("turn the unpowered axis by a spring scale to two angles", 4.0))
    }
}
