//! Speed of one axis: the twin of `fixed_kin::speed::SpeedState::step`, in two parts with room for
//! other work while the divider runs.

use super::layout::{
    CASE, COUNT, DENOMINATOR, DIFFERENCE, EDGE_TIME, EDGE_VALID, LINE, SCRATCH, SNAPSHOT_COUNT, SNAPSHOT_SPEED, SPEED,
    TIMEOUT,
};
use super::{Assembler, InputPort, Op};

/// What the quotient means.
const PLAIN: i8 = 0;
const BOUND: i8 = 1;
const STILL: i8 = -1;

/// Counts, and a division under way.
pub(super) fn start(p: &mut Assembler) {
    let [by_time, first, remember, no_edge, still, plain, case] = [(); 7].map(|()| p.label());

    p.input(InputPort::Count).op(Op::Subtract16, COUNT).store(DIFFERENCE);
    p.op(Op::AddWrapping, COUNT).store(COUNT).store(SNAPSHOT_COUNT);
    p.input(InputPort::CountAndTime).jump(Op::JumpNotZero, by_time);
    p.input(InputPort::TickPeriod).store(DENOMINATOR);
    p.load(DIFFERENCE).op(Op::Divide, DENOMINATOR).jump(Op::Jump, plain);

    p.here(by_time);
    p.input(InputPort::EdgeTime).op(Op::Subtract24, EDGE_TIME).jump(Op::JumpZero, no_edge);
    p.store(DENOMINATOR);
    p.load(EDGE_VALID).jump(Op::JumpZero, first);
    p.input(InputPort::Line).op(Op::Subtract16, LINE).op(Op::Divide, DENOMINATOR);
    p.jump(Op::Jump, remember);
    p.here(first);
    p.input(InputPort::TickPeriod).store(DENOMINATOR);
    p.load(DIFFERENCE).op(Op::Divide, DENOMINATOR);
    p.here(remember);
    p.input(InputPort::EdgeTime).store(EDGE_TIME);
    p.input(InputPort::Line).store(LINE);
    p.immediate(1).store(EDGE_VALID);
    p.here(plain);
    p.immediate(PLAIN).jump(Op::Jump, case);

    p.here(no_edge);
    p.load(EDGE_VALID).jump(Op::JumpZero, still);
    p.input(InputPort::Now).op(Op::Subtract24, EDGE_TIME).store(DENOMINATOR);
    p.op(Op::Subtract, TIMEOUT).jump(Op::JumpNotNegative, still);
    p.immediate(1).op(Op::Divide, DENOMINATOR);
    p.immediate(BOUND).jump(Op::Jump, case);
    p.here(still);
    p.immediate(0).store(EDGE_VALID);
    p.immediate(STILL);

    p.here(case);
    p.store(CASE);
}

/// The quotient, or the last speed within ± the quotient, or zero.
pub(super) fn finish(p: &mut Assembler) {
    let [plain, still, falling, done] = [(); 4].map(|()| p.label());
    p.load(CASE).jump(Op::JumpZero, plain).jump(Op::JumpNegative, still);
    p.op(Op::Quotient, CASE).store(SCRATCH);
    p.load(SPEED).jump(Op::JumpNegative, falling);
    p.op(Op::Minimum, SCRATCH).jump(Op::Jump, done);
    p.here(falling);
    p.negated(SCRATCH).op(Op::Maximum, SPEED).jump(Op::Jump, done);
    p.here(still);
    p.immediate(0).jump(Op::Jump, done);
    p.here(plain);
    p.op(Op::Quotient, CASE);
    p.here(done);
    p.store(SPEED).store(SNAPSHOT_SPEED);
}
