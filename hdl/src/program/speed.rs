//! Counts and speed of one axis: the twin of `fixed_kin::speed::SpeedState::step`, in parts with room for
//! other work while divider and multiplier run.

use super::layout::{
    ALL_ONES, CASE, COUNT, DENOMINATOR, DIFFERENCE, EDGE_TIME, HOME, INDEX_POSITION, LINE, SCRATCH, SNAPSHOT_COUNT,
    SNAPSHOT_SPEED, SPEED, TIMEOUT,
};
use super::{Assembler, InputPort, Op};

/// What the quotient means.
const PLAIN: i8 = 0;
/// Also the count that is divided.
const BOUND: i8 = 1;
const STILL: i8 = -1;

/// Counts of the tick and since power-up.
pub(super) fn count(p: &mut Assembler) {
    p.input(InputPort::Count).op(Op::Subtract16, COUNT).store(DIFFERENCE);
    p.op(Op::AddWrapping, COUNT).store(COUNT);
}

/// A captured index, and where the counts are zero.
pub(super) fn index(p: &mut Assembler) {
    let done = p.label();
    p.input(InputPort::IndexEvent).jump(Op::JumpClear, done);
    p.input(InputPort::IndexCount).op(Op::Subtract16, COUNT).op(Op::AddWrapping, COUNT).store(SCRATCH);
    p.op(Op::AddWrapping, HOME).store(INDEX_POSITION);
    p.input(InputPort::IndexClear).jump(Op::JumpClear, done);
    // −x = ~(x − 1): a plain difference would saturate.
    p.load(SCRATCH).op(Op::AddWrapping, ALL_ONES).op(Op::Xor, ALL_ONES).store(HOME);
    p.here(done);
}

/// The counts from the place that is zero.
pub(super) fn publish(p: &mut Assembler) {
    p.load(COUNT).op(Op::AddWrapping, HOME).store(SNAPSHOT_COUNT);
}

/// A division under way, and what its quotient will mean.
pub(super) fn start(p: &mut Assembler) {
    let [by_count, first, remember, no_edge, still, plain, case] = [(); 7].map(|()| p.label());

    p.input(InputPort::CountAndTime).jump(Op::JumpClear, by_count);
    p.aside(by_count, plain, |p| {
        p.input(InputPort::TickPeriod).store(DENOMINATOR);
        p.load(DIFFERENCE).op(Op::Divide, DENOMINATOR)
    });
    p.input(InputPort::EdgeTime).op(Op::Subtract24, EDGE_TIME).store(DENOMINATOR).jump(Op::JumpZero, no_edge);
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

    // A negative line: the next edge has no partner.
    p.aside(still, case, |p| p.immediate(STILL).store(LINE));

    p.here(no_edge);
    p.load(LINE).jump(Op::JumpNegative, still);
    p.input(InputPort::Now).op(Op::Subtract24, EDGE_TIME).store(DENOMINATOR);
    p.op(Op::Subtract, TIMEOUT).jump(Op::JumpNotNegative, still);
    // What is divided is also the case.
    p.immediate(BOUND).op(Op::Divide, DENOMINATOR);
    p.here(case);
    p.store(CASE);
}

/// The quotient, or the last speed within ± the quotient, or zero. The divider gives a negative one less one.
pub(super) fn finish(p: &mut Assembler) {
    let [plain, still, rising, done] = [(); 4].map(|()| p.label());
    p.load(CASE).jump(Op::JumpNegative, still).jump(Op::JumpClear, plain);
    p.quotient().store(SCRATCH);
    p.load(SPEED).jump(Op::JumpNotNegative, rising);
    p.negated(SCRATCH).maximum(SPEED);
    p.here(done);
    p.store(SPEED).store(SNAPSHOT_SPEED);
    p.aside(rising, done, |p| p.minimum(SCRATCH));
    p.aside(still, done, |p| p.immediate(0));
    p.aside(plain, done, move |p| {
        p.quotient().jump(Op::JumpNotNegative, done);
        p.op(Op::Subtract, ALL_ONES)
    });
}
