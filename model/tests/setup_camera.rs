//! How a camera's poses were written is told by one cause where one made it.

use std::borrow::Cow;
use std::f64::consts::PI;
use std::path::Path;

use model::effects::Applied;
use model::manoeuvre::{Manoeuvre, simulate};
use model::setup::{Mistake, mistakes};
use runs::frames::Pose;
use runs::geometry::Wheel;
use runs::robot::{Layout, Robot};
use runs::{Columns, DataSet, Log, Logs};

/// What is said of a set of two wheels whose camera wrote other poses.
fn told(write: impl Fn(Pose) -> Pose) -> Vec<String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../data/real/differential-squares");
    let mut set = DataSet::open(&folder).unwrap();
    set.runs.iter_mut().flat_map(|run| &mut run.camera).for_each(|sample| sample.pose = write(sample.pose));
    mistakes(&Logs::from(&set)).iter().map(Mistake::sentence).collect()
}

/// Headings of the forward axis, clockwise, that a map turns to the x axis as if they were counter-clockwise.
#[test]
fn clockwise_headings_that_were_turned_are_one_mistake() {
    let said = told(|p| Pose::new(p.x, p.y, -(p.theta + 0.5 * PI) - 0.5 * PI));
    assert!(said.len() == 1 && said[0].contains("headings grow clockwise"), "{said:?}");
    assert!(said[0].contains("add half a turn"), "{said:?}");
    let said = told(|p| Pose::new(p.x, p.y, -p.theta));
    assert!(said.len() == 1 && said[0].ends_with("change their sign"), "{said:?}");
    let said = told(|p| Pose::new(p.x, p.y, p.theta + PI));
    assert!(said.len() == 1 && said[0].contains("180 degrees from that of the body's x axis"), "{said:?}");
}

/// Of a robot whose tyres are dragged sideways the camera shows turns and ways apart: what its track acts as is told.
#[test]
fn a_track_that_acts_wider_is_told_with_its_size() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../data/real/differential-squares");
    let set = DataSet::open(&folder).unwrap();
    let stands = set.robot.geometry().unwrap().wheels().iter().map(|w| 2.0 * w.x_m).fold(0.0, f64::max);
    for (acts, skids) in [(1.8, true), (0.6, false)] {
        let mut set = set.clone();
        let Layout::Wheels(wheels) = &mut set.robot.layout else { panic!("it has two wheels") };
        wheels.iter_mut().for_each(|w| w.x_m /= acts);
        let said: Vec<String> = mistakes(&Logs::from(&set)).iter().map(Mistake::sentence).collect();
        assert!(said.len() == 1 && said[0].contains("a track of"), "{said:?}");
        assert_eq!(said[0].contains("skid-steered"), skids, "{said:?}");
        assert!(!said[0].contains("diameter"), "{said:?}");
        let size: f64 =
            said[0].split("acts as one of ").nth(1).and_then(|s| s.split(' ').next()).unwrap().parse().unwrap();
        assert!((size / stands - 1.0).abs() < 0.03, "{stands}: {said:?}");
    }
}

#[test]
fn units_that_were_taken_for_the_next_are_told() {
    for (scale, which) in
        [(0.1, "centimetres that were taken for millimetres"), (10.0, "millimetres that were taken for")]
    {
        let said = told(|p| Pose::new(scale * p.x, scale * p.y, p.theta));
        assert!(said.len() == 1 && said[0].contains(which), "{said:?}");
    }
}

/// At full duty the robot spins at 36 rad/s, most of a turn in a usual stretch, and half of the time it is held at full duty and
/// does not reach its set points.
#[test]
fn nothing_is_wrong_with_what_the_library_drives() {
    let said = |set: &DataSet| mistakes(&Logs::from(set)).iter().map(Mistake::sentence).collect::<Vec<_>>();
    let mut hard = DataSet { folder: "simulated".into(), robot: Robot::racbot(), runs: Vec::new() };
    for (k, manoeuvre) in Manoeuvre::ALL.into_iter().enumerate() {
        let robot = Robot { support: manoeuvre.support(), ..Robot::racbot() };
        let run = simulate(manoeuvre, &Applied::of(&robot), &robot, Pose::new(0.4, -0.3, 0.5), 60 + k as u64).unwrap();
        let mut set = DataSet { folder: "simulated".into(), robot, runs: vec![run] };
        for supply in ["logged", "unknown"] {
            assert_eq!(said(&set), Vec::<String>::new(), "{}, supply {supply}", manoeuvre.name());
            set.runs[0].supply_v = None;
        }
        let driven_hard = [Manoeuvre::StopAndGo, Manoeuvre::Star, Manoeuvre::Chirp, Manoeuvre::FullDuty];
        if driven_hard.contains(&manoeuvre) {
            hard.runs.push(Log::from(Cow::Borrowed(&set.runs[0])).part(0..5_000, Columns::ALL));
        }
    }
    assert_eq!(said(&hard), Vec::<String>::new());
}

