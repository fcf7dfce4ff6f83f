//! The device without a design: what the vendor's tools leave in what a design does not use.
//!
//! Found by counting: for every attribute the value that all 22 files of the card's maker have in unused slices,
//! pads, memories, clocks and corners (2,244 and 2,621 unused slices, 364 unused pads of the west side, and so on).

use super::Configuration;
use crate::device::{Attribute, Coding, Device};

/// Numbers that are not 0 when nothing is used. An attribute's index in its tile is left out.
const NUMBERS: [(&str, u64); 29] = [
    // Enables and inputs that float (1) and are inverted, so that they are 0.
    ("SLICE:INV.CE", 1),
    ("SLICE:INV.SR", 1),
    ("TBUF:INV.I", 1),
    ("IO:INV.ICE", 1),
    ("IO:INV.O", 1),
    ("IO:INV.OCE", 1),
    ("IO:INV.TCE", 1),
    ("BRAM:INV.CLKA", 1),
    ("BRAM:INV.CLKB", 1),
    ("BRAM:INV.ENA", 1),
    ("BRAM:INV.ENB", 1),
    ("BRAM:INV.RSTA", 1),
    ("BRAM:INV.RSTB", 1),
    ("BRAM:INV.WEA", 1),
    ("BRAM:INV.WEB", 1),
    ("CAPTURE:INV.CAP", 1),
    ("CAPTURE:INV.CLK", 1),
    ("BSCAN:INV.TDO1", 1),
    ("BSCAN:INV.TDO2", 1),
    ("STARTUP:INV.GSR", 1),
    ("STARTUP:INV.GTS", 1),
    ("PCILOGIC:INV.I1", 1),
    ("PCILOGIC:INV.I2", 1),
    // A pad's flip-flops begin with what leaves the pin alone.
    ("IO:OFF_INIT", 1),
    ("IO:TFF_INIT", 1),
    // Clock pads: all delay elements.
    ("GCLK_IO:DELAY", 0b1_1111),
    ("DLL:LVL1_MUX_20", 1),
    ("DLL:LVL1_MUX_24", 1),
    ("MISC:DRIVE_PD_STATUS", 1),
];

/// Numbers of more than one bit, as above.
const WIDE: [(&str, u64); 7] = [
    ("IO:IOSTD_MISC", 0b011),
    ("IO:OUTPUT_MISC", 0b11),
    ("IO:SLEW", 0b1111),
    ("DLL:FACTORY_JF1", 0xF0),
    ("DLL:FACTORY_JF2", 0xF0),
    ("BSCAN:USERID", 0xFFFF_FFFF),
    ("MISC:BCLK_DIV2", 0b1_1111),
];

/// What is chosen when nothing is used.
const CHOICES: [(&str, &str); 34] = [
    ("SLICE:CY0", "0"),
    ("SLICE:CYINIT", "CIN"),
    ("SLICE:CYSELF", "1"),
    ("SLICE:CYSELG", "1"),
    ("SLICE:DXMUX", "X"),
    ("SLICE:DYMUX", "Y"),
    ("SLICE:FXMUX", "FXOR"),
    ("SLICE:GYMUX", "GXOR"),
    ("SLICE:RAMCONFIG", "ROM"),
    ("SLICE:YBMUX", "CY"),
    ("IO:OMUX", "O"),
    ("IO:TMUX", "T"),
    ("IO:IBUF", "NONE"),
    ("IO:PULL", "PULLDOWN"),
    ("GCLK_IO:IBUF", "NONE"),
    ("BRAM:PORTA_ATTR", "4096X1"),
    ("BRAM:PORTB_ATTR", "4096X1"),
    ("DLL:CLKDV_MODE", "HALF"),
    ("DLL:CLK_FEEDBACK", "1X"),
    ("DLL:TEST_OSC", "90"),
    ("MISC:M0PIN", "PULLUP"),
    ("MISC:M1PIN", "PULLUP"),
    ("MISC:M2PIN", "PULLUP"),
    ("MISC:PDSTATUSPIN", "PULLNONE"),
    ("MISC:POWERDOWNPIN", "PULLUP"),
    ("MISC:POWERUP_DELAY", "100US"),
    ("MISC:POWERUP_CLK", "INTOSC"),
    ("MISC:TCKPIN", "PULLUP"),
    ("MISC:TMSPIN", "PULLUP"),
    ("MISC:TDIPIN", "PULLUP"),
    ("MISC:TDOPIN", "PULLUP"),
    ("MISC:DONEPIN", "PULLUP"),
    ("MISC:PROGPIN", "PULLUP"),
    ("MISC:CCLKPIN", "PULLUP"),
];

