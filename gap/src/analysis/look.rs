//! How the logs of a drive are looked at, settled before anything is fitted.

use runs::is_from_speeds;
use runs::robot::Robot;

use super::cut::Cut;
use crate::state::State;
use links::drive::{DriveLink, FEWEST_PER_COLUMN, Generic};
use links::pieces::{Driven, Driving};

/// Longest test function, s.
const LONGEST_S: f64 = 3.0;

/// Effects that make a log older than what drives it.
const LATE: [&str; 2] = ["actuation-latency", "speed-filter"];
/// Part of a row by which a stated latency may be short of a whole number of rows: files have six digits or so.
const A_HAIR: f64 = 1e-3;

/// Whether currents were measured, whether speeds are means of rows, and how long test functions are.
///
/// Currents are measured, at a row or in the time up to it, or what an amplifier is told and holds: whichever leaves less of the accelerations beside smooth
/// functions of speed and current. Speeds in place of counts are momentary, or the mean of the row before up to its end or its
/// middle, by the same rule: a part of a row of age is the log's, not the machine's. Test functions of an axis alone that scatters too much get longer
/// as long as they tell more: the squared noise of an acceleration falls with the fifth power of their length, and what the motors of a heavy
/// machine do hardly at all.
pub(super) fn driving(held: &Cut, filed: &State, currents: bool, no_noise: f64) -> Driving {
    let robot: &Robot = &filed.robot;
    // Without other effects of the file, so that it is the same before something was found and after. What the file says of an
    // age is not taken for that of the rows as well: a part of a stated latency looked like means of the row before. Parts of a
    // row are left to the rows' own age, for which speeds of the moment do not bend as under a duty that begins with the row.
    let mut late = filed.clone();
    late.active.retain(|a| LATE.contains(&a.effect.name()));
    let mut model = late.drive(None);
    let row_s = 1.0 / robot.control_rate_hz;
    model.duty_delay_s = row_s * (model.duty_delay_s / row_s + A_HAIR).floor();
    let look = |driving: Driving| {
        let pieces = held.searched().driven(driving);
        let mut link = DriveLink::new(&pieces, &model)?;
        let columns = Generic::columns_of_wheel(&link);
        let enough = link.len() >= FEWEST_PER_COLUMN * columns;
        (link.noise, _) = links::drive::floor(&link, &link.residuals(&model)?, link.sizes.drive_nm);
        let noise = link.noise.iter().copied().fold(0.0, f64::max);
        Some(Look {
            tells: link.tells(&model),
            length: link.length(),
            loud: noise > no_noise * link.sizes.drive_nm,
            enough,
        })
    };
    let mut chosen = Driving::default();
    let Some(mut now) = look(chosen) else { return chosen };
    for driven in [Driven::Straight, Driven::UntilThen].into_iter().filter(|_| currents) {
        let measured = Driving { driven, ..chosen };
        if let Some(other) = look(measured).filter(|other| other.tells > now.tells) {
            (chosen, now) = (measured, other);
        }
    }
    if is_from_speeds(robot) {
        let held = chosen;
        let aged = |half_rows: usize| {
            let older = Driving { half_rows, ..held };
            look(older).map(|seen| (older, seen))
        };
        if let Some(mean) = aged(1).filter(|(_, mean)| mean.tells > now.tells) {
            (chosen, now) = mean;
            // Where they tell still more as older ones they are late by the machine, and the latency has a name.
            let beyond = aged(3).map_or(0.0, |(_, beyond)| beyond.tells);
            if let Some(older) = aged(2).filter(|(_, older)| older.tells > now.tells.max(beyond)) {
                (chosen, now) = older;
            }
        }
    }
    while now.loud && 2.0 * now.length <= LONGEST_S {
        let longer = Driving { test_function_s: 2.0 * now.length, ..chosen };
        let Some(next) = look(longer).filter(|next| next.enough && next.tells > now.tells) else { break };
        (chosen, now) = (longer, next);
    }
    chosen
}

/// What a way of looking at a drive shows.
struct Look {
    tells: f64,
    /// Length of a test function, s.
    length: f64,
    /// Whether it scatters too much to show smaller effects.
    loud: bool,
    /// Whether there are enough test functions to know the noise.
    enough: bool,
}
