//! Where every word of the sequencer's memory stands.
//!
//! | address | words | bank switched by |
//! |---|---|---|
//! | 00–3F | configuration, second bank at 40–7F | commit of the configuration |
//! | 80–83 | set points, second bank at 88–8B | commit of set points |
//! | 8C–BF | state, temporaries, constants | |
//! | C0–D7 | snapshot, second bank at E0–F7, third in D8–DF, F8–FF, 78–7F | start of a control tick |
//!
//! The program names the first bank; the sequencer puts in the others.

use fixed_kin::AXES;
use fixed_kin::pose;
use fixed_kin::registers;
use fixed_kin::speed::EDGE_TIMEOUT;

/// Of 32 bits, for values between two instructions.
pub const MEMORY_WORDS: usize = 256;

/// An address of the program: a word, or one word per axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cell {
    address: u8,
    per_axis: bool,
}

impl Cell {
    const fn scalar(address: usize) -> Self {
        Self { address: address as u8, per_axis: false }
    }

    /// One word per axis; the address ends in zeros, so that the axis number is just put in.
    const fn axis(address: usize) -> Self {
        assert!(address.is_multiple_of(AXES));
        Self { address: address as u8, per_axis: true }
    }

    /// Fixed word `index` after this one.
    pub(super) const fn word(self, index: usize) -> Self {
        Self::scalar(self.address as usize + index)
    }

    pub(super) fn encode(self) -> u16 {
        u16::from(self.per_axis) << 10 | u16::from(self.address)
    }
}

/// Whether two operands may mean the same word, for some axis each.
pub(super) fn overlap(first: u16, second: u16) -> bool {
    let words = |operand: u16| {
        let address = operand & 0xFF;
        address..address + if operand & 1 << 10 == 0 { 1 } else { AXES as u16 }
    };
    let (first, second) = (words(first), words(second));
    first.start < second.end && second.start < first.end
}

/// First word of the first bank of the snapshot.
const SNAPSHOT: usize = 0xC0;
/// Where the third bank's words stand, eight by eight.
const THIRD_BANK: [usize; 3] = [0xD8, 0xF8, 0x78];

/// Where a word of a snapshot stands, for each of the three banks.
#[must_use]
pub const fn snapshot_address(bank: usize, word: usize) -> usize {
    match bank {
        0 => SNAPSHOT + word,
        1 => SNAPSHOT + 0x20 + word,
        _ => THIRD_BANK[word / 8] + word % 8,
    }
}

const fn snapshot(register: &registers::Register) -> usize {
    SNAPSHOT + (register.offset - registers::SNAPSHOT_SEQUENCE.offset) as usize / 4
}

/// Column `k` of the inverse matrix.
pub(super) const fn inverse_column(k: usize) -> Cell {
    Cell::axis(k * AXES)
}

/// Row `k` of the direct matrix.
pub(super) const fn direct_row(k: usize) -> Cell {
    Cell::axis((3 + k) * AXES)
}

pub(super) const KP: Cell = Cell::axis(6 * AXES);
pub(super) const KI: Cell = Cell::axis(7 * AXES);
pub(super) const LOWER: Cell = Cell::axis(8 * AXES);
pub(super) const UPPER: Cell = Cell::axis(9 * AXES);
pub(super) const KFF: Cell = Cell::axis(10 * AXES);
pub(super) const FALL: Cell = Cell::axis(11 * AXES);
pub(super) const RISE: Cell = Cell::axis(12 * AXES);
pub(super) const SET_POINT: Cell = Cell::axis(0x80);

pub(super) const HOME: Cell = Cell::axis(0x8C);
pub(super) const COUNT: Cell = Cell::axis(0x90);
pub(super) const EDGE_TIME: Cell = Cell::axis(0x94);
pub(super) const LINE: Cell = Cell::axis(0x98);
pub(super) const INDEX_POSITION: Cell = Cell::axis(0x9C);
pub(super) const SPEED: Cell = Cell::axis(0xA0);
pub(super) const INTEGRAL: Cell = Cell::axis(0xA4);
pub(super) const DISPLACEMENT: Cell = Cell::scalar(0xA8);
pub(super) const SEQUENCE: Cell = Cell::scalar(0xAB);
pub(super) const REFERENCE: Cell = Cell::axis(0xAC);

pub(super) const DIFFERENCE: Cell = Cell::scalar(0xB0);
pub(super) const CASE: Cell = Cell::scalar(0xB1);
pub(super) const DENOMINATOR: Cell = Cell::scalar(0xB2);
pub(super) const FORWARD: Cell = Cell::scalar(0xB3);
pub(super) const ERROR: Cell = Cell::scalar(0xB4);
pub(super) const PROPORTIONAL: Cell = Cell::scalar(0xB5);
/// In the place of the denominator, which the divider has taken by then.
pub(super) const NEW_INTEGRAL: Cell = DENOMINATOR;
pub(super) const SUM: Cell = Cell::scalar(0xB7);
pub(super) const DUTY: Cell = Cell::scalar(0xB8);
pub(super) const SCRATCH: Cell = Cell::scalar(0xB9);

pub(super) const HEADING: Cell = Cell::scalar(0xB6);
pub(super) const POSE_X: Cell = Cell::scalar(0xBA);
pub(super) const POSE_Y: Cell = Cell::scalar(0xBB);

pub(super) const TIMEOUT: Cell = Cell::scalar(0xBC);
pub(super) const ROUNDING: Cell = Cell::scalar(0xBD);
pub(super) const ALL_ONES: Cell = Cell::scalar(0xBE);
pub(super) const ARC: Cell = Cell::scalar(0xBF);

pub(super) const SNAPSHOT_SEQUENCE: Cell = Cell::scalar(snapshot(&registers::SNAPSHOT_SEQUENCE));
pub(super) const SNAPSHOT_STATUS: Cell = Cell::scalar(snapshot(&registers::SNAPSHOT_STATUS));
pub(super) const SNAPSHOT_TIME: Cell = Cell::scalar(snapshot(&registers::SNAPSHOT_TIME));
pub(super) const SNAPSHOT_FAULTS: Cell = Cell::scalar(snapshot(&registers::SNAPSHOT_FAULTS));
pub(super) const SNAPSHOT_POSE: Cell = Cell::scalar(snapshot(&registers::SNAPSHOT_POSE));
pub(super) const SNAPSHOT_SEQUENCE_END: Cell = Cell::scalar(snapshot(&registers::SNAPSHOT_SEQUENCE_END));
pub(super) const SNAPSHOT_COUNT: Cell = Cell::axis(snapshot(&registers::SNAPSHOT_COUNT));
pub(super) const SNAPSHOT_SPEED: Cell = Cell::axis(snapshot(&registers::SNAPSHOT_SPEED));
pub(super) const SNAPSHOT_REFERENCE: Cell = Cell::axis(snapshot(&registers::SNAPSHOT_REFERENCE));
pub(super) const SNAPSHOT_DUTY: Cell = Cell::axis(snapshot(&registers::SNAPSHOT_DUTY));

/// What the memory holds when the FPGA is configured: zeros, the constants of the program, and no edge seen.
#[must_use]
pub fn initial_memory() -> Vec<u32> {
    let mut words = vec![0; MEMORY_WORDS];
    words[TIMEOUT.address as usize] = EDGE_TIMEOUT;
    words[ROUNDING.address as usize] = 1 << 11;
    words[ALL_ONES.address as usize] = u32::MAX;
    words[ARC.address as usize] = pose::ARC as u32;
    // No edge has been seen yet.
    words[LINE.address as usize..][..AXES].fill(u32::MAX);
    words
}
