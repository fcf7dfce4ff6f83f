//! Columns that hold something else than their name says, and odometry whose heading is not its own.

use std::fmt::Write as _;
use std::path::Path;

use model::setup::{Mistake, mistakes};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use runs::robot::Robot;
use runs::{DataSet, Logs};

/// A robot of two wheels, whose file has counts.
fn robot(folder: &Path) -> Robot {
    let wheel = |x: f64| format!("[[wheel]]\nx_m = {x}\ny_m = 0\ndrive_deg = 90\nroller_deg = 0\n");
    let head = "wheel_radius_m = 0.05\ngear_ratio = 1\nencoder_counts_per_motor_rev = 1000\n";
    std::fs::write(folder.join("robot.toml"), format!("{head}{}{}", wheel(0.1), wheel(-0.1))).unwrap();
    Robot::load_partial(folder.join("robot.toml")).unwrap()
}

/// What is said of a log.
fn said(text: &str) -> Vec<Mistake> {
    let folder = tempfile::tempdir().unwrap();
    let robot = robot(folder.path());
    std::fs::write(folder.path().join("run.csv"), text).unwrap();
    mistakes(&Logs::from(&DataSet::open_as(folder.path(), robot).unwrap()))
}

/// Odometry that goes ahead and back on curves, turned by an angle from its own heading; with a corrector that pulls it aside.
fn odometry(aside: f64, pulled: f64, seed: u64) -> String {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut text = "t,odom_x,odom_y,odom_theta\n".to_owned();
    let [mut x, mut y, mut theta] = [0.0, 0.0, 1.0_f64];
    for k in 0..600 {
        let t = 0.05 * f64::from(k);
        let _ = writeln!(text, "{t},{x},{y},{theta}");
        let (way, turn) = (0.02 * (0.4 * t).sin(), 0.03 * (0.7 * t).cos());
        let to = theta + 0.5 * turn + std::f64::consts::FRAC_PI_2 + aside;
        x += way * to.cos() + pulled * random.random_range(-0.02..0.02);
        y += way * to.sin() + pulled * random.random_range(-0.02..0.02);
        theta += turn;
    }
    text
}

#[test]
fn odometry_beside_its_own_heading_is_told_with_the_angle() {
    for (aside, seed) in [(0.072, 1), (-0.03, 2)] {
        let told = said(&odometry(aside, 0.005, seed));
        assert!(told.len() == 1 && told[0].kind == "odometry-aside" && told[0].nameable, "{told:?}");
        let angle: f64 = told[0].remedy.split(' ').nth(1).unwrap().parse().unwrap();
        assert!((angle - aside).abs() < 0.002, "{aside}: {}", told[0].sentence());
    }
    // Curves have no way of their own beside the heading, and what a filter pulls aside goes with no way.
    for (pulled, seed) in [(0.0, 3), (0.3, 4), (1.0, 5)] {
        assert_eq!(said(&odometry(0.0, pulled, seed)), vec![], "{pulled}");
    }
}

/// Two wheels, their columns as a function of row and time.
fn table(names: &str, of: impl Fn(usize, f64) -> [String; 2]) -> String {
    let mut text = format!("t,{names}\n");
    for k in 0..800 {
        let t = 0.02 * k as f64;
        let [one, other] = of(k, t);
        let _ = writeln!(text, "{t},{one},{other}");
    }
    text
}

#[test]
fn clocks_are_no_counts_and_angles_no_speeds() {
    let turned = |t: f64| (2000.0 * (0.5 * t).sin() + 300.0 * t).round();
    let clock =
        |per_s: f64| table("enc_1,enc_2", move |_, t| [format!("{}", turned(t)), format!("{:.0}", per_s * t + 7.0)]);
    for per_s in [1e3, 1e6] {
        let told = said(&clock(per_s));
        let is = |m: &&Mistake| m.kind == "counts-are-time" && m.column == "enc_2";
        assert!(told.len() == 1 && told.iter().find(is).is_some(), "{told:?}");
    }
    // A wheel that goes on at nearly as many counts a second, and stands before, is none.
    let drives = table("enc_1,enc_2", |_, t| [0, 1].map(|_| format!("{:.0}", 1000.0 * (t - 1.0).max(0.0))));
    assert_eq!(said(&drives), vec![]);

    let angle = |k: usize| (k * 977) % 32_768;
    let told = said(&table("speed_1,speed_2", |k, t| [format!("{}", 20.0 * t.sin()), format!("{}", angle(k))]));
    assert!(told.len() == 1 && told[0].kind == "too-fast" && told[0].column == "speed_2", "{told:?}");
    assert_eq!(said(&table("speed_1,speed_2", |_, t| [0, 1].map(|_| format!("{}", 200.0 * t.sin())))), vec![]);
}
