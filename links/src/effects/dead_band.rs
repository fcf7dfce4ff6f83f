//! `dead-band`: a bridge that does nothing at small duties.

use runs::robot::Robot;

use crate::drive::DriveModel;
use crate::effect::{Effect, Form, Link, Parameter, Values};

/// Whether duties above the band pass whole.
const PASSES: &str = "passes";
/// Share of the band over which such a bridge begins to pass, for derivatives.
const EDGE: f64 = 0.05;

/// A bridge that does nothing at small duties.
pub(super) struct DeadBand;

impl Effect for DeadBand {
    fn name(&self) -> &str {
        "dead-band"
    }

    fn equation(&self) -> &str {
        "duty u becomes u - duty sign(u), or u whole (passes), and 0 for |u| below duty, of every bridge or of one"
    }

    fn reference(&self) -> &str {
        "dead time of H-bridges (less what is swallowed); firmware that ignores small duties (passes whole)"
    }

    fn link(&self) -> Link {
        Link::Drive
    }

    fn before_current(&self) -> bool {
        true
    }

    fn forms(&self, robot: &Robot) -> Vec<Form> {
        let duty = |name: &str, bounds| Parameter::new(name, 0.01, bounds, 0.03);
        let whole = |at| Form::whole(vec![duty("duty", [0.005, 0.5]).from(at)]).fixing(PASSES, 1.0);
        let swallowed = Form::all_or_one(robot, "duty", |name| duty(&name, [-0.02, 0.5]));
        swallowed.into_iter().chain([0.04, 0.08, 0.16].map(whole)).collect()
    }

    fn may_be_little(&self, form: &Form) -> bool {
        // What all bridges of a kind have a little of, one has no more of without a cause.
        form.free.iter().all(|p| p.name == "duty")
    }

    fn drive(&self, values: &Values, model: &mut DriveModel) {
        let bands: Vec<f64> = (0..model.axes.len()).map(|i| values.wheel("duty", i, "")).collect();
        let passes = values.get(PASSES) != 0.0;
        model.duty_maps.push(Box::new(move |wheel, u| {
            let band = bands.get(wheel).copied().unwrap_or(0.0);
            if passes {
                let edge = EDGE * band.abs().max(1e-6);
                0.5 * u * (1.0 + ((u.abs() - band) / edge).tanh())
            } else if band >= 0.0 {
                u.signum() * (u.abs() - band).max(0.0)
            } else {
                u - band * (u / 0.02).tanh()
            }
        }));
    }

    fn law_uncertainty(&self) -> f64 {
        // Windings smooth what the bridge swallows while the duty dithers.
        0.03
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("a duty staircase with the wheels lifted", 2.0))
    }
}
