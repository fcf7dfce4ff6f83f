//! The PI speed loop of every axis, in floating point.

use runs::robot::{Robot, Support};

use crate::motor::Axis;

/// The law, as `robot.toml` states it: e = ref − w (rad/s at the wheel); t = I + ki·e/rate;
/// I stays if |kp·e + t| > 1 and e·(kp·e + t) > 0, else I = t; duty = clip(kp·e + I, −1, 1).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PiLaw {
    /// Duty per rad/s at the wheel.
    pub kp: f64,
    /// Duty per rad at the wheel.
    pub ki: f64,
    /// Steps a second.
    pub rate_hz: f64,
    /// Rounding of the duty; 0 for none.
    pub duty_quantum: f64,
    /// Limit of an integrator that is not held in saturation; `None` for the law as stated.
    pub integral_limit: Option<f64>,
}

/// Times as fast as by itself that a proposed loop brings a wheel to its speed: 42 of the paper's robot.
const FASTER: f64 = 20.0;
/// Share of what is left of an error that it takes off in a tick at most: a loop rings from 1 on, and bare wheels are light.
const PER_TICK: f64 = 0.3;

/// Gains kp (duty per rad/s at the wheel) and ki (duty per rad) that suit the motors, the mass and the ticks of a robot whose
/// file has none: the zero of the loop is the pole of the wheel with its share of the robot. `None` where the file lacks what
/// they come from.
pub fn proposed_gains(robot: &Robot) -> Option<[f64; 2]> {
    if !runs::drive_lacks(robot).is_empty() || !robot.lacks(&["control_rate_hz"]).is_empty() {
        return None;
    }
    let axis = Axis::of(robot);
    let carried = match robot.support {
        Support::Floor => robot.mass_kg * robot.wheel_radius_m.powi(2) / robot.wheel_count() as f64,
        Support::Blocks => 0.0,
    };
    let own_s = (axis.inertia() + carried) / axis.damping;
    let faster = FASTER.min(PER_TICK * own_s * robot.control_rate_hz);
    let kp = faster / robot.no_load_wheel_speed(robot.supply_v);
    let gains = [kp, kp / own_s];
    gains.iter().all(|gain| gain.is_finite() && *gain > 0.0).then_some(gains)
}

impl PiLaw {
    /// The law of a robot's axes; the duty is rounded only if the robot says to what.
    pub fn of(robot: &Robot) -> Self {
        Self {
            kp: robot.pi.kp,
            ki: robot.pi.ki,
            rate_hz: robot.control_rate_hz,
            duty_quantum: robot.duty_quantum.unwrap_or(0.0),
            integral_limit: None,
        }
    }

    /// One step from a set point and a measured speed (rad/s at the wheel) to a duty in [−1, 1].
    pub fn step(&self, integral: &mut f64, reference: f64, speed: f64) -> f64 {
        let error = reference - speed;
        let proportional = self.kp * error;
        let candidate = *integral + self.ki * error / self.rate_hz;
        let unlimited = proportional + candidate;
        if let Some(limit) = self.integral_limit {
            *integral = candidate.clamp(-limit, limit);
        } else if unlimited.abs() <= 1.0 || error * unlimited <= 0.0 {
            *integral = candidate;
        }
        let duty = (proportional + *integral).clamp(-1.0, 1.0);
        if self.duty_quantum > 0.0 { (duty / self.duty_quantum).round() * self.duty_quantum } else { duty }
    }
}

/// One axis: speed from the count difference of one tick, then [`PiLaw`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpeedLoop {
    law: PiLaw,
    speed_per_count: f64,
    integral: f64,
    count: i64,
}

impl SpeedLoop {
    /// An axis at rest at count 0, with an empty integrator.
    pub fn new(robot: &Robot) -> Self {
        Self::with_law(robot, PiLaw::of(robot))
    }

    /// The same under another law than the robot's own.
    pub fn with_law(robot: &Robot, law: PiLaw) -> Self {
        Self { law, speed_per_count: robot.control_rate_hz / robot.counts_per_wheel_rad(), integral: 0.0, count: 0 }
    }

    /// The same reckoning with `share` times the counts that a wheel turn has by the robot's file.
    #[must_use]
    pub fn counting(self, share: f64) -> Self {
        Self { speed_per_count: self.speed_per_count / share, ..self }
    }

