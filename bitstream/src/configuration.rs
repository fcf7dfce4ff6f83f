//! A configuration: every bit of the device, and what it says in terms of attributes and switches.

mod attributes;
mod blank;
mod frames;

pub use attributes::{Attributes, Value};
pub use frames::{FrameError, StartUp};

use crate::device::{Attribute, Bit, Coding, Device, FRAME_BITS, FRAMES, PipId, PipKind, TileId};

/// All bits of the frames: 2,314 × 540.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Configuration {
    words: Vec<u64>,
}

/// An attribute that cannot be set like this, or holds a pattern that means nothing.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum AttributeError {
    /// The tile has no attribute of this name.
    #[error("{tile} has no attribute {attribute}")]
    Unknown {
        /// Name as in the device's database, such as `R5C12`.
        tile: String,
        /// Name that no tile of its kind has.
        attribute: String,
    },
    /// The attribute has no such choice.
    #[error("{attribute} of {tile} cannot be {value}; it can be {choices}")]
    Choice {
        /// Name as in the device's database, such as `R5C12`.
        tile: String,
        /// Multiplexer, mode or table that was to be set.
        attribute: String,
        /// Name of the choice that was asked for.
        value: String,
        /// Names of the attribute's choices, separated by commas.
        choices: String,
    },
    /// The bits stand for no choice.
    #[error("{attribute} of {tile} has the bits {pattern}, which stand for nothing; the frame is damaged")]
    Pattern {
        /// Name as in the device's database, such as `R5C12`.
        tile: String,
        /// Multiplexer, mode or table that cannot be read.
        attribute: String,
        /// Its bits, first of the attribute first.
        pattern: String,
    },
}

impl Default for Configuration {
    fn default() -> Self {
        Self::zero()
    }
}

impl Configuration {
    /// All bits 0. No design: see [`Configuration::blank`].
    #[must_use]
    pub fn zero() -> Self {
        Self { words: vec![0; (FRAMES * FRAME_BITS).div_ceil(64)] }
    }

    /// Whether a configuration bit is set.
    #[must_use]
    pub fn bit(&self, bit: Bit) -> bool {
        let at = place(bit);
        self.words[at / 64] >> (at % 64) & 1 == 1
    }

    /// Writes a configuration bit in its frame.
    pub fn set_bit(&mut self, bit: Bit, value: bool) {
        let at = place(bit);
        let mask = 1 << (at % 64);
        if value {
            self.words[at / 64] |= mask;
        } else {
            self.words[at / 64] &= !mask;
        }
    }

    /// Bits that are 1.
    #[must_use]
    pub fn ones(&self) -> usize {
        self.words.iter().map(|word| word.count_ones() as usize).sum()
    }

    /// Bits in which two configurations differ, in the order of the frames.
    pub fn differences<'a>(&'a self, other: &'a Self) -> impl Iterator<Item = Bit> + 'a {
        self.words.iter().zip(&other.words).enumerate().flat_map(|(n, (a, b))| {
            let differ = a ^ b;
            (0..64).filter(move |shift| differ >> shift & 1 == 1).map(move |shift| bit_at(n * 64 + shift))
        })
    }

    /// The pattern of an attribute of up to 64 bits, the attribute's first bit lowest, as stored.
    #[must_use]
    pub fn pattern(&self, device: &Device, tile: TileId, attribute: &Attribute) -> u64 {
        let bits = attribute.bits.iter().take(64).enumerate();
        bits.fold(0, |pattern, (n, bit)| pattern | u64::from(self.bit(device.bit(tile, *bit))) << n)
    }

    /// Stores a pattern.
    pub fn set_pattern(&mut self, device: &Device, tile: TileId, attribute: &Attribute, pattern: u64) {
        for (n, bit) in attribute.bits.iter().take(64).enumerate() {
            self.set_bit(device.bit(tile, *bit), pattern >> n & 1 == 1);
        }
    }

    /// A number of up to 64 bits.
    ///
    /// # Errors
    /// When the tile has no such attribute, or it is a choice.
    pub fn number(&self, device: &Device, tile: TileId, name: &str) -> Result<u64, AttributeError> {
        let attribute = find(device, tile, name)?;
        let Coding::Number { inverted } = &attribute.coding else { return Err(unknown(device, tile, name)) };
        Ok(self.pattern(device, tile, attribute) ^ mask(inverted))
    }

    /// Sets a number.
    ///
    /// # Errors
    /// When the tile has no such attribute, or it is a choice.
    pub fn set_number(&mut self, device: &Device, tile: TileId, name: &str, value: u64) -> Result<(), AttributeError> {
        let attribute = find(device, tile, name)?;
        let Coding::Number { inverted } = &attribute.coding else { return Err(unknown(device, tile, name)) };
        self.set_pattern(device, tile, attribute, value ^ mask(inverted));
        Ok(())
    }

    /// Bits of a number of any length, least significant first: the contents of a block RAM.
    ///
    /// # Errors
    /// When the tile has no such attribute, or it is a choice.
    pub fn bits(&self, device: &Device, tile: TileId, name: &str) -> Result<Vec<bool>, AttributeError> {
        let attribute = find(device, tile, name)?;
        let Coding::Number { inverted } = &attribute.coding else { return Err(unknown(device, tile, name)) };
        let bits = attribute.bits.iter().zip(inverted);
        Ok(bits.map(|(bit, inverted)| self.bit(device.bit(tile, *bit)) ^ inverted).collect())
    }

