//! Effects between the counters and the camera.

use super::{Entry, Found, Hand, Link};
use rand::RngExt;

const fn entry(name: &'static str, sizes: [f64; 5], meaning: &'static str, hide: fn(&mut Hand<'_>) -> Found) -> Entry {
    Entry { name, link: Link::Motion, sizes, meaning, hide }
}

pub(super) const MOTION: &[Entry] = &[
    entry(
        "wheel-skew",
        [0.004, 0.010, 0.025, 0.06, 0.12],
        "skew_i_rad of the most skewed wheel (clockwise); the others lie between",
        wheel_skew,
    ),
    entry("wheel-radius", [0.003, 0.006, 0.012, 0.03, 0.06], "scale_i (relative) of one wheel", |hand| {
        let (wheel, scale) = (hand.wheel(), hand.signed());
        hand.machine.wheels[wheel].radius_m *= 1.0 + scale;
        Found::on([wheel], []).with(format!("scale_{}", wheel + 1), scale)
    }),
    entry("wheel-radius-common", [0.003, 0.006, 0.015, 0.03, 0.06], "scale (relative) of all wheels", |hand| {
        let scale = hand.signed();
        hand.machine.wheels.iter_mut().for_each(|wheel| wheel.radius_m *= 1.0 + scale);
        Found::whole([("scale", scale)])
    }),
    entry("body-radius", [0.004, 0.008, 0.02, 0.04, 0.08], "scale (relative)", |hand| {
        let scale = hand.signed();
        hand.machine.wheels.iter_mut().for_each(|wheel| wheel.mount.spread(1.0 + scale));
        Found::whole([("scale", scale)])
    }),
    entry("wheel-angle", [0.004, 0.010, 0.025, 0.06, 0.10], "angle_i_rad of one wheel (ccw)", |hand| {
        let (wheel, angle) = (hand.wheel(), hand.signed());
        hand.machine.wheels[wheel].mount.turn_about_centre(angle);
        Found::on([wheel], []).with(format!("angle_{}_rad", wheel + 1), angle)
    }),
    entry(
        "encoder-scale",
        [0.003, 0.006, 0.015, 0.03, 0.06],
        "scale (relative) of all encoders, or scale_i of one",
        encoder_scale,
    ),
    entry(
        "encoder-loss",
        [0.004, 0.008, 0.02, 0.05, 0.12],
        "loss_i (fraction of edges) of one wheel; in half the cases only above above_rad_s",
        |hand| {
            let wheel = hand.wheel();
            let above = if hand.rng.random_bool(0.5) { 0.0 } else { hand.rng.random_range(6.0..12.0) };
            hand.machine.wheels[wheel].encoder_loss = hand.value;
            hand.machine.wheels[wheel].loss_above_rad_s = above;
            Found::on([wheel], [("above_rad_s", above)]).with(format!("loss_{}", wheel + 1), hand.value)
        },
    ),
    entry("encoder-lag", [0.001, 0.002, 0.004, 0.008, 0.016], "lag_s of all counters", |hand| {
        hand.machine.power.encoder_lag_s = hand.value;
        Found::whole([("lag_s", hand.value)])
    }),
    entry("wheel-creep", [0.0008, 0.0015, 0.003, 0.006, 0.012], "creep_s_per_kg (slip speed per force)", |hand| {
        hand.machine.ground.creep_s_per_kg = hand.value;
        Found::whole([("creep_s_per_kg", hand.value)])
    }),
    entry("wheel-slip", [0.45, 0.36, 0.28, 0.20, 0.13], "friction_coefficient, all wheels", |hand| {
        hand.machine.ground.friction_static = hand.value;
        hand.machine.ground.friction_sliding = 0.9 * hand.value;
        Found::whole([("friction_coefficient", hand.value)])
    }),
    entry(
        "roller-ripple",
        [0.004, 0.008, 0.015, 0.03, 0.05],
        "amplitude (relative radius) with count ripples per turn, one wheel or all",
        roller_ripple,
    ),
    entry("camera-latency", [0.002, 0.005, 0.012, 0.03, 0.08], "latency_s beyond what is stated", |hand| {
        hand.machine.camera.latency_s += hand.value;
        Found::whole([("latency_s", hand.value)])
    }),
    entry("camera-scale", [0.003, 0.006, 0.012, 0.025, 0.05], "scale (relative)", |hand| {
        hand.machine.camera.scale = hand.signed();
        Found::whole([("scale", hand.machine.camera.scale)])
    }),
    entry("marker-heading", [0.004, 0.010, 0.025, 0.06, 0.15], "angle_rad (ccw)", |hand| {
        hand.machine.camera.marker_heading_rad = hand.signed();
        Found::whole([("angle_rad", hand.machine.camera.marker_heading_rad)])
    }),
    entry("marker-offset", [0.001, 0.002, 0.005, 0.012, 0.03], "length of (x_m, y_m), body frame", |hand| {
        let (sin, cos) = hand.angle().sin_cos();
        let offset = [hand.value * cos, hand.value * sin];
        hand.machine.camera.marker_offset_m = offset;
        Found::whole([("x_m", offset[0]), ("y_m", offset[1])])
    }),
    entry("lens-distortion", [0.003, 0.008, 0.02, 0.04, 0.10], "k1_per_m2 about the field's origin", |hand| {
        hand.machine.camera.lens_per_m2 = hand.signed();
        Found::whole([("k1_per_m2", hand.machine.camera.lens_per_m2)])
    }),
];

/// Every wheel skewed within ± the magnitude and one at it; in one case of four only that one.
fn wheel_skew(hand: &mut Hand<'_>) -> Found {
    let most = hand.wheel();
    let alone = hand.rng.random_bool(0.25);
    let mut found = Found::on(if alone { most..most + 1 } else { hand.every_wheel() }, []);
    for i in hand.every_wheel() {
        let skew = match (i == most, alone) {
            (true, _) => hand.signed(),
            (false, true) => 0.0,
            (false, false) => hand.value * hand.rng.random_range(-0.8..0.8),
        };
        hand.machine.wheels[i].mount.drive_rad -= skew;
        found = found.with(format!("skew_{}_rad", i + 1), skew);
    }
    found
}

/// All encoders (even odds) or one.
fn encoder_scale(hand: &mut Hand<'_>) -> Found {
    let wheels = hand.one_or_all();
    let scale = hand.signed();
    for &i in &wheels {
        hand.machine.wheels[i].encoder_scale = scale;
    }
    match wheels[..] {
        [only] => Found::on([only], []).with(format!("scale_{}", only + 1), scale),
        _ => Found::whole([("scale", scale)]),
    }
}

/// The rollers' polygon on one wheel or on all.
fn roller_ripple(hand: &mut Hand<'_>) -> Found {
    let wheels = hand.one_or_all();
    for &i in &wheels {
        hand.machine.wheels[i].ripple_amplitude = hand.value;
        hand.machine.wheels[i].ripple_phase_rad = hand.angle();
    }
    let count = hand.machine.wheels[wheels[0]].ripple_count;
    Found::on(wheels, [("amplitude", hand.value), ("count", count)])
}
