//! Inverse kinematics and slew limit: the twins of `fixed_kin::kinematics` and `fixed_kin::slew`.

use super::layout::{FALL, REFERENCE, RISE, SCRATCH, SET_POINT, SNAPSHOT_REFERENCE, SUM, inverse_column};
use super::{Assembler, InputPort, Op};

/// The speed set point of this axis.
pub(super) fn reference(p: &mut Assembler) {
    let [off, wheels, none, slew, done] = [(); 5].map(|()| p.label());
    p.input(InputPort::Armed).jump(Op::JumpClear, off);
    p.input(InputPort::SetPointsValid).jump(Op::JumpClear, none);
    p.input(InputPort::Twist).jump(Op::JumpClear, wheels);
    let start = |p: &mut Assembler, k| {
        p.load(inverse_column(k)).op(Op::MultiplyCoefficient, SET_POINT.word(k));
    };
    start(p, 0);
    p.product().store(SCRATCH);
    start(p, 1);
    p.product().store(SUM);
    start(p, 2);
    p.load(SUM).op(Op::Add, SCRATCH).store(SCRATCH);
    p.product().op(Op::Add, SCRATCH);
    p.here(slew);
    p.op(Op::Subtract, REFERENCE).minimum(RISE).maximum(FALL).op(Op::Add, REFERENCE);
    p.here(done);
    p.store(REFERENCE).store(SNAPSHOT_REFERENCE);
    p.aside(off, done, |p| p.immediate(0));
    p.aside(none, slew, |p| p.immediate(0));
    p.aside(wheels, slew, |p| p.load(SET_POINT));
}
