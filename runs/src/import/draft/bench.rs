//! What a motor or a joint on a bench logs without a telling word: volts, an angle, a torque.

use super::super::{Series, Table, units};
use super::guess::{ANGLES, Guess, WANTED, by_names, from_zero, numbered, spaced, supply_words, words};
use super::present::meant;
use crate::columns::{Column, MOST_DUTY};

/// The unit of a current that is a torque at the output shaft.
pub(super) const TORQUE: &str = "Nm";
/// Angles beyond which a shaft turns in degrees rather than in radians: eight turns.
const DEGREES: f64 = 50.0;

/// What the series of a log seem to be, by their names and by what else there is, and the rest.
pub(super) fn guesses(table: &Table) -> (Vec<Guess<'_>>, Vec<&Series>) {
    let from_zero = from_zero(table);
    let (mut guesses, mut rest) = by_names(table, &from_zero, meant);
    lone_speed(&mut guesses, &mut rest);
    driving_volts(&mut guesses);
    shares(&mut guesses, &mut rest, &from_zero);
    angles(&mut guesses, &mut rest, &from_zero);
    torques(&mut guesses, &mut rest, &from_zero);
    guesses.sort_by_key(|g| g.column);
    (guesses, rest)
}

/// Of a log in which nothing else moves, the one speed beside what drives is that of the motor.
fn lone_speed<'a>(guesses: &mut Vec<Guess<'a>>, rest: &mut Vec<&'a Series>) {
    let drives = |g: &Guess| matches!(g.column, Column::Duty(_) | Column::Current(_) | Column::Supply);
    if guesses.iter().any(|g| !drives(g)) || guesses.len() != 1 {
        return;
    }
    let is_speed = |series: &&&Series| {
        let has = said(series);
        has(&["velocity", "speed", "vel", "omega"])
            && !has(&WANTED)
            && !has(&["error", "linear", "forward", "x", "y", "wind", "max", "min"])
            && units::in_name(&series.name).is_none_or(|unit| units::is_like(unit, "rad/s"))
    };
    // What turns beside what goes along x is a body.
    let goes =
        |series: &&Series| said(series)(&["velocity", "speed", "vel"]) && said(series)(&["x", "linear", "forward"]);
    if rest.iter().any(goes) {
        return;
    }
    let mut speeds = rest.iter().filter(is_speed);
    let (Some(series), None) = (speeds.next().copied(), speeds.next()) else { return };
    rest.retain(|other| !std::ptr::eq(*other, series));
    let unit = units::in_name(&series.name).filter(|unit| *unit != "rad/s").unwrap_or("");
    guesses.push(Guess { series, column: Column::Speed(0), unit });
}

/// Volts without a duty or a current beside a wheel are what drives it, though they stand still throughout a step.
fn driving_volts(guesses: &mut [Guess]) {
    let has = |wanted: fn(&Column) -> bool| guesses.iter().any(|g| wanted(&g.column));
    let driven = has(|c| matches!(c, Column::Duty(_) | Column::Current(_)));
    let wheels = guesses.iter().filter(|g| matches!(g.column, Column::Counts(_) | Column::Speed(_))).count();
    if driven || wheels != 1 {
        return;
    }
    let bare = |name: &str| {
        let lower = spaced(name).to_lowercase();
        let words = words(&lower);
        let mut supply = supply_words().chain(["bus", "bat", "source", "psu", "vcc", "vin", "input", "in"]);
        words.iter().any(|w| w.starts_with("volt")) && !supply.any(|w| words.contains(&w))
    };
    if let Some(volts) = guesses.iter_mut().find(|g| g.column == Column::Supply && bare(&g.series.name)) {
        (volts.column, volts.unit) = (Column::Duty(0), "V");
    }
}

/// Of one motor alone what it was told as a share drives it, whatever it is called: `m_power`, `throttle`.
fn shares<'a>(guesses: &mut Vec<Guess<'a>>, rest: &mut Vec<&'a Series>, from_zero: &[String]) {
    let wheels = guesses.iter().filter(|g| matches!(g.column, Column::Counts(_))).count();
    let others = guesses.iter().any(|g| matches!(g.column, Column::Duty(_) | Column::Command(_) | Column::Camera(_)));
    if others || wheels != 1 {
        return;
    }
    let rank = |series: &Series| {
        let has = said(series);
        let [low, high] = series.range();
        let share = low < high && low >= -MOST_DUTY && high <= MOST_DUTY;
        let watts = has(&["w", "watt", "watts", "electrical", "mechanical", "electric", "consumed", "average"]);
        (share && has(&["power", "throttle"]) && !watts).then_some(0)
    };
    let wheel_of = |name: &str| numbered(name, from_zero);
    take(guesses, rest, wheel_of, rank, |series, wheel| Guess { series, column: Column::Duty(wheel), unit: "" });
}

