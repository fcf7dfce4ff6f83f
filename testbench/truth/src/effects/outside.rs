//! Effects that no catalogue lists, to see what a workflow says when none of its names is right.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::{Entry, Found, Hand, Link};
use crate::disturbance::{Disturbance, Hit};

const fn entry(
    name: &'static str,
    link: Link,
    sizes: [f64; 5],
    meaning: &'static str,
    hide: fn(&mut Hand<'_>) -> Found,
) -> Entry {
    Entry { name, link, sizes, meaning, hide }
}

/// Every effect outside the catalogue.
pub fn outside() -> impl Iterator<Item = &'static Entry> {
    OUTSIDE.iter()
}

/// All effects outside the catalogue.
const OUTSIDE: &[Entry] = &[
    entry(
        "heading-rub",
        Link::Drive,
        [0.006, 0.010, 0.016, 0.025, 0.04],
        "torque_nm on one wheel, three maxima per turn of the robot",
        |hand| {
            let (wheel, phase_rad) = (hand.wheel(), hand.angle());
            let disturbance = Disturbance::HeadingRub { wheel, torque_nm: hand.value, harmonic: 3.0, phase_rad };
            hand.machine.disturbances.push(disturbance);
            Found::on([wheel], [("torque_nm", hand.value), ("harmonic", 3.0), ("phase_rad", phase_rad)])
        },
    ),
    entry(
        "late-sticking",
        Link::Drive,
        [0.006, 0.010, 0.016, 0.025, 0.04],
        "torque_nm on one wheel from onset_s on, in every run",
        |hand| {
            let (wheel, onset_s) = (hand.wheel(), hand.rng.random_range(3.0..4.5));
            hand.machine.disturbances.push(Disturbance::Sticking { wheel, torque_nm: hand.value, onset_s });
            Found::on([wheel], [("torque_nm", hand.value), ("onset_s", onset_s)])
        },
    ),
    entry(
        "cable-pull",
        Link::Drive,
        [0.3, 0.6, 1.0, 1.8, 3.0],
        "stiffness_n_per_m beyond a slack of 0.15 m from an anchor near the start",
        |hand| {
            let (sin, cos) = hand.angle().sin_cos();
            let away = hand.rng.random_range(0.0..0.4);
            let anchor_m = [away * cos, away * sin];
            let (slack_m, stiffness_n_m) = (0.15, hand.value);
            hand.machine.disturbances.push(Disturbance::CablePull { anchor_m, slack_m, stiffness_n_m });
            Found::whole([
                ("stiffness_n_per_m", hand.value),
                ("slack_m", slack_m),
                ("anchor_x_m", anchor_m[0]),
                ("anchor_y_m", anchor_m[1]),
            ])
        },
    ),
    entry(
        "periodic-torque",
        Link::Drive,
        [0.004, 0.008, 0.014, 0.022, 0.035],
        "torque_nm (amplitude) at frequency_hz in time on one wheel",
        |hand| {
            let (wheel, phase_rad) = (hand.wheel(), hand.angle());
            let frequency_hz = hand.rng.random_range(1.5..9.0);
            let disturbance = Disturbance::PeriodicTorque { wheel, torque_nm: hand.value, frequency_hz, phase_rad };
            hand.machine.disturbances.push(disturbance);
            Found::on([wheel], [("torque_nm", hand.value), ("frequency_hz", frequency_hz)])
        },
    ),
    entry(
        "collisions",
        Link::Drive,
        [2.0, 4.0, 7.0, 12.0, 20.0],
        "force_n of pushes lasting 0.08 s, 2 to 4 a run",
        |hand| {
            let count = hand.rng.random_range(2..=4);
            let disturbance = Disturbance::Collisions { force_n: hand.value, duration_s: 0.08, count };
            hand.machine.disturbances.push(disturbance);
            Found::whole([("force_n", hand.value), ("duration_s", 0.08), ("count", count as f64)])
        },
    ),
    entry(
        "rough-patch",
        Link::Drive,
        [0.4, 0.8, 1.4, 2.2, 3.5],
        "force_n of dry drag wherever world x is beyond edge_m",
        |hand| {
            let edge_m = hand.rng.random_range(-0.2..0.2);
            hand.machine.disturbances.push(Disturbance::RoughPatch { edge_m, force_n: hand.value });
            Found::whole([("force_n", hand.value), ("edge_m", edge_m)])
        },
    ),
    entry(
        "camera-speed-delay",
        Link::Motion,
        [0.008, 0.016, 0.03, 0.06, 0.12],
        "delay_s2_per_m: camera latency per speed of the robot",
        |hand| {
            hand.machine.camera.latency_per_speed = hand.value;
            Found::whole([("delay_s2_per_m", hand.value)])
        },
    ),
    entry(
        "camera-drift",
        Link::Motion,
        [0.001, 0.002, 0.005, 0.012, 0.03],
        "length of (x_m_per_s, y_m_per_s): the camera mount sags steadily",
        |hand| {
            let (sin, cos) = hand.angle().sin_cos();
            let drift = [hand.value * cos, hand.value * sin];
            hand.machine.camera.creep_m_s = drift;
            Found::whole([("x_m_per_s", drift[0]), ("y_m_per_s", drift[1])])
        },
    ),
    entry(
        "camera-freeze",
        Link::Motion,
        [0.03, 0.06, 0.12, 0.20, 0.35],
        "frozen: fraction of frames that repeat the one before",
        |hand| {
            hand.machine.camera.frozen = hand.value;
            Found::whole([("frozen", hand.value)])
        },
    ),
];

/// The pushes of one run of `seconds` s.
pub(crate) fn draw_hits(disturbances: &[Disturbance], seconds: f64, rng: &mut ChaCha8Rng) -> Vec<Hit> {
    let mut hits = Vec::new();
    for disturbance in disturbances {
        let Disturbance::Collisions { force_n, duration_s, count } = *disturbance else { continue };
        for _ in 0..count {
            let start_s = rng.random_range(0.6..(seconds - 0.6).max(0.7));
            let (sin, cos) = rng.random_range(0.0..std::f64::consts::TAU).sin_cos();
            hits.push(Hit {
                start_s,
                end_s: start_s + duration_s,
                force_n: [force_n * cos, force_n * sin],
                moment_nm: force_n * rng.random_range(-0.06..0.06),
            });
        }
    }
    hits
}
