//! Effects that show as a pattern and are named without a fit.

use std::sync::Arc;

use runs::robot::Robot;

use super::found::Named;
use crate::evidence::{Evidence, Interval};
use crate::thresholds::Thresholds;
use links::drive::DriveModel;
use links::effect::{Effect, Link, wheel_name};
use links::pieces::Pieces;

fn equation(name: &str, catalogue: &[Arc<dyn Effect>]) -> String {
    catalogue.iter().find(|e| e.name() == name).map_or("", |e| e.equation()).to_owned()
}

/// Share of a ripple that its contact may swallow, at 95 %: wheels creep, and the robot gives way. On three simulated
/// robots of the blind bench 3.2 to 5.1 % were missing.
const CREEPS: f64 = 0.06;

/// A ripple in the words that fit the machine: the effect's name where there are rollers, else what it may be.
pub(super) fn ripple_named(
    ripple: &crate::leftover::Ripple,
    robot: &Robot,
    catalogue: &[Arc<dyn Effect>],
) -> Result<Named, String> {
    let n = ripple.wheels.len().max(1) as f64;
    let amplitude = (ripple.wheels.iter().map(|w| w.1 * w.1).sum::<f64>() / n).sqrt();
    if !crate::leftover::has_rollers(robot) {
        let wheels: Vec<String> = ripple.wheels.iter().map(|w| (w.0 + 1).to_string()).collect();
        return Err(format!(
            "a ripple, {} per wheel turn, amplitude {:.1} % of the speed, on axis {} (p = {}): this machine has no rollers; \
             gear teeth, magnet poles of motor or encoder, or an eccentric wheel repeat like that",
            ripple.count,
            100.0 * amplitude,
            wheels.join(", "),
            crate::units::short(ripple.p_value)
        ));
    }
    let noise = ripple.wheels.iter().map(|w| w.2 * w.2).sum::<f64>().sqrt() / n;
    // Wheels scatter by more than noise: load, speed, slip of the rollers.
    let half = if ripple.wheels.len() > 1 {
        let apart = (ripple.wheels.iter().map(|w| (w.1 - amplitude).powi(2)).sum::<f64>() / (n - 1.0) / n).sqrt();
        estimation::statistics::t_quantile_975(ripple.wheels.len() - 1) * apart.max(noise)
    } else {
        estimation::statistics::t_quantile_975(usize::MAX) * noise
    };
    let half = half.hypot(CREEPS * amplitude);
    let what =
        format!("a line {} times a turn whose phase the wheel's angle fixes (Rayleigh, chi-squared)", ripple.count);
    Ok(Named {
        name: "roller-ripple".to_owned(),
        equation: equation("roller-ripple", catalogue),
        link: Link::Drive,
        wheels: ripple.wheels.iter().map(|w| w.0 + 1).collect(),
        parameters: vec![
            ("amplitude".to_owned(), amplitude, Interval::Ci95([amplitude - half, amplitude + half])),
            ("count".to_owned(), ripple.count as f64, Interval::Exact),
        ],
        gain: 0.0,
        evidence: Evidence::Pattern { what, p: Some(ripple.p_value) },
        conditional_on: Vec::new(),
    })
}

/// Play over what the encoder shakes by, at least and at most: wheels shake along, so that most of it may be theirs.
const PLAY_SHARE: [f64; 2] = [0.2, 1.15];
/// Plays within this of their mean are one.
const ALIKE: f64 = 0.2;

/// Play in which rotors rattle.
pub(super) fn rattling(
    pieces: &Pieces,
    robot: &Robot,
    model: &DriveModel,
    catalogue: &[Arc<dyn Effect>],
    thresholds: &Thresholds,
) -> Option<Named> {
    let rattles = Some(crate::leftover::rattle(pieces.iter(), robot, model, thresholds)).filter(|r| !r.is_empty())?;
    let mean = rattles.iter().map(|r| r.1).sum::<f64>() / rattles.len() as f64;
    let alike = rattles.len() > 1 && rattles.iter().all(|r| (r.1 / mean - 1.0).abs() < ALIKE);
    let middle = 0.5 * (PLAY_SHARE[0] + PLAY_SHARE[1]);
    let parameter =
        |name: String, shakes: f64| (name, middle * shakes, Interval::Bound(PLAY_SHARE.map(|s| s * shakes)));
    let parameters = if alike {
        vec![parameter("play_rad".to_owned(), mean)]
    } else {
        rattles.iter().map(|(i, shakes)| parameter(wheel_name("play", *i, "rad"), *shakes)).collect()
    };
    Some(Named {
        name: "gear-backlash".to_owned(),
        equation: equation("gear-backlash", catalogue),
        link: Link::Drive,
        wheels: if alike { Vec::new() } else { rattles.iter().map(|r| r.0 + 1).collect() },
        parameters,
        gain: 0.0,
        evidence: Evidence::Pattern {
            what: "rotors accelerate beyond what the stalled motor could give the wheel".to_owned(),
            p: None,
        },
        conditional_on: Vec::new(),
    })
}
