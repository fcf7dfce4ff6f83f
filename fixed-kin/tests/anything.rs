//! No panic, whatever the arguments: each public function with words at their ends and between (overflow checks are on), the
//! whole card with reads, writes and pins in any order.

use fixed_kin::card::{Card, Pins};
use fixed_kin::control::{CONFIGURATION_WORDS, Configuration, Core, IndexCapture, SetPointMode, TickInputs};
use fixed_kin::encoder::GlitchFilter;
use fixed_kin::format::{Duty, FeedForwardGain, Format, IntegralGain, ProportionalGain, Speed};
use fixed_kin::pi::{PiGains, PiState};
use fixed_kin::radio::{self, Frame};
use fixed_kin::safety::{self, ARM_FIRST, ARM_SECOND};
use fixed_kin::serial::Receiver;
use fixed_kin::slew::SlewLimits;
use fixed_kin::speed::{EncoderSample, SpeedMode, SpeedState};
use fixed_kin::{kicker, modulation, pose, recording, registers, serial_host, stall};
use proptest::prelude::*;
use std::cell::RefCell;

/// Words without end, one in three at an end of its range.
struct Words(u64);

/// Takes a result that only had to come.
fn came<T>(_: T) {}

impl Words {
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        self.0 ^ self.0 >> 33
    }

    fn any(&mut self) -> u32 {
        match self.bits() % 12 {
            0 => 0,
            1 => u32::MAX,
            2 => 1 << 31,
            3 => u32::MAX >> 1,
            _ => self.bits() as u32,
        }
    }

    fn signed(&mut self) -> i32 {
        self.any() as i32
    }

    fn flag(&mut self) -> bool {
        self.bits() % 2 == 1
    }

    fn speed(&mut self) -> Speed {
        Speed::from_bits(self.signed())
    }

    fn duty(&mut self) -> Duty {
        Duty::from_bits(self.signed())
    }

    fn sample(&mut self) -> EncoderSample {
        EncoderSample { count: self.any() as u16, edge_time: self.any(), direction: self.flag() }
    }

    fn mode(&mut self) -> SpeedMode {
        if self.flag() { SpeedMode::Difference } else { SpeedMode::CountAndTime }
    }

    fn gains(&mut self) -> PiGains {
        PiGains {
            kp: ProportionalGain::from_bits(self.signed()),
            ki: IntegralGain::from_bits(self.signed()),
            kff: FeedForwardGain::from_bits(self.signed()),
            lower: self.duty(),
            upper: self.duty(),
        }
    }

    fn tick(&mut self) -> TickInputs {
        TickInputs {
            encoders: std::array::from_fn(|_| self.sample()),
            indices: std::array::from_fn(|_| IndexCapture {
                event: self.flag(),
                clear: self.flag(),
                count: self.any() as u16,
            }),
            now: self.any(),
            tick_period: self.any(),
            speed_mode: self.mode(),
            set_point_mode: if self.flag() { SetPointMode::Wheels } else { SetPointMode::Twist },
            odometry: self.flag(),
            set_points: std::array::from_fn(|_| self.signed()),
            set_points_valid: self.flag(),
            armed: self.flag(),
            pwm_period: self.any() as u16,
        }
    }

    fn pins(&mut self) -> Pins {
        Pins {
            encoders: std::array::from_fn(|_| self.sample()),
            encoder_errors: self.any() as u8,
            indices: std::array::from_fn(|_| self.flag().then_some(self.any() as u16)),
            emergency_stop: self.flag(),
            ball: self.flag(),
            kicker_full: self.flag(),
            ..Pins::default()
        }
    }
}

