//! The controller: commands to set points, set points and counts to duties.

use crate::geometry::Mount;
use crate::machine::Controller;
use crate::robot::Robot;

/// The loops of all axes with their memory.
#[derive(Clone, Debug)]
pub(crate) struct Control<'a> {
    robot: &'a Robot,
    law: &'a Controller,
    mounts: Vec<Mount>,
    speed_quantum: f64,
    integrals: Vec<f64>,
    ref_history: Vec<Vec<f64>>,
    enc_history: Vec<Vec<i64>>,
}

impl<'a> Control<'a> {
    pub(crate) fn new(robot: &'a Robot, law: &'a Controller) -> Self {
        let mounts = robot.mounts();
        let axes = mounts.len();
        Self {
            robot,
            law,
            mounts,
            speed_quantum: robot.speed_quantum(),
            integrals: vec![0.0; axes],
            ref_history: Vec::new(),
            enc_history: vec![vec![0; axes]],
        }
    }

    /// Set points (rad/s at the wheel, rounded as in the log) for a body velocity `[vx, vy, ω]`.
    pub(crate) fn set_points(&self, command: [f64; 3]) -> Vec<f64> {
        self.law
            .row_of_ref
            .iter()
            .map(|&row| {
                let sign = f64::from(row.signum());
                let rim = self
                    .mounts
                    .get((row.unsigned_abs() as usize).saturating_sub(1))
                    .map_or(0.0, |mount| mount.rim_speed(command));
                round_to(sign * rim / self.robot.wheel_radius_m, self.robot.ref_quantum)
            })
            .collect()
    }

    /// One tick: duties (rounded) from the set points and counts of this tick.
    pub(crate) fn tick(&mut self, refs: &[f64], counts: &[i64]) -> Vec<f64> {
        self.ref_history.push(refs.to_vec());
        self.enc_history.push(counts.to_vec());
        let refs = aged(&self.ref_history, self.law.ref_age_ticks);
        let now = aged(&self.enc_history, self.law.enc_age_ticks);
        let before = aged(&self.enc_history, self.law.enc_age_ticks + 1);
        let rate = self.robot.control_rate_hz;
        let mut duties = Vec::with_capacity(self.integrals.len());
        for (i, integral) in self.integrals.iter_mut().enumerate() {
            let speed = (now[i] - before[i]) as f64 * self.speed_quantum;
            let error = refs[i] - speed;
            let next = *integral + self.law.ki * error / rate;
            let wanted = self.law.kp * error + next;
            match self.law.windup_limit {
                Some(limit) => *integral = next.clamp(-limit, limit),
                None if wanted.abs() > 1.0 && error * wanted > 0.0 => {}
                None => *integral = next,
            }
            let duty = (self.law.kp * error + *integral).clamp(-1.0, 1.0);
            duties.push(round_to(duty, self.law.duty_quantum).clamp(-1.0, 1.0));
        }
        duties
    }
}

/// The entry `age` before the last one, or the first.
fn aged<T>(history: &[T], age: usize) -> &T {
    &history[(history.len() - 1).saturating_sub(age)]
}

/// The nearest multiple of `quantum`.
pub(crate) fn round_to(value: f64, quantum: f64) -> f64 {
    (value / quantum).round() * quantum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::machine::Machine;

    #[test]
    fn the_integrator_is_held_at_saturation_and_only_there() {
        let robot = Robot::standard();
        let mut machine = Machine::ideal(&robot);
        let mut control = Control::new(&robot, &machine.controller);
        assert_eq!(control.tick(&[1.0, 100.0, 0.0], &[0, 0, 0]), vec![0.151, 1.0, 0.0]);
        assert!((control.integrals[0] - 0.0008).abs() < 1e-12);
        assert_eq!(control.integrals[1], 0.0);
        machine.controller.windup_limit = Some(2.0);
        let mut control = Control::new(&robot, &machine.controller);
        for _ in 0..100_000 {
            control.tick(&[1.0, 100.0, 0.0], &[0, 0, 0]);
        }
        assert_eq!(control.integrals[1], 2.0);
    }

    #[test]
    fn swapped_rows_swap_set_points() {
        let robot = Robot::standard();
        let mut machine = Machine::ideal(&robot);
        let plain = Control::new(&robot, &machine.controller).set_points([0.3, 0.5, 1.0]);
        machine.controller.row_of_ref = vec![2, 1, -3];
        let swapped = Control::new(&robot, &machine.controller).set_points([0.3, 0.5, 1.0]);
        assert_eq!(swapped, vec![plain[1], plain[0], -plain[2]]);
    }
}
