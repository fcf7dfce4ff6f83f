//! Parts of a log without a gap, and the integrators with which they begin.
//!
//! A host that wakes up late misses ticks that the card computed all the same, and a log may begin in motion. The
//! duties after such a gap tell the integrators: one word to the last bit, some rounded ones between bounds.

use std::ops::Range;

use driver::Scale;
use fixed_kin::AXES;
use fixed_kin::format::{Duty, Format, Speed};
use fixed_kin::pi::PiState;
use fixed_kin::speed::by_difference;
use model::pi::PiLaw;
use runs::Run;
use runs::robot::Robot;
use runs::ticks::Ticks;

use super::{Law, player};

/// Rows that are replayed without a break.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Stretch {
    pub(super) rows: Range<usize>,
    /// Counts before the first of them.
    pub(super) counts: [i64; AXES],
    /// Words in the integrators before the first of them.
    pub(super) integrals: [i32; AXES],
}

/// Rounded duties that narrow an integrator down.
const WINDOW: usize = 200;
/// A duty that a cleared loop does not begin with, however its gains are rounded.
const IN_MOTION: f64 = 0.01;

/// Bounds of an integrator that are close enough, in quanta of the log.
const SHARP: f64 = 0.2;

/// Words in the integrators, and how wide the bounds are between which the worst of them lies.
struct Told {
    integrals: [i32; AXES],
    width: f64,
}

/// A log, as far as it tells integrators.
pub(super) struct Teller<'a> {
    run: &'a Run,
    ticks: Ticks<'a>,
    scale: &'a Scale,
    law: PiLaw,
    speed_per_count: f64,
    quantum: f64,
}

impl<'a> Teller<'a> {
    pub(super) fn new(robot: &Robot, run: &'a Run, scale: &'a Scale, quantum: f64) -> Self {
        let law = PiLaw { duty_quantum: 0.0, ..PiLaw::of(robot) };
        let speed_per_count = robot.control_rate_hz / robot.counts_per_wheel_rad();
        Self { run, ticks: Ticks::new(robot, run), scale, law, speed_per_count, quantum }
    }

    /// Every stretch of the log, in order.
    pub(super) fn stretches(&self, robot: &Robot) -> Vec<Stretch> {
        let (wheels, rows) = (self.run.counts.len(), self.run.len());
        let is_break = |row: &usize| (0..wheels).any(|wheel| self.ticks.moved(wheel, *row).is_none());
        let mut breaks: Vec<usize> = (1..rows).filter(is_break).collect();
        let mut stretches = Vec::new();
        let mut begin = 0;
        if !self.begins_in_motion(robot) {
            let mut counts = [0; AXES];
            for (wheel, count) in counts.iter_mut().enumerate().take(wheels) {
                *count = player::count_before(robot, self.run, wheel);
            }
            let end = breaks.first().copied().unwrap_or(rows);
            stretches.push(Stretch { rows: 0..end, counts, integrals: [0; AXES] });
            begin = end;
        }
        breaks.push(rows);
        for end in breaks.into_iter().filter(|end| *end > begin).collect::<Vec<_>>() {
            while let Some(stretch) = self.after_gap(begin..end) {
                begin = stretch.rows.end;
                stretches.push(stretch);
            }
            begin = end;
        }
        stretches
    }

    /// Whether cleared loops would begin with other duties than the log does.
    fn begins_in_motion(&self, robot: &Robot) -> bool {
        let first = Law::new(robot, self.run).tick(0);
        let logged = |wheel: usize| self.run.duty.get(wheel).map_or(f64::NAN, |duty| duty[0]);
        first.iter().enumerate().any(|(wheel, duty)| (duty - logged(wheel)).abs() > IN_MOTION + self.quantum)
    }

    /// The part of rows after a gap that can be replayed.
    fn after_gap(&self, rows: Range<usize>) -> Option<Stretch> {
        // Of the first row nobody knows the speed.
        let mut best: Option<(usize, Told)> = None;
        for row in rows.start + 1..rows.end {
            let Some(told) = self.integrals(row, rows.end) else { continue };
            let sharp = told.width < SHARP * self.quantum;
            if best.as_ref().is_none_or(|(_, best)| told.width < best.width) {
                best = Some((row, told));
            }
            if sharp {
                break;
            }
        }
        let (row, told) = best?;
        let mut counts = [0; AXES];
        for (count, column) in counts.iter_mut().zip(&self.run.counts) {
            *count = column[row];
        }
        let rows = row + 1..self.undecided(row + 1..rows.end, &told);
        (!rows.is_empty()).then_some(Stretch { rows, counts, integrals: told.integrals })
    }

