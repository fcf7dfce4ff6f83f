//! Logs that hold less, or something else, than the usual.

use std::path::{Path, PathBuf};

use super::common::{cut, cut_all, example, names, run, simulate, value, with};
use gap::{Analysis, GapError, Options, Verdict, analyse};
use model::manoeuvre::Manoeuvre;
use runs::robot::{Layout, Robot, Support};
use runs::{DataSet, Run};

use Manoeuvre::{Blocks, Chirp, Spin, Star};

const SKEW: [(&str, f64); 2] = [("skew_1_rad", 0.06), ("skew_3_rad", -0.05)];

fn done(set: &DataSet) -> Analysis {
    let a = analyse(set, &Options::default()).unwrap();
    assert!(!a.terminal_summary().contains("NaN") && !a.html().contains("NaN"), "{}", a.terminal_summary());
    a
}

#[test]
fn missing_columns_narrow_what_is_compared() {
    let set = example();
    let without = |change: &dyn Fn(&mut Run)| {
        let mut set = set.clone();
        set.runs.iter_mut().for_each(change);
        set
    };
    let links = |a: &Analysis| a.links.iter().map(|l| l.link.name()).collect::<Vec<_>>();
    let a = done(&without(&|r| r.duty.clear()));
    assert_eq!((names(&a), links(&a)), (vec!["wheel-skew"], vec!["motion", "timing", "command"]));
    let a = done(&without(&|r| {
        r.camera.clear();
        r.has_camera = false;
    }));
    assert_eq!(links(&a), ["drive", "command", "controller"]);
    assert!(a.effects.iter().all(|e| e.name != "wheel-skew"));
    let a = done(&without(&|r| r.command = None));
    assert_eq!((names(&a), links(&a)), (vec!["wheel-skew"], vec!["motion", "drive", "timing", "controller"]));
    let a = done(&without(&|r| r.reference.clear()));
    assert_eq!((names(&a), links(&a)), (vec!["wheel-skew"], vec!["motion", "drive", "timing"]));
    // Commands and set points alone: one link, and it agrees.
    let a = done(&without(&|r| {
        r.counts.clear();
        r.duty.clear();
        r.camera.clear();
        r.has_camera = false;
    }));
    assert_eq!((a.verdict, links(&a)), (Verdict::Agrees, vec!["command"]));
    assert!(a.terminal_summary().starts_with("What could be compared agrees, and that is no motor"));
    // Duties for which robot.toml says too little: that is what is missing, and no signal.
    let mut few = without(&|r| {
        r.camera.clear();
        r.has_camera = false;
        r.command = None;
        r.reference.clear();
    });
    few.robot.missing.extend(["mass_kg", "motor.resistance_ohm"].map(str::to_owned));
    let error = analyse(&few, &Options::default()).err();
    assert_eq!(error, Some(GapError::Lacking("mass_kg, motor.resistance_ohm".to_owned())));
    let nothing = analyse(&without(&|r| *r = Run { t: r.t.clone(), ..Run::default() }), &Options::default());
    assert!(matches!(nothing, Err(GapError::NothingToCompare)));
    // Measured where each run began and ended.
    let ends = without(&|r| {
        r.duty.clear();
        r.command = None;
        r.reference.clear();
        let last = r.camera.len() - 1;
        let mut frames = 0..=last;
        r.camera.retain(|_| frames.next().is_some_and(|k| k == 0 || k == last));
    });
    assert_eq!(analyse(&ends, &Options::default()).err(), Some(GapError::FewPoses));
}

/// A set as read from logs that have positions alone, and no duties.
fn positions(set: DataSet) -> DataSet {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("robot.toml"), set.robot.to_toml()).unwrap();
    for mut run in set.runs {
        run.duty.clear();
        run.camera.iter_mut().for_each(|sample| sample.pose.theta = f64::NAN);
        let file = std::fs::File::create(folder.path().join(format!("{}.csv", run.name))).unwrap();
        run.write_to(file).unwrap();
    }
    DataSet::open(folder.path()).unwrap()
}

