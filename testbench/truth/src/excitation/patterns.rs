//! The shapes of the excitations.

use std::f64::consts::{PI, TAU};

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::{COMMAND_PERIOD_S, Pattern};

/// Rest at both ends, s.
const REST_S: f64 = 0.2;

/// Commands of `seconds` s; the pattern itself lies between the two rests.
pub(super) fn commands(pattern: Pattern, seconds: f64, rng: &mut ChaCha8Rng) -> Vec<[f64; 3]> {
    let count = (seconds / COMMAND_PERIOD_S).round() as usize;
    let active = seconds - 2.0 * REST_S - COMMAND_PERIOD_S;
    let shape: Box<dyn Fn(f64) -> [f64; 3]> = match pattern {
        Pattern::Lines => Box::new(lines(active, rng)),
        Pattern::Square => Box::new(square(active, rng)),
        Pattern::Circle => Box::new(circle(active, rng)),
        Pattern::Rotation => Box::new(rotation(active, rng)),
        Pattern::Sweep => Box::new(sweep(active, rng)),
        Pattern::Multisine => Box::new(multisine(active, rng)),
        Pattern::StopAndGo => Box::new(steps(active, rng, 0.4..1.0)),
        Pattern::GoHard => Box::new(steps(active, rng, 0.8..1.7)),
        Pattern::Creep => Box::new(creep(active, rng)),
    };
    (0..count)
        .map(|k| {
            let time = k as f64 * COMMAND_PERIOD_S - REST_S;
            if (1e-9..active).contains(&time) { shape(time) } else { [0.0; 3] }
        })
        .collect()
}

/// A trapezoid of unit height over unit time that rises and falls during `ramp` each.
fn trapezoid(part: f64, ramp: f64) -> f64 {
    (part.min(1.0 - part) / ramp).clamp(0.0, 1.0)
}

fn sign(rng: &mut ChaCha8Rng) -> f64 {
    if rng.random_bool(0.5) { 1.0 } else { -1.0 }
}

/// Out and back along straight lines in three or four directions.
fn lines(active: f64, rng: &mut ChaCha8Rng) -> impl Fn(f64) -> [f64; 3] + use<> {
    let legs = rng.random_range(3..=4);
    let first = rng.random_range(0.0..TAU);
    let legs: Vec<(f64, f64)> = (0..legs)
        .map(|i| {
            let direction = first + PI * f64::from(i) / f64::from(legs) + rng.random_range(-0.25..0.25);
            (direction, rng.random_range(0.35..0.7))
        })
        .collect();
    let ramp = rng.random_range(0.35..0.5);
    move |time| {
        let place = time / active * legs.len() as f64;
        let (direction, peak) = legs[(place as usize).min(legs.len() - 1)];
        let part = place.fract() * 2.0;
        let speed = if part < 1.0 { peak * trapezoid(part, ramp) } else { -peak * trapezoid(part - 1.0, ramp) };
        [speed * direction.cos(), speed * direction.sin(), 0.0]
    }
}

/// Four legs at right angles.
fn square(active: f64, rng: &mut ChaCha8Rng) -> impl Fn(f64) -> [f64; 3] + use<> {
    let first = rng.random_range(0.0..TAU);
    let turn = sign(rng) * PI / 2.0;
    let peak = rng.random_range(0.4..0.8);
    let spin = sign(rng) * rng.random_range(0.3..0.9);
    move |time| {
        let place = time / active * 4.0;
        let direction = first + turn * place.floor();
        let speed = peak * trapezoid(place.fract(), 0.45);
        let spin = spin * trapezoid(place.fract(), 0.15);
        [speed * direction.cos(), speed * direction.sin(), spin]
    }
}

/// One circle with fixed heading and one with the heading turning.
fn circle(active: f64, rng: &mut ChaCha8Rng) -> impl Fn(f64) -> [f64; 3] + use<> {
    let speed = [rng.random_range(0.4..0.85), rng.random_range(0.4..0.85)];
    let turn = [sign(rng) * rng.random_range(1.5..2.6), 0.0];
    let spin = [0.0, sign(rng) * rng.random_range(1.2..2.4)];
    let first = [rng.random_range(0.0..TAU), rng.random_range(0.0..TAU)];
    move |time| {
        let place = (time / active * 2.0).min(1.999);
        let half = place as usize;
        let envelope = trapezoid(place.fract(), 0.28);
        let direction = first[half] + turn[half] * (time - half as f64 * active / 2.0);
        let speed = speed[half] * envelope;
        [speed * direction.cos(), speed * direction.sin(), spin[half] * envelope]
    }
}

