//! What a data set is measured in must not change what is said of it.

use std::path::{Path, PathBuf};

use super::common::{RICH, cut, cut_all, names, simulate, value, with};
use gap::{Analysis, Options, Verdict, analyse};
use runs::frames::Pose;
use runs::geometry::Wheel;
use runs::robot::{Layout, Robot, Support};
use runs::{DataSet, Run};

/// A servo axis on blocks at 500 Hz, kg m², Nm s, Nm; what the file says of its inertia, and what its motor loses besides.
pub(super) fn servo(inertia: f64, told: f64, viscous: f64, dry: f64) -> DataSet {
    let (kt, ohm, volt, counts, tick) = (0.05, 1.2, 24.0, 4096.0, 2e-3);
    let text = format!(
        "encoder_counts_per_wheel_rev = {counts}\ngear_ratio = 1\nsupply_v = {volt}\nsupport = \"blocks\"\n\
         control_rate_hz = 500\nwheel_radius_m = 0.01\n[motor]\nresistance_ohm = {ohm}\ntorque_constant = {kt}\n\
         back_emf_constant = {kt}\nrotor_inertia = {told}\nfriction_torque = 0\n[[wheel]]\nx_m = 0\ny_m = 0.1\ndrive_deg = 0\n"
    );
    let robot = Robot::parse_partial(&text, Path::new("robot.toml")).unwrap();
    let waves = [(0.3, 0.25), (0.7, 0.2), (1.3, 0.15), (2.1, 0.1), (0.15, 0.2)];
    let run = |number: usize| {
        let mut run = Run { name: format!("run_{number}"), ..Run::default() };
        let (mut angle, mut speed) = (0.0_f64, 0.0_f64);
        let (mut duties, mut counted) = (Vec::new(), Vec::new());
        for k in 0..4000 {
            let t = tick * k as f64;
            let phase = |i: usize| (1 + i) as f64 * (1.3 + number as f64);
            let duty: f64 =
                waves.iter().enumerate().map(|(i, (f, a))| a * (std::f64::consts::TAU * f * t + phase(i)).sin()).sum();
            let duty = (duty * 1e4).round() / 1e4;
            run.t.push(t);
            duties.push(duty);
            counted.push((angle / std::f64::consts::TAU * counts).floor() as i64);
            let step = tick / 40.0;
            for _ in 0..40 {
                let torque = kt * (duty * volt - kt * speed) / ohm - viscous * speed;
                let sense = if speed == 0.0 { torque.signum() } else { speed.signum() };
                let sticks = speed == 0.0 && torque.abs() < dry;
                let next = if sticks { 0.0 } else { speed + step * (torque - dry * sense) / inertia };
                let next = if speed * next < 0.0 { 0.0 } else { next };
                angle += 0.5 * step * (speed + next);
                speed = next;
            }
        }
        run.duty = vec![duties];
        run.counts = vec![counted];
        run
    };
    DataSet { folder: PathBuf::from("servo"), robot, runs: (0..2).map(run).collect() }
}

/// The same machine with every torque, mass and inertia times `k`: what its logs hold stays the same.
fn stronger(set: &DataSet, k: f64) -> DataSet {
    let mut set = set.clone();
    let robot = &mut set.robot;
    let motor = &mut robot.motor;
    motor.back_emf_constant = Some(motor.back_emf_constant.unwrap_or(motor.torque_constant));
    for x in [&mut motor.torque_constant, &mut motor.rotor_inertia, &mut motor.friction_torque] {
        *x *= k;
    }
    robot.wheel_inertia_kg_m2 *= k;
    if robot.support == Support::Floor {
        robot.mass_kg *= k;
        robot.yaw_inertia_kg_m2 *= k;
    }
    set
}

