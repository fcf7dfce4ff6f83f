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
use model::robot::Robot;
use model::run::Run;

/// A log on its way through an FPGA.
pub(super) struct Player<'a, F> {
    board: Board<F>,
    scale: Scale,
    run: &'a Run,
    /// Counts that the FPGA's counters show as zero.
    base: [i64; AXES],
    references: [Speed; AXES],
    last: Snapshot,
}

/// Where an encoder stands for a logged count: between this line and the next.
const BETWEEN_LINES: f64 = 0.5;

impl<'a, F: Fpga> Player<'a, F> {
    /// An armed card that is about to see row `from`; with these words in its integrators.
    pub(super) fn start(
        fpga: F,
        robot: &Robot,
        run: &'a Run,
        from: usize,
        integrals: Option<[i32; AXES]>,
    ) -> Result<Self, LoopError> {
        let scale = Scale::new(robot, whole_tick_clock_hz(robot.control_rate_hz))?;
        let settings = Settings {
            speed_mode: SpeedMode::Difference,
            set_point_mode: SetPointMode::Wheels,
            watchdog_s: Settings::default().watchdog_s.max(5.0 * robot.tick_s()),
            ..Settings::default()
        };
        let mut board = Board::new(fpga);
        board.identify()?;
        board.configure(&scale, &settings)?;
        board.bus.advance(&[BETWEEN_LINES; AXES])?;
        board.arm()?;
        if let Some(integrals) = integrals {
            preload(&mut board, &scale, &integrals, &[BETWEEN_LINES; AXES])?;
        }
        let mut base = [0; AXES];
        for (wheel, base) in base.iter_mut().enumerate().take(run.counts.len()) {
            *base = if from == 0 { count_before(robot, run, wheel) } else { run.counts[wheel][from - 1] };
        }
        Ok(Self { board, scale, run, base, references: [Speed::ZERO; AXES], last: Snapshot::default() })
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
        let mut positions = [BETWEEN_LINES; AXES];
        for ((position, column), base) in positions.iter_mut().zip(&self.run.counts).zip(self.base) {
            *position += (column[tick] - base) as f64;
        }
        self.board.bus.advance(&positions)?;
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

    pub(super) fn armed(&self) -> bool {
        self.last.status.armed
    }

    pub(super) fn faults(&self) -> u32 {
        self.last.faults
    }
}

/// The count before the first row: zero, or the first one itself where no wheel could have turned
/// that far in a tick.
pub(super) fn count_before(robot: &Robot, run: &Run, wheel: usize) -> i64 {
    let first = run.counts[wheel].first().copied().unwrap_or(0);
    let per_tick = robot.no_load_wheel_speed(robot.supply_v) * robot.counts_per_wheel_rad() * robot.tick_s();
    if first.unsigned_abs() as f64 <= per_tick { 0 } else { first }
}
