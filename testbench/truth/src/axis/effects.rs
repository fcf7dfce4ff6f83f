//! What an axis can hide, at five sizes, in units of the machine at hand.

use std::collections::BTreeMap;

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::{Axis, Logger};
use crate::effects::{Hidden, Link, drawn};
use crate::error::Error;
use crate::noise::named_stream;

type Parameters = Vec<(&'static str, f64)>;

struct Entry {
    name: &'static str,
    /// Of the machine's own stall torque, damping, time constant or resistance; relative where the effect is.
    sizes: [f64; 5],
    hide: fn(&mut Axis, &mut Logger, f64, &mut ChaCha8Rng) -> Parameters,
    /// Whether it can be on the floor.
    floor: bool,
    /// Logs that it can be in: of counts, of speeds.
    counts: bool,
    speeds: bool,
    /// Name of the effect that does the same, where it is none of the machine.
    looks_like: Option<&'static str>,
}

const fn entry(
    name: &'static str,
    sizes: [f64; 5],
    hide: fn(&mut Axis, &mut Logger, f64, &mut ChaCha8Rng) -> Parameters,
) -> Entry {
    Entry { name, sizes, hide, floor: true, counts: true, speeds: true, looks_like: None }
}

fn signed(value: f64, rng: &mut ChaCha8Rng) -> f64 {
    if rng.random_bool(0.5) { value } else { -value }
}

const CATALOGUE: [Entry; 17] = [
    entry("coulomb-friction", [0.03, 0.05, 0.08, 0.12, 0.2], |axis, _, value, _| {
        let torque = value * axis.stall();
        axis.dry.iter_mut().for_each(|dry| *dry += torque);
        vec![("torque_nm", torque)]
    }),
    entry("viscous-friction", [0.05, 0.08, 0.15, 0.25, 0.5], |axis, _, value, _| {
        let coefficient = value * axis.stall() / axis.no_load();
        axis.viscous += coefficient;
        vec![("coefficient_nms", coefficient)]
    }),
    entry("stribeck-friction", [0.04, 0.06, 0.09, 0.12, 0.2], |axis, _, value, rng| {
        let (torque, speed) = (value * axis.stall(), rng.random_range(0.03..0.1) * axis.no_load());
        axis.stribeck = [torque, speed];
        vec![("torque_nm", torque), ("speed_rad_s", speed)]
    }),
    entry("asymmetric-friction", [0.04, 0.06, 0.09, 0.12, 0.2], |axis, _, value, rng| {
        let (torque, sense) = (value * axis.stall(), signed(1.0, rng));
        axis.dry[usize::from(sense < 0.0)] += torque;
        vec![("torque_nm", torque), ("sense", sense)]
    }),
    entry("torque-constant", [0.05, 0.08, 0.12, 0.2, 0.3], |axis, _, value, rng| {
        let scale = signed(value, rng);
        axis.constant *= 1.0 + scale;
        vec![("scale", scale)]
    }),
    Entry {
        floor: false,
        ..entry("rotor-inertia", [0.08, 0.12, 0.2, 0.35, 0.6], |axis, _, value, rng| {
            // The whole inertia changes by so much, as far as a rotor allows.
            let own = axis.gear * axis.gear * axis.rotor / axis.inertia();
            let scale = (signed(value, rng) / own).max(-0.7);
            axis.rotor *= 1.0 + scale;
            vec![("scale", scale * own)]
        })
    },
    entry("dead-band", [0.03, 0.045, 0.06, 0.1, 0.15], |axis, _, value, _| {
        axis.dead_band = value;
        vec![("duty", value)]
    }),
    entry("drive-curve", [0.12, 0.18, 0.25, 0.35, 0.5], |axis, _, value, rng| {
        let curvature = signed(value, rng);
        axis.curvature = curvature;
        vec![("curvature", curvature)]
    }),
    entry("coasting-bridge", [0.12, 0.2, 0.35, 0.6, 1.0], |axis, _, value, _| {
        let share = value.min(1.0);
        axis.coasting = share;
        vec![("share", share)]
    }),
    entry("actuation-latency", [0.05, 0.1, 0.15, 0.25, 0.4], |axis, _, value, _| {
        let latency = value * axis.time_constant().min(0.3);
        axis.latency_s = latency;
        vec![("latency_s", latency)]
    }),
    Entry {
        floor: false,
        speeds: false,
        ..entry("encoder-eccentricity", [0.008, 0.012, 0.02, 0.04, 0.08], |_, logger, value, rng| {
            let (sin, cos) = rng.random_range(0.0..std::f64::consts::TAU).sin_cos();
            logger.eccentric = [value * cos, value * sin];
            vec![("sin_1_rad", value * cos), ("cos_1_rad", value * sin)]
        })
    },
    // A firmware that takes speeds over several rows smooths them.
    Entry {
        counts: false,
        looks_like: Some("speed-filter"),
        ..entry("mean-speeds", [0.05, 0.1, 0.15, 0.25, 0.4], |axis, logger, value, _| {
            let rows = 2.0 * value * axis.time_constant().min(0.3) / logger.row_s;
            logger.mean_rows = Some(1 + (rows.round() as usize).max(1));
            Vec::new()
        })
    },
    Entry {
        floor: false,
        speeds: false,
        ..entry("gravity-load", [0.03, 0.05, 0.08, 0.12, 0.2], |axis, _, value, rng| {
            let (sin, cos) = rng.random_range(0.0..std::f64::consts::TAU).sin_cos();
            axis.gravity = [value * axis.stall() * sin, value * axis.stall() * cos];
            // Counts begin anywhere, so that nobody knows how much of it is sine and how much cosine.
            Vec::new()
        })
    },
    Entry {
        floor: false,
        ..entry("hanging-load", [0.03, 0.05, 0.08, 0.12, 0.2], |axis, _, value, rng| {
            axis.hanging = signed(value * axis.stall(), rng);
            vec![("torque_1_nm", axis.hanging)]
        })
    },
    Entry {
        counts: false,
        ..entry("speed-filter", [0.05, 0.1, 0.15, 0.25, 0.4], |axis, logger, value, _| {
            let time = value * axis.time_constant().min(0.25);
            logger.filter_s = time;
            vec![("time_s", time)]
        })
    },
    entry("current-limit", [0.8, 0.6, 0.45, 0.3, 0.2], |axis, _, value, _| {
        axis.limit_a = value * axis.supply_v / axis.resistance_ohm;
        vec![("limit_a", axis.limit_a)]
    }),
    Entry {
        floor: false,
        ..entry("quadratic-drag", [0.05, 0.08, 0.15, 0.25, 0.5], |axis, _, value, _| {
            axis.quadratic = value * axis.stall() / axis.no_load().powi(2);
            vec![("coefficient_1_nms2", axis.quadratic)]
        })
    },
];

/// Effects that one machine is likely to have at once.
pub const PAIRS: [[&str; 2]; 6] = [
    ["coulomb-friction", "viscous-friction"],
    ["coulomb-friction", "torque-constant"],
    ["coulomb-friction", "stribeck-friction"],
    ["viscous-friction", "rotor-inertia"],
    ["dead-band", "viscous-friction"],
    ["coulomb-friction", "actuation-latency"],
];

/// Names of what can be hidden.
pub fn names() -> impl Iterator<Item = &'static str> {
    CATALOGUE.iter().map(|entry| entry.name)
}

fn find(name: &str) -> Result<&'static Entry, Error> {
    CATALOGUE.iter().find(|entry| entry.name == name).ok_or_else(|| Error::UnknownEffect(name.to_owned()))
}

/// Whether an effect can be on the floor, in a log of counts, in a log of speeds.
pub(super) fn seen(name: &str) -> Result<[bool; 3], Error> {
    find(name).map(|entry| [entry.floor, entry.counts, entry.speeds])
}

/// Puts an effect into the machine.
pub(super) fn hide(name: &str, size: u8, seed: u64, axis: &mut Axis, logger: &mut Logger) -> Result<Hidden, Error> {
    let entry = find(name)?;
    let mut rng = named_stream(seed, name);
    let value = drawn(&entry.sizes, size, &mut rng)?;
    let parameters = (entry.hide)(axis, logger, value, &mut rng);
    Ok(Hidden {
        name: entry.looks_like.unwrap_or(name).to_owned(),
        link: Link::Drive,
        size,
        wheels: Vec::new(),
        parameters: parameters.into_iter().map(|(n, v)| (n.to_owned(), v)).collect::<BTreeMap<_, _>>(),
    })
}
