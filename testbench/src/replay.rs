//! A measured log through the FPGA logic: does the card compute what the robot's controller did?
//!
//! Logged counts become encoder edges, logged set points are committed before the tick they belong
//! to, and the FPGA's duty of every tick is compared with the logged one. Beside it runs the law of
//! `robot.toml` in floating point (`model::pi`), so that one can tell the FPGA's arithmetic from a
//! log that never followed the law.
//!
//! Row k of a log holds the duty that was computed at tick k from the count and set point of the
//! same row; before the first row integrators and counts are zero.

mod compare;
pub mod picture;
mod player;
mod preload;

pub use compare::{Deviation, WheelAgreement, duty_quantum, lsb};

use crate::closed_loop::LoopError;
use crate::fpga::{BitTrue, Fpga};
use driver::BoardError;
use model::pi::PiLaw;
use model::robot::Robot;
use model::run::Run;
use player::Player;

/// Which part of a run to replay.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Part {
    /// First tick.
    pub from: usize,
    /// Number of ticks; all that are left where it is `None`.
    pub ticks: Option<usize>,
}

/// A run that was replayed.
#[derive(Clone, Debug)]
pub struct Replayed {
    /// Name of the run.
    pub name: String,
    /// First tick.
    pub from: usize,
    /// Ticks that were replayed.
    pub ticks: usize,
    /// Half of this may lie between a logged duty and the one that was computed.
    pub quantum: f64,
    /// How well every wheel agrees; empty if the run was skipped.
    pub wheels: Vec<WheelAgreement>,
    /// Why the run was not replayed.
    pub skipped: Option<String>,
    /// Duties of the FPGA, `[wheel][tick]`.
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
    let mut replayed = Replayed {
        name: run.name.clone(),
        from: part.from,
        ticks: 0,
        quantum,
        wheels: Vec::new(),
        skipped: skip(robot, run, part.from),
        duty: Vec::new(),
    };
    if replayed.skipped.is_some() {
        return Ok(replayed);
    }
    let end = part.ticks.map_or(run.len(), |ticks| run.len().min(part.from + ticks));

    let integrals = if part.from == 0 {
        None
    } else {
        let mut ahead = Player::start(BitTrue::new(), robot, run, 0, None)?;
        for tick in 0..part.from {
            ahead.tick(tick)?;
        }
        Some(ahead.integrals()?)
    };
    let mut player = Player::start(fpga, robot, run, part.from, integrals)?;
    let mut law = Law::new(robot, run);
    for tick in 0..part.from {
        law.tick(tick);
    }

    let wheels = run.reference.len();
    replayed.wheels = vec![WheelAgreement::default(); wheels];
    replayed.duty = vec![Vec::new(); wheels];
    for tick in part.from..end {
        let duty = player.tick(tick)?;
        let exact = law.tick(tick);
        for wheel in 0..wheels {
            let logged = run.duty.get(wheel).map_or(f64::NAN, |column| column[tick]);
            replayed.wheels[wheel].add(tick, duty[wheel], exact[wheel], logged, quantum);
            replayed.duty[wheel].push(duty[wheel]);
        }
        if tick.is_multiple_of(64) {
            progress(tick - part.from);
        }
    }
    replayed.ticks = end - part.from;
    progress(replayed.ticks);
    if !player.armed() {
        return Err(BoardError::Arm { faults: player.faults(), names: "during the replay".to_owned() }.into());
    }
    Ok(replayed)
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
