//! Input/output blocks: buffer, driver, three flip-flops.
//!
//! ```text
//!  O ─ invert ─┬─ OFF ─┬─ OMUX ─ driver ─ pad ─ IBUF ─┬───── I
//!  T ─ invert ─┬─ TFF ─┬─ TMUX ──┘ off while 1        └ IFF ─ IQ
//! ```
//!
//! A block stands in two tiles, `IO_*` with the flip-flops and wires and `IOB_*` with the pad's electrics; OMUX and
//! TMUX have bits in both. Driver strengths: [`Standard`].

use super::{Place, choices};
use crate::configuration::{AttributeError, Configuration};
use crate::device::{Device, PadSite, Standard, TileId};

choices! {
    /// What turns the voltage at a pad into a bit.
    InputBuffer {
        /// Nothing; the input is not used.
        None = "NONE",
        /// The threshold of LVTTL, LVCMOS and PCI.
        Cmos = "CMOS",
        /// A comparison with VREF, high.
        VrefHigh = "VREF_HV",
        /// A comparison with VREF, low.
        VrefLow = "VREF_LV",
    }
}

choices! {
    /// What holds a pad that nobody drives.
    Pull {
        /// The pad floats.
        None = "NONE",
        /// A weak resistor to VCCO.
        Up = "PULLUP",
        /// A weak resistor to ground.
        Down = "PULLDOWN",
        /// The last value.
        Keeper = "KEEPER",
    }
}

/// A flip-flop of a pad.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct PadRegister {
    /// Value after configuration, and when SR is 1.
    pub init: bool,
    /// Transparent while the clock is high, in place of an edge.
    pub latch: bool,
    /// SR has an effect on it.
    pub reset: bool,
    /// SR acts at the clock edge; otherwise at once.
    pub synchronous_reset: bool,
    /// Inverter before its clock.
    pub invert_clk: bool,
    /// Inverter before its clock enable.
    pub invert_ce: bool,
}

/// How a pad is driven.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Driver {
    /// Strength towards VCCO.
    pub pull_up: u8,
    /// Strength towards ground.
    pub pull_down: u8,
    /// Slew rate.
    pub slew: u8,
    /// Bits of the standard that are neither.
    pub misc: u8,
    /// Bits of the output standard that are neither.
    pub output_misc: u8,
}

impl Driver {
    /// Strengths and bits of a standard, with its fast or its slow slew rate.
    #[must_use]
    pub fn of(standard: &Standard, fast: bool) -> Self {
        let slew = if fast { standard.fast } else { standard.slow };
        let Standard { pull_up, pull_down, misc, output_misc, .. } = *standard;
        Self { pull_up, pull_down, slew, misc, output_misc }
    }

    /// Whether it can drive at all.
    #[must_use]
    pub fn is_on(&self) -> bool {
        self.pull_up != 0 || self.pull_down != 0
    }

    /// The standard that it follows, and whether fast; none for a combination of no standard.
    #[must_use]
    pub fn standard<'a>(&self, device: &'a Device) -> Option<(&'a Standard, bool)> {
        let found = device.standards().iter().flat_map(|standard| [(standard, true), (standard, false)]);
        found.into_iter().find(|(standard, fast)| Self::of(standard, *fast) == *self)
    }
}

/// An input/output block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Io {
    /// What turns the voltage at its pad into a bit.
    pub input: InputBuffer,
    /// The input goes through a delay before I.
    pub delay_i: bool,
    /// The input goes through a delay before its flip-flop, so that its hold time is 0.
    pub delay_register: bool,
    /// The flip-flop of IQ.
    pub input_register: PadRegister,
    /// The flip-flop of the output.
    pub output_register: PadRegister,
    /// The flip-flop of the output enable.
    pub tristate_register: PadRegister,
    /// The output comes from its flip-flop.
    pub registered_output: bool,
    /// The output enable comes from its flip-flop.
    pub registered_tristate: bool,
    /// Inverter before O.
    pub invert_o: bool,
    /// Inverter before T.
    pub invert_t: bool,
    /// Inverter before SR.
    pub invert_sr: bool,
    /// Standard, strength and slew of the output.
    pub driver: Driver,
    /// What holds the pad.
    pub pull: Pull,
    /// The pad is a reference voltage.
    pub vref: bool,
}

