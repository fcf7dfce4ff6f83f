//! `current` as engineers of controllers write it: not amperes, but what is now, beside what was asked for.

use super::super::{Series, Table, owner};
use super::guess::{ANGLES, WANTED, spaced, words};

/// The word that is either.
const CURRENT: &str = "current";
/// What stands after it where it is no current.
const QUANTITIES: [&str; 18] = [
    "position", "pos", "speed", "velocity", "vel", "rpm", "heading", "yaw", "pose", "x", "y", "tick", "ticks", "count",
    "counts", "encoder", "enc", "state",
];

/// The name that says what a series is, where its own does not: `M1/speed` of a table that was taken apart by its motors is
/// one of them's.
pub(super) fn meant(table: &Table, series: &Series) -> Option<String> {
    let of_motors = || table.of.as_deref().is_some_and(owner::is_of_motors);
    now_or_wanted(table, series).or_else(|| of_motors().then(|| format!("motor {}", series.name)))
}

/// The same where it says it by such a word: `current_speed` is a speed, and of
/// `CURRENT_M1` beside `DESIRED_M1` one is the speed of a motor and the other what it should be.
fn now_or_wanted(table: &Table, series: &Series) -> Option<String> {
    let lower = spaced(&series.name).to_lowercase();
    let own = words(&lower);
    let others = || table.series.iter().filter(|other| other.name != series.name);
    let beside = |wanted: &[&str], name: &[&str]| {
        wanted.iter().any(|word| {
            let twin: Vec<&str> = name.iter().map(|own| if own.is_empty() { *word } else { *own }).collect();
            others().any(|other| words(&spaced(&other.name).to_lowercase()) == twin)
        })
    };
    // The name with a gap in place of the word.
    let without =
        |i: usize| -> Vec<&str> { own.iter().enumerate().map(|(k, w)| if k == i { "" } else { *w }).collect() };
    let bare =
        |i: usize| own.iter().enumerate().filter(|(k, _)| *k != i).map(|(_, w)| *w).collect::<Vec<_>>().join(" ");
    let quantity = |word: &&str| QUANTITIES.contains(word) || ANGLES.contains(word);
    if let Some(i) = own.iter().position(|word| *word == CURRENT) {
        if own.get(i + 1).is_some_and(quantity) {
            return Some(bare(i));
        }
        // Alone beside a target it may be either.
        return (own.len() > 1 && beside(&WANTED, &without(i))).then(|| format!("motor speed {}", bare(i)));
    }
    let i = own.iter().position(|word| WANTED.contains(word))?;
    (own.len() > 1 && !own.iter().any(quantity) && beside(&[CURRENT], &without(i)))
        .then(|| format!("target motor speed {}", bare(i)))
}
