//! A slice: two look-up tables, carry, wide multiplexers, two flip-flops.
//!
//! ```text
//!  G1..G4 ─ G ─┬───────────── GYMUX ─ Y ─ DYMUX ─ FF ─ YQ        COUT = C2
//!              ├─ CYSELG ─ C2 ───────────────────── YBMUX ─ YB
//!  F1..F4 ─ F ─┼─ F5 = BX ? F : G
//!              ├───────────── FXMUX ─ X ─ DXMUX ─ FF ─ XQ
//!              └─ CYSELF ─ C1 ── XB                             C0 = CIN or BX
//! ```
//!
//! With writable tables SR is their write enable and leaves the flip-flops alone; F is written with BX, G with BY.
//! Shift registers are so in the card maker's files; RAM of 16 bits in both tables is taken to be the same. What the
//! other modes of RAM do with their inputs is known from no file, so they are read and written, but not simulated.
//!
//! An input that is not routed is 1; `invert_*` stands before it. Order of F5 and of the carry: the other order
//! makes files of the card's maker answer their bus wrongly.

use super::{Place, choices};
use crate::configuration::{AttributeError, Configuration};
use crate::device::{Device, TileId};

choices! {
    /// What the X output is.
    FOutput {
        /// The F table.
        F = "F",
        /// BX ? F : G.
        F5 = "F5",
        /// F exclusive or the carry into F.
        Xor = "FXOR",
    }
}

choices! {
    /// What the Y output is.
    GOutput {
        /// The G table.
        G = "G",
        /// BY ? own F5 : the other slice's F5.
        F6 = "F6",
        /// G exclusive or the carry into G.
        Xor = "GXOR",
    }
}

choices! {
    /// What the carry multiplexers pass when their table is 0.
    Carry0 {
        /// 0.
        Zero = "0",
        /// 1.
        One = "1",
        /// F1 and G1.
        Input = "F1_G1",
        /// F1·F2 and G1·G2: for multipliers.
        Product = "PROD",
    }
}

choices! {
    /// Whether the tables can be written.
    RamMode {
        /// They cannot.
        Rom = "ROM",
        /// F is 16 bits of RAM.
        Ram16 = "16X1",
        /// F and G are 16 bits of RAM each.
        TwoRam16 = "16X2",
        /// F and G are 32 bits of RAM, BX the fifth address bit.
        Ram32 = "32X1",
        /// 16 bits with two addresses: G reads and writes at one, F reads at the other.
        DualRam16 = "16X1DP",
        /// One table is a shift register.
        Shift = "1SHIFT",
        /// Both are shift registers.
        TwoShifts = "2SHIFTS",
    }
}

/// A slice. `Default` is an unused one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Slice {
    /// Table F: bit {F4, F3, F2, F1} is its output.
    pub f: u16,
    /// Table G.
    pub g: u16,
    /// Whether the tables can be written.
    pub ram: RamMode,
    /// The X output.
    pub x: FOutput,
    /// The Y output.
    pub y: GOutput,
    /// The carry multiplexers' other input.
    pub carry0: Carry0,
    /// Carry begins here, with BX; otherwise it comes from the slice below.
    pub carry_from_bx: bool,
    /// The F table decides whether carry goes on; otherwise it always does.
    pub f_selects_carry: bool,
    /// The G table decides likewise.
    pub g_selects_carry: bool,
    /// YB is BY; otherwise the carry out of G.
    pub yb_is_by: bool,
    /// The flip-flop of XQ takes BX; otherwise X.
    pub x_register_takes_bx: bool,
    /// The flip-flop of YQ takes BY; otherwise Y.
    pub y_register_takes_by: bool,
    /// Value of XQ after configuration, and when SR is 1.
    pub x_init: bool,
    /// Value of YQ likewise.
    pub y_init: bool,
    /// The storage elements are latches, open while CLK is 1.
    pub latch: bool,
    /// SR acts at the clock edge; otherwise at once.
    pub synchronous_reset: bool,
    /// BY forces the opposite of what SR does.
    pub reverse: bool,
    /// Inverter before BX.
    pub invert_bx: bool,
    /// Inverter before BY.
    pub invert_by: bool,
    /// Inverter before CE.
    pub invert_ce: bool,
    /// Inverter before CLK: the falling edge.
    pub invert_clk: bool,
    /// Inverter before SR.
    pub invert_sr: bool,
}

impl Default for Slice {
    fn default() -> Self {
        Self {
            f: 0,
            g: 0,
            ram: RamMode::Rom,
            x: FOutput::Xor,
            y: GOutput::Xor,
            carry0: Carry0::Zero,
            carry_from_bx: false,
            f_selects_carry: false,
            g_selects_carry: false,
            yb_is_by: false,
            x_register_takes_bx: false,
            y_register_takes_by: false,
            x_init: false,
            y_init: false,
            latch: false,
            synchronous_reset: false,
            reverse: false,
            invert_bx: false,
            invert_by: false,
            invert_ce: true,
            invert_clk: false,
            invert_sr: true,
        }
    }
}

