//! The pins of the Mesa 4I65 and what this design puts on them: one table, from which the
//! constraints and the top module are written.
//!
//! ```text
//! P1  Mesa 7I30: four encoders, four H-bridges      P3  kicker, emergency stop, ball sensor, radio
//! P4  inertial sensor on five lines                 LAD, LEDs, clocks: the card's own
//! ```
//!
//! Pin numbers are those of Mesa's own constraint file for the 4I65. The assignment on P1 is Mesa's
//! usual four-axis layout; that the 7I30 has exactly this one is **not confirmed by its manual**,
//! and the pins on P3 are our choice. Both are therefore data: change [`Board::assignments`] and
//! write the constraints again. A 5I20 has other pins, although its FPGA is the same.

use fixed_kin::registers::{BOARD_4I65, Target};
use std::collections::BTreeMap;

/// FPGA pin of every I/O line; line 24·c + n is pin 2n + 1 of connector P1, P3, P4 for c = 0, 1, 2.
pub const IO_PINS: [u8; 72] = [
    83, 82, 81, 75, 74, 73, 71, 70, 69, 68, 67, 63, 62, 61, 60, 59, 58, 57, 49, 48, 47, 46, 45, 44, //
    8, 7, 6, 5, 4, 3, 206, 205, 204, 203, 202, 201, 200, 199, 195, 194, 193, 192, 191, 189, 188, 187, 181, 180, //
    43, 42, 41, 37, 36, 35, 34, 33, 31, 30, 29, 27, 24, 23, 22, 21, 20, 18, 17, 16, 15, 14, 10, 9,
];

/// FPGA pin of every bit of the multiplexed local bus.
pub const LAD_PINS: [u8; 32] = [
    153, 146, 142, 135, 126, 119, 115, 108, 174, 173, 172, 168, 167, 166, 165, 164, //
    163, 162, 152, 151, 150, 149, 148, 147, 141, 140, 139, 138, 136, 134, 133, 132,
];

/// FPGA pin of every user LED; low lights it.
pub const LED_PINS: [u8; 8] = [84, 86, 87, 88, 89, 90, 94, 95];

/// Address strobe from the bridge.
pub const ADS_PIN: u8 = 98;
/// Burst last from the bridge.
pub const BLAST_PIN: u8 = 99;
/// Write, not read, from the bridge.
pub const LW_R_PIN: u8 = 101;
/// Ready to the bridge.
pub const READY_PIN: u8 = 102;
/// Interrupt to the bridge.
pub const INT_PIN: u8 = 112;
/// Local bus clock: the PCI clock, 33 MHz nominal.
pub const LCLK_PIN: u8 = 182;
/// Crystal oscillator, 50 MHz.
pub const SYNCLK_PIN: u8 = 185;

/// A 50-pin connector of the card.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Connector {
    /// I/O lines 0 to 23.
    P1,
    /// I/O lines 24 to 47.
    P3,
    /// I/O lines 48 to 71.
    P4,
}

/// Where a port bit goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Place {
    /// An I/O line, 0 to 71.
    Io(u8),
    /// A pin of the FPGA's own.
    Pin(u8),
}

impl Place {
    /// The package pin.
    ///
    /// # Panics
    /// If an I/O line is above 71; [`Board::check`] tells that apart.
    #[must_use]
    pub fn pin(self) -> u8 {
        match self {
            Self::Io(line) => IO_PINS[usize::from(line)],
            Self::Pin(pin) => pin,
        }
    }

    /// Connector and its pin, for an I/O line.
    #[must_use]
    pub fn connector(self) -> Option<(Connector, u8)> {
        let Self::Io(line) = self else { return None };
        let connector = [Connector::P1, Connector::P3, Connector::P4].get(usize::from(line) / 24)?;
        Some((*connector, line % 24 * 2 + 1))
    }
}

