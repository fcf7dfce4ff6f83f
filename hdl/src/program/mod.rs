//! The program of the sequencer: what it computes at every control tick.
//!
//! One file a part, each the gateware twin of a function of `fixed-kin`. The sequencer is an
//! accumulator machine on one memory; this module is its instruction set and assembler.
//!
//! An instruction has 16 bits: operation in 15:11, bit 10 = "add the axis number to the address", bit 9 the
//! condition of a [`Op::LoadIf`], address or immediate in 7:0, branch target in 8:0. Every instruction takes one
//! clock, but: a taken branch two, a product 2 + digits and a quotient 34 from their start, less what is done in
//! between. So the parts of the tick are woven: a product is started, something else done, then it is asked for.
//! A sum stands in the accumulator a clock late and a stored word in the memory another clock later; only a
//! store may come at once. Whether the accumulator is zero is known a clock later still. The port of an input is
//! chosen by the instruction before it, so that no branch may lead to one. Where the program asks sooner, the
//! assembler puts a [`Op::Nop`].

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
    /// A step that changes nothing.
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
    /// Tells the next [`Op::LoadIf`] whether acc < m.
    Compare,
    /// acc = m, where the compare before said "less" and bit 9 is set, or neither.
    LoadIf,
    /// acc = acc ^ m.
    Xor,
    /// m = acc.
    Store,
    /// acc = input port.
    Input,
    /// output port = acc.
    Output,
    /// Branch in any case.
    Jump,
    /// Branch where acc = 0, which is known a clock later than acc.
    JumpZero,
    /// Branch where bit 0 of acc is 0: how a flag is asked.
    JumpClear,
    /// Branch where acc < 0.
    JumpNegative,
    /// Branch where acc ≥ 0.
    JumpNotNegative,
    /// Next axis; branch unless it was the last.
    NextAxis,
    /// End of the control tick.
    Halt,
    /// Starts acc·2³² / m, acc of 16 bits; the program goes on.
    Divide,
    /// acc = the quotient when it is there, less one where the numerator was negative.
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
    /// A label stands here: the instruction before the next one is not known.
    fresh: bool,
    asides: Vec<Aside>,
}

/// A piece of program that stands after the rest.
type Aside = Box<dyn FnOnce(&mut Assembler)>;

impl Assembler {
    fn label(&mut self) -> Label {
        self.labels += 1;
        Label(self.labels)
    }

    fn here(&mut self, label: Label) {
        assert!(self.places.insert(label, self.words.len()).is_none(), "label placed twice");
        self.fresh = true;
    }

    fn op(&mut self, op: Op, cell: Cell) -> &mut Self {
        self.push(op, cell.encode())
    }

    /// Appends an instruction, after as long a wait as those before it ask for. Over a taken branch none is asked
    /// for: it takes a clock more than any wait.
    fn push(&mut self, op: Op, operand: u16) -> &mut Self {
        let waits = |(distance, (before, written)): (usize, &(Op, u16))| {
            let sum = distance == 0 && before.is_sum() && op.reads_accumulator();
            // A clock for what changes the accumulator, another for a sum.
            let zero =
                (usize::from(before.changes_accumulator()) + usize::from(before.is_sum())).saturating_sub(distance);
            let word = *before == Op::Store && op.reads_memory() && layout::overlap(*written, operand);
            if op == Op::JumpZero {
                zero
            } else if sum {
                1
            } else if word {
                2 - distance
            } else {
                0
            }
        };
        let wait = self.words.iter().rev().take(2).enumerate().map(waits).max().unwrap_or(0);
        let wait = wait.max(usize::from(self.fresh && op == Op::Input));
        self.fresh = false;
        self.words.extend(std::iter::repeat_n((Op::Nop, 0), wait));
        self.words.push((op, operand));
        self
    }

    /// acc = min(acc, cell).
    fn minimum(&mut self, cell: Cell) -> &mut Self {
        self.op(Op::Compare, cell).push(Op::LoadIf, cell.encode())
    }

    /// acc = max(acc, cell).
    fn maximum(&mut self, cell: Cell) -> &mut Self {
        self.op(Op::Compare, cell).push(Op::LoadIf, cell.encode() | LESS)
    }

    fn load(&mut self, cell: Cell) -> &mut Self {
        self.op(Op::Load, cell)
    }

    fn store(&mut self, cell: Cell) -> &mut Self {
        self.op(Op::Store, cell)
    }

    fn immediate(&mut self, value: i8) -> &mut Self {
        self.push(Op::Immediate, u16::from(value as u8))
    }

    /// acc = −cell.
    fn negated(&mut self, cell: Cell) -> &mut Self {
        self.immediate(0).op(Op::Subtract, cell)
    }

    fn input(&mut self, port: InputPort) -> &mut Self {
        self.push(Op::Input, port as u16)
    }

