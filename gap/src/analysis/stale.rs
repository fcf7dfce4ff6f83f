//! Effects of a robot's file that its logs contradict: of a motor that was changed since, or of another robot.

use super::gaps;
use super::measure::{Data, left_on_drive};
use super::study::rms;
use crate::problem::Problem;
use crate::state::State;
use links::effect::Link;

/// An effect of the file beside which its link is further from the logs than without it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Stale {
    pub(super) name: String,
    pub(super) link: Link,
    /// Noise floors left with it and without.
    pub(super) left: [f64; 2],
    /// What is named beside it.
    pub(super) names: Vec<String>,
}

impl Stale {
    /// What is said of it, if it has a name again or not.
    pub(super) fn said(&self, anew: bool) -> String {
        let ([with, without], name, link) = (self.left, &self.name, self.link.name());
        let beside = if self.names.is_empty() { String::new() } else { format!(" and {}", self.names.join(", ")) };
        let left = format!("{with:.1} noise floors are left on the {link} link with it{beside}, {without:.1} without");
        if anew {
            format!(
                "{name} as the file has it does not fit these logs ({left}): it was looked for anew, and what is named stands in its place."
            )
        } else {
            format!("{name}, which the file has, is not in these logs: {left}")
        }
    }
}

/// Takes what the logs contradict out of a file's state, the worst first. Beside a size that is wrong the search could only name
/// what undoes it: of dry friction that is not there a bridge that gives more than its duties.
pub(super) fn taken_out(data: &Data, filed: &mut State) -> Vec<Stale> {
    let mut out = Vec::new();
    loop {
        let worst = (0..filed.active.len())
            .filter_map(|at| {
                let mut without = filed.clone();
                let effect = without.active.remove(at).effect;
                let left = left(data, effect.link(), filed, &without)?;
                let stale = !effect.nuisance() && data.thresholds.decided(left[0], left[1]);
                stale.then(|| {
                    (at, Stale { name: effect.name().to_owned(), link: effect.link(), left, names: Vec::new() })
                })
            })
            .min_by(|(_, a), (_, b)| (a.left[1] / a.left[0]).total_cmp(&(b.left[1] / b.left[0])));
        let Some((at, stale)) = worst else { return out };
        filed.active.remove(at);
        out.push(stale);
    }
}

/// Floors left on a link by two states, above what the second one leaves there.
pub(super) fn left(data: &Data, link: Link, with: &State, without: &State) -> Option<[f64; 2]> {
    match link {
        Link::Motion if data.has_camera() => {
            let seen = |state: &State| data.motion.floors() * rms(&Problem::Motion(data.motion), state);
            Some([seen(with), seen(without)])
        }
        Link::Drive => {
            let mut drive = data.drive(without, None)?;
            drive.link.noise = gaps::drive_floor(&drive.link, &drive.link.noise, data.thresholds);
            Some([with, without].map(|state| left_on_drive(&drive.link, state).0))
        }
        _ => None,
    }
}
