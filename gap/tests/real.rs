//! Recordings of real machines (data/real), read as an expert's least squares reads them, and every data set of the
//! repository analysed again with the file that its first analysis wrote.

use std::path::{Path, PathBuf};

use gap::{Analysis, Evidence, Interval, Options, Verdict, analyse};
use runs::DataSet;
use runs::robot::Robot;

fn folder(set: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../data").join(set)
}

/// Analyses a set twice, the second time with what the first wrote.
fn twice(set: &str) -> (Analysis, Analysis) {
    let path = folder(set);
    let data = DataSet::open(&path).unwrap();
    let first = analyse(&data, &Options::default()).unwrap();
    let robot = Robot::parse(&first.robot_text, &path.join("robot.toml")).unwrap();
    let again = analyse(&DataSet { robot, ..data }, &Options::default()).unwrap();
    for a in [&first, &again] {
        is_honest(a);
    }
    let figure = |a: &Analysis, key: &str| a.to_json()["gap"][key].as_f64().unwrap();
    let (after, before) = (figure(&first, "after"), figure(&again, "before"));
    assert!(
        (after - before).abs() <= 1e-9 * after,
        "{set}: {after} written, {before} found\n{}",
        first.terminal_summary()
    );
    // Headline, bars and table say the same.
    let bars = &first.waterfall;
    assert!((bars[bars.len() - 2].1 - after).abs() <= 1e-6 * after, "{set}: {bars:?}, {after}");
    (first, again)
}

/// What no report may hold, whatever the data.
fn is_honest(a: &Analysis) {
    for e in &a.effects {
        if let Evidence::Test { p, .. } = e.evidence {
            assert!(p <= 0.05, "{}: p = {p}", e.name);
            let sized =
                e.parameters.iter().filter_map(|p| if let Interval::Ci95(ends) = p.2 { Some(ends) } else { None });
            let away = sized.clone().any(|[low, high]| low > 0.0 || high < 0.0);
            assert!(away, "{}: every interval holds 0: {:?}", e.name, e.parameters);
        }
    }
    let json = a.to_json();
    for e in json["effects"].as_array().unwrap() {
        assert!(["test", "replay", "pattern"].contains(&e["evidence"]["kind"].as_str().unwrap()), "{e}");
        assert_eq!(e["p_value"].is_null(), e["evidence"]["kind"] == "replay" || e["evidence"]["p"].is_null(), "{e}");
    }
    if a.verdict == Verdict::Agrees {
        for l in a.links.iter().filter(|l| l.link == links::effect::Link::Motion) {
            assert!(l.after < 3.0, "agrees at {} floors\n{}", l.after, a.terminal_summary());
        }
    }
}

fn names(a: &Analysis) -> Vec<&str> {
    a.effects.iter().map(|e| e.name.as_str()).collect()
}

/// A named parameter and its interval.
fn value(a: &Analysis, effect: &str, parameter: &str) -> (f64, [f64; 2]) {
    let e = a.effects.iter().find(|e| e.name == effect).unwrap_or_else(|| panic!("{effect}\n{}", a.terminal_summary()));
    let p = e.parameters.iter().find(|p| p.0 == parameter).unwrap();
    (p.1, p.2.ends().unwrap())
}

/// Whether a named parameter is near what the expert fits, and its interval holds that.
#[track_caller]
fn reads(a: &Analysis, effect: &str, parameter: &str, expert: f64, off: f64) {
    let (v, [low, high]) = value(a, effect, parameter);
    assert!((v - expert).abs() < off, "{effect} {parameter}: {v}, by an expert {expert}");
    assert!(low < expert && expert < high, "{effect} {parameter}: {expert} is not in {low} to {high}");
}

#[test]
fn three_omni_wheels_read_as_an_expert_reads_them() {
    let (a, _) = twice("real/omni3-circles");
    assert!(matches!(a.verdict, Verdict::MissingEffect | Verdict::Ambiguous), "{}", a.terminal_summary());
    reads(&a, "wheel-radius-common", "scale", -0.041, 0.006);
    reads(&a, "marker-offset", "x_m", 0.029, 0.004);
    reads(&a, "marker-offset", "y_m", -0.035, 0.004);
    assert!(!names(&a).iter().any(|n| ["wheel-skew", "wheel-radius", "wheel-angle"].contains(n)), "{:?}", names(&a));
}

#[test]
fn four_mecanum_wheels_read_as_an_expert_reads_them() {
    let (a, _) = twice("real/mecanum-circles");
    assert!(matches!(a.verdict, Verdict::MissingEffect | Verdict::Ambiguous), "{}", a.terminal_summary());
    // By an expert +9.5 %; the interval of 0.4 % ends a little below.
    assert!((value(&a, "wheel-radius-common", "scale").0 - 0.095).abs() < 0.006);
    reads(&a, "body-radius", "scale", 0.054, 0.008);
    reads(&a, "sideways-creep", "scale", -0.044, 0.006);
    assert!(!names(&a).iter().any(|n| ["wheel-skew", "wheel-radius", "wheel-angle"].contains(n)), "{:?}", names(&a));
}

#[test]
fn two_wheels_are_read_and_never_called_false() {
    let (a, _) = twice("real/differential-squares");
    // An expert fits frames 27 ms early and half a track 1.1 % wider; clocks of single runs are late together as well, and no
    // latency is named beside them.
    assert_eq!(names(&a), ["camera-clock", "body-radius"], "{}", a.terminal_summary());
    let [first, second] = ["offset_1_s", "offset_2_s"].map(|p| value(&a, "camera-clock", p).0);
    assert!((0.5 * (first + second) + 0.027).abs() < 0.005, "{}", a.terminal_summary());
    reads(&a, "body-radius", "scale", 0.011, 0.003);
}

#[test]
fn a_radio_robot_is_not_called_in_agreement() {
    let (a, _) = twice("real/robojackets-excitation");
    assert_ne!(a.verdict, Verdict::Agrees, "{}", a.terminal_summary());
}

#[test]
fn the_example_is_read_again_with_what_it_wrote() {
    let (a, again) = twice("runs/wheel-skew");
    assert_eq!(names(&a), ["wheel-skew"]);
    assert_eq!((again.verdict, names(&again)), (Verdict::Agrees, vec![]), "{}", again.terminal_summary());
}
