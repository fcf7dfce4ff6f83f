//! What to do next: the measurement or drive that separates what the data cannot.

use std::sync::Arc;

use model::robot::Robot;

use crate::analysis::{Named, Verdict};
use crate::effect::Effect;

/// A proposal.
#[derive(Debug, Clone, PartialEq)]
pub struct Experiment {
    /// `measurement` without driving, or `manoeuvre`.
    pub kind: &'static str,
    /// Name of the manoeuvre, or what to measure.
    pub what: String,
    /// Names it separates.
    pub separates: Vec<String>,
    /// Time it takes, s.
    pub seconds: f64,
    /// Why.
    pub why: String,
}

/// Manoeuvres and the effects they show best: name, seconds, effects.
pub const MANOEUVRES: [(&str, f64, &[&str]); 8] = [
    (
        "spin",
        10.0,
        &[
            "body-radius",
            "camera-scale",
            "wheel-radius-common",
            "marker-offset",
            "yaw-inertia",
            "wheel-angle",
            "roller-friction",
        ],
    ),
    ("star", 18.0, &["wheel-skew", "wheel-radius", "marker-heading", "centre-of-mass", "floor-tilt", "carpet-grain"]),
    ("square", 12.0, &["lens-distortion", "camera-scale"]),
    (
        "chirp",
        15.0,
        &["actuation-latency", "camera-latency", "encoder-lag", "wheel-creep", "robot-mass", "yaw-inertia"],
    ),
    ("stop-and-go", 12.0, &["wheel-slip", "gear-backlash", "robot-mass", "wheel-creep"]),
    ("creep", 12.0, &["dead-band", "coulomb-friction", "stribeck-friction", "gear-backlash", "encoder-loss"]),
    (
        "blocks",
        10.0,
        &[
            "coulomb-friction",
            "viscous-friction",
            "rotor-inertia",
            "gear-efficiency",
            "roller-friction",
            "torque-constant",
        ],
    ),
    (
        "full-duty",
        8.0,
        &["torque-constant", "battery-sag", "drive-curve", "motor-heating", "viscous-friction", "encoder-loss"],
    ),
];

/// The cheapest way to tell a set of names apart.
pub fn propose(
    verdict: Verdict,
    alternatives: &[Vec<String>],
    named: &[Named],
    catalogue: &[Arc<dyn Effect>],
    robot: &Robot,
) -> Option<Experiment> {
    let _ = robot;
    let set = alternatives.first()?;
    if !matches!(verdict, Verdict::Ambiguous | Verdict::MissingEffect) || named.is_empty() {
        return None;
    }
    // A manoeuvre that shows one of the set much better than the others.
    let drive = MANOEUVRES
        .iter()
        .filter(|(_, _, shows)| {
            let shown = set.iter().filter(|n| shows.contains(&n.as_str())).count();
            shown > 0 && shown < set.len()
        })
        .min_by(|a, b| a.1.total_cmp(&b.1));
    let measurement = set
        .iter()
        .filter_map(|n| catalogue.iter().find(|e| e.name() == n))
        .filter_map(|e| e.measurement().map(|(what, minutes)| (what.to_owned(), 60.0 * minutes)))
        .min_by(|a, b| a.1.total_cmp(&b.1));
    let exact =
        [["wheel-radius", "encoder-scale"], ["wheel-radius-common", "encoder-scale"], ["wheel-skew", "marker-heading"]];
    let hopeless = exact.iter().any(|pair| pair.iter().all(|n| set.iter().any(|s| s == n)));
    match (drive, measurement) {
        (Some((name, seconds, _)), _) if !hopeless => Some(Experiment {
            kind: "manoeuvre",
            what: (*name).to_owned(),
            separates: set.clone(),
            seconds: *seconds,
            why: format!("it excites some of {} and not the others", set.join(", ")),
        }),
        (_, Some((what, seconds))) => Some(Experiment {
            kind: "measurement",
            what,
            separates: set.clone(),
            seconds,
            why: "no drive tells them apart from these logs' signals".to_owned(),
        }),
        _ => None,
    }
}
