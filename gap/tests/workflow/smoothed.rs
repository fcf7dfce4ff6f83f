//! Poses that were smoothed, or drift as those of a map do: neighbouring ones show nothing of what they err.

use std::f64::consts::{PI, TAU};

use gap::{Analysis, Options, Verdict, analyse};
use model::manoeuvre::Manoeuvre::{Chirp, Spin, Star};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use runs::Run;
use runs::frames::Pose;
use runs::robot::Robot;

use super::common::{names, simulate, with};

/// Full width of the window that smooths the poses, s.
const SMOOTHED_S: f64 = 0.3;
/// Time over which they keep their error, s, and that error (m, m, rad).
const KEPT_S: f64 = 2.0;
const ERRS: [f64; 3] = [0.012, 0.012, 0.03];

/// What a filter on a map makes of the camera's poses.
fn mapped(run: &mut Run, seed: u64) {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let t: Vec<f64> = run.camera.iter().map(|s| run.t[s.tick]).collect();
    let mut turn = 0.0;
    let poses: Vec<[f64; 3]> = run
        .camera
        .iter()
        .map(|s| {
            turn += runs::frames::wrap_angle(s.pose.theta - turn);
            [s.pose.x, s.pose.y, turn]
        })
        .collect();
    // Errors as sums of waves of every length that lasts.
    let waves: Vec<[(f64, f64); 3]> = (0..12)
        .map(|_| std::array::from_fn(|_| (random.random_range(0.1..1.0) / KEPT_S, random.random_range(0.0..TAU))))
        .collect();
    for (i, sample) in run.camera.iter_mut().enumerate() {
        let near: Vec<(f64, usize)> = (0..t.len())
            .map(|k| (2.0 * (t[k] - t[i]) / SMOOTHED_S, k))
            .filter(|(x, _)| x.abs() < 1.0)
            .map(|(x, k)| (1.0 + (PI * x).cos(), k))
            .collect();
        let whole: f64 = near.iter().map(|(w, _)| w).sum();
        let [x, y, theta] = [0, 1, 2].map(|j| {
            let smooth = near.iter().map(|(w, k)| w * poses[*k][j]).sum::<f64>() / whole;
            let error: f64 = waves.iter().map(|w| (TAU * w[j].0 * t[i] + w[j].1).sin()).sum();
            smooth + ERRS[j] * error * (2.0_f64 / 12.0).sqrt()
        });
        (sample.pose.x, sample.pose.y, sample.pose.theta) = (x, y, runs::frames::wrap_angle(theta));
    }
}

fn seen(robot: &Robot, seed: u64) -> Analysis {
    let mut set = simulate(robot, &[Star, Spin, Chirp, Star], seed);
    for (k, run) in set.runs.iter_mut().enumerate() {
        run.duty.clear();
        mapped(run, 10 * seed + k as u64);
    }
    analyse(&set, &Options::default()).unwrap()
}

#[test]
fn poses_of_a_map_name_what_they_show_and_agree_where_they_show_nothing() {
    for seed in [50, 52] {
        let a = seen(&Robot::racbot(), seed);
        assert_eq!((a.verdict, names(&a)), (Verdict::Agrees, vec![]), "{}", a.terminal_summary());
        let said = "the poses were smoothed or come from a map";
        assert!(a.remarks.iter().any(|r| r.starts_with(said)), "{:?}", a.remarks);

        let a = seen(&with(&Robot::racbot(), "wheel-radius-common", &[("scale", 0.05)]), seed);
        assert!(matches!(a.verdict, Verdict::MissingEffect | Verdict::Ambiguous), "{}", a.terminal_summary());
        // Wheels that are all larger by the same, or each by itself.
        assert!(
            names(&a) == ["wheel-radius-common"] || names(&a) == ["wheel-radius"],
            "{seed}: {}",
            a.terminal_summary()
        );
        for (name, v, interval) in &a.effects[0].parameters {
            let [low, high] = interval.ends().unwrap();
            assert!(low < 0.05 && 0.05 < high && high - low < 0.06, "{seed} {name}: {v}, {low} to {high}");
        }
    }
}

