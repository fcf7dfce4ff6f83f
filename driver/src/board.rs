//! The card as a robot's motion controller: identify, configure, arm, command, read.

#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_possible_wrap,
    reason = "words are raw bits; numbers are clamped to their register just before"
)]

mod error;
mod state;

pub use error::BoardError;
pub use state::{Identity, Settings, Snapshot, Standing, Status, fault_names};

use crate::registers::{BusError, Registers};
use crate::scale::Scale;
use fixed_kin::AXES;
use fixed_kin::control::{SET_POINT_WORDS, SetPointMode};
use fixed_kin::format::Speed;
use fixed_kin::imu_spi::SNAPSHOT_IMU_WORDS;
use fixed_kin::registers as map;
use fixed_kin::safety::{ARM_FIRST, ARM_SECOND};
use fixed_kin::speed::SpeedMode;
use runs::frames::Twist;

/// A card behind some bus.
#[derive(Debug)]
pub struct Board<R> {
    /// The bus; direct access is for tests and for the registers that have no method here.
    pub bus: R,
}

/// Tries before a snapshot or commit is given up.
const TRIES: u32 = 3;
/// Tries to switch off before the card's watchdog is left to do it. An access takes about a microsecond, so that a
/// bus that fails for 0.1 ms delays nothing; the watchdog would take 50 ms. Measured by the fault campaign.
const DISARM_TRIES: u32 = 100;
/// Looks at a tick that should come, a control period apart.
const LOOKS: u32 = 20;

impl<R: Registers> Board<R> {
    /// A board on this bus; nothing is touched yet.
    pub fn new(bus: R) -> Self {
        Self { bus }
    }

    /// Reads and checks the identification, on any board that a top module is written for.
    ///
    /// # Errors
    /// [`BoardError::Identity`] for another design, map or an unknown board.
    pub fn identify(&mut self) -> Result<Identity, BoardError> {
        self.identify_on(&map::BOARDS)
    }

    /// As [`Self::identify`], where only one board makes sense: the card behind a PCI bridge, say.
    ///
    /// # Errors
    /// [`BoardError::Identity`] for another design, map or board.
    pub fn identify_as(&mut self, board: map::Target) -> Result<Identity, BoardError> {
        self.identify_on(&[board])
    }

    fn identify_on(&mut self, boards: &[map::Target]) -> Result<Identity, BoardError> {
        self.expect(
            &map::COOKIE,
            map::COOKIE_VALUE,
            u32::MAX,
            "no racbot design is loaded; all ones is an absent card",
        )?;
        let found = self.bus.read(map::BOARD.offset)?;
        let Some(board) = boards.iter().copied().find(|board| board.word == found) else {
            let expected = boards.first().map_or(0, |board| board.word);
            let (register, hint) = (map::BOARD.name, "the bitstream drives the pins of another board");
            return Err(BoardError::Identity { register, found, expected, hint });
        };
        self.expect(&map::MAP_VERSION, map::VERSION, 0xFFFF_0000, "the register map has another major version")?;
        Ok(Identity {
            version: self.bus.read(map::MAP_VERSION.offset)?,
            content_hash: self.bus.read(map::CONTENT_HASH.offset)?,
            axes: self.bus.read(map::AXIS_COUNT.offset)?,
            board,
            clock_hz: self.bus.read(map::CLOCK_HZ.offset)?,
        })
    }

    fn expect(
        &mut self,
        register: &map::Register,
        expected: u32,
        mask: u32,
        hint: &'static str,
    ) -> Result<(), BoardError> {
        let found = self.bus.read(register.offset)?;
        if (found ^ expected) & mask == 0 {
            return Ok(());
        }
        Err(BoardError::Identity { register: register.name, found, expected, hint })
    }

