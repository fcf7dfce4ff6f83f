//! A slow robot on circles: what is wrong with its wheels by a per cent does not show in single seconds.

use std::fmt::Write as _;

use gap::{Analysis, Options, Verdict, analyse};
use links::effect::Link;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use runs::DataSet;
use runs::frames::{Pose, Twist, displacement};

use super::common::names;

/// Radius, m, half of the track, m, counts a turn: two wheels of a teaching robot.
const WHEELS: [f64; 3] = [0.042, 0.1, 43.7 * 64.0];
/// What motion capture errs, m and rad.
const CAPTURE: [f64; 2] = [4e-4, 4e-3];
/// What the wheels wander over a metre, m and rad.
const WANDER: [f64; 2] = [1.6e-3, 7e-3];
const PERIOD_S: f64 = 0.05;

/// Circles of 100 s each way whose wheels stand wider by a share than the file says.
fn circles(wider: f64, seed: u64) -> tempfile::TempDir {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut normal = move || -> f64 { StandardNormal.sample(&mut random) };
    let folder = tempfile::tempdir().unwrap();
    let [radius, half, counts] = WHEELS;
    for run in 0..4 {
        let mut text = "t,enc_1,enc_2,cam_x,cam_y,cam_theta\n".to_owned();
        let side = if run % 2 == 0 { 1.0 } else { -1.0 };
        let (mut at, mut angle) = (Pose::default(), [0.0_f64; 2]);
        for k in 0..2000 {
            let begun = (k as f64 * PERIOD_S / 2.0).min(1.0);
            let [v, turn] = [0.2 * begun, side * 0.3 * begun * (1.0 + 0.2 * (0.02 * k as f64).sin())];
            let way = v * PERIOD_S;
            let root = way.sqrt();
            let moved = [WANDER[0] * root * normal(), way + WANDER[0] * root * normal()];
            at =
                at.compose(displacement(Twist::new(moved[0], moved[1], turn * PERIOD_S + WANDER[1] * root * normal())));
            let rim = turn * PERIOD_S * half * (1.0 + wider);
            for (angle, rim) in angle.iter_mut().zip([rim, -rim]) {
                *angle += (way + rim) / radius;
            }
            let [right, left] = angle.map(|a| (a / std::f64::consts::TAU * counts).round());
            let [x, y] = [at.x, at.y].map(|p| p + CAPTURE[0] * normal());
            let heading = at.theta + CAPTURE[1] * normal();
            let _ = writeln!(text, "{:.2},{right},{left},{x:.6},{y:.6},{heading:.6}", k as f64 * PERIOD_S);
        }
        std::fs::write(folder.path().join(format!("run_{run}.csv")), text).unwrap();
    }
    let robot = format!(
        "wheel_radius_m = {radius}\ngear_ratio = 43.7\nencoder_counts_per_motor_rev = 64\ncontrol_rate_hz = 20\n\
         camera_rate_hz = 20\nmass_kg = 2.0\nyaw_inertia_kg_m2 = 0.02\n[motor]\nresistance_ohm = 1.0\n\
         torque_constant = 0.03\nrotor_inertia = 1e-6\n[[wheel]]\nx_m = {half}\ny_m = 0\ndrive_rad = 1.57079633\n\
         roller_rad = 0\n[[wheel]]\nx_m = -{half}\ny_m = 0\ndrive_rad = 1.57079633\nroller_rad = 0\n"
    );
    std::fs::write(folder.path().join("robot.toml"), robot).unwrap();
    folder
}

fn analysed(folder: &tempfile::TempDir, options: &Options) -> Analysis {
    analyse(&DataSet::open(folder.path()).unwrap(), options).unwrap()
}

/// No ways, however much they tell.
fn in_frames() -> Options {
    let mut options = Options::default();
    options.thresholds.tells_more = f64::INFINITY;
    options
}

/// What would be named of half the track, from which size.
fn told(a: &Analysis) -> f64 {
    a.limits.iter().find(|l| l.name == "body-radius").map_or(f64::INFINITY, |l| l.limit)
}

#[test]
fn a_track_that_is_a_little_wider_shows_along_ways() {
    for seed in 301..304 {
        let folder = circles(0.014, seed);
        let a = analysed(&folder, &Options::default());
        assert_eq!(names(&a), ["body-radius"], "{seed}: {}", a.terminal_summary());
        let found = &a.effects[0].parameters[0];
        let [low, high] = found.2.ends().unwrap();
        assert!(low < 0.014 && 0.014 < high && low > 0.0, "{seed}: {}", a.terminal_summary());
        assert!(a.remarks.iter().any(|r| r.contains("along ways of 10 s")), "{seed}: {:?}", a.remarks);
        let frames = analysed(&folder, &in_frames());
        assert_eq!(names(&frames), Vec::<&str>::new(), "{seed}: {}", frames.terminal_summary());
        // The file as it was written is measured in the same way.
        std::fs::write(folder.path().join("robot.toml"), &a.robot_text).unwrap();
        let again = analysed(&folder, &Options::default());
        assert_eq!((again.verdict, names(&again)), (Verdict::Agrees, vec![]), "{seed}: {}", again.terminal_summary());
        let motion = |a: &Analysis| a.links.iter().find(|l| l.link == Link::Motion).map(|l| [l.before, l.after]);
        let ([_, after], [before, _]) = (motion(&a).unwrap(), motion(&again).unwrap());
        assert!((after / before - 1.0).abs() < 1e-3, "{seed}: {after} written, {before} found");
    }
}

#[test]
fn ways_tell_smaller_sizes_where_nothing_is_wrong() {
    let folder = circles(0.0, 310);
    let a = analysed(&folder, &Options::default());
    assert_eq!((a.verdict, names(&a)), (Verdict::Agrees, vec![]), "{}", a.terminal_summary());
    let frames = analysed(&folder, &in_frames());
    assert_eq!((frames.verdict, names(&frames)), (Verdict::Agrees, vec![]), "{}", frames.terminal_summary());
    assert!(1.2 * told(&a) < told(&frames), "{} along ways, {} in frames", told(&a), told(&frames));
}
