//! Controller, command and stamps: what the log of a whole robot shows.

use super::*;
use crate::manoeuvre::{Manoeuvre, simulate};
use crate::pi::SpeedLoop;
use runs::Run;

fn log(name: &str, parameters: &[(&str, f64)]) -> Run {
    let nominal = Robot::racbot();
    simulate(Manoeuvre::Chirp, &applied(name, parameters), &nominal, Pose::default(), 3).unwrap()
}

/// Duties of axis 1 by the law of a robot, from what it logged, counts and set points so many ticks old.
fn replayed(run: &Run, robot: &Robot, age: [usize; 2]) -> f64 {
    let mut axis = SpeedLoop::new(robot);
    let error = (0..run.len()).map(|k| {
        let count = run.counts[0][k.saturating_sub(age[0])];
        (axis.step(run.reference[0][k.saturating_sub(age[1])], count) - run.duty[0][k]).abs()
    });
    error.fold(0.0, f64::max)
}

#[test]
fn gains_and_ages() {
    let nominal = Robot::racbot();
    assert!(replayed(&log("wheel-skew", &[]), &nominal, [0, 0]) < 1e-12);
    let mut strong = nominal.clone();
    (strong.pi.kp, strong.pi.ki) = (1.2 * nominal.pi.kp, 0.9 * nominal.pi.ki);
    let run = log("pi-gain", &[("kp_scale", 0.2), ("ki_scale", -0.1)]);
    assert!(replayed(&run, &strong, [0, 0]) < 1e-12 && replayed(&run, &nominal, [0, 0]) > 0.01);
    for (signal, age) in [(0.0, [2, 0]), (1.0, [0, 2])] {
        let run = log("sample-order", &[("signal", signal), ("shift_ticks", 2.0)]);
        assert!(replayed(&run, &nominal, age) < 1e-12 && replayed(&run, &nominal, [0, 0]) > 0.01);
    }
    let mut counting = nominal.clone();
    counting.encoder_counts_per_motor_rev *= 1.1;
    let run = log("encoder-scale", &[("loop_scale", 0.1)]);
    assert!(replayed(&run, &counting, [0, 0]) < 1e-12 && replayed(&run, &nominal, [0, 0]) > 0.01);
    let coarse = log("quantisation", &[("duty_quantum", 0.05)]);
    assert!(coarse.duty.iter().flatten().all(|d| (d / 0.05 - (d / 0.05).round()).abs() < 1e-9));
}

#[test]
fn an_integrator_that_is_not_held_winds_up() {
    let applied = applied("integrator-windup", &[("limit_duty", 2.5)]);
    let law = applied.control.law(&applied.robot);
    let mut integral = 0.0;
    for _ in 0..1000 {
        assert_eq!(law.step(&mut integral, 50.0, 0.0), 1.0);
    }
    assert_eq!(integral, 2.5);
}

#[test]
fn set_points_follow_late_or_elsewhere() {
    let g = Robot::racbot().geometry().unwrap();
    let expected = |run: &Run, i: usize, k: usize| {
        let [vx, vy, w] = run.command.as_ref().unwrap();
        g.wheel_speed(i, Twist::new(vx[k], vy[k], w[k]))
    };
    let late = log("command-latency", &[("latency_s", 0.03)]);
    let swapped = log("wheel-order", &[("axis_1", 2.0), ("axis_2", -1.0), ("axis_3", 3.0)]);
    for k in (100..late.len()).step_by(97) {
        assert!((late.reference[0][k] - expected(&late, 0, k - 30)).abs() < 1e-12);
        assert!((swapped.reference[0][k] - expected(&swapped, 1, k)).abs() < 1e-12);
        assert!((swapped.reference[1][k] + expected(&swapped, 0, k)).abs() < 1e-12);
        assert!((swapped.reference[2][k] - expected(&swapped, 2, k)).abs() < 1e-12);
    }
}

#[test]
fn crossed_cables_are_in_the_wheels_and_fold_away() {
    let parameters = [("cable_1", 2.0), ("cable_2", 1.0), ("cable_3", -3.0), ("axis_1", 3.0)];
    let value = |v: f64| EffectParameter { value: v, ..EffectParameter::default() };
    let parameters = parameters.map(|(name, v)| (name.to_owned(), value(v))).to_vec();
    let effect = Effect { name: "wheel-order".to_owned(), parameters, ..Effect::default() };
    let robot = Robot { effects: vec![effect], ..Robot::racbot() };
    let (nominal, applied) = (robot.layout.wheels(), Applied::of(&robot));
    let wired = applied.robot.layout.wheels();
    assert_eq!((wired[0], wired[1]), (nominal[1], nominal[0]));
    assert_eq!(wired[2].drive_rad, nominal[2].drive_rad + std::f64::consts::PI);
    assert_eq!((applied.control.order, applied.unsupported), (vec![3.0, 2.0, 3.0], vec![]));
    let folded = Applied::geometry_of(&robot);
    assert_eq!(folded.layout.wheels(), wired);
    assert_eq!(folded.effects[0].parameters.len(), 1, "the set points' side stays an effect");
}

#[test]
fn stamps_scatter_and_frames_are_lost() {
    let run = log("camera-timing", &[("jitter_s", 0.004), ("dropped", 0.1)]);
    let plain = log("wheel-skew", &[]);
    let kept = run.camera.len() as f64 / plain.camera.len() as f64;
    assert!((kept - 0.9).abs() < 0.04, "{kept}");
    assert!(run.camera.windows(2).all(|w| w[0].tick < w[1].tick));
    // Differences of neighbouring stamps scatter by √2 times as much.
    let steps: Vec<f64> = run.camera.windows(2).map(|w| (w[1].tick - w[0].tick) as f64).filter(|s| *s < 29.0).collect();
    let mean = steps.iter().sum::<f64>() / steps.len() as f64;
    let scatter = (steps.iter().map(|s| (s - mean).powi(2)).sum::<f64>() / steps.len() as f64).sqrt();
    assert!((scatter / 2.0_f64.sqrt() - 4.0).abs() < 0.6, "{scatter}");
}