    fn output(&mut self, port: OutputPort) -> &mut Self {
        self.push(Op::Output, port as u16)
    }

    fn product(&mut self) -> &mut Self {
        self.push(Op::Product, 0)
    }

    fn quotient(&mut self) -> &mut Self {
        self.push(Op::Quotient, 0)
    }

    fn jump(&mut self, op: Op, target: Label) -> &mut Self {
        self.push(op, 0);
        self.targets.push((self.words.len() - 1, target));
        self
    }

    fn halt(&mut self) {
        self.push(Op::Halt, 0);
    }

    /// Puts a piece that is reached by `label` and goes back to `back` out of the way of the program's longest path.
    fn aside(&mut self, label: Label, back: Label, write: impl FnOnce(&mut Self) -> &mut Self + 'static) {
        self.asides.push(Box::new(move |p| {
            p.here(label);
            write(p).jump(Op::Jump, back);
        }));
    }

    /// Resolves labels and encodes.
    ///
    /// # Panics
    /// If the program is too long: a mistake in the program, found when the gateware is built.
    fn finish(mut self) -> Vec<u16> {
        for aside in std::mem::take(&mut self.asides) {
            aside(&mut self);
        }
        assert!(self.words.len() <= PROGRAM_WORDS, "{} instructions do not fit", self.words.len());
        for (at, label) in &self.targets {
            self.words[*at].1 = self.places[label] as u16;
        }
        self.words.iter().map(|(op, operand)| (*op as u16) << 11 | operand).collect()
    }
}

/// In a [`Op::LoadIf`]: load where the compare said "less".
const LESS: u16 = 1 << 9;

impl Op {
    /// Its result is in the accumulator a clock late.
    fn is_sum(self) -> bool {
        matches!(self, Self::Add | Self::Subtract | Self::AddWrapping | Self::Subtract16 | Self::Subtract24)
    }

    /// Reads the accumulator in its first clock.
    fn reads_accumulator(self) -> bool {
        !matches!(
            self,
            Self::Nop
                | Self::Load
                | Self::Immediate
                | Self::Store
                | Self::Input
                | Self::Jump
                | Self::NextAxis
                | Self::Halt
                | Self::Quotient
                | Self::Product
        )
    }

    /// The accumulator is another one after it.
    fn changes_accumulator(self) -> bool {
        let loads = matches!(
            self,
            Self::Load | Self::Immediate | Self::LoadIf | Self::Xor | Self::Input | Self::Quotient | Self::Product
        );
        loads || self.is_sum()
    }

    fn reads_memory(self) -> bool {
        use Op::{
            Halt, Immediate, Input, Jump, JumpClear, JumpNegative, JumpNotNegative, JumpZero, NextAxis, Nop, Output,
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
                | JumpClear
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
    speed::index(&mut program);
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
        assert_eq!(program.iter().filter(|word| **word == (Op::Halt as u16) << 11).count(), 1);
        let last = program.last().map(|word| word >> 11);
        assert!(last == Some(Op::Halt as u16) || last == Some(Op::Jump as u16), "{last:?}");
    }

    fn assembled(write: impl Fn(&mut Assembler) -> &mut Assembler) -> Vec<Op> {
        let mut program = Assembler::default();
        write(&mut program);
        program.words.into_iter().map(|(op, _)| op).collect()
    }

    #[test]
    fn a_sum_is_waited_for_but_by_a_store() {
        let used = assembled(|p| p.op(Op::Add, layout::SUM).op(Op::Add, layout::DUTY));
        assert_eq!(used, [Op::Add, Op::Nop, Op::Add]);
        let stored = assembled(|p| p.op(Op::Add, layout::SUM).store(layout::DUTY).load(layout::SUM));
        assert_eq!(stored, [Op::Add, Op::Store, Op::Load]);
        let loaded = assembled(|p| p.load(layout::SUM).op(Op::Add, layout::DUTY));
        assert_eq!(loaded, [Op::Load, Op::Add]);
    }

    #[test]
    fn a_word_is_read_two_clocks_after_its_store() {
        let next = assembled(|p| p.store(layout::SEQUENCE).load(layout::SEQUENCE));
        assert_eq!(next, [Op::Store, Op::Nop, Op::Nop, Op::Load]);
        let later = assembled(|p| p.store(layout::SEQUENCE).immediate(0).load(layout::SEQUENCE));
        assert_eq!(later, [Op::Store, Op::Immediate, Op::Nop, Op::Load]);
        let other = assembled(|p| p.store(layout::SEQUENCE).load(layout::SUM));
        assert_eq!(other, [Op::Store, Op::Load]);
        let some_axis = assembled(|p| p.store(layout::SPEED).load(layout::SPEED.word(3)));
        assert_eq!(some_axis, [Op::Store, Op::Nop, Op::Nop, Op::Load]);
    }
}
