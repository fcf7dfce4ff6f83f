//! What a real robot does and its nominal model does not.

use std::f64::consts::TAU;

/// Everything by which a plant differs from its nominal model; all zero is the nominal model.
///
/// Equations, signs and units are those of the effects of the gap workflow, which bear the same names.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Deviations {
    /// Of each wheel; wheels beyond the end have none.
    pub wheels: Vec<WheelDeviation>,
    /// Place of the centre of mass in the body frame, m.
    pub centre_of_mass_m: [f64; 2],
    /// Its height over the floor, m: what an acceleration shifts from wheel to wheel where wheels may slip.
    pub centre_height_m: f64,
    /// Slope of the floor, downhill positive, along world x and y, rad.
    pub tilt_rad: [f64; 2],
    /// Friction of each contact in the direction its rollers roll in, N.
    pub roller_friction_n: f64,
    /// Drag on the body against the way it goes, N.
    pub drag_n: f64,
    /// Torque on the body against its turn, Nm.
    pub turning_nm: f64,
    /// Drag along one direction of the field only: force (N) and direction (rad, world).
    pub grain: [f64; 2],
    /// Friction of all wheels that changes with the heading.
    pub heading_drag: HeadingDrag,
    /// Friction at standstill beyond that in motion: torque (Nm) and the speed it falls with (rad/s).
    pub stribeck: [f64; 2],
    /// Duty of each wheel below which its bridge does nothing; wheels beyond the end have none.
    pub dead_band: Vec<f64>,
    /// Whether duties above that pass whole instead of less what is swallowed.
    pub dead_band_passes: bool,
    /// Duty u acts as u (1 + curvature (|u| − 1)).
    pub curvature: f64,
    /// Share of the time between pulses in which the bridge is open, and nothing brakes.
    pub coasting: f64,
    /// Current of each motor at most, A; 0 for no limit.
    pub current_limit_a: f64,
    /// Voltage that each bridge takes off against its current, V.
    pub bridge_drop_v: f64,
    /// Age of the duty that acts, s.
    pub duty_delay_s: f64,
    /// Supply: what it lacks at no load (V), and its resistance (Ω).
    pub battery: [f64; 2],
    /// By how much the supply falls, V/s.
    pub supply_fall_v_per_s: f64,
    /// Winding resistance: relative rise at full duty for long, and time constant (s).
    pub heating: [f64; 2],
    /// Ripples of the wheel radius in one turn of the wheel.
    pub ripple_order: f64,
    /// Wheel speed above which counts are lost, rad/s.
    pub loss_threshold: f64,
    /// Age of the counts that are read, s.
    pub encoder_delay_s: f64,
    /// Time constant of a low-pass on what the encoders read, s.
    pub encoder_filter_s: f64,
}

/// What one wheel does beyond its nominal model.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct WheelDeviation {
    /// Radius, relative: 0.01 is 1 % larger.
    pub radius: f64,
    /// Amplitude of the radius' ripple, relative: cosine and sine of the wheel's angle times the order.
    pub ripple: [f64; 2],
    /// Torque and back-EMF constant of its motor, relative.
    pub torque_constant: f64,
    /// Resistance of its motor's circuit, relative.
    pub resistance: f64,
    /// Dry friction at the wheel shaft, Nm.
    pub dry_nm: f64,
    /// Dry friction while it turns backwards and forwards only, Nm.
    pub one_way_nm: [f64; 2],
    /// Viscous friction at the wheel shaft, Nm s/rad.
    pub viscous_nms: f64,
    /// Drag by the square of the speed at the wheel shaft, Nm s²/rad².
    pub quadratic_nms2: f64,
    /// Torque at the wheel shaft with sine and cosine of the wheel's angle, Nm.
    pub gravity_nm: [f64; 2],
    /// What its encoder reads ahead with sine and cosine of `order` times the wheel's angle, rad, and that order.
    pub eccentric_rad: [f64; 2],
    /// Turns of the encoder's shaft for one of the wheel.
    pub eccentric_order: f64,
    /// Stiffness of a spring on the wheel shaft, Nm/rad.
    pub spring_nm_per_rad: f64,
    /// Torque of that spring where the wheel's angle is 0, Nm.
    pub preload_nm: f64,
    /// Counts per wheel angle, relative.
    pub encoder: f64,
    /// Share of the counts lost above the threshold.
    pub loss: f64,
    /// Play between motor and wheel, rad at the motor shaft.
    pub play_rad: f64,
    /// Dry friction of the wheel beyond that play on blocks, Nm: a part of what there is.
    pub load_friction_nm: f64,
}

