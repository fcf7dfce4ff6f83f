//! Set-up mistakes are found on good data that were spoiled, and none is found on good data.

mod spoil;

use std::path::Path;

use model::effects::Applied;
use model::manoeuvre::{Manoeuvre, simulate};
use model::setup::Mistake;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use runs::frames::{Pose, Twist, displacement};
use runs::geometry::Wheel;
use runs::output::Existing;
use runs::robot::{Layout, Robot, Support};
use runs::{CountSource, DataSet, DutySource, Run, Source, as_logged};
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
        assert!(mistakes.is_empty(), "{name}: {:?}", mistakes.iter().map(Mistake::sentence).collect::<Vec<_>>());
    }
}

/// A user may have one log: of straight ways alone the counts tell no turns, and of turns alone no ways.
#[test]
fn good_data_have_none_run_by_run() {
    for name in SETS {
        let set = open(name);
        for run in &set.runs {
            let said: Vec<String> =
                found(set.robot.clone(), std::slice::from_ref(run)).iter().map(Mistake::sentence).collect();
            assert!(said.is_empty(), "{name}, {}: {said:?}", run.name);
        }
    }
}

/// Each manoeuvre of the library by itself; where wheels slip all the time that is said, and is no reason to stop.
#[test]
fn no_manoeuvre_alone_is_set_up_wrong() {
    let file = |name: &str| Robot::load(Path::new(env!("CARGO_MANIFEST_DIR")).join("../data").join(name)).unwrap();
    let three = (Robot::racbot(), file("robot-skewed.toml"));
    for (robot, truth) in [three, (file("robot-four-wheels.toml"), file("robot-four-wheels.toml"))] {
        for manoeuvre in Manoeuvre::ALL.into_iter().filter(|m| m.support() == Support::Floor) {
            let run = simulate(manoeuvre, &Applied::of(&truth), &robot, Pose::default(), 5).unwrap();
            let stopped: Vec<String> =
                found(robot.clone(), &[run]).iter().filter(|m| !m.nameable).map(Mistake::sentence).collect();
            assert!(stopped.is_empty(), "{manoeuvre:?}, {} wheels: {stopped:?}", robot.wheel_count());
        }
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

/// A log of wheel speeds has no encoder to look at: gear and counts have no part in its ways.
#[test]
fn speeds_of_another_shaft_or_unit_are_told_as_such() {
    let said = |factor: f64| {
        let mut set = open("runs/wheel-skew");
        let source = Source { counts: CountSource::Speeds, ..Source::default() };
        let virtual_counts = as_logged(&set.robot, source, None).counts_per_wheel_rad();
        let scale = factor * virtual_counts / set.robot.counts_per_wheel_rad();
        for run in &mut set.runs {
            run.source = source;
            run.reference.clear();
            run.duty.clear();
            run.measured.clear();
            run.counts.iter_mut().flatten().for_each(|n| *n = (*n as f64 * scale).round() as i64);
        }
        let sentences = found(set.robot.clone(), &set.runs).iter().map(Mistake::sentence).collect::<Vec<_>>();
        sentences.join("\n")
    };
    assert_eq!(said(1.0), "");
    let gear = open("runs/wheel-skew").robot.gear_ratio;
    for (factor, expected) in [
        (gear, "speeds of the motors"),
        (60.0 / std::f64::consts::TAU, "turns per minute"),
        (1.6, "else the speeds are of another shaft or unit: multiply them by 0.6"),
    ] {
        let said = said(factor);
        assert!(said.contains(expected) && !said.contains("encoder_counts"), "{factor}: {said}");
    }
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
    let kinds = |mistakes: Vec<Mistake>| mistakes.iter().map(|m| m.kind).collect::<Vec<_>>();
    assert_eq!(kinds(found(set.robot.clone(), &set.runs)), [""; 0]);
    let other = SPOILS.iter().find(|spoil| spoil.kinds == ["supply"]).expect("a spoilt supply");
    assert_eq!(kinds(other.found(&set)), ["supply"]);
}

/// A bench has no camera: counts with or without their decoding show by what the duties achieve.
#[test]
fn a_motor_on_blocks_shows_counts_that_were_not_decoded() {
    let mut robot = Robot::racbot();
    robot.support = Support::Blocks;
    let mut run = simulate(Manoeuvre::Blocks, &Applied::of(&robot), &robot, Pose::default(), 5).unwrap();
    run.reference.clear();
    assert_eq!(found(robot.clone(), std::slice::from_ref(&run)), []);
    let counts = robot.encoder_counts_per_motor_rev;
    for factor in [0.25, 4.0] {
        robot.encoder_counts_per_motor_rev = factor * counts;
        let said = found(robot.clone(), std::slice::from_ref(&run));
        let expected = format!("with encoder_counts_per_motor_rev = {counts},");
        assert!(said.len() == 1 && said[0].remedy.contains(&expected), "{factor}: {said:?}");
    }
}

/// Mecanum wheels 2 and 3 do the same in every translation: swapped, they say that a robot never turns, and so nothing of
/// turns that the camera saw with some noise. A robot that turns little is no robot with crossed cables.
#[test]
fn an_order_that_hides_the_turns_answers_for_them() {
    let mut set = open("real/mecanum-circles");
    let robot = set.robot.clone();
    let geometry = robot.geometry().unwrap();
    let mut random = ChaCha8Rng::seed_from_u64(5);
    for run in &mut set.runs {
        let mut pose = Pose::default();
        let (mut poses, mut angles) = (vec![pose], vec![0.0; run.counts.len()]);
        for k in 1..run.t.len() {
            let (t, dt) = (run.t[k], run.t[k] - run.t[k - 1]);
            let twist = Twist::new(0.3 * (0.9 * t).sin(), 0.3 * (1.3 * t).cos(), 0.35 * (0.7 * t).sin());
            pose = pose.compose(displacement(twist.scaled(dt)));
            poses.push(pose);
            for ((angle, counts), speed) in angles.iter_mut().zip(&mut run.counts).zip(geometry.wheel_speeds(twist)) {
                *angle += speed * dt;
                counts[k] = counts[0] + (*angle * robot.counts_per_wheel_rad()).round() as i64;
            }
        }
        for sample in &mut run.camera {
            sample.pose = poses[sample.tick];
            sample.pose.theta += random.random_range(-0.02..0.02);
        }
    }
    let said = |mistakes: &[Mistake]| mistakes.iter().map(Mistake::sentence).collect::<Vec<_>>();
    let mistakes = found(robot.clone(), &set.runs);
    assert!(mistakes.is_empty(), "{:?}", said(&mistakes));
    // Truly crossed, they are found.
    set.runs.iter_mut().for_each(|run| run.counts.swap(1, 2));
    let mistakes = found(robot, &set.runs);
    let [mistake] = &mistakes[..] else { panic!("{:?}", said(&mistakes)) };
    assert!(
        mistake.kind == "encoder-order" && mistake.sentence().contains("enc_2 and enc_3"),
        "{}",
        mistake.sentence()
    );
}

/// A wheel that is driven and counted the other way goes on, for `wheel-order` says it; a column alone is to be mended.
#[test]
fn counts_alone_that_are_reversed_are_told_from_a_wheel() {
    for wheel in 0..3 {
        let mut set = open("runs/wheel-skew");
        set.runs.iter_mut().for_each(|run| run.command = None);
        let told = |set: &DataSet| {
            let mistakes = found(set.robot.clone(), &set.runs);
            let [mistake] = &mistakes[..] else { panic!("{mistakes:?}") };
            assert_eq!((mistake.kind, &mistake.column), ("encoder-order", &format!("enc_{}", wheel + 1)));
            mistake.nameable
        };
        set.runs.iter_mut().flat_map(|run| &mut run.counts[wheel]).for_each(|c| *c = -*c);
        assert!(!told(&set), "counts {wheel}");
        set.runs.iter_mut().flat_map(|run| &mut run.duty[wheel]).for_each(|d| *d = -*d);
        set.runs.iter_mut().flat_map(|run| &mut run.reference[wheel]).for_each(|r| *r = -*r);
        assert!(told(&set), "wheel {wheel}");
    }
}

/// Two wheels that drive at one speed and turn at another, both in m/s at the rim, with a marker ahead of them; what the
/// wheels read scatters by `noise` m/s.
fn marked_ahead(speed: f64, turn: f64, noise: f64) -> DataSet {
    driving(noise, |t| [speed * (0.9 * t).sin(), turn * (0.6 * t).cos()])
}

/// The same with speed and turn at every time.
fn driving(noise: f64, at: impl Fn(f64) -> [f64; 2]) -> DataSet {
    let mut set = open("real/differential-squares");
    let geometry = set.robot.geometry().unwrap();
    let rim = geometry.wheels()[0].x_m.hypot(geometry.wheels()[0].y_m);
    let mut random = ChaCha8Rng::seed_from_u64(9);
    for run in &mut set.runs {
        let (mut pose, mut angles) = (Pose::default(), vec![0.0; run.counts.len()]);
        let mut poses = vec![pose];
        for k in 1..run.t.len() {
            let (t, dt) = (run.t[k], run.t[k] - run.t[k - 1]);
            let [speed, turn] = at(t);
            let twist = Twist::new(0.0, speed, turn / rim);
            pose = pose.compose(displacement(twist.scaled(dt)));
            poses.push(pose);
            for ((angle, counts), rate) in angles.iter_mut().zip(&mut run.counts).zip(geometry.wheel_speeds(twist)) {
                *angle += (rate + noise * random.random_range(-1.0..1.0) / set.robot.wheel_radius_m) * dt;
                counts[k] = counts[0] + (*angle * set.robot.counts_per_wheel_rad()).round() as i64;
            }
        }
        for sample in &mut run.camera {
            sample.pose = poses[sample.tick].compose(Pose::new(0.0, 0.8 * rim, 0.0));
        }
    }
    set
}

/// Turns show as ways of a marker off the centre, and in short stretches noisy rates hardly tell turns. What is right is
/// not refused, and mistakes are found as with a marker in the middle and good encoders.
#[test]
fn a_marker_off_the_centre_and_noisy_rates_hide_nothing() {
    let said = |set: &DataSet| found(set.robot.clone(), &set.runs).iter().map(Mistake::sentence).collect::<Vec<_>>();
    for (speed, turn, noise) in [(0.1, 0.3, 0.0), (0.3, 0.12, 0.5)] {
        let set = marked_ahead(speed, turn, noise);
        assert_eq!(said(&set), Vec::<String>::new());
        let mut reversed = set.clone();
        reversed.runs.iter_mut().flat_map(|run| &mut run.counts[1]).for_each(|n| *n = -*n);
        let told = said(&reversed);
        assert!(told.len() == 1 && told[0].contains("enc_2 is reversed"), "{told:?}");
        let mut small = set;
        small.robot.wheel_radius_m /= 3.1;
        let told = said(&small);
        assert!(told.len() == 1 && told[0].contains("by the counts are "), "{told:?}");
    }
}

/// A log of one axis on a bench, half a minute, that turns at the speed that `drives` gives for the duty of each two seconds,
/// a tenth of a second late.
fn bench(drives: impl Fn(usize) -> (f64, f64)) -> DataSet {
    let mut set = open("runs/wheel-skew");
    set.robot = set.robot.first_axes(1);
    set.robot.support = Support::Blocks;
    let mut run = set.runs.swap_remove(0);
    (run.has_camera, run.command) = (false, None);
    run.camera.clear();
    run.reference.clear();
    run.measured.clear();
    run.supply_v = None;
    let ticks: Vec<usize> = (0..30_000).collect();
    run.t = ticks.iter().map(|k| *k as f64 * 1e-3).collect();
    run.duty = vec![ticks.iter().map(|k| drives(k / 2000).0).collect()];
    let (mut speed, mut angle) = (0.0, 0.0);
    let per_rad = set.robot.counts_per_wheel_rad();
    let counts = ticks.iter().map(|k| {
        speed += (drives(k / 2000).1 - speed) * 1e-3 / 0.1;
        angle += speed * 1e-3;
        (angle * per_rad).round() as i64
    });
    run.counts = vec![counts.collect()];
    run.count_gaps = vec![Vec::new()];
    set.runs = vec![run];
    set
}

#[test]
fn a_lost_sign_shows_where_there_are_only_two_levels() {
    let kinds = |set: &DataSet| found(set.robot.clone(), &set.runs).iter().map(|m| m.kind).collect::<Vec<_>>();
    let sign = |k: usize| if k.is_multiple_of(2) { 1.0 } else { -1.0 };
    assert_eq!(kinds(&bench(|k| (0.5 * sign(k), 120.0 * sign(k)))), [""; 0]);
    assert_eq!(kinds(&bench(|k| (0.5, 120.0 * sign(k)))), ["drive-unsigned"]);
    // A winch lifts with much and lowers with little; one that only lifts is held by nothing else.
    assert_eq!(kinds(&bench(|k| (if k.is_multiple_of(2) { 0.5 } else { 0.1 }, 80.0 * sign(k)))), [""; 0]);
    assert_eq!(kinds(&bench(|_| (0.5, 120.0))), [""; 0]);
    // Up with much, back with little, and at rest in between: what pulled it back would not have let it rest. A brake that
    // opens for the drive would, but then it runs back the faster the less it is driven.
    let rests = |back: f64| move |k: usize| [(0.5, 120.0), (0.0, 0.0), (back, -60.0), (0.0, 0.0)][k % 4];
    assert_eq!(kinds(&bench(rests(0.2))), ["drive-unsigned"]);
    assert_eq!(kinds(&bench(rests(0.05))), [""; 0]);
}

/// Speeds that stand beside counts are not used; but one of the two is wrong where they differ.
#[test]
fn speeds_in_another_unit_than_the_counts_are_told() {
    let with = |factor: f64| {
        let speed = |k: usize| if k % 3 == 2 { 0.0 } else { 20.0 + 5.0 * k as f64 };
        let mut set = bench(|k| (0.0, speed(k)));
        set.runs[0].duty.clear();
        let per_rad = set.robot.counts_per_wheel_rad();
        let run = &mut set.runs[0];
        // As a firmware counts them, every fifth of a second.
        let counted = |k: usize| (run.counts[0][k] - run.counts[0][k.saturating_sub(200)]) as f64 / 0.2 / per_rad;
        run.speed = vec![(0..run.t.len()).map(|k| factor * counted(k / 200 * 200)).collect()];
        let mistakes = found(set.robot, &set.runs);
        mistakes.iter().filter(|m| m.kind == "speed-counts").map(Mistake::sentence).collect::<String>()
    };
    assert_eq!(with(1.0), "");
    assert_eq!(with(1.2), "");
    for (factor, says) in [(9.55, "turns per minute"), (57.3, "degrees per second"), (-1.0, "the other sense")] {
        assert!(with(factor).contains(says), "{}", with(factor));
    }
    assert!(with(2.55).starts_with("speed_1: it is 2.55 times the speed by the counts; "), "{}", with(2.55));
}

/// A small motor whose bridge coasts takes a duty of 0.15 before it turns and then little more: no word of its battery.
#[test]
fn duties_that_hardly_follow_the_speed_say_nothing_of_a_supply() {
    let kinds = |set: &DataSet| found(set.robot.clone(), &set.runs).iter().map(|m| m.kind).collect::<Vec<_>>();
    let speed = |k: usize| 5.0 + 3.0 * (k % 6) as f64;
    assert_eq!(kinds(&bench(|k| (0.15 + 0.0006 * speed(k), speed(k)))), [""; 0]);
    // With little friction they do: 40 V where the file has 7.2.
    assert_eq!(kinds(&bench(|k| (0.005 + 0.0006 * speed(k), speed(k)))), ["supply"]);
    // Nor does a load that hangs hide it from an axis that turns both ways.
    let both = |k: usize| if k.is_multiple_of(2) { speed(k) } else { -speed(k) };
    assert_eq!(kinds(&bench(|k| (0.05 + 0.0006 * both(k), both(k)))), ["supply"]);
}

/// Duties of a few thousandths that do not follow the speed, on a robot that gains speed: no motor does it with so little.
#[test]
fn duties_that_are_too_small_for_the_work_done_are_told() {
    let mut set = open("runs/wheel-skew");
    let duties = set.runs.iter_mut().flat_map(|run| &mut run.duty);
    duties.for_each(|duty| duty.iter_mut().enumerate().for_each(|(k, d)| *d = 0.001 * (0.1 * k as f64).cos()));
    let kinds: Vec<_> = found(set.robot.clone(), &set.runs).iter().map(|m| m.kind).collect();
    assert_eq!(kinds, ["duty-unit"]);
}

#[test]
fn a_log_in_another_unit_than_the_others_is_named() {
    for factor in [1e-3, 1e3] {
        let mut set = open("runs/wheel-skew");
        set.runs[1].t.iter_mut().for_each(|t| *t *= factor);
        let mistakes = found(set.robot.clone(), &set.runs);
        let odd = mistakes.iter().find(|m| m.kind == "time-unit").unwrap_or_else(|| panic!("{mistakes:?}"));
        assert!(odd.what.starts_with(&format!("{}: ticks are", set.runs[1].name)), "{}", odd.sentence());
    }
}

/// A servo's set points are angles; a speed loop's are speeds.
#[test]
fn set_points_of_a_position_loop_are_no_speeds() {
    let kinds = |set: &DataSet| found(set.robot.clone(), &set.runs).iter().map(|m| m.kind).collect::<Vec<_>>();
    let asked = |t: f64| 3.0 * (1.9 * t).sin() + 2.0 * (0.7 * t).sin();
    let servo = |position: bool, per_rad: f64| {
        let mut set = open("runs/wheel-skew");
        set.robot = set.robot.first_axes(1);
        set.robot.support = Support::Blocks;
        let counts = set.robot.counts_per_wheel_rad();
        set.runs.truncate(1);
        let run = &mut set.runs[0];
        let t: Vec<f64> = (0..3000).map(|k| 0.01 * f64::from(k)).collect();
        run.counts = vec![t.iter().map(|t| (counts * asked(t - 0.08)).round() as i64).collect()];
        run.count_gaps = vec![Vec::new()];
        let speed = |t: f64| (asked(t + 1e-3) - asked(t - 1e-3)) / 2e-3;
        run.reference = vec![t.iter().map(|t| per_rad * if position { asked(*t) } else { speed(*t) }).collect()];
        run.t = t;
        (run.command, run.supply_v, run.has_camera) = (None, None, false);
        run.duty.clear();
        run.measured.clear();
        run.camera.clear();
        set.robot.control_rate_hz = 100.0;
        set
    };
    assert_eq!(kinds(&servo(false, 1.0)), [""; 0]);
    assert_eq!(kinds(&servo(true, 1.0)), ["reference-position"]);
    assert_eq!(kinds(&servo(true, 651.9)), ["reference-position"]);
}

#[test]
fn no_log_says_nothing() {
    assert!(found(open("runs/wheel-skew").robot, &[]).is_empty());
}

/// Wheels that slip at starts excuse a length that is wrong; a counter that once jumped does not.
#[test]
fn one_jump_of_a_counter_is_no_slip() {
    let mut set = open("runs/wheel-skew");
    let counts = &mut set.runs[0].counts[0];
    let middle = counts.len() / 2;
    counts[middle..].iter_mut().for_each(|n| *n += 6000);
    let diameter = SPOILS.iter().find(|spoil| spoil.kinds == ["wheel-diameter"]).expect("a spoilt radius");
    let mistakes = diameter.found(&set);
    assert!(mistakes.iter().any(|m| m.kind == "wheel-diameter" && !m.nameable), "{mistakes:?}");
    assert!(mistakes.iter().all(|m| !m.what.contains("slip")), "{mistakes:?}");
}

/// A pendulum behind a current controller, with a file that has no supply: its inertia takes more than an ampere gives, its
/// friction more than that, and its weight more than the motor lifts. Grams for kilograms are still found.
#[test]
fn currents_say_what_their_motors_gave() {
    let text = "encoder_counts_per_wheel_rev = 65536\ngear_ratio = 1\nsupport = \"blocks\"\nwheel_radius_m = 1\nwheel_inertia_kg_m2 = 0\n\
                [motor]\ntorque_constant = 1\nrotor_inertia = 0.19\nfriction_torque = 1.2\n[[wheel]]\nx_m = 0\ny_m = 0\ndrive_deg = 0\n";
    let robot = Robot::parse_partial(text, Path::new("robot.toml")).unwrap();
    let mut run = Run { name: "run_1".to_owned(), ..Run::default() };
    let (mut angle, mut speed, mut currents, mut counts) = (0.0_f64, 0.0_f64, Vec::new(), Vec::new());
    for k in 0..4000 {
        let t = 0.005 * f64::from(k);
        let current = 1.4 * (4.2 * t).sin();
        run.t.push(t);
        currents.push(current);
        counts.push((angle / std::f64::consts::TAU * 65536.0).floor() as i64);
        for _ in 0..20 {
            speed += 0.00025 * (current - 3.8 * angle.sin() - 0.02 * speed) / 0.19;
            angle += 0.00025 * speed;
        }
    }
    // As a file with `current_1` is read.
    run.source = Source { duties: DutySource::Currents, ..Source::default() };
    (run.duty, run.counts, run.count_gaps) = (vec![currents], vec![counts], vec![Vec::new()]);
    let said = |robot: &Robot| -> Vec<String> {
        found(robot.clone(), std::slice::from_ref(&run)).iter().map(Mistake::sentence).collect()
    };
    assert_eq!(said(&robot), Vec::<String>::new());
    let mut grams = robot.clone();
    grams.motor.rotor_inertia *= 1e3;
    let grams = said(&grams);
    assert!(grams.len() == 1 && grams[0].contains("by its greatest current"), "{grams:?}");
    let mut milli = robot.clone();
    milli.motor.friction_torque *= 1e3;
    assert!(said(&milli)[0].contains("cannot turn against 1200 Nm"), "{:?}", said(&milli));
}

/// The counts of a set as those of a log of wheel speeds.
fn of_speeds(set: &mut DataSet) {
    let source = Source { counts: CountSource::Speeds, ..Source::default() };
    let scale = as_logged(&set.robot, source, None).counts_per_wheel_rad() / set.robot.counts_per_wheel_rad();
    for run in &mut set.runs {
        run.source = source;
        run.counts.iter_mut().flatten().for_each(|n| *n = (*n as f64 * scale).round() as i64);
    }
}

/// One file of a session was recorded with a heading of another axis, or in millimetres: it is said which.
#[test]
fn a_frame_that_is_wrong_in_one_log_is_told_of_that_log() {
    let spoil = |wrong: fn(&mut Pose)| {
        let mut set = marked_ahead(0.4, 0.3, 0.0);
        set.runs[1].camera.iter_mut().for_each(|sample| wrong(&mut sample.pose));
        let said = found(set.robot.clone(), &set.runs);
        let sentences = said.iter().map(Mistake::sentence).collect::<Vec<_>>();
        (said, format!("in {} (1 of 2 logs that show it) ", set.runs[1].name), sentences)
    };
    let (said, which, sentences) = spoil(|pose| pose.theta += std::f64::consts::PI);
    assert!(said.len() == 1 && said[0].kind == "heading-axis" && said[0].what.starts_with(&which), "{sentences:?}");
    let (said, which, sentences) = spoil(|pose| (pose.x, pose.y) = (1000.0 * pose.x, 1000.0 * pose.y));
    assert!(said.len() == 1 && said[0].kind == "camera-unit" && said[0].what.starts_with(&which), "{sentences:?}");
}

/// A heading that is half a turn off is no slip, however rims jump where rows were lost.
#[test]
fn a_turned_heading_is_no_slip() {
    let mut set = marked_ahead(0.4, 0.3, 0.0);
    for run in &mut set.runs {
        run.camera.iter_mut().for_each(|sample| sample.pose.theta += std::f64::consts::PI);
        let jump = (0.5 / set.robot.wheel_radius_m * set.robot.counts_per_wheel_rad()) as i64;
        for counts in &mut run.counts {
            (0..counts.len()).for_each(|k| counts[k] += jump * (k as i64 / 200));
        }
    }
    let said = found(set.robot.clone(), &set.runs);
    let sentences: Vec<String> = said.iter().map(Mistake::sentence).collect();
    assert!(said.iter().any(|m| m.kind == "heading-axis" && !m.nameable), "{sentences:?}");
}

/// Speeds that scatter by 0.35 m/s from row to row seem to gain 16 m/s² now and then, on any floor.
#[test]
fn noise_of_speeds_is_no_slip() {
    let mut set = marked_ahead(0.3, 0.3, 0.6);
    of_speeds(&mut set);
    set.robot.wheel_radius_m *= 3.1;
    let told = |set: &DataSet| found(set.robot.clone(), &set.runs).iter().map(Mistake::sentence).collect::<Vec<_>>();
    let said = told(&set);
    assert!(said.len() == 1 && !said[0].contains("rims gain"), "{said:?}");
    // Nor are single speeds that were logged wrong.
    for counts in set.runs.iter_mut().map(|run| &mut run.counts[0]) {
        let per_rad = as_logged(&set.robot, Source { counts: CountSource::Speeds, ..Source::default() }, None);
        let wrong = (4.0 * per_rad.counts_per_wheel_rad()) as i64;
        (0..counts.len()).for_each(|k| counts[k] += wrong * (k as i64 / 100));
    }
    let said = told(&set);
    assert!(said.len() == 1 && !said[0].contains("rims gain"), "{said:?}");
}

/// Where ways and turns are both the other way round, positive speed drives the other way than the file says; where ways
/// alone are, the frame of the commands is turned.
#[test]
fn wheels_that_all_turn_the_other_way_are_no_frame() {
    let mut set = open("runs/wheel-skew");
    for run in &mut set.runs {
        run.has_camera = false;
        run.camera.clear();
        run.reference.clear();
        run.duty.clear();
        run.measured.clear();
    }
    let told = |set: &DataSet| {
        let told = found(set.robot.clone(), &set.runs).iter().map(Mistake::sentence).collect::<Vec<_>>();
        assert_eq!(told.len(), 1, "{told:?}");
        told.concat()
    };
    let mut turned = set.clone();
    for c in turned.runs.iter_mut().flat_map(|run| run.command.iter_mut().flat_map(|c| &mut c[..2])) {
        c.iter_mut().for_each(|x| *x = -*x);
    }
    assert!(told(&turned).contains("change the signs of cmd_vx and cmd_vy"), "{}", told(&turned));
    set.runs.iter_mut().flat_map(|run| run.counts.iter_mut().flatten()).for_each(|n| *n = -*n);
    assert!(told(&set).contains("positive speeds drive every wheel the other way"), "{}", told(&set));
}

/// Without duties nothing else says that wheels do more than they were asked for.
#[test]
fn wheels_faster_than_their_set_points_are_told() {
    let said = |factor: f64| {
        let mut set = open("runs/wheel-skew");
        for run in &mut set.runs {
            run.duty.clear();
            run.reference.iter_mut().flatten().for_each(|r| *r *= factor);
        }
        found(set.robot.clone(), &set.runs).iter().map(Mistake::sentence).collect::<Vec<_>>()
    };
    assert_eq!((said(1.0), said(0.9)), (Vec::<String>::new(), Vec::new()));
    let told = said(0.75);
    assert!(told.len() == 1 && told[0].contains("wheels turn 1.3"), "{told:?}");
}

/// Three axes on blocks whose set points change every 1.5 s, with the duty that the firmware gives for one, a share of the
/// no-load speed.
fn asked_for(robot: &Robot, firmware: impl Fn(f64) -> f64) -> Run {
    let free = robot.supply_v / (robot.motor.back_emf() * robot.gear_ratio);
    let counts = robot.counts_per_wheel_rad();
    let mut rng = ChaCha8Rng::seed_from_u64(4);
    let mut run = Run { name: "limited".to_owned(), ..Run::default() };
    let (mut asked, mut speed, mut angle) = (0.0, 0.0, 0.0);
    let (mut references, mut duties, mut angles) = (vec![], vec![], vec![]);
    for row in 0..30_000_u32 {
        if row % 1500 == 0 {
            asked = rng.random_range(-0.7..0.7) * free;
        }
        let duty = firmware(asked / free);
        let steady = (duty - 0.02 * f64::signum(asked)) * free;
        speed += 1e-3 * (steady - speed) / 0.05;
        angle += 1e-3 * speed;
        run.t.push(1e-3 * f64::from(row));
        references.push(asked);
        duties.push(duty);
        angles.push((angle * counts) as i64);
    }
    run.reference = vec![references; 3];
    run.duty = vec![duties; 3];
    run.counts = vec![angles; 3];
    run.count_gaps = vec![Vec::new(); 3];
    run
}

/// Set points of up to twice what a firmware's limit of 0.3 lets the motors reach: they are asked for in vain, in the right
/// unit. Of motors of which the duties speak otherwise the set points may be wrong.
#[test]
fn a_limit_of_the_firmware_is_no_unit() {
    let robot = Robot { support: Support::Blocks, ..Robot::racbot() };
    let run = asked_for(&robot, |asked| (0.02 * f64::signum(asked) + asked).clamp(-0.3, 0.3));
    let said =
        |robot: Robot| found(robot, std::slice::from_ref(&run)).iter().map(Mistake::sentence).collect::<Vec<_>>();
    assert_eq!(said(robot.clone()), Vec::<String>::new());
    let mut other = robot;
    other.supply_v *= 1.8;
    assert!(said(other).iter().any(|s| s.contains("set points are")), "without motors that are its own");
}

/// A weak loop that gets halfway to its set points is no set-up mistake, but for what duties know of no motor.
#[test]
fn a_loop_that_does_not_keep_up_may_go_on() {
    let robot = Robot { support: Support::Blocks, ..Robot::racbot() };
    let mut run = asked_for(&robot, |asked| 0.02 * f64::signum(asked) + 0.5 * asked);
    let [mistake] = &found(robot.clone(), std::slice::from_ref(&run))[..] else { panic!("one was to be found") };
    assert!(mistake.nameable && mistake.sentence().contains("does not keep up"), "{}", mistake.sentence());
    run.duty.clear();
    assert!(found(robot, &[run]).iter().any(|m| m.kind == "reference-unit" && !m.nameable));
}

/// A weak loop of a cascade stays behind its set points, of a motor that dry friction holds besides: what it subtracts from
/// them says that they are speeds, and that those in turns per minute are not.
#[test]
fn a_weak_loop_tells_the_unit_of_its_set_points() {
    let text = "support = \"blocks\"\nwheel_radius_m = 1\ngear_ratio = 1\nencoder_counts_per_motor_rev = 2000\nsupply_v = 24\n\
                control_rate_hz = 500\n[motor]\nresistance_ohm = 0.8\ntorque_constant = 0.05\nrotor_inertia = 8e-5\n\
                friction_torque = 0.02\n[[wheel]]\nx_m = 0\ny_m = 0\ndrive_deg = 0\n";
    let robot = Robot::parse_partial(text, Path::new("robot.toml")).unwrap();
    let (tick, volt, kt, ohm) = (0.002, 24.0, 0.05, 0.8);
    let (mut run, mut angle, mut speed, mut last) = (Run::default(), 0.0_f64, 0.0_f64, 0_i64);
    let (mut counts, mut asked, mut duties) = (Vec::new(), Vec::new(), Vec::new());
    for k in 0..10_000 {
        let t = f64::from(k) * tick;
        let count = (angle / std::f64::consts::TAU * 2000.0).floor() as i64;
        let measured = (count - last) as f64 / 2000.0 * std::f64::consts::TAU / tick;
        let reference = 60.0 * f64::signum((1.3 * t).sin());
        let duty = (0.004 * (reference - measured)).clamp(-1.0, 1.0);
        last = count;
        run.t.push(t);
        counts.push(count);
        asked.push(reference);
        duties.push((duty * 1e3).round() / 1e3);
        for _ in 0..20 {
            let torque = kt * (duty * volt - kt * speed) / ohm;
            let dry = 0.09_f64.min((torque + 8e-5 * speed / 1e-4).abs()) * f64::signum(torque + 8e-5 * speed / 1e-4);
            speed += 1e-4 * (torque - dry) / 8e-5;
            angle += 1e-4 * speed;
        }
    }
    (run.counts, run.reference, run.duty) = (vec![counts], vec![asked], vec![duties]);
    let told = found(robot.clone(), std::slice::from_ref(&run));
    assert!(told.iter().all(|m| m.nameable), "{:?}", told.iter().map(Mistake::sentence).collect::<Vec<_>>());
    run.reference[0].iter_mut().for_each(|r| *r *= 60.0 / std::f64::consts::TAU);
    assert!(found(robot, &[run]).iter().any(|m| m.kind == "reference-unit" && !m.nameable));
}

/// Two wheels that drive to and fro and hardly turn, in the camera's headings or its positions alone: turns the other way
/// are told, and those that are right are not; nor are curves between straight ways taken for slip. Headings scatter by
/// 5 mrad, positions by 2 mm.
#[test]
fn turns_the_other_way_show_where_there_are_few() {
    let curves = |t: f64| [0.4, if t.rem_euclid(3.0) < 1.8 { 0.0 } else { 0.5 * (0.3 * t).cos().signum() }];
    let driven = |turn: f64| {
        let mut set = if turn > 1.0 { driving(0.0, curves) } else { marked_ahead(0.4, turn, 0.0) };
        let mut random = ChaCha8Rng::seed_from_u64(17);
        for sample in set.runs.iter_mut().flat_map(|run| &mut run.camera) {
            sample.pose.x += random.random_range(-0.002..0.002);
            sample.pose.y += random.random_range(-0.002..0.002);
            sample.pose.theta += random.random_range(-0.005..0.005);
        }
        set
    };
    let said = |set: &DataSet| found(set.robot.clone(), &set.runs).iter().map(Mistake::sentence).collect::<Vec<_>>();
    // As logs of positions alone are read.
    let without_headings = |set: &mut DataSet| {
        let folder = tempfile::tempdir().unwrap();
        for run in &set.runs {
            let path = folder.path().join(format!("{}.csv", run.name));
            run.save(&path, Existing::Refuse).unwrap();
            let text = std::fs::read_to_string(&path).unwrap();
            let at = text.lines().next().unwrap().split(',').position(|name| name == "cam_theta").unwrap();
            let without = |line: &str| {
                line.split(',').enumerate().filter(|(i, _)| *i != at).map(|(_, f)| f).collect::<Vec<_>>().join(",")
            };
            std::fs::write(&path, text.lines().map(without).collect::<Vec<_>>().join("\n")).unwrap();
        }
        *set = DataSet::open_as(folder.path(), set.robot.clone()).unwrap();
    };
    for (turn, ways_alone) in [(0.012, false), (0.05, true), (0.2, true), (f64::INFINITY, true)] {
        let mut set = driven(turn);
        let mut swapped = set.clone();
        swapped.runs.iter_mut().for_each(|run| run.counts.swap(0, 1));
        if ways_alone {
            [&mut set, &mut swapped].into_iter().for_each(without_headings);
        }
        assert_eq!(said(&set), Vec::<String>::new(), "{turn}");
        let reversed = |set: &DataSet| {
            let told = said(set);
            assert!(
                told.len() == 1 && told[0].contains("the other way; ") && told[0].contains("are swapped"),
                "{told:?}"
            );
        };
        reversed(&swapped);
        // Ways alone also where half of the track passed for it: ways, which bend then by neither reading, are no slip.
        if ways_alone && turn > 1.0 {
            let halved = |wheel: Wheel| Wheel { x_m: 0.5 * wheel.x_m, ..wheel };
            swapped.robot.layout = Layout::Wheels(swapped.robot.layout.wheels().into_iter().map(halved).collect());
            reversed(&swapped);
        }
    }
}

/// A wheel that spins twice as fast as it should for half of the time is no robot of another file: the others say so.
#[test]
fn a_wheel_that_slips_half_the_time_is_told_as_one() {
    let robot = Robot::racbot();
    for (wheel, seed) in [(0, 31), (1, 32), (2, 33)] {
        let drives = [Manoeuvre::Star, Manoeuvre::Chirp, Manoeuvre::Square];
        let mut runs: Vec<Run> = drives
            .into_iter()
            .map(|m| simulate(m, &Applied::of(&robot), &robot, Pose::default(), seed).unwrap())
            .collect();
        for run in &mut runs {
            let (mut spun, mut last) = (0.0, run.counts[wheel][0]);
            for k in 1..run.t.len() {
                let moved = (run.counts[wheel][k] - last) as f64;
                last = run.counts[wheel][k];
                let slips = (run.t[k] * 2.0) as usize % 2 == 1;
                spun += if slips { 2.5 * moved } else { 0.0 };
                run.counts[wheel][k] += spun.round() as i64;
            }
            run.duty.clear();
            run.reference.clear();
            run.command = None;
        }
        let told = found(robot.clone(), &runs);
        let said: Vec<String> = told.iter().map(Mistake::sentence).collect();
        assert!(told.len() == 1 && told[0].kind == "wheels-slip" && told[0].nameable, "{wheel}: {said:?}");
        assert!(said[0].contains(&format!("wheel {} slips", wheel + 1)), "{said:?}");
        // Of the poses of another drive nothing is said to slip.
        let poses: Vec<_> = runs.iter().map(|run| run.camera.clone()).collect();
        runs.iter_mut().zip(poses.iter().cycle().skip(1)).for_each(|(run, camera)| {
            run.camera = camera.iter().filter(|c| c.tick < run.t.len()).copied().collect();
        });
        let said: Vec<&str> = found(robot.clone(), &runs).iter().map(|m| m.kind).collect();
        assert_eq!(said, ["robot-file"], "{wheel}");
    }
}

/// Wheels that spin through most of a drive have a best factor, but no factor makes what the camera saw: no reason to stop.
#[test]
fn wheels_that_slip_most_of_the_time_are_no_other_file() {
    let robot = Robot::racbot();
    let drives = [Manoeuvre::Star, Manoeuvre::Chirp, Manoeuvre::Square];
    for (spins, slips) in [([1.25, 3.0], true), ([1.8, 1.8], false)] {
        let runs = drives.into_iter().map(|m| {
            let mut run = simulate(m, &Applied::of(&robot), &robot, Pose::default(), 34).unwrap();
            for counts in &mut run.counts {
                let (mut at, mut last) = (counts[0] as f64, counts[0]);
                for (count, t) in counts.iter_mut().zip(&run.t) {
                    at += spins[(t * 2.0) as usize % 2] * (*count - last) as f64;
                    last = *count;
                    *count = at.round() as i64;
                }
            }
            run.duty.clear();
            run.reference.clear();
            run.command = None;
            run
        });
        let told = found(robot.clone(), &runs.collect::<Vec<_>>());
        let said: Vec<String> = told.iter().map(Mistake::sentence).collect();
        assert!(told.len() == 1 && told[0].nameable == slips, "{said:?}");
        assert_eq!(said[0].contains("or wheels slip"), slips, "{said:?}");
    }
}

/// A diameter for a radius is the same in every log; wheels that slip on a soft floor are not.
#[test]
fn wheels_that_slip_in_every_log_by_another_part_are_no_diameter() {
    let robot = Robot::racbot();
    let drives = [Manoeuvre::Star, Manoeuvre::Chirp, Manoeuvre::Square];
    let said = |parts: [f64; 3]| {
        let runs = drives.into_iter().zip(parts).map(|(m, part)| {
            let mut run = simulate(m, &Applied::of(&robot), &robot, Pose::default(), 34).unwrap();
            run.counts.iter_mut().flatten().for_each(|n| *n = (*n as f64 * part).round() as i64);
            run.duty.clear();
            run.reference.clear();
            run.command = None;
            run
        });
        let told = found(robot.clone(), &runs.collect::<Vec<_>>());
        told.iter().map(|m| format!("{} {} {}", m.kind, m.nameable, m.sentence())).collect::<Vec<_>>().join("\n")
    };
    let slips = said([1.6, 2.2, 3.4]);
    assert!(slips.starts_with("wheels-slip false") && slips.contains("turn 1.6") && !slips.contains('\n'), "{slips}");
    let twice = said([2.0, 2.0, 2.0]);
    // Counts of a decoder that takes both edges do the same.
    assert!(twice.starts_with("wheel-diameter") && twice.contains("encoder_counts_per_motor_rev"), "{twice}");
}