impl Default for Io {
    /// An unused block, as on a blank device.
    fn default() -> Self {
        let register = PadRegister { invert_ce: true, ..PadRegister::default() };
        Self {
            input: InputBuffer::None,
            delay_i: false,
            delay_register: false,
            input_register: register,
            output_register: PadRegister { init: true, ..register },
            tristate_register: PadRegister { init: true, ..register },
            registered_output: false,
            registered_tristate: false,
            invert_o: true,
            invert_t: false,
            invert_sr: false,
            driver: Driver { pull_up: 0, pull_down: 0, slew: 0b1111, misc: 0b011, output_misc: 0b11 },
            pull: Pull::Down,
            vref: false,
        }
    }
}

impl Io {
    /// Reads the block of a pad; none if the pin is no input/output.
    ///
    /// # Errors
    /// When a multiplexer's bits stand for nothing.
    pub fn read(device: &Device, configuration: &Configuration, site: PadSite) -> Result<Option<Self>, AttributeError> {
        let PadSite::Io { tile, buffer, index } = site else { return Ok(None) };
        Self::read_at(device, configuration, tile, buffer, index).map(Some)
    }

    /// Reads a block of a pair of tiles, bonded or not.
    ///
    /// # Errors
    /// When a multiplexer's bits stand for nothing, or the tiles have no such block.
    pub fn read_at(
        device: &Device,
        configuration: &Configuration,
        tile: TileId,
        buffer: TileId,
        index: u8,
    ) -> Result<Self, AttributeError> {
        let c = configuration;
        let at = Place::new(device, tile, format!("IO[{index}]"));
        let pad = Place::new(device, buffer, format!("IO[{index}]"));
        let register = |stem: &str, enable: &str| -> Result<PadRegister, AttributeError> {
            Ok(PadRegister {
                init: at.flag(c, &format!("{stem}_INIT"))?,
                latch: at.flag(c, &format!("{stem}_LATCH"))?,
                reset: at.flag(c, &format!("{stem}_SR_ENABLE"))?,
                synchronous_reset: at.flag(c, &format!("{stem}_SR_SYNC"))?,
                invert_clk: at.flag(c, &format!("INV.{stem}.CLK"))?,
                invert_ce: at.flag(c, &format!("INV.{enable}"))?,
            })
        };
        Ok(Self {
            input: pad.choice(c, "IBUF", InputBuffer::named)?,
            delay_i: at.flag(c, "I_DELAY_ENABLE")?,
            delay_register: at.flag(c, "IFF_DELAY_ENABLE")?,
            input_register: register("IFF", "ICE")?,
            output_register: register("OFF", "OCE")?,
            tristate_register: register("TFF", "TCE")?,
            registered_output: at.is(c, "OMUX", "OFF")?,
            registered_tristate: at.is(c, "TMUX", "TFF")?,
            invert_o: at.flag(c, "INV.O")?,
            invert_t: at.flag(c, "INV.T")?,
            invert_sr: at.flag(c, "INV.SR")?,
            driver: Driver {
                pull_up: pad.number(c, "PDRIVE")? as u8,
                pull_down: pad.number(c, "NDRIVE")? as u8,
                slew: pad.number(c, "SLEW")? as u8,
                misc: pad.number(c, "IOSTD_MISC")? as u8,
                output_misc: pad.number(c, "OUTPUT_MISC")? as u8,
            },
            pull: pad.choice(c, "PULL", Pull::named)?,
            vref: pad.flag(c, "VREF")?,
        })
    }

