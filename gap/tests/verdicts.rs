//! Verdicts on logs in which there is little to compare, or the same twice.

use std::path::Path;

use gap::{Analysis, Options, Verdict, analyse};
use runs::DataSet;

fn example() -> DataSet {
    DataSet::open(Path::new(env!("CARGO_MANIFEST_DIR")).join("../data/runs/wheel-skew")).unwrap()
}

fn done(set: &DataSet) -> Analysis {
    analyse(set, &Options::default()).unwrap()
}

#[test]
fn a_robot_that_never_moved_is_not_compared() {
    let mut set = example();
    for run in &mut set.runs {
        run.counts.iter_mut().for_each(|c| c.fill(7));
        run.duty.iter_mut().chain(&mut run.reference).for_each(|d| d.fill(0.0));
        run.command.iter_mut().flatten().for_each(|c| c.fill(0.0));
        let first = run.camera[0].pose;
        run.camera.iter_mut().for_each(|c| c.pose = first);
    }
    let a = done(&set);
    assert_eq!(a.verdict, Verdict::NotCompared, "{}", a.terminal_summary());
    assert!(a.remarks.iter().any(|r| r.contains("no wheel turns")), "{:?}", a.remarks);
    assert_eq!(a.to_json()["verdict"], "not-compared");
}

#[test]
fn times_in_milliseconds_are_not_compared() {
    let mut set = example();
    for run in &mut set.runs {
        run.t.iter_mut().for_each(|t| *t *= 1000.0);
    }
    let a = done(&set);
    assert_eq!(a.verdict, Verdict::NotCompared, "{}", a.terminal_summary());
    assert!(a.effects.is_empty() && a.remarks.iter().any(|r| r.contains("milliseconds")), "{:?}", a.remarks);
}

#[test]
fn a_recording_written_twice_gives_the_verdict_of_one() {
    let set = example();
    let mut twice = set.clone();
    for run in &set.runs {
        let mut copy = run.clone();
        copy.name += "_copy";
        twice.runs.push(copy);
    }
    let names = |a: &Analysis| a.effects.iter().map(|e| e.name.clone()).collect::<Vec<_>>();
    let (once, twice) = (done(&set), done(&twice));
    assert_eq!((once.verdict, names(&once)), (twice.verdict, names(&twice)), "{}", twice.terminal_summary());
}
