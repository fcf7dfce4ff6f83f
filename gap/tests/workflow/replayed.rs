//! Effects of the links that compute: what `robot.toml` states is what they are replayed with.

use super::common::{cut_all, names, simulate, value, with};
use gap::{Analysis, Options, Verdict, analyse};
use links::effect::Link;
use model::manoeuvre::Manoeuvre;
use runs::DataSet;
use runs::frames::Twist;
use runs::robot::Robot;

/// An effect, how it really is, and a statement of it that is false.
const STATED: [(&str, Parameters, Parameters); 4] = [
    ("command-latency", &[("latency_s", 0.03)], &[("latency_s", 0.1)]),
    ("pi-gain", &[("kp_scale", 0.3), ("ki_scale", 0.0)], &[("kp_scale", -0.2), ("ki_scale", 0.0)]),
    ("integrator-windup", &[("limit_duty", 0.3)], &[("limit_duty", 0.1)]),
    ("quantisation", &[("duty_quantum", 0.02)], &[("duty_quantum", 0.05)]),
];

type Parameters = &'static [(&'static str, f64)];

fn set(truth: &Robot) -> DataSet {
    let mut set = simulate(truth, &[Manoeuvre::Star, Manoeuvre::FullDuty], 60);
    cut_all(&mut set, 8.0);
    set
}

fn analysed(set: &DataSet, robot: Robot) -> Analysis {
    analyse(&DataSet { robot, ..set.clone() }, &Options::default()).unwrap()
}

#[test]
fn a_stated_effect_counts_by_its_size_not_by_its_name() {
    for (name, truth, wrong) in STATED {
        let robot = Robot::racbot();
        let set = set(&with(&robot, name, truth));
        let stated = analysed(&set, with(&robot, name, truth));
        assert_eq!(stated.verdict, Verdict::Agrees, "{name}: {}", stated.terminal_summary());
        let first = analysed(&set, robot.clone());
        let mended = analysed(&set, with(&robot, name, wrong));
        for found in [&first, &mended] {
            assert_eq!(names(found), [name], "{}", found.terminal_summary());
            for (parameter, size) in truth {
                assert!((value(found, parameter) - size).abs() < 0.01, "{name}: {}", found.terminal_summary());
            }
            // As written and read again.
            let again = analysed(&set, found.robot.clone());
            assert_eq!(again.verdict, Verdict::Agrees, "{name}: {}", again.terminal_summary());
            let off = found.links.iter().find(|l| l.before > 3.0).unwrap();
            let read = again.links.iter().find(|l| l.link == off.link).unwrap();
            assert!((read.before / off.after - 1.0).abs() < 1e-6, "{name}: {}", again.terminal_summary());
        }
    }
}

/// A control loop whose period is not quite that of its host: for a while every command acts at once, then a tick late.
#[test]
fn commands_that_slide_past_the_tick_are_late_by_a_part_of_it() {
    let mut set = simulate(&Robot::racbot(), &[Manoeuvre::Chirp], 61);
    for run in &mut set.runs {
        let on_time = run.reference.clone();
        for (late, right) in run.reference.iter_mut().zip(&on_time) {
            for k in (1..right.len()).filter(|k| k / 50 % 4 == 3) {
                late[k] = right[k - 1];
            }
        }
        // Counts and duties are those of the loop as it ran: only the command link is asked for.
        run.duty.clear();
    }
    let a = analysed(&set, set.robot.clone());
    assert_eq!(names(&a), ["command-latency"], "{}", a.terminal_summary());
    let tick = 1.0 / set.robot.control_rate_hz;
    // A set point that rests is on time and late at once.
    let late = value(&a, "latency_s") / tick;
    assert!((0.05..=0.25).contains(&late), "{late} ticks: {}", a.terminal_summary());
    let ends = a.effects[0].parameters[0].2.ends().unwrap();
    assert!(ends[0] == 0.0 && (ends[1] / tick - 1.0).abs() < 0.01, "{ends:?}");
    let again = analysed(&set, a.robot.clone());
    assert_eq!(again.verdict, Verdict::Agrees, "{}", again.terminal_summary());
}

