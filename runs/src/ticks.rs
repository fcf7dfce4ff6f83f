//! Which rows of a log follow each other in the control loop's own time, and which do not.

use crate::Run;
use crate::robot::Robot;

/// Longest time between two neighbours, in ticks.
const NEIGHBOURS: f64 = 1.5;

/// The rows of a run as ticks of the loop that was logged.
#[derive(Debug, Clone, Copy)]
pub struct Ticks<'a> {
    run: &'a Run,
    tick_s: f64,
    /// Largest change of a wheel's movement from a tick to the next, counts.
    jerk: f64,
}

/// Rows that are missing from a log, and counters that began anew.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Gaps {
    /// Places at which rows are missing.
    pub pauses: usize,
    /// Ticks that the log lacks in them.
    pub missing: u64,
    /// Resets of a counter.
    pub resets: usize,
}

impl<'a> Ticks<'a> {
    /// The rows of a run of a robot.
    #[must_use]
    pub fn new(robot: &Robot, run: &'a Run) -> Self {
        Self::with_period(robot, run, run.tick_s())
    }

    /// The rows of a part of a log whose ticks are `tick_s` apart by the median.
    pub fn with_period(robot: &Robot, run: &'a Run, tick_s: Option<f64>) -> Self {
        let tick_s = tick_s.unwrap_or_else(|| robot.tick_s());
        // A tenth of full speed, from one tick to the next: no motor does that.
        let jerk = 16.0 + 0.1 * robot.no_load_wheel_speed(robot.supply_v) * robot.counts_per_wheel_rad() * tick_s;
        Self { run, tick_s, jerk }
    }

    /// Ticks from the row before to this one: 1 for neighbours, 0 for the first row.
    #[must_use]
    pub fn since(&self, row: usize) -> u64 {
        let t = &self.run.t;
        let Some(before) = row.checked_sub(1) else { return 0 };
        let step = (t[row] - t[before]) / self.tick_s;
        // A stamp that came late or early is made up for by its neighbour.
        let made_up = |span: Option<f64>| span.is_some_and(|s| s < (1.0 + NEIGHBOURS) * self.tick_s);
        let after = t.get(row + 1).map(|next| next - t[before]);
        let ahead = before.checked_sub(1).map(|last| t[row] - t[last]);
        if step < NEIGHBOURS || made_up(after) || made_up(ahead) { 1 } else { step.round() as u64 }
    }

    /// Counts of a wheel from the row before to this one; nothing where a tick is missing or not sampled between
    /// them, or the counter began anew.
    #[must_use]
    pub fn moved(&self, wheel: usize, row: usize) -> Option<i64> {
        if self.since(row) != 1 || self.is_reset(wheel, row) {
            return None;
        }
        self.step(wheel, row)
    }

    /// Counts from the row before to this one, where both have them: a camera may have rows of its own.
    fn step(&self, wheel: usize, row: usize) -> Option<i64> {
        let counts = &self.run.counts[wheel];
        let gaps = self.run.count_gaps.get(wheel).map_or(&[][..], Vec::as_slice);
        let sampled = |row: usize| gaps.is_empty() || gaps.binary_search(&row).is_err();
        (sampled(row) && sampled(row - 1)).then(|| counts[row].wrapping_sub(counts[row - 1]))
    }

    /// Whether a counter jumps to near zero, further than a wheel's speed can change.
    fn is_reset(&self, wheel: usize, row: usize) -> bool {
        let counts = &self.run.counts[wheel];
        if row == 0 || counts[row].unsigned_abs() as f64 > self.jerk || self.since(row) != 1 {
            return false;
        }
        let Some(step) = self.step(wheel, row) else { return false };
        let beside = [(row > 1).then(|| row - 1), (row + 1 < counts.len()).then_some(row + 1)];
        let mut beside = beside.into_iter().flatten().filter_map(|r| self.step(wheel, r)).peekable();
        let far = |counts: i64| counts.unsigned_abs() as f64 > self.jerk;
        far(step) && beside.peek().is_some() && beside.all(|b| far(step.wrapping_sub(b)))
    }

