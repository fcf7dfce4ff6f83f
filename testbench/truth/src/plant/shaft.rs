//! A wheel shaft with its gear and rotor: dry friction that holds, load-dependent gear loss, play.

/// Stiffness of the gear teeth seen at the wheel shaft, Nm/rad; used only where there is play.
const MESH_STIFFNESS: f64 = 12.0;
/// Damping of the same relative to critical.
const MESH_DAMPING: f64 = 0.4;
/// Part by which the smoothed shaft acceleration moves in one step; it only scales the gear loss.
const SMOOTHING: f64 = 0.1;

/// Wheel and rotor; angles and speeds of the rotor are divided by the gear ratio, so that both count wheel turns.
#[derive(Clone, Debug)]
pub(crate) struct Shaft {
    /// Wheel angle, rad, half a step behind the speed.
    pub(crate) angle: f64,
    /// Wheel speed, rad/s.
    pub(crate) speed: f64,
    /// Rotor angle over the gear ratio, rad.
    pub(crate) rotor_angle: f64,
    /// Rotor speed over the gear ratio, rad/s.
    pub(crate) rotor_speed: f64,
    wheel_inertia: f64,
    rotor_inertia: f64,
    half_play: f64,
    loss: f64,
    acceleration: f64,
}

/// Torques on a shaft during one step, Nm at the wheel shaft.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Torques {
    /// From the motor's magnetic field, times the gear ratio.
    pub(crate) motor: f64,
    /// From the ground and everything else that turns the wheel.
    pub(crate) wheel: f64,
    /// Dry friction limit of the motor, times the gear ratio.
    pub(crate) motor_dry: f64,
    /// Dry friction limit of the wheel for positive and negative turning.
    pub(crate) wheel_dry: [f64; 2],
}

impl Shaft {
    /// A shaft with these inertias (kg m² at the wheel shaft), play (rad at the wheel shaft) and gear efficiency.
    pub(crate) fn new(wheel_inertia: f64, rotor_inertia: f64, play: f64, efficiency: f64) -> Self {
        Self {
            angle: 0.0,
            speed: 0.0,
            rotor_angle: 0.0,
            rotor_speed: 0.0,
            wheel_inertia,
            rotor_inertia,
            half_play: 0.5 * play,
            loss: 1.0 - efficiency,
            acceleration: 0.0,
        }
    }

    /// Moves the angles by one step.
    pub(crate) fn drift(&mut self, step: f64) {
        self.angle += step * self.speed;
        self.rotor_angle += step * self.rotor_speed;
    }

    /// Moves the speeds by one step.
    pub(crate) fn kick(&mut self, step: f64, torques: &Torques) {
        if self.half_play > 0.0 {
            self.kick_with_play(step, torques);
        } else {
            self.kick_rigid(step, torques);
        }
    }

    fn kick_rigid(&mut self, step: f64, torques: &Torques) {
        let mesh = torques.motor - self.rotor_inertia * self.acceleration;
        let held = torques.motor_dry + self.loss * mesh.abs();
        let inertia = self.wheel_inertia + self.rotor_inertia;
        let free = self.speed + step / inertia * (torques.motor + torques.wheel);
        let next = dry(free, step / inertia, [held + torques.wheel_dry[0], held + torques.wheel_dry[1]]);
        self.acceleration += SMOOTHING * ((next - self.speed) / step - self.acceleration);
        self.speed = next;
        self.rotor_speed = next;
    }

    fn kick_with_play(&mut self, step: f64, torques: &Torques) {
        let gap = self.rotor_angle - self.angle;
        let over = gap - gap.clamp(-self.half_play, self.half_play);
        let mut mesh = 0.0;
        if over != 0.0 {
            let reduced = self.wheel_inertia * self.rotor_inertia / (self.wheel_inertia + self.rotor_inertia);
            let damping = 2.0 * MESH_DAMPING * (MESH_STIFFNESS * reduced).sqrt();
            mesh = MESH_STIFFNESS * over + damping * (self.rotor_speed - self.speed);
            if mesh * over < 0.0 {
                mesh = 0.0;
            }
        }
        let free = self.rotor_speed + step / self.rotor_inertia * (torques.motor - mesh);
        self.rotor_speed = dry(free, step / self.rotor_inertia, [torques.motor_dry; 2]);
        let free = self.speed + step / self.wheel_inertia * (mesh + torques.wheel);
        let held = self.loss * mesh.abs();
        self.speed = dry(free, step / self.wheel_inertia, [held + torques.wheel_dry[0], held + torques.wheel_dry[1]]);
    }

    /// Kinetic and elastic energy, J.
    pub(crate) fn energy(&self) -> f64 {
        let gap = self.rotor_angle - self.angle;
        let over = if self.half_play > 0.0 { gap - gap.clamp(-self.half_play, self.half_play) } else { 0.0 };
        0.5 * (self.wheel_inertia * self.speed * self.speed
            + self.rotor_inertia * self.rotor_speed * self.rotor_speed
            + MESH_STIFFNESS * over * over)
    }
}

/// Dry friction as an impulse: it stops the shaft where it can and brakes it by `limit·step/inertia` where it cannot.
fn dry(free: f64, step_over_inertia: f64, limits: [f64; 2]) -> f64 {
    let most = step_over_inertia * if free >= 0.0 { limits[0] } else { limits[1] };
    free - free.clamp(-most, most)
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEP: f64 = 5e-5;

    #[test]
    fn dry_friction_holds_below_its_limit_and_brakes_above() {
        for play in [0.0, 0.01] {
            let mut shaft = Shaft::new(5e-6, 4e-6, play, 1.0);
            let mut torques = Torques { wheel: 0.0099, wheel_dry: [0.01; 2], ..Torques::default() };
            for _ in 0..2000 {
                shaft.drift(STEP);
                shaft.kick(STEP, &torques);
            }
            assert_eq!(shaft.angle, 0.0, "play {play}");
            torques.wheel = -0.0101;
            for _ in 0..2000 {
                shaft.drift(STEP);
                shaft.kick(STEP, &torques);
            }
            assert!(shaft.speed < -0.1, "play {play}: {}", shaft.speed);
        }
    }

    #[test]
    fn a_motor_in_the_play_turns_alone_and_then_takes_the_wheel_along() {
        let mut shaft = Shaft::new(5e-6, 4e-6, 0.1, 0.9);
        let torques = Torques { motor: 0.002, wheel_dry: [0.0005; 2], ..Torques::default() };
        let mut alone = true;
        for _ in 0..4000 {
            shaft.drift(STEP);
            shaft.kick(STEP, &torques);
            if shaft.rotor_angle < 0.05 {
                alone &= shaft.angle == 0.0;
            }
        }
        assert!(alone);
        assert!(shaft.speed > 1.0 && (shaft.rotor_speed - shaft.speed).abs() < 0.05 * shaft.speed);
    }

    #[test]
    fn the_gear_takes_its_part_of_a_steady_torque() {
        let mut shaft = Shaft::new(5e-6, 4e-6, 0.0, 0.88);
        shaft.speed = 10.0;
        shaft.rotor_speed = 10.0;
        for _ in 0..20_000 {
            shaft.kick(STEP, &Torques { motor: 0.02, wheel: -0.0176, ..Torques::default() });
        }
        assert!((shaft.speed - 10.0).abs() < 1e-6, "{}", shaft.speed);
    }
}
