//! Duty to PWM compare value: the twin of `fixed_kin::modulation::modulate`.

use super::layout::{DUTY, ROUNDING, SCRATCH, SNAPSHOT_DUTY};
use super::{Assembler, InputPort, Op, OutputPort, odometry, speed};

/// The compare value; beside it the third row of the odometry ends, and counts and duty are published.
pub(super) fn drive(p: &mut Assembler) {
    let forward = p.label();
    p.load(DUTY).output(OutputPort::Direction).jump(Op::JumpNotNegative, forward);
    p.negated(DUTY);
    p.here(forward);
    p.store(SCRATCH);
    odometry::add(p, 2);
    p.input(InputPort::PwmPeriod).op(Op::MultiplyPeriod, SCRATCH);
    p.load(DUTY).store(SNAPSHOT_DUTY);
    speed::publish(p);
    p.product();
    p.op(Op::Add, ROUNDING).output(OutputPort::Compare);
}