proptest! {
    #[test]
    fn functions(seed: u64) {
        let mut w = Words(seed);
        for _ in 0..50 {
            let mut state = PiState { integral: w.duty() };
            let (gains, now) = (w.gains(), w.any());
            let _ = (state.step(&gains, w.speed(), w.speed()), PiState::after(&gains, w.speed(), w.speed(), w.duty()));
            let _ = (SlewLimits::NONE.step(w.speed(), w.speed()), modulation::modulate(w.duty(), now as u16));
            let _ = (pose::sine(now, w.any()), pose::fraction(now), kicker::microsecond_clocks(now));
            let _ = (Format::DUTY.round(f64::from_bits(w.bits())), registers::lookup(now as u16));
            let mut speed = SpeedState::default();
            (speed.count, speed.speed) = (w.signed(), w.speed());
            (0..3).for_each(|_| came(speed.step(w.sample(), w.any(), w.any(), w.mode())));
            let mut standing = pose::Pose { x: w.signed(), y: w.signed(), heading: w.any() };
            standing.step([w.signed(), w.signed(), w.signed()]);
            let words: [i32; CONFIGURATION_WORDS] = std::array::from_fn(|_| w.signed());
            let mut core = Core::default();
            (0..3).for_each(|_| came(core.tick(&Configuration::from_words(&words), &w.tick())));
        }
    }

    #[test]
    fn blocks(seed: u64, clocks_per_bit: u16) {
        let mut w = Words(seed);
        let (mut line, mut radio) = (Receiver::new(clocks_per_bit), radio::Radio::new(clocks_per_bit));
        let (mut off, mut kicker) = (safety::Safety::default(), kicker::Kicker::default());
        let (mut filter, mut wheel, mut window) =
            (GlitchFilter::default(), stall::Stall::default(), stall::Window::default());
        for _ in 0..500 {
            line.clock(w.flag(), w.flag());
            radio.clock(&radio::Inputs::default());
            filter.clock(w.flag(), w.flag(), w.any() as u8, w.flag());
            wheel.step(w.flag(), w.signed());
            window.tick(w.any() as u16);
            let inputs = safety::Inputs {
                arm_write: w.flag(),
                arm_data: if w.flag() { ARM_FIRST } else { ARM_SECOND },
                pet: w.flag(),
                watchdog_timeout: w.any(),
                tick: w.flag(),
                set_point_timeout: w.any() as u16,
                ..safety::Inputs::default()
            };
            off.clock(&inputs);
            off.advance(&inputs, w.any());
            kicker.clock(&kicker::Inputs {
                enable: w.flag(),
                microsecond: w.flag(),
                charge_request: w.flag(),
                charge_timeout: w.any(),
                fire: w.flag(),
                pulse: w.any() as u16,
                lockout: w.any(),
                ..kicker::Inputs::default()
            });
        }
    }

    #[test]
    fn the_card(seed: u64) {
        let mut w = Words(seed);
        let mut card = if w.flag() { Card::new(w.any()) } else { Card::slave(w.any(), w.any() as u8) };
        for _ in 0..400 {
            let register = registers::REGISTERS[w.bits() as usize % registers::REGISTERS.len()];
            match w.bits() % 6 {
                0 => came(card.read(w.any() as u16)),
                1 => card.write(register.at(w.bits() as usize % usize::from(register.words)), w.any()),
                2 => card.set_time(w.any()),
                3 => [ARM_FIRST, ARM_SECOND].iter().for_each(|word| card.write(registers::ARM.offset, *word)),
                4 => card.imu().answer(w.any() as u8),
                _ => came(card.tick(&w.pins())),
            }
        }
        card.read_block(w.any() as u16, &mut vec![0; 20_000]);
    }

    #[test]
    fn what_was_recorded_and_what_came_by_a_line(seed: u64, bytes: Vec<u8>, robot: u8) {
        let w = RefCell::new(Words(seed));
        let found = recording::RecordedWords::find(|_| {
            let mut w = w.borrow_mut();
            let shift = w.bits() % 64;
            Some(w.bits() as i64 >> shift)
        });
        let mut w = w.into_inner();
        if let Ok(found) = found {
            let mut replay = recording::LoopReplay::new(found.gains);
            (0..20).for_each(|_| came(replay.step(w.speed(), w.speed(), w.flag().then_some(w.duty()))));
        }
        let _ = (radio::decode(&bytes, robot), serial_host::reply(&bytes));
        if let Ok(mut frame) = Frame::new(robot, w.any() as u8) {
            (0..100).for_each(|_| came(frame.write(w.any() as u16, w.any())));
            let whole = frame.bytes().to_vec();
            (0..whole.len()).for_each(|n| came(radio::decode(&whole[..n], robot).map(|(_, writes)| writes.count())));
        }
    }
}
