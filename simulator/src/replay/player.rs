//! The rows of a log as the FPGA sees them: counts on its encoder lines, set points in its registers.

use super::preload::preload;
use crate::closed_loop::{LoopError, whole_tick_clock_hz};
use crate::fpga::Fpga;
use driver::{Board, Scale, Settings, Snapshot};
use fixed_kin::AXES;
use fixed_kin::control::SetPointMode;
use fixed_kin::format::Speed;
use fixed_kin::registers::INTEGRALS;
use fixed_kin::speed::SpeedMode;
use runs::Run;
use runs::robot::Robot;

/// A log on its way through an FPGA.
pub(super) struct Player<'a, F> {
    board: Board<F>,
    scale: Scale,
    run: &'a Run,
    /// Counts that the FPGA's counters show as zero.
    base: [i64; AXES],
    /// Where the encoders stand.
    positions: [f64; AXES],
    references: [Speed; AXES],
    last: Snapshot,
}

/// Where an encoder stands for a logged count: between this line and the next.
const BETWEEN_LINES: f64 = 0.5;

impl<'a, F: Fpga> Player<'a, F> {
    /// An armed card whose encoders and integrators are at zero.
    pub(super) fn start(fpga: F, robot: &Robot, run: &'a Run) -> Result<Self, LoopError> {
        let scale = scale(robot)?;
        let settings = Settings {
            speed_mode: SpeedMode::Difference,
            set_point_mode: SetPointMode::Wheels,
            watchdog_s: Settings::default().watchdog_s.max(5.0 * robot.tick_s()),
            ..Settings::default()
        };
        let mut board = Board::new(fpga);
        board.identify()?;
        board.configure(&scale, &settings)?;
        let positions = [BETWEEN_LINES; AXES];
        board.bus.advance(&positions)?;
        board.arm()?;
        let (references, last) = ([Speed::ZERO; AXES], Snapshot::default());
        Ok(Self { board, scale, run, base: [0; AXES], positions, references, last })
    }

    /// Goes on after rows that stand at these counts, with these words in the integrators.
    pub(super) fn resume(&mut self, counts: &[i64; AXES], integrals: &[i32; AXES]) -> Result<(), LoopError> {
        for ((base, count), position) in self.base.iter_mut().zip(counts).zip(self.positions) {
            *base = count - (position - BETWEEN_LINES) as i64;
        }
        if self.integrals()? == *integrals {
            return Ok(());
        }
        // Off for a tick, which clears the integrators.
        self.board.disarm()?;
        self.board.bus.advance(&self.positions)?;
        self.board.arm()?;
        preload(&mut self.board, &self.scale, integrals, &self.positions)
    }

    /// One row; gives the FPGA's duties.
    pub(super) fn tick(&mut self, tick: usize) -> Result<[f64; AXES], LoopError> {
        for (word, column) in self.references.iter_mut().zip(&self.run.reference) {
            // Where the log has no set point the last one holds.
            if !column[tick].is_nan() {
                *word = self.scale.speed_word(column[tick]);
            }
        }
        self.board.set_wheel_speeds(&self.references)?;
        for ((position, column), base) in self.positions.iter_mut().zip(&self.run.counts).zip(self.base) {
            *position = (column[tick] - base) as f64 + BETWEEN_LINES;
        }
        self.board.bus.advance(&self.positions)?;
        self.last = self.board.snapshot()?;
        Ok(self.last.duties.map(f64::from))
    }

    /// Words in the integrators.
    pub(super) fn integrals(&mut self) -> Result<[i32; AXES], LoopError> {
        let mut words = [0; AXES];
        for (axis, word) in words.iter_mut().enumerate() {
            *word = self.board.bus.read(INTEGRALS.at(axis)).map_err(driver::BoardError::from)? as i32;
        }
        Ok(words)
    }

    /// Whether the outputs are on; before the first row they are.
    pub(super) fn armed(&self) -> bool {
        self.last.status.armed
    }

    pub(super) fn faults(&self) -> u32 {
        self.last.faults
    }
}

/// What the card is told of the robot.
pub(super) fn scale(robot: &Robot) -> Result<Scale, LoopError> {
    Ok(Scale::new(robot, whole_tick_clock_hz(robot.control_rate_hz))?)
}

/// The count before the first row: zero, or the first one itself where no wheel could have turned
/// that far in a tick.
pub(super) fn count_before(robot: &Robot, run: &Run, wheel: usize) -> i64 {
    let first = run.counts[wheel].first().copied().unwrap_or(0);
    let per_tick = robot.no_load_wheel_speed(robot.supply_v) * robot.counts_per_wheel_rad() * robot.tick_s();
    if first.unsigned_abs() as f64 <= per_tick { 0 } else { first }
}
