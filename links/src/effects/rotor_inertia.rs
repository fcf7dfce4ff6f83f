//! `rotor-inertia`: rotors with another inertia than stated; on blocks all that turns, for an axis alone does not tell its
//! rotor from its load.

use runs::robot::{Robot, Support};

use crate::drive::DriveModel;
use crate::effect::{Effect, Form, Link, Parameter, Values};

/// Rotors with another inertia than stated.
pub(super) struct RotorInertia;

impl Effect for RotorInertia {
    fn name(&self) -> &str {
        "rotor-inertia"
    }

    fn equation(&self) -> &str {
        "rotor inertia times (1 + scale), and on blocks the load's with it: an axis alone does not tell them apart"
    }

    fn reference(&self) -> &str {
        "motor data sheet"
    }

    fn link(&self) -> Link {
        Link::Drive
    }

    fn forms(&self, robot: &Robot) -> Vec<Form> {
        // Material is what changes the inertia a wheel feels by as much as a material mass does.
        let model = DriveModel::new(robot);
        let own = model.inertia_of_scale(0);
        let material = 0.06 * model.felt_inertia() / own.max(f64::MIN_POSITIVE);
        // What is drawn, or copied with a wrong unit, may be a hundred times what turns on a bench.
        let least = if robot.support == Support::Blocks { -0.995 } else { -0.9 };
        vec![Form::whole(vec![Parameter::new("scale", (0.2 * material).max(0.02), [least, 200.0], material)])]
    }

    fn drive(&self, values: &Values, model: &mut DriveModel) {
        let scale = 1.0 + values.get("scale");
        let on_blocks = model.support == Support::Blocks;
        for a in &mut model.axes {
            a.rotor_inertia *= scale;
            a.load_inertia *= if on_blocks { scale } else { 1.0 };
        }
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("a step of duty with the wheels lifted", 2.0))
    }
}