/// GPS, ultra-wideband or a single marker: ways tell sizes and clocks all the same.
#[test]
fn positions_without_headings_narrow_what_is_compared() {
    for (effect, parameter, truth) in [("wheel-radius-common", "scale", 0.04), ("camera-latency", "latency_s", 0.03)] {
        let set = simulate(&with(&Robot::racbot(), effect, &[(parameter, truth)]), &[Star, Spin, Chirp, Star], 41);
        let a = done(&positions(set));
        // Wheels that are all larger by the same, or within the stated tie every wheel by itself.
        let tied = |set: &Vec<String>| set.iter().any(|n| n == effect) && set.iter().any(|n| *n == names(&a)[0]);
        assert!(
            names(&a) == [effect] || names(&a).len() == 1 && a.alternatives.iter().any(tied),
            "{}",
            a.terminal_summary()
        );
        let near = |found: f64| (found - truth).abs() < 0.1 * truth;
        assert!(a.effects[0].parameters.iter().all(|p| near(p.1)), "{parameter}: {}", a.terminal_summary());
        let motion = a.links.iter().find(|l| l.link == links::effect::Link::Motion).unwrap();
        assert_eq!((motion.signals, motion.units.len()), (2, 2));
        assert!(motion.after < 1.3, "{}", a.terminal_summary());
        assert!(a.remarks.iter().any(|r| r.contains("positions have no headings")), "{:?}", a.remarks);
    }
}

/// Turns show in positions as far as they bend ways: little of the noise goes with them, and yet they are named.
#[test]
fn a_body_radius_is_named_by_positions_alone_from_the_limit_that_is_printed() {
    let seen = |scale: f64| {
        let drives = [Star, Spin, Chirp, Manoeuvre::Square, Star, Chirp];
        done(&positions(simulate(&with(&Robot::racbot(), "body-radius", &[("scale", scale)]), &drives, 43)))
    };
    let nothing = seen(0.0);
    assert_eq!((nothing.verdict, names(&nothing)), (gap::Verdict::Agrees, vec![]), "{}", nothing.terminal_summary());
    let limit = nothing.limits.iter().find(|l| l.name == "body-radius").unwrap().limit;
    assert!(limit < 0.06, "{limit}");
    let found = seen(1.2 * limit);
    assert_eq!(names(&found), ["body-radius"], "{}", found.terminal_summary());
    let interval = found.effects[0].parameters[0].2.ends().unwrap();
    assert!(interval[0] < 1.2 * limit && 1.2 * limit < interval[1], "{interval:?}");
}

#[test]
fn one_run_and_two_seconds_are_read_for_what_they_are_worth() {
    let mut set = example();
    set.runs.truncate(1);
    assert_eq!(names(&done(&set)), ["wheel-skew"]);
    cut(&mut set.runs[0], 2.0);
    assert!(done(&set).effects.len() <= 1);
    cut(&mut set.runs[0], 0.2);
    // Too short for anything: an answer or a clear refusal.
    match analyse(&set, &Options::default()) {
        Ok(a) => assert!(a.effects.is_empty(), "{}", a.terminal_summary()),
        Err(e) => assert!(e.to_string().contains("log"), "{e}"),
    }
    set.runs[0].t.truncate(1);
    cut(&mut set.runs[0], 0.0005);
    assert!(analyse(&set, &Options::default()).map_or(true, |a| a.effects.is_empty()));
}

#[test]
fn other_rates_of_control_and_camera() {
    for (control, camera, seconds) in [(20.0, 30.0, 15.0), (100.0, 100.0, 9.0), (10_000.0, 60.0, 3.0)] {
        // Twenty times a second the camera cannot be faster.
        let camera = f64::min(camera, control);
        let nominal = Robot { control_rate_hz: control, camera_rate_hz: camera, ..Robot::racbot() };
        let truth = with(&nominal, "wheel-skew", &SKEW);
        let mut set = simulate(&truth, &[Star, Spin, Chirp], 3);
        set.runs.iter_mut().for_each(|r| cut(r, seconds));
        let a = done(&set);
        assert_eq!(names(&a), ["wheel-skew"], "{control} Hz, camera {camera} Hz: {}", a.terminal_summary());
        assert!((value(&a, "skew_1_rad") - 0.06).abs() < 0.012, "{control} Hz: {}", value(&a, "skew_1_rad"));
    }
}

