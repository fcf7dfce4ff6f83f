//! `encoder-scale` as the controller's duties and the camera tell it together.
//!
//! Counts a wheel turn stand in three places: in the file, in the controller, in the encoder. Camera and wheels tell the
//! file from the encoder, but not from a radius; the controller's own duties tell its number from the file's.

use super::found::Named;
use super::gaps;
use super::measure::{Data, Drive};
use super::study::{chosen, is_better, needed};
use crate::controller::{ENCODER_SCALE, LOOP_SCALE};
use crate::evidence::{Interval, Ticks};
use crate::exact::Finding;
use crate::problem::Problem;
use crate::state::{Active, State};
use crate::thresholds::Thresholds;
use links::effect::{Form, Link, Values};

const SCALE: &str = "scale";
const RADIUS: &str = "wheel-radius-common";

/// Whose number of counts is wrong.
pub(super) enum Wrong {
    /// The file's: the camera has that of the controller.
    File(Active),
    /// The controller's: the camera has that of the file.
    Controller,
    /// No camera tells, or it has neither.
    Untold,
}

/// The scale that a replay found in the controller.
pub(super) fn of_loop(finding: &Finding) -> Option<f64> {
    finding.parameters.iter().find(|(name, ..)| name == LOOP_SCALE).map(|(_, scale, _)| *scale)
}

/// Whose it is, where the controller reckons with a `scale` more counts than the file has: the file's, where what camera
/// and wheels show, or without a camera the motors, needs fewer names by the controller's number; the controller's, where
/// it needs fewer by the file's.
pub(super) fn whose(scale: f64, data: &Data, start: &State, thresholds: &Thresholds) -> Wrong {
    let stated = start.active.iter().any(|a| a.effect.name() == ENCODER_SCALE);
    let Some(effect) = data.catalogue.iter().find(|e| e.name() == ENCODER_SCALE && !stated) else {
        return Wrong::Untold;
    };
    let values = Values(vec![(SCALE.to_owned(), scale), (LOOP_SCALE.to_owned(), scale)]);
    let form = Form { wheels: Vec::new(), free: Vec::new(), fixed: values.0.clone() };
    let mended = Active { given: true, values, ..Active::new(effect.clone(), form) };
    let mut other = start.clone();
    other.active.push(mended.clone());
    let needed = |problem: &Problem, thresholds: &Thresholds, matters: f64| {
        [start, &other]
            .map(|start| needed(problem, start, &chosen(problem, start, &[], data.catalogue, thresholds, matters)))
    };
    let [by_file, by_loop] = if data.has_motion {
        needed(&Problem::Motion(data.motion), thresholds, gaps::motion_matters(data.motion, thresholds))
    } else {
        let Some(Drive { link, correlation, .. }) = data.drive(start, None) else { return Wrong::Untold };
        let thresholds = Thresholds { drive_correlation: correlation, ..thresholds.clone() };
        let matters = thresholds.far * gaps::floor_of_scatter(&link, &link.noise, &thresholds);
        needed(&Problem::Drive(&link), &thresholds, matters)
    };
    if by_loop.1 < by_file.1 && is_better(by_loop, by_file, thresholds) {
        Wrong::File(mended)
    } else if by_file.1 < by_loop.1 && is_better(by_file, by_loop, thresholds) {
        Wrong::Controller
    } else {
        Wrong::Untold
    }
}

/// The name with both its sides, where the file alone is wrong: the replay knows the encoder's scale as it knows the
/// controller's.
pub(super) fn both_sides(mut named: Named) -> Named {
    let replayed = named.parameters.iter().find(|(name, ..)| name == LOOP_SCALE).cloned();
    named.parameters.extend(replayed.map(|(_, scale, within)| (SCALE.to_owned(), scale, within)));
    named.parameters.sort_by(|a, b| b.0.cmp(&a.0));
    named
}

/// What it means, with the counts a wheel turn of the file, and whether a camera told it.
pub(super) fn said(wrong: &Wrong, scale: f64, counts: f64, seen: bool) -> String {
    let numbers = format!("{:.1} counts a wheel turn, where the file has {counts:.1}", counts * (1.0 + scale));
    let by = if seen { "camera" } else { "drive" };
    match wrong {
        Wrong::File(_) => format!(
            "The controller reckons with {numbers}, and by the {by} it is right: counts a turn or gear ratio are wrong in the \
             file, and not the radius."
        ),
        Wrong::Controller => format!(
            "The controller reckons with {numbers}, and by the {by} the file is right: its number is wrong in the \
             controller, whose wheels turn {:.4} times as fast as it orders.",
            1.0 + scale
        ),
        Wrong::Untold => {
            format!("The controller reckons with {numbers}; which of the two is right the {by} does not tell.")
        }
    }
}

/// What a wrong number of counts and motors that are off by the same share are together, with the file's gear ratio.
pub(super) fn geared(named: &[Named], gear_ratio: f64) -> Option<String> {
    let of = |n: &Named, name: &str| n.parameters.iter().find(|(p, ..)| p == name).cloned();
    let counts =
        named.iter().filter(|n| n.name == ENCODER_SCALE).find_map(|n| of(n, SCALE).zip(of(n, LOOP_SCALE)))?.0.1;
    let motor = named.iter().find(|n| n.name == "torque-constant").and_then(|n| of(n, SCALE))?;
    let [low, high] = motor.2.ends()?;
    (low..=high).contains(&counts).then(|| {
        format!(
            "A gear ratio of {:.4} instead of {gear_ratio:.4} does what {ENCODER_SCALE} and torque-constant do together; then \
             neither the encoders nor the motors are wrong in the file.",
            gear_ratio * (1.0 + counts)
        )
    })
}

/// What the controller says of a radius that wheels and camera do not tell from counts, replayed with the file's counts
/// and with others.
pub(super) fn shared([ours, theirs]: [Ticks; 2]) -> String {
    format!(
        "The controller reckons with the file's counts a turn: {} of {} ticks replay wrong with them, {} with those \
         that the camera would have. Were it {ENCODER_SCALE}, and not the radius, both would have the same wrong number.",
        ours.wrong, ours.all, theirs.wrong
    )
}

/// What else makes all wheels drive less far than they turn, where that is more than wheels wear: a part of every way that
/// they slip has no law in the catalogue, and no logs of one floor tell it from a radius.
pub(super) fn slipped(named: &[Named], thresholds: &Thresholds) -> Option<String> {
    let radius = named.iter().find(|n| n.name == RADIUS && n.link == Link::Motion)?;
    let (_, scale, _) = radius.parameters.iter().find(|(name, ..)| name == SCALE)?;
    (*scale < -thresholds.worn).then(|| {
        format!(
            "Wheels that slip alike in every direction, as on a soft floor, do what {RADIUS} of {:.1} % does: before you write \
             it into a file, drive on a hard floor or measure a wheel.",
            100.0 * scale
        )
    })
}

/// Scale of the counts that would do what a radius does.
pub(super) fn for_radius(named: &[Named], sets: &[Vec<String>]) -> Option<f64> {
    let tied = sets.iter().any(|s| [RADIUS, ENCODER_SCALE].iter().all(|n| s.iter().any(|x| x == n)));
    let radius = named.iter().find(|n| tied && n.name == RADIUS && n.link == Link::Motion)?;
    radius
        .parameters
        .iter()
        .find(|(name, ..)| name == SCALE)
        .map(|(_, r, _): &(String, f64, Interval)| 1.0 / (1.0 + r) - 1.0)
}
