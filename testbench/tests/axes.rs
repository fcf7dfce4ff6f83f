//! Single motors and drive trains of any size, simulated by what is not ours: nothing is named where nothing hides, and what
//! hides at its largest size is named, tied with what does the same, or found to be below what the log shows.

use testbench::blind::{self, Grade, Group, Plan, Series, Task};
use truth::{Conditions, Kind};

#[test]
fn motors_of_any_size_are_read_right() {
    let plan = Plan { axes_free: 60, axes: 1, sizes: vec![5], axis_pairs: 6, pair_sizes: vec![4], ..Plan::new(20) };
    let report = blind::run(&plan, &Series::default(), |_| ()).unwrap();
    assert_eq!(report.scored.len(), report.planned);
    // The limit of a Stribeck friction holds at one speed of its curve; a short log may not be as slow as another.
    let at_one_speed = |s: &blind::Scored| s.hidden.iter().any(|h| h.name == "stribeck-friction");
    let shows = |s: &blind::Scored| s.hidden.is_empty() || s.limits.is_some_and(|l| l >= 1.5) && !at_one_speed(s);
    let faults: Vec<String> = report
        .scored
        .iter()
        .filter(|s| matches!(s.grade, Grade::Wrong | Grade::Failed) || shows(s) && !s.grade.is_good())
        .map(|s| format!("{} {:?}: {} {:?}", s.seed, s.hidden, s.grade.name(), s.answer))
        .collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
    let named = |name: &str| report.scored.iter().any(|s| s.hidden.iter().any(|h| h.name == name) && s.grade.is_good());
    let missed: Vec<&str> = truth::axis::names().filter(|n| *n != "mean-speeds" && !named(n)).collect();
    assert!(missed.len() <= 2, "not found at the largest size: {missed:?}");
    let [judged, hold] = report.intervals();
    assert!(judged > 10 && hold + 2 >= judged, "{hold} of {judged} intervals hold");
}

/// A dead band that a search names by a curved bridge, stiction that it names by a dead band, and friction beside a latency that a dead band leaves 1.5 floors of.
#[test]
fn one_law_that_leaves_noise_alone_is_tried_by_itself() {
    for (group, kind, seed) in [
        (Group::Axis, "axis:dead-band:5", 9_538_704_517_320_418_942),
        (Group::Axis, "axis:stribeck-friction:4", 10_551_524_075_058_885_870),
        (Group::AxisPair, "axis:coulomb-friction+actuation-latency:5", 1_855_999_549_820_300_230),
    ] {
        let kind: Kind = kind.parse().unwrap();
        let task = Task { group, seed, kind, conditions: Conditions::default() };
        let scored = task.run().unwrap();
        assert_ne!(scored.grade, Grade::Wrong, "{:?}", scored.answer);
        assert!(group != Group::Axis || scored.grade.is_good(), "{:?}", scored.answer);
    }
}
