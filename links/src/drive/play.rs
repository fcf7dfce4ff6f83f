//! The play of a gear by which a search for it begins.
//!
//! What a wheel does in its gear's play is no straight line of how much that is: a little of it says nothing of more. So the
//! derivative is taken at the play that leaves least.

use super::{DriveLink, DriveModel, DriveResiduals};
use crate::effect::{Effect, Form, Play, Sizes, Values};

/// From one play that is tried to the next: an estimate goes on from within a quarter of the true one.
pub(crate) const RATIO: f64 = 1.5;
/// Dry friction of the wheel beyond the play, Nm: a part of what there is.
pub(crate) const LOAD_FRICTION: &str = "load_friction_nm";
/// Times that a play must be crossed: once there and back is a start and a stop, and of one step of a coarse encoder that
/// flickers a wheel that coasts within 2.4 turns of its motor left less.
const CROSSINGS: usize = 4;
/// Shares of a model's dry friction that are tried on the wheel's side of the play.
const HELD: [f64; 5] = [0.0, 0.1, 0.25, 0.5, 1.0];
/// Share of the squared gap that a play must close to be looked for: less any play closes by chance.
const CLOSES: f64 = 0.02;

impl DriveLink<'_> {
    /// The sizes of the logs with the play that leaves least beside a model, of an effect in this form; worked out once.
    pub fn sizes_with_play(&self, play: &dyn Effect, form: &Form, model: &dyn Fn() -> DriveModel) -> Sizes {
        let found = *self.play.get_or_init(|| {
            let p = form.free.first()?;
            let without = squares(&self.residuals(&model())?);
            // One wheel of several may have it; what single counts make, a wheel that coasts takes away as well.
            let counted = super::of_a_count(self).powi(2) * self.test_functions.len() as f64;
            let falls = |with: Vec<f64>| {
                let more = without.iter().zip(with).filter(|(a, _)| **a > counted);
                more.map(|(a, b)| (a - b).max(0.0)).sum::<f64>()
            };
            let of = |found: Play| {
                let mut model = model();
                let mut values = Values::default();
                values.set(&p.name, found.rad);
                values.set(LOAD_FRICTION, found.load_friction_nm);
                model.add(play, &values, form);
                if self.crossings(&model) < CROSSINGS {
                    return None;
                }
                Some((falls(squares(&self.residuals(&model)?)), found))
            };
            let friction = self.standing_friction(&model());
            // Without friction all shares are one.
            let shares = if friction > 0.0 { &HELD[..] } else { &HELD[..1] };
            let tried = std::iter::successors(Some(p.material), |play| Some(play * RATIO));
            let tried = tried.take_while(|play| *play < p.bounds[1]);
            let tried = tried.flat_map(|rad| {
                shares.iter().map(move |share| Play { rad, load_friction_nm: share * friction, friction_nm: friction })
            });
            let best = tried.filter_map(of).max_by(|a, b| a.0.total_cmp(&b.0));
            let least = CLOSES * without.iter().sum::<f64>();
            Some(
                best.filter(|(fall, _)| *fall > least)
                    .map_or(Play { rad: 0.0, load_friction_nm: 0.0, friction_nm: friction }, |(_, play)| play),
            )
        });
        Sizes { play: found, ..self.sizes }
    }

    /// The next search for play is worked out anew.
    pub fn forget_play(&mut self) {
        self.play.take();
    }

    /// The most that friction may hold a wheel with, Nm.
    fn standing_friction(&self, model: &DriveModel) -> f64 {
        let Some(first) = self.test_functions.first() else { return 0.0 };
        model.standing_friction(&self.pieces.get(first.segment)).into_iter().fold(0.0, f64::max)
    }

    /// How often the rotor that does so most goes from one flank of the last play of a model to the other.
    fn crossings(&self, model: &DriveModel) -> usize {
        let Some((_, ahead)) = model.offsets.last() else { return 0 };
        let mut crossed = vec![0; model.axes.len()];
        for segment in self.pieces.iter() {
            for (crossed, ahead) in crossed.iter_mut().zip(ahead(model, &segment)) {
                let half = ahead.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
                let mut flanks: Vec<bool> = ahead.iter().filter(|x| x.abs() == half).map(|x| *x > 0.0).collect();
                flanks.dedup();
                *crossed += flanks.len().saturating_sub(1);
            }
        }
        crossed.into_iter().max().unwrap_or(0)
    }
}

/// Sum of squares of the torques of each wheel that count.
fn squares(residuals: &DriveResiduals) -> Vec<f64> {
    let wheels = residuals.torque.first().map_or(0, Vec::len);
    let rows = || residuals.torque.iter().zip(&residuals.weights);
    (0..wheels).map(|i| rows().filter(|(_, w)| w[i] > 0.0).map(|(t, _)| t[i] * t[i]).sum()).collect()
}
