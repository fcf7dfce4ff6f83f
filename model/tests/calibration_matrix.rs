//! Both calibration procedures over a seeded matrix, as a table that shows in review.

use std::fmt::Write as _;

use model::calibration::{PaperOptions, calibrate_like_the_paper, estimate_skew};
use model::camera::CameraModel;
use model::plant::{Contact, Creep};
use model::simulation::{VirtualRobot, calibration_drive};
use model::trajectory::{FIG_6, simulate_motion};
use runs::frames::Pose;
use runs::geometry::Geometry;
use runs::robot::{Layout, Robot};

struct Case {
    skew_deg: [f64; 3],
    /// Camera noise: 1 is 1.5 mm and 0.5°.
    noise: f64,
    counts: u32,
    slip: bool,
}

const fn case(skew_deg: [f64; 3], noise: f64, counts: u32, slip: bool) -> Case {
    Case { skew_deg, noise, counts, slip }
}

const CASES: [Case; 12] = [
    case([4.0, -3.0, 2.0], 0.0, 2048, false),
    case([4.0, -3.0, 2.0], 1.0, 2048, false),
    case([4.0, -3.0, 2.0], 3.0, 2048, false),
    case([4.0, -3.0, 2.0], 1.0, 512, false),
    case([4.0, -3.0, 2.0], 1.0, 2048, true),
    case([8.0, -8.0, 8.0], 1.0, 2048, false),
    case([-8.0, 8.0, 0.0], 1.0, 2048, false),
    case([8.0, -8.0, 8.0], 1.0, 2048, true),
    case([1.0, -1.0, 0.5], 1.0, 2048, false),
    case([0.0, 0.0, 0.0], 1.0, 2048, false),
    case([3.0, 3.0, 3.0], 1.0, 2048, false),
    case([0.0, 0.0, 8.0], 1.0, 2048, false),
];

fn with_skew(robot: &Robot, skew_rad: [f64; 3]) -> Robot {
    Robot { layout: Layout::Rac { body_radius_m: 0.085, skew_rad }, ..robot.clone() }
}

/// Largest error of a difference of skews and error of their mean, degrees.
fn errors(found: &[f64], truth_deg: [f64; 3]) -> (f64, f64) {
    let off: Vec<f64> = found.iter().zip(truth_deg).map(|(f, t)| f.to_degrees() - t).collect();
    let spread = off.iter().copied().fold(f64::MIN, f64::max) - off.iter().copied().fold(f64::MAX, f64::min);
    (spread, off.iter().sum::<f64>() / 3.0)
}

/// Largest distance between where the controller of Fig. 6 believes to be and where it is, in per
/// cent of the path.
fn path_error(believed: &[f64], actual: &Geometry) -> f64 {
    let believed = Geometry::rac(0.0275, 0.085, [believed[0], believed[1], believed[2]]).unwrap();
    let run = simulate_motion(&FIG_6, Pose::default(), &believed, actual, 0.002, 60.0);
    let worst = run.iter().map(|s| s.believed.distance(s.actual)).fold(0.0, f64::max);
    100.0 * worst / (18.0_f64.sqrt() + 9.0)
}

#[test]
fn both_procedures_over_the_matrix() {
    let mut table = String::from(
        "skew [deg]       noise counts slip | path error [%]         | estimate [deg]      | paper, sound step   | as printed\n\
         \x20                                 | before  estim.  paper  | differ.  95%   mean | differ.  mean drives| differ.  mean\n",
    );
    for (k, c) in CASES.iter().enumerate() {
        let skew_rad = c.skew_deg.map(f64::to_radians);
        let nominal = Robot { encoder_counts_per_motor_rev: f64::from(c.counts), ..Robot::racbot() };
        let actual = with_skew(&nominal, skew_rad);
        let truth = actual.geometry().unwrap();
        let camera = CameraModel {
            noise: [0.0015 * c.noise, 0.0015 * c.noise, 0.5_f64.to_radians() * c.noise],
            ..CameraModel::of(&actual)
        };
        let contact = if c.slip {
            Contact::Friction { friction_coefficient: 0.5, creep: Creep::at_rest(0.003) }
        } else {
            Contact::Rolling
        };
        let robot = |seed| VirtualRobot::new(&actual, contact, camera, Pose::default(), seed).unwrap();

        let mut logged = robot(100 + k as u64);
        calibration_drive(&mut logged, 0.8, 30.0, &nominal.geometry().unwrap());
        let estimate = estimate_skew(&nominal, &[logged.into_log()]).unwrap();
        let half = estimate.differences.iter().map(|d| d.2).fold(0.0, f64::max).to_degrees();
        let (differ, mean) = errors(&estimate.skew_rad, c.skew_deg);

        let mut driven = robot(200 + k as u64);
        let paper = calibrate_like_the_paper(&nominal, &mut driven, &PaperOptions::default()).unwrap();
        let (paper_differ, paper_mean) = errors(&paper.common, c.skew_deg);
        let (printed_differ, printed_mean) = errors(&paper.scaled, c.skew_deg);

        let skew = format!("{:+.1} {:+.1} {:+.1}", c.skew_deg[0], c.skew_deg[1], c.skew_deg[2]);
        let _ = writeln!(
            table,
            "{skew:16} {:5.1} {:6} {:4} | {:6.2} {:6.2} {:6.2}   | {differ:6.2} {half:6.2} {mean:+6.2} | {paper_differ:6.2} {paper_mean:+6.2} {:4}  | {printed_differ:6.2} {printed_mean:+6.2}",
            c.noise,
            c.counts,
            if c.slip { "yes" } else { "no" },
            path_error(&[0.0; 3], &truth),
            path_error(&estimate.skew_rad, &truth),
            path_error(&paper.common, &truth),
            paper.iterations.len(),
        );
    }
    insta::assert_snapshot!(table);
}