    /// Disarms and writes everything a robot needs, reading back what can be read.
    ///
    /// # Errors
    /// A bus or commit that fails, or a register that does not take its value.
    pub fn configure(&mut self, scale: &Scale, settings: &Settings) -> Result<(), BoardError> {
        self.disarm()?;
        let clocks = |seconds: f64| (seconds * scale.clock_hz).round().clamp(0.0, 16_777_215.0) as u32;
        let mode = map::MODE_COUNT_AND_TIME.place(u32::from(settings.speed_mode == SpeedMode::CountAndTime))
            | map::MODE_TWIST.place(u32::from(settings.set_point_mode == SetPointMode::Twist))
            | map::MODE_ODOMETRY.place(u32::from(settings.odometry && scale.has_odometry()))
            | map::MODE_UP_DOWN.place(u32::from(settings.up_down));
        let ticks = |seconds: f64, least: f64| (seconds / scale.tick_s()).ceil().clamp(least, 65_535.0) as u32;
        let pwm_period = scale.pwm_period(settings.pwm_hz);
        let stall_compare = if settings.stall_duty < 1.0 {
            (settings.stall_duty.max(0.0) * f64::from(pwm_period)).round() as u32
        } else {
            8_191
        };
        let per_microsecond = (scale.clock_hz / 1e6).round().clamp(1.0, 63.0) as u32;
        for (register, value) in [
            (&map::TICK_PERIOD, scale.tick_period),
            (&map::MODE, mode),
            (&map::PWM_PERIOD, pwm_period),
            (&map::WATCHDOG_TIMEOUT, clocks(settings.watchdog_s)),
            (&map::CLOCKS_PER_MICROSECOND, per_microsecond),
            (&map::SET_POINT_TIMEOUT, ticks(settings.set_point_s, 5.0)),
            (&map::STALL_WINDOW, ticks(settings.stall_s, 1.0)),
            (&map::STALL_COMPARE, stall_compare),
        ] {
            self.write_checked(register, value)?;
        }
        if settings.kicker_charge_s > 0.0 {
            self.set_charge_timeout(settings.kicker_charge_s.min(16.0))?;
        }
        let words = scale.configuration().to_words().map(|word| word as u32);
        self.commit("the configuration", &map::CONFIGURATION, &map::COMMIT_CONFIGURATION, &words)
    }

    /// Sets for how long the kicker may charge without getting full, s, up to 16.
    ///
    /// # Errors
    /// See [`Board::write_checked`].
    pub(crate) fn set_charge_timeout(&mut self, charge_s: f64) -> Result<(), BoardError> {
        self.write_checked(&map::KICKER_CHARGE_TIMEOUT, (charge_s * 1e6).round() as u32)
    }

    /// Writes a register and reads it back, trying again where it reads otherwise.
    ///
    /// # Errors
    /// [`BoardError::ReadBack`] where it keeps reading otherwise.
    pub fn write_checked(&mut self, register: &map::Register, value: u32) -> Result<(), BoardError> {
        let mut found = 0;
        for _ in 0..TRIES {
            self.bus.write(register.offset, value)?;
            found = self.bus.read(register.offset)?;
            if found == value {
                return Ok(());
            }
        }
        Err(BoardError::ReadBack { register: register.name, found, written: value })
    }

    /// Stages and commits a group, trying again where the card saw another checksum.
    fn commit(
        &mut self,
        what: &'static str,
        base: &map::Register,
        commit: &map::Register,
        words: &[u32],
    ) -> Result<(), BoardError> {
        let mut after = 0;
        for _ in 0..TRIES {
            // Read anew at every try: it may be the read that went wrong.
            let before = self.bus.read(map::COMMITS.offset)?;
            self.stage(base, commit, words)?;
            after = self.bus.read(map::COMMITS.offset)?;
            if map::COMMITS_ACCEPTED.of(after) == map::COMMITS_ACCEPTED.of(before.wrapping_add(1)) {
                return Ok(());
            }
        }
        let faults = self.bus.read(map::FAULTS.offset)?;
        Err(BoardError::Commit { what, accepted: map::COMMITS_ACCEPTED.of(after), faults })
    }

    fn stage(&mut self, base: &map::Register, commit: &map::Register, words: &[u32]) -> Result<(), BusError> {
        let mut sum = map::CHECKSUM_SEED;
        for (index, &word) in words.iter().enumerate() {
            self.bus.write(base.at(index), word)?;
            sum = map::checksum(sum, base.at(index) / 4, word);
        }
        self.bus.write(commit.offset, sum)
    }

    /// What stands in the sticky registers.
    ///
    /// # Errors
    /// A bus that fails.
    pub fn standing(&mut self) -> Result<Standing, BoardError> {
        Ok(Standing {
            faults: self.bus.read(map::FAULTS.offset)?,
            encoder_errors: self.bus.read(map::ENCODER_ERROR.offset)?,
            stalls: self.bus.read(map::STALL.offset)?,
        })
    }

