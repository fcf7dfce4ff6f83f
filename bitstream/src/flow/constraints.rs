//! Which pin of the package a port has, what its buffer is like, and how fast the clocks are.
//!
//! Read from a constraint file of the vendor's form (UCF): `NET "name" LOC = "P98" | IOSTANDARD = LVTTL
//! | DRIVE = 8 | SLEW = FAST | PULLUP;`, periods (`TIMESPEC … = PERIOD "name" 30 ns`) and offsets.

use super::FlowError;
use std::collections::BTreeMap;

/// Resistor or latch at a pad.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub enum Pull {
    /// Neither keeper nor resistor.
    #[default]
    None,
    /// To the supply.
    Up,
    /// To ground.
    Down,
    /// Holds the last level.
    Keeper,
}

/// A port's pad.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct PadConstraint {
    /// Pin of the package, 1 to 208.
    pub pin: u8,
    /// Input/output standard, such as `LVTTL`.
    pub standard: String,
    /// Drive in mA, for standards that have a choice.
    pub drive: u8,
    /// Fast slew rate.
    pub fast: bool,
    /// What holds the pad while nobody drives it.
    pub pull: Pull,
}

/// All constraints of a design.
#[derive(Clone, Debug, Default, Eq, PartialEq)]
pub struct Constraints {
    /// Pads by port, `name` or `name[index]`.
    pub pads: BTreeMap<String, PadConstraint>,
    /// Clock periods in ps, by port.
    pub periods: BTreeMap<String, u32>,
    /// Inputs are stable this long before the clock, in ps; 0 if not said.
    pub offset_in: u32,
    /// Outputs are due this long after the clock, in ps; 0 if not said.
    pub offset_out: u32,
}

impl Constraints {
    /// Reads a constraint file.
    ///
    /// # Errors
    /// A line that is not understood, with its number.
    pub fn parse(text: &str) -> Result<Self, FlowError> {
        let mut constraints = Self::default();
        for (index, line) in text.lines().enumerate() {
            let statement = line.split('#').next().unwrap_or("").trim();
            if !statement.is_empty() && constraints.line(statement).is_none() {
                return Err(FlowError::Constraint { line: index + 1, text: line.trim().to_owned() });
            }
        }
        Ok(constraints)
    }

    fn line(&mut self, statement: &str) -> Option<()> {
        let statement = statement.strip_suffix(';')?.trim();
        let words: Vec<&str> = statement.split_whitespace().collect();
        match words[..] {
            ["OFFSET", "=", "IN", time, "ns", "BEFORE", _] => self.offset_in = picoseconds(time)?,
            ["OFFSET", "=", "OUT", time, "ns", "AFTER", _] => self.offset_out = picoseconds(time)?,
            ["TIMESPEC", _, "=", "PERIOD", name, time, "ns", ..] => {
                self.periods.insert(quoted(name)?, picoseconds(time)?);
            }
            ["NET", _, "TNM_NET", ..] => {}
            ["NET", name, ..] => {
                let rest = &statement[statement.find(name)? + name.len()..];
                let pad = pad(rest)?;
                self.pads.insert(quoted(name)?, pad);
            }
            _ => return None,
        }
        Some(())
    }
}

fn pad(text: &str) -> Option<PadConstraint> {
    let mut pad = PadConstraint { pin: 0, standard: "LVTTL".into(), drive: 12, fast: false, pull: Pull::None };
    for part in text.split('|') {
        match part.split_once('=').map_or((part.trim(), ""), |(name, value)| (name.trim(), value.trim())) {
            ("LOC", value) => pad.pin = value.trim_matches('"').strip_prefix('P')?.parse().ok()?,
            ("IOSTANDARD", value) => pad.standard = value.to_owned(),
            ("DRIVE", value) => pad.drive = value.parse().ok()?,
            ("SLEW", "FAST") => pad.fast = true,
            ("SLEW", "SLOW") => pad.fast = false,
            ("PULLUP", "") => pad.pull = Pull::Up,
            ("PULLDOWN", "") => pad.pull = Pull::Down,
            ("KEEPER", "") => pad.pull = Pull::Keeper,
            _ => return None,
        }
    }
    (pad.pin > 0).then_some(pad)
}

/// A name in quotes, with the index in square brackets.
fn quoted(word: &str) -> Option<String> {
    Some(word.strip_prefix('"')?.strip_suffix('"')?.replace('<', "[").replace('>', "]"))
}

fn picoseconds(word: &str) -> Option<u32> {
    let (whole, part) = word.split_once('.').unwrap_or((word, ""));
    let part = format!("{part:0<3}");
    Some(whole.parse::<u32>().ok()? * 1_000 + part.get(..3)?.parse::<u32>().ok()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_read() {
        let text = "# head\n\nNET \"clk\" TNM_NET = \"clk\";\nTIMESPEC \"TS\" = PERIOD \"clk\" 30 ns HIGH 50%;\n\
                    OFFSET = IN 19.5 ns BEFORE \"clk\";\n\
                    NET \"a<3>\" LOC = \"P153\" | IOSTANDARD = LVTTL | DRIVE = 8 | SLEW = FAST;  # P1\n\
                    NET \"b\" LOC = \"P6\" | IOSTANDARD = LVTTL | PULLUP;\n";
        let constraints = Constraints::parse(text).unwrap();
        assert_eq!(constraints.periods["clk"], 30_000);
        assert_eq!(constraints.offset_in, 19_500);
        let a = &constraints.pads["a[3]"];
        assert_eq!((a.pin, a.drive, a.fast, a.pull), (153, 8, true, Pull::None));
        assert_eq!(constraints.pads["b"].pull, Pull::Up);
    }

    #[test]
    fn a_line_that_is_no_constraint_is_named() {
        let error = Constraints::parse("NET \"a\" LOC = \"P1\";\nNET \"b\" LOCK = \"P2\";\n").unwrap_err();
        assert!(error.to_string().contains("line 2") && error.to_string().contains("LOCK"), "{error}");
    }
}
