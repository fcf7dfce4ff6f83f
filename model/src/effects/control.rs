//! Effects of the controller: what it does with commands, counts and duties.

use crate::pi::PiLaw;
use runs::frames::Twist;
use runs::geometry::Geometry;
use runs::robot::{Effect, Robot};

/// By what a controller differs from its nominal law; all zero is the nominal one.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ControlDeviations {
    /// Gains kp and ki, relative: 0.01 is 1 % more.
    pub gains: [f64; 2],
    /// Limit of an integrator that is not held in saturation, duty.
    pub integral_limit: Option<f64>,
    /// Rounding of the duty.
    pub duty_quantum: Option<f64>,
    /// Ticks by which the counts and the set points it uses are older than logged.
    pub shift_ticks: [usize; 2],
    /// Age of the command that the set points follow, s.
    pub command_latency_s: f64,
    /// Row of the inverse kinematics, from 1, that each set point follows, inverted where negative.
    pub order: Vec<f64>,
    /// By how much more counts a wheel turn its speeds are reckoned with than stated, as a share of those.
    pub more_counts: f64,
}

impl ControlDeviations {
    /// The law of a robot's axes.
    pub(crate) fn law(&self, robot: &Robot) -> PiLaw {
        let nominal = PiLaw::of(robot);
        PiLaw {
            kp: nominal.kp * (1.0 + self.gains[0]),
            ki: nominal.ki * (1.0 + self.gains[1]),
            duty_quantum: self.duty_quantum.unwrap_or(nominal.duty_quantum),
            integral_limit: self.integral_limit,
            ..nominal
        }
    }

    /// Set point (rad/s) of axis `i`, from 0.
    pub(crate) fn reference(&self, i: usize, command: Twist, believed: &Geometry) -> f64 {
        let row = self.order.get(i).copied().unwrap_or(i as f64 + 1.0);
        let index = (row.abs().round() as usize).clamp(1, believed.wheel_count()) - 1;
        row.signum() * believed.wheel_speed(index, command)
    }
}

/// What the controller takes for the counts of a wheel turn, beside what the encoder gives.
pub(super) fn reckoned(effect: &Effect, control: &mut ControlDeviations) {
    if effect.name == "encoder-scale" {
        control.more_counts += effect.value("loop_scale").unwrap_or(0.0);
    }
}

/// Applies an effect if it is one of these.
pub(super) fn apply(effect: &Effect, wheels: usize, control: &mut ControlDeviations) -> bool {
    let value = |name: &str| effect.value(name).unwrap_or(0.0);
    match effect.name.as_str() {
        "pi-gain" => control.gains = [value("kp_scale"), value("ki_scale")],
        "integrator-windup" => control.integral_limit = effect.value("limit_duty").map(f64::abs),
        "quantisation" => control.duty_quantum = effect.value("duty_quantum"),
        "sample-order" => {
            let (signal, ticks) = (value("signal").round(), value("shift_ticks").max(0.0).round() as usize);
            // Counts, set points, or both.
            for (older, age) in [signal != 1.0, signal != 0.0].into_iter().zip(&mut control.shift_ticks) {
                *age = if older { ticks } else { *age };
            }
        }
        "command-latency" => control.command_latency_s += value("latency_s"),
        "wheel-order" => {
            control.order =
                (0..wheels).map(|i| effect.value(&format!("axis_{}", i + 1)).unwrap_or(i as f64 + 1.0)).collect();
        }
        _ => return false,
    }
    true
}
