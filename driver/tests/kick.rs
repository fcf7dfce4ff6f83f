//! A kick over a bit-true card.

mod treadmill;

use driver::drive::{Kick, KickError, Kicked};
use driver::realtime::Clock;
use driver::{Board, BusError, Registers, Scale, Settings};
use fixed_kin::registers as map;
use runs::robot::Robot;
use std::sync::atomic::AtomicBool;
use std::time::Duration;
use treadmill::{CLOCK_HZ, Treadmill};

/// A bus on which so many of the status words after the request to fire are read as zero.
struct Misread {
    card: Treadmill,
    left: usize,
    fired: bool,
}

impl Registers for Misread {
    fn read(&mut self, offset: u16) -> Result<u32, BusError> {
        let word = self.card.read(offset)?;
        if offset == map::STATUS.offset && self.fired && self.left > 0 {
            self.left -= 1;
            return Ok(0);
        }
        Ok(word)
    }

    fn write(&mut self, offset: u16, data: u32) -> Result<(), BusError> {
        self.fired |= offset == map::KICKER_FIRE.offset;
        self.card.write(offset, data)
    }
}

fn kicked(misread: usize) -> (Treadmill, Result<Kicked, KickError>) {
    let (mut card, never) = (Treadmill::new(), AtomicBool::new(false));
    // The card sees its pins at its first tick.
    card.sleep_until(Duration::from_millis(2));
    let board = Board::new(Misread { card: card.clone(), left: misread, fired: false });
    let scale = Scale::new(&Robot::racbot(), CLOCK_HZ).unwrap();
    let kick = Kick { pulse_us: 1_000, charge_s: 0.0 };
    let result = kick.kick(board, &mut card.clone(), &scale, &Settings::default(), &never);
    (card, result)
}

#[test]
fn one_misread_status_does_not_call_a_kick_off() {
    for misread in [0, 1] {
        let (card, kicked) = kicked(misread);
        assert!(kicked.is_ok() && !card.armed(), "{misread}: {kicked:?}");
    }
    let (card, kicked) = kicked(2);
    assert!(matches!(kicked, Err(KickError::Disarmed(_))) && !card.armed(), "{kicked:?}");
}
