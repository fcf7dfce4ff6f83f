//! Direct kinematics and pose: the twin of `fixed_kin::pose`.

use super::layout::{
    ARC, DIFFERENCE, DISPLACEMENT, ERROR, HEADING, POSE_X, POSE_Y, SCRATCH, SNAPSHOT_POSE, SUM, direct_row,
};
use super::{Assembler, InputPort, Op, OutputPort};

pub(super) fn clear(p: &mut Assembler) {
    p.immediate(0);
    for k in 0..3 {
        p.store(DISPLACEMENT.word(k));
    }
}

/// Starts what this axis' counts contribute to displacement `k`.
pub(super) fn start(p: &mut Assembler, k: usize) {
    p.load(DIFFERENCE).op(Op::MultiplyCounts, direct_row(k));
}

/// Adds the product that [`start`] began to its displacement.
pub(super) fn add(p: &mut Assembler, k: usize) {
    p.product().op(Op::Add, DISPLACEMENT.word(k)).store(DISPLACEMENT.word(k));
}

/// The pose, from the displacement of all axes; or zero.
pub(super) fn step(p: &mut Assembler) {
    let [none, done] = [(); 2].map(|()| p.label());
    let [dx, dy, half] = [0, 1, 2].map(|k| DISPLACEMENT.word(k));
    // The axes are through with their temporaries.
    let (small, part, x, y) = (SCRATCH, DIFFERENCE, ERROR, SUM);

    p.input(InputPort::Odometry).jump(Op::JumpClear, none);
    p.aside(none, done, |p| {
        p.immediate(0).store(POSE_X).store(POSE_Y).store(HEADING);
        (0..3).fold(p, |p, k| p.store(SNAPSHOT_POSE.word(k)))
    });
    p.load(HEADING).op(Op::AddWrapping, half).output(OutputPort::Angle);
    p.op(Op::AddWrapping, half).store(HEADING).store(SNAPSHOT_POSE.word(2));

    // The small angle to the entry of the table, and the displacement turned by it.
    p.input(InputPort::Fraction).op(Op::MultiplyCoefficient, ARC).product().store(small);
    p.op(Op::MultiplyFine, dy).product().store(part);
    p.load(dx).op(Op::Subtract, part).store(x);
    p.load(small).op(Op::MultiplyFine, dx).product().op(Op::Add, dy).store(y);

    p.input(InputPort::Sine).op(Op::MultiplyCoefficient, y).product().store(part);
    p.input(InputPort::Cosine).op(Op::MultiplyCoefficient, x).product().op(Op::Subtract, part);
    p.op(Op::AddWrapping, POSE_X).store(POSE_X).store(SNAPSHOT_POSE.word(0));
    p.input(InputPort::Sine).op(Op::MultiplyCoefficient, x).product().store(part);
    p.input(InputPort::Cosine).op(Op::MultiplyCoefficient, y).product().op(Op::Add, part);
    p.op(Op::AddWrapping, POSE_Y).store(POSE_Y).store(SNAPSHOT_POSE.word(1));
    p.here(done);
}
