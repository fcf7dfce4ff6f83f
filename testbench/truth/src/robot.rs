//! The nominal robot: what its designers know, and the `robot.toml` that says so.

use std::fmt::Write as _;

use crate::geometry::Mount;

/// Where the wheels stand in `robot.toml`.
#[derive(Clone, Debug, PartialEq)]
pub enum Layout {
    /// Three omni wheels at 90°, 210° and 330° on a circle of this radius (m), skew 0.
    Circle(f64),
    /// Any number of wheels, each listed.
    Listed(Vec<Mount>),
}

/// Nominal parameters in SI units; the fields are those of `robot.toml`.
#[derive(Clone, Debug, PartialEq)]
pub struct Robot {
    /// Nominal radius of every wheel, m.
    pub wheel_radius_m: f64,
    /// Where the wheels are.
    pub layout: Layout,
    /// Mass with everything on board, kg.
    pub mass_kg: f64,
    /// Moment of inertia about the vertical axis, kg m².
    pub yaw_inertia_kg_m2: f64,
    /// Motor turns per wheel turn.
    pub gear_ratio: f64,
    /// Part of the power that the gear passes on.
    pub gear_efficiency: f64,
    /// Counts per turn of the motor shaft.
    pub counts_per_rev: u32,
    /// Battery voltage without load, V.
    pub supply_v: f64,
    /// Control and log ticks per second.
    pub control_rate_hz: f64,
    /// Camera frames per second.
    pub camera_rate_hz: f64,
    /// What is known of the camera's latency, s.
    pub camera_latency_s: Option<f64>,
    /// Standard deviation of the camera's x, y (m) and θ (rad), where it is stated.
    pub camera_noise: Option<[f64; 3]>,
    /// Rounding of set points in the log, rad/s.
    pub ref_quantum: f64,
    /// Rounding of duty, −1 … 1.
    pub duty_quantum: f64,
    /// Whether the two quanta stand in the file.
    pub quanta_stated: bool,
    /// Wheels off the floor, every axis alone.
    pub blocks: bool,
    /// Inertia of a wheel about its shaft, kg m², where it is stated.
    pub wheel_inertia_kg_m2: Option<f64>,
    /// Winding resistance, Ω.
    pub resistance_ohm: f64,
    /// Torque per current, Nm/A; equally the back-EMF, V s/rad.
    pub torque_constant: f64,
    /// Rotor inertia at the motor shaft, kg m².
    pub rotor_inertia: f64,
    /// No-load friction at the motor shaft, Nm.
    pub friction_torque: f64,
    /// Proportional gain, duty per rad/s at the wheel.
    pub kp: f64,
    /// Integral gain, duty per rad at the wheel.
    pub ki: f64,
    /// Whether the loop is tuned gently.
    pub gentle: bool,
}

impl Robot {
    /// The robot of the example sets.
    #[must_use]
    pub fn standard() -> Self {
        Self {
            wheel_radius_m: 0.0275,
            layout: Layout::Circle(0.085),
            mass_kg: 2.4,
            yaw_inertia_kg_m2: 0.0095,
            gear_ratio: 3.71,
            gear_efficiency: 0.88,
            counts_per_rev: 2048,
            supply_v: 7.2,
            control_rate_hz: 1000.0,
            camera_rate_hz: 60.0,
            camera_latency_s: None,
            camera_noise: None,
            ref_quantum: 0.01,
            duty_quantum: 0.001,
            quanta_stated: false,
            blocks: false,
            wheel_inertia_kg_m2: None,
            resistance_ohm: 1.94,
            torque_constant: 0.00692,
            rotor_inertia: 2.7e-7,
            friction_torque: 0.00015,
            kp: 0.15,
            ki: 0.8,
            gentle: false,
        }
    }

    /// Every wheel's nominal place.
    #[must_use]
    pub fn mounts(&self) -> Vec<Mount> {
        match &self.layout {
            Layout::Circle(radius) => {
                [90.0_f64, 210.0, 330.0].map(|spoke| Mount::on_circle(spoke.to_radians(), *radius, 0.0)).to_vec()
            }
            Layout::Listed(mounts) => mounts.clone(),
        }
    }

    /// Wheel-speed quantum of a one-tick difference, rad/s at the wheel: `2π·rate / (counts·gear)`.
    #[must_use]
    pub fn speed_quantum(&self) -> f64 {
        std::f64::consts::TAU * self.control_rate_hz / (f64::from(self.counts_per_rev) * self.gear_ratio)
    }