/// Which way a pin works, with its buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Buffer {
    /// An input, kept high by the FPGA if nothing drives it.
    PulledUp,
    /// An input that is always driven.
    Input,
    /// A clock input.
    Clock {
        /// Period for the timing constraint, in nanoseconds.
        period_ns: u32,
    },
    /// Driven by the FPGA.
    Output {
        /// Current in milliampere.
        drive_ma: u8,
        /// Fast edges.
        fast: bool,
    },
    /// A tri-state bus line.
    Bidirectional {
        /// Current in milliampere.
        drive_ma: u8,
        /// Fast edges.
        fast: bool,
    },
}

impl Buffer {
    /// Whether the FPGA drives the pin, at least at times.
    #[must_use]
    pub fn drives(self) -> bool {
        matches!(self, Self::Output { .. } | Self::Bidirectional { .. })
    }
}

/// One bit of a port of the top module on its pin.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Assignment {
    /// Port of the top module.
    pub port: String,
    /// Bit of a vector port.
    pub bit: Option<u8>,
    /// Where it goes.
    pub place: Place,
    /// Kind of its buffer.
    pub buffer: Buffer,
}

/// What a board puts on the card's pins.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Board {
    /// What it is, for the head of the constraint file.
    pub name: String,
    /// What the registers `board` and `clock_hz` say.
    pub target: Target,
    /// Every used pin.
    pub assignments: Vec<Assignment>,
}

/// Why a board table cannot be used.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum BoardError {
    /// Two bits on one pin.
    #[error("`{first}` and `{second}` are both on FPGA pin {pin}; move one of them")]
    PinTwice {
        /// Port that has the pin, with its number where it is a vector.
        first: String,
        /// Port that has the pin too.
        second: String,
        /// Number of the FPGA's pin that both want.
        pin: u8,
    },
    /// One bit on two pins.
    #[error("`{bit}` has two pins; remove one line")]
    BitTwice {
        /// Port, with its number where it is a vector.
        bit: String,
    },
    /// A vector with holes, or mixed with a single bit.
    #[error("port `{port}` needs its bits numbered from 0 without holes, or one line without a number")]
    Holes {
        /// Vector whose numbers do not run from 0.
        port: String,
    },
    /// An I/O line that the card does not have.
    #[error("`{bit}` is on I/O line {line}; the card has lines 0 to 71")]
    NoLine {
        /// Port, with its number where it is a vector.
        bit: String,
        /// Number that is above 71.
        line: u8,
    },
}

/// Slow edges for cables: 24 mA as the card's I/O is specified.
const CABLE: Buffer = Buffer::Output { drive_ma: 24, fast: false };

/// Fast edges of little current for a sensor a few centimetres off: 4 to 17 MHz.
const SHORT: Buffer = Buffer::Output { drive_ma: 8, fast: true };

impl Assignment {
    /// `port<bit>`, as the constraint file spells it.
    #[must_use]
    pub fn net(&self) -> String {
        match self.bit {
            Some(bit) => format!("{}<{bit}>", self.port),
            None => self.port.clone(),
        }
    }
}

impl Board {
    /// The 4I65 with a 7I30 on P1, kicker and radio on P3, an inertial sensor on P4.
    #[must_use]
    pub fn mesa_4i65_7i30() -> Self {
        let mut board = Self {
            name: "Mesa 4I65, 7I30 on P1 (layout not confirmed), kicker and radio on P3, inertial sensor on P4".into(),
            target: BOARD_4I65,
            assignments: vec![],
        };
        board.add_card();
        board.add_7i30();
        board.add("kicker_charge_n", None, Place::Io(24), CABLE);
        board.add("kicker_trigger_n", None, Place::Io(25), CABLE);
        board.add("kicker_discharge", None, Place::Io(28), CABLE);
        board.add("kicker_full", None, Place::Io(29), Buffer::PulledUp);
        board.add("emergency_stop", None, Place::Io(26), Buffer::PulledUp);
        board.add("ball_sensor", None, Place::Io(27), Buffer::PulledUp);
        board.add("radio_rx", None, Place::Io(30), Buffer::PulledUp);
        board.add("host_select", None, Place::Io(31), Buffer::PulledUp);
        for bit in 0..4 {
            board.add("robot_number", Some(bit), Place::Io(32 + bit), Buffer::PulledUp);
        }
        // Line 48 is a clock input of the FPGA too and stays free.
        board.add("imu_cs_n", None, Place::Io(49), SHORT);
        board.add("imu_sclk", None, Place::Io(50), SHORT);
        board.add("imu_mosi", None, Place::Io(51), SHORT);
        board.add("imu_miso", None, Place::Io(52), Buffer::PulledUp);
        board.add("imu_ready", None, Place::Io(53), Buffer::PulledUp);
        board
    }

