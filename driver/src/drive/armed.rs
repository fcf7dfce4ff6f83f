//! A card whose outputs may be on, for as long as somebody holds this.

use crate::{Board, BoardError, Registers, Standing};
use std::ops::{Deref, DerefMut};

/// An armed card. Dropped in any way, by a return, an error or a panic, it is disarmed.
#[derive(Debug)]
pub struct Armed<R: Registers>(Option<Board<R>>);

/// What a use of the board after its end would be; no path leads there.
const HELD: &str = "the board is here until the guard ends";

impl<R: Registers> Armed<R> {
    /// Arms a configured card; beside it, what stood in its sticky registers and was cleared.
    ///
    /// # Errors
    /// [`BoardError::Arm`] while a cause stands.
    pub fn new(board: Board<R>) -> Result<(Self, Standing), BoardError> {
        let mut armed = Self(Some(board));
        let stood = armed.arm()?;
        Ok((armed, stood))
    }

    /// Disarms, and says whether the card obeyed.
    ///
    /// # Errors
    /// A card that does not answer or does not disarm: its watchdog then does it.
    pub fn disarm(mut self) -> Result<Board<R>, BoardError> {
        let mut board = self.0.take().expect(HELD);
        board.disarm()?;
        Ok(board)
    }
}

impl<R: Registers> Deref for Armed<R> {
    type Target = Board<R>;

    fn deref(&self) -> &Board<R> {
        self.0.as_ref().expect(HELD)
    }
}

impl<R: Registers> DerefMut for Armed<R> {
    fn deref_mut(&mut self) -> &mut Board<R> {
        self.0.as_mut().expect(HELD)
    }
}

impl<R: Registers> Drop for Armed<R> {
    fn drop(&mut self) {
        if let Some(board) = &mut self.0 {
            // Nobody is left to hear of a failure; the watchdog is the second way.
            let _ = board.disarm();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Scale, Settings};
    use fixed_kin::card::{Card, Pins};
    use runs::robot::Robot;
    use std::panic::{AssertUnwindSafe, catch_unwind};

    fn configured(card: &mut Card) -> Board<&mut Card> {
        let scale = Scale::new(&Robot::racbot(), 33_333_333.0).unwrap();
        let mut board = Board::new(card);
        board.configure(&scale, &Settings::default()).unwrap();
        board.bus.tick(&Pins::default());
        board
    }

    #[test]
    fn the_outputs_are_off_after_a_return_a_drop_and_a_panic() {
        let mut card = Card::new(0);
        let (armed, _) = Armed::new(configured(&mut card)).unwrap();
        armed.disarm().unwrap();
        assert!(!card.armed());
        let (armed, _) = Armed::new(configured(&mut card)).unwrap();
        assert!(armed.bus.armed());
        drop(armed);
        assert!(!card.armed());
        let panicked = catch_unwind(AssertUnwindSafe(|| {
            let (armed, _) = Armed::new(configured(&mut card)).unwrap();
            assert!(!armed.bus.armed(), "on purpose");
        }));
        assert!(panicked.is_err() && !card.armed());
    }
}
