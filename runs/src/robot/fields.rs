//! The numbers of `robot.toml`: one row each, from which reading, checking and writing follow.

use super::Robot;

/// One number of the file.
pub(super) struct Field {
    /// Table it stands in: empty for the top, else `motor` or `pi`.
    pub(super) table: &'static str,
    /// Key within that table.
    pub(super) name: &'static str,
    /// What it means, for error messages and as a comment where the key does not carry its unit.
    pub(super) meaning: &'static str,
    /// Physical range.
    pub(super) range: Range,
    /// Whether it may be left out; [`BODY`] may be on blocks.
    pub(super) optional: bool,
    /// `None` where the file need not say it.
    pub(super) get: fn(&Robot) -> Option<f64>,
    /// Called with a number in range.
    pub(super) set: fn(&mut Robot, f64),
}

impl Field {
    /// How messages and [`Robot::missing`] call it.
    pub(super) fn path(&self) -> String {
        if self.table.is_empty() { self.name.to_owned() } else { format!("{}.{}", self.table, self.name) }
    }
}

/// Another way to write a number of the file.
pub(super) struct Synonym {
    /// Key, at the top of the file.
    pub(super) name: &'static str,
    /// The number it stands for.
    pub(super) of: &'static str,
    /// What a reader of the file is told of it.
    pub(super) meaning: &'static str,
    /// Its value from that of the key.
    pub(super) value: fn(&Robot, f64) -> f64,
}

/// All of them; the gear ratio is known when they are read.
pub(super) const SYNONYMS: &[Synonym] = &[
    Synonym {
        name: "encoder_counts_per_wheel_rev",
        of: "encoder_counts_per_motor_rev",
        meaning: "counts per turn of the output shaft",
        value: |robot, x| x / robot.gear_ratio,
    },
    Synonym {
        name: "travel_per_rev_m",
        of: "wheel_radius_m",
        meaning: "metres that one turn of the output shaft moves",
        value: |_, x| x / std::f64::consts::TAU,
    },
];

/// Which numbers make physical sense.
#[derive(Clone, Copy)]
pub(super) enum Range {
    /// 0 < x ≤ limit.
    Positive(f64),
    /// 0 ≤ x ≤ limit.
    NotNegative(f64),
    /// |x| ≤ limit.
    Within(f64),
}

impl Range {
    /// What is wrong with `x`, if anything.
    pub(super) fn fault(self, x: f64) -> Option<String> {
        if !x.is_finite() {
            return Some(format!("{x} is not a finite number"));
        }
        let (low, high, limit) = match self {
            Self::Positive(limit) => (x <= 0.0, x > limit, limit),
            Self::NotNegative(limit) => (x < 0.0, x > limit, limit),
            Self::Within(limit) => (false, x.abs() > limit, limit),
        };
        match self {
            Self::Positive(_) if low => Some(format!("{x} is not positive")),
            Self::NotNegative(_) if low => Some(format!("{x} is negative")),
            Self::Within(_) if high => Some(format!("{x} is not within ±{limit}")),
            _ if high => Some(format!("{x} is more than {limit}")),
            _ => None,
        }
    }
}

macro_rules! field {
    ($table:literal, $name:ident, $range:expr, $meaning:literal, $($place:ident).+) => {
        Field {
            table: $table,
            name: stringify!($name),
            meaning: $meaning,
            range: $range,
            optional: false,
            get: |r| Some(r.$($place).+),
            set: |r, x| r.$($place).+ = x,
        }
    };
    ($table:literal, $name:ident = $default:literal, $range:expr, $meaning:literal) => {
        Field {
            table: $table,
            name: stringify!($name),
            meaning: $meaning,
            range: $range,
            optional: true,
            get: |r| (r.$name != $default).then_some(r.$name),
            set: |r, x| r.$name = x,
        }
    };
    ($table:literal, $name:ident?, $range:expr, $meaning:literal, $($place:ident).+) => {
        Field {
            table: $table,
            name: stringify!($name),
            meaning: $meaning,
            range: $range,
            optional: true,
            get: |r| r.$($place).+,
            set: |r, x| r.$($place).+ = Some(x),
        }
    };
}

use Range::{NotNegative, Positive};

/// What nobody needs to know of a robot whose wheels are off the floor.
pub(super) const BODY: [&str; 2] = ["mass_kg", "yaw_inertia_kg_m2"];

/// All numbers, in the order of the file.
pub(super) const FIELDS: &[Field] = &[
    field!("", wheel_radius_m, Positive(10.0), "wheel radius in metres", wheel_radius_m),
    field!("", mass_kg, Positive(1e5), "mass of the whole robot in kilograms", mass_kg),
    field!("", yaw_inertia_kg_m2, Positive(1e6), "moment of inertia about the vertical in kg m2", yaw_inertia_kg_m2),
    field!("", gear_ratio, Positive(1e4), "motor turns per wheel turn", gear_ratio),
    field!("", gear_efficiency = 1.0, Positive(1.0), "share of torque the gear passes on"),
    field!(
        "",
        encoder_counts_per_motor_rev,
        Positive(1e15),
        "counts per turn of the motor shaft, four per encoder line (or encoder_counts_per_wheel_rev)",
        encoder_counts_per_motor_rev
    ),
    field!("", supply_v, Positive(1e3), "motor supply in volts", supply_v),
    field!("", top_speed_rad_s?, Positive(1e5), "fastest turn of a wheel in rad/s", top_speed_rad_s),
    field!("", control_rate_hz, Positive(1e6), "control ticks a second", control_rate_hz),
    Field {
        optional: true,
        get: |r| (r.camera_rate_hz > 0.0).then_some(r.camera_rate_hz),
        ..field!("", camera_rate_hz, Positive(1e5), "camera frames a second", camera_rate_hz)
    },
    field!("", camera_latency_s = 0.0, NotNegative(2.0), "camera delay in seconds"),
    field!("", ref_quantum?, Positive(1e3), "rounding of logged set points in rad/s", ref_quantum),
    field!("", duty_quantum?, Positive(1.0), "rounding of logged duties", duty_quantum),
    field!("", wheel_inertia_kg_m2 = 0.0, NotNegative(1e5), "load inertia at a wheel shaft in kg m2"),
    field!("motor", resistance_ohm, Positive(1e4), "terminal resistance", motor.resistance_ohm),
    field!("motor", torque_constant, Positive(1e4), "Nm/A", motor.torque_constant),
    field!("motor", back_emf_constant?, NotNegative(1e2), "V s/rad", motor.back_emf_constant),
    field!("motor", rotor_inertia, NotNegative(1e5), "kg m2, at the motor shaft", motor.rotor_inertia),
    field!("motor", friction_torque, NotNegative(1e4), "Nm, at the motor shaft", motor.friction_torque),
    field!("pi", kp, NotNegative(1e6), "duty per (rad/s) at the wheel", pi.kp),
    field!("pi", ki, NotNegative(1e6), "duty per rad at the wheel", pi.ki),
];
