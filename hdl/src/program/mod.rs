//! The program of the sequencer: what it computes at every control tick.
//!
//! One file a part, each the gateware twin of a function of `fixed-kin`. The sequencer is an
//! accumulator machine on one memory; this module is its instruction set and assembler.
//!
//! An instruction has 16 bits: operation in 15:11, bit 10 = "add the axis number to the address",
//! address or immediate in 7:0, branch target in 8:0. Every instruction takes one clock, but: a taken
//! branch two, a product 2 + digits and a quotient 34 from their start, less what is done in between.
//! So the parts of the tick are woven: a product is started, something else done, then it is asked for.

mod kinematics;
pub mod layout;
mod modulation;
mod odometry;
mod pi;
mod speed;

use layout::Cell;
use std::collections::HashMap;

/// Words of the program memory.
pub const PROGRAM_WORDS: usize = 512;

/// Operations. `m` is the addressed word, `acc` the accumulator; see `fixed_kin::word` for the arithmetic.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u8)]
pub enum Op {
    /// Nothing.
    Nop,
    /// acc = m.
    Load,
    /// acc = sign-extended immediate.
    Immediate,
    /// acc = acc + m, saturating.
    Add,
    /// acc = acc − m, saturating.
    Subtract,
    /// acc = acc + m modulo 2³².
    AddWrapping,
    /// acc = low 16 bits of acc − m, sign-extended.
    Subtract16,
    /// acc = low 24 bits of acc − m.
    Subtract24,
    /// acc = min(acc, m).
    Minimum,
    /// acc = max(acc, m).
    Maximum,
    /// acc = acc ^ m.
    Xor,
    /// m = acc.
    Store,
    /// acc = input port.
    Input,
    /// output port = acc.
    Output,
    /// Branch.
    Jump,
    /// Branch where acc = 0.
    JumpZero,
    /// Branch where acc ≠ 0.
    JumpNotZero,
    /// Branch where acc < 0.
    JumpNegative,
    /// Branch where acc ≥ 0.
    JumpNotNegative,
    /// Next axis; branch unless it was the last.
    NextAxis,
    /// End of the control tick.
    Halt,
    /// Starts acc·2³² / m; the program goes on.
    Divide,
    /// acc = the quotient, when it is there.
    Quotient,
    /// acc = the product, when it is there.
    Product,
    /// Starts m · coefficient in acc; the program goes on.
    MultiplyCoefficient = 24,
    /// Starts m · integral gain in acc.
    MultiplyFine,
    /// Starts m · proportional gain in acc.
    MultiplyWide,
    /// Starts m · PWM period in acc.
    MultiplyPeriod,
    /// Starts m · counts in acc.
    MultiplyCounts,
}

/// Input ports of the sequencer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum InputPort {
    /// Count of this axis, 16 bits.
    Count,
    /// Time of the last edge of this axis, 24 bits.
    EdgeTime,
    /// Encoder line of the last edge of this axis, 16 bits.
    Line,
    /// Time of the tick, 24 bits.
    Now,
    /// Control period in clocks.
    TickPeriod,
    /// Mode bit: speed by count and time.
    CountAndTime,
    /// Mode bit: set points are a body velocity.
    Twist,
    /// Outputs may be on, at the tick.
    Armed,
    /// Set points are valid, at the tick.
    SetPointsValid,
    /// PWM period in clocks.
    PwmPeriod,
    /// The status register.
    Status,
    /// The fault register.
    Faults,
    /// An index of this axis was captured since the last tick.
    IndexEvent,
    /// Counts of this axis are to begin at zero at its index.
    IndexClear,
    /// Count of this axis at its index, 16 bits.
    IndexCount,
    /// Mode bit: a pose is kept.
    Odometry,
    /// Of the angle: place in its interval of the table.
    Fraction,
    /// Of the angle.
    Sine,
    /// Of the angle.
    Cosine,
}

/// Output ports of the sequencer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum OutputPort {
    /// Sign of acc is the direction for the next [`OutputPort::Compare`].
    Direction,
    /// acc / 2¹² is the compare value of this axis' PWM generator; takes effect with its next period.
    Compare,
    /// The angle whose sine and cosine stand at the input ports two clocks later.
    Angle,
}

/// A place in the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
struct Label(usize);

/// A program under construction.
#[derive(Default)]
struct Assembler {
    words: Vec<(Op, u16)>,
    targets: Vec<(usize, Label)>,
    places: HashMap<Label, usize>,
    labels: usize,
}

impl Assembler {
    fn label(&mut self) -> Label {
        self.labels += 1;
        Label(self.labels)
    }

    fn here(&mut self, label: Label) {
        assert!(self.places.insert(label, self.words.len()).is_none(), "label placed twice");
    }

    fn op(&mut self, op: Op, cell: Cell) -> &mut Self {
        self.words.push((op, cell.encode()));
        self
    }

