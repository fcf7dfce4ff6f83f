//! The sender beside the field, for one robot.

use super::line::time_of;
use super::{Line, RadioError, boot};
use crate::realtime::Clock;
use crate::{Scale, Settings};
use fixed_kin::radio::{Frame, GAP_BYTES};
use runs::frames::Twist;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// Boot frames before a drive: nothing comes back over the radio, and one may be lost.
const BOOTS: usize = 3;
/// Time from frame to frame. The robot stands after 30 ms without one, and is off after 50 ms.
const PERIOD: Duration = Duration::from_millis(10);
/// Standstill before the outputs go off, so that the wheels brake.
const BRAKE: Duration = Duration::from_millis(500);

/// Sends a robot what a host on the bus would write.
#[derive(Debug)]
pub struct BaseStation<L> {
    line: L,
    robot: u8,
    sequence: u8,
    scale: Scale,
    settings: Settings,
}

/// Frames that went out in a drive.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Sent {
    /// Frames that configure and arm.
    pub boots: usize,
    /// Frames with a velocity.
    pub velocities: usize,
    /// Whether somebody stopped it before its end.
    pub stopped: bool,
}

impl<L: Line> BaseStation<L> {
    /// A station whose first frame has the number after `sequence`.
    pub fn new(line: L, robot: u8, sequence: u8, scale: Scale, settings: Settings) -> Self {
        Self { line, robot, sequence, scale, settings }
    }

    /// Configures and arms the robot, lets it follow a velocity over time (s since it was armed; `None` is the
    /// end), brings it to a standstill and switches it off; early once `stop` is set. Whatever goes wrong, the
    /// robot is off within its watchdog's time of the last frame.
    ///
    /// # Errors
    /// [`RadioError`].
    pub fn drive<C: Clock>(
        &mut self,
        clock: &mut C,
        velocity: impl Fn(f64) -> Option<Twist>,
        stop: &AtomicBool,
    ) -> Result<Sent, RadioError> {
        let mut sent = Sent::default();
        let begun = clock.now();
        let mut at = begun;
        for _ in 0..BOOTS {
            self.sequence = self.sequence.wrapping_add(1);
            let frame = boot(self.robot, self.sequence, &self.scale, &self.settings)?;
            at = self.send(clock, at, begun, frame)?;
            sent.boots += 1;
        }
        let armed = at;
        let mut braking_until = None;
        loop {
            let stopped = stop.load(Ordering::Relaxed);
            let wanted = velocity((at - armed).as_secs_f64()).filter(|_| !stopped && braking_until.is_none());
            if wanted.is_none() {
                sent.stopped |= stopped && braking_until.is_none();
                if at >= *braking_until.get_or_insert(at + BRAKE) {
                    break;
                }
            }
            let mut frame = self.frame()?;
            let [x, y, omega] = self.scale.twist_words(wanted.unwrap_or_default()).map(i32::cast_unsigned);
            frame.set_points([x, y, omega, 0])?;
            at = self.send(clock, at, begun, frame)?;
            sent.velocities += 1;
        }
        for _ in 0..BOOTS {
            let mut frame = self.frame()?;
            frame.disarm()?;
            at = self.send(clock, at, begun, frame)?;
        }
        Ok(sent)
    }

    fn frame(&mut self) -> Result<Frame, RadioError> {
        self.sequence = self.sequence.wrapping_add(1);
        Ok(Frame::new(self.robot, self.sequence)?)
    }