/// A host that writes six digits, and set points of the motors that a map brought to the wheels: their steps are no decimals.
#[test]
fn six_digits_are_no_disagreement() {
    let six = |x: f64| -> f64 { format!("{x:.5e}").parse().unwrap() };
    let mut set = set(&Robot::racbot());
    let geometry = set.robot.geometry().unwrap();
    let gear = 16.3;
    for run in &mut set.runs {
        let command = run.command.as_mut().unwrap();
        command.iter_mut().flatten().for_each(|x| *x = six(*x + 0.1));
        for k in 0..run.t.len() {
            let twist = Twist::new(command[0][k], command[1][k], command[2][k]);
            for (reference, speed) in run.reference.iter_mut().zip(geometry.wheel_speeds(twist)) {
                reference[k] = six(speed * gear) / gear;
            }
        }
        run.duty.clear();
        run.camera.clear();
    }
    let a = analysed(&set, set.robot.clone());
    let command = a.links.iter().find(|l| l.link == Link::Command).unwrap();
    assert!(command.before < 1.01, "{}", a.terminal_summary());
    // Four digits are more than that.
    set.runs.iter_mut().flat_map(|run| run.reference.iter_mut().flatten()).for_each(|r| *r *= 1.001);
    let a = analysed(&set, set.robot.clone());
    let command = a.links.iter().find(|l| l.link == Link::Command).unwrap();
    assert!(command.before > 10.0, "{}", a.terminal_summary());
}

/// Set points that follow no command, in a log with a gap every tenth of a second: a latency longer than that compares
/// nothing, and so closes nothing.
#[test]
fn a_latency_that_compares_nothing_is_not_named() {
    let mut set = set(&Robot::racbot());
    for run in &mut set.runs {
        let kept: Vec<usize> = (0..run.t.len()).filter(|k| k % 100 != 7).collect();
        let only = |column: &Vec<f64>| kept.iter().map(|k| column[*k]).collect::<Vec<_>>();
        run.t = only(&run.t);
        run.reference = run
            .reference
            .iter()
            .enumerate()
            .map(|(i, r)| only(r).iter().map(|w| 3.0 + w * w * (i + 1) as f64).collect())
            .collect();
        run.command = run.command.as_ref().map(|c| [only(&c[0]), only(&c[1]), only(&c[2])]);
        run.counts = run.counts.iter().map(|c| kept.iter().map(|k| c[*k]).collect()).collect();
        run.supply_v = run.supply_v.as_ref().map(only);
        run.duty.clear();
        run.camera.clear();
    }
    let a = analysed(&set, set.robot.clone());
    assert!(!names(&a).contains(&"command-latency"), "{}", a.terminal_summary());
    assert!(a.unexplained.iter().any(|u| u.link == Link::Command), "{}", a.terminal_summary());
}

/// With another gear ratio in the file every speed that the loop sees is wrong: no gains replay that, though some leave a
/// tenth of the error's square; other counts do. Of duties by a law that nobody knows nothing is named.
#[test]
fn gains_that_replay_nothing_are_not_named() {
    let set = set(&Robot::racbot());
    for gear_ratio in [4.4, 3.4] {
        let a = analysed(&set, Robot { gear_ratio, ..Robot::racbot() });
        assert!(!names(&a).contains(&"pi-gain"), "{gear_ratio}: {}", a.terminal_summary());
        assert!(names(&a).contains(&"encoder-scale"), "{gear_ratio}: {}", a.terminal_summary());
        let mut unknown = set.clone();
        for duty in unknown.runs.iter_mut().flat_map(|r| r.duty.iter_mut().flatten()) {
            *duty = duty.signum() * duty.abs().powf(1.3);
        }
        let a = analysed(&unknown, Robot { gear_ratio, ..Robot::racbot() });
        assert!(a.effects.iter().all(|e| e.link != Link::Controller), "{gear_ratio}: {}", a.terminal_summary());
        assert!(a.unexplained.iter().any(|u| u.link == Link::Controller), "{gear_ratio}: {:?}", a.unexplained);
    }
}