    fn add(&mut self, port: &str, bit: Option<u8>, place: Place, buffer: Buffer) {
        self.assignments.push(Assignment { port: port.into(), bit, place, buffer });
    }

    fn add_card(&mut self) {
        let bus = Buffer::Bidirectional { drive_ma: 8, fast: true };
        self.add("lclk", None, Place::Pin(LCLK_PIN), Buffer::Clock { period_ns: 30 });
        self.add("synclk", None, Place::Pin(SYNCLK_PIN), Buffer::Clock { period_ns: 20 });
        self.add("ads_n", None, Place::Pin(ADS_PIN), Buffer::Input);
        self.add("blast_n", None, Place::Pin(BLAST_PIN), Buffer::Input);
        self.add("lw_r", None, Place::Pin(LW_R_PIN), Buffer::Input);
        self.add("ready_n", None, Place::Pin(READY_PIN), Buffer::Output { drive_ma: 8, fast: true });
        self.add("int_n", None, Place::Pin(INT_PIN), Buffer::Output { drive_ma: 8, fast: false });
        for (bit, pin) in (0..).zip(LAD_PINS) {
            self.add("lad", Some(bit), Place::Pin(pin), bus);
        }
        for (bit, pin) in (0..).zip(LED_PINS) {
            self.add("led_n", Some(bit), Place::Pin(pin), CABLE);
        }
    }

    /// Two axes share twelve lines; the odd one has the lower number of every pair.
    fn add_7i30(&mut self) {
        for axis in 0..4 {
            let line = |pair: u8| Place::Io(axis / 2 * 12 + pair + 1 - axis % 2);
            let bit = Some(axis);
            // B stands before A in a pair of its own axis, unlike all other signals.
            let encoder = axis / 2 * 12 + 2 * (1 - axis % 2);
            self.add("encoder_b", bit, Place::Io(encoder), Buffer::PulledUp);
            self.add("encoder_a", bit, Place::Io(encoder + 1), Buffer::PulledUp);
            self.add("encoder_index", bit, line(4), Buffer::PulledUp);
            self.add("pwm", bit, line(6), CABLE);
            self.add("dir", bit, line(8), CABLE);
            self.add("enable_n", bit, line(10), CABLE);
        }
        self.assignments.sort_by_key(|a| matches!(a.place, Place::Io(_)).then(|| (a.port.clone(), a.bit)));
    }

