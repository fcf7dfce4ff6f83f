//! A gyroscope and an accelerometer in the chassis centre: what they feel, and the errors of a good part.

use rand_chacha::ChaCha8Rng;

use crate::machine::Machine;
use crate::noise::{Stream, normal, stream};
use crate::plant::GRAVITY;
use crate::record::Track;

/// Half the time over which speeds change, s: a sensor's bandwidth of some 250 Hz.
const HALF_S: f64 = 1.0e-3;
/// Standard deviations over all parts of a type: relative scale, bias of the gyroscope (rad/s) and of the accelerometer
/// (m/s²), angle of its axes (rad).
const SCALE: f64 = 0.004;
const BIAS: [f64; 2] = [0.006, 0.12];
const ANGLE: f64 = 0.007;
/// Noise of a reading at 1 kHz: rad/s, m/s²; and what rollers shake, m/s² per m/s.
const NOISE: [f64; 2] = [1.2e-3, 0.016];
const SHAKES: f64 = 0.25;
/// A digit: rad/s at 2000 °/s and m/s² at 16 g in 16 bits.
const DIGIT: [f64; 2] = [1.065e-3, 4.79e-3];

/// Rate of turn (rad/s) and specific force to the right and forward (m/s²), one a tick of a run.
pub(crate) fn felt(
    machine: &Machine,
    track: &Track,
    rate_hz: f64,
    ticks: usize,
    (seed, number): (u64, u32),
) -> Vec<[f64; 3]> {
    let mut part = stream(seed, Stream::Part);
    let mut drawn = |sd: f64| sd * normal(&mut part);
    let scale = [drawn(SCALE), drawn(SCALE), drawn(SCALE)];
    let bias = [drawn(BIAS[0]), drawn(BIAS[1]), drawn(BIAS[1])];
    let (sin, cos) = drawn(ANGLE).sin_cos();
    let mut rng = stream(seed, Stream::Inertial(number));
    let read = |tick: usize, rng: &mut ChaCha8Rng| {
        let time = tick as f64 / rate_hz;
        let [spin, x, y] = motion(machine, track, time);
        let shakes = NOISE[1].hypot(SHAKES * track.speed(time));
        let axes = [spin, cos * x + sin * y, cos * y - sin * x];
        [0, 1, 2].map(|i| {
            let kind = usize::from(i > 0);
            let noise = if i > 0 { shakes } else { NOISE[0] };
            let value = (1.0 + scale[i]) * axes[i] + bias[i] + noise * normal(rng);
            (value / DIGIT[kind]).round() * DIGIT[kind]
        })
    };
    (0..ticks).map(|tick| read(tick, &mut rng)).collect()
}

/// What an exact sensor feels: nothing of gravity but what a tilted floor turns into its plane, and that upwards.
fn motion(machine: &Machine, track: &Track, time: f64) -> [f64; 3] {
    let time = time.max(HALF_S);
    let [before, now, after] = [-HALF_S, 0.0, HALF_S].map(|by| track.pose(time + by));
    let change = |i: usize| (after[i] - 2.0 * now[i] + before[i]) / (HALF_S * HALF_S);
    let [right, forward] = machine.ground.tilt_rad.map(|tilt| GRAVITY * tilt);
    let (x, y) = (change(0) - right, change(1) - forward);
    let (sin, cos) = now[2].sin_cos();
    [(after[2] - before[2]) / (2.0 * HALF_S), cos * x + sin * y, cos * y - sin * x]
}