    /// Sends a frame at its time and gives that of the next one.
    fn send<C: Clock>(
        &mut self,
        clock: &mut C,
        at: Duration,
        begun: Duration,
        mut frame: Frame,
    ) -> Result<Duration, RadioError> {
        clock.sleep_until(at);
        let bytes = frame.bytes();
        let takes = time_of(bytes.len() + 2 * GAP_BYTES as usize);
        self.line.send(at - begun, bytes)?;
        // Late frames are not made up for: they would follow each other without a silence.
        Ok((at + PERIOD.max(takes)).max(clock.now()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fixed_kin::card::{Card, Pins};
    use runs::robot::Robot;
    use std::cell::RefCell;
    use std::io;
    use std::rc::Rc;

    const ROBOT: u8 = 6;

    /// A robot at the end of a line, and the time that both share.
    struct Far {
        card: Card,
        now: Duration,
        ticks: u64,
        heard: u32,
        /// Every so manieth frame is lost.
        lost: u32,
        armed_ms: usize,
        fastest: i32,
    }

    #[derive(Clone)]
    struct Shared(Rc<RefCell<Far>>);

    impl Shared {
        fn new(lost: u32) -> Self {
            let mut card = Card::slave(0, ROBOT);
            card.tick(&Pins::default());
            let (now, ticks, heard, armed_ms, fastest) = (Duration::ZERO, 0, 0, 0, 0);
            Self(Rc::new(RefCell::new(Far { card, now, ticks, heard, lost, armed_ms, fastest })))
        }
    }

    impl Clock for Shared {
        fn now(&mut self) -> Duration {
            self.0.borrow().now
        }

        fn sleep_until(&mut self, at: Duration) {
            let mut far = self.0.borrow_mut();
            far.now = far.now.max(at);
            while Duration::from_millis(far.ticks) < far.now {
                far.card.tick(&Pins::default());
                far.ticks += 1;
                far.armed_ms += usize::from(far.card.armed());
            }
        }
    }

    impl Line for Shared {
        fn send(&mut self, _: Duration, frame: &[u8]) -> io::Result<()> {
            let mut far = self.0.borrow_mut();
            far.heard += 1;
            if far.lost == 0 || far.heard % far.lost != 1 {
                far.card.receive(frame).map_err(|refusal| io::Error::other(format!("{refusal:?}")))?;
            }
            let velocity = far.card.read(fixed_kin::registers::ACTIVE_SET_POINTS.offset) as i32;
            far.fastest = far.fastest.max(velocity);
            Ok(())
        }
    }

    fn station(far: &Shared) -> BaseStation<Shared> {
        let scale = Scale::new(&Robot::racbot(), 33_333_333.0).unwrap();
        let settings = Settings { stall_duty: 1.0, ..Settings::default() };
        BaseStation::new(far.clone(), ROBOT, 200, scale, settings)
    }

    #[test]
    fn a_robot_is_armed_driven_and_switched_off_though_frames_are_lost() {
        let velocity = |t: f64| (t < 1.0).then_some(Twist { vx: 0.5, vy: 0.0, omega: 0.0 });
        for lost in [0, 4, 3] {
            let mut far = Shared::new(lost);
            let mut clock = far.clone();
            let sent = station(&far).drive(&mut clock, velocity, &AtomicBool::new(false)).unwrap();
            assert_eq!((sent.boots, sent.velocities, sent.stopped), (3, 150, false));
            let now = far.now();
            assert!(!far.0.borrow().card.armed(), "switched off by its last frames");
            let seen = far.0.borrow();
            let wanted = station(&far).scale.twist_words(velocity(0.0).unwrap())[0];
            assert_eq!(seen.fastest, wanted);
            assert!(seen.armed_ms > 1_450 && seen.armed_ms <= 1_600, "{} of {now:?}", seen.armed_ms);
        }
    }

    #[test]
    fn a_stop_brakes_and_switches_off() {
        let far = Shared::new(0);
        let mut clock = far.clone();
        let stop = AtomicBool::new(false);
        let velocity = |t: f64| {
            stop.store(t >= 0.3, Ordering::Relaxed);
            Some(Twist { vx: 0.5, vy: 0.0, omega: 0.0 })
        };
        let sent = station(&far).drive(&mut clock, velocity, &stop).unwrap();
        assert!(sent.stopped && (75..85).contains(&sent.velocities), "{sent:?}");
        assert!(!far.0.borrow().card.armed());
    }

    #[test]
    fn values_that_no_frame_takes_are_refused_before_anything_is_sent() {
        let far = Shared::new(0);
        let mut station = BaseStation { robot: 16, ..station(&far) };
        let error = station.drive(&mut far.clone(), |_| None, &AtomicBool::new(false)).unwrap_err();
        assert_eq!((error.to_string().as_str(), far.0.borrow().heard), ("there is no robot 16; they are 0 to 15", 0));
    }
}