    /// Commits a standstill, clears every sticky register and arms; returns what stood in them before.
    ///
    /// # Errors
    /// [`BoardError::Arm`] while a cause stands.
    pub fn arm(&mut self) -> Result<Standing, BoardError> {
        let stood = self.standing()?;
        for _ in 0..TRIES {
            self.commit("the set points", &map::SET_POINTS, &map::COMMIT_SET_POINTS, &[0; SET_POINT_WORDS])?;
            // The axes first: while one stands, its fault comes again at once.
            self.clear_axes(u32::MAX)?;
            self.clear_faults()?;
            self.bus.write(map::ARM.offset, ARM_FIRST)?;
            self.bus.write(map::ARM.offset, ARM_SECOND)?;
            if self.status()?.armed {
                return Ok(stood);
            }
        }
        Err(BoardError::Arm(self.standing()?))
    }

    /// Outputs off at once. A transfer that fails is no reason to give up: every try writes and looks again.
    ///
    /// # Errors
    /// The last failure of the bus, or [`BoardError::StillArmed`]; the card's watchdog then does it.
    pub fn disarm(&mut self) -> Result<(), BoardError> {
        let mut failed = BoardError::StillArmed(DISARM_TRIES);
        for _ in 0..DISARM_TRIES {
            let written = self.bus.write(map::ARM.offset, 0).map_err(BoardError::Bus);
            match written.and_then(|()| self.status()) {
                Ok(status) if !status.armed => return Ok(()),
                Ok(_) => {}
                Err(error) => failed = error,
            }
        }
        Err(failed)
    }

    /// Waits for the tick at which a committed configuration acts, by calling `wait`, and compares what is in
    /// force with what was committed, word by word.
    ///
    /// # Errors
    /// [`BoardError::NoTick`], or [`BoardError::InForce`].
    pub fn configuration_in_force(&mut self, scale: &Scale, mut wait: impl FnMut()) -> Result<(), BoardError> {
        let mut looks = 0;
        while map::STATUS_CONFIGURATION_PENDING.is_set(self.bus.read(map::STATUS.offset)?) {
            looks += 1;
            if looks > LOOKS {
                return Err(BoardError::NoTick(LOOKS));
            }
            wait();
        }
        let register = &map::ACTIVE_CONFIGURATION;
        for (index, word) in scale.configuration().to_words().into_iter().enumerate() {
            let mut found = self.bus.read(register.at(index))?;
            if found != word as u32 {
                // Once more: the read may be what went wrong.
                found = self.bus.read(register.at(index))?;
            }
            if found != word as u32 {
                return Err(BoardError::InForce { register: register.name, index, found, written: word as u32 });
            }
        }
        Ok(())
    }

    /// Clears faults whose cause is gone.
    ///
    /// # Errors
    /// A bus that fails.
    pub fn clear_faults(&mut self) -> Result<(), BoardError> {
        Ok(self.bus.write(map::FAULTS.offset, u32::MAX)?)
    }

    /// The fault that came first since the last clear; more than one bit where they came at once.
    ///
    /// # Errors
    /// A bus that fails.
    pub fn first_fault(&mut self) -> Result<u32, BoardError> {
        Ok(self.bus.read(map::FIRST_FAULT.offset)?)
    }

    /// Axes that the card saw driven without moving, a bit each; [`Board::clear_axes`] clears them.
    ///
    /// # Errors
    /// A bus that fails.
    pub fn stalled(&mut self) -> Result<u32, BoardError> {
        Ok(self.bus.read(map::STALL.offset)?)
    }

    /// Clears the stall and the encoder error of these axes, a bit each: they disarm as long as they stand.
    ///
    /// # Errors
    /// A bus that fails.
    pub fn clear_axes(&mut self, axes: u32) -> Result<(), BoardError> {
        self.bus.write(map::STALL.offset, axes)?;
        Ok(self.bus.write(map::ENCODER_ERROR.offset, axes)?)
    }

    /// Captures the next index of these axes, a bit each; those of `clear` count from zero there.
    ///
    /// # Errors
    /// A bus that fails.
    pub fn arm_index(&mut self, axes: u32, clear: u32) -> Result<(), BoardError> {
        let word = map::INDEX_ARM_LATCH.place(axes) | map::INDEX_ARM_CLEAR.place(clear);
        Ok(self.bus.write(map::INDEX_ARM.offset, word)?)
    }

