//! The whole card at the granularity of control ticks: registers in front, [`Core`] behind.
//!
//! Registers read and write as over the bus, but in no time; [`Card::tick`] lets one control
//! period pass and computes. Between ticks this equals the gateware word for word, but for
//! `time`: a bus access takes clocks there. Pins between ticks, filters and PWM are not here; their
//! twins ([`crate::encoder`], [`crate::pwm`]) work clock by clock.

#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_possible_wrap,
    reason = "registers and snapshot are raw words; masks stand beside each cast"
)]

mod plain;

use crate::AXES;
use crate::commit::{Commit, Group};
use crate::control::{
    CONFIGURATION_WORDS, Configuration, Core, IndexCapture, SET_POINT_WORDS, SetPointMode, TickInputs, TickOutputs,
};
use crate::imu_spi::{self, SNAPSHOT_IMU_WORDS};
use crate::interrupt::{self, Interrupt};
use crate::kicker::{self, Kicker};
use crate::radio::{Link, Refusal};
use crate::registers as map;
use crate::safety::{self, Safety};
use crate::speed::{EncoderSample, SpeedMode, TIME_BITS};
use crate::stall::{self, Stall, Window};
use plain::Plain;

/// What reaches the card from outside, at a control tick.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Pins {
    /// Encoder counters.
    pub encoders: [EncoderSample; AXES],
    /// Illegal transitions in this tick, a bit per axis.
    pub encoder_errors: u8,
    /// First rise of the index in this tick, per axis: the encoder's count at it.
    pub indices: [Option<u16>; AXES],
    /// Emergency stop, high = stop.
    pub emergency_stop: bool,
    /// Ball sensor.
    pub ball: bool,
    /// The kicker's capacitor is full.
    pub kicker_full: bool,
    /// What the inertial sensor would send.
    pub imu: imu_spi::Sample,
}

/// See the module.
#[derive(Clone, Debug)]
pub struct Card {
    core: Core,
    commit: Commit,
    safety: Safety,
    kicker: Kicker,
    /// Inputs in which the kicker has come to rest: only others, or strobes, can wake it.
    kicker_rests: Option<kicker::Inputs>,
    interrupt: Interrupt,
    link: Link,
    imu: imu_spi::Port,
    by_radio: bool,
    stalls: [Stall; AXES],
    window: Window,
    index_waiting: u8,
    index_seen: u8,
    index_clear: u8,
    plain: Plain,
    content_hash: u32,
    target: map::Target,
    configuration: [[i32; CONFIGURATION_WORDS]; 2],
    parsed: Configuration,
    set_points: [[i32; SET_POINT_WORDS]; 2],
    snapshots: [[u32; map::SNAPSHOT_WORDS_WITH_IMU]; 3],
    latest: usize,
    held: Option<usize>,
    held_bank: usize,
    sequence: u32,
    time: u32,
    pins: Pins,
    encoder_errors: u8,
}

impl Card {
    /// A card just configured with a bitstream of this hash.
    #[must_use]
    pub fn new(content_hash: u32) -> Self {
        let mut card = Self {
            core: Core::default(),
            commit: Commit::default(),
            safety: Safety::default(),
            kicker: Kicker::default(),
            kicker_rests: None,
            interrupt: Interrupt::default(),
            link: Link::new(15),
            imu: imu_spi::Port::default(),
            by_radio: false,
            stalls: [Stall::default(); AXES],
            window: Window::default(),
            index_waiting: 0,
            index_seen: 0,
            index_clear: 0,
            plain: Plain::new(),
            content_hash,
            target: map::BOARD_4I65,
            configuration: [[0; CONFIGURATION_WORDS]; 2],
            parsed: Configuration::default(),
            set_points: [[0; SET_POINT_WORDS]; 2],
            snapshots: [[0; map::SNAPSHOT_WORDS_WITH_IMU]; 3],
            latest: 0,
            held: None,
            held_bank: 0,
            sequence: 0,
            time: 0,
            pins: Pins::default(),
            encoder_errors: 0,
        };
        // The capacitor counts as full until its input has been low for a while.
        card.clock_kicker(card.kicker_inputs());
        card
    }

