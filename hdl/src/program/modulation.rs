//! Duty to PWM compare value: the twin of `fixed_kin::modulation::modulate`.

use super::layout::{DUTY, ROUNDING, SCRATCH};
use super::{Assembler, InputPort, Op, OutputPort};

pub(super) fn drive(p: &mut Assembler) {
    let forward = p.label();
    // The accumulator still holds the duty.
    p.output(OutputPort::Direction).jump(Op::JumpNotNegative, forward);
    p.negated(DUTY);
    p.here(forward);
    p.store(SCRATCH);
    p.input(InputPort::PwmPeriod).op(Op::MultiplyPeriod, SCRATCH).product();
    p.op(Op::Add, ROUNDING).output(OutputPort::Compare);
}
