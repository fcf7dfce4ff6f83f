//! A pose that somebody measured, and what it is worth.

use crate::odometry::Estimate;
use nalgebra::{Matrix3, Vector3};
use runs::frames::{Pose, wrap_angle};

/// A pose as a camera delivers it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measurement {
    /// Where the robot was.
    pub pose: Pose,
    /// Covariance of its error, world axes (m², rad²); without it, the noise that the filter is told of its camera.
    pub covariance: Option<Matrix3<f64>>,
    /// When, s of the filter's time; without it, the latency that the filter is told of its camera before delivery.
    pub taken: Option<f64>,
    /// The prediction that is part of pose and covariance already: the filter takes it out, so that it counts once. Who
    /// matched a picture to a prediction has also judged whether the two go together.
    pub prediction: Option<Estimate>,
    /// Whether what the filter believes was found to be wrong, and this takes its place.
    pub replaces: bool,
}

/// Share of a prediction's information that stays in what is left without it: a picture of one line tells nothing along
/// it, and the difference of two rounded matrices may be less than nothing. So little counts twice that a million
/// pictures weigh as much as one prediction.
const STAYS: f64 = 1e-6;

impl From<Pose> for Measurement {
    fn from(pose: Pose) -> Self {
        Self { pose, covariance: None, taken: None, prediction: None, replaces: false }
    }
}

impl Measurement {
    /// What was measured at `taken`, as the posterior of a prediction and a picture.
    #[must_use]
    pub fn posterior(found: Estimate, prediction: Estimate, taken: f64) -> Self {
        let covariance = Some(found.covariance);
        Self { covariance, taken: Some(taken), prediction: Some(prediction), ..found.pose.into() }
    }

    /// What was found at `taken` without a prediction, of a robot that is not where it believes to be.
    #[must_use]
    pub fn instead(found: Estimate, taken: f64) -> Self {
        Self { covariance: Some(found.covariance), taken: Some(taken), replaces: true, ..found.pose.into() }
    }

    /// Pose and covariance without the prediction: by the product of normal densities, inverse covariances add up, and so
    /// do the poses that they weigh. Where the picture tells nothing the deviation is a thousand times the prediction's.
    /// `noise` are the standard deviations where the measurement has no covariance (m, m, rad). `None` where numbers are
    /// not finite, or say less than the prediction.
    #[must_use]
    pub fn alone(&self, noise: [f64; 3]) -> Option<Estimate> {
        let Pose { x, y, theta } = self.pose;
        let finite = [x, y, theta].iter().all(|v| v.is_finite());
        let given = self.covariance.unwrap_or_else(|| Matrix3::from_diagonal(&Vector3::from(noise.map(|s| s * s))));
        if !finite || given.iter().any(|v| !v.is_finite()) {
            return None;
        }
        // What cannot be inverted is no prediction: the match did not use it either.
        let prior = self.prediction.and_then(|p| Some((p.pose, p.covariance.try_inverse()?)));
        let Some((from, weight)) = prior else { return Some(Estimate { pose: self.pose, covariance: given }) };
        let weight = (1.0 - STAYS) * weight;
        let covariance = (given.try_inverse()? - weight).cholesky()?.inverse();
        let moved = Vector3::new(x - from.x, y - from.y, wrap_angle(theta - from.theta));
        let off = covariance * (weight * moved);
        Some(Estimate { pose: Pose::new(x + off.x, y + off.y, theta + off.z), covariance })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_prediction_is_taken_out_of_its_match() {
        let picture = Estimate {
            pose: Pose::new(1.03, 1.98, 0.52),
            covariance: Matrix3::new(4e-4, 1e-4, 0.0, 1e-4, 100.0, 1e-3, 0.0, 1e-3, 1e-4),
        };
        let prediction = Estimate::new(Pose::new(1.0, 2.0, 0.5), [0.05, 0.04, 0.03]);
        let [a, b] = [picture, prediction].map(|e| e.covariance.try_inverse().unwrap());
        let covariance = (a + b).try_inverse().unwrap();
        let vector = |p: Pose| Vector3::new(p.x, p.y, p.theta);
        let at = covariance * (a * vector(picture.pose) + b * vector(prediction.pose));
        let found = Estimate { pose: Pose::new(at.x, at.y, at.z), covariance };
        let alone = Measurement::posterior(found, prediction, 0.0).alone([1.0; 3]).unwrap();
        // What is left of the prediction is the share that stays of it, and no more.
        let kept = 1.1 * STAYS * b.norm();
        let information = alone.covariance.try_inverse().unwrap();
        assert!((information - a).norm() < kept, "{alone:?}");
        let off = vector(alone.pose) - vector(picture.pose);
        assert!((a * off).norm() < kept * 0.1, "{alone:?}");
    }

    /// One line across the way: the match leaves the place along it, and the heading's covariance, as predicted.
    #[test]
    fn a_picture_of_one_line_tells_what_it_shows() {
        for (k, sd) in [[0.05, 0.04, 0.03], [0.3, 0.001, 0.2], [0.0123, 0.0456, 0.0789]].into_iter().enumerate() {
            let turn = nalgebra::Rotation3::from_axis_angle(&Vector3::z_axis(), 0.3 * (k + 1) as f64);
            let turned = |c: Matrix3<f64>| turn.matrix() * c * turn.matrix().transpose();
            let plain = Estimate::new(Pose::new(1.0, 2.0, 0.5), sd);
            let prediction = Estimate { covariance: turned(plain.covariance), ..plain };
            let across = turn.matrix() * Vector3::x();
            // The line is seen to a centimetre, 5 mm from where it was predicted.
            let told = across * across.transpose() * 1e4;
            let covariance = (prediction.covariance.try_inverse().unwrap() + told).try_inverse().unwrap();
            let by = covariance * (told * (0.005 * across));
            let pose = Pose::new(1.0 + by.x, 2.0 + by.y, 0.5 + by.z);
            let alone = Measurement::posterior(Estimate { pose, covariance }, prediction, 0.0).alone([1.0; 3]).unwrap();
            let off = Vector3::new(alone.pose.x - 1.0, alone.pose.y - 2.0, 0.0).dot(&across);
            assert!((off - 0.005).abs() < 1e-4, "{k}: {off}");
            let variance = (across.transpose() * alone.covariance * across)[0];
            assert!((variance.sqrt() - 0.01).abs() < 1e-3, "{k}: {variance}");
            let along = turn.matrix() * Vector3::y();
            assert!((along.transpose() * alone.covariance * along)[0].sqrt() > 100.0 * sd[1], "{k}: {alone:?}");
        }
    }

    #[test]
    fn what_is_no_measurement_is_none() {
        let start = Estimate::new(Pose::default(), [0.1; 3]);
        let nothing = |found: Estimate| Measurement::posterior(found, start, 0.0).alone([1.0; 3]).is_none();
        assert!(nothing(Estimate::new(Pose::default(), [0.2; 3])));
        assert!(nothing(Estimate::new(Pose::new(f64::NAN, 0.0, 0.0), [0.01; 3])));
        assert!(nothing(Estimate::new(Pose::default(), [f64::NAN; 3])));
        let plain = Measurement::from(Pose::new(1.0, 2.0, 3.0)).alone([0.1, 0.2, 0.3]).unwrap();
        assert_eq!(plain, Estimate::new(Pose::new(1.0, 2.0, 3.0), [0.1, 0.2, 0.3]));
    }
}