/// At 14 mm/s and 20 frames a second turns are the camera's noise, of which wheels in another order that say the robot did not
/// turn have none to answer for.
#[test]
fn noise_for_turns_swaps_no_wheels() {
    let corners = [(-1.0, 1.0, -1.0), (1.0, 1.0, 1.0), (-1.0, -1.0, 1.0), (1.0, -1.0, -1.0)];
    let wheel = |(x, y, side): (f64, f64, f64)| Wheel {
        x_m: 0.175 * x,
        y_m: 0.2 * y,
        drive_rad: 0.5 * PI,
        roller_rad: 0.25 * PI * side,
    };
    let mut robot = Robot { layout: Layout::Wheels(corners.map(wheel).to_vec()), ..Robot::racbot() };
    (robot.wheel_radius_m, robot.mass_kg, robot.yaw_inertia_kg_m2) = (0.076, 15.0, 0.5);
    (robot.gear_ratio, robot.encoder_counts_per_motor_rev, robot.supply_v) = (27.0, 48.0, 12.0);
    (robot.control_rate_hz, robot.camera_rate_hz) = (50.0, 20.0);
    (robot.motor.torque_constant, robot.motor.resistance_ohm, robot.motor.rotor_inertia) = (0.018, 0.6, 1e-5);
    (robot.pi.kp, robot.pi.ki) = (0.0447, 0.608);
    for seed in 1..5 {
        let run = simulate(Manoeuvre::Creep, &Applied::of(&robot), &robot, Pose::default(), seed).unwrap();
        let set = DataSet { folder: "simulated".into(), robot: robot.clone(), runs: vec![run] };
        let said: Vec<String> = mistakes(&Logs::from(&set)).iter().map(Mistake::sentence).collect();
        assert_eq!(said, Vec::<String>::new(), "{seed}");
    }
}

/// Who drives by the field's axes, and takes the commands for those of the robot, has wheels that go there whatever the heading.
#[test]
fn velocities_of_the_field_are_no_slip() {
    let robot = Robot::racbot();
    let run = simulate(Manoeuvre::Star, &Applied::of(&robot), &robot, Pose::new(0.4, -0.3, 0.5), 7).unwrap();
    let mut set = DataSet { folder: "simulated".into(), robot, runs: vec![run] };
    // What the wheels make of the body's way is what the camera sees in the field, 0.3 rad off its axes.
    let own: Vec<Pose> = set.runs[0].camera.iter().map(|sample| sample.pose).collect();
    let mut at = own[0];
    for (pair, sample) in own.windows(2).zip(&mut set.runs[0].camera[1..]) {
        let turn = 0.3 - pair[0].theta - 0.5 * runs::frames::wrap_angle(pair[1].theta - pair[0].theta);
        let step = Pose::new(0.0, 0.0, turn).compose(Pose::new(pair[1].x - pair[0].x, pair[1].y - pair[0].y, 0.0));
        at = Pose::new(at.x + step.x, at.y + step.y, pair[1].theta);
        sample.pose = at;
    }
    let said: Vec<String> = mistakes(&Logs::from(&set)).iter().map(Mistake::sentence).collect();
    assert!(said.len() == 1 && said[0].contains("along the field's axes"), "{said:?}");
}

/// The sense in which positive speed turns a robot is one line of `racbot init`, and one thing to be wrong, not a mirrored camera
/// beside wheels in another order.
#[test]
fn wheels_that_all_turn_the_other_way_are_one_mistake() {
    let four = [60.0_f64, 135.0, 225.0, 300.0].map(|degrees| {
        let at = degrees.to_radians() + 0.5 * PI;
        Wheel { x_m: 0.08 * at.cos(), y_m: 0.08 * at.sin(), drive_rad: at + 0.5 * PI, roller_rad: 0.0 }
    });
    let three = Robot::racbot();
    let robots = [three.clone(), Robot { layout: Layout::Wheels(four.to_vec()), ..three }];
    for robot in robots {
        let mut set = DataSet { folder: "simulated".into(), robot: robot.clone(), runs: Vec::new() };
        for (seed, manoeuvre) in [Manoeuvre::Star, Manoeuvre::Spin, Manoeuvre::Square].into_iter().enumerate() {
            let run =
                simulate(manoeuvre, &Applied::of(&robot), &robot, Pose::new(0.4, -0.3, 0.5), seed as u64).unwrap();
            set.runs.push(run);
        }
        set.runs.iter_mut().flat_map(|run| &mut run.counts).flatten().for_each(|n| *n = -*n);
        for with_commands in [true, false] {
            for run in &mut set.runs {
                // Neither duties nor set points say which of motor and encoder is the other way round.
                run.reference.clear();
                run.duty.clear();
                run.measured.clear();
                if !with_commands {
                    run.command = None;
                }
            }
            let said: Vec<String> = mistakes(&Logs::from(&set)).iter().map(Mistake::sentence).collect();
            assert!(said.len() == 1 && said[0].contains("drive every wheel the other way"), "{said:?}");
        }
    }
}