/// Friction torque mean + cos·cos(n θ) + sin·sin(n θ) at every wheel, θ the heading.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct HeadingDrag {
    /// n.
    pub harmonic: f64,
    /// Mean over all headings, Nm.
    pub mean_nm: f64,
    /// Amplitude with cos(n θ), Nm.
    pub cos_nm: f64,
    /// Amplitude with sin(n θ), Nm.
    pub sin_nm: f64,
}

impl Deviations {
    /// Of wheel `i`, from 0.
    pub fn wheel(&self, i: usize) -> WheelDeviation {
        self.wheels.get(i).copied().unwrap_or_default()
    }

    /// The same for changing, for a robot of `n` wheels.
    pub fn wheels_mut(&mut self, n: usize) -> &mut [WheelDeviation] {
        self.wheels.resize(n, WheelDeviation::default());
        &mut self.wheels
    }

    /// Radius of wheel `i` at an angle, relative to the nominal one.
    pub(super) fn radius(&self, i: usize, angle: f64) -> f64 {
        let w = self.wheel(i);
        let [a, b] = w.ripple;
        if a == 0.0 && b == 0.0 {
            return 1.0 + w.radius;
        }
        let (s, c) = (self.ripple_order * angle % TAU).sin_cos();
        (1.0 + w.radius) * (1.0 + a * c + b * s)
    }

    /// Whether the plant's matrices change while it moves.
    pub(super) fn is_changing(&self) -> bool {
        self.heating[0] != 0.0 || self.wheels.iter().any(|w| w.ripple != [0.0; 2])
    }

    /// Whether all of this is between duty and winding or between shaft and counts: no force of it changes within a tick.
    pub(super) fn are_steady(&self) -> bool {
        let electrical = Self {
            dead_band: self.dead_band.clone(),
            dead_band_passes: self.dead_band_passes,
            curvature: self.curvature,
            coasting: self.coasting,
            current_limit_a: self.current_limit_a,
            bridge_drop_v: self.bridge_drop_v,
            duty_delay_s: self.duty_delay_s,
            battery: self.battery,
            supply_fall_v_per_s: self.supply_fall_v_per_s,
            heating: self.heating,
            loss_threshold: self.loss_threshold,
            encoder_delay_s: self.encoder_delay_s,
            encoder_filter_s: self.encoder_filter_s,
            ..Self::default()
        };
        *self == electrical
    }

    /// Torque of what hangs on wheel `i` and of a spring on its shaft, Nm, at an angle.
    pub(super) fn at_angle(&self, i: usize, angle: f64) -> f64 {
        let w = self.wheel(i);
        let spring = w.preload_nm - w.spring_nm_per_rad * angle;
        let [a, b] = w.gravity_nm;
        if a == 0.0 && b == 0.0 {
            return spring;
        }
        let (s, c) = angle.sin_cos();
        spring + a * s + b * c
    }

    /// Friction torque of wheel `i` beyond nominal, Nm, at a speed and a heading; `push` says where it
    /// is about to turn if it stands.
    pub(super) fn friction(&self, i: usize, speed: f64, push: f64, heading: f64) -> f64 {
        let w = self.wheel(i);
        let forwards = if speed == 0.0 { push > 0.0 } else { speed > 0.0 };
        let [torque, fall] = self.stribeck;
        let standing = if torque == 0.0 { 0.0 } else { torque * (-(speed / fall).powi(2)).exp() };
        let h = &self.heading_drag;
        let (s, c) = (h.harmonic * heading).sin_cos();
        w.dry_nm + w.one_way_nm[usize::from(forwards)] + standing + h.mean_nm + h.cos_nm * c + h.sin_nm * s
    }
}
