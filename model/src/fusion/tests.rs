use super::*;
use crate::camera::{Camera, CameraModel};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

const COUNTS_PER_RAD: f64 = 1e6;
const TICK: f64 = 0.001;

/// A drive whose wheels and camera err exactly as the filter is told.
struct Drive {
    options: FusionOptions,
    camera: CameraModel,
    seed: u64,
}

#[derive(Default)]
struct Outcome {
    nis: Vec<f64>,
    refused: usize,
    /// Normalised estimation error squared, at every camera frame.
    nees: Vec<f64>,
    /// Position error, m, at every tick.
    error: Vec<f64>,
    /// Standard deviation of x the filter claims, at every tick.
    claimed: Vec<f64>,
}

fn drive(latency_s: f64, seed: u64) -> Drive {
    let robot = Robot { camera_latency_s: latency_s, ..Robot::racbot() };
    Drive { options: FusionOptions::of(&robot), camera: CameraModel::of(&robot), seed }
}

impl Drive {
    fn run(&self, seconds: f64, blind: impl Fn(f64) -> bool) -> Outcome {
        let g = Geometry::rac(0.0275, 0.085, [0.0; 3]).unwrap();
        let start = Pose::new(1.0, -0.5, 2.9);
        let mut rng = ChaCha8Rng::seed_from_u64(self.seed);
        let mut camera = Camera::new(self.camera, self.seed + 1000);
        let noise = self.options.camera_noise;
        // The filter starts from a pose that errs as its covariance says.
        let mut gauss = || -> f64 { StandardNormal.sample(&mut rng) };
        let told =
            Pose::new(start.x + noise[0] * gauss(), start.y + noise[1] * gauss(), start.theta + noise[2] * gauss());
        let mut fusion = Fusion::new(&g, COUNTS_PER_RAD, self.options, Estimate::new(told, noise));
        let mut truth = start;
        let mut angles = [0.0; 3];
        let mut outcome = Outcome::default();
        for k in 0..(seconds / TICK) as usize {
            let t = k as f64 * TICK;
            if k > 0 {
                let twist = Twist::new((0.7 * t).sin(), 0.8 * (0.9 * t).cos(), 2.0 * (0.3 * t).sin()).scaled(TICK);
                let turned: Vec<f64> = g
                    .wheel_speeds(twist)
                    .iter()
                    .map(|w| w + gauss() * (self.options.wheel_variance * w.abs()).sqrt())
                    .collect();
                truth = truth.advance(g.twist(&turned), 1.0);
                for (angle, w) in angles.iter_mut().zip(g.wheel_speeds(twist)) {
                    *angle += w;
                }
            }
            fusion.predict(t, &angles.map(|a| (a * COUNTS_PER_RAD).round() as i64));
            if let Some(seen) = camera.observe(t, truth).filter(|_| !blind(t)) {
                match fusion.correct(t, seen) {
                    Correction::Accepted(nis) => outcome.nis.push(nis),
                    Correction::Refused(_) | Correction::Restarted => outcome.refused += 1,
                    Correction::Unusable => {}
                }
                let e = fusion.estimate();
                let d = Vector3::new(truth.x - e.pose.x, truth.y - e.pose.y, wrap_angle(truth.theta - e.pose.theta));
                outcome.nees.push((d.transpose() * e.covariance.try_inverse().unwrap() * d)[0]);
            }
            outcome.error.push(truth.distance(fusion.pose()));
            outcome.claimed.push(fusion.estimate().covariance[(0, 0)].sqrt());
        }
        outcome
    }
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

fn rms(values: &[f64]) -> f64 {
    mean(&values.iter().map(|v| v * v).collect::<Vec<_>>()).sqrt()
}

#[test]
fn innovations_are_consistent_with_and_without_latency() {
    for latency in [0.0, 0.0705] {
        let outcome = drive(latency, 11).run(60.0, |_| false);
        let n = outcome.nis.len() as f64;
        // The mean of n χ² of three degrees of freedom: 3 ± 3·√(6/n).
        let bound = 3.0 * (6.0 / n).sqrt();
        assert!((mean(&outcome.nis) - 3.0).abs() < bound, "NIS {} ± {bound}", mean(&outcome.nis));
        // Errors of the estimate are correlated over time: a wider bound.
        assert!((mean(&outcome.nees) - 3.0).abs() < 0.6, "NEES {}", mean(&outcome.nees));
        assert!(outcome.refused < 12, "{}", outcome.refused);
    }
}

#[test]
fn ignoring_the_latency_is_noticed() {
    let mut late = drive(0.05, 11);
    late.options.latency_s = 0.0;
    let outcome = late.run(20.0, |_| false);
    assert!(outcome.refused as f64 > 0.2 * outcome.nis.len() as f64, "{} refused", outcome.refused);
}

#[test]
fn fusion_is_better_than_a_frame_and_outliers_do_not_get_in() {
    let mut d = drive(0.03, 5);
    d.camera.drop_share = 0.2;
    d.camera.outlier_share = 0.1;
    let outcome = d.run(30.0, |_| false);
    let error = rms(&outcome.error);
    // A single frame errs by √2 · 1.5 mm, were it not late on top.
    assert!(error < 0.0021, "{error}");
    let frames = outcome.nis.len() + outcome.refused;
    assert!((outcome.refused as f64 / frames as f64 - 0.1).abs() < 0.03);
    assert!((mean(&outcome.nis) - 3.0).abs() < 0.3, "{}", mean(&outcome.nis));
}

#[test]
fn seconds_without_a_camera_are_survived_and_admitted() {
    let outcome = drive(0.0, 21).run(20.0, |t| (8.0..13.0).contains(&t));
    let worst = outcome.error[8000..13_000].iter().copied().fold(0.0, f64::max);
    let claimed = outcome.claimed[12_990];
    assert!(claimed > 5.0 * outcome.claimed[7990], "the covariance grows: {claimed}");
    assert!(worst < 4.0 * claimed, "{worst} against {claimed}");
    assert!(rms(&outcome.error[14_000..]) < 0.003, "{}", rms(&outcome.error[14_000..]));
    assert!(outcome.refused < 6);
}

#[test]
fn a_robot_carried_away_is_found_again() {
    let g = Geometry::rac(0.0275, 0.085, [0.0; 3]).unwrap();
    let options = FusionOptions { latency_s: 0.02, ..FusionOptions::of(&Robot::racbot()) };
    let mut fusion = Fusion::new(&g, 1e3, options, Estimate::new(Pose::default(), [0.001; 3]));
    let elsewhere = Pose::new(2.0, 1.0, -1.0);
    let mut verdicts = Vec::new();
    for k in 0..1000_u32 {
        let t = f64::from(k) * TICK;
        fusion.predict(t, &[0; 3]);
        if k % 10 == 0 {
            verdicts.push(fusion.correct(t, elsewhere));
        }
    }
    assert!(verdicts.contains(&Correction::Restarted));
    assert!(fusion.pose().distance(elsewhere) < 1e-6, "{:?}", fusion.pose());
    assert_eq!(verdicts[0], Correction::Unusable, "exposed before the filter began");
    assert_eq!(fusion.correct(1.0, Pose::new(f64::NAN, 0.0, 0.0)), Correction::Unusable);
}

/// Pictures that are matched to the belief of their own moment and come late, one of them while the next is already
/// matched: the filter ends where it would have, had each come alone and at once.
#[test]
fn a_late_match_counts_its_prediction_once() {
    let g = Geometry::rac(0.0275, 0.085, [0.0; 3]).unwrap();
    let options = FusionOptions::of(&Robot::racbot()).uncalibrated();
    let start = Estimate::new(Pose::new(0.4, 0.3, 0.2), [0.04, 0.05, 0.03]);
    let counts = |k: usize| [k as i64 * 9, k as i64 * -3, k as i64 * -5];
    // Picture, its sight of a line along y, and of the heading; taken at ticks 20 and 40.
    let sights = [(20, Pose::new(0.41, 0.0, 0.21)), (40, Pose::new(0.43, 0.0, 0.20))];
    let noise = Matrix3::from_diagonal(&Vector3::new(4e-4, 100.0, 2.5e-4));
    let alone = |seen: Pose, t: f64| Measurement { covariance: Some(noise), taken: Some(t), ..seen.into() };
    let (mut at_once, mut late) =
        (Fusion::new(&g, COUNTS_PER_RAD / 1e3, options, start), Fusion::new(&g, COUNTS_PER_RAD / 1e3, options, start));
    let mut found = Vec::new();
    for k in 0..100 {
        let t = k as f64 * TICK;
        at_once.predict(t, &counts(k));
        late.predict(t, &counts(k));
        if let Some((_, seen)) = sights.iter().find(|(tick, _)| *tick == k) {
            // The match: the belief of now, corrected as a filter would.
            let belief = late.estimate();
            let mut by_match = Fusion { history: VecDeque::new(), now: belief, ..late.clone() };
            by_match.predict(t, &counts(k));
            by_match.correct(t, alone(*seen, t));
            found.push(Measurement::posterior(by_match.estimate(), belief, t));
            assert!(matches!(at_once.correct(t, alone(*seen, t)), Correction::Accepted(_)));
        }
        if k == 60 || k == 75 {
            let verdict = late.correct(t, found[usize::from(k == 75)]);
            assert!(matches!(verdict, Correction::Accepted(_)), "{verdict:?}");
        }
    }
    let (a, b) = (at_once.estimate(), late.estimate());
    let off = Vector3::new(a.pose.x - b.pose.x, a.pose.y - b.pose.y, a.pose.theta - b.pose.theta);
    // The match was linearised at an older belief: the difference is of second order.
    assert!(off.norm() < 2e-4, "{off:?}");
    assert!((a.covariance - b.covariance).norm() < 0.01 * a.covariance.norm(), "{a:?} {b:?}");
    assert!(a.covariance[(0, 0)].sqrt() < 0.02 && a.covariance[(1, 1)].sqrt() > 0.04, "{a:?}");
    let old = Measurement { taken: Some(0.099 - 2.0 * MEMORY_S), ..Pose::default().into() };
    assert_eq!(late.correct(0.099, old), Correction::Unusable);
}
