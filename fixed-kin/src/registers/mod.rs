//! The register map: one typed table from which the bus decoder's addresses, the driver's registers and
//! the documents in `generated/` all come.
//!
//! Conventions:
//! 1. Offsets are in bytes from the start of BAR 5; every access is an aligned 32-bit word.
//! 2. Reads have no side effect but one: reading word 0 of the snapshot latches the snapshot.
//! 3. Reserved addresses read zero; writes to them, and to read-only registers, do nothing.
//! 4. Set points and configuration are **staged**: they act only when the commit register is
//!    written with the right checksum ([`checksum`]), and then all at once at the next control tick.
//! 5. A register marked *locked while armed* ignores writes while the outputs may be on.
//! 6. A staged word has 30 bits; the upper two are replaced by its sign.
//! 7. The minor number of [`VERSION`] counts additions and mends that a driver of an older minor number can
//!    live with; the major number counts all others.

#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_possible_wrap,
    reason = "words are raw bits; offsets fit 16 bits"
)]

mod fields;
mod map;
mod rules;

pub use fields::*;
pub use map::*;
pub use rules::*;

/// Version of this map: major in the high half, minor in the low half. The driver refuses another major.
pub const VERSION: u32 = 0x0002_0003;

/// Who may do what with a register.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Access {
    /// Constant or status.
    ReadOnly,
    /// Plain register.
    ReadWrite,
    /// Plain register that ignores writes while armed.
    LockedWhileArmed,
    /// Writes act, reads give zero.
    WriteOnly,
    /// Status whose set bits are cleared by writing ones to them.
    WriteOneToClear,
    /// Memory that acts at the next tick after a commit.
    Staged,
}

impl Access {
    /// Short form for tables.
    #[must_use]
    pub const fn symbol(self) -> &'static str {
        match self {
            Self::ReadOnly => "R",
            Self::ReadWrite => "RW",
            Self::LockedWhileArmed => "RW, locked while armed",
            Self::WriteOnly => "W",
            Self::WriteOneToClear => "R, W1C",
            Self::Staged => "RW, staged",
        }
    }
}

/// How the 32 bits of a register are read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Unsigned number of so many bits.
    Unsigned(u32),
    /// Signed fixed-point number.
    Fixed(crate::format::Format),
    /// Four ASCII characters, first in the highest byte.
    Text,
    /// Separate bits.
    Fields(&'static [Field]),
}

/// A bit field of a register.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Field {
    /// Name, in kebab-case.
    pub name: &'static str,
    /// Lowest bit.
    pub bit: u32,
    /// How many bits it has.
    pub width: u32,
    /// What it says.
    pub text: &'static str,
    /// Block of the gateware that raises it, for a fault; else empty.
    pub block: &'static str,
}

impl Field {
    /// The field's value in `word`.
    #[must_use]
    #[inline]
    pub const fn of(&self, word: u32) -> u32 {
        (word >> self.bit) & (u32::MAX >> (32 - self.width))
    }

    /// Whether any bit of the field is set in `word`.
    #[must_use]
    #[inline]
    pub const fn is_set(&self, word: u32) -> bool {
        self.of(word) != 0
    }

    /// `value` at the field's place; excess bits are dropped.
    #[must_use]
    #[inline]
    pub const fn place(&self, value: u32) -> u32 {
        (value & (u32::MAX >> (32 - self.width))) << self.bit
    }
}

/// A word that means something of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Value {
    /// Name, in kebab-case.
    pub name: &'static str,
    /// All 32 bits, as written or read.
    pub word: u32,
    /// What it does.
    pub text: &'static str,
}

/// Words of an array that belong together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Group {
    /// Name, in `snake_case`.
    pub name: &'static str,
    /// Its first word in the array.
    pub first: usize,
    /// Words, one per axis where there are as many as axes.
    pub words: usize,
    /// Format of a word.
    pub format: crate::format::Format,
    /// Unit of the value.
    pub unit: &'static str,
    /// What the register map says of it.
    pub text: &'static str,
}

/// A board that the design drives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Target {
    /// What `board` reads: four characters.
    pub word: u32,
    /// What `clock_hz` reads.
    pub clock_hz: u32,
    /// Which board that is.
    pub text: &'static str,
}

/// A register, or an array of them at consecutive words.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Register {
    /// Name, in `snake_case`.
    pub name: &'static str,
    /// Byte offset in BAR 5.
    pub offset: u16,
    /// Words; more than one is an array, mostly one word per axis.
    pub words: u16,
    /// Who may read and write it, and when.
    pub access: Access,
    /// Meaning of the bits.
    pub kind: Kind,
    /// What it reads after configuration of the FPGA while nothing is connected to the pins, which are then
    /// pulled up.
    pub reset: u32,
    /// Bits of [`Self::reset`] that follow pins or time.
    pub live: u32,
    /// Words that mean something of their own.
    pub values: &'static [Value],
    /// Groups of an array.
    pub groups: &'static [Group],
    /// What zero means, where it is no plain number; else empty.
    pub zero: &'static str,
    /// What it is for, and its unit.
    pub text: &'static str,
}

impl Register {
    /// Reads `reset` while nothing is connected; the bits of `live` follow pins or time.
    pub(crate) const fn starts(self, reset: u32, live: u32) -> Self {
        Self { reset, live, ..self }
    }

    pub(crate) const fn values(self, values: &'static [Value]) -> Self {
        Self { values, ..self }
    }

    pub(crate) const fn groups(self, groups: &'static [Group]) -> Self {
        Self { groups, ..self }
    }

    pub(crate) const fn zero(self, zero: &'static str) -> Self {
        Self { zero, ..self }
    }