    /// Writes the block of a pad; does nothing if the pin is no input/output.
    ///
    /// # Errors
    /// When the tiles have no such block.
    pub fn write(
        &self,
        device: &Device,
        configuration: &mut Configuration,
        site: PadSite,
    ) -> Result<(), AttributeError> {
        let PadSite::Io { tile, buffer, index } = site else { return Ok(()) };
        let c = configuration;
        let at = Place::new(device, tile, format!("IO[{index}]"));
        let pad = Place::new(device, buffer, format!("IO[{index}]"));
        let registers = [
            ("IFF", "ICE", &self.input_register),
            ("OFF", "OCE", &self.output_register),
            ("TFF", "TCE", &self.tristate_register),
        ];
        for (stem, enable, register) in registers {
            at.set(c, &format!("{stem}_INIT"), register.init)?;
            at.set(c, &format!("{stem}_LATCH"), register.latch)?;
            at.set(c, &format!("{stem}_SR_ENABLE"), register.reset)?;
            at.set(c, &format!("{stem}_SR_SYNC"), register.synchronous_reset)?;
            at.set(c, &format!("INV.{stem}.CLK"), register.invert_clk)?;
            at.set(c, &format!("INV.{enable}"), register.invert_ce)?;
        }
        at.set(c, "I_DELAY_ENABLE", self.delay_i)?;
        at.set(c, "IFF_DELAY_ENABLE", self.delay_register)?;
        at.set(c, "INV.O", self.invert_o)?;
        at.set(c, "INV.T", self.invert_t)?;
        at.set(c, "INV.SR", self.invert_sr)?;
        for place in [&at, &pad] {
            place.choose(c, "OMUX", if self.registered_output { "OFF" } else { "O" })?;
            place.choose(c, "TMUX", if self.registered_tristate { "TFF" } else { "T" })?;
        }
        pad.choose(c, "IBUF", self.input.name())?;
        pad.choose(c, "PULL", self.pull.name())?;
        pad.set(c, "VREF", self.vref)?;
        pad.set(c, "PDRIVE", self.driver.pull_up)?;
        pad.set(c, "NDRIVE", self.driver.pull_down)?;
        pad.set(c, "SLEW", self.driver.slew)?;
        pad.set(c, "IOSTD_MISC", self.driver.misc)?;
        pad.set(c, "OUTPUT_MISC", self.driver.output_misc)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unused_pads_are_those_of_a_blank_device() {
        let device = Device::xc2s200();
        let blank = Configuration::blank(device);
        for pad in device.pads() {
            let io = Io::read(device, &blank, pad.site).expect("known patterns");
            assert!(io.is_none_or(|io| io == Io::default()), "P{}: {io:?}", pad.pin);
        }
    }

    #[test]
    fn a_pad_is_read_as_it_was_written() {
        let device = Device::xc2s200();
        let blank = Configuration::blank(device);
        for pad in device.pads().iter().filter(|pad| matches!(pad.site, PadSite::Io { .. })) {
            for (n, standard) in device.standards().iter().enumerate() {
                let io = Io {
                    input: InputBuffer::ALL[n % 4],
                    pull: Pull::ALL[n / 2 % 4],
                    driver: Driver::of(standard, n % 2 == 0),
                    registered_output: n % 3 == 0,
                    registered_tristate: n % 3 == 1,
                    delay_register: n % 5 == 0,
                    invert_t: n % 2 == 1,
                    ..Io::default()
                };
                let mut configuration = blank.clone();
                io.write(device, &mut configuration, pad.site).expect("a pad");
                assert_eq!(Io::read(device, &configuration, pad.site), Ok(Some(io)));
            }
        }
    }

    #[test]
    fn drivers_know_their_standard() {
        let device = Device::xc2s200();
        for standard in device.standards().iter().filter(|standard| standard.name.starts_with("LVTTL")) {
            for fast in [false, true] {
                let found = Driver::of(standard, fast).standard(device).expect("a standard");
                assert_eq!((found.0.name, found.1), (standard.name, fast));
            }
        }
        assert!(Driver::default().standard(device).is_none());
    }
}