    /// As [`Self::new`], with the straps of a robot without a PC, 0 to 15: commanded by radio.
    #[must_use]
    pub fn slave(content_hash: u32, robot: u8) -> Self {
        Self { link: Link::new(robot), by_radio: true, ..Self::new(content_hash) }
    }

    /// The same design on another board.
    #[must_use]
    pub fn on(self, target: map::Target) -> Self {
        Self { target, ..self }
    }

    /// What came over the radio between two silences; acts as a whole, in no time, if the radio commands.
    ///
    /// # Errors
    /// [`Refusal`]: nothing was done; `radio` counts it.
    pub fn receive(&mut self, bytes: &[u8]) -> Result<(), Refusal> {
        let writes = self.link.take(bytes, self.armed())?;
        if self.by_radio {
            writes.for_each(|(offset, data)| self.act(offset, data));
        }
        Ok(())
    }

    /// Control period in clocks, as in force.
    #[must_use]
    pub fn tick_period(&self) -> u32 {
        self.plain.of(&map::TICK_PERIOD).max(map::MIN_TICK_PERIOD)
    }

    /// Clocks since configuration, wrapping.
    #[must_use]
    pub fn time(&self) -> u32 {
        self.time
    }

    /// Moves the clock counter, to run beside a chip whose ticks fall at other times.
    pub fn set_time(&mut self, time: u32) {
        self.time = time;
    }

    /// The line to the inertial sensor, for whoever stands at its other end.
    pub fn imu(&mut self) -> &mut imu_spi::Port {
        &mut self.imu
    }

    /// The register from which on the sensor is read at every tick, if it is.
    #[must_use]
    pub fn imu_reads(&self) -> Option<u8> {
        let control = self.plain.of(&map::IMU_CONTROL);
        map::IMU_ENABLE.is_set(control).then(|| map::IMU_FIRST.of(control) as u8)
    }

    /// PWM period in clocks.
    #[must_use]
    pub fn pwm_period(&self) -> u16 {
        self.plain.of(&map::PWM_PERIOD) as u16
    }

    /// Encoder filter in clocks, for whoever makes edges.
    #[must_use]
    pub fn encoder_filter(&self) -> u8 {
        self.plain.of(&map::ENCODER_FILTER) as u8
    }

    /// Whether the outputs may be on.
    #[must_use]
    pub fn armed(&self) -> bool {
        self.safety.outputs().armed
    }

