//! Whether the robot knows where it is well enough to drive on, and what it does while it does not.
//!
//! ```text
//!  drives ──── deviation above the limit, or pictures that contradict ───► brakes, turns round and looks
//!     ▲                                                                        │            │
//!     └────────────── deviation below half the limit, no contradiction ────────┘            └─► Lost, after TURNS
//! ```

use super::Fault;
use model::odometry::Estimate;
use runs::frames::{Pose, place_sd};
use std::f64::consts::TAU;

/// Rate of the turn while it looks round, rad/s: in the 10 ms that a picture under lamps is exposed it turns by 0.6°, three
/// pixels of a camera of 320 pixels over 70°.
const LOOKING_RAD_S: f64 = 1.0;
/// Turns until it gives up: one shows all there is to see from here, a quarter is for braking and what is out of focus.
const TURNS: f64 = 1.25;
/// Error of the way that no covariance knows of, as a share of the way since the last pose: wheels that are all skewed by 4°
/// lead astray by 7 %, and the filter takes them for a random walk.
const ASTRAY: f64 = 0.07;
/// Share of the limit below which it drives on: no stop and go about the limit.
const FOUND: f64 = 0.5;

/// The judge of one drive.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sure {
    limit_m: f64,
    before: Option<Pose>,
    /// Since the last pose from outside, m.
    way: f64,
    /// Since when the robot is lost, s.
    lost: Option<f64>,
    /// How often it was.
    times: u64,
}

impl Sure {
    /// Of a place that has to be known to this standard deviation, m.
    pub(super) fn to(limit_m: f64) -> Self {
        Self { limit_m, before: None, way: 0.0, lost: None, times: 0 }
    }

    /// How often the robot was lost so far.
    pub(super) fn times(&self) -> u64 {
        self.times
    }

    /// At `t` s, by what is believed, whether a pose came at this tick and whether what is seen contradicts the belief: the
    /// rate at which to look round instead of driving on, rad/s.
    ///
    /// # Errors
    /// [`Fault::Lost`] where looking round told no more.
    pub(super) fn judge(
        &mut self,
        t: f64,
        belief: &Estimate,
        posed: bool,
        contradicted: bool,
    ) -> Result<Option<f64>, Fault> {
        let moved = self.before.map_or(0.0, |p| (belief.pose.x - p.x).hypot(belief.pose.y - p.y));
        self.before = Some(belief.pose);
        self.way = if posed { 0.0 } else { self.way + moved };
        let sd = place_sd(&belief.covariance).hypot(ASTRAY * self.way);
        let least = if self.lost.is_some() { FOUND * self.limit_m } else { self.limit_m };
        // What is not finite is not known either.
        if sd <= least && !contradicted {
            self.lost = None;
            return Ok(None);
        }
        self.times += u64::from(self.lost.is_none());
        let since = *self.lost.get_or_insert(t);
        if t - since > TURNS * TAU / LOOKING_RAD_S {
            return Err(Fault::Lost { sd_m: sd, limit_m: self.limit_m });
        }
        Ok(Some(LOOKING_RAD_S))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn believed(x: f64, sd: f64) -> Estimate {
        Estimate::new(Pose::new(x, 0.0, 0.0), [sd, 0.01, 0.01])
    }

    #[test]
    fn it_stops_at_the_limit_and_goes_on_at_half_of_it() {
        let mut sure = Sure::to(0.15);
        let mut at = |t: f64, sd: f64| sure.judge(t, &believed(0.0, sd), true, false);
        assert_eq!(at(0.0, 0.14).unwrap(), None);
        assert_eq!(at(0.1, 0.16).unwrap(), Some(LOOKING_RAD_S));
        assert_eq!(at(0.2, 0.14).unwrap(), Some(LOOKING_RAD_S));
        assert_eq!(at(0.3, 0.07).unwrap(), None);
        // A turn and a quarter later it has seen all there is, each time anew.
        assert_eq!(at(1.0, f64::NAN).unwrap(), Some(LOOKING_RAD_S));
        assert_eq!(at(8.8, 0.2).unwrap(), Some(LOOKING_RAD_S));
        assert!(matches!(at(8.9, 0.2), Err(Fault::Lost { sd_m: 0.2, limit_m: 0.15 })));
    }

    #[test]
    fn the_way_without_a_pose_counts_and_so_does_a_contradiction() {
        let mut sure = Sure::to(0.15);
        let mut judged = |x: f64, posed, contradicted| sure.judge(x, &believed(x, 0.02), posed, contradicted);
        assert_eq!(judged(0.0, true, false).unwrap(), None);
        assert_eq!(judged(2.0, false, false).unwrap(), None);
        assert_eq!(judged(2.2, false, false).unwrap(), Some(LOOKING_RAD_S));
        assert_eq!(judged(2.2, true, false).unwrap(), None);
        assert_eq!(judged(2.2, true, true).unwrap(), Some(LOOKING_RAD_S));
        assert_eq!(judged(2.2, true, false).unwrap(), None);
    }
}