    /// The ports with their widths, in the order of their first line.
    ///
    /// # Errors
    /// If the table contradicts itself or names a line that is not there.
    pub fn check(&self) -> Result<Vec<(String, Option<u8>)>, BoardError> {
        let mut pins: BTreeMap<u8, &Assignment> = BTreeMap::new();
        let mut ports: Vec<(String, Vec<Option<u8>>)> = Vec::new();
        for assignment in &self.assignments {
            if let Place::Io(line) = assignment.place
                && line > 71
            {
                return Err(BoardError::NoLine { bit: assignment.net(), line });
            }
            let pin = assignment.place.pin();
            if let Some(first) = pins.insert(pin, assignment) {
                return Err(BoardError::PinTwice { first: first.net(), second: assignment.net(), pin });
            }
            match ports.iter_mut().find(|(port, _)| *port == assignment.port) {
                Some((_, bits)) if bits.contains(&assignment.bit) => {
                    return Err(BoardError::BitTwice { bit: assignment.net() });
                }
                Some((_, bits)) => bits.push(assignment.bit),
                None => ports.push((assignment.port.clone(), vec![assignment.bit])),
            }
        }
        let width = |(port, mut bits): (String, Vec<Option<u8>>)| {
            bits.sort_unstable();
            let whole = bits == [None] || (0..).zip(&bits).all(|(n, bit)| *bit == Some(n));
            let width = bits[0].and_then(|_| u8::try_from(bits.len()).ok());
            if whole { Ok((port, width)) } else { Err(BoardError::Holes { port }) }
        };
        ports.into_iter().map(width).collect()
    }

    /// The assignments of a port, lowest bit first.
    #[must_use]
    pub fn port(&self, name: &str) -> Vec<&Assignment> {
        let mut found: Vec<_> = self.assignments.iter().filter(|a| a.port == name).collect();
        found.sort_by_key(|a| a.bit);
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn the_card_has_120_distinct_pins() {
        let own = [ADS_PIN, BLAST_PIN, LW_R_PIN, READY_PIN, INT_PIN, 113, LCLK_PIN, SYNCLK_PIN];
        let all: Vec<u8> = IO_PINS.iter().chain(&LAD_PINS).chain(&LED_PINS).chain(&own).copied().collect();
        assert_eq!(all.len(), 120);
        assert_eq!(all.iter().collect::<BTreeSet<_>>().len(), 120);
    }

    #[test]
    fn the_7i30_is_laid_out_as_in_mesas_tables() {
        let board = Board::mesa_4i65_7i30();
        let pin = |port: &str, bit: usize| board.port(port)[bit].place.connector().unwrap();
        let p1 = |pin| (Connector::P1, pin);
        for (port, pins) in [
            ("encoder_a", [7, 3, 31, 27]),
            ("encoder_b", [5, 1, 29, 25]),
            ("encoder_index", [11, 9, 35, 33]),
            ("pwm", [15, 13, 39, 37]),
            ("dir", [19, 17, 43, 41]),
            ("enable_n", [23, 21, 47, 45]),
        ] {
            for (axis, number) in pins.into_iter().enumerate() {
                assert_eq!(pin(port, axis), p1(number), "{port} {axis}");
            }
        }
    }

    #[test]
    fn every_port_has_its_width() {
        let ports = Board::mesa_4i65_7i30().check().unwrap();
        let width = |name: &str| ports.iter().find(|(port, _)| port == name).unwrap().1;
        assert_eq!(ports.len(), 29);
        assert_eq!((width("lad"), width("led_n"), width("pwm"), width("lclk")), (Some(32), Some(8), Some(4), None));
    }

    #[test]
    fn contradictions_are_named() {
        let wrong = |change: fn(&mut Board)| {
            let mut board = Board::mesa_4i65_7i30();
            change(&mut board);
            board.check().unwrap_err().to_string()
        };
        let add = |b: &mut Board, port, bit, place| b.add(port, bit, place, CABLE);
        assert!(wrong(|b| b.add("spare", None, Place::Io(24), CABLE)).contains("kicker_charge_n"));
        assert!(wrong(|b| b.add("pwm", Some(1), Place::Io(60), CABLE)).contains("pwm<1>"));
        assert!(wrong(|b| b.add("pwm", Some(5), Place::Io(60), CABLE)).contains("without holes"));
        assert!(wrong(|b| b.add("spare", None, Place::Io(72), CABLE)).contains("0 to 71"));
        let mut fine = Board::mesa_4i65_7i30();
        add(&mut fine, "spare", None, Place::Io(71));
        fine.check().unwrap();
    }
}