    /// What the whole run lacks.
    #[must_use]
    pub fn gaps(&self) -> Gaps {
        self.gaps_in(0..self.run.len())
    }

    /// What these rows lack.
    pub fn gaps_in(&self, rows: std::ops::Range<usize>) -> Gaps {
        let mut gaps = Gaps::default();
        for row in rows.start.max(1)..rows.end {
            let since = self.since(row);
            gaps.pauses += usize::from(since > 1);
            gaps.missing += since - 1;
            gaps.resets += (0..self.run.counts.len()).filter(|w| self.is_reset(*w, row)).count();
        }
        gaps
    }
}

impl std::ops::AddAssign for Gaps {
    fn add_assign(&mut self, other: Self) {
        self.pauses += other.pauses;
        self.missing += other.missing;
        self.resets += other.resets;
    }
}

impl Gaps {
    /// In words; nothing for a log without any.
    #[must_use]
    pub fn words(&self) -> Option<String> {
        let pauses = match self.pauses {
            0 => None,
            1 => Some(format!("the log has a gap ({} ticks missing)", self.missing)),
            n => Some(format!("the logs have {n} gaps ({} ticks missing)", self.missing)),
        };
        let resets = (self.resets > 0).then(|| format!("{} counters began anew", self.resets));
        let parts: Vec<String> = pauses.into_iter().chain(resets).collect();
        (!parts.is_empty()).then(|| parts.join(" and "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(t: &[f64], counts: &[i64]) -> Run {
        Run { t: t.to_vec(), counts: vec![counts.to_vec()], count_gaps: vec![Vec::new()], ..Run::default() }
    }

    #[test]
    fn late_stamps_are_no_gaps_and_missing_ticks_are() {
        let robot = Robot::racbot();
        let stamps = [0.0, 0.001, 0.0026, 0.003, 0.004, 0.0044, 0.006, 0.007, 0.010, 0.011, 0.012, 0.013];
        let run = run(&stamps, &[0; 12]);
        let ticks = Ticks::new(&robot, &run);
        let since: Vec<u64> = (0..12).map(|row| ticks.since(row)).collect();
        assert_eq!(since, [0, 1, 1, 1, 1, 1, 1, 1, 3, 1, 1, 1]);
        let gaps = ticks.gaps();
        assert_eq!((gaps.pauses, gaps.missing, gaps.resets), (1, 2, 0));
        assert_eq!(gaps.words().unwrap(), "the log has a gap (2 ticks missing)");
        assert_eq!((ticks.moved(0, 8), ticks.moved(0, 9)), (None, Some(0)));
    }

    #[test]
    fn a_counter_that_begins_anew_is_no_motion() {
        let t: Vec<f64> = (0..6).map(|k| f64::from(k) * 1e-3).collect();
        let robot = Robot::racbot();
        let reset = run(&t, &[400, 430, 460, 8, 38, 68]);
        let ticks = Ticks::new(&robot, &reset);
        assert_eq!(
            (0..6).map(|k| ticks.moved(0, k)).collect::<Vec<_>>(),
            [None, Some(30), Some(30), None, Some(30), Some(30)]
        );
        assert_eq!(ticks.gaps().words().unwrap(), "1 counters began anew");
        // Through zero at full speed is motion, also where the camera has a row of its own, in which the last count stands.
        let mut through = run(&t, &[600, 400, 200, 0, -200, -400]);
        assert_eq!(Ticks::new(&robot, &through).moved(0, 3), Some(-200));
        through.counts[0][2] = 400;
        through.count_gaps[0].push(2);
        let ticks = Ticks::new(&robot, &through);
        assert_eq!((ticks.gaps().resets, ticks.moved(0, 3), ticks.moved(0, 4)), (0, None, Some(-200)));
    }
}