#[test]
fn stamps_that_are_slightly_irregular() {
    let nominal = Robot { control_rate_hz: 200.0, ..Robot::racbot() };
    let mut set = simulate(&with(&nominal, "wheel-skew", &SKEW), &[Star, Chirp], 4);
    for run in &mut set.runs {
        // The golden ratio again: a tenth of a tick to and fro, without an order.
        for (k, t) in run.t.iter_mut().enumerate() {
            *t += 0.1 / 200.0 * ((k as f64 * 0.618_034).fract() - 0.5);
        }
        cut(run, 9.0);
    }
    assert_eq!(names(&done(&set)), ["wheel-skew"]);
}

#[test]
fn four_wheels_and_mecanum_rollers() {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("../data/robot-four-wheels.toml");
    let four = Robot::load(data).unwrap();
    let set = simulate(&with(&four, "body-radius", &[("scale", 0.04)]), &[Star, Spin], 5);
    let a = done(&set);
    assert_eq!(names(&a), ["body-radius"], "{}", a.terminal_summary());
    assert!((value(&a, "scale") - 0.04).abs() < 0.008);

    let at = |x: f64, y: f64, side: f64| runs::geometry::Wheel {
        x_m: x,
        y_m: y,
        drive_rad: std::f64::consts::FRAC_PI_2,
        roller_rad: side * std::f64::consts::FRAC_PI_4,
    };
    let corners = vec![at(-0.08, 0.09, -1.0), at(0.08, 0.09, 1.0), at(-0.08, -0.09, 1.0), at(0.08, -0.09, -1.0)];
    let mecanum = Robot { layout: Layout::Wheels(corners), ..Robot::racbot() };
    let clean = done(&simulate(&mecanum, &[Star, Spin], 6));
    assert_eq!((clean.verdict, names(&clean)), (Verdict::Agrees, vec![]), "{}", clean.terminal_summary());
    let a = done(&simulate(&with(&mecanum, "camera-latency", &[("latency_s", 0.04)]), &[Star, Spin], 6));
    assert_eq!(names(&a), ["camera-latency"], "{}", a.terminal_summary());
}

#[test]
fn a_slide_on_one_axis_behind_a_current_controller() {
    // No back-EMF, no speed loop in the file, and a log of axis 1 only.
    let mut nominal = Robot { support: Support::Blocks, wheel_inertia_kg_m2: 4e-4, ..Robot::racbot() };
    nominal.motor.back_emf_constant = Some(0.0);
    nominal.motor.friction_torque = 0.0;
    // Only the driver of the simulated slide has to know how fast it may go.
    let driven = Robot { top_speed_rad_s: Some(200.0), ..nominal.clone() };
    let mut truth = with(&driven, "coulomb-friction", &[("torque_nm", 0.012)]);
    truth.effects.extend(with(&driven, "viscous-friction", &[("coefficient_nms", 4e-4)]).effects);
    let folder = tempfile::tempdir().unwrap();
    let text = nominal.to_toml();
    let (before, after) = text.split_once("\n[pi]").unwrap();
    let after = after.split_once("\n[").map_or(String::new(), |(_, rest)| format!("\n[{rest}"));
    std::fs::write(folder.path().join("robot.toml"), format!("# The slide\n{before}{after}")).unwrap();
    for seed in 0..2 {
        let run = run(&truth, Blocks, seed);
        let mut csv = String::from("t,enc_1,duty_1\n");
        for k in 0..run.len() {
            csv += &format!("{:.4},{},{:.4}\n", run.t[k], run.counts[0][k], run.duty[0][k]);
        }
        std::fs::write(folder.path().join(format!("run_{seed}.csv")), csv).unwrap();
    }
    let set = DataSet::open(folder.path()).unwrap();
    assert_eq!(set.robot.wheel_count(), 1);
    let a = done(&set);
    let mut found = names(&a);
    found.sort_unstable();
    assert_eq!(found, ["coulomb-friction", "viscous-friction"], "{}", a.terminal_summary());
    assert!((value(&a, "torque_nm") / 0.012 - 1.0).abs() < 0.15, "{}", a.terminal_summary());
    assert!((value(&a, "coefficient_nms") / 4e-4 - 1.0).abs() < 0.15, "{}", a.terminal_summary());
    assert!(a.robot_text.starts_with("# The slide") && a.robot_text.contains("body_radius_m"), "{}", a.robot_text);
}

