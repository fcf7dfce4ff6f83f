//! The kinematics as found, where a named effect changed them; what is merely nearest is typed into no robot.

use crate::analysis::{Analysis, Verdict};
use crate::undo;
use model::firmware::Firmware;

pub(super) fn of(a: &Analysis) -> Option<Firmware> {
    if a.verdict == Verdict::Unexplained {
        return None;
    }
    let nominal = a.effects.iter().fold(a.robot.clone(), |robot, e| undo(&robot, &e.name).unwrap_or(robot));
    Firmware::corrected(&nominal, &a.robot)
}
