//! A calibrated camera on a robot: pinhole with radial distortion, at a height, tilted.
//!
//! Robot frame here: x forward, y to the left, z up, origin on the floor below the camera, m.

use crate::picture::{LARGEST_SIDE, Picture, SMALLEST_SIDE, Unusable};
use nalgebra::{Rotation3, Vector3};
use runs::error::{InputError, line_and_column};
use serde::Deserialize;
use std::path::Path;

/// What is older when it comes is worth no more than the odometry since, s.
const LONGEST_LATENCY_S: f64 = 0.4;
/// Steps that undo a distortion; each one shrinks the error by the distortion's size, a tenth or so.
const UNDISTORTION_STEPS: usize = 8;

/// Where a camera looks and how it maps directions to pixels (Brown 1966, radial terms only).
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Camera {
    /// Pixels a row.
    pub width: usize,
    /// Height of the picture, pixels.
    pub height: usize,
    /// Focal lengths in x and y, pixels; they differ where pixels are not square.
    pub focal: [f64; 2],
    /// Where the optical axis meets the picture, pixels.
    pub centre: [f64; 2],
    /// Radial distortion: a ray at tangent r appears at r (1 + k₁ r² + k₂ r⁴).
    pub distortion: [f64; 2],
    /// Of the camera above the floor, m.
    pub mount_height: f64,
    /// Of the optical axis below the horizontal, rad.
    pub tilt: f64,
    /// Of the camera about its optical axis, clockwise as seen from behind it, rad.
    pub roll: f64,
    /// From the middle of the exposure until the picture is delivered, s; 0 where a calibration does not say.
    #[serde(default)]
    pub latency_s: f64,
}

impl Camera {
    /// An ideal lens of a horizontal field of view (rad) at a height (m), tilted down (rad).
    #[must_use]
    pub fn ideal(width: usize, height: usize, view: f64, mount_height: f64, tilt: f64) -> Self {
        let focal = width as f64 / 2.0 / (view / 2.0).tan();
        Self {
            width,
            height,
            focal: [focal; 2],
            centre: [width as f64 / 2.0, height as f64 / 2.0],
            distortion: [0.0; 2],
            mount_height,
            tilt,
            roll: 0.0,
            latency_s: 0.0,
        }
    }

    /// A calibration from a TOML file with the names of the members, all of them.
    ///
    /// # Errors
    /// What is wrong, where.
    pub fn load(file: &Path) -> Result<Self, InputError> {
        let text = std::fs::read_to_string(file).map_err(|error| InputError::io(file, &error))?;
        Self::of_toml(&text, file)
    }

    fn of_toml(text: &str, file: &Path) -> Result<Self, InputError> {
        let hint = "give width, height, focal = [x, y], centre = [x, y] in pixels, distortion = [k1, k2], mount_height in \
                    metres, tilt and roll in radians; latency_s, in seconds, may be left out";
        let camera: Self = toml::from_str(text).map_err(|error| {
            let (line, column) = line_and_column(text, error.span().map_or(0, |span| span.start));
            InputError::new(file, error.message().to_owned(), hint).at(line, column)
        })?;
        let positive = |x: f64| x > 0.0 && x.is_finite();
        let upright = |x: f64| x.abs() < std::f64::consts::FRAC_PI_2;
        let wrong = [
            ("width", (SMALLEST_SIDE..=LARGEST_SIDE).contains(&camera.width)),
            ("height", (SMALLEST_SIDE..=LARGEST_SIDE).contains(&camera.height)),
            ("focal", camera.focal.into_iter().all(positive)),
            ("centre", camera.centre.into_iter().all(positive)),
            ("distortion", camera.distortion.into_iter().all(|k| k.abs() < 1.0)),
            ("mount_height", positive(camera.mount_height) && camera.mount_height < 3.0),
            ("tilt", upright(camera.tilt)),
            ("roll", upright(camera.roll)),
            ("latency_s", (0.0..=LONGEST_LATENCY_S).contains(&camera.latency_s)),
        ];
        match wrong.into_iter().find(|(_, good)| !good) {
            None => Ok(camera),
            Some((member, _)) => Err(InputError::new(file, "out of range", hint).field(member)),
        }
    }

