//! A DC motor behind a gear, seen from the wheel shaft.

use runs::robot::Robot;

/// Relative growth of a copper winding's resistance, 1/K.
pub const COPPER_PER_K: f64 = 0.0039;
/// Relative loss of flux of neodymium magnets, 1/K (reversible, N-grades: 0.10 to 0.12 %).
pub const MAGNET_PER_K: f64 = 0.0011;

/// Everything between duty and wheel shaft, in wheel-shaft quantities.
///
/// The winding's inductance is neglected: its time constant L/R is 23 µs (45 µH, 1.94 Ω), a
/// fortieth of a control tick.
///
/// The gear loses a share 1 − η of the torque that passes through it, whichever side drives it: a
/// friction of (1 − η)·|transmitted torque| against the rotation. It therefore never returns
/// energy, and driving the gear backwards costs as much as driving it forwards.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Axis {
    /// Torque per volt at standstill, Nm/V: g·kt/R.
    pub torque_per_volt: f64,
    /// Electrical damping, Nm s/rad: g²·kt·ke/R.
    pub damping: f64,
    /// Rotor inertia reflected through the gear, kg m²: g²·J.
    pub rotor_inertia: f64,
    /// Inertia beyond the gear, kg m².
    pub load_inertia: f64,
    /// Coulomb friction of the motor reflected through the gear, Nm: g·τ.
    pub coulomb: f64,
    /// Share of the transmitted torque that the gear loses, 1 − η.
    pub gear_loss: f64,
}

impl Axis {
    /// The axes of a robot.
    pub fn of(robot: &Robot) -> Self {
        let (motor, g) = (&robot.motor, robot.gear_ratio);
        Self {
            torque_per_volt: g * motor.torque_constant / motor.resistance_ohm,
            damping: g * g * motor.torque_constant * motor.back_emf() / motor.resistance_ohm,
            rotor_inertia: g * g * motor.rotor_inertia,
            load_inertia: robot.wheel_inertia_kg_m2,
            coulomb: g * motor.friction_torque,
            gear_loss: 1.0 - robot.gear_efficiency,
        }
    }

    /// The same with a torque and back-EMF constant, and a resistance, that are larger by these shares.
    #[must_use]
    pub fn with_motor(self, constant: f64, resistance: f64) -> Self {
        let (k, r) = (1.0 + constant, 1.0 + resistance);
        Self { torque_per_volt: self.torque_per_volt * k / r, damping: self.damping * k * k / r, ..self }
    }

    /// Rotor and load at the wheel shaft, kg m².
    pub fn inertia(&self) -> f64 {
        self.rotor_inertia + self.load_inertia
    }

    /// Torque of the winding at the wheel shaft, Nm, before any friction.
    pub fn winding_torque(&self, voltage: f64, wheel_speed: f64) -> f64 {
        self.torque_per_volt * voltage - self.damping * wheel_speed
    }

    /// Torque the gear passes on before its own loss, Nm: winding minus rotor acceleration minus
    /// the motor's part of the friction torque.
    pub fn transmitted(&self, winding: f64, acceleration: f64, friction: f64, limit: f64) -> f64 {
        let motor_part = if limit > 0.0 { friction * self.coulomb / limit } else { 0.0 };
        winding - self.rotor_inertia * acceleration + motor_part
    }

    /// [`Self::transmitted`] while the friction is at its limit, as it is in motion.
    pub fn transmitted_in_motion(&self, winding: f64, acceleration: f64, friction: f64) -> f64 {
        winding - self.rotor_inertia * acceleration + self.coulomb.copysign(friction)
    }

    /// Largest friction torque at the wheel shaft, Nm, while the gear transmits `transmitted`.
    pub fn friction_limit(&self, transmitted: f64) -> f64 {
        self.coulomb + self.gear_loss * transmitted.abs()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn data_sheet_figures_come_out_at_the_wheel() {
        let robot = Robot::racbot();
        let axis = Axis::of(&robot);
        // Stall: 7.2 V / 1.94 Ω · 6.92 mNm/A · 3.71.
        assert!((axis.winding_torque(7.2, 0.0) - 0.095_282).abs() < 1e-6);
        // No load: the winding gives nothing at back-EMF = supply.
        assert!(axis.winding_torque(7.2, robot.no_load_wheel_speed(7.2)).abs() < 1e-15);
        assert!((axis.inertia() - 3.716_3e-6).abs() < 1e-10);
        assert!((axis.coulomb - 0.000_556_5).abs() < 1e-12);
        assert!((axis.friction_limit(-0.05) - (0.000_556_5 + 0.006)).abs() < 1e-12);
    }
}