    /// Reads the register at a byte offset; reserved and unaligned ones read zero.
    pub fn read(&mut self, offset: u16) -> u32 {
        // What a host reads in every tick comes first.
        let snapshot = map::SNAPSHOT_SEQUENCE.offset..=map::SNAPSHOT_IMU.at(SNAPSHOT_IMU_WORDS - 1);
        if snapshot.contains(&offset) && offset.is_multiple_of(4) {
            return self.read_snapshot(usize::from(offset - map::SNAPSHOT_SEQUENCE.offset) / 4);
        }
        let Some((register, index)) = map::lookup(offset) else { return 0 };
        if let Some(word) = self.plain.read(register) {
            return word;
        }
        match register.offset {
            o if o == map::CONTENT_HASH.offset => self.content_hash,
            o if o == map::BOARD.offset => self.target.word,
            o if o == map::CLOCK_HZ.offset => self.target.clock_hz,
            o if o == map::TIME.offset => self.time,
            o if o == map::FAULTS.offset => u32::from(self.safety.outputs().faults),
            o if o == map::FIRST_FAULT.offset => u32::from(self.safety.outputs().first_fault),
            o if o == map::STATUS.offset => self.status(),
            o if o == map::COMMITS.offset => {
                map::COMMITS_ACCEPTED.place(self.commit.accepted.into())
                    | map::COMMITS_REJECTED.place(self.commit.rejected.into())
            }
            o if o == map::ENCODER_ERROR.offset => u32::from(self.encoder_errors),
            o if o == map::KICKER_STATUS.offset => self.kicker_status(),
            // Levels of the lines are not here, only what was counted of them.
            o if o == map::ENCODER_LINES.offset => 0,
            o if o == map::STALL.offset => self.stalled(),
            o if o == map::INDEX_STATUS.offset => {
                map::INDEX_WAITING.place(self.index_waiting.into()) | map::INDEX_SEEN.place(self.index_seen.into())
            }
            o if o == map::INTERRUPT_STATUS.offset => u32::from(self.interrupt.outputs().status),
            o if o == map::RADIO.offset => {
                map::RADIO_SELECT.place(self.by_radio.into())
                    | map::RADIO_ACCEPTED.place(self.link.accepted.into())
                    | map::RADIO_DROPPED.place(self.link.dropped.into())
            }
            o if o == map::IMU_STATUS.offset => self.imu.status(),
            o if o == map::CONFIGURATION.offset => {
                self.configuration[1 - self.commit.bank(Group::Configuration)][index] as u32
            }
            o if o == map::ACTIVE_CONFIGURATION.offset => {
                self.configuration[self.commit.bank(Group::Configuration)][index] as u32
            }
            o if o == map::SET_POINTS.offset => self.set_points[1 - self.commit.bank(Group::SetPoints)][index] as u32,
            o if o == map::ACTIVE_SET_POINTS.offset => {
                self.set_points[self.commit.bank(Group::SetPoints)][index] as u32
            }
            o if o == map::INDEX_POSITION.offset => self.core.index_positions[index] as u32,
            o if o == map::INTEGRALS.offset => self.core.loops[index].integral.to_bits() as u32,
            _ if register.access == map::Access::ReadOnly => register.reset,
            _ => 0,
        }
    }

    /// Reads consecutive words, as so many calls of [`Self::read`] would.
    pub fn read_block(&mut self, offset: u16, words: &mut [u32]) {
        // The whole snapshot, as a host reads it in every tick: its first word holds it, its last lets it go.
        if offset == map::SNAPSHOT_SEQUENCE.offset && words.len() == map::SNAPSHOT_WORDS {
            (self.held_bank, self.held) = (self.latest, None);
            words.copy_from_slice(&self.snapshots[self.latest][..map::SNAPSHOT_WORDS]);
            return;
        }
        for (index, word) in words.iter_mut().enumerate() {
            *word = self.read(offset.wrapping_add((4 * index) as u16));
        }
    }

    fn read_snapshot(&mut self, index: usize) -> u32 {
        if index == 0 {
            self.held_bank = self.latest;
            self.held = Some(self.latest);
        }
        if index == map::SNAPSHOT_WORDS - 1 {
            self.held = None;
        }
        self.snapshots[self.held_bank][index]
    }

    /// Writes the register at a byte offset; reserved, unaligned and read-only ones ignore it, and while
    /// the radio commands all but two.
    pub fn write(&mut self, offset: u16, data: u32) {
        if !self.by_radio || [map::ARM.offset, map::RADIO.offset].contains(&offset) {
            self.act(offset, data);
        }
    }

