//! What a firmware's filter on logged speeds may be, beside what is named.

use super::found::Named;
use super::look_alikes::LookAlike;
use crate::thresholds::Thresholds;
use links::drive::DriveModel;
use links::thresholds::filter_s;

const FILTER: &str = "speed-filter";
const INERTIA: &str = "rotor-inertia";
const LATENCY: &str = "actuation-latency";

fn parameter(named: &[Named], name: &str) -> Option<(f64, Option<[f64; 2]>)> {
    let found = named.iter().find(|n| n.name == name)?;
    found.parameters.first().map(|(_, value, interval)| (*value, interval.ends()))
}

/// A delay that was found from speeds: a filter of higher order, or a mean, makes them late without the shape of a low-pass
/// of first order.
pub(super) fn of_delay(named: &[Named], row_s: f64) -> Option<LookAlike> {
    let (late_s, _) = parameter(named, LATENCY)?;
    let (found, names, all_s): (_, &[&'static str], _) = match parameter(named, FILTER) {
        Some((found_s, _)) => (format!("{FILTER} and {LATENCY}"), &[], late_s + found_s),
        None => (LATENCY.to_owned(), &[LATENCY, FILTER], late_s),
    };
    (late_s > 0.0 && all_s <= filter_s(row_s)).then(|| {
        let said = format!(
            "Found from speeds that the log has in place of counts: {found}. Where the firmware takes a mean of {:.0} ms, or \
             filters twice, that is what it looks like. Log counts, or speeds without the filter, to tell.",
            2e3 * all_s
        );
        LookAlike::open(said, names)
    })
}

/// Time constants of an axis by its file and with the inertia that is named, s.
fn motor_s(named: &[Named], model: &DriveModel) -> Option<[f64; 2]> {
    let (heavier, _) = parameter(named, INERTIA)?;
    let braking = model.axes[0].braking(model.gear_ratio);
    let file_s = model.felt_inertia() / braking;
    Some([file_s, file_s + heavier * model.inertia_of_scale(0) / braking])
}

/// A motor whose time constant by its file is about a row does not show beside a filter that is longer: an inertia then does
/// the same as the filter. `late_s` is the age that logged speeds are taken to have by themselves.
pub(super) fn in_place_of_inertia(
    named: &[Named],
    model: &DriveModel,
    [row_s, late_s]: [f64; 2],
    thresholds: &Thresholds,
) -> Option<LookAlike> {
    let [file_s, now_s] = motor_s(named, model)?;
    // Both are as late.
    let late_s = now_s + late_s - file_s;
    let hidden = parameter(named, FILTER).is_none()
        && file_s <= thresholds.hidden_rows * row_s
        && (row_s..=filter_s(row_s)).contains(&late_s);
    hidden.then(|| {
        let said = format!(
            "A filter and an inertia may change places: a {FILTER} of {:.1} ms with the inertia of the file does the same as \
             what is named, for by the file the motor is done within about a row. Log counts, or speeds without the filter, to tell.",
            1e3 * late_s
        );
        LookAlike::open(said, &[INERTIA, FILTER])
    })
}

/// A motor is a low-pass of its duty as a filter is one of its speed, and what comes out of both does not tell which is
/// which: inertia and filter with their time constants exchanged.
pub(super) fn exchanged(named: &[Named], model: &DriveModel, row_s: f64) -> Option<LookAlike> {
    let (found_s, within) = parameter(named, FILTER)?;
    let [file_s, motor_s] = motor_s(named, model)?;
    let scaled = model.inertia_of_scale(0);
    let braking = model.axes[0].braking(model.gear_ratio);
    let holds_file = within.is_some_and(|[low, high]| (low..=high).contains(&file_s));
    let inertia = match (found_s - file_s) * braking / scaled {
        _ if holds_file => "the inertia of the file".to_owned(),
        scale => format!("{INERTIA} of {:+.0} %", 100.0 * scale),
    };
    (motor_s.is_finite() && motor_s <= filter_s(row_s)).then(|| {
        let said = format!(
            "A filter and an inertia may change places: a {FILTER} of {:.1} ms with {inertia} does the same as what is named. \
             Log counts, or speeds without the filter, to tell.",
            1e3 * motor_s
        );
        LookAlike::open(said, &[])
    })
}
