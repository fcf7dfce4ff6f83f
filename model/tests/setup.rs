//! Set-up mistakes are found on good data that were spoiled, and none is found on good data.

mod spoil;

use std::path::Path;

use runs::DataSet;
use runs::robot::Support;
use spoil::{SPOILS, found};

const SETS: [&str; 5] = [
    "runs/wheel-skew",
    "real/omni3-circles",
    "real/mecanum-circles",
    "real/differential-squares",
    "real/robojackets-excitation",
];

fn open(name: &str) -> DataSet {
    DataSet::open(Path::new(env!("CARGO_MANIFEST_DIR")).join("../data").join(name)).unwrap()
}

#[test]
fn good_data_have_none() {
    for name in SETS {
        let set = open(name);
        let mistakes = found(set.robot, &set.runs);
        assert!(
            mistakes.is_empty(),
            "{name}: {:?}",
            mistakes.iter().map(model::setup::Mistake::sentence).collect::<Vec<_>>()
        );
    }
}

#[test]
fn every_mistake_is_found_on_every_set_that_can_show_it() {
    let mut missed = Vec::new();
    for name in SETS {
        let set = open(name);
        for spoil in SPOILS.iter().filter(|s| (s.shows)(&set)) {
            let mistakes = spoil.found(&set);
            if !mistakes.iter().any(|m| spoil.kinds.contains(&m.kind)) {
                let said: Vec<String> = mistakes.iter().map(|m| format!("[{}] {}", m.kind, m.sentence())).collect();
                missed.push(format!("{name}: {}: {said:?}", spoil.name));
            }
        }
    }
    assert!(missed.is_empty(), "{}", missed.join("\n"));
}

/// On blocks the body does not move: nobody has to weigh it before its battery can be doubted.
#[test]
fn an_axis_on_blocks_shows_another_battery_without_a_mass() {
    let mut set = open("runs/wheel-skew");
    set.robot = set.robot.first_axes(1);
    set.robot.support = Support::Blocks;
    set.robot.missing = ["mass_kg", "yaw_inertia_kg_m2"].map(str::to_owned).to_vec();
    for run in &mut set.runs {
        run.counts.truncate(1);
        run.count_gaps.truncate(1);
        run.reference.truncate(1);
        run.duty.truncate(1);
        run.measured.truncate(1);
        (run.command, run.has_camera) = (None, false);
        run.camera.clear();
    }
    let kinds = |mistakes: Vec<model::setup::Mistake>| mistakes.iter().map(|m| m.kind).collect::<Vec<_>>();
    assert_eq!(kinds(found(set.robot.clone(), &set.runs)), [""; 0]);
    let other = SPOILS.iter().find(|spoil| spoil.kinds == ["supply"]).expect("a spoilt supply");
    assert_eq!(kinds(other.found(&set)), ["supply"]);
}
