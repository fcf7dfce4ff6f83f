//! The kicker of the whole card: a ball fires it where that was asked for, and only there.

use fixed_kin::card::{Card, Pins};
use fixed_kin::control::Configuration;
use fixed_kin::registers::{self, CHECKSUM_SEED, Register, checksum};
use fixed_kin::safety;

/// Stages words and commits them.
fn commit(card: &mut Card, base: &Register, commit: &Register, words: &[i32]) {
    let mut sum = CHECKSUM_SEED;
    for (index, word) in words.iter().enumerate() {
        card.write(base.at(index), *word as u32);
        sum = checksum(sum, base.at(index) / 4, *word as u32);
    }
    card.write(commit.offset, sum);
}

fn armed() -> Card {
    let mut card = Card::new(1);
    let words = Configuration::default().to_words();
    commit(&mut card, &registers::CONFIGURATION, &registers::COMMIT_CONFIGURATION, &words);
    card.write(registers::PWM_PERIOD.offset, 1_667);
    card.tick(&Pins::default());
    commit(&mut card, &registers::SET_POINTS, &registers::COMMIT_SET_POINTS, &[0; 4]);
    card.write(registers::ARM.offset, safety::ARM_FIRST);
    card.write(registers::ARM.offset, safety::ARM_SECOND);
    assert!(card.armed());
    card.write(registers::KICKER_PULSE.offset, 2_000);
    card
}

#[test]
fn a_ball_fires_only_what_waits_for_one() {
    for waits in [false, true] {
        let mut card = armed();
        let seen = |card: &mut Card, field: registers::Field| field.of(card.read(registers::KICKER_STATUS.offset));
        card.write(registers::KICKER_CONTROL.offset, registers::KICKER_ARM_ON_BALL.place(u32::from(waits)));
        card.tick(&Pins::default());
        assert_eq!(seen(&mut card, registers::KICKER_READY), 1);
        assert_eq!(seen(&mut card, registers::KICKER_ON_BALL), u32::from(waits));
        // Two milliseconds of pulse: it is not over at the next tick.
        card.tick(&Pins { ball: true, ..Pins::default() });
        assert_eq!(seen(&mut card, registers::KICKER_READY), u32::from(!waits), "{waits}");
    }
}

#[test]
fn only_its_word_fires() {
    for (word, fires) in [(registers::KICKER_FIRE_WORD, true), (registers::KICKER_FIRE_WORD ^ 1, false), (1, false)] {
        let mut card = armed();
        card.tick(&Pins::default());
        card.write(registers::KICKER_FIRE.offset, word);
        card.tick(&Pins::default());
        let ready = registers::KICKER_READY.of(card.read(registers::KICKER_STATUS.offset));
        assert_eq!(ready, u32::from(!fires), "{word:#x}");
    }
}