    /// A write of whoever commands.
    fn act(&mut self, offset: u16, data: u32) {
        let Some((register, index)) = map::lookup(offset) else { return };
        if register.access == map::Access::LockedWhileArmed && self.armed() {
            return;
        }
        if self.plain.write(register, data) {
            if register.offset == map::KICKER_CONTROL.offset {
                self.clock_kicker(self.kicker_inputs());
            }
            return;
        }
        match register.offset {
            o if o == map::ARM.offset => {
                self.safety.clock(&safety::Inputs { arm_write: true, arm_data: data, ..self.safety_inputs() });
            }
            o if o == map::FAULTS.offset && data != 0 => {
                self.safety.clock(&safety::Inputs { clear_faults: data as u8, ..self.safety_inputs() });
                self.clock_kicker(kicker::Inputs { clear: true, ..self.kicker_inputs() });
            }
            o if o == map::ENCODER_ERROR.offset => self.encoder_errors &= !(data as u8),
            o if o == map::STALL.offset => {
                for (axis, detector) in self.stalls.iter_mut().enumerate() {
                    let enable = self.safety.outputs().armed;
                    detector.clock(&stall::Inputs { clear: data >> axis & 1 == 1, enable, ..stall::Inputs::default() });
                }
            }
            o if o == map::INDEX_ARM.offset => self.arm_index(data),
            o if o == map::INTERRUPT_STATUS.offset => self.interrupt(false, data as u8),
            o if o == map::RADIO.offset => self.by_radio = map::RADIO_SELECT.of(data) == 1,
            o if o == map::IMU_ACCESS.offset => self.imu.access(self.plain.of(&map::IMU_CONTROL), data),
            o if o == map::COMMIT_SET_POINTS.offset => self.commit(Group::SetPoints, data),
            o if o == map::COMMIT_CONFIGURATION.offset => self.commit(Group::Configuration, data),
            o if o == map::KICKER_FIRE.offset && data == map::KICKER_FIRE_WORD => {
                self.clock_kicker(kicker::Inputs { fire: true, ..self.kicker_inputs() });
            }
            o if o == map::CONFIGURATION.offset => {
                self.commit.stage(Group::Configuration, offset / 4, data);
                self.configuration[1 - self.commit.bank(Group::Configuration)][index] = map::stored_word(data);
            }
            o if o == map::SET_POINTS.offset => {
                self.commit.stage(Group::SetPoints, offset / 4, data);
                self.set_points[1 - self.commit.bank(Group::SetPoints)][index] = map::stored_word(data);
            }
            _ => {}
        }
    }

    fn commit(&mut self, group: Group, sum: u32) {
        let right = self.commit.commit(group, sum);
        let pet = right && group == Group::SetPoints;
        self.safety.clock(&safety::Inputs { pet, commit_fault: !right, ..self.safety_inputs() });
    }

    /// One control period passes, with these pins at its end; then the core computes.
    pub fn tick(&mut self, pins: &Pins) -> TickOutputs {
        let period = self.tick_period();
        self.pins = *pins;
        self.encoder_errors |= pins.encoder_errors;
        self.time = self.time.wrapping_add(period);
        self.advance_safety(period - 1);
        self.advance_kicker(period);

        if self.commit.pending(Group::Configuration) {
            self.parsed = Configuration::from_words(&self.configuration[1 - self.commit.bank(Group::Configuration)]);
        }
        self.commit.tick();
        let safe = self.safety.outputs();
        let inputs = self.tick_inputs(safe);
        let outputs = self.core.tick(&self.parsed, &inputs);
        self.publish(&outputs, inputs.now, safe);
        self.judge_stalls(&outputs);
        // The clock of the tick itself.
        self.safety.clock(&safety::Inputs { tick: true, ..self.safety_inputs() });
        self.interrupt(true, 0);
        outputs
    }

    /// The line to the bridge, low = interrupt.
    #[must_use]
    pub fn int_n(&self) -> bool {
        u32::from(self.interrupt.outputs().status) & self.plain.of(&map::INTERRUPT_ENABLE) == 0
    }

    /// Whether the kicker's capacitor is being discharged.
    #[must_use]
    pub fn kicker_discharges(&self) -> bool {
        let holds = map::KICKER_HOLD.is_set(self.plain.of(&map::KICKER_CONTROL)) && !self.safety.outputs().stopped;
        !self.armed() && !holds
    }

