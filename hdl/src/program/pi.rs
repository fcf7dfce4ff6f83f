//! The PI speed loop of one axis: the twin of `fixed_kin::pi::PiState::step`, in parts with room for
//! other work while the multiplier runs.

use super::layout::{
    DUTY, ERROR, FORWARD, INTEGRAL, KFF, KI, KP, LOWER, NEW_INTEGRAL, PROPORTIONAL, REFERENCE, SPEED, SUM, UPPER,
};
use super::{Assembler, InputPort, Op, odometry};

pub(super) fn start_feed_forward(p: &mut Assembler) {
    p.load(KFF).op(Op::MultiplyCoefficient, REFERENCE);
}

pub(super) fn take_feed_forward(p: &mut Assembler) {
    p.product().store(FORWARD);
}

/// The duty; the third row of the odometry is started on the way.
pub(super) fn step(p: &mut Assembler) {
    let [off, accept, done] = [(); 3].map(|()| p.label());
    p.load(REFERENCE).op(Op::Subtract, SPEED).store(ERROR);
    p.load(KP).op(Op::MultiplyWide, ERROR);
    p.input(InputPort::Armed).jump(Op::JumpClear, off);
    p.product().store(PROPORTIONAL);
    p.load(KI).op(Op::MultiplyFine, ERROR);
    p.load(PROPORTIONAL).op(Op::Add, FORWARD).store(PROPORTIONAL);
    p.product().op(Op::Add, INTEGRAL).store(NEW_INTEGRAL);
    odometry::start(p, 2);
    p.load(NEW_INTEGRAL).op(Op::Add, PROPORTIONAL).store(SUM);
    p.minimum(UPPER).maximum(LOWER).store(DUTY);
    p.op(Op::Subtract, SUM).jump(Op::JumpZero, accept);
    // Signs of sum and error differ: the error drives back inside.
    p.load(SUM).op(Op::Xor, ERROR).jump(Op::JumpNegative, accept);
    p.load(PROPORTIONAL).op(Op::Add, INTEGRAL);
    p.minimum(UPPER).maximum(LOWER).store(DUTY);
    p.here(done);
    p.aside(accept, done, |p| p.load(NEW_INTEGRAL).store(INTEGRAL));
    p.aside(off, done, |p| {
        p.product();
        odometry::start(p, 2);
        p.immediate(0).store(DUTY).store(INTEGRAL)
    });
}