/// Of a log without wheels and poses the angles are what its motors turn: the first, and each that numbers its motor.
fn angles<'a>(guesses: &mut Vec<Guess<'a>>, rest: &mut Vec<&'a Series>, from_zero: &[String]) {
    let moves = |g: &Guess| {
        matches!(
            g.column,
            Column::Counts(_) | Column::Speed(_) | Column::Camera(_) | Column::Odometry(_) | Column::Command(_)
        )
    };
    if guesses.iter().any(moves) {
        return;
    }
    // Four q are a quaternion; beside their rates or torques they are joints.
    let joints = rest.iter().any(|s| said(s)(&["dq", "qd", "tau", "torque", "effort"]));
    let is_angle = |series: &Series| {
        let has = said(series);
        let turns = |unit| units::is_like(unit, "rad");
        (has(&ANGLES[..3]) || joints && has(&["q"]) || units::in_name(&series.name).is_some_and(turns))
            && !has(&WANTED)
            && !has(&[
                "x",
                "y",
                "z",
                "roll",
                "pitch",
                "yaw",
                "heading",
                "error",
                "dot",
                "vel",
                "velocity",
                "rate",
                "electrical",
            ])
    };
    take(
        guesses,
        rest,
        |name| numbered(name, from_zero),
        |series| is_angle(series).then_some(0),
        |series, wheel| {
            let [low, high] = series.range();
            let unit_said = units::in_name(&series.name).filter(|unit| units::is_like(unit, "rad"));
            let whole = series.values.iter().all(|x| x.fract() == 0.0);
            let unit = match low.abs().max(high.abs()) {
                most if most > DEGREES && whole => "",
                most if most > DEGREES => "deg",
                _ => "rad",
            };
            Guess { series, column: Column::Counts(wheel), unit: unit_said.unwrap_or(unit) }
        },
    );
}

/// Where neither duties nor currents are logged, the torques of turning motors are what drives them.
fn torques<'a>(guesses: &mut Vec<Guess<'a>>, rest: &mut Vec<&'a Series>, from_zero: &[String]) {
    let turns = |i: usize| move |g: &Guess| [Column::Counts(i), Column::Speed(i)].contains(&g.column);
    if guesses.iter().any(|g| matches!(g.column, Column::Duty(_) | Column::Current(_))) {
        return;
    }
    let turning: Vec<bool> = (0..8).map(|i| guesses.iter().any(turns(i))).collect();
    // A joint without a number has that of its position: `elbow/position`, `elbow/effort`.
    let joint = |name: &str| name.rsplit_once(['/', '_', '.', ' ']).map(|(joint, _)| joint.to_owned());
    let joints: Vec<(String, usize)> = guesses
        .iter()
        .filter_map(|g| match g.column {
            Column::Counts(i) | Column::Speed(i) => Some((joint(&g.series.name)?, i)),
            _ => None,
        })
        .collect();
    let beside = |name: &str| {
        let own = joint(name)?;
        joints.iter().find(|(joint, _)| *joint == own).map(|(_, wheel)| *wheel)
    };
    // Measured ones first, asked for ones last; parts and bounds of a torque are none.
    let rank = |series: &Series| {
        let has = said(series);
        let wheel = numbered(&series.name, from_zero).or_else(|| beside(&series.name)).unwrap_or(0);
        let is = has(&["torque", "tau", "effort"])
            && !has(&[
                "fric", "friction", "ff", "gravity", "limit", "max", "min", "ext", "external", "error", "x", "y", "z",
            ]);
        (is && turning.get(wheel) == Some(&true)).then(|| match () {
            () if has(&["meas", "measured", "act", "actual", "feedback", "fb"]) => 0,
            () if has(&WANTED) || has(&["con", "cmd", "command", "des", "control"]) => 2,
            () => 1,
        })
    };
    let wheel_of = |name: &str| numbered(name, from_zero).or_else(|| beside(name));
    take(guesses, rest, wheel_of, rank, |series, wheel| Guess { series, column: Column::Current(wheel), unit: TORQUE });
}

/// Takes from the rest what has a rank, the lowest first, one series a motor; of several without a number the first.
fn take<'a>(
    guesses: &mut Vec<Guess<'a>>,
    rest: &mut Vec<&'a Series>,
    wheel_of: impl Fn(&str) -> Option<usize>,
    rank: impl Fn(&Series) -> Option<usize>,
    guess: impl Fn(&'a Series, usize) -> Guess<'a>,
) {
    let mut ranked: Vec<(usize, &'a Series)> = rest.iter().filter_map(|s| rank(s).map(|rank| (rank, *s))).collect();
    ranked.sort_by_key(|(rank, _)| *rank);
    for (_, series) in ranked {
        let found = guess(series, wheel_of(&series.name).unwrap_or(0));
        if guesses.iter().all(|g| g.column != found.column) {
            rest.retain(|other| !std::ptr::eq(*other, series));
            guesses.push(found);
        }
    }
}

/// Whether one of some words stands in a name, whatever number follows it.
fn said(series: &Series) -> impl Fn(&[&str]) -> bool {
    let lower = spaced(&series.name).to_lowercase();
    let stem = |word: &&str| word.trim_end_matches(|c: char| c.is_ascii_digit()).to_owned();
    let words: Vec<String> = words(&lower).iter().map(stem).collect();
    move |some| words.iter().any(|word| some.contains(&&**word))
}