/// Turns to both sides on the spot.
fn rotation(active: f64, rng: &mut ChaCha8Rng) -> impl Fn(f64) -> [f64; 3] + use<> {
    let side = sign(rng);
    let peaks: Vec<f64> =
        (0..4).map(|i| side * if i % 2 == 0 { 1.0 } else { -1.0 } * rng.random_range(3.5..6.6)).collect();
    let ramp = rng.random_range(0.25..0.4);
    move |time| {
        let place = time / active * 4.0;
        [0.0, 0.0, peaks[(place as usize).min(3)] * trapezoid(place.fract(), ramp)]
    }
}

/// A chirp in every freedom, fading as it gets faster.
fn sweep(active: f64, rng: &mut ChaCha8Rng) -> impl Fn(f64) -> [f64; 3] + use<> {
    let axes: [[f64; 4]; 3] = [0, 1, 2].map(|k| {
        let size = if k == 2 { rng.random_range(1.8..3.0) } else { rng.random_range(0.35..0.5) };
        [size, rng.random_range(0.2..0.5), rng.random_range(1.3..2.2), rng.random_range(0.0..TAU)]
    });
    move |time| {
        let part = time / active;
        let fade = (1.0 - 0.65 * part) * (time / 0.3).min(1.0) * ((active - time) / 0.2).min(1.0);
        axes.map(|[size, slow, fast, phase]| {
            size * fade * (phase + TAU * time * (slow + 0.5 * (fast - slow) * part)).sin()
        })
    }
}

/// Three sines in every freedom.
fn multisine(active: f64, rng: &mut ChaCha8Rng) -> impl Fn(f64) -> [f64; 3] + use<> {
    let axes: [[[f64; 3]; 3]; 3] = [0, 1, 2].map(|axis| {
        let size = if axis == 2 { rng.random_range(0.6..1.1) } else { rng.random_range(0.12..0.2) };
        [0.25, 0.6, 1.2].map(|frequency| [size, frequency * rng.random_range(0.8..1.25), rng.random_range(0.0..TAU)])
    });
    move |time| {
        let fade = (time / 0.3).min(1.0) * ((active - time) / 0.3).min(1.0);
        axes.map(|sines| {
            let sum: f64 =
                sines.iter().map(|[size, frequency, phase]| size * (phase + TAU * frequency * time).sin()).sum();
            fade * sum
        })
    }
}

/// Steps to drawn velocities with rests between; some also turn.
fn steps(active: f64, rng: &mut ChaCha8Rng, speeds: std::ops::Range<f64>) -> impl Fn(f64) -> [f64; 3] + use<> {
    let mut legs: Vec<(f64, f64, [f64; 3])> = Vec::new();
    let mut start = 0.0;
    while start < active - 0.5 {
        let go = rng.random_range(0.4..0.75);
        let rest = rng.random_range(0.2..0.45);
        let direction = rng.random_range(0.0..TAU);
        let speed = rng.random_range(speeds.clone());
        let spin = if rng.random_bool(0.35) { sign(rng) * rng.random_range(0.3..2.1) } else { 0.0 };
        legs.push((start, (start + go).min(active - 0.1), [speed * direction.cos(), speed * direction.sin(), spin]));
        start += go + rest;
    }
    move |time| {
        legs.iter().find(|(from, to, _)| (*from..*to).contains(&time)).map_or([0.0; 3], |(_, _, velocity)| *velocity)
    }
}

/// Slow triangles of speed along drawn directions and about the vertical axis.
fn creep(active: f64, rng: &mut ChaCha8Rng) -> impl Fn(f64) -> [f64; 3] + use<> {
    let legs: Vec<[f64; 3]> = (0..6)
        .map(|i| {
            let direction = rng.random_range(0.0..TAU);
            let speed = rng.random_range(0.02..0.08);
            let spin = if i % 3 == 2 { sign(rng) * rng.random_range(0.2..0.6) } else { 0.0 };
            [speed * direction.cos(), speed * direction.sin(), spin]
        })
        .collect();
    move |time| {
        let place = time / active * 6.0;
        let leg = legs[(place as usize).min(5)];
        let wave = (TAU * place.fract()).sin();
        leg.map(|v| v * wave)
    }
}