    /// Sets the first bits of a number of any length.
    ///
    /// # Errors
    /// When the tile has no such attribute, or it is a choice.
    pub fn set_bits(
        &mut self,
        device: &Device,
        tile: TileId,
        name: &str,
        values: &[bool],
    ) -> Result<(), AttributeError> {
        let attribute = find(device, tile, name)?;
        let Coding::Number { inverted } = &attribute.coding else { return Err(unknown(device, tile, name)) };
        for ((bit, inverted), value) in attribute.bits.iter().zip(inverted).zip(values) {
            self.set_bit(device.bit(tile, *bit), value ^ inverted);
        }
        Ok(())
    }

    /// What is chosen.
    ///
    /// # Errors
    /// When the tile has no such attribute, or its bits stand for no choice.
    pub fn choice(&self, device: &Device, tile: TileId, name: &str) -> Result<&'static str, AttributeError> {
        let attribute = find(device, tile, name)?;
        let pattern = self.pattern(device, tile, attribute);
        let chosen = attribute.choices().iter().find(|choice| u64::from(choice.pattern) == pattern);
        chosen.map(|choice| choice.name).ok_or_else(|| bad_pattern(device, tile, attribute, pattern))
    }

    /// Sets an attribute of a tile to one of its choices.
    ///
    /// # Errors
    /// When the tile has no such attribute, or it no such choice.
    pub fn set_choice(&mut self, device: &Device, tile: TileId, name: &str, value: &str) -> Result<(), AttributeError> {
        let attribute = find(device, tile, name)?;
        let Some(choice) = attribute.choices().iter().find(|choice| choice.name == value) else {
            let choices: Vec<&str> = attribute.choices().iter().map(|choice| choice.name).collect();
            return Err(AttributeError::Choice {
                tile: device.describe_tile(tile),
                attribute: attribute.name.clone(),
                value: value.to_owned(),
                choices: choices.join(", "),
            });
        };
        self.set_pattern(device, tile, attribute, choice.pattern.into());
        Ok(())
    }

    /// Whether a switch conducts.
    #[must_use]
    pub fn pip(&self, device: &Device, pip: PipId) -> bool {
        device.pip(pip).is_some_and(|pip| self.conducts(device, pip.tile, pip.kind))
    }

    /// Whether a switch of a tile conducts.
    #[must_use]
    pub fn conducts(&self, device: &Device, tile: TileId, kind: PipKind) -> bool {
        let attributes = &device.class(tile).attributes;
        let on = |attribute: u16| {
            let attribute = &attributes[usize::from(attribute)];
            let Coding::Number { inverted } = &attribute.coding else { return false };
            self.pattern(device, tile, attribute) ^ mask(inverted) != 0
        };
        match kind {
            PipKind::Joined => true,
            PipKind::Buffer { attribute } | PipKind::Switch { attribute } | PipKind::Gate { attribute } => {
                on(attribute)
            }
            PipKind::Mux { attribute, choice, drive } => {
                let attribute = &attributes[usize::from(attribute)];
                let pattern = self.pattern(device, tile, attribute);
                u64::from(attribute.choices()[usize::from(choice)].pattern) == pattern && drive.is_none_or(on)
            }
        }
    }

    /// Makes a switch conduct, its driver included.
    pub fn set_pip(&mut self, device: &Device, pip: PipId) {
        let Some(pip) = device.pip(pip) else { return };
        let attributes = &device.class(pip.tile).attributes;
        let mut on = |attribute: u16| {
            let attribute = &attributes[usize::from(attribute)];
            if let Coding::Number { inverted } = &attribute.coding {
                self.set_pattern(device, pip.tile, attribute, u64::MAX ^ mask(inverted));
            }
        };
        match pip.kind {
            PipKind::Joined => {}
            PipKind::Buffer { attribute } | PipKind::Switch { attribute } | PipKind::Gate { attribute } => {
                on(attribute);
            }
            PipKind::Mux { attribute, choice, drive } => {
                drive.into_iter().for_each(&mut on);
                let attribute = &attributes[usize::from(attribute)];
                let pattern = attribute.choices()[usize::from(choice)].pattern;
                self.set_pattern(device, pip.tile, attribute, pattern.into());
            }
        }
    }
}

fn place(bit: Bit) -> usize {
    usize::from(bit.frame) * FRAME_BITS + usize::from(bit.bit)
}

fn bit_at(place: usize) -> Bit {
    Bit { frame: (place / FRAME_BITS) as u16, bit: (place % FRAME_BITS) as u16 }
}

fn mask(inverted: &[bool]) -> u64 {
    inverted.iter().take(64).enumerate().fold(0, |mask, (n, inverted)| mask | u64::from(*inverted) << n)
}

fn unknown(device: &Device, tile: TileId, name: &str) -> AttributeError {
    AttributeError::Unknown { tile: device.describe_tile(tile), attribute: name.to_owned() }
}

fn find<'a>(device: &'a Device, tile: TileId, name: &str) -> Result<&'a Attribute, AttributeError> {
    let class = device.class(tile);
    let found = class.attribute(name).ok_or_else(|| unknown(device, tile, name))?;
    Ok(&class.attributes[usize::from(found)])
}

pub(crate) fn bad_pattern(device: &Device, tile: TileId, attribute: &Attribute, pattern: u64) -> AttributeError {
    AttributeError::Pattern {
        tile: device.describe_tile(tile),
        attribute: attribute.name.clone(),
        pattern: (0..attribute.bits.len()).map(|n| if pattern >> n & 1 == 1 { '1' } else { '0' }).collect(),
    }
}