    /// Byte offset of word `index` of an array.
    ///
    /// # Panics
    /// If the array has no such word: a bug in the caller, never input.
    #[must_use]
    #[inline]
    pub const fn at(&self, index: usize) -> u16 {
        assert!(index < self.words as usize, "no such word in this register array");
        self.offset + 4 * index as u16
    }

    /// Bits that a write keeps and a read gives back, of a register that is memory and nothing else; 0 of any other.
    #[must_use]
    pub const fn kept(&self) -> u32 {
        let memory = matches!(self.access, Access::ReadWrite | Access::LockedWhileArmed);
        match self.kind {
            Kind::Unsigned(bits) if memory && self.live == 0 => u32::MAX >> (32 - bits),
            Kind::Fields(fields) if memory && self.live == 0 => {
                let (mut kept, mut i) = (0, 0);
                while i < fields.len() {
                    kept |= fields[i].place(u32::MAX);
                    i += 1;
                }
                kept
            }
            _ => 0,
        }
    }

    /// Word address, as the local bus counts.
    #[must_use]
    pub const fn word_address(&self) -> u16 {
        self.offset / 4
    }
}

/// Words of the window that registers stand in; what lies above is reserved.
const WINDOW_WORDS: usize = 0x240;

/// For every word of the window its place in [`REGISTERS`] plus one; 0 is reserved.
static PLACES: [u8; WINDOW_WORDS] = {
    let mut places = [0; WINDOW_WORDS];
    let mut register = 0;
    while register < REGISTERS.len() {
        let mut word = 0;
        while word < REGISTERS[register].words {
            places[(REGISTERS[register].word_address() + word) as usize] = register as u8 + 1;
            word += 1;
        }
        register += 1;
    }
    places
};

/// The register at a byte offset, and which of its words.
#[must_use]
pub fn lookup(offset: u16) -> Option<(&'static Register, usize)> {
    if !offset.is_multiple_of(4) {
        return None;
    }
    let place = PLACES.get(usize::from(offset / 4))?.checked_sub(1)?;
    let register = REGISTERS[usize::from(place)];
    Some((register, usize::from(offset / 4 - register.word_address())))
}

/// Checksum of a sequence of staged writes, for the commit registers.
///
/// `state = rotate_left(state, 1) ^ data ^ word_address` for every write since the last commit, from
/// [`CHECKSUM_SEED`]. A write that is lost, doubled, out of order, at a wrong address or with any
/// single bit flipped gives another sum.
#[must_use]
#[inline]
pub const fn checksum(state: u32, word_address: u16, data: u32) -> u32 {
    state.rotate_left(1) ^ data ^ word_address as u32
}

/// Start value of [`checksum`]: "RACS".
pub const CHECKSUM_SEED: u32 = 0x5241_4353;

/// The 30-bit word that the gateware stores for a staged write (convention 6).
#[must_use]
#[inline]
pub const fn stored_word(data: u32) -> i32 {
    ((data << 2) as i32) >> 2
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn registers_do_not_overlap_and_fit_the_window() {
        let mut next = 0;
        for register in REGISTERS {
            assert!(register.offset >= next, "{} overlaps its neighbour", register.name);
            assert_eq!(register.offset % 4, 0, "{}", register.name);
            next = register.offset + 4 * register.words;
            assert_eq!(lookup(register.offset), Some((*register, 0)));
        }
        assert_eq!(lookup(2), None);
        assert_eq!(lookup(0xFFFC), None);
    }

    #[test]
    fn fields_stay_inside_their_register_and_apart() {
        for register in REGISTERS {
            if let Kind::Fields(fields) = register.kind {
                let mut used = 0_u32;
                for field in fields {
                    let mask = field.place(u32::MAX);
                    assert_eq!(used & mask, 0, "{}.{}", register.name, field.name);
                    assert_eq!(field.of(mask), mask >> field.bit);
                    used |= mask;
                }
            }
        }
    }

    #[test]
    fn groups_fill_their_arrays() {
        for register in REGISTERS {
            let mut next = 0;
            for group in register.groups {
                assert_eq!(group.first, next, "{}.{}", register.name, group.name);
                next += group.words;
            }
            assert!(next == 0 || next == usize::from(register.words), "{}", register.name);
        }
    }

    #[test]
    fn every_fault_names_its_block() {
        assert!(FAULT_FIELDS.iter().all(|field| !field.block.is_empty()));
    }

    #[test]
    fn names_are_unique() {
        for (i, register) in REGISTERS.iter().enumerate() {
            assert!(REGISTERS[..i].iter().all(|other| other.name != register.name), "{}", register.name);
        }
    }

    #[test]
    fn the_checksum_sees_every_single_fault() {
        let writes = [(0x180_u16, 7_u32), (0x181, 0), (0x182, 0xFFFF_FFFF), (0x183, 0)];
        let sum = |writes: &[(u16, u32)]| writes.iter().fold(CHECKSUM_SEED, |s, &(a, d)| checksum(s, a, d));
        let good = sum(&writes);
        for i in 0..4 {
            for bit in 0..32 {
                let mut bad = writes;
                bad[i].1 ^= 1 << bit;
                assert_ne!(sum(&bad), good);
            }
            for bit in 0..14 {
                let mut bad = writes;
                bad[i].0 ^= 1 << bit;
                assert_ne!(sum(&bad), good);
            }
            let mut lost = std::vec::Vec::from(writes);
            lost.remove(i);
            assert_ne!(sum(&lost), good);
            let mut doubled = std::vec::Vec::from(writes);
            doubled.insert(i, writes[i]);
            assert_ne!(sum(&doubled), good);
        }
    }
}
