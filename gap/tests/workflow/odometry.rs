//! Logs of a robot's own odometry, with nothing of its wheels.

use std::fmt::Write as _;

use gap::{Analysis, Options, Verdict, analyse};
use model::manoeuvre::Manoeuvre::{Chirp, Spin, Square, Star};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use runs::frames::{Pose, Twist, displacement};
use runs::robot::Robot;
use runs::{DataSet, Run};

use super::common::{names, simulate};

/// What the odometry has wrong: turn that it misses per metre forward (rad/m) and per second (rad/s), and the share of
/// what it moves sideways that it misses.
#[derive(Clone, Copy, Default)]
struct Wrong {
    curl: f64,
    rate: f64,
    sideways: f64,
}

/// A run as its robot's odometry tells it, a tick of five.
fn told(robot: &Robot, run: &Run, wrong: Wrong) -> String {
    let geometry = robot.geometry().unwrap();
    let mut at = Pose::default();
    let mut text = "t,odom_x,odom_y,odom_theta,cam_x,cam_y,cam_theta\n".to_owned();
    let mut camera = run.camera.iter().peekable();
    for k in 0..run.t.len() {
        if k > 0 {
            let per_rad = robot.counts_per_wheel_rad();
            let turned: Vec<f64> = run.counts.iter().map(|c| (c[k] - c[k - 1]) as f64 / per_rad).collect();
            let true_one = geometry.twist(&turned);
            let missed = wrong.curl * true_one.vy + wrong.rate * (run.t[k] - run.t[k - 1]);
            let believed = Twist::new(true_one.vx / (1.0 + wrong.sideways), true_one.vy, true_one.omega - missed);
            at = at.compose(displacement(believed));
        }
        let frame = camera.next_if(|s| s.tick == k);
        if frame.is_none() && k % 5 != 0 {
            continue;
        }
        let seen = frame.map_or(",,".to_owned(), |s| format!("{},{},{}", s.pose.x, s.pose.y, s.pose.theta));
        let _ = writeln!(text, "{},{},{},{},{seen}", run.t[k], at.x, at.y, at.theta);
    }
    text
}

fn seen(wrong: Wrong, seed: u64) -> Analysis {
    let robot = Robot::racbot();
    let set = simulate(&robot, &[Star, Square, Chirp, Spin], seed);
    let folder = tempfile::tempdir().unwrap();
    for run in &set.runs {
        std::fs::write(folder.path().join(format!("{}.csv", run.name)), told(&robot, run, wrong)).unwrap();
    }
    std::fs::write(folder.path().join("robot.toml"), "").unwrap();
    analyse(&DataSet::open(folder.path()).unwrap(), &Options::default()).unwrap()
}

fn holds(a: &Analysis, parameter: &str, truth: f64) {
    let found = a.effects.iter().flat_map(|e| &e.parameters).find(|p| p.0 == parameter);
    let ends = found.and_then(|p| p.2.ends());
    assert!(ends.is_some_and(|[low, high]| low < truth && truth < high), "{parameter}: {}", a.terminal_summary());
}

#[test]
fn odometry_that_turns_with_the_way_or_with_time_is_named() {
    let a = seen(Wrong::default(), 70);
    assert_eq!((a.verdict, names(&a)), (Verdict::Agrees, vec![]), "{}", a.terminal_summary());
    let mut random = ChaCha8Rng::seed_from_u64(71);
    for seed in 72..75 {
        let mut draw = |range: std::ops::Range<f64>| {
            let size = random.random_range(range);
            if random.random_bool(0.5) { size } else { -size }
        };
        let curl = draw(0.03..0.1);
        let a = seen(Wrong { curl, ..Wrong::default() }, seed);
        assert_eq!(names(&a), ["odometry-curl"], "{curl}: {}", a.terminal_summary());
        holds(&a, "forward_rad_per_m", curl);

        let rate = draw(0.01..0.04);
        let a = seen(Wrong { rate, ..Wrong::default() }, seed);
        assert_eq!(names(&a), ["odometry-drift"], "{rate}: {}", a.terminal_summary());
        holds(&a, "rate_rad_s", rate);

        let sideways = draw(0.03..0.08);
        let a = seen(Wrong { sideways, ..Wrong::default() }, seed);
        assert_eq!(names(&a), ["sideways-creep"], "{sideways}: {}", a.terminal_summary());
        holds(&a, "scale", sideways);
    }
}
