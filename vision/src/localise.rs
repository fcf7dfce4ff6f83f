//! Where the robot stands: points on lines against the field's map, after Lauer, Lange and Riedmiller, "Calculating the
//! perfect match: an efficient and accurate approach for robot self-localization", RoboCup 2005 (LNAI 4020, 2006).
//!
//! Every point votes by its distance to the nearest line, with an error that levels off, so that what is no line does not
//! pull. Each distance counts by what a pixel there is worth on the floor, and the prediction counts by its covariance:
//! the result is the pose of most likelihood and its covariance. A match that most points contradict is none.

mod map;
mod outlook;

pub use map::Map;
pub use outlook::Outlook;

use crate::LinePoint;
use crate::camera::Camera;
use crate::field::Line;
use nalgebra::{Matrix3, Vector3};
use runs::frames::{Pose, place_sd, wrap_angle};
use std::f64::consts::FRAC_PI_2;

/// Farthest point used, m: at 3 m from a camera 0.15 m high one pixel of 640 is worth 0.15 m.
const FARTHEST: f64 = 3.0;
/// Fewest points that make a match; three unknowns, and lines come in runs of points.
const FEWEST: usize = 12;
/// Standard deviation of a point in the picture, pixels: assumed for the middle of a blurred line.
const PIXEL_SD: f64 = 0.8;
/// Standard deviation that no point is better than, m: camera calibration, bumps of the floor.
const FLOOR_SD: f64 = 0.008;
/// Standard deviations at which a point's error has levelled off half-way.
const LEVEL: f64 = 3.0;
/// Share of points that must agree within [`LEVEL`].
const AGREEING: f64 = 0.55;
/// Points of one line are not independent: all of them shift with tilt and height. Their information is divided by this.
const DEPENDENT: f64 = 8.0;
/// Steps of Gauss and Newton.
const STEPS: usize = 12;

/// A pose with covariance (m, m, rad; world frame).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// The pose of the body: heading of its x axis; the camera looks along y.
    pub pose: Pose,
    /// Of x, y and heading.
    pub covariance: Matrix3<f64>,
    /// Share of the points used that agree with the map.
    pub agreeing: f64,
}

impl Estimate {
    /// A pose with independent standard deviations (m, m, rad).
    #[must_use]
    pub fn new(pose: Pose, sd: [f64; 3]) -> Self {
        Self { pose, covariance: Matrix3::from_diagonal(&Vector3::from(sd.map(|sd| sd * sd))), agreeing: 1.0 }
    }

    /// Of the place in the axis where it is larger (m), and of the heading (rad).
    #[must_use]
    pub fn standard_deviations(&self) -> [f64; 2] {
        let variance = |i: usize| self.covariance[(i, i)];
        [variance(0).max(variance(1)).sqrt(), variance(2).sqrt()]
    }

    /// Of the place in the direction where it is largest, m.
    #[must_use]
    pub fn place_sd(&self) -> f64 {
        place_sd(&self.covariance)
    }
}

/// Why there is no match.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum NoMatch {
    /// Too little to go by.
    #[error("{0} points on lines within {FARTHEST} m; a match needs {FEWEST}")]
    TooFewPoints(usize),
    /// Most of what is seen is not on the map.
    #[error("{:.0} % of the points on lines are on the map; {:.0} % must be", 100.0 * .0, 100.0 * AGREEING)]
    Contradiction(f64),
}

/// A point on the floor, robot's frame (x right, y forward), and its standard deviation, m.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FloorPoint {
    at: [f64; 2],
    sd: f64,
}

impl FloorPoint {
    /// The same point from another place: `before` is where it was seen from, as seen from there.
    pub(crate) fn seen_from(self, before: Pose) -> Self {
        let [x, y] = before.rotate_to_world(self.at);
        Self { at: [before.x + x, before.y + y], ..self }
    }
}

/// The points of a picture on the floor.
pub(crate) fn on_floor(camera: &Camera, points: &[LinePoint]) -> Vec<FloorPoint> {
    let place = |point: &LinePoint| {
        let [forward, left] = camera.onto([point.x, point.y], 0.0)?;
        let far = forward.hypot(left);
        if far > FARTHEST {
            return None;
        }
        Some(FloorPoint { at: [-left, forward], sd: point_sd(camera, [point.x, point.y])? })
    };
    points.iter().filter_map(place).collect()
}

/// Standard deviation on the floor of a point at a pixel, m: by what one pixel further down moves it.
fn point_sd(camera: &Camera, [x, y]: [f64; 2]) -> Option<f64> {
    let ([forward, left], [f, l]) = (camera.onto([x, y], 0.0)?, camera.onto([x, y + 1.0], 0.0)?);
    Some(FLOOR_SD.hypot(PIXEL_SD * (f - forward).hypot(l - left)))
}

/// Matches points to the map around a prediction.
///
/// # Errors
/// [`NoMatch`] where the points do not tell, or tell of another place.
pub fn track(map: &Map, camera: &Camera, points: &[LinePoint], predicted: &Estimate) -> Result<Estimate, NoMatch> {
    let floor = on_floor(camera, points);
    if floor.len() < FEWEST {
        return Err(NoMatch::TooFewPoints(floor.len()));
    }
    let prior = predicted.covariance.try_inverse().unwrap_or_else(Matrix3::zeros);
    settle(map, &floor, predicted.pose, &prior)
}