impl Configuration {
    /// The device without a design: no switch conducts, every pad is an input with a weak pull-down and no buffer,
    /// multiplexers choose nothing where they can and drive nothing where a driver can be off.
    #[must_use]
    pub fn blank(device: &Device) -> Self {
        let mut blank = Self::zero();
        blank.set_ones(device);
        let patterns: Vec<Vec<Option<u64>>> =
            device.classes().iter().map(|class| class.attributes.iter().map(pattern).collect()).collect();
        for (id, tile) in device.tiles() {
            let class = usize::from(tile.class);
            for (attribute, pattern) in device.classes()[class].attributes.iter().zip(&patterns[class]) {
                if let Some(pattern) = pattern {
                    blank.set_pattern(device, id, attribute, *pattern);
                }
            }
        }
        blank
    }
}

/// The bits of an attribute that is not used; none for the contents of memories, which are 0.
fn pattern(attribute: &Attribute) -> Option<u64> {
    let name = without_index(&attribute.name);
    match &attribute.coding {
        Coding::Number { inverted } if inverted.len() > 64 => None,
        Coding::Number { inverted } => {
            let value = NUMBERS.iter().chain(&WIDE).find(|row| row.0 == name).map_or(0, |row| row.1);
            Some(value ^ super::mask(inverted))
        }
        Coding::Choices(choices) => {
            let wanted = CHOICES.iter().find(|row| row.0 == name).map_or("NONE", |row| row.1);
            let choice = choices.iter().find(|choice| choice.name == wanted);
            Some(choice.map_or(0, |choice| choice.pattern).into())
        }
    }
}

/// `SLICE[1]:CY0` is `SLICE:CY0`; names of switches stay as they are.
fn without_index(name: &str) -> String {
    match (name.split_once('['), name.find(':')) {
        (Some((stem, rest)), Some(colon)) if stem.len() < colon => {
            format!("{stem}{}", rest.split_once(']').map_or("", |(_, rest)| rest))
        }
        _ => name.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::configuration::Attributes;
    use crate::device::PipKind;

    #[test]
    fn a_blank_device_says_something_everywhere() {
        let device = Device::xc2s200();
        let attributes = Attributes::read(device, &Configuration::blank(device)).expect("known patterns only");
        assert!(attributes.unexplained.is_empty() && attributes.absent.is_empty());
    }

    #[test]
    fn every_row_of_the_tables_is_an_attribute() {
        let device = Device::xc2s200();
        let names: std::collections::HashSet<String> = device
            .classes()
            .iter()
            .flat_map(|class| class.attributes.iter().map(|attribute| without_index(&attribute.name)))
            .collect();
        for name in NUMBERS.iter().chain(&WIDE).map(|row| row.0).chain(CHOICES.iter().map(|row| row.0)) {
            assert!(names.contains(name), "{name}");
        }
        assert_eq!(without_index("SLICE[1]:INV.BX"), "SLICE:INV.BX");
        assert_eq!(without_index("MUX.OMUX[0]"), "MUX.OMUX[0]");
    }

    #[test]
    fn no_switch_of_a_blank_device_drives_a_wire_that_can_be_left_alone() {
        let device = Device::xc2s200();
        let blank = Configuration::blank(device);
        for (tile, _) in device.tiles() {
            for pip in &device.class(tile).pips {
                let conducts = blank.conducts(device, tile, pip.kind);
                match pip.kind {
                    PipKind::Joined => {}
                    PipKind::Mux { attribute, drive: None, .. } => {
                        let mux = &device.class(tile).attributes[usize::from(attribute)];
                        assert!(!conducts || mux.choice("NONE").is_none(), "{}", mux.name);
                    }
                    _ => assert!(!conducts, "{}", device.describe_tile(tile)),
                }
            }
        }
    }
}
