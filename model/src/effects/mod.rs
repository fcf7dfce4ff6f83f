//! Effects of a `robot.toml` in the simulator: the true robot behind the nominal one.
//!
//! [`Applied::of`] turns the `[[effect]]` tables into a robot, a floor and a camera to simulate;
//! what the logs show beyond that (a marker that sits askew, a camera that distorts) is put on by
//! [`Applied::finish`]. Equations and parameter names are those of the gap workflow.

mod camera;
mod geometry;
mod plant;

use crate::camera::CameraModel;
use crate::plant::Contact;
use crate::robot::{Effect, Robot};
use crate::run::Run;

/// What to simulate for a robot with effects.
#[derive(Debug, Clone, PartialEq)]
pub struct Applied {
    /// The true robot, without `[[effect]]` tables.
    pub robot: Robot,
    /// The floor.
    pub contact: Contact,
    /// The camera.
    pub camera: CameraModel,
    /// Names of effects that the simulator cannot show.
    pub unsupported: Vec<String>,
    effects: Vec<Effect>,
}

impl Applied {
    /// Applies the effects of a robot's file.
    pub fn of(robot: &Robot) -> Self {
        let mut applied = Self {
            robot: Robot { effects: Vec::new(), ..robot.clone() },
            contact: Contact::Rolling,
            camera: CameraModel::of(robot),
            unsupported: Vec::new(),
            effects: robot.effects.clone(),
        };
        for effect in &robot.effects {
            let known = geometry::apply(effect, &mut applied.robot)
                || plant::apply(effect, &mut applied)
                || camera::apply(effect, &mut applied.camera)
                || camera::is_seen(effect);
            if !known {
                applied.unsupported.push(effect.name.clone());
            }
        }
        applied
    }

    /// What the camera makes of the poses of a simulated log.
    pub fn finish(&self, run: &mut Run) {
        for effect in &self.effects {
            for sample in &mut run.camera {
                sample.pose = camera::seen(effect, sample.pose);
            }
        }
    }
}

/// A parameter of wheel `i` (from 0): `stem_i+1_unit` plus the common `stem_unit`.
fn of_wheel(effect: &Effect, stem: &str, i: usize, unit: &str) -> f64 {
    let join = |stem: &str| if unit.is_empty() { stem.to_owned() } else { format!("{stem}_{unit}") };
    effect.value(&join(&format!("{stem}_{}", i + 1))).unwrap_or(0.0) + effect.value(&join(stem)).unwrap_or(0.0)
}

#[cfg(test)]
mod tests;