#[test]
fn a_camera_whose_rate_nobody_gave() {
    let mut set = simulate(&with(&Robot::racbot(), "camera-latency", &[("latency_s", 0.05)]), &[Star, Spin], 8);
    set.robot.camera_rate_hz = 0.0;
    let a = done(&set);
    assert_eq!(names(&a), ["camera-latency"], "{}", a.terminal_summary());
    assert!((value(&a, "latency_s") - 0.05).abs() < 0.003, "{}", a.terminal_summary());
}

#[test]
fn duties_of_another_drive_do_not_agree() {
    let mut set = simulate(&Robot::racbot(), &[Chirp, Star], 3);
    for run in &mut set.runs {
        run.duty.iter_mut().for_each(|duty| duty.reverse());
        run.reference.clear();
    }
    let a = done(&set);
    assert_eq!(a.verdict, Verdict::Unexplained, "{}", a.terminal_summary());
    assert!(a.unexplained.iter().any(|u| u.link.name() == "drive"), "{}", a.terminal_summary());
}

#[test]
fn lifted_wheels_are_compared_axis_by_axis_one_alone_as_well() {
    let nominal = Robot { support: Support::Blocks, wheel_inertia_kg_m2: 2e-5, ..Robot::racbot() };
    let truth = with(&nominal, "coulomb-friction", &[("torque_nm", 0.012)]);
    let mut set = simulate(&truth, &[Blocks, Blocks], 1);
    cut_all(&mut set, 6.0);
    let a = done(&set);
    assert_eq!(names(&a), ["coulomb-friction"], "{}", a.terminal_summary());
    assert!(a.links.iter().all(|l| l.link.name() != "motion"));
    // Only wheel 2 turned, and only there the effect can be known.
    let truth = with(&nominal, "coulomb-friction", &[("torque_2_nm", 0.015)]);
    let alone: Vec<Run> = (0..2)
        .map(|seed| {
            let mut run = run(&truth, Blocks, seed);
            let (from, to) = (run.len() / 3, 2 * run.len() / 3);
            let keep = |v: &mut Vec<f64>| *v = v[from..to].to_vec();
            run.reference.iter_mut().chain(&mut run.duty).for_each(keep);
            run.command.iter_mut().flatten().for_each(keep);
            run.supply_v.iter_mut().for_each(keep);
            keep(&mut run.t);
            run.counts.iter_mut().for_each(|c| *c = c[from..to].to_vec());
            run.camera.clear();
            run.has_camera = false;
            run
        })
        .collect();
    let a = done(&DataSet { folder: PathBuf::from("alone"), robot: nominal, runs: alone });
    assert_eq!(names(&a), ["coulomb-friction"], "{}", a.terminal_summary());
    assert!((value(&a, "torque_2_nm") / 0.015 - 1.0).abs() < 0.2 || a.effects[0].wheels.is_empty());
}

/// A name that leaves much is not all: the headline says how much, where a camera that bends the field lies beside it.
#[test]
fn the_headline_says_where_much_remains() {
    let seen = |bend_m: f64| {
        let truth = with(&Robot::racbot(), "wheel-radius-common", &[("scale", 0.4)]);
        let mut set = simulate(&truth, &[Star, Spin, Chirp, Star], 43);
        for run in &mut set.runs {
            for sample in &mut run.camera {
                let p = sample.pose;
                sample.pose.x += bend_m * (25.0 * p.y).sin();
                sample.pose.y += bend_m * (25.0 * p.x).sin();
            }
        }
        let a = done(&set);
        let text = a.terminal_summary();
        assert!(names(&a).iter().any(|n| n.starts_with("wheel-radius")), "{text}");
        text.split("\n\n").next().unwrap_or_default().split_whitespace().collect::<Vec<_>>().join(" ")
    };
    let straight = seen(0.0);
    assert!(!straight.contains("and more"), "{straight}");
    let bent = seen(0.03);
    assert!(bent.contains(", and more: ") && bent.contains("noise floors remain on the motion link."), "{bent}");
}