/// Poses at which points on the floor fit the map, without a prediction, best match first. A field looks the same from both
/// ends, so that two poses are the rule.
pub(crate) fn places(map: &Map, floor: &[FloorPoint]) -> Vec<Estimate> {
    /// Places that are settled at, and how far apart they begin (m, rad): whatever fits best is one of them, and its
    /// neighbours are not all of them.
    const STARTS: usize = 150;
    const APART: [f64; 2] = [0.4, 0.3];
    if floor.len() < FEWEST {
        return Vec::new();
    }
    let few: Vec<FloorPoint> = floor.iter().step_by((floor.len() / 60).max(1)).copied().collect();
    let mut starts: Vec<(f64, Pose)> = map.grid().map(|pose| (map.cost(&few, pose), pose)).collect();
    starts.sort_by(|a, b| a.0.total_cmp(&b.0));
    let apart = |a: Pose, b: Pose, least: [f64; 2]| {
        (a.x - b.x).hypot(a.y - b.y) > least[0] || wrap_angle(a.theta - b.theta).abs() > least[1]
    };
    let mut tried: Vec<Pose> = Vec::new();
    let mut found: Vec<(f64, Estimate)> = Vec::new();
    for (_, start) in starts {
        if !tried.iter().all(|other| apart(*other, start, APART)) {
            continue;
        }
        tried.push(start);
        if let Ok(estimate) = settle(map, floor, start, &Matrix3::zeros())
            && found.iter().all(|(_, other)| apart(other.pose, estimate.pose, [0.15; 2]))
        {
            found.push((misfit(map, floor, estimate.pose), estimate));
        }
        if tried.len() == STARTS {
            break;
        }
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    found.into_iter().map(|(_, estimate)| estimate).collect()
}

/// Negative logarithm of the likelihood of points at a pose, but for a constant: what [`settle`] makes least.
pub(crate) fn misfit(map: &Map, floor: &[FloorPoint], pose: Pose) -> f64 {
    let of = |point: &FloorPoint| {
        let squared = (map.residual(point, pose).0 / point.sd).powi(2);
        0.5 * squared / (1.0 + squared / (LEVEL * LEVEL)) / DEPENDENT
    };
    floor.iter().map(of).sum()
}

/// Gauss and Newton with weights that fall with the error (iteratively reweighted least squares).
fn settle(map: &Map, floor: &[FloorPoint], start: Pose, prior: &Matrix3<f64>) -> Result<Estimate, NoMatch> {
    let mut pose = start;
    let mut information = Matrix3::zeros();
    for step in 0..STEPS {
        // Wide at first, so that a prediction that is off is pulled in.
        let level = LEVEL * (1.0 + 4.0 * (1.0 - step as f64 / (STEPS as f64 - 3.0)).max(0.0));
        let (mut hessian, mut slope) = (*prior, Vector3::zeros());
        let off = Vector3::new(pose.x - start.x, pose.y - start.y, wrap_angle(pose.theta - start.theta));
        slope += prior * off;
        information = Matrix3::zeros();
        for point in floor {
            let (error, normal, turned) = map.residual(point, pose);
            let scaled = error / point.sd / level;
            let weight = 1.0 / (1.0 + scaled * scaled).powi(2) / (point.sd * point.sd) / DEPENDENT;
            // A point moves along the normal with x, y and the heading.
            let row = Vector3::new(normal[0], normal[1], normal[0] * turned[0] + normal[1] * turned[1]);
            information += weight * row * row.transpose();
            slope += weight * error * row;
        }
        hessian += information + Matrix3::identity() * 1e-6;
        let Some(inverse) = hessian.try_inverse() else { break };
        let change = -inverse * slope;
        pose = Pose::new(pose.x + change.x, pose.y + change.y, wrap_angle(pose.theta + change.z));
    }
    let agree = |point: &&FloorPoint| map.residual(point, pose).0.abs() < LEVEL * point.sd;
    let agreeing = floor.iter().filter(agree).count() as f64 / floor.len() as f64;
    if agreeing < AGREEING {
        return Err(NoMatch::Contradiction(agreeing));
    }
    // What neither points nor prediction tell stays unknown: ten metres and half a turn.
    let least = Matrix3::from_diagonal(&Vector3::new(0.01, 0.01, 0.1));
    let covariance = (information + prior + least).try_inverse().unwrap_or_else(Matrix3::identity);
    Ok(Estimate { pose, covariance, agreeing })
}

impl Map {
    /// A point's distance to the nearest line, the direction away from it, and how the point moves with the heading.
    fn residual(&self, point: &FloorPoint, pose: Pose) -> (f64, [f64; 2], [f64; 2]) {
        let [dx, dy] = pose.rotate_to_world(point.at);
        let at = [pose.x + dx, pose.y + dy];
        let (line, near) = self.nearest(at);
        let away = [at[0] - near[0], at[1] - near[1]];
        let error = away[0].hypot(away[1]);
        let normal = if error > 1e-9 { away.map(|c| c / error) } else { across(line, near) };
        (error, normal, [-dy, dx])
    }
}

/// The direction across a line.
fn across(line: &Line, at: [f64; 2]) -> [f64; 2] {
    let d = match *line {
        Line::Straight(a, b) => [a[1] - b[1], b[0] - a[0]],
        Line::Circle(_) => at,
    };
    let length = d[0].hypot(d[1]).max(1e-12);
    d.map(|c| c / length)
}

/// The pose of the body whose camera stands at x, y and looks along a heading.
#[must_use]
pub fn body(camera_pose: [f64; 3]) -> Pose {
    Pose::new(camera_pose[0], camera_pose[1], wrap_angle(camera_pose[2] - FRAC_PI_2))
}
