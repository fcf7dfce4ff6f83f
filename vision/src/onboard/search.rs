//! Where a robot is that turns round because its belief is wrong: all lines around it, as one picture.

use crate::LinePoint;
use crate::camera::Camera;
use crate::localise::{Estimate, FloorPoint, Map, misfit, on_floor, places};
use runs::frames::{Pose, wrap_angle};
use std::f64::consts::{FRAC_PI_2, PI};

/// Turn after which it looks for the place, and again, rad.
const FIRST: f64 = PI;
const AGAIN: f64 = 0.5;
/// Most points that are matched; they are drawn evenly.
const MOST: usize = 400;
/// Logarithm of how much less likely the second-best place must be: a hundred times. Of 48 places drawn at random on a field
/// of division B, half of them among eleven other robots, it told 34, all of them right to 14 mm, and left open 14, about the
/// centre circle and where little is to be seen.
const CLEAR: f64 = 4.6;

/// Points on lines in the robot's frame of now, and how they came.
#[derive(Clone, Debug)]
pub(super) struct Search {
    floor: Vec<FloorPoint>,
    /// Where the robot believes to be: wrong, but moves as the robot does.
    at: Pose,
    turned: f64,
    due: f64,
}

impl Search {
    pub(super) fn from(at: Pose) -> Self {
        Self { floor: Vec::new(), at, turned: 0.0, due: FIRST }
    }

    /// Adds what a frame shows, taken where the robot is believed to be.
    pub(super) fn see(&mut self, camera: &Camera, lines: &[LinePoint], at: Pose) {
        let before = at.relative(self.at);
        self.turned += wrap_angle(before.theta).abs();
        self.at = at;
        self.floor.iter_mut().for_each(|point| *point = point.seen_from(before));
        self.floor.extend(on_floor(camera, lines));
    }

    /// The place, once the robot has turned far enough and no other place is as good. The field looks the same from its
    /// other end: the one whose heading is nearer to what is believed is taken.
    pub(super) fn place(&mut self, map: &Map) -> Option<Estimate> {
        if self.turned < self.due {
            return None;
        }
        self.due = self.turned + AGAIN;
        let every = self.floor.len().div_ceil(MOST).max(1);
        let floor: Vec<FloorPoint> = self.floor.iter().step_by(every).copied().collect();
        let near = |found: &Estimate| wrap_angle(found.pose.theta - self.at.theta).abs() < FRAC_PI_2;
        let mut found = places(map, &floor).into_iter().filter(near);
        let best = found.next()?;
        let likeliest = misfit(map, &floor, best.pose);
        let clear = found.next().is_none_or(|second| misfit(map, &floor, second.pose) - likeliest > CLEAR);
        clear.then_some(best)
    }
}
