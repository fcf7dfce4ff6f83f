//! Frames that must not move a robot, each named, and one that does.

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use runs::frames::Pose;
use vision::camera::Camera;
use vision::field::Field;
use vision::localise::{Estimate, NoMatch, body};
use vision::onboard::{Glance, OnBoard, Refused};
use vision::picture::{Picture, Unusable};
use vision::render::{Sensor, Shutter, World, render};

/// From where the corner of a defence area and the goal line can be seen (m, m, rad).
const PLACE: [f64; 3] = [2.4, -0.6, 0.2];
/// Of the prediction (m, m, rad).
const SD: [f64; 3] = [0.05, 0.05, 0.05];

fn camera() -> Camera {
    Camera { distortion: [-0.1, 0.0], ..Camera::ideal(320, 240, 1.2, 0.15, 0.35) }
}

fn picture(camera: &Camera, sensor: &Sensor, seed: u64) -> Picture {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let shutter = Shutter { pose: PLACE, ..Shutter::default() };
    render(&World::plain(Field::DIVISION_B, 5).with_ball(3.1, -0.5), camera, shutter, sensor, 1, &mut rng).picture
}

fn predicted() -> Estimate {
    let truth = body(PLACE);
    Estimate::new(Pose::new(truth.x + 0.04, truth.y - 0.03, truth.theta + 0.03), SD)
}

fn off(glance: &Glance) -> Option<f64> {
    let (truth, found) = (body(PLACE), glance.pose.as_ref().ok()?.pose);
    Some((found.x - truth.x).hypot(found.y - truth.y))
}

#[test]
fn a_good_frame_gives_ball_and_pose() {
    let mut onboard = OnBoard::new(camera(), Field::DIVISION_B);
    let glance = onboard.glance(&picture(&camera(), &Sensor::GOOD, 1), &predicted()).unwrap();
    assert!(off(&glance).unwrap() < 0.03, "{:?}", glance.pose);
    let [forward, left] = glance.scene.balls[0].place(&camera(), vision::ball::RADIUS).unwrap();
    let ball = [3.1 - PLACE[0], -0.5 - PLACE[1]];
    assert!((forward.hypot(left) - ball[0].hypot(ball[1])).abs() < 0.04, "{forward} {left}");
}

#[test]
fn a_frozen_frame_is_named() {
    let mut onboard = OnBoard::new(camera(), Field::DIVISION_B);
    let frame = picture(&camera(), &Sensor::GOOD, 1);
    assert!(onboard.glance(&frame, &predicted()).is_ok());
    assert_eq!(onboard.glance(&frame, &predicted()), Err(Unusable::Frozen));
    assert_eq!(onboard.glance(&frame, &predicted()), Err(Unusable::Frozen));
    assert!(onboard.glance(&picture(&camera(), &Sensor::GOOD, 2), &predicted()).is_ok());
}

#[test]
fn black_and_over_exposed_frames_are_named() {
    let mut onboard = OnBoard::new(camera(), Field::DIVISION_B);
    for (exposure, error) in [(0.0, Unusable::Black), (100.0, Unusable::OverExposed)] {
        let frame = picture(&camera(), &Sensor { exposure, ..Sensor::GOOD }, 1);
        assert_eq!(onboard.glance(&frame, &predicted()), Err(error));
    }
}

#[test]
fn a_frame_of_another_size_is_named() {
    let mut onboard = OnBoard::new(camera(), Field::DIVISION_B);
    let frame = picture(&Camera::ideal(160, 120, 1.2, 0.15, 0.35), &Sensor::GOOD, 1);
    let error = onboard.glance(&frame, &predicted()).unwrap_err();
    assert_eq!(error.to_string(), "160 x 120 pixels, but the camera is calibrated at 320 x 240");
}

/// A calibration that is off makes a match that is refused, or one that still is no farther off than the prediction was.
#[test]
fn a_wrong_calibration_does_not_lead_astray() {
    let bent = [
        Camera { tilt: camera().tilt + 0.2, ..camera() },
        Camera { tilt: camera().tilt - 0.15, ..camera() },
        Camera { mount_height: 0.3, ..camera() },
        Camera { focal: camera().focal.map(|f| f * 1.6), ..camera() },
    ];
    let mut refused = 0;
    for taken_by in bent {
        let mut onboard = OnBoard::new(camera(), Field::DIVISION_B);
        let glance = onboard.glance(&picture(&taken_by, &Sensor::GOOD, 1), &predicted()).unwrap();
        refused += usize::from(glance.pose.is_err());
        assert!(off(&glance).is_none_or(|off| off < 0.12), "{taken_by:?}: {:?} {:?}", off(&glance), glance.pose);
    }
    assert!(refused >= 2, "{refused} of 4 refused");
}

#[test]
fn lines_that_tell_nothing_or_of_another_place_are_refused() {
    let mut onboard = OnBoard::new(camera(), Field::DIVISION_B);
    // Sure of standing where no line can be seen.
    let elsewhere = Estimate::new(body([1.5, 1.8, 1.0]), [0.001; 3]);
    let glance = onboard.glance(&picture(&camera(), &Sensor::GOOD, 1), &elsewhere).unwrap();
    assert!(
        matches!(glance.pose, Err(Refused::Lines(NoMatch::Contradiction(_)) | Refused::Far(_))),
        "{:?}",
        glance.pose
    );
    // A prediction that knows nothing, and one line at most.
    let carpet = Field { length: 60.0, width: 60.0, ..Field::DIVISION_B };
    let mut lost = OnBoard::new(camera(), carpet);
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let shutter = Shutter { pose: [10.0, 10.0, 0.3], ..Shutter::default() };
    let frame = render(&World::plain(carpet, 5), &camera(), shutter, &Sensor::GOOD, 1, &mut rng).picture;
    let glance = lost.glance(&frame, &Estimate::new(body([10.0, 10.0, 0.3]), [1.0; 3])).unwrap();
    assert!(matches!(glance.pose, Err(Refused::Lines(NoMatch::TooFewPoints(_)))), "{:?}", glance.pose);
    assert!(glance.pose.unwrap_err().kind().contains("too few"));
}
