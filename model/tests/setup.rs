//! Set-up mistakes are found on good data that were spoiled, and none is found on good data.

mod spoil;

use std::path::Path;

use runs::DataSet;
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