    /// Whether a picture is of the size that this calibration is of.
    ///
    /// # Errors
    /// [`Unusable::NotCalibrated`]
    pub fn accepts(&self, picture: &Picture) -> Result<(), Unusable> {
        let (width, height) = (picture.width(), picture.height());
        if (width, height) == (self.width, self.height) {
            return Ok(());
        }
        Err(Unusable::NotCalibrated { width, height, expected_width: self.width, expected_height: self.height })
    }

    /// Camera axes (right, down, forward) as columns in the robot frame.
    fn axes(&self) -> Rotation3<f64> {
        let (s, c) = self.tilt.sin_cos();
        let forward = Vector3::new(c, 0.0, -s);
        let (right, down) = (Vector3::new(0.0, -1.0, 0.0), Vector3::new(-s, 0.0, -c));
        let (s, c) = self.roll.sin_cos();
        Rotation3::from_matrix_unchecked(nalgebra::Matrix3::from_columns(&[
            c * right + s * down,
            c * down - s * right,
            forward,
        ]))
    }

    /// Direction of a pixel's ray in the robot frame, of length one.
    #[must_use]
    pub fn ray(&self, pixel: [f64; 2]) -> Vector3<f64> {
        let seen = [0, 1].map(|i| (pixel[i] - self.centre[i]) / self.focal[i]);
        let mut at = seen;
        let steps = if self.distortion == [0.0; 2] { 0 } else { UNDISTORTION_STEPS };
        for _ in 0..steps {
            let stretch = self.stretch(at);
            at = seen.map(|s| s / stretch);
        }
        self.axes() * Vector3::new(at[0], at[1], 1.0).normalize()
    }

    /// Where a point of the robot frame appears; `None` outside the half space the lens sees.
    #[must_use]
    pub fn project(&self, point: Vector3<f64>) -> Option<[f64; 2]> {
        let seen = self.axes().inverse() * (point - Vector3::new(0.0, 0.0, self.mount_height));
        if seen.z <= 1e-6 {
            return None;
        }
        let at = [seen.x / seen.z, seen.y / seen.z];
        let stretch = self.stretch(at);
        Some([0, 1].map(|i| self.centre[i] + self.focal[i] * at[i] * stretch))
    }

    /// The point at `height` above the floor that a pixel shows; `None` where the ray never gets there.
    #[must_use]
    pub fn onto(&self, pixel: [f64; 2], height: f64) -> Option<[f64; 2]> {
        let ray = self.ray(pixel);
        let way = (height - self.mount_height) / ray.z;
        (way.is_finite() && way > 0.0).then(|| [way * ray.x, way * ray.y])
    }

    fn stretch(&self, at: [f64; 2]) -> f64 {
        let [k1, k2] = self.distortion;
        let r2 = at[0] * at[0] + at[1] * at[1];
        (1.0 + k1 * r2 + k2 * r2 * r2).max(0.2)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_on_the_floor_comes_back_from_its_pixel() {
        let camera = Camera {
            distortion: [-0.2, 0.05],
            roll: 0.03,
            focal: [400.0, 410.0],
            ..Camera::ideal(640, 480, 1.2, 0.14, 0.3)
        };
        for point in [[0.3, 0.1], [1.0, -0.4], [4.0, 1.0]] {
            let pixel = camera.project(Vector3::new(point[0], point[1], 0.0)).expect("in front");
            let back = camera.onto(pixel, 0.0).expect("below the horizon");
            assert!((back[0] - point[0]).abs() < 1e-4 * point[0] && (back[1] - point[1]).abs() < 1e-4, "{back:?}");
        }
        assert!(camera.onto([320.0, 5.0], 0.0).is_none(), "the sky is not on the floor");
    }

    #[test]
    fn left_of_the_robot_is_left_in_the_picture_and_near_is_low() {
        let camera = Camera::ideal(640, 480, 1.2, 0.14, 0.3);
        let pixel = |x, y| camera.project(Vector3::new(x, y, 0.0)).expect("in front");
        assert!(pixel(1.0, 0.2)[0] < 320.0 && pixel(0.4, 0.0)[1] > pixel(2.0, 0.0)[1]);
    }
}
