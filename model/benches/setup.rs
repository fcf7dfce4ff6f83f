//! How often set-up mistakes are found: none on simulated sets that hide effects or nothing, every one once it is made.
//! Writes `docs/measured/setup.md`. `cargo bench -p model --bench setup`.

#[path = "../tests/spoil/mod.rs"]
mod spoil;

use runs::DataSet;
use spoil::{SPOILS, found};

/// Sets that hide nothing, and sets of every effect at a middle size.
const EFFECT_FREE: u64 = 120;
const MIDDLE: u8 = 3;
/// Sets that are spoiled.
const SPOILED: u64 = 24;

fn set(seed: u64, kind: &str) -> DataSet {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let case = truth::draw(seed, &kind.parse().expect("a kind")).expect("a case");
    truth::write(&case, folder.path()).expect("a data set");
    DataSet::open(folder.path()).expect("a data set that can be read")
}

fn main() {
    let table = measured::Table {
        name: "setup",
        title: "Set-up mistakes that `racbot check` finds",
        command: "cargo bench -p model --bench setup",
        columns: &["data", "sets", "found", "right answer"],
    };
    let mut rows = Vec::new();
    let mut said = Vec::new();
    let mut good = |name: &str, kinds: &[(u64, String)], alone: bool| {
        let (mut number, mut wrong) = (0, 0);
        for (seed, kind) in kinds {
            let set = set(*seed, kind);
            for runs in set.runs.chunks(if alone { 1 } else { set.runs.len() }) {
                let mistakes = found(set.robot.clone(), runs);
                // An order of wheels that is hidden is there to be found.
                let other = mistakes.iter().filter(|m| !m.nameable);
                said.extend(
                    other.clone().map(|m| format!("{name}, {kind} seed {seed}, {}: {}", runs[0].name, m.sentence())),
                );
                (number, wrong) = (number + 1, wrong + usize::from(other.count() > 0));
            }
        }
        rows.push([name, &number.to_string(), &wrong.to_string(), "none"].map(str::to_owned).to_vec());
    };
    let nothing: Vec<(u64, String)> = (0..EFFECT_FREE).map(|i| (7000 + i, "effect-free".to_owned())).collect();
    let effects = truth::catalogue();
    let hidden = |(i, e): (usize, &truth::Entry)| {
        [0, 1].map(|k| (7500 + 2 * i as u64 + k, format!("single:{}:{MIDDLE}", e.name)))
    };
    let one: Vec<(u64, String)> = effects.enumerate().flat_map(hidden).collect();
    good("hiding nothing", &nothing, false);
    good("hiding one effect", &one, false);
    good("one run alone, hiding nothing", &nothing, true);
    good("one run alone, hiding one effect", &one, true);
    let sets: Vec<DataSet> = (0..SPOILED).map(|i| set(8000 + i, "effect-free")).collect();
    for spoil in SPOILS {
        let can: Vec<&DataSet> = sets.iter().filter(|set| (spoil.shows)(set)).collect();
        let right = can.iter().enumerate().filter(|(i, set)| {
            let mistakes = spoil.found(set);
            let right = mistakes.iter().any(|m| spoil.kinds.contains(&m.kind));
            if !right {
                let kinds: Vec<String> = mistakes.iter().map(model::setup::Mistake::sentence).collect();
                said.push(format!("{} on set {i}: {kinds:?}", spoil.name));
            }
            right
        });
        let right = right.count();
        rows.push([spoil.name, &can.len().to_string(), &right.to_string(), spoil.kinds[0]].map(str::to_owned).to_vec());
    }
    table.write(&rows);
    for row in &rows {
        println!("{}", row.join(" | "));
    }
    for line in said {
        println!("{line}");
    }
}
