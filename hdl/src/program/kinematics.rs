//! Direct and inverse kinematics: the twin of `fixed_kin::kinematics`.

use super::layout::{REFERENCE, SCRATCH, SET_POINT, SNAPSHOT_REFERENCE, SPEED, TWIST, direct_row, inverse_column};
use super::{Assembler, InputPort, Op};

pub(super) fn clear_twist(p: &mut Assembler) {
    p.immediate(0);
    for k in 0..3 {
        p.store(TWIST.word(k));
    }
}

/// Adds what this axis' speed contributes to the body velocity.
pub(super) fn accumulate_twist(p: &mut Assembler) {
    for k in 0..3 {
        p.load(direct_row(k)).op(Op::MultiplyCoefficient, SPEED);
        p.op(Op::Add, TWIST.word(k)).store(TWIST.word(k));
    }
}

/// The speed set point of this axis.
pub(super) fn reference(p: &mut Assembler) {
    let [none, inverse, done] = [(); 3].map(|()| p.label());
    p.input(InputPort::SetPointsValid).jump(Op::JumpZero, none);
    p.input(InputPort::Twist).jump(Op::JumpNotZero, inverse);
    p.load(SET_POINT).jump(Op::Jump, done);
    p.here(inverse);
    p.load(inverse_column(0)).op(Op::MultiplyCoefficient, SET_POINT.word(0)).store(SCRATCH);
    for k in 1..3 {
        p.load(inverse_column(k)).op(Op::MultiplyCoefficient, SET_POINT.word(k)).op(Op::Add, SCRATCH);
        if k == 1 {
            p.store(SCRATCH);
        }
    }
    p.jump(Op::Jump, done);
    p.here(none);
    p.immediate(0);
    p.here(done);
    p.store(REFERENCE).store(SNAPSHOT_REFERENCE);
}
