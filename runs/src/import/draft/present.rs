//! What series are whose own names do not say it: `current` as engineers of controllers write it, not amperes, but what is now
//! beside what was asked for; and the parts of a pose that is a list of three.

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
    now_or_wanted(table, series)
        .or_else(|| part_of_three(table, &series.name))
        .or_else(|| of_motors().then(|| format!("motor {}", series.name)))
}

/// What a part of a list is: of `robot/pose/1`, 2 and 3, or `tracker_pose_1`, x, y and heading, and of velocities that were asked
/// for beside such a pose those of the body. Of several poses in a file the robot's, if one is called so, or the tracker's.
fn part_of_three(table: &Table, name: &str) -> Option<String> {
    const BETWEEN: [char; 2] = ['/', '_'];
    let is_three = |list: &str| {
        let has = |n: usize| BETWEEN.iter().any(|b| table.series.iter().any(|s| s.name == format!("{list}{b}{n}")));
        has(1) && has(2) && has(3) && !has(4)
    };
    let (list, part) = name.rsplit_once(BETWEEN)?;
    let part = part.parse::<usize>().ok().filter(|n| (1..=3).contains(n) && is_three(list))? - 1;
    let pose_of = |list: &str| list.strip_suffix("pose").map(|owner| owner.trim_end_matches(BETWEEN).to_owned());
    let (owner, what) = match pose_of(list) {
        Some(owner) => (owner, "pose"),
        None => list.rsplit_once('/').map_or((String::new(), list), |(owner, what)| (owner.to_owned(), what)),
    };
    let firsts = table.series.iter().filter_map(|other| other.name.strip_suffix('1')?.strip_suffix(BETWEEN));
    let owners: Vec<String> = firsts.filter(|list| is_three(list)).filter_map(pose_of).collect();
    if !owners.contains(&owner) {
        return None;
    }
    let called = |owner: &String, name: &str| words(&owner.to_lowercase()).contains(&name);
    for name in ["robot", "tracker"] {
        if owners.iter().any(|other| called(other, name)) && !called(&owner, name) {
            return Some("another".to_owned());
        }
    }
    let lower = spaced(what).to_lowercase();
    let words = words(&lower);
    let asked = words.iter().any(|word| WANTED.contains(word) || ["cmd", "command"].contains(word));
    match what {
        "pose" => Some(format!("{owner} pose {}", ["x", "y", "theta"][part])),
        _ if asked && words.iter().any(|word| ["velocity", "vel", "twist"].contains(word)) => {
            Some(format!("cmd {}", ["linear x", "linear y", "angular z"][part]))
        }
        _ => None,
    }
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
