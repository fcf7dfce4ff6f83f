//! Block RAM: 4,096 bits with two ports of 1, 2, 4, 8 or 16 bits.
//!
//! Word n of a port of width w is bits n·w .. n·w + w of the contents. A port has 12 address pins of which the
//! upper ones are used: 256 × 16 uses ADDR11..ADDR4.

use super::{Place, choices};
use crate::configuration::{AttributeError, Configuration};
use crate::device::{Device, TileId};

/// Bits of a block.
const BITS: usize = 4_096;

choices! {
    /// Words and width of a port.
    PortWidth {
        /// 4,096 × 1.
        W1 = "4096X1",
        /// 2,048 × 2.
        W2 = "2048X2",
        /// 1,024 × 4.
        W4 = "1024X4",
        /// 512 × 8.
        W8 = "512X8",
        /// 256 × 16.
        W16 = "256X16",
    }
}

impl PortWidth {
    /// Bits of a word.
    #[must_use]
    pub fn bits(self) -> usize {
        1 << self.address_shift()
    }

    /// Address pins at the low end that are not used.
    #[must_use]
    pub fn address_shift(self) -> usize {
        match self {
            Self::W1 => 0,
            Self::W2 => 1,
            Self::W4 => 2,
            Self::W8 => 3,
            Self::W16 => 4,
        }
    }
}

/// A port. Not routed, an input is 1 before its inverter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Port {
    /// Words and width.
    pub width: PortWidth,
    /// Inverter before the clock.
    pub invert_clk: bool,
    /// Inverter before the enable.
    pub invert_en: bool,
    /// Inverter before the write enable.
    pub invert_we: bool,
    /// Inverter before the reset of the output register.
    pub invert_rst: bool,
}

impl Default for Port {
    fn default() -> Self {
        Self { width: PortWidth::W1, invert_clk: true, invert_en: true, invert_we: true, invert_rst: true }
    }
}

/// How a block RAM is set: widths, polarities, content.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BlockRam {
    /// Port A and port B.
    pub ports: [Port; 2],
    /// Contents after configuration, bit 0 first; 4,096 of them.
    pub contents: Vec<bool>,
}

impl Default for BlockRam {
    fn default() -> Self {
        Self { ports: [Port::default(); 2], contents: vec![false; BITS] }
    }
}

impl BlockRam {
    /// Reads the block RAM of a tile.
    ///
    /// # Errors
    /// When a port's width stands for nothing, or the tile has no block RAM.
    pub fn read(device: &Device, configuration: &Configuration, tile: TileId) -> Result<Self, AttributeError> {
        let at = Place::new(device, tile, "BRAM".to_owned());
        let port = |name: char| -> Result<Port, AttributeError> {
            Ok(Port {
                width: at.choice(configuration, &format!("PORT{name}_ATTR"), PortWidth::named)?,
                invert_clk: at.flag(configuration, &format!("INV.CLK{name}"))?,
                invert_en: at.flag(configuration, &format!("INV.EN{name}"))?,
                invert_we: at.flag(configuration, &format!("INV.WE{name}"))?,
                invert_rst: at.flag(configuration, &format!("INV.RST{name}"))?,
            })
        };
        Ok(Self { ports: [port('A')?, port('B')?], contents: configuration.bits(device, tile, "BRAM:DATA")? })
    }

    /// Writes the block RAM of a tile.
    ///
    /// # Errors
    /// When the tile has no block RAM.
    pub fn write(
        &self,
        device: &Device,
        configuration: &mut Configuration,
        tile: TileId,
    ) -> Result<(), AttributeError> {
        let at = Place::new(device, tile, "BRAM".to_owned());
        for (name, port) in ['A', 'B'].into_iter().zip(&self.ports) {
            at.choose(configuration, &format!("PORT{name}_ATTR"), port.width.name())?;
            at.set(configuration, &format!("INV.CLK{name}"), port.invert_clk)?;
            at.set(configuration, &format!("INV.EN{name}"), port.invert_en)?;
            at.set(configuration, &format!("INV.WE{name}"), port.invert_we)?;
            at.set(configuration, &format!("INV.RST{name}"), port.invert_rst)?;
        }
        configuration.set_bits(device, tile, "BRAM:DATA", &self.contents)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contents_and_ports_are_read_as_written() {
        let device = Device::xc2s200();
        for (tile, _) in device.tiles_of("BRAM_E").chain(device.tiles_of("BRAM_W")) {
            let mut configuration = Configuration::blank(device);
            assert_eq!(BlockRam::read(device, &configuration, tile), Ok(BlockRam::default()));
            let mut memory = BlockRam {
                contents: (0..BITS).map(|n| n.wrapping_mul(2_654_435_761) >> 13 & 1 == 1).collect(),
                ..BlockRam::default()
            };
            memory.ports[1].width = PortWidth::W16;
            memory.ports[0] = Port { width: PortWidth::W8, invert_we: false, ..Port::default() };
            memory.write(device, &mut configuration, tile).expect("a block RAM");
            assert_eq!(BlockRam::read(device, &configuration, tile), Ok(memory));
        }
    }

    /// Bit 0 of the contents of the lowest block of column 1: from the table, and where XAPP151 puts it.
    #[test]
    fn contents_stand_in_their_frames() {
        let device = Device::xc2s200();
        let tile = device.tile_at("BRAM_W", 1, 1).expect("a block RAM");
        let mut configuration = Configuration::zero();
        configuration.set_bits(device, tile, "BRAM:DATA", &[true]).expect("a block RAM");
        let set: Vec<_> = configuration.differences(&Configuration::zero()).collect();
        assert_eq!(set, [crate::device::Bit { frame: 2_186, bit: 18 + 29 }]);
    }
}
