//! A measured log through the FPGA logic: does the card compute what the robot's controller did?
//!
//! Logged counts become encoder edges, logged set points are committed before the tick they belong
//! to, and the FPGA's duty of every tick is compared with the logged one. Beside it runs the law of
//! `robot.toml` in floating point (`model::pi`), so that one can tell the FPGA's arithmetic from a
//! log that never followed the law.
//!
//! Row k of a log holds the duty that was computed at tick k from the count and set point of the
//! same row; before the first row integrators and counts are zero, unless the first duties say otherwise.
//! After rows that the log lacks, the duties tell where the integrators were (`stretches`).

mod compare;
pub mod picture;
mod player;
mod preload;
mod stretches;

pub use compare::{Deviation, WheelAgreement, duty_quantum, lsb};

use crate::closed_loop::LoopError;
use crate::fpga::{BitTrue, Fpga};
use driver::{BoardError, Standing};
use fixed_kin::AXES;
use fixed_kin::format::Duty;
use model::pi::PiLaw;
use player::Player;
use runs::Run;
use runs::robot::Robot;
use runs::ticks::{Gaps, Ticks};
use stretches::{Stretch, Teller};

/// Which part of a run to replay.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Part {
    /// First tick.
    pub from: usize,
    /// Number of ticks; all that are left where it is `None`.
    pub ticks: Option<usize>,
}

/// A run that was replayed.
#[derive(Clone, Debug, Default)]
pub struct Replayed {
    /// Name of the run.
    pub name: String,
    /// First tick.
    pub from: usize,
    /// Rows of the part, replayed or not.
    pub ticks: usize,
    /// What the log lacks.
    pub gaps: Gaps,
    /// Rows after gaps that only tell the integrators.
    pub telling: usize,
    /// Rows at which all outputs were off although the loops say otherwise.
    pub off: usize,
    /// Half of this may lie between a logged duty and the one that was computed.
    pub quantum: f64,
    /// How well every wheel agrees; empty if the run was skipped.
    pub wheels: Vec<WheelAgreement>,
    /// Why the run was not replayed.
    pub skipped: Option<String>,
    /// Duties of the FPGA, `[wheel][row]`; NaN where a row was not replayed.
    pub duty: Vec<Vec<f64>>,
}

/// Replays a part of a run; `progress` hears the number of ticks done every now and then.
///
/// A part that does not start at tick 0 starts with the integrators that the bit-true model has
/// there, put into the FPGA through its registers.
///
/// # Errors
/// [`LoopError`] where the robot does not fit the card, or the FPGA fails.
pub fn replay<F: Fpga>(
    fpga: F,
    robot: &Robot,
    run: &Run,
    part: Part,
    mut progress: impl FnMut(usize),
) -> Result<Replayed, LoopError> {
    let quantum = duty_quantum(robot, run);
    let mut replayed = Replayed { name: run.name.clone(), from: part.from, quantum, ..Replayed::default() };
    replayed.skipped = skip(robot, run, part.from);
    if replayed.skipped.is_some() {
        return Ok(replayed);
    }
    let end = part.ticks.map_or(run.len(), |ticks| run.len().min(part.from + ticks));
    let wheels = run.reference.len();
    replayed.ticks = end - part.from;
    replayed.gaps = Ticks::new(robot, run).gaps();
    replayed.wheels = vec![WheelAgreement::default(); wheels];
    replayed.duty = vec![vec![f64::NAN; replayed.ticks]; wheels];

    let scale = player::scale(robot)?;
    let stretches = Teller::new(robot, run, &scale, quantum).stretches(robot);
    let mut pair = Pair { player: Player::start(fpga, robot, run)?, law: Law::new(robot, run), quantum, off: 0 };
    let mut seen = 0;
    for stretch in stretches.iter().filter(|s| s.rows.start < end && s.rows.end > part.from) {
        let first = stretch.rows.start.max(part.from);
        pair.resume(stretch)?;
        if first > stretch.rows.start {
            pair.skip_to(first, robot, stretch)?;
        }
        for row in first..stretch.rows.end.min(end) {
            let Some([duty, exact]) = pair.tick(row)? else { continue };
            for wheel in 0..wheels {
                let logged = run.duty.get(wheel).map_or(f64::NAN, |column| column[row]);
                replayed.wheels[wheel].add(row, duty[wheel], exact[wheel], logged, quantum);
                replayed.duty[wheel][row - part.from] = duty[wheel];
            }
            if row.is_multiple_of(64) {
                progress(row - part.from);
            }
        }
        seen += stretch.rows.end.min(end) - first;
    }
    (replayed.telling, replayed.off) = (replayed.ticks - seen, pair.off);
    progress(replayed.ticks);
    if seen > 0 && !pair.player.armed() {
        return Err(BoardError::Arm(Standing { faults: pair.player.faults(), ..Standing::default() }).into());
    }
    Ok(replayed)
}

