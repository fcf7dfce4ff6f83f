//! Effects of a `robot.toml` in the simulator: the true robot behind the nominal one.
//!
//! [`Applied::of`] turns the `[[effect]]` tables into a robot, a floor, a camera and a controller to
//! simulate; what only shows in the finished log (stamps that jitter) is put on by
//! [`Applied::finish`]. Equations and parameter names are those of the gap workflow.

mod camera;
mod control;
mod geometry;
mod plant;

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

pub use control::ControlDeviations;

use crate::camera::CameraModel;
use crate::imu::ImuDeviations;
use crate::plant::{Contact, Deviations, Plant};
use runs::Run;
use runs::geometry::GeometryError;
use runs::robot::{Effect, Robot};

/// What to simulate for a robot with effects.
#[derive(Debug, Clone, PartialEq)]
pub struct Applied {
    /// The true robot, without `[[effect]]` tables.
    pub robot: Robot,
    /// Wheels on the floor: friction and creep.
    pub contact: Contact,
    /// What `robot` cannot say about the true one.
    pub deviations: Deviations,
    /// What the overhead camera is like, with its effects.
    pub camera: CameraModel,
    /// What the inertial sensor is like, where the robot has one.
    pub imu: ImuDeviations,
    /// Where the controller's numbers differ from those of `robot`.
    pub control: ControlDeviations,
    /// Standard deviation of a camera stamp about its capture time, s.
    pub stamp_jitter_s: f64,
    /// Names of effects that the simulator does not know, such as a user's own.
    pub unsupported: Vec<String>,
}

impl Applied {
    /// Applies the effects of a robot's file.
    pub fn of(robot: &Robot) -> Self {
        let mut applied = Self {
            robot: Robot { effects: Vec::new(), ..robot.clone() },
            contact: Contact::Rolling,
            deviations: Deviations::default(),
            camera: CameraModel::of(robot),
            imu: ImuDeviations::default(),
            control: ControlDeviations::default(),
            stamp_jitter_s: 0.0,
            unsupported: Vec::new(),
        };
        for effect in &robot.effects {
            if effect.name == "camera-timing" {
                applied.stamp_jitter_s = effect.value("jitter_s").unwrap_or(0.0);
            }
            control::reckoned(effect, &mut applied.control);
            let known = geometry::cables(effect, &mut applied.robot)
                || geometry::apply(effect, &mut applied.robot)
                || plant::apply(effect, &mut applied)
                || camera::apply(effect, &mut applied.camera)
                || applied.imu.apply(effect)
                || control::apply(effect, robot.wheel_count(), &mut applied.control);
            if !known {
                applied.unsupported.push(effect.name.clone());
            }
        }
        applied
    }

    /// Parameters, as (effect, parameter), that effects of the simulator carry and none of their equations reads:
    /// names written wrong.
    #[must_use]
    pub fn unread(robot: &Robot) -> Vec<(String, String)> {
        let alone = |effect: &Effect| Self::of(&Robot { effects: vec![effect.clone()], ..robot.clone() });
        let mut found = Vec::new();
        for effect in &robot.effects {
            let applied = alone(effect);
            for (i, (name, parameter)) in effect.parameters.iter().enumerate() {
                // Several other values, for a value may be out of its equation's range.
                let acts = [0.3, -0.3, 1e-3, 2.0, -parameter.value].iter().any(|value| {
                    let mut other = effect.clone();
                    other.parameters[i].1.value = *value;
                    alone(&other) != applied
                });
                if !acts && applied.unsupported.is_empty() {
                    found.push((effect.name.clone(), name.clone()));
                }
            }
        }
        found
    }

    /// The robot with its effects on geometry in its layout and its wheel radius, and all others as they were.
    #[must_use]
    pub fn geometry_of(robot: &Robot) -> Robot {
        let mut out = robot.clone();
        let effects = std::mem::take(&mut out.effects);
        for mut effect in effects {
            geometry::cables(&effect, &mut out);
            effect.parameters.retain(|(name, _)| !name.starts_with(geometry::CABLE));
            let bare = effect.name == "wheel-order" && effect.parameters.is_empty();
            if !bare && !geometry::apply(&effect, &mut out) {
                out.effects.push(effect);
            }
        }
        out
    }

    /// Motors, wheels and body.
    ///
    /// # Errors
    /// [`GeometryError`] if the wheels cannot drive the robot.
    pub fn plant(&self) -> Result<Plant, GeometryError> {
        Ok(Plant::new(&self.robot)?.with_contact(self.contact).with_deviations(&self.deviations))
    }

    /// Moves the stamps of a simulated log by their jitter.
    pub fn finish(&self, run: &mut Run, seed: u64) {
        if self.stamp_jitter_s == 0.0 {
            return;
        }
        let mut rng = ChaCha8Rng::seed_from_u64(seed ^ 0x7374_616d_7073);
        let mut free = 0;
        for sample in &mut run.camera {
            let error: f64 = StandardNormal.sample(&mut rng);
            let late = (self.stamp_jitter_s * error / self.robot.tick_s()).round() as i64;
            sample.tick = sample.tick.saturating_add_signed(late as isize).max(free);
            free = sample.tick + 1;
        }
        run.camera.retain(|sample| sample.tick < run.t.len());
    }
}

/// A parameter of wheel `i` (from 0): `stem_i+1_unit` plus the common `stem_unit`.
fn of_wheel(effect: &Effect, stem: &str, i: usize, unit: &str) -> f64 {
    let join = |stem: &str| if unit.is_empty() { stem.to_owned() } else { format!("{stem}_{unit}") };
    effect.value(&join(&format!("{stem}_{}", i + 1))).unwrap_or(0.0) + effect.value(&join(stem)).unwrap_or(0.0)
}

#[cfg(test)]
mod tests;
