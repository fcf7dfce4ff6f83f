//! Frames that come unevenly, each stamped with the time at which it was taken.

use gap::{Options, Verdict, analyse};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use runs::robot::Robot;

use super::common::{RICH, names, simulate, with};

/// Rates of the camera that is simulated and of the one that a log has, Hz.
const FINE_HZ: f64 = 250.0;
const LOGGED_HZ: f64 = 40.0;

#[test]
fn frames_that_come_unevenly_are_no_scatter_of_their_stamps() {
    for (truth, expected) in [
        (Robot::racbot(), vec![]),
        (with(&Robot::racbot(), "wheel-radius-common", &[("scale", 0.03)]), vec!["wheel-radius-common"]),
    ] {
        let mut set = simulate(&Robot { camera_rate_hz: FINE_HZ, ..truth }, &RICH, 21);
        let mut rng = ChaCha8Rng::seed_from_u64(22);
        for run in &mut set.runs {
            let mut next = 0.0;
            let mut kept = Vec::new();
            for frame in std::mem::take(&mut run.camera) {
                if run.t[frame.tick] >= next {
                    // Frame by frame up to 8 ms early or late, and one of twenty missing.
                    let number = (run.t[frame.tick] * LOGGED_HZ).round() + 1.0;
                    next = (number + rng.random_range(-0.3..0.3)) / LOGGED_HZ;
                    if rng.random_range(0.0..1.0) > 0.05 {
                        kept.push(frame);
                    }
                }
            }
            run.camera = kept;
        }
        set.robot.camera_rate_hz = LOGGED_HZ;
        let a = analyse(&set, &Options::default()).unwrap();
        assert_eq!(names(&a), expected, "{}", a.terminal_summary());
        assert_eq!(a.verdict == Verdict::Agrees, expected.is_empty(), "{}", a.terminal_summary());
        assert!(a.remarks.iter().any(|r| r.contains("their poses follow the stamps")), "{:?}", a.remarks);
    }
}

/// A tracker that skips and waits: no beat at all.
#[test]
fn frames_without_a_beat_are_no_scattered_stamps() {
    let skew = [("skew_1_rad", 0.06), ("skew_2_rad", -0.05), ("skew_3_rad", 0.04)];
    let truths = [(Robot::racbot(), vec![]), (with(&Robot::racbot(), "wheel-skew", &skew), vec!["wheel-skew"])];
    for (truth, expected) in truths {
        let mut set = simulate(&Robot { camera_rate_hz: FINE_HZ, ..truth }, &RICH, 11);
        let mut rng = ChaCha8Rng::seed_from_u64(23);
        for run in &mut set.runs {
            let mut next = 0;
            let mut kept = Vec::new();
            for (i, frame) in run.camera.iter().enumerate() {
                if i == next {
                    next += rng.random_range(2..7);
                    kept.push(*frame);
                }
            }
            run.camera = kept;
        }
        set.robot.camera_rate_hz = FINE_HZ / 4.0;
        let a = analyse(&set, &Options::default()).unwrap();
        assert_eq!(names(&a), expected, "{}", a.terminal_summary());
        assert!(a.remarks.iter().any(|r| r.contains("their poses follow the stamps")), "{:?}", a.remarks);
    }
}
