//! A random walk over the whole register window of the compiled chip against the bit-true card:
//! plain, locked, read-only, write-only and reserved words, single and in bursts.

use driver::Registers;
use fixed_kin::card::{Card, Pins};
use fixed_kin::registers::{self as map, REGISTERS};
use rand::{Rng, RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use simulator::fpga::Verilog;

const STEPS: usize = 60_000;

/// Words that move by themselves in the chip: time, interrupts of ticks, the sensor's line, and snapshots of ticks that the card has not seen.
fn moves(offset: u16) -> bool {
    [map::TIME.offset, map::INTERRUPT_STATUS.offset, map::IMU_STATUS.offset].contains(&offset)
        || (map::SNAPSHOT_SEQUENCE.offset..=map::SNAPSHOT_IMU.at(7)).contains(&offset)
}

fn offset(random: &mut ChaCha8Rng) -> u16 {
    let any = match random.random_range(0..4) {
        0 => random.random_range(0..0x4000) * 4,
        1 => random.random_range(0..0x240) * 4,
        _ => {
            let register = REGISTERS[random.random_range(0..REGISTERS.len())];
            register.at(random.random_range(0..usize::from(register.words)))
        }
    };
    if any == map::TICK_PERIOD.offset { map::LEDS.offset } else { any }
}

#[test]
fn the_register_window_equals_the_card() {
    let mut chip = Verilog::new().unwrap_or_else(|error| panic!("{error}"));
    let mut card = Card::new(hdl::design::content_hash());
    // Power-up counts as bitten, stopped and without crystal; wait for that to pass.
    for _ in 0..1_000 {
        chip.read(map::TIME.offset).unwrap();
    }
    card.tick(&Pins::default());
    chip.write(map::FAULTS.offset, u32::MAX).unwrap();
    card.write(map::FAULTS.offset, u32::MAX);

    let mut random = ChaCha8Rng::seed_from_u64(9);
    let mut compared = 0;
    for step in 0..STEPS {
        let at = offset(&mut random);
        match random.random_range(0..3) {
            0 => {
                let data = match random.random_range(0..3) {
                    0 => random.next_u32(),
                    1 => random.random_range(0..4),
                    _ => u32::MAX,
                };
                chip.write(at, data).unwrap();
                card.write(at, data);
            }
            1 => {
                let got = chip.read(at).unwrap();
                if !moves(at) {
                    assert_eq!(got, card.read(at), "step {step}, offset {at:#x}");
                    compared += 1;
                }
            }
            _ => {
                let count = random.random_range(1..40_u16).min((0xFFFC - at) / 4 + 1);
                let mut words = vec![0; usize::from(count)];
                chip.read_block(at, &mut words).unwrap();
                for (index, got) in words.into_iter().enumerate() {
                    let at = at + 4 * index as u16;
                    if !moves(at) {
                        assert_eq!(got, card.read(at), "step {step}, offset {at:#x} in a burst");
                        compared += 1;
                    }
                }
            }
        }
    }
    assert!(compared > STEPS, "{compared}");
}

#[test]
fn every_register_starts_at_its_reset_value() {
    let mut chip = Verilog::new().unwrap_or_else(|error| panic!("{error}"));
    for register in REGISTERS {
        if register.offset == map::CONTENT_HASH.offset {
            continue;
        }
        for index in 0..usize::from(register.words) {
            let (got, fixed) = (chip.read(register.at(index)).unwrap(), !register.live);
            assert_eq!(got & fixed, register.reset & fixed, "{} {index}", register.name);
        }
    }
    assert_eq!(chip.read(map::CONTENT_HASH.offset).unwrap(), hdl::design::content_hash());
}