    /// One tick: set point (rad/s at the wheel) and cumulative count to duty.
    pub fn step(&mut self, reference: f64, count: i64) -> f64 {
        let speed = count.wrapping_sub(self.count) as f64 * self.speed_per_count;
        self.count = count;
        self.law.step(&mut self.integral, reference, speed)
    }

    /// The integrator, as duty.
    pub fn integral(&self) -> f64 {
        self.integral
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use runs::DataSet;
    use std::path::Path;

    #[test]
    fn replay_of_measured_runs_reproduces_every_duty() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../data/runs/wheel-skew");
        let set = DataSet::open(folder).unwrap();
        let mut compared = 0;
        for run in &set.runs {
            for wheel in 0..3 {
                let mut axis = SpeedLoop::new(&set.robot);
                for tick in 0..run.len() {
                    let duty = axis.step(run.reference[wheel][tick], run.counts[wheel][tick]);
                    let logged = run.duty[wheel][tick];
                    assert!((duty - logged).abs() <= 0.0005 + 1e-9, "{} tick {tick} wheel {wheel}", run.name);
                    compared += 1;
                }
            }
        }
        assert!(compared > 70_000, "{compared}");
    }

    /// A small-size robot, one wheel of a mecanum robot at 50 Hz, and the paper's robot, on the floor and off it.
    #[test]
    fn proposed_gains_bring_wheels_to_their_speeds() {
        let paper = Robot { gear_efficiency: 1.0, ..Robot::racbot() };
        let mut heavy =
            Robot { mass_kg: 15.0, wheel_radius_m: 0.076, gear_ratio: 27.0, supply_v: 12.0, ..paper.clone() };
        heavy.control_rate_hz = 50.0;
        heavy.motor.torque_constant = 0.018;
        heavy.motor.resistance_ohm = 0.6;
        for (robot, support) in [(&paper, Support::Floor), (&heavy, Support::Floor), (&paper, Support::Blocks)] {
            let robot = Robot { support, ..robot.clone() };
            let [kp, ki] = proposed_gains(&robot).unwrap();
            let law = PiLaw { kp, ki, rate_hz: robot.control_rate_hz, duty_quantum: 0.0, integral_limit: None };
            let axis = Axis::of(&robot);
            let carried = robot.mass_kg * robot.wheel_radius_m.powi(2) / robot.wheel_count() as f64;
            let own_s = (axis.inertia() + if support == Support::Floor { carried } else { 0.0 }) / axis.damping;
            let (mut integral, mut speed) = (0.0, 0.0_f64);
            let most = robot.no_load_wheel_speed(robot.supply_v);
            let (asked, kept) = (0.4 * most, (-robot.tick_s() / own_s).exp());
            let mut fastest = 0.0_f64;
            for _ in 0..(10.0 * own_s * robot.control_rate_hz) as usize {
                speed = kept * speed + (1.0 - kept) * most * law.step(&mut integral, asked, speed);
                fastest = fastest.max(speed);
            }
            assert!(
                (speed / asked - 1.0).abs() < 0.01 && fastest < 1.1 * asked,
                "{support:?} {speed} {fastest} {asked}"
            );
        }
        let unknown = Robot { missing: vec!["supply_v".to_owned()], ..paper };
        assert_eq!(proposed_gains(&unknown), None);
    }

    #[test]
    fn integrator_holds_in_saturation_and_lets_go_at_once() {
        let law = PiLaw { kp: 0.1, ki: 10.0, rate_hz: 1000.0, duty_quantum: 0.0, integral_limit: None };
        let mut integral = 0.0;
        for _ in 0..10_000 {
            assert_eq!(law.step(&mut integral, 50.0, 0.0), 1.0);
        }
        assert!(integral <= 1.0);
        // The set point falls below the speed: the duty leaves the stop in the same tick.
        assert!(law.step(&mut integral, 0.0, 5.0) < 0.5);
    }

    #[test]
    fn duty_is_rounded_to_its_quantum() {
        let law = PiLaw { kp: 0.1, ki: 0.0, rate_hz: 1000.0, duty_quantum: 0.01, integral_limit: None };
        let duty = law.step(&mut 0.0, 1.234, 0.0);
        assert!((duty - 0.12).abs() < 1e-12);
    }
}
