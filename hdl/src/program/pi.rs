//! The PI speed loop of one axis: the twin of `fixed_kin::pi::PiState::step`.

use super::layout::{
    DUTY, ERROR, INTEGRAL, KI, KP, LOWER, NEW_INTEGRAL, PROPORTIONAL, REFERENCE, SNAPSHOT_DUTY, SPEED, SUM, UPPER,
};
use super::{Assembler, InputPort, Op};

pub(super) fn step(p: &mut Assembler) {
    let [off, outside, accept, done] = [(); 4].map(|()| p.label());
    p.input(InputPort::Armed).jump(Op::JumpZero, off);
    p.load(REFERENCE).op(Op::Subtract, SPEED).store(ERROR);
    p.load(KP).op(Op::MultiplyWide, ERROR).store(PROPORTIONAL);
    p.load(KI).op(Op::MultiplyFine, ERROR).op(Op::Add, INTEGRAL).store(NEW_INTEGRAL);
    p.op(Op::Add, PROPORTIONAL).store(SUM);
    p.op(Op::Minimum, UPPER).op(Op::Maximum, LOWER).store(DUTY);
    p.op(Op::Subtract, SUM).jump(Op::JumpNotZero, outside);
    p.here(accept);
    p.load(NEW_INTEGRAL).store(INTEGRAL).jump(Op::Jump, done);
    p.here(outside);
    // Signs of sum and error differ: the error drives back inside.
    p.load(SUM).op(Op::Xor, ERROR).jump(Op::JumpNegative, accept);
    p.load(PROPORTIONAL).op(Op::Add, INTEGRAL);
    p.op(Op::Minimum, UPPER).op(Op::Maximum, LOWER).store(DUTY).jump(Op::Jump, done);
    p.here(off);
    p.immediate(0).store(DUTY).store(INTEGRAL);
    p.here(done);
    p.load(DUTY).store(SNAPSHOT_DUTY);
}
