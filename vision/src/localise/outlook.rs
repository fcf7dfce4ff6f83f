//! What a look would tell: the points on lines that a camera should see from a pose, and where to look to learn more.

use super::{DEPENDENT, Estimate, FARTHEST, FEWEST, Map, across, point_sd};
use crate::camera::Camera;
use crate::field::Line;
use crate::picture::reduction;
use crate::{SCAN_EVERY, ball, lines};
use nalgebra::{Matrix3, Vector3};
use runs::frames::{Pose, wrap_angle};
use std::f64::consts::TAU;

/// Distance of the places of a line that are looked at, m: small against what a scan's step is worth from afar.
const SAMPLE: f64 = 0.04;
/// Thinnest line that a scan is sure to find, pixels of the working picture: with it, as many points are seen as are
/// expected over the whole field (`vision/tests/outlook.rs`); with half of it a third of them is missing.
const THINNEST: f64 = 0.3;
/// Headings that are weighed up.
const HEADINGS: usize = 24;
/// Points that must be expected for one that is needed: lines are worn, and the pose is not where it is believed to be.
const SPARE: f64 = 1.5;
/// What the standard deviation of the place must at least become, as a share, for a look that still leaves it too large.
const WORTH: f64 = 0.7;
/// Longest way to a better look, m: the wheels of a robot that is not calibrated lose 10 mm on the way back.
const WAY: f64 = 0.8;
/// Distances and directions of the places that are weighed up.
const RINGS: usize = 4;
const DIRECTIONS: usize = 8;

/// What a look is expected to tell.
#[derive(Clone, Copy, Debug)]
pub struct Outlook {
    /// Points on lines.
    pub points: f64,
    /// Of x, y and heading.
    pub information: Matrix3<f64>,
}

impl Map {
    /// What a camera should see of the lines from a pose of the body, nothing in between.
    #[must_use]
    pub fn outlook(&self, camera: &Camera, pose: Pose) -> Outlook {
        let mut sum = Outlook { points: 0.0, information: Matrix3::zeros() };
        for line in self.lines() {
            let places = places(line);
            for pair in places.windows(2) {
                self.add(&mut sum, camera, pose, line, [pair[0], pair[1]]);
            }
        }
        sum
    }

    /// A short piece of a line: as many points as scans cross it.
    fn add(&self, sum: &mut Outlook, camera: &Camera, pose: Pose, line: &Line, [a, b]: [[f64; 2]; 2]) {
        let middle = [0, 1].map(|i| 0.5 * (a[i] + b[i]));
        let off = [middle[0] - pose.x, middle[1] - pose.y];
        if off[0].hypot(off[1]) > FARTHEST {
            return;
        }
        // The camera looks along the body's y axis.
        let project = |at: [f64; 2]| {
            let [right, forward] = pose.rotate_to_body([at[0] - pose.x, at[1] - pose.y]);
            camera.project(Vector3::new(forward, -right, 0.0)).filter(|_| forward > 0.0)
        };
        let normal = across(line, middle);
        let half = 0.5 * self.line_width();
        let side = |way: f64| project([middle[0] + way * half * normal[0], middle[1] + way * half * normal[1]]);
        let (Some(from), Some(to), Some(left), Some(right)) = (project(a), project(b), side(1.0), side(-1.0)) else {
            return;
        };
        let by = reduction(camera.width, camera.height, ball::WORKING_WIDTH) as f64;
        let (along, wide) = ([to[0] - from[0], to[1] - from[1]], [left[0] - right[0], left[1] - right[1]]);
        let length = along[0].hypot(along[1]).max(1e-9);
        let width = (along[0] * wide[1] - along[1] * wide[0]).abs() / length / by;
        let pixel = [0.5 * (from[0] + to[0]), 0.5 * (from[1] + to[1])];
        let fringe = lines::FRINGE as f64 * by;
        let inside = |c: f64, size: usize| (fringe..size as f64 - fringe).contains(&c);
        if width < THINNEST || !inside(pixel[0], camera.width) || !inside(pixel[1], camera.height) {
            return;
        }
        let widest = f64::from(lines::WIDEST) * camera.width as f64 / by;
        // A scan down a column meets the line's thickness in that direction, one across a row that in the other.
        let scans = |step: f64| if width * length <= widest * step { step / (SCAN_EVERY as f64 * by) } else { 0.0 };
        let points = scans(along[0].abs()) + scans(along[1].abs());
        let Some(sd) = point_sd(camera, pixel) else { return };
        let row = Vector3::new(normal[0], normal[1], normal[1] * off[0] - normal[0] * off[1]);
        sum.points += points;
        sum.information += points / (sd * sd) / DEPENDENT * row * row.transpose();
    }

    /// Where to stand for a look that should leave the place known to a standard deviation of `needed` (m) in every
    /// direction: here with the least turn, or else the least way off within the field; or the pose at which it becomes
    /// known best, if that is worth it. `None` where nothing is.
    #[must_use]
    pub fn vantage(&self, camera: &Camera, believed: &Estimate, needed: f64) -> Option<Pose> {
        let prior = believed.covariance.try_inverse()?;
        let mut turns: Vec<f64> = (0..HEADINGS).map(|k| wrap_angle(TAU * k as f64 / HEADINGS as f64)).collect();
        turns.sort_by(|a, b| a.abs().total_cmp(&b.abs()));
        let mut best = None;
        let places = around([believed.pose.x, believed.pose.y]).filter(|place| self.is_inside(*place));
        for (n, [x, y]) in places.enumerate() {
            // Here and as it stands, it has looked.
            for turn in &turns[usize::from(n == 0)..] {
                let pose = Pose::new(x, y, wrap_angle(believed.pose.theta + turn));
                let outlook = self.outlook(camera, pose);
                if outlook.points < SPARE * FEWEST as f64 {
                    continue;
                }
                let Some(covariance) = (prior + outlook.information).try_inverse() else { continue };
                let sd = Estimate { covariance, ..*believed }.place_sd();
                if sd <= needed {
                    return Some(pose);
                }
                if best.is_none_or(|(least, _)| sd < least) {
                    best = Some((sd, pose));
                }
            }
        }
        best.filter(|(sd, _)| *sd < WORTH * believed.place_sd()).map(|(_, pose)| pose)
    }
}

/// A place, and those around it, the nearest first.
fn around([x, y]: [f64; 2]) -> impl Iterator<Item = [f64; 2]> {
    let ring = move |ring: usize| {
        let way = WAY * ring as f64 / RINGS as f64;
        (0..DIRECTIONS).map(move |k| {
            let (s, c) = (TAU * k as f64 / DIRECTIONS as f64).sin_cos();
            [x + way * c, y + way * s]
        })
    };
    std::iter::once([x, y]).chain((1..=RINGS).flat_map(ring))
}

/// Places on a line, from one end to the other.
fn places(line: &Line) -> Vec<[f64; 2]> {
    let steps = |length: f64| (length / SAMPLE).ceil().max(1.0) as usize;
    match *line {
        Line::Straight(a, b) => {
            let n = steps((b[0] - a[0]).hypot(b[1] - a[1]));
            (0..=n).map(|k| [0, 1].map(|i| a[i] + (b[i] - a[i]) * k as f64 / n as f64)).collect()
        }
        Line::Circle(radius) => {
            let n = steps(TAU * radius);
            let angle = |k: usize| TAU * k as f64 / n as f64;
            (0..=n).map(|k| [radius * angle(k).cos(), radius * angle(k).sin()]).collect()
        }
    }
}