    fn load(&mut self, cell: Cell) -> &mut Self {
        self.op(Op::Load, cell)
    }

    fn store(&mut self, cell: Cell) -> &mut Self {
        self.op(Op::Store, cell)
    }

    fn immediate(&mut self, value: i8) -> &mut Self {
        self.words.push((Op::Immediate, u16::from(value as u8)));
        self
    }

    /// acc = −cell.
    fn negated(&mut self, cell: Cell) -> &mut Self {
        self.immediate(0).op(Op::Subtract, cell)
    }

    fn input(&mut self, port: InputPort) -> &mut Self {
        self.words.push((Op::Input, port as u16));
        self
    }

    fn output(&mut self, port: OutputPort) -> &mut Self {
        self.words.push((Op::Output, port as u16));
        self
    }

    fn product(&mut self) -> &mut Self {
        self.words.push((Op::Product, 0));
        self
    }

    fn quotient(&mut self) -> &mut Self {
        self.words.push((Op::Quotient, 0));
        self
    }

    fn jump(&mut self, op: Op, target: Label) -> &mut Self {
        self.targets.push((self.words.len(), target));
        self.words.push((op, 0));
        self
    }

    fn halt(&mut self) {
        self.words.push((Op::Halt, 0));
    }

    /// Resolves labels and encodes.
    ///
    /// # Panics
    /// If the program is too long or reads a word in the clock in which it is written: mistakes in
    /// the program, found when the gateware is built.
    fn finish(mut self) -> Vec<u16> {
        assert!(self.words.len() <= PROGRAM_WORDS, "{} instructions do not fit", self.words.len());
        for (at, label) in &self.targets {
            self.words[*at].1 = self.places[label] as u16;
        }
        for (at, pair) in self.words.windows(2).enumerate() {
            let [(first, written), (second, read)] = [pair[0], pair[1]];
            let clash = first == Op::Store && second.reads_memory() && layout::overlap(written, read);
            assert!(!clash, "instruction {} reads the word that {at} is writing", at + 1);
        }
        self.words.iter().map(|(op, operand)| (*op as u16) << 11 | operand).collect()
    }
}

impl Op {
    fn reads_memory(self) -> bool {
        use Op::{
            Halt, Immediate, Input, Jump, JumpNegative, JumpNotNegative, JumpNotZero, JumpZero, NextAxis, Nop, Output,
            Product, Quotient, Store,
        };
        !matches!(
            self,
            Nop | Immediate
                | Store
                | Input
                | Output
                | Jump
                | JumpZero
                | JumpNotZero
                | JumpNegative
                | JumpNotNegative
                | NextAxis
                | Product
                | Quotient
                | Halt
        )
    }
}

/// The program of the control tick: the twin of `fixed_kin::control::Core::tick`.
#[must_use]
pub fn control_tick() -> Vec<u16> {
    let mut program = Assembler::default();
    odometry::clear(&mut program);
    let axis = program.label();
    program.here(axis);
    speed::count(&mut program);
    odometry::start(&mut program, 0);
    speed::publish(&mut program);
    odometry::add(&mut program, 0);
    odometry::start(&mut program, 1);
    speed::start(&mut program);
    odometry::add(&mut program, 1);
    kinematics::reference(&mut program);
    pi::start_feed_forward(&mut program);
    speed::finish(&mut program);
    pi::take_feed_forward(&mut program);
    pi::step(&mut program);
    modulation::drive(&mut program);
    program.jump(Op::NextAxis, axis);
    odometry::step(&mut program);
    publish(&mut program);
    program.finish()
}

/// The words of the snapshot that are not written on the way.
fn publish(program: &mut Assembler) {
    program.input(InputPort::Status).store(layout::SNAPSHOT_STATUS);
    program.input(InputPort::Faults).store(layout::SNAPSHOT_FAULTS);
    program.input(InputPort::Now).store(layout::SNAPSHOT_TIME);
    program.immediate(1).op(Op::AddWrapping, layout::SEQUENCE).store(layout::SEQUENCE);
    program.store(layout::SNAPSHOT_SEQUENCE).store(layout::SNAPSHOT_SEQUENCE_END);
    program.halt();
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fits_its_memory_and_ends() {
        let program = control_tick();
        assert!(program.len() <= PROGRAM_WORDS, "{}", program.len());
        assert_eq!(program.last(), Some(&((Op::Halt as u16) << 11)));
    }

    #[test]
    #[should_panic(expected = "reads the word")]
    fn a_hazard_is_refused() {
        let mut program = Assembler::default();
        program.store(layout::SEQUENCE).load(layout::SEQUENCE).halt();
        let _ = program.finish();
    }

    #[test]
    #[should_panic(expected = "reads the word")]
    fn a_hazard_behind_an_axis_number_is_refused() {
        let mut program = Assembler::default();
        program.store(layout::SPEED).load(layout::SPEED.word(3)).halt();
        let _ = program.finish();
    }
}
