//! Set points and the controllers that follow them (paper, section 4).

mod file;
mod follower;
mod limits;
mod paper;
mod report;

pub use follower::{Arrival, Follower, FollowerOptions};
pub use limits::Limits;
pub use paper::{MotionController, MotionSample, simulate_motion};
pub use report::{SetPointReport, TrajectoryReport};

/// One point of a trajectory: a place, and how to travel there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SetPoint {
    /// Field x, m.
    pub x: f64,
    /// Field y, m.
    pub y: f64,
    /// Speed on the way there, m/s, greater than 0.
    pub v: f64,
    /// Rotation on the way there, counter-clockwise, rad/s; with a heading, the fastest turn to it either way.
    pub omega: f64,
    /// Whether to come to rest there instead of passing through.
    pub stop: bool,
    /// Heading to come to rest at, rad; only with `stop`, and not for the paper's controller, which knows none.
    pub heading: Option<f64>,
}

impl SetPoint {
    /// A point to pass through.
    pub const fn pass(x: f64, y: f64, v: f64, omega: f64) -> Self {
        Self { x, y, v, omega, stop: false, heading: None }
    }

    /// A point to come to rest at.
    pub const fn stop(x: f64, y: f64, v: f64, omega: f64) -> Self {
        Self { x, y, v, omega, stop: true, heading: None }
    }

    /// A point to come to rest at with a heading, turning no faster than `omega`.
    pub const fn facing(x: f64, y: f64, v: f64, omega: f64, heading: f64) -> Self {
        Self { x, y, v, omega, stop: true, heading: Some(heading) }
    }
}

/// The trajectory of the paper's Fig. 6.
///
/// The caption prints the first point as "(3, 3, 10, 05)". We read (3, 3, 1.0, 0.5): decimal
/// points got lost, for all other speeds are 1 and 10 m/s is beyond the motors.
pub const FIG_6: [SetPoint; 4] = [
    SetPoint::pass(3.0, 3.0, 1.0, 0.5),
    SetPoint::pass(3.0, 0.0, 1.0, 0.0),
    SetPoint::pass(6.0, 0.0, 1.0, -0.15),
    SetPoint::pass(6.0, 3.0, 1.0, 0.0),
];

/// The skew of the paper's Fig. 7 as we drive it, unknown to the controller: 4°, −3°, 2° (the paper
/// does not print its own).
pub const FIG_7_SKEW_DEG: [f64; 3] = [4.0, -3.0, 2.0];

/// Length of a vector of the field, m. Not `hypot`: that takes five times as long to stand numbers beyond 1e150.
fn length_of([x, y]: [f64; 2]) -> f64 {
    (x * x + y * y).sqrt()
}
