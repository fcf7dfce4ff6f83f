//! Where a word of a snapshot stands in the sequencer's memory: combinational.
//!
//! | bank | words 0–7 | 8–15 | 16–23 |
//! |---|---|---|---|
//! | 0 | C0 | C8 | D0 |
//! | 1 | E0 | E8 | F0 |
//! | 2 | D8 | F8 | 78 |
//!
//! The third bank is made of what the others and the configuration leave over, so that two block memories
//! are enough. `hdl::program::layout::snapshot_address` is the same table.

use crate::primitives::Literal;
use rust_hdl::prelude::*;

/// See the module.
#[derive(LogicBlock, Default)]
pub struct SnapshotAddress {
    /// Number of the word in the snapshot, 0 to 23.
    pub word: Signal<In, Bits<5>>,
    /// Bank that the word is in, 0 to 2.
    pub bank: Signal<In, Bits<2>>,
    /// Address in the memory.
    pub address: Signal<Out, Bits<8>>,

    wide: Signal<Local, Bits<8>>,
    row: Signal<Local, Bits<8>>,
    at_first: Literal<8, 0xC0>,
    at_second: Literal<8, 0xE0>,
    at_third: Literal<8, 0xD8>,
    at_third_middle: Literal<8, 0xF8>,
    at_third_end: Literal<8, 0x78>,
}

impl Logic for SnapshotAddress {
    #[hdl_gen]
    fn update(&mut self) {
        self.wide.next = bit_cast::<8, 5>(self.word.val());
        self.row.next = bit_cast::<8, 3>(self.word.val().get_bits::<3>(0));
        self.address.next = self.wide.val() | self.at_first.val();
        if self.bank.val().get_bit(0) {
            self.address.next = self.wide.val() | self.at_second.val();
        }
        if self.bank.val().get_bit(1) {
            self.address.next = self.row.val() | self.at_third.val();
            if self.word.val().get_bit(3) {
                self.address.next = self.row.val() | self.at_third_middle.val();
            }
            if self.word.val().get_bit(4) {
                self.address.next = self.row.val() | self.at_third_end.val();
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::program::layout::{MEMORY_WORDS, snapshot_address};
    use fixed_kin::registers::SNAPSHOT_WORDS;

    #[test]
    fn the_block_is_the_table_and_no_two_words_share_a_place() {
        let mut block = SnapshotAddress::default();
        block.connect_all();
        let mut taken = [false; MEMORY_WORDS];
        for bank in 0..3 {
            for word in 0..SNAPSHOT_WORDS {
                block.word.next = (word as u64).to_bits();
                block.bank.next = (bank as u64).to_bits();
                block.update_all();
                block.update_all();
                let address = block.address.val().index();
                assert_eq!(address, snapshot_address(bank, word), "bank {bank}, word {word}");
                assert!(!std::mem::replace(&mut taken[address], true), "{address:#x} twice");
            }
        }
        let free = |range: std::ops::Range<usize>| taken[range].iter().all(|taken| !taken);
        assert!(free(0..0x34) && free(0x40..0x74) && free(0x80..0xC0));
    }
}
