//! A wheel on blocks beyond the play of its gear: rotor and wheel are two bodies, and one while a flank carries.

use super::{WheelDeviation, WheelState, friction};
use crate::motor::Axis;

/// Rotor and wheel of one axis, and what each has.
#[derive(Debug, Clone, Copy)]
pub(super) struct Play {
    /// Half the play, rad at the wheel.
    half: f64,
    /// Dry friction on the wheel's side, Nm: a part of what there is.
    load_friction_nm: f64,
}

impl Play {
    /// That of a wheel whose gear has one; none of a wheel without inertia of its own, which has nothing to coast by.
    pub(super) fn of(deviation: &WheelDeviation, axis: &Axis, gear_ratio: f64) -> Option<Self> {
        let WheelDeviation { play_rad, load_friction_nm, .. } = *deviation;
        (play_rad > 0.0 && axis.load_inertia > 0.0)
            .then_some(Self { half: 0.5 * play_rad / gear_ratio, load_friction_nm })
    }

    /// One step of an axis; `together` is that of one body.
    pub(super) fn step(self, wheel: &mut WheelState, axis: &Axis, h: f64, together: impl Fn(&mut WheelState)) {
        let limit = wheel.friction_limit(axis);
        let of_wheel = self.load_friction_nm.min(limit);
        let of_rotor = limit - of_wheel;
        let flank = wheel.ahead.signum();
        if wheel.ahead.abs() >= self.half {
            let mut one = *wheel;
            together(&mut one);
            // What the flank passes on to the wheel; of one that stands the rotor goes when nothing holds it.
            let acceleration = (one.speed - wheel.speed) / h;
            let passed = axis.load_inertia * acceleration - wheel.load + of_wheel * one.speed.signum();
            let leaves = if one.speed == 0.0 { -flank * wheel.drive > of_rotor } else { passed * flank < 0.0 };
            if !leaves {
                one.rotor_speed = one.speed;
                *wheel = one;
                return;
            }
        }
        let (rotor, speed) = (wheel.rotor_speed, wheel.speed);
        let (own, load) = (axis.rotor_inertia / h, axis.load_inertia / h);
        wheel.rotor_speed = friction::soft(own * rotor + wheel.drive, of_rotor) / (own + axis.damping);
        wheel.speed = friction::soft(load * speed + wheel.load, of_wheel) / load;
        wheel.angle += 0.5 * h * (speed + wheel.speed);
        wheel.ahead += 0.5 * h * (rotor + wheel.rotor_speed - speed - wheel.speed);
        (wheel.transmitted, wheel.friction) = (0.0, 0.0);
        if wheel.ahead.abs() >= self.half {
            // The flanks meet, and stay together.
            wheel.ahead = self.half.copysign(wheel.ahead);
            wheel.speed = (own * wheel.rotor_speed + load * wheel.speed) / (own + load);
            wheel.rotor_speed = wheel.speed;
        }
    }
}
