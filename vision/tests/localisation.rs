//! Poses from rendered pictures of a field.

use nalgebra::{Matrix3, Vector3};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use runs::frames::{Pose, wrap_angle};
use vision::camera::Camera;
use vision::detect;
use vision::field::Field;
use vision::localise::{Estimate, Map, NoMatch, body, track};
use vision::picture::Picture;
use vision::render::{Sensor, Shutter, World, render};

/// Camera poses (m, m, rad) from which at least two lines that are not parallel can be seen within reach.
const POSES: [[f64; 3]; 6] =
    [[-1.2, 0.4, 0.0], [2.4, -0.6, 0.2], [-2.8, 0.5, 3.0], [3.4, 2.2, 0.7], [0.9, -0.8, 2.6], [-3.2, -2.0, -2.4]];

fn camera() -> Camera {
    Camera { distortion: [-0.1, 0.0], ..Camera::ideal(480, 360, 1.2, 0.15, 0.35) }
}

fn picture(pose: [f64; 3], seed: u64) -> Picture {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let shutter = Shutter { pose, ..Shutter::default() };
    render(&World::plain(Field::DIVISION_B, 5), &camera(), shutter, &Sensor::GOOD, 1, &mut rng).picture
}

fn off(a: Pose, b: Pose) -> (f64, f64) {
    ((a.x - b.x).hypot(a.y - b.y), wrap_angle(a.theta - b.theta).abs())
}

#[test]
fn lines_correct_a_prediction() {
    let map = Map::new(Field::DIVISION_B);
    let prior = Matrix3::from_diagonal(&Vector3::new(0.1_f64.powi(2), 0.1_f64.powi(2), 0.08_f64.powi(2)));
    for (seed, pose) in POSES.into_iter().enumerate() {
        let truth = body(pose);
        let points = detect(&picture(pose, seed as u64), 0.5).lines;
        let start = Pose::new(truth.x + 0.08, truth.y - 0.07, truth.theta + 0.06);
        let predicted = Estimate { pose: start, covariance: prior, agreeing: 1.0 };
        let found = track(&map, &camera(), &points, &predicted).unwrap_or_else(|why| panic!("{pose:?}: {why}"));
        let (distance, turn) = off(found.pose, truth);
        eprintln!("{pose:?}: {distance:.3} m, {:.2}°, sd {:.3}", turn.to_degrees(), found.covariance[(0, 0)].sqrt());
        assert!(distance < 0.05 && turn < 0.03, "{pose:?}: {distance:.3} m, {turn:.3} rad");
        let far =
            Vector3::new(found.pose.x - truth.x, found.pose.y - truth.y, wrap_angle(found.pose.theta - truth.theta));
        let squared = (far.transpose() * found.covariance.try_inverse().unwrap() * far)[0];
        assert!(squared < 30.0, "{pose:?}: {squared:.1} normalised squared error");
    }
}

#[test]
fn a_match_that_contradicts_the_map_is_refused() {
    let points = detect(&picture(POSES[0], 0), 0.5).lines;
    let map = Map::new(Field::DIVISION_B);
    // Sure of a place where no line can be seen.
    let predicted = Estimate { pose: body([1.5, 1.8, 1.0]), covariance: Matrix3::identity() * 1e-6, agreeing: 1.0 };
    assert!(matches!(track(&map, &camera(), &points, &predicted), Err(NoMatch::Contradiction(_))));
    assert_eq!(track(&map, &camera(), &points[..3], &predicted), Err(NoMatch::TooFewPoints(3)));
}
