//! Effects in the computer: commands, controller, stamps.

use super::{Entry, Found, Hand, Link};
use rand::RngExt;

const fn entry(
    name: &'static str,
    link: Link,
    sizes: [f64; 5],
    meaning: &'static str,
    hide: fn(&mut Hand<'_>) -> Found,
) -> Entry {
    Entry { name, link, sizes, meaning, hide }
}

pub(super) const CONTROL: &[Entry] = &[
    entry(
        "command-latency",
        Link::Command,
        [0.002, 0.005, 0.010, 0.03, 0.08],
        "latency_s from the logged command to the set point",
        |hand| {
            // Set points change on ticks, so the true delay is a whole number of them.
            let rate = hand.robot.control_rate_hz;
            let latency = (hand.value * rate).round().max(1.0) / rate;
            hand.machine.controller.command_latency_s = latency;
            Found::whole([("latency_s", latency)])
        },
    ),
    entry(
        "wheel-order",
        Link::Command,
        [1.0; 5],
        "axis_i: which row makes set point i (variant 0), or cable_i: which wheel axis i drives and counts (variant 1); \
         negative = inverted",
        wheel_order,
    ),
    entry("pi-gain", Link::Controller, [0.01, 0.03, 0.08, 0.20, 0.45], "kp_scale, ki_scale (relative)", |hand| {
        let (mut kp, mut ki) = (0.0, 0.0);
        match hand.rng.random_range(0..3) {
            0 => kp = hand.signed(),
            1 => ki = hand.signed(),
            _ => {
                kp = hand.signed();
                ki = hand.signed();
            }
        }
        hand.machine.controller.kp *= 1.0 + kp;
        hand.machine.controller.ki *= 1.0 + ki;
        Found::whole([("kp_scale", kp), ("ki_scale", ki)])
    }),
    entry(
        "integrator-windup",
        Link::Controller,
        [0.6, 0.8, 1.1, 1.6, 3.0],
        "limit_duty: the integrator is not held at saturation but stops at this value",
        |hand| {
            hand.machine.controller.windup_limit = Some(hand.value);
            Found::whole([("limit_duty", hand.value)])
        },
    ),
    entry(
        "quantisation",
        Link::Controller,
        [0.002, 0.004, 0.008, 0.02, 0.05],
        "duty_quantum: the bridge takes coarser duties than stated",
        |hand| {
            hand.machine.controller.duty_quantum = hand.value;
            Found::whole([("duty_quantum", hand.value)])
        },
    ),
    entry(
        "sample-order",
        Link::Controller,
        [1.0, 1.0, 1.0, 2.0, 2.0],
        "shift_ticks: counts (signal 0) or set points (signal 1) used are this many ticks older than the logged ones",
        |hand| {
            let ticks = usize::from(hand.level / 4) + 1;
            let signal = f64::from(u8::from(hand.rng.random_bool(0.5)));
            if signal == 0.0 {
                hand.machine.controller.enc_age_ticks = ticks;
            } else {
                hand.machine.controller.ref_age_ticks = ticks;
            }
            Found::whole([("shift_ticks", ticks as f64), ("signal", signal)])
        },
    ),
    entry(
        "camera-timing",
        Link::Timing,
        [0.0015, 0.0025, 0.004, 0.006, 0.010],
        "jitter_s: standard deviation of the stamps about the capture times, at sizes 4 and 5 frames are lost too \
         (dropped, a fraction); in one case of three instead drift: the stamping clock runs faster by 0.3/s of the size",
        camera_timing,
    ),
];

/// Two axes exchanged or one inverted, in the matrix or in the cables.
fn wheel_order(hand: &mut Hand<'_>) -> Found {
    let count = hand.machine.wheels.len();
    let mut order: Vec<i32> = hand.machine.controller.row_of_ref.clone();
    let first = hand.wheel();
    let wheels = if hand.rng.random_bool(0.6) {
        let second = (first + hand.rng.random_range(1..count.max(2))) % count;
        order.swap(first, second);
        vec![first.min(second), first.max(second)]
    } else {
        order[first] = -order[first];
        vec![first]
    };
    let in_cables = hand.rng.random_bool(0.4);
    let mut found = Found::on(wheels, [("variant", f64::from(u8::from(in_cables)))]);
    let stem = if in_cables { "cable" } else { "axis" };
    for (axis, row) in order.iter().enumerate() {
        found = found.with(format!("{stem}_{}", axis + 1), f64::from(*row));
    }
    if in_cables {
        hand.machine.controller.wheel_of_axis = order;
    } else {
        hand.machine.controller.row_of_ref = order;
    }
    found
}

/// Stamps that scatter, or a clock that runs wrong.
fn camera_timing(hand: &mut Hand<'_>) -> Found {
    if hand.rng.random_bool(1.0 / 3.0) {
        let drift = 0.3 * hand.signed();
        hand.machine.camera.clock_drift = drift;
        return Found::whole([("drift", drift)]);
    }
    let dropped = if hand.level >= 4 { hand.rng.random_range(0.05..0.2) } else { 0.0 };
    hand.machine.camera.stamp_jitter_s = hand.value;
    hand.machine.camera.dropped = dropped;
    Found::whole([("jitter_s", hand.value), ("dropped", dropped)])
}
