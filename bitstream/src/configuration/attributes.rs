//! A configuration as values of attributes, tile by tile.

use super::{AttributeError, Configuration, bad_pattern, mask};
use crate::device::{Attribute, Bit, Coding, Device, TileId};

/// The value of an attribute.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Value {
    /// A choice, by its index.
    Choice(u8),
    /// A number of up to 64 bits.
    Number(u64),
    /// A longer number, least significant bit first.
    Bits(Vec<bool>),
}

/// All attributes of the device, in the order of tiles and of the attributes of their classes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Attributes {
    values: Vec<Vec<Value>>,
    /// Bits that are 1 and belong to no attribute.
    pub unexplained: Vec<Bit>,
    /// Bits that are 1 in every file of the vendor's tools, but not in this one.
    pub absent: Vec<Bit>,
}

impl Attributes {
    /// What a configuration says.
    ///
    /// # Errors
    /// Every attribute whose bits stand for nothing.
    pub fn read(device: &Device, configuration: &Configuration) -> Result<Self, Vec<AttributeError>> {
        let (mut values, mut errors) = (Vec::new(), Vec::new());
        for (tile, _) in device.tiles() {
            let mut list = Vec::with_capacity(device.class(tile).attributes.len());
            for attribute in &device.class(tile).attributes {
                match value(device, configuration, tile, attribute) {
                    Ok(value) => list.push(value),
                    Err(error) => errors.push(error),
                }
            }
            values.push(list);
        }
        let mut known = Configuration::zero();
        known.set_ones(device);
        let absent = known.differences(configuration).filter(|bit| !configuration.bit(*bit));
        let absent = absent.filter(|bit| known.bit(*bit)).collect();
        explain(device, &mut known);
        let unexplained = configuration.differences(&known).filter(|bit| configuration.bit(*bit)).collect();
        if errors.is_empty() { Ok(Self { values, unexplained, absent }) } else { Err(errors) }
    }

    /// The values of a tile, in the order of its class.
    #[must_use]
    pub fn tile(&self, tile: TileId) -> &[Value] {
        &self.values[usize::from(tile.0)]
    }

    /// The configuration that says this: the attributes, the bits that are always 1, and those unexplained.
    #[must_use]
    pub fn write(&self, device: &Device) -> Configuration {
        let mut configuration = Configuration::zero();
        configuration.set_ones(device);
        for (tile, _) in device.tiles() {
            for (attribute, value) in device.class(tile).attributes.iter().zip(self.tile(tile)) {
                set(device, &mut configuration, tile, attribute, value);
            }
        }
        for bit in &self.unexplained {
            configuration.set_bit(*bit, true);
        }
        for bit in &self.absent {
            configuration.set_bit(*bit, false);
        }
        configuration
    }
}

impl Configuration {
    /// Sets the bits that are 1 in every file of the vendor's tools and belong to no attribute.
    pub fn set_ones(&mut self, device: &Device) {
        for (tile, _) in device.tiles() {
            for bit in &device.class(tile).ones {
                self.set_bit(device.bit(tile, *bit), true);
            }
        }
    }
}

fn value(
    device: &Device,
    configuration: &Configuration,
    tile: TileId,
    attribute: &Attribute,
) -> Result<Value, AttributeError> {
    match &attribute.coding {
        Coding::Number { inverted } if inverted.len() <= 64 => {
            Ok(Value::Number(configuration.pattern(device, tile, attribute) ^ mask(inverted)))
        }
        Coding::Number { .. } => Ok(Value::Bits(configuration.bits(device, tile, &attribute.name)?)),
        Coding::Choices(choices) => {
            let pattern = configuration.pattern(device, tile, attribute);
            let found = choices.iter().position(|choice| u64::from(choice.pattern) == pattern);
            found.map(|n| Value::Choice(n as u8)).ok_or_else(|| bad_pattern(device, tile, attribute, pattern))
        }
    }
}

fn set(device: &Device, configuration: &mut Configuration, tile: TileId, attribute: &Attribute, value: &Value) {
    match (&attribute.coding, value) {
        (Coding::Number { inverted }, Value::Number(number)) => {
            configuration.set_pattern(device, tile, attribute, number ^ mask(inverted));
        }
        (Coding::Number { inverted }, Value::Bits(bits)) => {
            for ((bit, inverted), value) in attribute.bits.iter().zip(inverted).zip(bits) {
                configuration.set_bit(device.bit(tile, *bit), value ^ inverted);
            }
        }
        (Coding::Choices(choices), Value::Choice(choice)) => {
            let pattern = choices[usize::from(*choice)].pattern;
            configuration.set_pattern(device, tile, attribute, pattern.into());
        }
        _ => {}
    }
}

/// Sets every bit that an attribute has.
fn explain(device: &Device, known: &mut Configuration) {
    for (tile, _) in device.tiles() {
        for attribute in &device.class(tile).attributes {
            for bit in &attribute.bits {
                known.set_bit(device.bit(tile, *bit), true);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn any_bits_of_numbers_survive_attributes() {
        let device = Device::xc2s200();
        let tile = device.tile_at("CLB", 7, 9).expect("a logic block");
        let mut configuration = Configuration::blank(device);
        configuration.set_number(device, tile, "SLICE[1]:G", 0xBEEF).expect("the table");
        // Row 0 of a block RAM column has no memory.
        let bit = Bit { frame: 2_186, bit: 0 };
        configuration.set_bit(bit, true);
        let one = Bit { frame: 16, bit: 16 };
        configuration.set_bit(one, false);
        let attributes = Attributes::read(device, &configuration).expect("no unknown pattern");
        assert_eq!((&attributes.unexplained[..], &attributes.absent[..]), (&[bit][..], &[one][..]));
        assert_eq!(attributes.write(device), configuration);
    }

    #[test]
    fn the_bits_that_are_always_one_are_344() {
        let device = Device::xc2s200();
        let mut configuration = Configuration::zero();
        configuration.set_ones(device);
        assert_eq!(configuration.ones(), 344);
    }
}
