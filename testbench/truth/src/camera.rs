//! The overhead camera: when it looks, what it sees, what it says.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use crate::geometry::wrap;
use crate::machine::Camera;
use crate::noise::normal;
use crate::record::Track;

/// One camera sample in the log.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Row of the log in which it stands.
    pub tick: usize,
    /// x, y (m) and θ (rad, wrapped).
    pub pose: [f64; 3],
}

/// All frames of a run of `ticks` ticks; the first capture lies anywhere within the first frame period.
pub(crate) fn film(camera: &Camera, track: &Track, rate_hz: f64, ticks: usize, rng: &mut ChaCha8Rng) -> Vec<Frame> {
    let mut frames: Vec<Frame> = Vec::new();
    let period = 1.0 / camera.rate_hz;
    let end = ticks as f64 / rate_hz;
    let mut capture = period * rng.random::<f64>();
    while capture < end {
        let stamp = capture * (1.0 + camera.clock_drift) + camera.stamp_jitter_s * normal(rng);
        let mut pose = see(camera, track, capture, rng);
        if camera.frozen > 0.0 && rng.random_bool(camera.frozen.min(1.0)) {
            pose = frames.last().map_or(pose, |last| last.pose);
        }
        let arrives = camera.dropped == 0.0 || !rng.random_bool(camera.dropped.clamp(0.0, 1.0));
        let tick = (stamp * rate_hz).round();
        capture += period;
        if !arrives || tick < 0.0 || tick as usize >= ticks {
            continue;
        }
        let tick = tick as usize;
        if frames.last().is_none_or(|last| last.tick < tick) {
            frames.push(Frame { tick, pose });
        }
    }
    frames
}

/// The pose that a frame captured at `time` reports.
fn see(camera: &Camera, track: &Track, time: f64, rng: &mut ChaCha8Rng) -> [f64; 3] {
    let mut age = camera.latency_s;
    if camera.latency_per_speed != 0.0 {
        age += camera.latency_per_speed * track.speed(time);
    }
    let [mut x, mut y, theta] = track.pose(time - age);
    let (sin, cos) = theta.sin_cos();
    let [ox, oy] = camera.marker_offset_m;
    x += cos * ox - sin * oy;
    y += sin * ox + cos * oy;
    let stretch = (1.0 + camera.scale) * (1.0 + camera.lens_per_m2 * (x * x + y * y));
    x = x * stretch + camera.creep_m_s[0] * time;
    y = y * stretch + camera.creep_m_s[1] * time;
    [
        x + camera.noise_m * normal(rng),
        y + camera.noise_m * normal(rng),
        wrap(theta + camera.marker_heading_rad + camera.noise_rad * normal(rng)),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::machine::Machine;
    use crate::noise::{Stream, stream};
    use crate::robot::Robot;

    fn moving_track() -> Track {
        let mut track = Track::new(0.001);
        for k in 0..=2000 {
            let t = f64::from(k) * 0.001;
            track.push([0.5 * t, 0.0, 2.0 * t], &[]);
        }
        track
    }

    #[test]
    fn noise_has_the_stated_deviation_and_latency_shows_the_past() {
        let robot = Robot::standard();
        let mut camera = Machine::ideal(&robot).camera;
        camera.rate_hz = 1000.0;
        camera.noise_m = 0.0015;
        camera.noise_rad = 0.0087;
        camera.latency_s = 0.07;
        let mut rng = stream(3, Stream::Camera(0));
        let frames = film(&camera, &moving_track(), 1000.0, 2000, &mut rng);
        let late: Vec<&Frame> = frames.iter().filter(|f| f.tick > 100).collect();
        let count = late.len() as f64;
        let error = |f: &&Frame| f.pose[0] - 0.5 * (f.tick as f64 / 1000.0 - 0.07);
        let mean = late.iter().map(error).sum::<f64>() / count;
        let deviation = (late.iter().map(|f| (error(f) - mean).powi(2)).sum::<f64>() / count).sqrt();
        assert!(mean.abs() < 0.0005, "mean {mean}");
        assert!((deviation - 0.0015).abs() < 0.0001, "deviation {deviation}");
        let turn = |f: &&Frame| wrap(f.pose[2] - 2.0 * (f.tick as f64 / 1000.0 - 0.07));
        let spread = (late.iter().map(|f| turn(f).powi(2)).sum::<f64>() / count).sqrt();
        assert!((spread - 0.0087).abs() < 0.0006, "turn {spread}");
    }

    #[test]
    fn stamps_lie_on_a_sixty_hertz_grid_rounded_to_ticks() {
        let camera = Machine::ideal(&Robot::standard()).camera;
        let frames = film(&camera, &moving_track(), 1000.0, 2000, &mut stream(4, Stream::Camera(0)));
        assert!((119..=121).contains(&frames.len()));
        assert!(frames.windows(2).all(|w| (16..=17).contains(&(w[1].tick - w[0].tick))));
    }

    #[test]
    fn marker_scale_and_lens_move_what_is_seen() {
        let mut track = Track::new(0.001);
        track.push([0.3, 0.4, 0.5], &[]);
        let camera = Machine::ideal(&Robot::standard()).camera;
        let seen = |change: fn(&mut Camera)| {
            let mut changed = camera.clone();
            change(&mut changed);
            see(&changed, &track, 2.0, &mut stream(5, Stream::Camera(0)))
        };
        let close = |pose: [f64; 3], expected: [f64; 3]| {
            assert!(pose.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12), "{pose:?} instead of {expected:?}");
        };
        let (sin, cos) = 0.5_f64.sin_cos();
        close(seen(|_| {}), [0.3, 0.4, 0.5]);
        close(seen(|c| c.marker_heading_rad = 0.1), [0.3, 0.4, 0.6]);
        close(
            seen(|c| c.marker_offset_m = [0.01, 0.02]),
            [0.3 + 0.01 * cos - 0.02 * sin, 0.4 + 0.01 * sin + 0.02 * cos, 0.5],
        );
        close(seen(|c| c.scale = 0.1), [0.33, 0.44, 0.5]);
        close(seen(|c| c.lens_per_m2 = 0.2), [0.315, 0.42, 0.5]);
        close(seen(|c| c.creep_m_s = [0.01, -0.01]), [0.32, 0.38, 0.5]);
    }
}
