//! A bridge that swallows small duties and a dry friction do the same as long as no duty works against what turns.

use std::sync::Arc;

use super::ratios::{DEAD_BAND, FRICTIONS};
use super::study::Outcome;
use super::workflow::Workflow;
use links::drive::DriveLink;
use links::effect::Effect;
use links::pieces::Pieces;

impl<'a> Workflow<'a> {
    /// The dry friction that a dead band may be as well where no duty brakes, tied with it: of the two it is the likelier.
    /// Nothing where the band is not named, where duties brake, or where that is no friction.
    pub(super) fn unbraked(&mut self, outcome: &Outcome, here: &[Arc<dyn Effect>]) -> Option<(DriveLink<'a>, Outcome)> {
        let named = |outcome: &Outcome, name: &str| outcome.named.iter().any(|n| n.name == name);
        if !named(outcome, DEAD_BAND) || named(outcome, FRICTION) {
            return None;
        }
        let [most, surely] = self.thresholds.braked;
        let share = braked(self.searched().pieces, surely);
        if share > most {
            return None;
        }
        let others: Vec<_> = here.iter().filter(|e| e.name() != DEAD_BAND).cloned().collect();
        let (link, mut again) = self.drive_again(&others)?;
        if !named(&again, FRICTION) {
            return None;
        }
        again.sets.push([FRICTION, DEAD_BAND].map(str::to_owned).to_vec());
        again.ambiguous = true;
        self.findings.remarks.push(format!(
            "Duties hardly ever work against what turns ({:.1} % of the rows): a bridge that swallows small duties does what dry \
             friction does. Brake by the motor, and they differ.",
            100.0 * share
        ));
        Some((link, again))
    }
}

/// The friction that a dead band looks like.
const FRICTION: &str = FRICTIONS[0];

/// Share of the rows in which a wheel surely turned, by that speed, whose duties worked against that.
fn braked(pieces: &Pieces, surely: f64) -> f64 {
    let (mut turned, mut against) = (0_u64, 0_u64);
    for s in pieces.iter() {
        for (duty, speed) in s.duty.iter().zip(&s.speed) {
            for k in s.own.clone().filter(|k| speed[*k].abs() > surely * s.turning) {
                turned += 1;
                against += u64::from(duty[k] * speed[k] < 0.0);
            }
        }
    }
    against as f64 / turned.max(1) as f64
}
