//! Does a log fit the robot it is said to come from?

use std::path::Path;

use super::{CountSource, Run, RunError};
use crate::robot::{Robot, Support, WHEELS};

/// How far beyond the no-load speed a count may jump. Generous: a motor pushed from outside, a
/// supply above nominal or a coarse time stamp are no errors; a lost or swapped counter is.
const SPEED_FACTOR: f64 = 3.0;
/// Ticks for which a counter may have been read late, or not at all: one read every second tick, a row of which is lost.
const HELD_TICKS: f64 = 4.0;
/// Counts allowed beside: edges that bounce around a tick.
const COUNT_MARGIN: f64 = 16.0;

/// Rows on each side of a jump among which those that arrived together are sought: a transmission that stood still for a
/// fifth of a second at 50 Hz. Reasoned; a real robot's bag had four at once.
const BUNCH: usize = 10;

/// How many rows about a jump have times of arrival: over more of them the wheel turned no faster than it can.
fn bunched(t: &[f64], counts: &[i64], now: usize, per_second: f64) -> Option<usize> {
    let rows = |n: usize| (now.saturating_sub(n), (now + n).min(counts.len() - 1));
    let usual = (t[counts.len() - 1] - t[0]) / (counts.len() - 1) as f64;
    (2..=BUNCH).map(rows).find_map(|(a, b)| {
        // Steps about a counter that leapt are as usual.
        let close = (a..b).filter(|i| t[i + 1] - t[*i] < CLOSE * usual).count();
        let late = (a..b).any(|i| t[i + 1] - t[i] > LATE * usual);
        let fits = counts[b].abs_diff(counts[a]) as f64 <= per_second * (t[b] - t[a]) / SPEED_FACTOR + COUNT_MARGIN;
        (close > 0 && late && fits).then_some(close + 1)
    })
}

/// How long a logger stood still, s, between the counts of the row before a jump and its time: the jump and that wait together are
/// no faster than the wheel can turn.
fn stalled(t: &[f64], counts: &[i64], now: usize, per_second: f64) -> Option<f64> {
    let [a, b] = [now.checked_sub(2)?, now - 1];
    let usual = (t[counts.len() - 1] - t[0]) / (counts.len() - 1) as f64;
    let fits = counts[now].abs_diff(counts[a]) as f64 <= per_second * (t[now] - t[a]) / SPEED_FACTOR + COUNT_MARGIN;
    let (waited, next) = (t[b] - t[a], t[now] - t[b]);
    // Rows that came at once waited for each other.
    (waited > LATE * usual && next >= CLOSE * usual && fits).then_some(waited)
}

/// Steps of time that are those of rows that arrived together, and of the wait before them, in usual ones.
const CLOSE: f64 = 0.3;
const LATE: f64 = 2.0;

impl Run {
    /// Checks the number of wheels, and that no count jumps by more than its wheel can turn.
    ///
    /// # Errors
    /// [`RunError`] about `path`, with the line of the jump (for a log of one line a tick).
    pub fn check(&self, robot: &Robot, path: &Path) -> Result<(), RunError> {
        self.check_from(0, robot, path)
    }

    /// The same of a part of a log that begins with its tick `first`.
    pub(super) fn check_from(&self, first: usize, robot: &Robot, path: &Path) -> Result<(), RunError> {
        let (logged, described) = (self.wheel_count(), robot.wheel_count());
        if self.source.counts == CountSource::Odometry || !robot.lacks(&[WHEELS]).is_empty() {
            return Ok(());
        }
        if logged != 0 && logged != described {
            let what = format!("speaks of {logged} wheels, but the robot has {described}");
            let hint = if robot.support == Support::Blocks && described == 1 {
                "make a data set of each axis: `racbot init --axis --log LOG`"
            } else {
                "use the robot.toml of the robot that drove; axes alone need support = \"blocks\""
            };
            return Err(RunError::new(path, what, hint));
        }
        if self.source.counts != CountSource::Encoders {
            return Ok(());
        }
        let logged_supply = self.supply_v.iter().flatten().copied().filter(|v| v.is_finite());
        let supply = logged_supply.fold(robot.supply_v, f64::max);
        let per_second = SPEED_FACTOR * robot.no_load_wheel_speed(supply) * robot.counts_per_wheel_rad();
        let tick = robot.tick_s();
        for (wheel, counts) in self.counts.iter().enumerate() {
            let gaps = self.count_gaps.get(wheel).map_or(&[][..], Vec::as_slice);
            let mut sampled = (0..counts.len()).filter(|tick| gaps.binary_search(tick).is_err());
            let Some(mut before) = sampled.next() else { continue };
            let mut moved = before;
            for now in sampled {
                // Stamps may jitter, so at least one nominal tick is granted; and a counter may repeat what it was.
                let since = self.t[now] - self.t[before];
                let held = (self.t[now] - self.t[moved]).min(HELD_TICKS * tick);
                let dt = since.max(held).max(tick);
                let jump = counts[now].abs_diff(counts[before]);
                let limit = per_second * dt + COUNT_MARGIN;
                if jump as f64 > limit {
                    let what = format!(
                        "jumps by {jump} counts in {:.3} ms, but the wheel can turn by {limit:.0} at most",
                        dt * 1e3
                    );
                    let bits = [16, 32].into_iter().find(|bits| (1_u64 << bits).abs_diff(jump) as f64 <= limit);
                    let rows = bunched(&self.t, counts, now, per_second);
                    let (what, hint) = match (rows, bits, stalled(&self.t, counts, now, per_second)) {
                        (Some(rows), ..) => (
                            format!("{what}; the {rows} rows about it come at once, and together they fit"),
                            "the times are those of arrival: take the time at which each row was measured, as a stamp of \
                             the robot's own"
                                .to_owned(),
                        ),
                        (None, None, Some(waited)) => (
                            format!(
                                "{what}; the line before came {:.0} ms after its own, and together they fit",
                                1e3 * waited
                            ),
                            "the logger stood still between the counts of that line and its time: leave the line out"
                                .to_owned(),
                        ),
                        (None, Some(bits), _) => (
                            what,
                            format!(
                                "a counter of {bits} bits began again: log cumulative counts; `racbot convert` counts on \
                                 with wraps = {}",
                                1_u64 << bits
                            ),
                        ),
                        (None, None, None) => (
                            what,
                            format!(
                                "look for a counter that was reset, wrapped or not read; log cumulative counts; if it turns \
                                 so fast, mend what says that {:.3} rad/s is its top speed: supply_v, torque_constant \
                                 (Nm/A), back_emf_constant (V s/rad), gear_ratio, or the counts of a turn: a decoder that \
                                 takes all edges makes four of each",
                                robot.no_load_wheel_speed(supply)
                            ),
                        ),
                    };
                    let error = RunError::new(path, what, hint).field(format!("enc_{}", wheel + 1));
                    return Err(RunError { line: u32::try_from(first + now + 2).ok(), ..error });
                }
                if jump > 0 {
                    moved = now;
                }
                before = now;
            }
        }
        Ok(())
    }
}