/// The FPGA and the law, side by side.
struct Pair<'a, F> {
    player: Player<'a, F>,
    law: Law<'a>,
    quantum: f64,
    off: usize,
}

impl<F: Fpga> Pair<'_, F> {
    fn resume(&mut self, stretch: &Stretch) -> Result<(), LoopError> {
        self.law.resume(&stretch.counts, &stretch.integrals);
        self.player.resume(&stretch.counts, &stretch.integrals)
    }

    /// Leaves out the first rows of a stretch, which the bit-true model goes through instead.
    fn skip_to(&mut self, row: usize, robot: &Robot, stretch: &Stretch) -> Result<(), LoopError> {
        let run = self.law.run;
        let player = Player::start(BitTrue::new(), robot, run)?;
        let mut ahead = Pair { player, law: Law::new(robot, run), quantum: self.quantum, off: 0 };
        ahead.resume(stretch)?;
        for row in stretch.rows.start..row {
            ahead.tick(row)?;
        }
        self.player.resume(&counts_at(run, row - 1), &ahead.player.integrals()?)?;
        self.law = ahead.law;
        Ok(())
    }

    /// Duties of both; nothing where all outputs were off, which clears the loops.
    fn tick(&mut self, row: usize) -> Result<Option<[Vec<f64>; 2]>, LoopError> {
        let (duty, exact) = (self.player.tick(row)?, self.law.tick(row));
        let run = self.law.run;
        let zero = |columns: &[Vec<f64>]| !columns.is_empty() && columns.iter().all(|column| column[row] == 0.0);
        if zero(&run.duty) && zero(&run.reference) && duty.iter().any(|duty| duty.abs() > self.quantum) {
            self.off += 1;
            let counts = counts_at(run, row);
            self.law.resume(&counts, &[0; AXES]);
            self.player.resume(&counts, &[0; AXES])?;
            return Ok(None);
        }
        Ok(Some([duty.to_vec(), exact]))
    }
}

fn counts_at(run: &Run, row: usize) -> [i64; AXES] {
    let mut counts = [0; AXES];
    for (count, column) in counts.iter_mut().zip(&run.counts) {
        *count = column[row];
    }
    counts
}

/// What a run lacks.
fn skip(robot: &Robot, run: &Run, from: usize) -> Option<String> {
    if robot.pi.registers.iter().any(|(name, word)| name == "count_and_time" && *word != 0) {
        let what = "its speeds were measured by count and time, and a log has no times of edges";
        return Some(format!("{what}; racbot gap compares it word for word from the measured speeds"));
    }
    if run.reference.is_empty() {
        return Some("no set points (ref_1..) in the log".to_owned());
    }
    if run.counts.is_empty() {
        return Some("no encoder counts (enc_1..) in the log".to_owned());
    }
    if run.count_gaps.iter().any(|gaps| 2 * gaps.len() > run.len()) {
        return Some("its counts were sampled less often than its loops ran".to_owned());
    }
    (from >= run.len()).then(|| format!("only {} ticks, none after tick {from}", run.len()))
}

/// The law in floating point, over the same inputs.
struct Law<'a> {
    run: &'a Run,
    law: PiLaw,
    speed_per_count: f64,
    wheels: Vec<LawWheel>,
}

struct LawWheel {
    integral: f64,
    count: i64,
    reference: f64,
}

impl<'a> Law<'a> {
    fn new(robot: &Robot, run: &'a Run) -> Self {
        let wheel = |i: usize| LawWheel { integral: 0.0, count: player::count_before(robot, run, i), reference: 0.0 };
        Self {
            run,
            law: PiLaw { duty_quantum: 0.0, ..PiLaw::of(robot) },
            speed_per_count: robot.control_rate_hz / robot.counts_per_wheel_rad(),
            wheels: (0..run.reference.len()).map(wheel).collect(),
        }
    }

    /// Goes on after rows that stand at these counts, with these words in the integrators.
    fn resume(&mut self, counts: &[i64; AXES], integrals: &[i32; AXES]) {
        for ((wheel, count), word) in self.wheels.iter_mut().zip(counts).zip(integrals) {
            (wheel.count, wheel.integral) = (*count, Duty::from_bits(*word).into());
        }
    }

    fn tick(&mut self, tick: usize) -> Vec<f64> {
        let step = |(i, wheel): (usize, &mut LawWheel)| {
            let (reference, count) = (self.run.reference[i][tick], self.run.counts[i][tick]);
            if !reference.is_nan() {
                wheel.reference = reference;
            }
            let speed = (count - wheel.count) as f64 * self.speed_per_count;
            wheel.count = count;
            self.law.step(&mut wheel.integral, wheel.reference, speed)
        };
        self.wheels.iter_mut().enumerate().map(step).collect()
    }
}

#[cfg(test)]
mod tests;
