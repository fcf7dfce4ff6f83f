//! Charging and firing the solenoid kicker.

#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_possible_wrap,
    reason = "checked against the register before"
)]

use super::Armed;
use crate::realtime::{Clock, Timer};
use crate::{Board, BoardError, Registers, Scale, Settings, Standing};
use fixed_kin::kicker::{MAXIMUM_PULSE_US, State};
use fixed_kin::registers as map;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// How often the watchdog is petted meanwhile.
const PERIOD: Duration = Duration::from_millis(5);
/// Time from the request to the end of the pulse beyond the pulse itself.
const SLACK: Duration = Duration::from_millis(20);
/// Charging stops by itself after what was asked for and so much, s.
const CHARGE_SLACK_S: f64 = 0.1;

/// What to do with the kicker.
#[derive(Clone, Copy, Debug)]
pub struct Kick {
    /// Trigger pulse, µs, 1 to [`MAXIMUM_PULSE_US`].
    pub pulse_us: u16,
    /// Time to charge before, s, up to 16.
    pub charge_s: f64,
}

/// A kick that did not happen.
#[derive(Debug, thiserror::Error)]
pub enum KickError {
    /// A transfer to the card failed.
    #[error(transparent)]
    Board(#[from] BoardError),
    /// A pulse that cannot be.
    #[error("a pulse of {0} µs is not between 1 and {MAXIMUM_PULSE_US}")]
    Pulse(u16),
    /// A time that cannot be.
    #[error("{0} s to charge are not between 0 and 16")]
    Charge(f64),
    /// The card switched off while charging.
    #[error("the card switched off before the kick: {0}")]
    Disarmed(String),
    /// The kicker does not take the request.
    #[error("the kicker is not ready, {0}; wait for the lock-out, then kick again")]
    NotReady(&'static str),
    /// The request went unheard.
    #[error("the kicker did not fire: {0}")]
    NoPulse(&'static str),
    /// Somebody asked to stop.
    #[error("stopped before the kick; the kicker is off")]
    Stopped,
}

/// A kick that happened.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Kicked {
    /// From the request until the kicker was seen to fire or to have fired.
    pub after: Duration,
    /// Charging ran into its time-out.
    pub charge_timed_out: bool,
    /// What stood in the card's sticky registers before it was armed, and was cleared.
    pub stood: Standing,
}

impl Kick {
    /// Charges and fires; wheels stand still, and the card is disarmed afterwards, whatever happens.
    ///
    /// # Errors
    /// [`KickError`]; charging is then off and the card disarmed.
    pub fn kick<R: Registers>(
        &self,
        mut board: Board<R>,
        clock: &mut impl Clock,
        scale: &Scale,
        settings: &Settings,
        stop: &AtomicBool,
    ) -> Result<Kicked, KickError> {
        if !(1..=MAXIMUM_PULSE_US).contains(&self.pulse_us) {
            return Err(KickError::Pulse(self.pulse_us));
        }
        if !(0.0..=16.0).contains(&self.charge_s) {
            return Err(KickError::Charge(self.charge_s));
        }
        board.identify()?;
        board.configure(scale, settings)?;
        board.write_checked(&map::KICKER_CONTROL, 0)?;
        board.set_charge_timeout(self.charge_s + CHARGE_SLACK_S)?;
        board.write_checked(&map::KICKER_PULSE, self.pulse_us.into())?;
        let (mut armed, stood) = Armed::new(board)?;
        let result = self.charged(&mut armed, clock, scale, stop);
        // Disarming takes the charger down too; this keeps the next arming from starting it.
        let charger_off = armed.write_checked(&map::KICKER_CONTROL, 0);
        armed.disarm()?;
        let kicked = result?;
        charger_off?;
        Ok(Kicked { stood, ..kicked })
    }

    fn charged<R: Registers>(
        &self,
        armed: &mut Armed<R>,
        clock: &mut impl Clock,
        scale: &Scale,
        stop: &AtomicBool,
    ) -> Result<Kicked, KickError> {
        let charges = self.charge_s > 0.0;
        armed.write_checked(&map::KICKER_CONTROL, map::KICKER_CHARGE.place(charges.into()))?;
        let mut timer = Timer::new(PERIOD, clock);
        let until = clock.now() + Duration::from_secs_f64(self.charge_s);
        let mut pet = |armed: &mut Armed<R>, clock: &mut _| -> Result<u32, KickError> {
            timer.wait(clock);
            if stop.load(Ordering::Relaxed) {
                return Err(KickError::Stopped);
            }
            armed.set_twist(scale, runs::frames::Twist::default())?;
            if armed.status()?.armed || armed.status()?.armed {
                return Ok(armed.bus.read(map::KICKER_STATUS.offset).map_err(BoardError::from)?);
            }
            Err(KickError::Disarmed(crate::fault_names(armed.first_fault()?)))
        };
        while clock.now() < until {
            pet(armed, clock)?;
        }
        armed.write_checked(&map::KICKER_CONTROL, 0)?;
        let ready = pet(armed, clock)?;
        if map::KICKER_READY.of(ready) == 0 {
            return Err(KickError::NotReady(state_name(ready)));
        }
        let charge_timed_out = map::KICKER_TIMED_OUT.of(ready) == 1;
        let asked = clock.now();
        armed.bus.write(map::KICKER_FIRE.offset, map::KICKER_FIRE_WORD).map_err(BoardError::from)?;
        let patience = asked + Duration::from_micros(self.pulse_us.into()) + SLACK;
        loop {
            let status = pet(armed, clock)?;
            if map::KICKER_STATE.of(status) >= u32::from(State::Pulse as u8) {
                let after = clock.now().saturating_sub(asked);
                // The pulse must end before the card is disarmed, else it is cut short.
                while map::KICKER_STATE.of(pet(armed, clock)?) == u32::from(State::Pulse as u8) {}
                return Ok(Kicked { after, charge_timed_out, stood: Standing::default() });
            }
            if map::KICKER_DROPPED.of(status) == 1 {
                return Err(KickError::NoPulse("the request came while it was locked out"));
            }
            if clock.now() > patience {
                return Err(KickError::NoPulse("the request was lost on the bus"));
            }
        }
    }
}

fn state_name(status: u32) -> &'static str {
    match map::KICKER_STATE.of(status) {
        0 => "off",
        1 => "idle without a pulse set",
        2 => "already pending",
        3 => "firing",
        4 => "in commutation",
        _ => "locked out",
    }
}
