//! Counts and speed of one axis: the twin of `fixed_kin::speed::SpeedState::step`, in parts with room for
//! other work while divider and multiplier run.

use super::layout::{
    ALL_ONES, CASE, COUNT, DENOMINATOR, DIFFERENCE, EDGE_TIME, HOME, INDEX_POSITION, LINE, SCRATCH, SNAPSHOT_COUNT,
    SNAPSHOT_SPEED, SPEED, TIMEOUT,
};
use super::{Assembler, InputPort, Op};

/// What the quotient means.
const PLAIN: i8 = 0;
const BOUND: i8 = 1;
const STILL: i8 = -1;

/// Counts of the tick and since power-up.
pub(super) fn count(p: &mut Assembler) {
    p.input(InputPort::Count).op(Op::Subtract16, COUNT).store(DIFFERENCE);
    p.op(Op::AddWrapping, COUNT).store(COUNT);
}

/// A captured index, and the counts from the place that is zero.
pub(super) fn publish(p: &mut Assembler) {
    let publish = p.label();
    p.input(InputPort::IndexEvent).jump(Op::JumpZero, publish);
    p.input(InputPort::IndexCount).op(Op::Subtract16, COUNT).op(Op::AddWrapping, COUNT).store(SCRATCH);
    p.op(Op::AddWrapping, HOME).store(INDEX_POSITION);
    p.input(InputPort::IndexClear).jump(Op::JumpZero, publish);
    // −x = ~x + 1: a plain difference would saturate.
    p.load(SCRATCH).op(Op::Xor, ALL_ONES).store(SCRATCH);
    p.immediate(1).op(Op::AddWrapping, SCRATCH).store(HOME);
    p.here(publish);
    p.load(COUNT).op(Op::AddWrapping, HOME).store(SNAPSHOT_COUNT);
}

/// A division under way, and what its quotient will mean.
pub(super) fn start(p: &mut Assembler) {
    let [by_time, first, remember, no_edge, still, plain, case] = [(); 7].map(|()| p.label());

    p.input(InputPort::CountAndTime).jump(Op::JumpNotZero, by_time);
    p.input(InputPort::TickPeriod).store(DENOMINATOR);
    p.load(DIFFERENCE).op(Op::Divide, DENOMINATOR).jump(Op::Jump, plain);

    p.here(by_time);
    p.input(InputPort::EdgeTime).op(Op::Subtract24, EDGE_TIME).jump(Op::JumpZero, no_edge);
    p.store(DENOMINATOR);
    p.load(LINE).jump(Op::JumpNegative, first);
    p.input(InputPort::Line).op(Op::Subtract16, LINE).op(Op::Divide, DENOMINATOR);
    p.jump(Op::Jump, remember);
    p.here(first);
    p.input(InputPort::TickPeriod).store(DENOMINATOR);
    p.load(DIFFERENCE).op(Op::Divide, DENOMINATOR);
    p.here(remember);
    p.input(InputPort::EdgeTime).store(EDGE_TIME);
    p.input(InputPort::Line).store(LINE);
    p.here(plain);
    p.immediate(PLAIN).jump(Op::Jump, case);

    p.here(no_edge);
    p.load(LINE).jump(Op::JumpNegative, still);
    p.input(InputPort::Now).op(Op::Subtract24, EDGE_TIME).store(DENOMINATOR);
    p.op(Op::Subtract, TIMEOUT).jump(Op::JumpNotNegative, still);
    p.immediate(1).op(Op::Divide, DENOMINATOR);
    p.immediate(BOUND).jump(Op::Jump, case);
    p.here(still);
    // A negative line: the next edge has no partner.
    p.immediate(STILL).store(LINE);

    p.here(case);
    p.store(CASE);
}

/// The quotient, or the last speed within ± the quotient, or zero.
pub(super) fn finish(p: &mut Assembler) {
    let [plain, still, falling, done] = [(); 4].map(|()| p.label());
    p.load(CASE).jump(Op::JumpZero, plain).jump(Op::JumpNegative, still);
    p.quotient().store(SCRATCH);
    p.load(SPEED).jump(Op::JumpNegative, falling);
    p.op(Op::Minimum, SCRATCH).jump(Op::Jump, done);
    p.here(falling);
    p.negated(SCRATCH).op(Op::Maximum, SPEED).jump(Op::Jump, done);
    p.here(still);
    p.immediate(0).jump(Op::Jump, done);
    p.here(plain);
    p.quotient();
    p.here(done);
    p.store(SPEED).store(SNAPSHOT_SPEED);
}
