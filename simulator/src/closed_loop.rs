//! The virtual robot: driver code → registers → FPGA → motors and body → encoders → FPGA.
//!
//! ```text
//!        ┌────────── snapshot ──────────┐
//!        ▼                              │
//!  controller ──► driver ──► registers: FPGA ──duty──► motors, body ──┐
//!        ▲                              ▲                              │
//!        └── camera                     └───────── encoders ───────────┘
//! ```
//!
//! Time is counted in control ticks. Before tick k the host commits the set points that act at k;
//! at k the FPGA latches its encoders and computes the duty that drives the motors until k + 1;
//! after k the host reads what the FPGA saw.

mod drive;
mod forward;
pub mod picture;
mod recording;

pub use drive::{Drive, Driven, Ending};
pub use driver::drive::Control;

use crate::fpga::{Fpga, FpgaError};
use driver::{Board, BoardError, Scale, ScaleError, Settings, Snapshot};
use fixed_kin::AXES;
use fixed_kin::modulation::modulate;
use fixed_kin::registers::NOMINAL_CLOCK_HZ;
use model::plant::Plant;
use runs::frames::Twist;
use runs::geometry::GeometryError;
use runs::robot::Robot;

/// A virtual robot that cannot be set up, or whose card failed.
#[derive(Debug, thiserror::Error)]
pub enum LoopError {
    /// The robot does not fit the card.
    #[error(transparent)]
    Scale(#[from] ScaleError),
    /// The wheels cannot drive the robot.
    #[error(transparent)]
    Geometry(#[from] GeometryError),
    /// The driver got no proper answer.
    #[error(transparent)]
    Board(#[from] BoardError),
    /// The FPGA's simulation failed.
    #[error(transparent)]
    Fpga(#[from] FpgaError),
}

/// The clock near the nominal one at which a control period is a whole number of clocks, so that a
/// simulated tick is exactly 1 / `rate_hz` long.
#[must_use]
pub fn whole_tick_clock_hz(rate_hz: f64) -> f64 {
    (f64::from(NOMINAL_CLOCK_HZ) / rate_hz).round().max(1.0) * rate_hz
}

/// A robot on an FPGA, tick by tick.
#[derive(Debug)]
pub struct ClosedLoop<F> {
    board: Board<F>,
    scale: Scale,
    plant: Plant,
    supply_v: f64,
    pwm_period: u16,
    duty: [f64; AXES],
    positions: [f64; AXES],
}

impl<F: Fpga> ClosedLoop<F> {
    /// Identifies and configures the card for the robot that the driver `believes` in, and arms it.
    ///
    /// The `plant` is what the robot really is; it may be in motion.
    ///
    /// # Errors
    /// [`LoopError`] where the robot does not fit the card, or the card does not answer.
    pub fn start(fpga: F, believed: &Robot, plant: Plant, settings: &Settings) -> Result<Self, LoopError> {
        let scale = Scale::new(believed, whole_tick_clock_hz(believed.control_rate_hz))?;
        let mut board = Board::new(fpga);
        board.identify()?;
        board.configure(&scale, settings)?;
        board.bus.advance(&[0.0; AXES])?;
        board.arm()?;
        let pwm_period = scale.pwm_period(settings.pwm_hz) as u16;
        let supply_v = believed.supply_v;
        Ok(Self { board, scale, plant, supply_v, pwm_period, duty: [0.0; AXES], positions: [0.0; AXES] })
    }

    /// Another supply than the believed robot's, V.
    #[must_use]
    pub fn with_supply(mut self, supply_v: f64) -> Self {
        self.supply_v = supply_v;
        self
    }

    /// Commits a body velocity, lets the FPGA see the encoders and the motors its duty for one
    /// control period; returns what the FPGA saw.
    ///
    /// # Errors
    /// [`LoopError`] where the card does not answer or an encoder moves too fast.
    pub fn tick(&mut self, command: Twist) -> Result<Snapshot, LoopError> {
        self.board.set_twist(&self.scale, command)?;
        for (position, now) in self.positions.iter_mut().zip(self.plant.encoder_after()) {
            *position = *now;
        }
        self.board.bus.advance(&self.positions)?;
        let snapshot = self.board.snapshot()?;
        for (duty, word) in self.duty.iter_mut().zip(snapshot.duties) {
            let pwm = modulate(word, self.pwm_period);
            let share = f64::from(pwm.compare) / f64::from(self.pwm_period);
            *duty = match (snapshot.status.armed, pwm.reverse) {
                (false, _) => 0.0,
                (true, false) => share,
                (true, true) => -share,
            };
        }
        self.plant.step(&self.duty, self.supply_v, self.scale.tick_s());
        Ok(snapshot)
    }

    /// Motors and body as they are at the coming tick.
    pub fn plant(&self) -> &Plant {
        &self.plant
    }

    /// The driver's conversions.
    pub fn scale(&self) -> &Scale {
        &self.scale
    }

    /// The FPGA, for whoever wants to look at its registers afterwards.
    pub fn into_fpga(self) -> F {
        self.board.bus
    }
}
