//! The model under study: the nominal robot and the effects added so far.

use std::sync::Arc;

use runs::robot::Robot;

use links::drive::{DriveLink, DriveModel};
use links::effect::{Effect, Form, Link, Values};
use links::motion::MotionModel;
use links::thresholds;

/// Wheels that slip by a law.
pub(crate) const SLIP: &str = "wheel-slip";

/// An effect with values.
#[derive(Clone)]
pub struct Active {
    /// Entry of the catalogue.
    pub effect: Arc<dyn Effect>,
    /// How it is parametrised.
    pub form: Form,
    /// Its values, fixed ones included.
    pub values: Values,
    /// Whether it is fitted but too small to be named.
    pub immaterial: bool,
    /// The link it is fitted on.
    pub link: Link,
    /// Whether it stood in the robot's file and is not fitted again.
    pub given: bool,
    /// Whether it is named for what it does together with others, however small it is alone.
    pub together: bool,
}

impl Active {
    /// An effect at its start: 0, or where it is tried first.
    pub fn new(effect: Arc<dyn Effect>, form: Form) -> Self {
        let mut values = Values(form.fixed.clone());
        for p in &form.free {
            values.set(&p.name, p.start.unwrap_or(0.0));
        }
        Self { link: effect.link(), effect, form, values, immaterial: false, given: false, together: false }
    }

    /// Values of the fitted parameters.
    pub fn parameters(&self) -> Vec<f64> {
        self.form.free.iter().map(|p| self.values.get(&p.name)).collect()
    }

    /// The same with one fitted parameter moved.
    pub fn moved(&self, parameter: usize, by: f64) -> Self {
        let mut out = self.clone();
        let name = &self.form.free[parameter].name;
        out.values.set(name, self.values.get(name) + by);
        out
    }

    /// Whether it is material, and so named or reported.
    pub fn worth(&self) -> bool {
        !self.given && (self.together || is_material(self, &self.parameters()))
    }

    /// Whether it is named: worth it, and an effect of the catalogue.
    pub fn is_named(&self) -> bool {
        self.worth() && !self.effect.probe()
    }

    /// Whether it is switched on from a start value instead of growing from 0.
    pub fn switched(&self) -> bool {
        self.form.free.iter().any(|p| p.start.is_some())
    }
}

/// The nominal robot and the effects added so far.
#[derive(Clone)]
pub struct State {
    /// The nominal robot.
    pub robot: Robot,
    /// Effects, in the order they were added.
    pub active: Vec<Active>,
}

impl State {
    /// The motion link of this state.
    pub fn motion(&self, extra: Option<&Active>) -> MotionModel {
        let mut model = MotionModel::new(&self.robot);
        for a in self.active.iter().chain(extra) {
            a.effect.motion(&a.values, &mut model);
            model.angles_are_of(a.effect.name(), &a.values);
        }
        model
    }

    /// Leaves of a drive what its wheels did while they rolled.
    pub fn mask_slip(&self, drive: &mut DriveLink) {
        drive.mask_slip(&self.motion(None), thresholds::ROLLING);
        // What an inertial sensor tells in place of wheels that slip is for those that surely do.
        if drive.pieces.iter().next().is_some_and(|s| s.felt.is_some()) {
            return;
        }
        let law = |a: &&Active| a.effect.name() == SLIP;
        let active: Vec<Active> = self.active.iter().filter(law).cloned().collect();
        if !active.is_empty() {
            let slip = Self { active, ..self.clone() };
            drive.mask_slip(&slip.motion(None), thresholds::HELD);
        }
    }

    /// The drive link of this state.
    pub fn drive(&self, extra: Option<&Active>) -> DriveModel {
        let mut model = DriveModel::new(&self.robot);
        for a in self.active.iter().chain(extra) {
            model.add(&*a.effect, &a.values, &a.form);
        }
        model
    }

    /// The same with the active effect `index` replaced.
    #[must_use]
    pub fn with(&self, index: usize, active: Active) -> Self {
        let mut out = self.clone();
        out.active[index] = active;
        out
    }

    /// Indices of the effects fitted on a link.
    pub fn fitted_on(&self, link: Link) -> Vec<usize> {
        (0..self.active.len()).filter(|i| !self.active[*i].given && self.active[*i].link == link).collect()
    }
}

/// Whether any parameter of an effect exceeds its materiality threshold.
pub fn is_material(active: &Active, values: &[f64]) -> bool {
    active.form.free.iter().zip(values).any(|(p, v)| p.is_material(*v))
}