/// The same robot with every length times `k`, as its camera sees it: camera and counts alone, for weight does not grow
/// along.
fn larger(set: &DataSet, k: f64) -> DataSet {
    let mut set = set.clone();
    set.robot.wheel_radius_m *= k;
    set.robot.mass_kg /= k * k;
    set.robot.layout = Layout::Wheels(
        set.robot.layout.wheels().into_iter().map(|w| Wheel { x_m: k * w.x_m, y_m: k * w.y_m, ..w }).collect(),
    );
    for run in &mut set.runs {
        run.duty.clear();
        run.command = None;
        run.reference.clear();
        run.camera.iter_mut().for_each(|c| c.pose = Pose::new(k * c.pose.x, k * c.pose.y, c.pose.theta));
    }
    set
}

/// The same recording by encoders of `k` times the counts.
fn finer(set: &DataSet, k: i64) -> DataSet {
    let mut set = set.clone();
    set.robot.encoder_counts_per_motor_rev *= k as f64;
    set.runs.iter_mut().flat_map(|r| &mut r.counts).flatten().for_each(|c| *c *= k);
    set
}

fn analysed(set: &DataSet) -> Analysis {
    analyse(set, &Options::default()).unwrap()
}

/// Whether two analyses say the same; figures in floors to a share.
#[track_caller]
fn same(one: &Analysis, other: &Analysis, off: f64) {
    let both = || format!("{}\n{}", one.terminal_summary(), other.terminal_summary());
    assert_eq!((one.verdict, names(one)), (other.verdict, names(other)), "{}", both());
    assert_eq!(one.alternatives, other.alternatives, "{}", both());
    for (a, b) in one.links.iter().zip(&other.links) {
        assert!(
            (a.before - b.before).abs() <= off * a.before && (a.after - b.after).abs() <= off * a.after,
            "{}",
            both()
        );
    }
}

#[test]
fn a_servo_is_the_same_in_any_unit() {
    let set = servo(2e-5, 2e-5, 1e-5, 4e-3);
    let a = analysed(&set);
    assert_eq!(names(&a).first(), Some(&"coulomb-friction"), "{}", a.terminal_summary());
    for e in &a.effects {
        let (_, truth) =
            [("coulomb-friction", 4e-3), ("viscous-friction", 1e-5)].into_iter().find(|t| t.0 == e.name).unwrap();
        let [low, high] = e.parameters[0].2.ends().unwrap();
        assert!(low < truth && truth < high && high - low < 0.6 * truth, "{:?}", e.parameters);
    }
    for k in [1e3, 1e-3] {
        let other = analysed(&stronger(&set, k));
        same(&a, &other, 0.01);
        let torque = value(&other, "torque_nm");
        assert!((torque / value(&a, "torque_nm") / k - 1.0).abs() < 0.01, "{torque}");
    }
    same(&a, &analysed(&finer(&set, 1000)), 0.01);
}

/// What a desk leaves in a moment: one log of three seconds.
#[test]
fn three_seconds_of_a_servo_are_enough_for_a_name() {
    let short = |mut set: DataSet| {
        set.runs.truncate(1);
        cut(&mut set.runs[0], 3.0);
        analysed(&set)
    };
    for (set, name, truth) in [
        (servo(2e-5, 2e-5, 0.0, 4e-3), "coulomb-friction", 4e-3),
        (servo(3.2e-5, 2e-5, 0.0, 0.0), "rotor-inertia", 0.6),
    ] {
        let a = short(set);
        assert_eq!(names(&a), [name], "{}", a.terminal_summary());
        let [low, high] = a.effects[0].parameters[0].2.ends().unwrap();
        assert!(low < truth && truth < high && high - low < 0.5 * truth, "{}", a.terminal_summary());
    }
    let a = short(servo(2e-5, 2e-5, 0.0, 0.0));
    assert_eq!((a.verdict, names(&a)), (Verdict::Agrees, vec![]), "{}", a.terminal_summary());
}

