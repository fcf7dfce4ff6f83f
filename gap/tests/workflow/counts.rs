//! Counts a wheel turn stand in the file, in the controller and in the encoder: whose number is wrong.

use super::common::{RICH, cut_all, names, simulate, value, with};
use gap::evidence::Evidence;
use gap::{Analysis, Options, Verdict, analyse};
use links::effect::Link;
use model::manoeuvre::Manoeuvre;
use runs::DataSet;
use runs::robot::{Robot, Support};

/// By how much more counts the encoder gives than the file says, or the controller reckons with; each on a seed of its own.
const SIZES: [f64; 4] = [0.03, -0.03, 0.25, -0.2];

fn analysed(set: &DataSet) -> Analysis {
    analyse(set, &Options::default()).unwrap()
}

/// Duties as a controller rounds them that says how.
fn rounded(robot: &Robot) -> Robot {
    Robot { duty_quantum: Some(0.001), ..robot.clone() }
}

/// Six seconds of each drive: a replay tells counts from far less.
fn driven(truth: &Robot, seed: u64) -> DataSet {
    let mut set = simulate(truth, &RICH, seed);
    cut_all(&mut set, 6.0);
    set
}

/// The file's number of counts a turn is another than the robot's, which its controller knows.
fn miscounted(mut set: DataSet, size: f64) -> DataSet {
    set.robot.encoder_counts_per_motor_rev /= 1.0 + size;
    set
}

fn before(a: &Analysis, link: Link) -> f64 {
    a.links.iter().find(|l| l.link == link).map_or(f64::NAN, |l| l.before)
}

/// The file that was written, read again, gives what was said it would.
fn agrees_again(set: &DataSet, first: &Analysis) {
    let again = analysed(&DataSet { robot: first.robot.clone(), ..set.clone() });
    assert_eq!((again.verdict, names(&again)), (Verdict::Agrees, vec![]), "{}", again.terminal_summary());
    for link in &first.links {
        let read = before(&again, link.link);
        assert!((read / link.after - 1.0).abs() < 1e-6, "{:?}: {} then {read}", link.link, link.after);
    }
}

fn said(a: &Analysis, what: &str) -> bool {
    a.remarks.iter().any(|r| r.contains(what))
}

#[test]
fn a_file_with_other_counts_than_controller_and_camera_is_wrong_and_not_the_radius() {
    for (k, size) in SIZES.into_iter().enumerate() {
        let robot = if k % 2 == 0 { Robot::racbot() } else { rounded(&Robot::racbot()) };
        let set = miscounted(driven(&robot, 70 + k as u64), size);
        let a = analysed(&set);
        let text = a.terminal_summary();
        assert_eq!((a.verdict, names(&a)), (Verdict::MissingEffect, vec!["encoder-scale"]), "{text}");
        assert!(a.alternatives.is_empty() && a.unexplained.is_empty() && a.next_experiment.is_none(), "{text}");
        for parameter in ["scale", "loop_scale"] {
            let known = a.effects[0].parameters.iter().find(|p| p.0 == parameter).unwrap();
            let [low, high] = known.2.ends().unwrap();
            assert!((known.1 - size).abs() < 3e-4 && low <= size && size <= high, "{known:?}: {text}");
        }
        let Evidence::Replay { nominal, with } = a.effects[0].evidence else { panic!("{text}") };
        assert!(
            with.all > 40_000 && nominal.wrong_share() > 1.0 / 3.0 && with.wrong_share() < 0.001,
            "{nominal:?} {with:?}"
        );
        assert!(said(&a, "wrong in the file, and not the radius"), "{text}");
        agrees_again(&set, &a);
    }
}

#[test]
fn a_gear_ratio_is_no_radius_either() {
    let mut set = driven(&Robot::racbot(), 76);
    set.robot.gear_ratio *= 1.15;
    let a = analysed(&set);
    assert!(names(&a).contains(&"encoder-scale"), "{}", a.terminal_summary());
    assert!(!names(&a).contains(&"wheel-radius-common"), "{}", a.terminal_summary());
    assert!((value(&a, "scale") - (1.0 / 1.15 - 1.0)).abs() < 3e-4, "{}", a.terminal_summary());
    assert!(said(&a, "A gear ratio of 3.71"), "{:?}", a.remarks);
}

