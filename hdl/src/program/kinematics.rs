//! Inverse kinematics and slew limit: the twins of `fixed_kin::kinematics` and `fixed_kin::slew`.

use super::layout::{FALL, REFERENCE, RISE, SCRATCH, SET_POINT, SNAPSHOT_REFERENCE, inverse_column};
use super::{Assembler, InputPort, Op};

/// The speed set point of this axis.
pub(super) fn reference(p: &mut Assembler) {
    let [on, wheels, none, slew, done] = [(); 5].map(|()| p.label());
    p.input(InputPort::Armed).jump(Op::JumpNotZero, on);
    p.immediate(0).jump(Op::Jump, done);
    p.here(none);
    p.immediate(0).jump(Op::Jump, slew);
    p.here(wheels);
    p.load(SET_POINT).jump(Op::Jump, slew);
    p.here(on);
    p.input(InputPort::SetPointsValid).jump(Op::JumpZero, none);
    p.input(InputPort::Twist).jump(Op::JumpZero, wheels);
    for k in 0..3 {
        p.load(inverse_column(k)).op(Op::MultiplyCoefficient, SET_POINT.word(k)).product();
        if k > 0 {
            p.op(Op::Add, SCRATCH);
        }
        if k < 2 {
            p.store(SCRATCH);
        }
    }
    p.here(slew);
    p.op(Op::Subtract, REFERENCE).op(Op::Minimum, RISE).op(Op::Maximum, FALL).op(Op::Add, REFERENCE);
    p.here(done);
    p.store(REFERENCE).store(SNAPSHOT_REFERENCE);
}
