//! The kinematics as found, where a named effect changed them.

use crate::analysis::Analysis;
use crate::undo;
use model::firmware::Firmware;

pub(super) fn of(a: &Analysis) -> Option<Firmware> {
    let nominal = a.effects.iter().fold(a.robot.clone(), |robot, e| undo(&robot, &e.name).unwrap_or(robot));
    Firmware::corrected(&nominal, &a.robot)
}