#[test]
fn a_controller_with_other_counts_than_file_and_camera_is_wrong_itself() {
    for (k, size) in SIZES.into_iter().enumerate() {
        let robot = if k % 2 == 1 { Robot::racbot() } else { rounded(&Robot::racbot()) };
        let set = driven(&with(&robot, "encoder-scale", &[("loop_scale", size)]), 80 + k as u64);
        let a = analysed(&set);
        let text = a.terminal_summary();
        assert_eq!((a.verdict, names(&a)), (Verdict::MissingEffect, vec!["encoder-scale"]), "{text}");
        assert_eq!((a.effects[0].link, a.effects[0].parameters.len()), (Link::Controller, 1), "{text}");
        assert!((value(&a, "loop_scale") - size).abs() < 3e-4, "{text}");
        assert!(said(&a, "its number is wrong in the controller"), "{text}");
        agrees_again(&set, &a);
    }
}

#[test]
fn a_radius_stays_tied_with_counts_that_are_wrong_twice_and_the_replay_is_told() {
    for (k, size) in SIZES.into_iter().enumerate() {
        let set = driven(&with(&Robot::racbot(), "wheel-radius-common", &[("scale", size)]), 90 + k as u64);
        let a = analysed(&set);
        assert_eq!(names(&a), ["wheel-radius-common"], "{}", a.terminal_summary());
        assert!(said(&a, "The controller reckons with the file's counts a turn: 0 of"), "{:?}", a.remarks);
        assert_eq!(said(&a, "Wheels that slip alike"), size < -0.05, "{:?}", a.remarks);
    }
    // Nobody's number is the encoder's: the same motion, and the same duties.
    let set = driven(&with(&Robot::racbot(), "encoder-scale", &[("scale", 0.1)]), 96);
    let a = analysed(&set);
    let tie = ["wheel-radius-common", "encoder-scale"];
    assert!(a.alternatives.iter().any(|s| tie.iter().all(|n| s.iter().any(|x| x == n))), "{}", a.terminal_summary());
}

/// Beside them, radii and skews that are none of the controller's.
#[test]
fn counts_are_told_beside_what_else_moves_the_camera() {
    let skews = [("skew_1_rad", 0.07), ("skew_2_rad", -0.05), ("skew_3_rad", 0.035)];
    let besides: [(&str, &[(&str, f64)]); 2] = [("wheel-skew", &skews), ("body-radius", &[("scale", 0.05)])];
    for (k, (name, parameters)) in besides.into_iter().enumerate() {
        let truth = with(&Robot::racbot(), name, parameters);
        let size = [0.05, -0.1][k];
        let a = analysed(&miscounted(driven(&truth, 100 + k as u64), size));
        let mut found = names(&a);
        found.sort_unstable();
        let mut both = vec![name, "encoder-scale"];
        both.sort_unstable();
        assert_eq!(found, both, "{size}: {}", a.terminal_summary());
        assert!((value(&a, "loop_scale") - size).abs() < 3e-4, "{}", a.terminal_summary());
        assert!(said(&a, "wrong in the file"), "{:?}", a.remarks);
    }
}

/// What shows no counts of the controller's says nothing of them.
#[test]
fn without_a_loop_by_counts_nothing_of_the_controllers_number_is_said() {
    let mut set = miscounted(driven(&Robot::racbot(), 110), 0.1);
    // What these logs say of the drive is no matter here.
    cut_all(&mut set, 5.0);
    let mut no_gains = set.clone();
    (no_gains.robot.pi.kp, no_gains.robot.pi.ki) = (0.0, 0.0);
    // The loop's own speeds, whatever they were made of.
    let mut measured = set.clone();
    let per_count = Robot::racbot().control_rate_hz / Robot::racbot().counts_per_wheel_rad();
    for run in &mut measured.runs {
        let speeds = |c: &Vec<i64>| {
            let moved = |k: usize| c[k] - k.checked_sub(1).map_or(0, |before| c[before]);
            (0..c.len()).map(|k| moved(k) as f64 * per_count).collect()
        };
        run.measured = run.counts.iter().map(speeds).collect();
    }
    // Another law that nobody knows.
    let mut other_law = set;
    for run in &mut other_law.runs {
        run.duty.iter_mut().flatten().for_each(|d| *d = d.signum() * d.abs().powf(1.3));
    }
    for set in [no_gains, measured, other_law] {
        let a = analysed(&set);
        assert!(!said(&a, "The controller reckons"), "{:?}", a.remarks);
        assert!(a.effects.iter().all(|e| e.parameters.iter().all(|p| p.0 != "loop_scale")), "{}", a.terminal_summary());
    }
}

