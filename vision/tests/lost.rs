//! A robot that is not where it believes to be turns round, and finds its place.

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use runs::frames::{Pose, wrap_angle};
use std::f64::consts::{FRAC_PI_2, TAU};
use vision::camera::Camera;
use vision::field::Field;
use vision::localise::Estimate;
use vision::onboard::OnBoard;
use vision::render::{Sensor, Shutter, World, render};

/// Between two frames, rad.
const STEP: f64 = 0.15;

fn camera() -> Camera {
    Camera { distortion: [-0.08, 0.0], ..Camera::ideal(320, 240, 1.25, 0.15, 0.33) }
}

/// Turns on the spot at `truth`, among robots, and is believed to do so elsewhere: where it was when its place was found, the place, and
/// how far it had turned.
fn looks_round(
    truth: Pose,
    believed: Pose,
    onboard: &mut OnBoard,
    robots: &[[f64; 2]],
) -> Option<(Pose, Estimate, f64)> {
    let mut rng = ChaCha8Rng::seed_from_u64(3);
    let world = World::plain(Field::DIVISION_B, 3).with_robots(robots);
    let frames = (1.25 * TAU / STEP) as u32;
    (0..frames).find_map(|k| {
        let turned = f64::from(k) * STEP;
        let at = |p: Pose| Pose { theta: wrap_angle(p.theta + turned), ..p };
        let looking = truth.theta + turned + FRAC_PI_2;
        let shutter = Shutter { pose: [truth.x, truth.y, looking], turn: 0.01, ..Shutter::default() };
        let picture = render(&world, &camera(), shutter, &Sensor::GOOD, 1, &mut rng).picture;
        let glance = onboard.glance(&picture, &Estimate::new(at(believed), [0.03, 0.03, 0.02])).unwrap();
        glance.instead.map(|found| (at(truth), found, turned))
    })
}

#[test]
fn a_robot_that_was_carried_away_finds_its_place_among_others_by_one_turn() {
    let others: Vec<[f64; 2]> =
        (0..11).map(f64::from).map(|k| [4.2 * (2.4 * k).cos(), 2.7 * (1.7 * k).sin()]).collect();
    for (truth, believed) in [
        ([-3.44, -1.32, 2.5], [-2.4, -1.2, 2.9]),
        ([3.68, -2.10, 0.7], [1.1, 1.7, 0.3]),
        ([-0.33, -1.95, -0.4], [0.9, 2.1, 0.0]),
        ([4.16, 0.22, 0.0], [0.5, 0.3, -0.5]),
    ] {
        let [truth, believed] = [truth, believed].map(|[x, y, theta]| Pose::new(x, y, theta));
        let mut onboard = OnBoard::new(camera(), Field::DIVISION_B);
        let (at, found, turned) = looks_round(truth, believed, &mut onboard, &others).expect("it is found");
        let off = (at.x - found.pose.x).hypot(at.y - found.pose.y);
        let turn = wrap_angle(at.theta - found.pose.theta).abs();
        assert!(off < 0.03 && turn < 0.01, "{truth:?}: {off:.3} m, {turn:.3} rad after {turned:.1}");
        assert!(!onboard.refuted(), "it is where it believes now");
    }
}

/// Where the centre circle and its lines are all there is to see, a quarter of a turn looks the same.
#[test]
fn what_looks_alike_is_left_open() {
    let mut onboard = OnBoard::new(camera(), Field::DIVISION_B);
    let found = looks_round(Pose::new(0.0, 0.3, 0.9), Pose::new(3.1, 1.8, 1.3), &mut onboard, &[]);
    assert!(found.is_none() && onboard.refuted(), "{found:?}");
}

#[test]
fn a_robot_that_is_where_it_believes_to_be_is_not_refuted() {
    for place in [[-3.44, -1.32, 2.5], [0.98, -0.16, 1.9], [1.0, 2.23, -0.5]] {
        let truth = Pose::new(place[0], place[1], place[2]);
        let mut onboard = OnBoard::new(camera(), Field::DIVISION_B);
        let believed = Pose { x: truth.x + 0.03, y: truth.y - 0.02, ..truth };
        assert!(looks_round(truth, believed, &mut onboard, &[]).is_none() && !onboard.refuted(), "{place:?}");
    }
}