    /// Counts at an axis' captured index; `None` until a control tick after it was seen.
    ///
    /// # Errors
    /// A bus that fails.
    pub fn index_position(&mut self, axis: usize) -> Result<Option<i32>, BoardError> {
        let status = self.bus.read(map::INDEX_STATUS.offset)?;
        if axis >= AXES || map::INDEX_SEEN.of(status) >> axis & 1 == 0 {
            return Ok(None);
        }
        Ok(Some(self.bus.read(map::INDEX_POSITION.at(axis))? as i32))
    }

    /// Live status.
    ///
    /// # Errors
    /// A bus that fails.
    pub fn status(&mut self) -> Result<Status, BoardError> {
        Ok(Status::of(self.bus.read(map::STATUS.offset)?))
    }

    /// Commits a body velocity; the card must be in that mode. Five words over the bus.
    ///
    /// A commit that the card refuses changes nothing and shows as a fault in the next snapshot.
    ///
    /// # Errors
    /// A bus that fails.
    pub fn set_twist(&mut self, scale: &Scale, twist: Twist) -> Result<(), BoardError> {
        let [x, y, omega] = scale.twist_words(twist).map(|word| word as u32);
        Ok(self.stage(&map::SET_POINTS, &map::COMMIT_SET_POINTS, &[x, y, omega, 0])?)
    }

    /// Commits wheel speeds; the card must be in that mode. Five words over the bus.
    ///
    /// # Errors
    /// A bus that fails.
    pub fn set_wheel_speeds(&mut self, speeds: &[Speed; AXES]) -> Result<(), BoardError> {
        Ok(self.stage(&map::SET_POINTS, &map::COMMIT_SET_POINTS, &speeds.map(|speed| speed.to_bits() as u32))?)
    }

    /// A coherent snapshot with what the inertial sensor sent at its tick. 32 words over the bus.
    ///
    /// # Errors
    /// As [`Self::snapshot`].
    pub fn snapshot_with_imu(&mut self) -> Result<(Snapshot, [u16; SNAPSHOT_IMU_WORDS]), BoardError> {
        let mut imu = [0; SNAPSHOT_IMU_WORDS];
        let snapshot = self.coherent(|bus, words| {
            // The last word of the snapshot releases it: the sensor's words come before.
            words[0] = bus.read(map::SNAPSHOT_SEQUENCE.offset)?;
            bus.read_block(map::SNAPSHOT_IMU.offset, &mut imu)?;
            bus.read_block(map::SNAPSHOT_SEQUENCE.offset + 4, &mut words[1..])
        })?;
        Ok((snapshot, imu.map(|word| word as u16)))
    }

    /// A coherent snapshot of the last control tick. 24 words over the bus.
    ///
    /// # Errors
    /// [`BoardError::Snapshot`] where the sequence numbers never agree.
    pub fn snapshot(&mut self) -> Result<Snapshot, BoardError> {
        self.coherent(|bus, words| bus.read_block(map::SNAPSHOT_SEQUENCE.offset, words))
    }

