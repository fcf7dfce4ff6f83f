//! Effects that show as a pattern and are named without a fit.

use std::sync::Arc;

use runs::robot::Robot;

use super::Named;
use crate::drive::DriveModel;
use crate::effect::{Effect, Link, wheel_name};
use crate::pieces::Pieces;

fn equation(name: &str, catalogue: &[Arc<dyn Effect>]) -> String {
    catalogue.iter().find(|e| e.name() == name).map_or("", |e| e.equation()).to_owned()
}

pub(super) fn ripple_named(ripple: &crate::leftover::Ripple, catalogue: &[Arc<dyn Effect>]) -> Named {
    let n = ripple.wheels.len().max(1) as f64;
    let amplitude = (ripple.wheels.iter().map(|w| w.1 * w.1).sum::<f64>() / n).sqrt();
    let sd = (ripple.wheels.iter().map(|w| w.2 * w.2).sum::<f64>()).sqrt() / n;
    // Amplitudes of single wheels scatter by more than noise: load, speed, slip of the rollers.
    let half = 1.96 * sd.hypot(0.06 * amplitude);
    let count = ripple.count as f64;
    Named {
        name: "roller-ripple".to_owned(),
        equation: equation("roller-ripple", catalogue),
        link: Link::Drive,
        wheels: ripple.wheels.iter().map(|w| w.0 + 1).collect(),
        parameters: vec![
            ("amplitude".to_owned(), amplitude, [amplitude - half, amplitude + half]),
            ("count".to_owned(), count, [count; 2]),
        ],
        gain: 0.0,
        p_value: ripple.p_value,
    }
}

/// Play over what the encoder shakes by, 95 %: wheels shake along, so that most of it may be theirs.
const PLAY_SHARE: [f64; 2] = [0.2, 1.15];
/// Plays within this of their mean are one.
const ALIKE: f64 = 0.2;

/// Play in which rotors rattle.
pub(super) fn rattling(
    pieces: &Pieces,
    robot: &Robot,
    model: &DriveModel,
    catalogue: &[Arc<dyn Effect>],
) -> Option<Named> {
    let rattles = Some(crate::leftover::rattle(pieces.iter(), robot, model)).filter(|r| !r.is_empty())?;
    let mean = rattles.iter().map(|r| r.1).sum::<f64>() / rattles.len() as f64;
    let alike = rattles.len() > 1 && rattles.iter().all(|r| (r.1 / mean - 1.0).abs() < ALIKE);
    let middle = 0.5 * (PLAY_SHARE[0] + PLAY_SHARE[1]);
    let parameter = |name: String, shakes: f64| (name, middle * shakes, PLAY_SHARE.map(|s| s * shakes));
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
        // No torque of the motor moves a wheel like this.
        p_value: 1e-12,
    })
}
