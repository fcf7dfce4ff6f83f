//! Kicks over the card's kicker: charged while armed, fired by the ball sensor.

use crate::pilot::Kick;
use driver::{Board, BusError, Registers};
use fixed_kin::kicker::{MAXIMUM_PULSE_US, State};
use fixed_kin::registers as map;

/// Speed of the ball by length of the trigger pulse, m/s per second. A solenoid's force is about constant over its
/// stroke, so speed grows with the time of the pulse; the slope is one that makes 1 ms 1 m/s, and a robot's own is
/// measured with a camera.
pub const SPEED_PER_PULSE: f64 = 1000.0;

/// Fastest kick, m/s: the longest pulse of the card.
#[must_use]
pub fn fastest() -> f64 {
    SPEED_PER_PULSE * 1e-6 * f64::from(MAXIMUM_PULSE_US)
}

/// What keeps the kicker's registers in step with what is asked for. Writes only what changes.
#[derive(Clone, Copy, Debug, Default)]
pub struct Trigger {
    control: Option<u32>,
    pulse_us: Option<u32>,
    state: u32,
    asked: Option<Kick>,
}

impl Trigger {
    /// One tick: charges, and kicks at the ball where a kick is asked for. The kick whose pulse ended in this tick.
    ///
    /// # Errors
    /// A bus that fails.
    pub fn tick<R: Registers>(&mut self, board: &mut Board<R>, asked: Option<Kick>) -> Result<Option<Kick>, BusError> {
        let status = board.bus.read(map::KICKER_STATUS.offset)?;
        let before = std::mem::replace(&mut self.state, map::KICKER_STATE.of(status));
        let over = |state: u32| state >= State::Commutation as u32;
        let kicked = (over(self.state) && !over(before)).then_some(self.asked).flatten();
        // The length of a pulse that runs is left alone.
        let free = self.state < State::Pending as u32;
        if let Some(kick) = asked.filter(|_| free) {
            let pulse = (kick.speed / SPEED_PER_PULSE * 1e6).round().clamp(1.0, f64::from(MAXIMUM_PULSE_US)) as u32;
            if self.pulse_us != Some(pulse) {
                board.bus.write(map::KICKER_PULSE.offset, pulse)?;
                self.pulse_us = Some(pulse);
            }
            self.asked = Some(kick);
        }
        // A shot that was had comes again only after the request fell and rose.
        let has_shot = map::KICKER_ON_BALL.of(status) == 1;
        let armed = self.control.is_some_and(|control| map::KICKER_ARM_ON_BALL.of(control) == 1);
        let arm = if free { asked.is_some() && (has_shot || !armed) } else { armed };
        let control = map::KICKER_CHARGE.place(1) | map::KICKER_ARM_ON_BALL.place(arm.into());
        if self.control != Some(control) {
            board.bus.write(map::KICKER_CONTROL.offset, control)?;
            self.control = Some(control);
        }
        Ok(kicked)
    }

    /// Whether the charger may run: asked to, and neither firing nor in commutation.
    #[must_use]
    pub fn charges(&self) -> bool {
        self.control.is_some() && [State::Ready as u32, State::Lockout as u32].contains(&self.state)
    }
}
