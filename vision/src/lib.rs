//! What a robot's own camera sees: the ball, the carpet and its boundary, field lines and goals in forward-looking
//! pictures.
//!
//! ```text
//!  file, camera ─► Picture ─► carpet ─┬─► ball ───────────────┐
//!                                     └─► boundary, lines, goals ─► Scene
//! ```
//!
//! [`picture::Picture`] is what everything starts from; [`picture::read`] makes one of a PNG or JPEG file, and [`detect`]
//! finds what is in it. [`render`] draws pictures with known truth, by a model of light that the detector knows nothing of.
//!
//! Pixels: x to the right, y down, (0, 0) the upper left corner of the upper left pixel, whose centre is (0.5, 0.5).
//!
//! ```
//! let sample = vision::render::sample(3, 224, 224);
//! let scene = vision::detect(&sample.rendered.picture, vision::ball::DEFAULT_SCORE);
//! assert!(!scene.boundary.is_empty());
//!
//! // Where a point on the floor, a metre ahead, is in a picture, and back. Vectors are those of [`nalgebra`], which stands
//! // here in the version that they are of.
//! let camera = sample.camera;
//! let pixel = camera.project(vision::nalgebra::Vector3::new(1.0, 0.0, 0.0)).expect("it is ahead");
//! let [x, y] = camera.onto(pixel, 0.0).expect("it is on the floor");
//! assert!((x - 1.0).hypot(y) < 1e-3);
//! ```

pub mod ball;
pub mod camera;
mod carpet;
pub mod field;
mod goal;
mod lines;
pub mod localise;
pub mod onboard;
pub mod picture;
pub mod render;

pub use lines::LinePoint;
pub use nalgebra;

use ball::{Ball, Region};
use carpet::Carpet;
use picture::Picture;

/// Columns and rows between two scans for lines, of the working picture.
const SCAN_EVERY: usize = 4;
/// Columns between two points of the boundary, of the working picture.
const BOUNDARY_EVERY: usize = 8;

/// What is in a picture, pixels.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scene {
    /// The likeliest ball first.
    pub balls: Vec<Ball>,
    /// The far edge of the carpet from left to right; empty where there is no carpet.
    pub boundary: Vec<[f64; 2]>,
    /// Where scans down and across cross the middle of a painted line.
    pub lines: Vec<LinePoint>,
    /// Boxes around the white walls that stand on the boundary.
    pub goals: Vec<Region>,
}

/// Finds what is in a picture; balls with at least a score, from 0 to 1.
#[must_use]
pub fn detect(picture: &Picture, least: f64) -> Scene {
    let (working, by) = picture.reduced(ball::WORKING_WIDTH);
    let carpet = Carpet::find(&working);
    let balls = ball::find_on(&working, carpet.as_ref(), by, least);
    let Some(carpet) = carpet else { return Scene { balls, ..Scene::default() } };
    let boundary = (BOUNDARY_EVERY / 2..working.width)
        .step_by(BOUNDARY_EVERY)
        .map(|x| [(x as f64 + 0.5) * by as f64, f64::from(carpet.boundary[x]) * by as f64])
        .filter(|point| point[1] < (working.height * by) as f64)
        .collect();
    Scene {
        balls,
        boundary,
        lines: lines::points(&working, &carpet, by, SCAN_EVERY),
        goals: goal::goals(&working, &carpet, by),
    }
}