    /// A snapshot whose first and last word agree.
    fn coherent(
        &mut self,
        mut read: impl FnMut(&mut R, &mut [u32; map::SNAPSHOT_WORDS]) -> Result<(), BusError>,
    ) -> Result<Snapshot, BoardError> {
        let mut words = [0; map::SNAPSHOT_WORDS];
        for _ in 0..TRIES {
            read(&mut self.bus, &mut words)?;
            if words[0] == words[map::SNAPSHOT_WORDS - 1] {
                return Ok(Snapshot::of(&words));
            }
        }
        Err(BoardError::Snapshot(TRIES))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::registers::{Recorder, Transfer};
    use fixed_kin::card::{Card, Pins};
    use runs::robot::Robot;

    fn ready() -> (Board<Recorder<Card>>, Scale) {
        let scale = Scale::new(&Robot::racbot(), 33_333_333.0).unwrap();
        let mut board = Board::new(Recorder::new(Card::new(7)));
        assert_eq!(board.identify().unwrap().content_hash, 7);
        board.configure(&scale, &Settings::default()).unwrap();
        board.bus.inner.tick(&Pins::default());
        board.arm().unwrap();
        (board, scale)
    }

    #[test]
    fn a_commanded_twist_reaches_the_wheels() {
        let (mut board, scale) = ready();
        let twist = Twist { vx: 0.2, vy: 1.0, omega: -0.5 };
        board.set_twist(&scale, twist).unwrap();
        board.bus.inner.tick(&Pins::default());
        let snapshot = board.snapshot().unwrap();
        let expected = Robot::racbot().geometry().unwrap().wheel_speeds(twist);
        for (axis, expected) in expected.into_iter().enumerate() {
            assert!((scale.speed(snapshot.references[axis]) - expected).abs() < 2e-3);
            assert_eq!(snapshot.duties[axis] > 0, expected > 0.0);
        }
    }

    #[test]
    fn a_pose_comes_back_in_metres_and_radians() {
        let (mut board, scale) = ready();
        let robot = Robot::racbot();
        let twist = Twist { vx: 0.3, vy: 1.0, omega: 0.8 };
        let speeds = robot.geometry().unwrap().wheel_speeds(twist);
        let mut pins = Pins::default();
        for tick in 1..=1_000 {
            for (axis, speed) in speeds.iter().enumerate() {
                let turned = speed * f64::from(tick) * scale.tick_s();
                pins.encoders[axis].count = (turned * robot.counts_per_wheel_rad()).floor() as i64 as u16;
            }
            board.bus.inner.tick(&pins);
        }
        let exact = runs::frames::Pose::default().advance(twist, 1_000.0 * scale.tick_s());
        let pose = scale.pose(board.snapshot().unwrap().pose);
        assert!((pose.x - exact.x).hypot(pose.y - exact.y) < 2e-4, "{pose:?} for {exact:?}");
        assert!((pose.theta - exact.theta).abs() < 1e-3);
    }

    #[test]
    fn an_index_is_captured_and_zeroes_its_axis() {
        let (mut board, _) = ready();
        assert_eq!(board.index_position(1).unwrap(), None);
        board.arm_index(0b0010, 0b0010).unwrap();
        let mut pins = Pins::default();
        pins.encoders[1].count = 100;
        board.bus.inner.tick(&pins);
        pins.encoders[1].count = 140;
        pins.indices = [Some(7), Some(120), None, None];
        board.bus.inner.tick(&pins);
        assert_eq!(board.index_position(1).unwrap(), Some(120));
        assert_eq!(board.index_position(0).unwrap(), None, "not armed");
        assert_eq!(board.snapshot().unwrap().counts[1], 20);
    }

    #[test]
    fn a_control_tick_takes_24_words_read_and_5_written() {
        let (mut board, scale) = ready();
        board.bus.transfers.clear();
        board.set_twist(&scale, Twist::default()).unwrap();
        board.snapshot().unwrap();
        let reads = board.bus.transfers.iter().filter(|t| matches!(t, Transfer::Read(..))).count();
        assert_eq!((reads, board.bus.transfers.len() - reads), (24, 5));
    }

    #[test]
    fn a_pressed_emergency_stop_refuses_to_arm_by_name() {
        let (mut board, _) = ready();
        board.bus.inner.tick(&Pins { emergency_stop: true, ..Pins::default() });
        assert!(!board.status().unwrap().armed);
        let message = board.arm().unwrap_err().to_string();
        assert!(message.contains("emergency-stop"), "{message}");
    }

    #[test]
    fn what_stood_is_named_and_cleared_at_arming() {
        let (mut board, _) = ready();
        board.bus.inner.tick(&Pins { encoder_errors: 0b0010, ..Pins::default() });
        assert!(!board.status().unwrap().armed);
        let stood = board.arm().unwrap();
        assert!(board.status().unwrap().armed && stood.is_notable());
        assert_eq!(stood.to_string(), "encoder; encoder error on axis 2");
        assert_eq!(board.standing().unwrap(), Standing::default());
        board.disarm().unwrap();
        assert!(!board.arm().unwrap().is_notable());
    }

    #[test]
    fn a_blocked_wheel_can_drive_again_once_it_is_free() {
        let (mut board, scale) = ready();
        let mut driven = 0;
        while board.status().unwrap().armed && driven < 1_000 {
            board.set_twist(&scale, Twist { vx: 1.0, vy: 0.0, omega: 0.0 }).unwrap();
            board.bus.inner.tick(&Pins::default());
            driven += 1;
        }
        // 0.2 s at more than half duty, which the integrator needs some time to reach.
        assert!((200..800).contains(&driven), "{driven} ticks");
        let stood = board.arm().unwrap();
        assert!(stood.stalls != 0 && stood.to_string().contains("stall on axis "), "{stood}");
        board.bus.inner.tick(&Pins::default());
        assert!(board.status().unwrap().armed);
    }

    #[test]
    fn a_fault_that_still_stands_is_named_with_its_axis() {
        /// An encoder that is broken for good: its error cannot be cleared.
        struct Broken(Card);
        impl Registers for Broken {
            fn read(&mut self, offset: u16) -> Result<u32, BusError> {
                Ok(self.0.read(offset))
            }
            fn write(&mut self, offset: u16, data: u32) -> Result<(), BusError> {
                if offset != map::ENCODER_ERROR.offset {
                    self.0.write(offset, data);
                }
                Ok(())
            }
        }
        let (board, _) = ready();
        let mut card = board.bus.inner;
        card.tick(&Pins { encoder_errors: 0b0100, ..Pins::default() });
        let message = Board::new(Broken(card)).arm().unwrap_err().to_string();
        assert!(message.contains("refused to arm") && message.contains("encoder error on axis 3"), "{message}");
    }

    /// A bus on which so many transfers fail from one on.
    struct Failing {
        card: Card,
        transfers: usize,
        fails: std::ops::Range<usize>,
    }

    impl Failing {
        fn fails(&mut self) -> bool {
            self.transfers += 1;
            self.fails.contains(&(self.transfers - 1))
        }
    }

    impl Registers for Failing {
        fn read(&mut self, offset: u16) -> Result<u32, BusError> {
            if self.fails() { Err(BusError::read(offset, "a parity error")) } else { Ok(self.card.read(offset)) }
        }
        fn write(&mut self, offset: u16, data: u32) -> Result<(), BusError> {
            if self.fails() {
                return Err(BusError::write(offset, "a parity error"));
            }
            self.card.write(offset, data);
            Ok(())
        }
    }

    #[test]
    fn a_bus_error_does_not_keep_the_outputs_on() {
        for fails in [0..1, 0..2, 1..2, 1..3] {
            let (board, _) = ready();
            let mut board = Board::new(Failing { card: board.bus.inner, transfers: 0, fails: fails.clone() });
            let disarmed = board.disarm();
            assert!(!board.bus.card.armed(), "transfers {fails:?} fail");
            assert!(disarmed.is_ok(), "{fails:?}: {disarmed:?}");
        }
        let (board, _) = ready();
        let mut board = Board::new(Failing { card: board.bus.inner, transfers: 0, fails: 0..usize::MAX });
        let message = board.disarm().unwrap_err().to_string();
        assert!(message.contains("parity error"), "{message}");
        assert_eq!(board.bus.transfers, DISARM_TRIES as usize, "it writes zero on every try");
    }

    /// A bus that flips one bit of one write.
    struct Flip {
        card: Card,
        at: usize,
        writes: usize,
    }

    impl Registers for Flip {
        fn read(&mut self, offset: u16) -> Result<u32, BusError> {
            Ok(self.card.read(offset))
        }
        fn write(&mut self, offset: u16, data: u32) -> Result<(), BusError> {
            self.writes += 1;
            self.card.write(offset, if self.writes == self.at { data ^ 0x0400 } else { data });
            Ok(())
        }
    }

    #[test]
    fn one_flipped_write_is_caught_or_repaired() {
        let scale = Scale::new(&Robot::racbot(), 33_333_333.0).unwrap();
        for at in 1..60 {
            let mut board = Board::new(Flip { card: Card::new(0), at, writes: 0 });
            let done = board.configure(&scale, &Settings::default());
            if done.is_ok() {
                board.bus.card.tick(&Pins::default());
                for (index, word) in scale.configuration().to_words().into_iter().enumerate() {
                    let found = board.bus.card.read(map::ACTIVE_CONFIGURATION.at(index));
                    assert_eq!(found as i32, word, "write {at} went unnoticed");
                }
            }
        }
    }

    #[test]
    fn another_design_is_refused() {
        struct Absent;
        impl Registers for Absent {
            fn read(&mut self, _: u16) -> Result<u32, BusError> {
                Ok(u32::MAX)
            }
            fn write(&mut self, _: u16, _: u32) -> Result<(), BusError> {
                Ok(())
            }
        }
        let message = Board::new(Absent).identify().unwrap_err().to_string();
        assert!(message.contains("cookie") && message.contains("absent"), "{message}");
    }
}
