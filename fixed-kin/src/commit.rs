//! Staged writes and their commit: all at once at the next control tick, or nothing changes.
//!
//! A group, set points or configuration, is staged word by word and committed with the checksum
//! over the writes. The commit counts only with the right sum and the right number of words, all of
//! one group. A staged write while a commit of its group waits for the tick takes that commit back:
//! newer values are on their way, and a tick must not see half of them.

#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_possible_wrap,
    reason = "words are raw bits"
)]

use crate::control::{CONFIGURATION_WORDS, SET_POINT_WORDS};
use crate::registers::{CHECKSUM_SEED, checksum};

/// What is staged and committed together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Group {
    /// Wheel speeds or body velocity.
    SetPoints,
    /// Matrices and gains.
    Configuration,
}

/// State of the commit block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Commit {
    sum: u32,
    words: [u8; 2],
    waiting: [bool; 2],
    bank: [bool; 2],
    /// Right commits, wrapping.
    pub accepted: u16,
    /// Wrong commits, wrapping.
    pub rejected: u16,
}

impl Default for Commit {
    fn default() -> Self {
        Self { sum: CHECKSUM_SEED, words: [0; 2], waiting: [false; 2], bank: [false; 2], accepted: 0, rejected: 0 }
    }
}

impl Commit {
    /// Bank of a group in force; staged words go to the other one.
    #[must_use]
    pub fn bank(&self, group: Group) -> usize {
        usize::from(self.bank[group as usize])
    }

    /// Whether a commit waits for the tick.
    #[must_use]
    pub fn pending(&self, group: Group) -> bool {
        self.waiting[group as usize]
    }

    /// A staged write.
    pub fn stage(&mut self, group: Group, word_address: u16, data: u32) {
        let words = &mut self.words[group as usize];
        *words = (*words + 1).min(63);
        self.sum = checksum(self.sum, word_address, data);
        self.waiting[group as usize] = false;
    }

    /// A commit; returns whether it counts.
    pub fn commit(&mut self, group: Group, sum: u32) -> bool {
        let expected = match group {
            Group::SetPoints => [SET_POINT_WORDS as u8, 0],
            Group::Configuration => [0, CONFIGURATION_WORDS as u8],
        };
        let right = sum == self.sum && self.words == expected;
        self.sum = CHECKSUM_SEED;
        self.words = [0; 2];
        if right {
            self.accepted = self.accepted.wrapping_add(1);
            self.waiting[group as usize] = true;
        } else {
            self.rejected = self.rejected.wrapping_add(1);
        }
        right
    }

    /// A control tick starts: what waits comes into force.
    pub fn tick(&mut self) {
        for group in 0..2 {
            self.bank[group] ^= self.waiting[group];
            self.waiting[group] = false;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stage(commit: &mut Commit, words: u16) -> u32 {
        (0..words).fold(CHECKSUM_SEED, |sum, i| {
            commit.stage(Group::SetPoints, 0x180 + i, 7);
            checksum(sum, 0x180 + i, 7)
        })
    }

    #[test]
    fn a_right_commit_flips_the_bank_at_the_tick() {
        let mut commit = Commit::default();
        let sum = stage(&mut commit, 4);
        assert!(commit.commit(Group::SetPoints, sum));
        assert_eq!(commit.bank(Group::SetPoints), 0);
        commit.tick();
        assert_eq!((commit.bank(Group::SetPoints), commit.bank(Group::Configuration)), (1, 0));
        commit.tick();
        assert_eq!(commit.bank(Group::SetPoints), 1);
    }

    #[test]
    fn wrong_sum_short_or_of_the_other_group_changes_nothing() {
        let mut commit = Commit::default();
        let sum = stage(&mut commit, 4);
        assert!(!commit.commit(Group::SetPoints, sum ^ 1));
        let short = stage(&mut commit, 3);
        assert!(!commit.commit(Group::SetPoints, short));
        let sum = stage(&mut commit, 4);
        assert!(!commit.commit(Group::Configuration, sum));
        commit.tick();
        assert_eq!((commit.bank(Group::SetPoints), commit.accepted, commit.rejected), (0, 0, 3));
    }

    #[test]
    fn newer_words_take_a_waiting_commit_back() {
        let mut commit = Commit::default();
        let sum = stage(&mut commit, 4);
        assert!(commit.commit(Group::SetPoints, sum));
        stage(&mut commit, 1);
        commit.tick();
        assert_eq!(commit.bank(Group::SetPoints), 0);
    }
}