    /// The integrators after a row, from the duties of that one and of what follows.
    fn integrals(&self, row: usize, end: usize) -> Option<Told> {
        let mut told = Told { integrals: [0; AXES], width: 0.0 };
        if self.run.duty.is_empty() {
            return Some(told);
        }
        for (wheel, integral) in told.integrals.iter_mut().enumerate().take(self.run.counts.len()) {
            if self.quantum < 2.0 * Format::DUTY.lsb() {
                *integral = self.by_word(wheel, row)?;
            } else {
                let [low, high] = self.by_bounds(wheel, row, end)?;
                *integral = Duty::from_num(0.5 * (low + high)).to_bits();
                told.width = told.width.max(high - low);
            }
        }
        Some(told)
    }

    /// The first row at which the bounds of the integrators leave open whether one is held at full drive. What
    /// follows may differ by much more than the bounds, until duties tell anew.
    fn undecided(&self, rows: Range<usize>, told: &Told) -> usize {
        let half = 0.5 * told.width;
        let mut integrals = told.integrals.map(|word| f64::from(Duty::from_bits(word)));
        let mut open = |row: &usize| {
            integrals.iter_mut().enumerate().take(self.run.counts.len()).any(|(wheel, integral)| {
                let speed = self.ticks.moved(wheel, *row).unwrap_or(0) as f64 * self.speed_per_count;
                let error = self.reference(wheel, *row).unwrap_or(0.0) - speed;
                let unlimited = (self.law.kp + self.law.ki / self.law.rate_hz) * error + *integral;
                self.law.step(integral, error, 0.0);
                (unlimited.abs() - 1.0).abs() < half
            })
        };
        rows.clone().find(|row| open(row)).unwrap_or(rows.end)
    }

    fn by_word(&self, wheel: usize, row: usize) -> Option<i32> {
        let gains = &self.scale.configuration().gains[wheel];
        let reference = self.scale.speed_word(self.reference(wheel, row)?);
        let counts = self.ticks.moved(wheel, row)?;
        let speed: Speed = by_difference(i32::from(counts as i16), self.scale.tick_period);
        let duty = self.run.duty[wheel][row] / Format::DUTY.lsb();
        let duty = duty.is_finite().then(|| Duty::from_bits(duty.round() as i32))?;
        Some(PiState::after(gains, reference, speed, duty)?.integral.to_bits())
    }

    /// Every unlimited duty says where the integrator was, but for its rounding.
    fn by_bounds(&self, wheel: usize, row: usize, end: usize) -> Option<[f64; 2]> {
        let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
        let mut since = 0.0;
        for k in row..end.min(row + WINDOW) {
            let speed = self.ticks.moved(wheel, k)? as f64 * self.speed_per_count;
            let Some(reference) = self.reference(wheel, k) else { break };
            let (error, duty) = (reference - speed, self.run.duty[wheel][k]);
            let more = self.law.ki * error / self.law.rate_hz;
            if k > row {
                since += more;
            }
            if duty.is_nan() {
                continue;
            }
            // At the limit, or so near that the integrator may have been held.
            if duty.abs() + more.abs() + self.quantum >= 1.0 {
                break;
            }
            let middle = duty - self.law.kp * error - since;
            let bounds = (low.max(middle - 0.5 * self.quantum), high.min(middle + 0.5 * self.quantum));
            if bounds.0 > bounds.1 {
                break;
            }
            (low, high) = bounds;
        }
        (low.is_finite() && high.is_finite()).then_some([low, high])
    }

    /// The set point in force at a row.
    fn reference(&self, wheel: usize, row: usize) -> Option<f64> {
        let column = &self.run.reference[wheel];
        column[..=row].iter().rev().copied().find(|reference| !reference.is_nan())
    }
}