impl Slice {
    /// Reads slice 0 or 1 of a logic block.
    ///
    /// # Errors
    /// When a multiplexer's bits stand for nothing, or the tile has no such slice.
    pub fn read(
        device: &Device,
        configuration: &Configuration,
        tile: TileId,
        index: u8,
    ) -> Result<Self, AttributeError> {
        let at = Place::new(device, tile, format!("SLICE[{index}]"));
        let c = configuration;
        Ok(Self {
            f: at.number(c, "F")? as u16,
            g: at.number(c, "G")? as u16,
            ram: at.choice(c, "RAMCONFIG", RamMode::named)?,
            x: at.choice(c, "FXMUX", FOutput::named)?,
            y: at.choice(c, "GYMUX", GOutput::named)?,
            carry0: at.choice(c, "CY0", Carry0::named)?,
            carry_from_bx: at.is(c, "CYINIT", "BX")?,
            f_selects_carry: at.is(c, "CYSELF", "F")?,
            g_selects_carry: at.is(c, "CYSELG", "G")?,
            yb_is_by: at.is(c, "YBMUX", "BY")?,
            x_register_takes_bx: at.is(c, "DXMUX", "BX")?,
            y_register_takes_by: at.is(c, "DYMUX", "BY")?,
            x_init: at.flag(c, "INITX")?,
            y_init: at.flag(c, "INITY")?,
            latch: at.flag(c, "FF_LATCH")?,
            synchronous_reset: at.flag(c, "FF_SR_SYNC")?,
            reverse: at.flag(c, "FF_REV_ENABLE")?,
            invert_bx: at.flag(c, "INV.BX")?,
            invert_by: at.flag(c, "INV.BY")?,
            invert_ce: at.flag(c, "INV.CE")?,
            invert_clk: at.flag(c, "INV.CLK")?,
            invert_sr: at.flag(c, "INV.SR")?,
        })
    }

    /// Writes slice 0 or 1 of a logic block.
    ///
    /// # Errors
    /// When the tile has no such slice.
    pub fn write(
        &self,
        device: &Device,
        configuration: &mut Configuration,
        tile: TileId,
        index: u8,
    ) -> Result<(), AttributeError> {
        let at = Place::new(device, tile, format!("SLICE[{index}]"));
        let c = configuration;
        at.set(c, "F", self.f)?;
        at.set(c, "G", self.g)?;
        at.choose(c, "RAMCONFIG", self.ram.name())?;
        at.choose(c, "FXMUX", self.x.name())?;
        at.choose(c, "GYMUX", self.y.name())?;
        at.choose(c, "CY0", self.carry0.name())?;
        at.choose(c, "CYINIT", if self.carry_from_bx { "BX" } else { "CIN" })?;
        at.choose(c, "CYSELF", if self.f_selects_carry { "F" } else { "1" })?;
        at.choose(c, "CYSELG", if self.g_selects_carry { "G" } else { "1" })?;
        at.choose(c, "YBMUX", if self.yb_is_by { "BY" } else { "CY" })?;
        at.choose(c, "DXMUX", if self.x_register_takes_bx { "BX" } else { "X" })?;
        at.choose(c, "DYMUX", if self.y_register_takes_by { "BY" } else { "Y" })?;
        at.set(c, "INITX", self.x_init)?;
        at.set(c, "INITY", self.y_init)?;
        at.set(c, "FF_LATCH", self.latch)?;
        at.set(c, "FF_SR_SYNC", self.synchronous_reset)?;
        at.set(c, "FF_REV_ENABLE", self.reverse)?;
        at.set(c, "INV.BX", self.invert_bx)?;
        at.set(c, "INV.BY", self.invert_by)?;
        at.set(c, "INV.CE", self.invert_ce)?;
        at.set(c, "INV.CLK", self.invert_clk)?;
        at.set(c, "INV.SR", self.invert_sr)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_unused_slice_is_that_of_a_blank_device() {
        let device = Device::xc2s200();
        let blank = Configuration::blank(device);
        let tile = device.tile_at("CLB", 2, 1).expect("a logic block");
        assert_eq!(Slice::read(device, &blank, tile, 0), Ok(Slice::default()));
        assert_eq!(Slice::read(device, &blank, tile, 1), Ok(Slice::default()));
        assert!(Slice::read(device, &blank, device.tile_at("CNR_SW", 0, 0).expect("a corner"), 0).is_err());
    }

    #[test]
    fn every_mode_is_read_as_it_was_written() {
        let device = Device::xc2s200();
        let tile = device.tile_at("CLB", 30, 14).expect("a logic block");
        let blank = Configuration::blank(device);
        for (n, ram) in RamMode::ALL.iter().enumerate() {
            for flags in 0..1u32 << 15 {
                if flags % 97 != n as u32 {
                    continue;
                }
                let flag = |n: u32| flags >> n & 1 == 1;
                let slice = Slice {
                    f: flags as u16 ^ 0x1234,
                    g: !flags as u16,
                    ram: *ram,
                    x: FOutput::ALL[flags as usize % 3],
                    y: GOutput::ALL[flags as usize / 3 % 3],
                    carry0: Carry0::ALL[flags as usize / 9 % 4],
                    carry_from_bx: flag(0),
                    f_selects_carry: flag(1),
                    g_selects_carry: flag(2),
                    yb_is_by: flag(3),
                    x_register_takes_bx: flag(4),
                    y_register_takes_by: flag(5),
                    x_init: flag(6),
                    y_init: flag(7),
                    latch: flag(8),
                    synchronous_reset: flag(9),
                    reverse: flag(10),
                    invert_bx: flag(11),
                    invert_by: flag(12),
                    invert_ce: flag(13),
                    invert_clk: flag(14),
                    invert_sr: flags % 2 == 0,
                };
                let mut configuration = blank.clone();
                slice.write(device, &mut configuration, tile, 1).expect("a slice");
                assert_eq!(Slice::read(device, &configuration, tile, 1), Ok(slice));
                assert_eq!(Slice::read(device, &configuration, tile, 0), Ok(Slice::default()));
            }
        }
    }
}