    /// Tunes the loop gently: 0.3 of the usual proportional gain, unless that is done already.
    pub(crate) fn soften(&mut self) {
        if !self.gentle {
            self.gentle = true;
            self.kp = (self.kp * 300.0).round() / 1000.0;
        }
    }

    /// The file `robot.toml`.
    #[must_use]
    pub fn to_toml(&self) -> String {
        let mut out = String::from("# Nominal robot parameters (what the designers know). SI units.\n");
        line(&mut out, "wheel_radius_m", self.wheel_radius_m);
        if let Layout::Circle(radius) = self.layout {
            line(&mut out, "body_radius_m", radius);
            out.push_str("skew_rad = [0.0, 0.0, 0.0]\n");
        }
        line(&mut out, "mass_kg", self.mass_kg);
        line(&mut out, "yaw_inertia_kg_m2", self.yaw_inertia_kg_m2);
        line(&mut out, "gear_ratio", self.gear_ratio);
        line(&mut out, "gear_efficiency", self.gear_efficiency);
        let _ = writeln!(out, "encoder_counts_per_motor_rev = {}", self.counts_per_rev);
        line(&mut out, "supply_v", self.supply_v);
        line(&mut out, "control_rate_hz", self.control_rate_hz);
        line(&mut out, "camera_rate_hz", self.camera_rate_hz);
        if let Some(latency) = self.camera_latency_s {
            line(&mut out, "camera_latency_s", latency);
        }
        if let Some(noise) = self.camera_noise {
            let [x, y, theta] = noise.map(|sd| (sd * 1.0e4).round() / 1.0e4);
            let _ = writeln!(out, "camera_noise = [{x:?}, {y:?}, {theta:?}]");
        }
        if self.quanta_stated {
            line(&mut out, "ref_quantum", self.ref_quantum);
            line(&mut out, "duty_quantum", self.duty_quantum);
        }
        if self.blocks {
            out.push_str("support = \"blocks\"\n");
        }
        if let Some(inertia) = self.wheel_inertia_kg_m2 {
            line(&mut out, "wheel_inertia_kg_m2", inertia);
        }
        out.push_str("\n[motor]\n");
        line(&mut out, "resistance_ohm", self.resistance_ohm);
        line(&mut out, "torque_constant", self.torque_constant);
        line(&mut out, "rotor_inertia", self.rotor_inertia);
        line(&mut out, "friction_torque", self.friction_torque);
        let _ = write!(
            out,
            "\n[pi]\n\
             # Per axis and tick: w = (enc - enc before) * rate * 2*pi / (counts * gear_ratio); e = ref - w;\n\
             # t = I + ki*e/rate; keep I if |kp*e+t| > 1 and e*(kp*e+t) > 0, else I = t;\n\
             # duty = clip(kp*e + I, -1, 1), rounded to {:?}; applied until the next tick\n",
            self.duty_quantum
        );
        line(&mut out, "kp", self.kp);
        line(&mut out, "ki", self.ki);
        if let Layout::Listed(mounts) = &self.layout {
            for mount in mounts {
                out.push_str("\n[[wheel]]\n");
                line(&mut out, "x_m", mount.x_m);
                line(&mut out, "y_m", mount.y_m);
                line(&mut out, "drive_rad", mount.drive_rad);
                line(&mut out, "roller_rad", mount.roller_rad);
            }
        }
        out
    }
}

/// One `key = value`; floats always carry a point or an exponent, as TOML wants them.
fn line(out: &mut String, key: &str, value: f64) {
    let _ = writeln!(out, "{key} = {value:?}");
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_standard_robot_has_the_known_speed_quantum() {
        assert!((Robot::standard().speed_quantum() - 0.827).abs() < 0.001);
    }

    #[test]
    fn toml_lists_what_is_stated_and_nothing_else() {
        let mut robot = Robot::standard();
        let text = robot.to_toml();
        assert!(text.contains("body_radius_m = 0.085\n") && text.contains("rotor_inertia = 2.7e-7\n"));
        assert!(!text.contains("camera_latency_s") && !text.contains("support") && !text.contains("[[wheel]]"));
        robot.layout = Layout::Listed(robot.mounts());
        robot.blocks = true;
        let text = robot.to_toml();
        assert_eq!(text.matches("[[wheel]]").count(), 3);
        assert!(text.contains("support = \"blocks\"") && !text.contains("body_radius_m"));
    }
}
