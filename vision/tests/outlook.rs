//! What a look is expected to tell, against what rendered pictures show.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use runs::frames::wrap_angle;
use std::f64::consts::PI;
use vision::camera::Camera;
use vision::detect;
use vision::field::Field;
use vision::localise::{Estimate, Map, body};
use vision::render::{Sensor, Shutter, World, render};

/// Points that `vision::localise::track` needs, and those that are expected where they are promised.
const NEEDED: usize = 12;
const PROMISED: f64 = 18.0;

fn camera() -> Camera {
    Camera { distortion: [-0.08, 0.0], ..Camera::ideal(320, 240, 1.25, 0.15, 0.33) }
}

#[test]
fn points_that_are_expected_are_seen() {
    let (map, camera) = (Map::new(Field::DIVISION_B), camera());
    let world = World::plain(Field::DIVISION_B, 5);
    let mut rng = ChaCha8Rng::seed_from_u64(8);
    let (mut seen, mut told, mut promised, mut kept) = (0, 0.0, 0, 0);
    for _ in 0..120 {
        let pose = [rng.random_range(-4.2..4.2), rng.random_range(-2.7..2.7), rng.random_range(-PI..PI)];
        let shutter = Shutter { pose, ..Shutter::default() };
        let picture = render(&world, &camera, shutter, &Sensor::GOOD, 1, &mut rng).picture;
        let near = |pixel| camera.onto(pixel, 0.0).is_some_and(|[forward, left]| forward.hypot(left) < 3.0);
        let points = detect(&picture, 0.5).lines.iter().filter(|point| near([point.x, point.y])).count();
        let outlook = map.outlook(&camera, body(pose));
        (seen, told) = (seen + points, told + outlook.points);
        if outlook.points >= PROMISED {
            (promised, kept) = (promised + 1, kept + usize::from(points >= NEEDED));
        }
    }
    eprintln!("{seen} points seen, {told:.0} expected; {kept} of {promised} promises kept");
    assert!((0.8..1.25).contains(&(told / seen as f64)), "{told:.0} of {seen}");
    assert!(promised > 60 && kept as f64 > 0.9 * f64::from(promised), "{kept} of {promised}");
}

#[test]
fn the_next_look_is_where_the_lines_tell_enough_by_the_least_way() {
    let (map, camera) = (Map::new(Field::DIVISION_B), camera());
    const ENOUGH: f64 = 0.015;
    // Camera pose, standard deviations, the turn (between, rad) and the way (at most, m; 0 is none); none where nothing can
    // be gained.
    let table = [
        // Half a metre from the corner of touch and goal line, looking back along the touch line, which is on the right.
        ([4.0, 2.5, PI], [0.06, 0.06, 0.03], Some(([-2.7, -0.5], 0.0))),
        // Near the touch line, the place along it known: any look at the line is enough, and the nearest is to the left.
        ([2.2, 2.2, 0.0], [0.005, 0.06, 0.03], Some(([0.2, 1.4], 0.0))),
        // The same from the other side.
        ([2.2, 2.2, PI], [0.005, 0.06, 0.03], Some(([-1.4, -0.2], 0.0))),
        // In the middle of a quarter of the field no line is near enough to be seen.
        ([-1.8, 1.5, 0.0], [0.06, 0.06, 0.03], Some(([-PI, PI], 0.8))),
        // Known already: no look tells more.
        ([-1.8, 1.5, 0.0], [0.001, 0.001, 0.001], None),
    ];
    for (pose, sd, expected) in table {
        let believed = Estimate::new(body(pose), sd);
        let here = believed.pose;
        let needed = if expected.is_some() { ENOUGH } else { 0.0005 };
        let to = map.vantage(&camera, &believed, needed);
        let (Some(to), Some(([low, high], most))) = (to, expected) else {
            assert!(to.is_none() && expected.is_none(), "{pose:?} {sd:?}: {to:?}, not {expected:?}");
            continue;
        };
        let (turn, way) = (wrap_angle(to.theta - here.theta), here.distance(to));
        assert!((low..=high).contains(&turn) && way < most + 1e-9, "{pose:?} {sd:?}: {turn} after {way}");
        assert_eq!(way > 0.0, most > 0.0, "{pose:?}: {way}");
        let outlook = map.outlook(&camera, to);
        let covariance = (believed.covariance.try_inverse().unwrap() + outlook.information).try_inverse().unwrap();
        let sd = Estimate { covariance, ..believed }.place_sd();
        assert!(sd <= ENOUGH && outlook.points >= PROMISED, "{pose:?}: {sd}");
    }
}