#[test]
fn an_inertia_is_the_same_in_any_unit() {
    let set = servo(3.2e-5, 2e-5, 0.0, 0.0);
    let a = analysed(&set);
    assert_eq!((a.verdict, names(&a)), (Verdict::MissingEffect, vec!["rotor-inertia"]), "{}", a.terminal_summary());
    same(&a, &analysed(&stronger(&set, 1e3)), 0.01);
}

#[test]
fn a_torque_constant_is_not_called_friction() {
    let mut set = servo(2e-5, 2e-5, 0.0, 4e-4);
    set.robot.motor.friction_torque = 4e-4;
    set.robot.motor.torque_constant /= 1.163;
    set.robot.motor.back_emf_constant = Some(set.robot.motor.torque_constant);
    let a = analysed(&set);
    // Viscous friction explains all of the gap but a hundredth, and leaves tens of floors.
    assert_eq!(names(&a), ["torque-constant"], "{}", a.terminal_summary());
    let [low, high] = a.effects[0].parameters[0].2.ends().unwrap();
    assert!(low < 0.163 && 0.163 < high, "{low} to {high}");
}

fn short(truth: &Robot, seed: u64) -> DataSet {
    let mut set = simulate(truth, &RICH, seed);
    cut_all(&mut set, 6.0);
    set
}

#[test]
fn three_wheels_are_the_same_in_any_unit() {
    let set = short(&with(&Robot::racbot(), "coulomb-friction", &[("torque_nm", 0.012)]), 81);
    let a = analysed(&set);
    assert_eq!(names(&a), ["coulomb-friction"], "{}", a.terminal_summary());
    // A file holds no robot of more than a ton.
    same(&a, &analysed(&stronger(&set, 300.0)), 0.01);
    same(&a, &analysed(&stronger(&set, 1e-3)), 0.01);
}

#[test]
fn four_wheels_are_the_same_in_any_unit() {
    let at = |degrees: f64| {
        let (y, x) = degrees.to_radians().sin_cos();
        Wheel { x_m: 0.085 * x, y_m: 0.085 * y, drive_rad: (degrees + 90.0).to_radians(), roller_rad: 0.0 }
    };
    let nominal = Robot { layout: Layout::Wheels([35.0, 145.0, 225.0, 315.0].map(at).to_vec()), ..Robot::racbot() };
    let truth = with(&nominal, "wheel-radius", &[("scale_2", 0.03)]);
    let set = short(&truth, 82);
    let a = analysed(&set);
    assert_eq!(names(&a), ["wheel-radius"], "{}", a.terminal_summary());
    same(&a, &analysed(&stronger(&set, 300.0)), 0.01);
    let seen = analysed(&larger(&set, 1.0));
    for k in [10.0, 0.1] {
        same(&seen, &analysed(&larger(&set, k)), 0.02);
    }
}

#[test]
fn a_lens_matters_by_how_far_from_the_middle_the_robot_is_seen() {
    // A quarter of what a lens must have on a field of one metre; near a corner of a large one it bends a way by 3 %.
    const K1_PER_M2: f64 = -0.0008;
    let nominal = Robot::racbot();
    let mut set = short(&nominal, 83);
    for (run, [x, y]) in set.runs.iter_mut().zip([[3.6, 2.2], [-3.4, 1.8], [0.4, -2.6]]) {
        for seen in &mut run.camera {
            let far = Pose::new(seen.pose.x + x, seen.pose.y + y, seen.pose.theta);
            let scale = 1.0 + K1_PER_M2 * (far.x * far.x + far.y * far.y);
            seen.pose = Pose::new(scale * far.x, scale * far.y, far.theta);
        }
    }
    let a = analysed(&set);
    assert_eq!(names(&a), ["lens-distortion"], "{}", a.terminal_summary());
    assert!((value(&a, "k1_per_m2") / K1_PER_M2 - 1.0).abs() < 0.15, "{}", a.terminal_summary());
}
