//! What the drives in a log could show, and which drive would show more.

use runs::Run;
use runs::frames::Twist;
use runs::robot::Robot;

/// How a robot moved in its logs, by its encoders and nominal geometry.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Excitation {
    /// Length of the path, m.
    pub(super) path_m: f64,
    /// Turned in all, either way, rad.
    pub(super) turned_rad: f64,
    /// Body direction (rad from body x) of the only axis it drove along, if there was only one.
    pub(super) single_axis: Option<f64>,
}

impl Excitation {
    pub(super) fn of(robot: &Robot, runs: &[Run]) -> Self {
        let mut excitation = Self { path_m: 0.0, turned_rad: 0.0, single_axis: None };
        let Ok(geometry) = robot.geometry() else { return excitation };
        // Second moments of the travel in the body frame: one large eigenvalue means one axis.
        let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
        // Steps of 20 ms, so that the dither of single counts is no motion.
        let stride = ((0.02 * robot.control_rate_hz) as usize).max(1);
        for run in runs {
            let mut tick = 0;
            while tick + stride < run.len() && !run.counts.is_empty() {
                let turned: Vec<f64> = run
                    .counts
                    .iter()
                    .map(|c| c[tick + stride].wrapping_sub(c[tick]) as f64 / robot.counts_per_wheel_rad())
                    .collect();
                let moved = geometry.twist(&turned);
                let length = moved.speed();
                excitation.path_m += length;
                excitation.turned_rad += moved.omega.abs();
                if length > 0.0 {
                    xx += moved.vx * moved.vx / length;
                    xy += moved.vx * moved.vy / length;
                    yy += moved.vy * moved.vy / length;
                }
                tick += stride;
            }
        }
        let (mean, half) = (0.5 * (xx + yy), (0.25 * (xx - yy).powi(2) + xy * xy).sqrt());
        if mean - half < 0.02 * (mean + half) {
            excitation.single_axis = Some(0.5 * (2.0 * xy).atan2(xx - yy));
        }
        excitation
    }
}

/// The body direction (rad from body x, in steps of 15°) in which a straight drive of a metre shows
/// most of a change of the skews along `direction`, in units of 1.5 mm and 0.5°.
pub(super) fn best_direction(robot: &Robot, direction: &[f64]) -> f64 {
    let Ok(geometry) = robot.geometry() else { return 0.0 };
    let shown = |angle: f64| {
        let v = Twist::new(angle.cos(), angle.sin(), 0.0);
        // Turning the traction direction clockwise by α lowers its share of v by α·(a⊥ · v).
        let turned: Vec<f64> = geometry
            .wheels()
            .iter()
            .zip(direction)
            .map(|(wheel, alpha)| {
                let [ax, ay] = wheel.traction();
                alpha * (-ay * v.vx + ax * v.vy) / (geometry.wheel_radius_m() * wheel.roller_rad.cos())
            })
            .collect();
        let off = geometry.twist(&turned);
        (off.vx.powi(2) + off.vy.powi(2)) / 0.0015_f64.powi(2) + (off.omega / 0.5_f64.to_radians()).powi(2)
    };
    let candidates = (0..12).map(|k| f64::from(k) * 15.0_f64.to_radians());
    candidates.max_by(|a, b| shown(*a).total_cmp(&shown(*b))).unwrap_or(0.0)
}
