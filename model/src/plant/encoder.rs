//! From wheel angles to what the encoders at the motor shafts count.

use std::collections::VecDeque;

use runs::robot::Support;

use super::Plant;
use super::play::Play;

/// One encoder with its gear.
#[derive(Debug, Clone, Default)]
pub(super) struct Encoder {
    /// Wheel angle of the last tick, or on blocks its rotor's, rad.
    angle: f64,
    /// What has been counted, rad at the wheel.
    counted: f64,
    /// Where the motor is in the play, rad at the motor shaft, and how fast it crosses it, rad/s.
    play: [f64; 2],
    /// What came through the low-pass, rad at the wheel.
    passed: f64,
    /// What was counted at the last ticks, newest last.
    past: VecDeque<f64>,
}

impl Plant {
    /// Wheel angle by encoder `i` after a tick of `dt`, rad.
    pub(super) fn read_encoder(&mut self, i: usize, dt: f64) -> f64 {
        let wheel = &self.wheels[i];
        let Some(d) = self.deviations.as_deref() else { return wheel.angle };
        let (w, e) = (d.wheel(i), &mut self.encoders[i]);
        let rotor = wheel.angle + wheel.ahead;
        let mut moved = rotor - e.angle;
        e.angle = rotor;
        let apart = self.support == Support::Blocks && Play::of(&w, &self.axes[i], self.gear_ratio).is_some();
        if w.play_rad > 0.0 && !apart {
            // The free rotor runs across the play until the other flank stops it.
            let (half, [at, speed]) = (0.5 * w.play_rad, e.play);
            let speed = speed + dt * wheel.transmitted / self.gear_ratio / self.rotor_inertia;
            let next = at + dt * speed;
            e.play = if next.abs() >= half { [half.copysign(next), 0.0] } else { [next, speed] };
            moved += (e.play[0] - at) / self.gear_ratio;
        }
        let kept = if wheel.speed.abs() > d.loss_threshold { 1.0 - w.loss } else { 1.0 };
        e.counted += moved * kept * (1.0 + w.encoder);
        let (sin, cos) = (w.eccentric_order * wheel.angle).sin_cos();
        // Counts begin at 0 wherever the shaft stands.
        let mut read = e.counted + w.eccentric_rad[0] * sin + w.eccentric_rad[1] * (cos - 1.0);
        if d.encoder_filter_s > 0.0 {
            e.passed += (read - e.passed) * -(-dt / d.encoder_filter_s).exp_m1();
            read = e.passed;
        }
        let ticks = d.encoder_delay_s / dt;
        if ticks <= 0.0 {
            return read;
        }
        let (whole, share) = (ticks.floor() as usize, ticks.fract());
        e.past.push_back(read);
        while e.past.len() > whole + 2 {
            e.past.pop_front();
        }
        let at = |age: usize| e.past.len().checked_sub(1 + age).map_or(0.0, |k| e.past[k]);
        (1.0 - share) * at(whole) + share * at(whole + 1)
    }
}
