//! The ball: an orange sphere on a green carpet.
//!
//! Three steps. **Candidates** are connected regions above a threshold of redness, for all thresholds at once (a
//! component tree), so that no colour has to be known beforehand: white balance, exposure and shadow move a ball's colour
//! as far as they like as long as it stays redder than what is around it. Each candidate's outline is **refined** to
//! parts of a pixel where redness is half-way between inside and outside. Then **features** of colour, outline, shading
//! and surroundings are weighed into the odds that it is a ball.

mod calm;
mod directions;
pub mod features;
pub mod net;
mod outline;
mod redness;
mod regions;
mod weights;

use crate::camera::Camera;
use crate::carpet::Carpet;
use crate::picture::{Picture, Raster};
use features::Features;
use outline::Outline;

/// Working width, pixels; a wider picture is reduced to this or up to twice as much.
pub(crate) const WORKING_WIDTH: usize = 224;
/// Candidates that are looked at closely: bounds the time a cluttered picture takes.
const CANDIDATES: usize = 40;
/// Overlap, as intersection over union, at which two outlines are of the same thing.
const SAME: f64 = 0.3;

/// Score from which on a candidate is reported: recall and precision, for balls of more than 8 pixels of 224, are about equal
/// there on rendered pictures of seeds from 30 000 on; docs/measured/ball-detection.md has others.
pub const DEFAULT_SCORE: f64 = 0.3;

/// Radius of a golf ball, m (rules of golf: at least 42.67 mm across).
pub const RADIUS: f64 = 0.021_35;

/// A place in a picture, pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Region {
    /// Middle, from the left.
    pub x: f64,
    /// Middle, from the top.
    pub y: f64,
    /// From the left edge to the right one.
    pub width: f64,
    /// From the upper edge to the lower one.
    pub height: f64,
}

impl Region {
    /// Area of the intersection over area of the union.
    #[must_use]
    pub fn overlap(&self, other: &Self) -> f64 {
        let shared = |a: f64, wa: f64, b: f64, wb: f64| {
            ((a + wa / 2.0).min(b + wb / 2.0) - (a - wa / 2.0).max(b - wb / 2.0)).max(0.0)
        };
        let both =
            shared(self.x, self.width, other.x, other.width) * shared(self.y, self.height, other.y, other.height);
        both / (self.width * self.height + other.width * other.height - both)
    }
}

/// A ball in a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ball {
    /// Box around it.
    pub region: Region,
    /// Odds that it is one, as a probability from 0 to 1.
    pub score: f64,
}

impl Ball {
    /// Where it lies on the floor in the camera's robot frame: forward and to the left, m; `None` above the horizon.
    #[must_use]
    pub fn place(&self, camera: &Camera, radius: f64) -> Option<[f64; 2]> {
        camera.onto([self.region.x, self.region.y], radius)
    }

    /// Whether a ball of this radius (m) on the floor would look as large from a camera; true of half to twice the size, as
    /// a ball that is partly hidden or blurred has.
    #[must_use]
    pub fn fits(&self, camera: &Camera, radius: f64) -> bool {
        let Some([forward, left]) = self.place(camera, radius) else { return false };
        let range = forward.hypot(left).hypot(camera.mount_height - radius);
        let expected = [2.0 * radius * camera.focal[0] / range, 2.0 * radius * camera.focal[1] / range];
        let near = |seen: f64, expected: f64| (0.5..2.0).contains(&(seen / expected));
        near(self.region.width.max(self.region.height * camera.focal[0] / camera.focal[1]), expected[0])
            && near(self.region.height.max(self.region.width * camera.focal[1] / camera.focal[0]), expected[1])
    }
}

/// A candidate with what is known of it.
#[derive(Clone, Copy, Debug)]
pub struct Candidate {
    /// Box around it.
    pub region: Region,
    /// What speaks for and against a ball.
    pub features: Features,
}

/// The balls of a picture whose score is at least `least`, best first.
#[must_use]
pub fn find(picture: &Picture, least: f64) -> Vec<Ball> {
    let (working, by) = picture.reduced(WORKING_WIDTH);
    let carpet = Carpet::find(&working);
    find_on(&working, carpet.as_ref(), by, least)
}

/// All candidates of a picture: what the weights are trained on.
#[must_use]
pub fn candidates(picture: &Picture) -> Vec<Candidate> {
    let (working, by) = picture.reduced(WORKING_WIDTH);
    let carpet = Carpet::find(&working);
    outlined(&working, carpet.as_ref())
        .into_iter()
        .map(|(outline, features)| Candidate { region: outline.region(&working, by), features })
        .collect()
}

pub(crate) fn find_on(working: &Raster<[f32; 3]>, carpet: Option<&Carpet>, by: usize, least: f64) -> Vec<Ball> {
    let mut balls: Vec<Ball> = outlined(working, carpet)
        .into_iter()
        .map(|(outline, features)| Ball { region: outline.region(working, by), score: features.score() })
        .filter(|ball| ball.score >= least)
        .collect();
    balls.sort_by(|a, b| b.score.total_cmp(&a.score));
    let mut kept: Vec<Ball> = Vec::new();
    for ball in balls {
        if kept.iter().all(|other| other.region.overlap(&ball.region) < SAME) {
            kept.push(ball);
        }
    }
    kept
}

fn outlined(working: &Raster<[f32; 3]>, carpet: Option<&Carpet>) -> Vec<(Outline, Features)> {
    let calm = calm::calmed(working);
    let working = calm.as_ref().unwrap_or(working);
    let redness = redness::redness(working);
    let ground = carpet.map_or(0.0, |carpet| redness::of(carpet.colour));
    let mut found: Vec<(Outline, Features)> = regions::regions(&redness, ground, CANDIDATES)
        .into_iter()
        .filter_map(|region| {
            let outline = Outline::refine(&redness, region)?;
            Some((outline, Features::of(working, &redness, carpet, &outline)))
        })
        .collect();
    features::rank(&mut found);
    found
}
