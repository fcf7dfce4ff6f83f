//! From a seed to a machine, its log and what it hides.

use rand::RngExt;
use rand::seq::IndexedRandom;
use rand_chacha::ChaCha8Rng;

use super::{Axis, AxisCase, Carrier, Logger, drives, effects};
use crate::error::Error;
use crate::noise::{Stream, stream};

/// Evenly on a logarithmic scale.
fn decades(rng: &mut ChaCha8Rng, low: f64, high: f64) -> f64 {
    rng.random_range(low.ln()..high.ln()).exp()
}

fn one_of(rng: &mut ChaCha8Rng, list: &[f64]) -> f64 {
    list.choose(rng).copied().unwrap_or(list[0])
}

/// A machine as its file has it.
fn machine(rng: &mut ChaCha8Rng) -> Axis {
    let supply_v = one_of(rng, &[3.7, 6.0, 7.4, 12.0, 24.0, 36.0, 48.0]);
    // 0.1 W to some kilowatts at the shaft, which is a quarter of the product of stall current and supply.
    let resistance_ohm = supply_v * supply_v / decades(rng, 0.4, 1.0e4);
    let constant = supply_v / decades(rng, 150.0, 1200.0);
    let gear = if rng.random_bool(0.25) { 1.0 } else { decades(rng, 2.0, 60.0) };
    let tau = decades(rng, 0.03, 1.0);
    let whole = gear * gear * constant * constant * tau / resistance_ohm;
    let own = decades(rng, 0.05, 0.7);
    let rotor = own * whole / (gear * gear);
    let stall = gear * constant * supply_v / resistance_ohm;
    let dry = decades(rng, 0.005, 0.04) * stall;
    Axis {
        supply_v,
        resistance_ohm,
        constant,
        gear,
        rotor,
        load: (1.0 - own) * whole,
        dry: [dry; 2],
        stribeck: [0.0, 1.0],
        viscous: 0.0,
        quadratic: 0.0,
        gravity: [0.0; 2],
        hanging: 0.0,
        cogging: [0.0; 2],
        dead_band: 0.0,
        curvature: 0.0,
        coasting: 0.0,
        limit_a: f64::INFINITY,
        latency_s: 0.0,
        source_ohm: 0.0,
    }
}

fn logger(axis: &Axis, speeds: bool, rng: &mut ChaCha8Rng) -> Logger {
    let tau = axis.time_constant();
    let fitting: Vec<f64> =
        [0.001, 0.002, 0.005, 0.01, 0.02].into_iter().filter(|r| (tau / 300.0..=tau / 4.0).contains(r)).collect();
    let row_s = one_of(rng, if fitting.is_empty() { &[0.001] } else { &fitting });
    let at_motor = one_of(rng, &[12.0, 28.0, 48.0, 256.0, 512.0, 2048.0, 4096.0, 16384.0]);
    let counts = at_motor * if rng.random_bool(0.7) { axis.gear } else { 1.0 };
    // Whoever logs it sees some counts a row at speed.
    let least = 2.0 * std::f64::consts::TAU / (axis.no_load() * row_s);
    Logger {
        row_s,
        jitter_s: one_of(rng, &[0.0, 0.02, 0.06]) * row_s,
        counts: counts.max(least.ceil()),
        edges: one_of(rng, &[0.0, 0.2, 0.5]),
        eccentric: [0.0; 2],
        stamp_s: Some(1e-3).filter(|_| row_s >= 0.005 && rng.random_bool(0.3)),
        lost: one_of(rng, &[0.0, 0.0, 0.0, 0.01]),
        mean_rows: speeds.then_some(1),
        filter_s: 0.0,
        duty_steps: Some(one_of(rng, &[255.0, 1000.0, 0.0])).filter(|steps| *steps > 0.0),
        supply: rng.random_bool(0.4),
    }
}

/// Draws a machine that hides these effects at this size; without one, each is drawn from 2 to 5.
pub(crate) fn draw(seed: u64, hidden: &[String], size: Option<u8>) -> Result<AxisCase, Error> {
    let mut rng = stream(seed, Stream::Robot);
    let nominal = machine(&mut rng);
    let seen = hidden.iter().map(|name| effects::seen(name)).collect::<Result<Vec<_>, _>>()?;
    let floor = rng.random_bool(0.3) && seen.iter().all(|s| s[0]);
    // A robot of 0.3 to 300 kg, by the radius of its wheels.
    let radius = (2.0 * nominal.load / decades(&mut rng, 0.3, 300.0)).sqrt().clamp(0.005, 0.5);
    let carrier = if floor { Carrier::Floor(radius) } else { Carrier::Blocks };
    let speeds = seen.iter().all(|s| s[2]) && (rng.random_bool(0.3) || seen.iter().any(|s| !s[1]));
    let mut logger = logger(&nominal, speeds, &mut rng);
    let drives = drives::draw(&nominal, &logger, &mut stream(seed, Stream::Excitation));
    let mut machine = nominal.clone();
    let mut rng = stream(seed, Stream::Nuisance);
    // What every machine has and none is named for: cables, magnets.
    machine.cogging = [rng.random_range(0.0..0.01) * machine.stall(), one_of(&mut rng, &[4.0, 7.0, 12.0, 24.0])];
    machine.source_ohm = rng.random_range(0.0..0.005) * machine.resistance_ohm;
    let mut rng = stream(seed, Stream::Effect);
    let mut hides = Vec::new();
    for name in hidden {
        let size = size.unwrap_or_else(|| rng.random_range(2..=5));
        hides.push(effects::hide(name, size, seed, &mut machine, &mut logger)?);
    }
    Ok(AxisCase { nominal, machine, carrier, logger, drives, seed, effects: hides })
}