/// Moves every pose back along its way by so much at 1 m/s, and by the square of the speed else.
fn late_with_speed(run: &mut Run, seconds_per_speed: f64) {
    let before: Vec<(f64, Pose)> = run.camera.iter().map(|s| (run.t[s.tick], s.pose)).collect();
    for (i, sample) in run.camera.iter_mut().enumerate() {
        let [(t0, from), (t1, to)] = [before[i.saturating_sub(1)], before[(i + 1).min(before.len() - 1)]];
        let [vx, vy] = [to.x - from.x, to.y - from.y].map(|way| way / (t1 - t0));
        let late_s = seconds_per_speed * vx.hypot(vy);
        (sample.pose.x, sample.pose.y) = (sample.pose.x - late_s * vx, sample.pose.y - late_s * vy);
    }
}

/// Poses of a map err by 12 mm for seconds: what moves them by a few is nothing that the robot is asked for.
#[test]
fn structure_below_what_poses_of_a_map_err_by_decides_nothing() {
    let robot = with(&Robot::racbot(), "wheel-radius-common", &[("scale", 0.05)]);
    let mut set = simulate(&robot, &[Star, Spin, Chirp, Star], 50);
    for (k, run) in set.runs.iter_mut().enumerate() {
        run.duty.clear();
        late_with_speed(run, 0.03);
        mapped(run, 500 + k as u64);
    }
    let a = analyse(&set, &Options::default()).unwrap();
    assert!(matches!(a.verdict, Verdict::MissingEffect | Verdict::Ambiguous), "{}", a.terminal_summary());
    assert!(names(&a).iter().any(|name| name.starts_with("wheel-radius")), "{}", a.terminal_summary());
}

/// Standard deviation of a camera's place, m, and of its heading, rad.
const SEEN: [f64; 3] = [0.003, 0.003, 0.01];
/// Weights of a new frame in the place and in the velocity of a filter that trusts its own prediction.
const TRUSTS: [f64; 2] = [0.10, 0.005];

/// What a Kalman filter of constant velocity, long settled, makes of noisy frames: late, and beyond every corner.
fn tracked(run: &mut Run, seed: u64) {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let (mut state, mut last, mut turn): ([[f64; 2]; 3], _, _) = ([[0.0; 2]; 3], None, 0.0);
    for sample in &mut run.camera {
        let t = run.t[sample.tick];
        turn += runs::frames::wrap_angle(sample.pose.theta - turn);
        let noisy = |x: f64, sd: f64, random: &mut ChaCha8Rng| {
            x + sd * (0..12).map(|_| random.random_range(-0.5..0.5)).sum::<f64>()
        };
        let seen = [sample.pose.x, sample.pose.y, turn];
        for j in 0..3 {
            let z = noisy(seen[j], SEEN[j], &mut random);
            let [x, v] = &mut state[j];
            match last {
                Some(before) => {
                    let dt = t - before;
                    *x += *v * dt;
                    let off = z - *x;
                    (*x, *v) = (*x + TRUSTS[0] * off, *v + TRUSTS[1] * off / dt);
                }
                None => (*x, *v) = (z, 0.0),
            }
        }
        last = Some(t);
        (sample.pose.x, sample.pose.y) = (state[0][0], state[1][0]);
        sample.pose.theta = runs::frames::wrap_angle(state[2][0]);
    }
}

/// The filter's own error is no cause on the robot.
#[test]
fn the_lag_of_a_filter_is_no_scale_of_the_camera() {
    for seed in [54, 55, 56] {
        let mut set = simulate(&Robot::racbot(), &[Star, Spin, Chirp, Star], seed);
        for (k, run) in set.runs.iter_mut().enumerate() {
            run.duty.clear();
            tracked(run, 10 * seed + k as u64);
        }
        let a = analyse(&set, &Options::default()).unwrap();
        assert_eq!(a.verdict, Verdict::Unexplained, "{}", a.terminal_summary());
        assert!(!names(&a).contains(&"camera-scale"), "{}", a.terminal_summary());
        assert!(
            a.unexplained.iter().any(|u| u.structure.contains("poses that a filter smoothed")),
            "{:?}",
            a.unexplained
        );
    }
}