    fn tick_inputs(&mut self, safe: safety::Outputs) -> TickInputs {
        let mode = |field: map::Field| field.of(self.plain.of(&map::MODE)) == 1;
        let speed_mode = if mode(map::MODE_COUNT_AND_TIME) { SpeedMode::CountAndTime } else { SpeedMode::Difference };
        let set_point_mode = if mode(map::MODE_TWIST) { SetPointMode::Twist } else { SetPointMode::Wheels };
        let odometry = mode(map::MODE_ODOMETRY);
        TickInputs {
            encoders: self.pins.encoders,
            indices: core::array::from_fn(|axis| self.capture(axis)),
            now: self.time & ((1 << TIME_BITS) - 1),
            tick_period: self.tick_period(),
            speed_mode,
            set_point_mode,
            odometry,
            set_points: self.set_points[self.commit.bank(Group::SetPoints)],
            set_points_valid: safe.setpoints_valid,
            armed: safe.armed,
            pwm_period: self.pwm_period(),
        }
    }

    fn arm_index(&mut self, data: u32) {
        let (latch, clear) = (map::INDEX_ARM_LATCH.of(data) as u8, map::INDEX_ARM_CLEAR.of(data) as u8);
        self.index_waiting |= latch;
        self.index_seen &= !latch;
        self.index_clear = (self.index_clear & !latch) | (clear & latch);
    }

    fn capture(&mut self, axis: usize) -> IndexCapture {
        let mask = 1 << axis;
        match self.pins.indices[axis] {
            Some(count) if self.index_waiting & mask != 0 => {
                self.index_waiting &= !mask;
                self.index_seen |= mask;
                IndexCapture { event: true, clear: self.index_clear & mask != 0, count }
            }
            _ => IndexCapture::default(),
        }
    }

    /// Counts of the tick, the end of a window, and the drive from now on, in the order of the clocks.
    fn judge_stalls(&mut self, outputs: &TickOutputs) {
        let enable = self.safety.outputs().armed;
        let window = self.window.tick(self.plain.of(&map::STALL_WINDOW) as u16);
        let threshold = self.plain.of(&map::STALL_COMPARE) as u16;
        let quiet = stall::Inputs { enable, threshold, ..stall::Inputs::default() };
        for (axis, detector) in self.stalls.iter_mut().enumerate() {
            detector.step(enable, outputs.moved[axis]);
            detector.clock(&stall::Inputs { window, ..quiet });
            detector.clock(&stall::Inputs { load: true, compare: outputs.modulation[axis].compare, ..quiet });
        }
    }

    fn stalled(&self) -> u32 {
        self.stalls.iter().enumerate().fold(0, |word, (axis, s)| word | u32::from(s.outputs().stalled) << axis)
    }

    fn interrupt(&mut self, done: bool, clear: u8) {
        let armed = self.safety.outputs().armed;
        self.interrupt.clock(&interrupt::Inputs {
            done,
            armed,
            enable: self.plain.of(&map::INTERRUPT_ENABLE) as u8,
            clear,
        });
    }

    /// The safety block for some clocks; the interrupt sees what they changed.
    fn advance_safety(&mut self, clocks: u32) {
        self.safety.advance(&self.safety_inputs(), clocks);
        self.interrupt(false, 0);
    }

    fn publish(&mut self, outputs: &TickOutputs, now: u32, safe: safety::Outputs) {
        let bank = free_bank(self.latest, self.held.unwrap_or(self.latest));
        self.sequence = self.sequence.wrapping_add(1);
        // What is pending is over at the tick.
        let (status, faults) = (self.status() & 0x0F, u32::from(safe.faults));
        let words = &mut self.snapshots[bank];
        words[0] = self.sequence;
        words[1] = status;
        words[2] = now;
        words[3] = faults;
        for axis in 0..AXES {
            words[4 + axis] = outputs.counts[axis] as u32;
            words[8 + axis] = outputs.speeds[axis].to_bits() as u32;
            words[12 + axis] = outputs.references[axis].to_bits() as u32;
            words[16 + axis] = outputs.duties[axis].to_bits() as u32;
        }
        for (word, component) in words[20..23].iter_mut().zip(outputs.pose.words()) {
            *word = component as u32;
        }
        words[23] = self.sequence;
        self.imu.tick(self.plain.of(&map::IMU_CONTROL), &self.pins.imu, &mut words[map::SNAPSHOT_WORDS..]);
        self.latest = bank;
    }

