//! The card as a host sees it.

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
        ..PiGains::default()
    };
    configuration.slew[0] = crate::slew::SlewLimits::NONE;
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
        // Faults of power-up come with the first clocks, which the card does not have.
        let faults = [map::FAULTS, map::FIRST_FAULT].iter().any(|r| r.offset == register.offset);
        let reset = if register.offset == map::CONTENT_HASH.offset { 0xABCD } else { register.reset };
        let live = if register.offset == map::KICKER_STATUS.offset { 0 } else { register.live };
        if !faults {
            assert_eq!(card.read(register.offset) & !live, reset & !live, "{}", register.name);
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
fn a_driven_wheel_that_only_toggles_disarms_by_name() {
    let mut card = driving();
    card.write(map::ARM.offset, 0);
    card.write(map::STALL_WINDOW.offset, 10);
    card.write(map::STALL_COMPARE.offset, 400);
    card.write(map::FAULTS.offset, u32::MAX);
    card.write(map::ARM.offset, safety::ARM_FIRST);
    card.write(map::ARM.offset, safety::ARM_SECOND);
    let mut pins = Pins::default();
    let mut ticks = 0;
    while card.armed() {
        stage(&mut card, &map::SET_POINTS, &map::COMMIT_SET_POINTS, &[1 << 22, 0, 0, 0]);
        pins.encoders[0].count ^= 1;
        card.tick(&pins);
        ticks += 1;
        assert!(ticks <= 25, "a cut wire goes unseen");
    }
    assert_eq!(card.read(map::STALL.offset), 1);
    card.tick(&pins);
    assert_eq!(card.read(map::FIRST_FAULT.offset), u32::from(safety::Fault::Stall.mask()));
    card.write(map::STALL.offset, 0b1110);
    assert_eq!(card.read(map::STALL.offset), 1, "cleared per axis");
    card.write(map::STALL.offset, 1);
    assert_eq!(card.read(map::STALL.offset), 0);
}

#[test]
fn interrupts_come_with_the_tick_and_with_disarming() {
    let mut card = driving();
    card.write(map::INTERRUPT_STATUS.offset, 3);
    assert!(card.int_n());
    card.tick(&Pins::default());
    assert!(card.int_n(), "off at reset");
    card.write(map::INTERRUPT_ENABLE.offset, 1);
    assert!(!card.int_n());
    card.write(map::INTERRUPT_STATUS.offset, 1);
    assert!(card.int_n());
    card.write(map::INTERRUPT_ENABLE.offset, 2);
    card.tick(&Pins { emergency_stop: true, ..Pins::default() });
    assert!(!card.int_n());
    assert_eq!(card.read(map::INTERRUPT_STATUS.offset), 3);
}

#[test]
fn the_capacitor_is_discharged_unless_held_and_always_at_an_emergency_stop() {
    let mut card = Card::new(0);
    assert!(card.kicker_discharges());
    card.write(map::KICKER_CONTROL.offset, map::KICKER_HOLD.place(1));
    card.tick(&Pins::default());
    assert!(!card.kicker_discharges());
    card.tick(&Pins { emergency_stop: true, ..Pins::default() });
    assert!(card.kicker_discharges());
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
fn word_0_is_always_of_the_last_tick_however_a_reader_holds() {
    let mut card = Card::new(0);
    for tick in 1..50 {
        card.tick(&Pins::default());
        assert_eq!(card.read(map::SNAPSHOT_SEQUENCE.offset), tick);
        if tick % 3 == 0 {
            assert_eq!(card.read(map::SNAPSHOT_SEQUENCE_END.offset), tick);
        }
    }
}

#[test]
fn a_sticky_fault_whose_cause_is_gone_does_not_keep_from_arming() {
    let mut card = driving();
    card.tick(&Pins { emergency_stop: true, ..Pins::default() });
    assert!(!card.armed());
    card.tick(&Pins::default());
    stage(&mut card, &map::SET_POINTS, &map::COMMIT_SET_POINTS, &[0; 4]);
    card.write(map::COMMIT_SET_POINTS.offset, 1);
    for word in [safety::ARM_SECOND, safety::ARM_FIRST, safety::ARM_SECOND] {
        card.write(map::ARM.offset, word);
    }
    assert!(card.armed());
    let faults = [safety::Fault::EmergencyStop, safety::Fault::CommitChecksum, safety::Fault::ArmRefused];
    for fault in faults {
        let before = card.read(map::FAULTS.offset);
        assert_eq!(before & u32::from(fault.mask()), u32::from(fault.mask()), "{fault:?}");
        card.write(map::FAULTS.offset, fault.mask().into());
        assert_eq!(card.read(map::FAULTS.offset), before & !u32::from(fault.mask()), "a one clears its bit alone");
    }
}

#[test]
fn a_block_reads_as_so_many_words() {
    let mut block = driving();
    let mut words = block.clone();
    for tick in 0..20_u16 {
        for card in [&mut block, &mut words] {
            card.tick(&Pins::default());
        }
        // From before the snapshot, at it, inside of it, and beyond its end; some of them hold it.
        let offset =
            [map::INTEGRALS.offset, map::SNAPSHOT_SEQUENCE.offset, map::SNAPSHOT_TIME.offset][usize::from(tick % 3)];
        let mut together = [0; map::SNAPSHOT_WORDS + 3];
        let length = if tick % 4 == 3 { together.len() } else { map::SNAPSHOT_WORDS };
        block.read_block(offset, &mut together[..length]);
        for (index, word) in together[..length].iter().enumerate() {
            assert_eq!(*word, words.read(offset + 4 * index as u16), "tick {tick}, word {index}");
        }
    }
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
    for pins in [Pins { emergency_stop: true, ..Pins::default() }, Pins { encoder_errors: 0b100, ..Pins::default() }] {
        let mut card = driving();
        card.tick(&pins);
        assert!(!card.armed(), "{pins:?}");
    }
}