/// What a robot of two wheels does is the mirror image of what it does with its wheels exchanged.
#[test]
fn wheels_that_seem_exchanged_may_be_mirrored_poses() {
    let said = told(|p| Pose::new(p.x, -p.y, -p.theta - PI));
    assert!(said.len() == 1 && said[0].contains("enc_1 and enc_2 are swapped"), "{said:?}");
    assert!(said[0].contains("the poses are mirrored") && said[0].contains("headings = \"clockwise\""), "{said:?}");
}

/// The robot's own odometry in the columns of the camera agrees with any wheels.
#[test]
fn poses_that_were_computed_from_the_counts_are_told() {
    let robot = Robot::racbot();
    let geometry = robot.geometry().unwrap();
    let mut set = DataSet { folder: "simulated".into(), robot: robot.clone(), runs: Vec::new() };
    for (seed, manoeuvre) in [Manoeuvre::Star, Manoeuvre::Chirp].into_iter().enumerate() {
        let start = Pose::new(0.4, -0.3, 0.5);
        set.runs.push(simulate(manoeuvre, &Applied::of(&robot), &robot, start, 90 + seed as u64).unwrap());
    }
    // By a firmware whose wheels are 4 % smaller than the file's, of this row's counts or those of the row before.
    let reckoned = |late: usize| {
        let mut set = set.clone();
        for run in &mut set.runs {
            let mut poses = vec![run.camera[0].pose];
            for k in 1..run.len() {
                let turned: Vec<f64> =
                    run.counts.iter().map(|n| 0.96 * (n[k] - n[k - 1]) as f64 / robot.counts_per_wheel_rad()).collect();
                let (step, at) = (geometry.twist(&turned), poses[k - 1]);
                let middle = at.theta + 0.5 * step.omega;
                let (sin, cos) = middle.sin_cos();
                let to = [cos * step.vx - sin * step.vy, sin * step.vx + cos * step.vy];
                poses.push(Pose::new(at.x + to[0], at.y + to[1], runs::frames::wrap_angle(at.theta + step.omega)));
            }
            run.camera.iter_mut().for_each(|sample| sample.pose = poses[sample.tick.saturating_sub(late)]);
        }
        set
    };
    let said = |set: &DataSet| mistakes(&Logs::from(set)).iter().map(Mistake::sentence).collect::<Vec<_>>();
    for late in [0, 1] {
        let said = said(&reckoned(late));
        assert!(said.len() == 1 && said[0].contains("computed from these counts"), "{said:?}");
    }
    // Places alone, of two wheels: of a drive of others, whose own camera says nothing of the kind.
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../data/real/differential-squares");
    let mut two = DataSet::open(&folder).unwrap();
    two.runs.iter_mut().for_each(|run| run.source.positions_only = true);
    assert!(!said(&two).iter().any(|s| s.contains("computed")), "{:?}", said(&two));
    let geometry = two.robot.geometry().unwrap();
    for run in &mut two.runs {
        let mut at = run.camera[0].pose;
        let mut poses = vec![at];
        for k in 1..run.len() {
            let turned: Vec<f64> =
                run.counts.iter().map(|n| (n[k] - n[k - 1]) as f64 / two.robot.counts_per_wheel_rad()).collect();
            let step = geometry.twist(&turned);
            let ahead = at.theta + 0.5 * step.omega + 0.5 * PI;
            at = Pose::new(at.x + step.vy * ahead.cos(), at.y + step.vy * ahead.sin(), at.theta + step.omega);
            poses.push(at);
        }
        run.camera.iter_mut().for_each(|sample| sample.pose = poses[sample.tick]);
    }
    let told = said(&two);
    assert!(told.len() == 1 && told[0].contains("computed from these counts"), "{told:?}");
    // Poses that are as exact, and know nothing of how the counts of the log are rounded.
    let mut finer = reckoned(0);
    finer.robot.encoder_counts_per_motor_rev /= 8.0;
    finer.runs.iter_mut().flat_map(|run| &mut run.counts).flatten().for_each(|n| *n = n.div_euclid(8));
    assert_eq!(said(&finer), Vec::<String>::new());
}