    fn status(&self) -> u32 {
        let safe = self.safety.outputs();
        let bits = [
            safe.armed,
            safe.setpoints_valid,
            self.pins.emergency_stop,
            self.pins.ball,
            self.commit.pending(Group::SetPoints),
            self.commit.pending(Group::Configuration),
        ];
        bits.into_iter().enumerate().fold(0, |word, (bit, on)| word | u32::from(on) << bit)
    }

    fn kicker_status(&self) -> u32 {
        let outputs = self.kicker.outputs();
        map::KICKER_STATE.place(outputs.state.into())
            | map::KICKER_ON_BALL.place(outputs.on_ball.into())
            | map::KICKER_READY.place(outputs.ready.into())
            | map::KICKER_TIMED_OUT.place(outputs.timed_out.into())
            | map::KICKER_DROPPED.place(outputs.dropped.into())
            | map::KICKER_FULL.place(outputs.is_full.into())
    }

    fn safety_inputs(&self) -> safety::Inputs {
        safety::Inputs {
            emergency_stop: self.pins.emergency_stop,
            watchdog_timeout: self.plain.of(&map::WATCHDOG_TIMEOUT),
            encoder_fault: u32::from(self.encoder_errors) & self.plain.of(&map::ENCODER_FAULT_MASK) != 0,
            stall_fault: self.stalled() & self.plain.of(&map::ENCODER_FAULT_MASK) != 0,
            set_point_timeout: self.plain.of(&map::SET_POINT_TIMEOUT) as u16,
            ..safety::Inputs::default()
        }
    }

    fn kicker_inputs(&self) -> kicker::Inputs {
        kicker::Inputs {
            enable: self.armed(),
            charge_request: map::KICKER_CHARGE.is_set(self.plain.of(&map::KICKER_CONTROL)),
            arm_on_ball: map::KICKER_ARM_ON_BALL.is_set(self.plain.of(&map::KICKER_CONTROL)),
            charge_timeout: self.plain.of(&map::KICKER_CHARGE_TIMEOUT),
            pulse: self.plain.of(&map::KICKER_PULSE) as u16,
            lockout: self.plain.of(&map::KICKER_LOCKOUT),
            ball: self.pins.ball,
            full: self.pins.kicker_full,
            by_time: map::KICKER_BY_TIME.is_set(self.plain.of(&map::KICKER_CONTROL)),
            ..kicker::Inputs::default()
        }
    }

    fn clock_kicker(&mut self, inputs: kicker::Inputs) {
        self.kicker.clock(&inputs);
        self.kicker_rests = None;
    }

    fn advance_kicker(&mut self, clocks: u32) {
        let quiet = self.kicker_inputs();
        if self.kicker_rests == Some(quiet) {
            return;
        }
        self.kicker_rests = None;
        for _ in 0..clocks / kicker::microsecond_clocks(self.plain.of(&map::CLOCKS_PER_MICROSECOND)) {
            let before = self.kicker;
            self.kicker.clock(&kicker::Inputs { microsecond: true, ..quiet });
            self.kicker.clock(&quiet);
            if self.kicker == before {
                self.kicker_rests = Some(quiet);
                break;
            }
        }
    }
}

/// The bank that a tick writes: neither the latest nor the one a reader holds.
const fn free_bank(latest: usize, held: usize) -> usize {
    if latest != held {
        3 - latest - held
    } else if latest == 0 {
        1
    } else {
        0
    }
}

#[cfg(test)]
mod tests;