/// Without a camera the motors tell: by the file's number their back-EMF would be another.
#[test]
fn without_a_camera_the_drive_tells_whose_number_is_wrong() {
    let file = miscounted(driven(&Robot::racbot(), 8), 0.1);
    let controller = driven(&with(&Robot::racbot(), "encoder-scale", &[("loop_scale", -0.1)]), 9);
    for (mut set, what, parameters) in
        [(file, "wrong in the file", 2), (controller, "its number is wrong in the controller", 1)]
    {
        for run in &mut set.runs {
            (run.camera, run.has_camera) = (Vec::new(), false);
        }
        let a = analysed(&set);
        let text = a.terminal_summary();
        assert_eq!((names(&a), a.effects[0].parameters.len()), (vec!["encoder-scale"], parameters), "{text}");
        assert!(said(&a, what), "{text}");
        agrees_again(&set, &a);
    }
}

/// Wheels off the floor, which no camera sees: to them counts of another encoder are as much more inertia and braking, and
/// one law in place of two.
#[test]
fn wrong_counts_show_by_the_drive_alone() {
    let nominal = Robot { support: Support::Blocks, wheel_inertia_kg_m2: 2e-5, ..Robot::racbot() };
    let size = -0.45;
    let lifted = |truth: &Robot, seed: u64| {
        let mut set = simulate(truth, &[Manoeuvre::Blocks; 2], seed);
        cut_all(&mut set, 7.0);
        analysed(&set)
    };
    let a = lifted(&with(&nominal, "encoder-scale", &[("scale", size)]), 1);
    let text = a.terminal_summary();
    assert_eq!((names(&a), a.verdict), (vec!["encoder-scale"], Verdict::Ambiguous), "{text}");
    assert!((value(&a, "scale") - size).abs() < 0.03, "{text}");
    let tie = ["encoder-scale", "viscous-friction", "rotor-inertia"];
    assert!(a.alternatives.iter().any(|set| set == &tie), "{text}");
    assert!(text.contains("encoder_counts_per_motor_rev = "), "{text}");
    // A friction with an inertia of its own size is none.
    let mut truth = with(&nominal, "viscous-friction", &[("coefficient_nms", 4e-4)]);
    truth.effects.extend(with(&nominal, "rotor-inertia", &[("scale", 0.9)]).effects);
    let a = lifted(&truth, 3);
    assert!(!names(&a).contains(&"encoder-scale"), "{}", a.terminal_summary());
}

/// A decoder that misses edges of one wheel: without a camera that was friction of this wheel, and a centre of mass beside it.
#[test]
fn lost_edges_of_one_wheel_show_without_a_camera() {
    for (seed, wheel, share) in [(81, 1, 0.5), (83, 0, 0.6)] {
        let mut set = driven(&Robot::racbot(), seed);
        for run in &mut set.runs {
            run.camera.clear();
            run.has_camera = false;
            run.reference.clear();
            run.counts[wheel].iter_mut().for_each(|c| *c = (*c as f64 * share).floor() as i64);
        }
        let a = analysed(&set);
        let text = a.terminal_summary();
        assert_eq!(names(&a), ["encoder-scale"], "{text}");
        assert_eq!(a.effects[0].wheels, [wheel + 1], "{text}");
        let found = value(&a, &format!("scale_{}", wheel + 1));
        assert!((found - (share - 1.0)).abs() < 0.03, "{found}: {text}");
        assert!(said(&a, &format!("encoder-scale of wheel {}, from what the drive does", wheel + 1)), "{text}");
        agrees_again(&set, &a);
    }
}

/// Of one wheel a camera sees a larger radius, and the drive a motor that brakes more: one cause in place of two.
#[test]
fn counts_that_one_encoder_loses_are_no_radius_where_the_drive_has_them() {
    for (seed, scale) in [(97, -0.06), (98, 0.08)] {
        let a = analysed(&driven(&with(&Robot::racbot(), "encoder-scale", &[("scale_2", scale)]), seed));
        let text = a.terminal_summary();
        assert!((value(&a, "scale_2") - scale).abs() < 0.01 && names(&a) == ["encoder-scale"], "{text}");
        let a = analysed(&driven(&with(&Robot::racbot(), "wheel-radius", &[("scale_2", scale)]), seed));
        assert_eq!(names(&a), ["wheel-radius"], "{}", a.terminal_summary());
    }
}
