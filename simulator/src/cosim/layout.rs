//! Columns of a stimulus and of a response: how the ports of a module become rows of words.
//!
//! ```text
//! ports       clock  a[7:0]  lad[31:0] (inout)   sum[8:0]
//! inputs             a       lad  lad.drive
//! outputs                    lad                 sum
//! ```

use super::CosimError;
use super::ports::{Direction, Ports};

/// One word of a row.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Column {
    /// The port's name; `name.drive` says whether the outside drives a tri-state port.
    pub name: String,
    /// Bits that count; higher bits of an input word must be zero.
    pub width: u32,
}

/// The columns of a module.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Layout {
    /// Stimulus columns, in port order, without clocks.
    pub inputs: Vec<Column>,
    /// Response columns, in port order.
    pub outputs: Vec<Column>,
    /// Clock inputs; bit n of a [`Levels`] word is clock n.
    pub clocks: Vec<String>,
}

/// Clock levels of one step: what the clocks show while the inputs settle, then after the edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Levels {
    /// One bit a clock, first half.
    pub before: u16,
    /// One bit a clock, second half.
    pub after: u16,
}

impl Levels {
    /// The clocks of this mask rise, the others stay low.
    #[must_use]
    pub const fn rising(mask: u16) -> Self {
        Self { before: 0, after: mask }
    }

    /// The word of the harness's protocol.
    #[must_use]
    pub fn word(self) -> u32 {
        u32::from(self.before) << 16 | u32::from(self.after)
    }
}

/// When which clock rises.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub enum Clocks {
    /// All clocks rise on every step.
    #[default]
    Together,
    /// These levels, over and over.
    Repeat(Vec<Levels>),
    /// Every stimulus row begins with a [`Levels::word`].
    PerStep,
}

impl Clocks {
    /// The repeating pattern of clocks with these periods (any common unit) that all rise at zero:
    /// 30 and 20 give four steps in 60.
    ///
    /// # Panics
    /// If there is no clock, more than 16, or a period of zero.
    #[must_use]
    pub fn periods(periods: &[u32]) -> Self {
        assert!((1..=16).contains(&periods.len()), "1 to 16 clocks, got {}", periods.len());
        assert!(periods.iter().all(|p| *p > 0), "a clock period of zero");
        let common = periods.iter().fold(1u64, |a, b| {
            let b = u64::from(*b);
            a / gcd(a, b) * b
        });
        let rises = |t: u64| {
            periods.iter().enumerate().fold(0u16, |mask, (n, p)| mask | u16::from(t.is_multiple_of(u64::from(*p))) << n)
        };
        let steps = (0..common).map(rises).filter(|mask| *mask != 0).map(Levels::rising);
        Self::Repeat(steps.collect())
    }
}

fn gcd(a: u64, b: u64) -> u64 {
    if b == 0 { a } else { gcd(b, a % b) }
}

impl Layout {
    /// The columns for these ports.
    #[must_use]
    pub fn of(ports: &Ports) -> Self {
        let mut layout = Self { clocks: ports.clocks.clone(), ..Self::default() };
        for port in &ports.list {
            if ports.clocks.contains(&port.name) {
                continue;
            }
            let column = Column { name: port.name.clone(), width: port.width };
            if port.direction != Direction::Out {
                layout.inputs.push(column.clone());
            }
            if port.direction == Direction::InOut {
                layout.inputs.push(Column { name: format!("{}.drive", port.name), width: 1 });
            }
            if port.direction != Direction::In {
                layout.outputs.push(column);
            }
        }
        layout
    }

    /// The column of an input.
    ///
    /// # Errors
    /// If there is no such input.
    pub fn input(&self, name: &str) -> Result<usize, CosimError> {
        find(&self.inputs, name, "input")
    }

    /// The column of an output.
    ///
    /// # Errors
    /// If there is no such output.
    pub fn output(&self, name: &str) -> Result<usize, CosimError> {
        find(&self.outputs, name, "output")
    }

    pub(crate) fn rows(&self, words: usize, columns: usize) -> Result<usize, CosimError> {
        if columns > 0 && words.is_multiple_of(columns) {
            return Ok(words / columns);
        }
        let names: Vec<_> = self.inputs.iter().map(|c| c.name.as_str()).collect();
        Err(CosimError::Shape { words, columns, names: names.join(", ") })
    }
}

fn find(columns: &[Column], name: &str, kind: &'static str) -> Result<usize, CosimError> {
    columns.iter().position(|c| c.name == name).ok_or_else(|| {
        let names: Vec<_> = columns.iter().map(|c| c.name.as_str()).collect();
        CosimError::NoPort { kind, name: name.into(), available: names.join(", ") }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_clocks_interleave_as_their_periods_say() {
        let steps = [3, 2, 1, 2].map(Levels::rising).to_vec();
        assert_eq!(Clocks::periods(&[30, 20]), Clocks::Repeat(steps));
        assert_eq!(Clocks::periods(&[7]), Clocks::Repeat(vec![Levels::rising(1)]));
    }

    #[test]
    fn a_tristate_port_gets_a_drive_column() {
        let verilog = "module m(input clk, inout [31:0] lad, output [3:0] y); endmodule";
        let layout = Layout::of(&Ports::parse(verilog, "m", &["clk"]).unwrap());
        let names = |c: &[Column]| c.iter().map(|c| c.name.clone()).collect::<Vec<_>>();
        assert_eq!(names(&layout.inputs), ["lad", "lad.drive"]);
        assert_eq!(names(&layout.outputs), ["lad", "y"]);
        assert!(layout.input("y").unwrap_err().to_string().contains("lad.drive"));
    }
}
