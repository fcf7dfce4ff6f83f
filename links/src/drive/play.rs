//! The play of a gear by which a search for it begins.
//!
//! What a wheel does in its gear's play is no straight line of how much that is: a little of it says nothing of more. So the
//! derivative is taken at the play that leaves least.

use super::{DriveLink, DriveModel, DriveResiduals};
use crate::effect::{Effect, Form, Sizes, Values};

/// From one play that is tried to the next: an estimate goes on from within a quarter of the true one.
const RATIO: f64 = 1.5;

impl DriveLink<'_> {
    /// The sizes of the logs with the play that leaves least beside a model, of an effect in this form; worked out once.
    pub fn sizes_with_play(&self, play: &dyn Effect, form: &Form, model: &dyn Fn() -> DriveModel) -> Sizes {
        let play_rad = *self.play.get_or_init(|| {
            let p = form.free.first()?;
            let squares = |play_rad: f64| {
                let mut model = model();
                let mut values = Values::default();
                values.set(&p.name, play_rad);
                play.drive(&values, &mut model);
                self.residuals(&model).map(|r| squares(&r))
            };
            let without = squares(0.0)?;
            // One wheel of several may have it.
            let falls = |with: Vec<f64>| without.iter().zip(with).map(|(a, b)| (a - b).max(0.0)).sum::<f64>();
            let tried = std::iter::successors(Some(p.material), |play| Some(play * RATIO));
            let of =
                tried.take_while(|play| *play < p.bounds[1]).filter_map(|play| Some((falls(squares(play)?), play)));
            of.max_by(|a, b| a.0.total_cmp(&b.0)).filter(|(fall, _)| *fall > 0.0).map(|(_, play)| play)
        });
        Sizes { play_rad, ..self.sizes }
    }
}

/// Sum of squares of the torques of each wheel that count.
fn squares(residuals: &DriveResiduals) -> Vec<f64> {
    let wheels = residuals.torque.first().map_or(0, Vec::len);
    let rows = || residuals.torque.iter().zip(&residuals.weights);
    (0..wheels).map(|i| rows().filter(|(_, w)| w[i] > 0.0).map(|(t, _)| t[i] * t[i]).sum()).collect()
}
