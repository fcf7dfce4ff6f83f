//! The whole card at the granularity of control ticks: registers in front, [`Core`] behind.
//!
//! Registers read and write as over the bus, but in no time; [`Card::tick`] lets one control
//! period pass and computes. Between ticks this equals the gateware word for word, but for
//! `time`: a bus access takes clocks there. Pins between ticks, filters and PWM are not here; their
//! twins ([`crate::encoder`], [`crate::pwm`]) work clock by clock.

use crate::AXES;
use crate::commit::{Commit, Group};
use crate::control::{
    CONFIGURATION_WORDS, Configuration, Core, SET_POINT_WORDS, SetPointMode, TickInputs, TickOutputs,
};
use crate::kicker::{self, Kicker};
use crate::registers as map;
use crate::safety::{self, Safety};
use crate::speed::{EncoderSample, SpeedMode, TIME_BITS};

/// What reaches the card from outside, at a control tick.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Pins {
    /// Encoder counters.
    pub encoders: [EncoderSample; AXES],
    /// Illegal transitions in this tick, a bit per axis.
    pub encoder_errors: u8,
    /// Emergency stop, high = stop.
    pub emergency_stop: bool,
    /// Ball sensor.
    pub ball: bool,
}

/// Plain registers.
#[derive(Clone, Copy, Debug)]
struct Plain {
    tick_period: u32,
    mode: u32,
    encoder_filter: u32,
    pwm_period: u32,
    pwm_blanking: u32,
    watchdog_timeout: u32,
    encoder_fault_mask: u32,
    kicker_control: u32,
    kicker_pulse: u32,
    kicker_lockout: u32,
    kicker_charge_timeout: u32,
    clocks_per_microsecond: u32,
    leds: u32,
}

impl Plain {
    fn of(&mut self, register: &map::Register) -> Option<(&mut u32, u32)> {
        let bits = match register.kind {
            map::Kind::Unsigned(bits) => bits,
            map::Kind::Fields(_) => 2,
            map::Kind::Fixed(_) | map::Kind::Text => return None,
        };
        let place = match register.offset {
            o if o == map::TICK_PERIOD.offset => &mut self.tick_period,
            o if o == map::MODE.offset => &mut self.mode,
            o if o == map::ENCODER_FILTER.offset => &mut self.encoder_filter,
            o if o == map::PWM_PERIOD.offset => &mut self.pwm_period,
            o if o == map::PWM_BLANKING.offset => &mut self.pwm_blanking,
            o if o == map::WATCHDOG_TIMEOUT.offset => &mut self.watchdog_timeout,
            o if o == map::ENCODER_FAULT_MASK.offset => &mut self.encoder_fault_mask,
            o if o == map::KICKER_CONTROL.offset => &mut self.kicker_control,
            o if o == map::KICKER_PULSE.offset => &mut self.kicker_pulse,
            o if o == map::KICKER_LOCKOUT.offset => &mut self.kicker_lockout,
            o if o == map::KICKER_CHARGE_TIMEOUT.offset => &mut self.kicker_charge_timeout,
            o if o == map::CLOCKS_PER_MICROSECOND.offset => &mut self.clocks_per_microsecond,
            o if o == map::LEDS.offset => &mut self.leds,
            _ => return None,
        };
        Some((place, u32::MAX >> (32 - bits)))
    }
}

