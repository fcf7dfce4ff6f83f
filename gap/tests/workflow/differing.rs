//! Data sets whose runs are not of one robot as it was.

use gap::{Analysis, Options, Verdict, analyse};
use model::manoeuvre::Manoeuvre::{self, Chirp, FullDuty, Star, StopAndGo};
use runs::DataSet;
use runs::robot::Robot;

use super::common::{RICH, names, simulate, with};

/// Runs of one robot, and the same drives of another or of the same as it was later; without what the logs say of the supply.
fn sessions(first: &Robot, later: &Robot, drives: [Manoeuvre; 3], seed: u64) -> DataSet {
    let mut set = simulate(first, &drives, seed);
    set.runs.extend(simulate(later, &drives, seed + 1).runs);
    for (k, run) in set.runs.iter_mut().enumerate() {
        run.name = format!("run_{}", k + 1);
        run.supply_v = None;
    }
    set
}

fn said(a: &Analysis) -> Vec<&String> {
    a.unexplained.iter().map(|u| &u.structure).filter(|s| s.starts_with("the runs differ: ")).collect()
}

fn of(set: &DataSet) -> Analysis {
    analyse(set, &Options::default()).unwrap()
}

#[test]
fn another_scale_in_one_session_is_told_as_such() {
    let robot = Robot::racbot();
    for (seed, size) in [(80, 0.06), (82, -0.05)] {
        let mut set = sessions(&robot, &with(&robot, "camera-scale", &[("scale", size)]), RICH, seed);
        set.runs.iter_mut().for_each(|run| run.duty.clear());
        let a = of(&set);
        let told = said(&a);
        assert!(told.len() == 1 && a.verdict == Verdict::Unexplained, "{}", a.terminal_summary());
        assert!(told[0].contains("camera-scale (scale) of "), "{told:?}");
        let value = |run: &str| {
            let before = told[0].split(&format!(" % in {run}")).next().unwrap();
            before.rsplit([' ', '+']).next().unwrap().parse::<f64>().unwrap()
        };
        // Where it only turns it shows no scale.
        for (run, truth) in [("run_1", 0.0), ("run_3", 0.0), ("run_4", 100.0 * size), ("run_6", 100.0 * size)] {
            assert!((value(run) - truth).abs() < 0.8, "{run}: {told:?}");
        }
    }
}

#[test]
fn another_battery_or_load_in_one_session_is_told_as_such() {
    let robot = Robot::racbot();
    let empty = Robot { supply_v: 0.85 * robot.supply_v, ..robot.clone() };
    let laden = with(&robot, "robot-mass", &[("scale", 0.35)]);
    for (seed, later, name) in [(84, empty, "supply-voltage (scale)"), (86, laden, "robot-mass")] {
        let a = of(&sessions(&robot, &later, [StopAndGo, FullDuty, Chirp], seed));
        let told = said(&a);
        assert!(told.len() == 1 && told[0].contains(name), "{}", a.terminal_summary());
        assert_eq!(a.verdict, Verdict::Unexplained, "{}", a.terminal_summary());
    }
}

/// Its payload divides what the motors give: a straight line from the file gives two thirds of it.
#[test]
fn a_payload_in_one_session_has_its_size() {
    let robot = Robot::racbot();
    let laden = with(&robot, "robot-mass", &[("scale", 0.5)]);
    let a = of(&sessions(&robot, &laden, [StopAndGo, FullDuty, Chirp], 92));
    let told = said(&a);
    assert!(told.len() == 1 && told[0].contains("robot-mass (scale)"), "{}", a.terminal_summary());
    let size = told[0].split(" % in run_6").next().unwrap().rsplit('+').next().unwrap().parse::<f64>().unwrap();
    assert!((size - 50.0).abs() < 5.0, "{told:?}");
}

#[test]
fn runs_of_one_robot_do_not_differ() {
    let robot = Robot::racbot();
    let larger = with(&robot, "wheel-radius-common", &[("scale", 0.03)]);
    for (seed, truth, drives) in [(88, &robot, [StopAndGo, FullDuty, Star]), (90, &larger, RICH)] {
        let a = of(&sessions(truth, truth, drives, seed));
        assert!(said(&a).is_empty(), "{:?} {:?}", said(&a), names(&a));
    }
}
