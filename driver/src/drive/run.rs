//! The loop.

use super::{Controller, DriveError, Driven, Ending, Plan, PoseSource, Session};
use crate::realtime::Clock;
use crate::recording::Recording;
use crate::{Board, Registers};
use std::sync::atomic::{AtomicBool, Ordering};

impl Plan {
    /// Drives until the robot rests at the end, has given up, is stopped, or something is wrong.
    ///
    /// # Errors
    /// [`DriveError`] where nothing has moved yet: the card is not ours, cannot be configured or armed.
    pub fn drive<R: Registers>(
        &self,
        board: Board<R>,
        clock: &mut impl Clock,
        clock_hz: f64,
        source: &mut impl PoseSource,
        mut recording: Option<&mut Recording>,
        stop: &AtomicBool,
    ) -> Result<Driven, DriveError> {
        let scale = self.scale(clock_hz)?;
        let steer = Controller::new(self.control, &self.believed(), &self.set_points, self.start)?;
        let mut session = Session::begin(self, scale, steer, board, clock)?;
        let ending = loop {
            session.wait(clock);
            if stop.load(Ordering::Relaxed) {
                break Ending::Stopped;
            }
            if let Some(ending) = session.tick(clock, source, recording.as_deref_mut()) {
                break ending;
            }
        };
        Ok(session.end(ending))
    }
}