/// See the module.
#[derive(Clone, Debug)]
pub struct Card {
    core: Core,
    commit: Commit,
    safety: Safety,
    kicker: Kicker,
    plain: Plain,
    content_hash: u32,
    configuration: [[i32; CONFIGURATION_WORDS]; 2],
    parsed: Configuration,
    set_points: [[i32; SET_POINT_WORDS]; 2],
    snapshots: [[u32; map::SNAPSHOT_WORDS]; 2],
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
        Self {
            core: Core::default(),
            commit: Commit::default(),
            safety: Safety::default(),
            kicker: Kicker::default(),
            plain: Plain {
                tick_period: map::TICK_PERIOD.reset,
                mode: map::MODE.reset,
                encoder_filter: map::ENCODER_FILTER.reset,
                pwm_period: map::PWM_PERIOD.reset,
                pwm_blanking: map::PWM_BLANKING.reset,
                watchdog_timeout: map::WATCHDOG_TIMEOUT.reset,
                encoder_fault_mask: map::ENCODER_FAULT_MASK.reset,
                kicker_control: map::KICKER_CONTROL.reset,
                kicker_pulse: map::KICKER_PULSE.reset,
                kicker_lockout: map::KICKER_LOCKOUT.reset,
                kicker_charge_timeout: map::KICKER_CHARGE_TIMEOUT.reset,
                clocks_per_microsecond: map::CLOCKS_PER_MICROSECOND.reset,
                leds: map::LEDS.reset,
            },
            content_hash,
            configuration: [[0; CONFIGURATION_WORDS]; 2],
            parsed: Configuration::default(),
            set_points: [[0; SET_POINT_WORDS]; 2],
            snapshots: [[0; map::SNAPSHOT_WORDS]; 2],
            latest: 0,
            held: None,
            held_bank: 0,
            sequence: 0,
            time: 0,
            pins: Pins::default(),
            encoder_errors: 0,
        }
    }

    /// Control period in clocks, as in force.
    #[must_use]
    pub fn tick_period(&self) -> u32 {
        self.plain.tick_period.max(map::MIN_TICK_PERIOD)
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

    /// Encoder filter in clocks, for whoever makes edges.
    #[must_use]
    pub fn encoder_filter(&self) -> u8 {
        self.plain.encoder_filter as u8
    }

    /// Whether the outputs may be on.
    #[must_use]
    pub fn armed(&self) -> bool {
        self.status() & 1 == 1
    }

    /// Reads the register at a byte offset; reserved and unaligned ones read zero.
    pub fn read(&mut self, offset: u16) -> u32 {
        let Some((register, index)) = map::lookup(offset) else { return 0 };
        if let Some((place, _)) = self.plain.of(register) {
            return *place;
        }
        match register.offset {
            o if o == map::CONTENT_HASH.offset => self.content_hash,
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
            o if o == map::INTEGRALS.offset => self.core.loops[index].integral.to_bits() as u32,
            o if o >= map::SNAPSHOT_SEQUENCE.offset => self.read_snapshot(usize::from(o - 0x800) / 4 + index),
            _ if register.access == map::Access::ReadOnly => register.reset,
            _ => 0,
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

    /// Writes the register at a byte offset; reserved, unaligned and read-only ones ignore it.
    pub fn write(&mut self, offset: u16, data: u32) {
        let Some((register, index)) = map::lookup(offset) else { return };
        if register.access == map::Access::LockedWhileArmed && self.armed() {
            return;
        }
        if let Some((place, mask)) = self.plain.of(register) {
            *place = data & mask;
            return;
        }
        let quiet = self.safety_inputs();
        match register.offset {
            o if o == map::ARM.offset => {
                self.safety.clock(&safety::Inputs { arm_write: true, arm_data: data, ..quiet });
            }
            o if o == map::FAULTS.offset && data != 0 => {
                self.safety.clock(&safety::Inputs { clear_faults: true, ..quiet });
                self.kicker.clock(&kicker::Inputs { clear: true, ..self.kicker_inputs() });
            }
            o if o == map::ENCODER_ERROR.offset => self.encoder_errors &= !(data as u8),
            o if o == map::COMMIT_SET_POINTS.offset => self.commit(Group::SetPoints, data),
            o if o == map::COMMIT_CONFIGURATION.offset => self.commit(Group::Configuration, data),
            o if o == map::KICKER_FIRE.offset && data == map::KICKER_FIRE_WORD => {
                self.kicker.clock(&kicker::Inputs { fire: true, ..self.kicker_inputs() });
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
        self.safety.advance(&self.safety_inputs(), period);
        self.advance_kicker(period);

        if self.commit.pending(Group::Configuration) {
            self.parsed = Configuration::from_words(&self.configuration[1 - self.commit.bank(Group::Configuration)]);
        }
        self.commit.tick();
        let safe = self.safety.outputs();
        let inputs = TickInputs {
            encoders: pins.encoders,
            now: self.time & ((1 << TIME_BITS) - 1),
            tick_period: period,
            speed_mode: if map::MODE_COUNT_AND_TIME.of(self.plain.mode) == 1 {
                SpeedMode::CountAndTime
            } else {
                SpeedMode::Difference
            },
            set_point_mode: if map::MODE_TWIST.of(self.plain.mode) == 1 {
                SetPointMode::Twist
            } else {
                SetPointMode::Wheels
            },
            set_points: self.set_points[self.commit.bank(Group::SetPoints)],
            set_points_valid: safe.setpoints_valid,
            armed: safe.armed,
            pwm_period: self.plain.pwm_period as u16,
        };
        let outputs = self.core.tick(&self.parsed, &inputs);
        self.publish(&outputs, inputs.now);
        outputs
    }

    fn publish(&mut self, outputs: &TickOutputs, now: u32) {
        let bank = 1 - self.held.unwrap_or(self.latest);
        self.sequence = self.sequence.wrapping_add(1);
        // What is pending is over at the tick.
        let (status, faults) = (self.status() & 0x0F, u32::from(self.safety.outputs().faults));
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
        for (word, component) in words[20..23].iter_mut().zip(outputs.twist) {
            *word = component as u32;
        }
        words[23] = self.sequence;
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
            | map::KICKER_READY.place(outputs.ready.into())
            | map::KICKER_TIMED_OUT.place(outputs.timed_out.into())
            | map::KICKER_DROPPED.place(outputs.dropped.into())
    }

    fn safety_inputs(&self) -> safety::Inputs {
        safety::Inputs {
            emergency_stop: self.pins.emergency_stop,
            watchdog_timeout: self.plain.watchdog_timeout,
            encoder_fault: u32::from(self.encoder_errors) & self.plain.encoder_fault_mask != 0,
            ..safety::Inputs::default()
        }
    }

    fn kicker_inputs(&self) -> kicker::Inputs {
        kicker::Inputs {
            enable: self.armed(),
            charge_request: map::KICKER_CHARGE.of(self.plain.kicker_control) == 1,
            arm_on_ball: map::KICKER_ARM_ON_BALL.of(self.plain.kicker_control) == 1,
            charge_timeout: self.plain.kicker_charge_timeout,
            pulse: self.plain.kicker_pulse as u16,
            lockout: self.plain.kicker_lockout,
            ball: self.pins.ball,
            ..kicker::Inputs::default()
        }
    }

    fn advance_kicker(&mut self, clocks: u32) {
        let quiet = self.kicker_inputs();
        for _ in 0..clocks / self.plain.clocks_per_microsecond.max(1) {
            let before = self.kicker;
            self.kicker.clock(&kicker::Inputs { microsecond: true, ..quiet });
            self.kicker.clock(&quiet);
            if self.kicker == before {
                break;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::format::Duty;
    use crate::pi::PiGains;
    use crate::registers::{CHECKSUM_SEED, checksum};

    fn stage(card: &mut Card, base: &map::Register, commit: &map::Register, words: &[i32]) {
        let mut sum = CHECKSUM_SEED;
        for (index, word) in words.iter().enumerate() {
            card.write(base.at(index), *word as u32);
            sum = checksum(sum, base.at(index) / 4, *word as u32);
        }
        card.write(commit.offset, sum);
    }

    fn driving() -> Card {
        let mut card = Card::new(0x1234);
        let mut configuration = Configuration::default();
        configuration.gains[0] = PiGains {
            kp: crate::format::ProportionalGain::from_num(16),
            ki: crate::format::IntegralGain::from_num(0.1),
            lower: -Duty::ONE,
            upper: Duty::ONE,
        };
        stage(&mut card, &map::CONFIGURATION, &map::COMMIT_CONFIGURATION, &configuration.to_words());
        card.write(map::PWM_PERIOD.offset, 1_667);
        card.tick(&Pins::default());
        stage(&mut card, &map::SET_POINTS, &map::COMMIT_SET_POINTS, &[0; 4]);
        card.write(map::ARM.offset, safety::ARM_FIRST);
        card.write(map::ARM.offset, safety::ARM_SECOND);
        assert!(card.armed());
        card
    }

    #[test]
    fn identification_and_reset_values() {
        let mut card = Card::new(0xABCD);
        for register in map::REGISTERS {
            let live = [map::FAULTS, map::FIRST_FAULT].iter().any(|r| r.offset == register.offset);
            let expected = if register.offset == map::CONTENT_HASH.offset { 0xABCD } else { register.reset };
            if !live && register.access != map::Access::WriteOnly {
                assert_eq!(card.read(register.offset), expected, "{}", register.name);
            }
        }
        assert_eq!(card.read(0x3FC), 0);
    }

    #[test]
    fn drives_after_arming_and_stops_when_the_host_is_silent() {
        let mut card = driving();
        stage(&mut card, &map::SET_POINTS, &map::COMMIT_SET_POINTS, &[1 << 22, 0, 0, 0]);
        assert_eq!(card.tick(&Pins::default()).duties[0], Duty::ONE);
        let mut ticks = 0;
        while card.armed() {
            card.tick(&Pins::default());
            ticks += 1;
            assert!(ticks <= 51, "the watchdog sleeps");
        }
        assert!(ticks >= 48);
        assert_eq!(card.tick(&Pins::default()).duties[0], Duty::ZERO);
        stage(&mut card, &map::SET_POINTS, &map::COMMIT_SET_POINTS, &[1 << 22, 0, 0, 0]);
        assert_eq!(card.tick(&Pins::default()).duties[0], Duty::ZERO, "stays off until armed again");
    }

    #[test]
    fn locked_registers_are_locked_while_armed() {
        let mut card = driving();
        card.write(map::PWM_PERIOD.offset, 5);
        assert_eq!(card.read(map::PWM_PERIOD.offset), 1_667);
        card.write(map::ARM.offset, 0);
        card.write(map::PWM_PERIOD.offset, 5);
        assert_eq!(card.read(map::PWM_PERIOD.offset), 5);
    }

    #[test]
    fn a_held_snapshot_does_not_change() {
        let mut card = Card::new(0);
        card.tick(&Pins::default());
        assert_eq!(card.read(map::SNAPSHOT_SEQUENCE.offset), 1);
        for _ in 0..3 {
            card.tick(&Pins::default());
        }
        assert_eq!(card.read(map::SNAPSHOT_SEQUENCE_END.offset), 1);
        assert_eq!(card.read(map::SNAPSHOT_SEQUENCE.offset), 4);
    }

    #[test]
    fn emergency_stop_and_encoder_error_disarm() {
        for pins in
            [Pins { emergency_stop: true, ..Pins::default() }, Pins { encoder_errors: 0b100, ..Pins::default() }]
        {
            let mut card = driving();
            card.tick(&pins);
            assert!(!card.armed(), "{pins:?}");
        }
    }
}
