//! The simulator against the laws it claims to obey.

use truth::{Columns, Drive, GRAVITY, Hit, Machine, Plant, Robot, Shake, simulate_run};

const STEP: f64 = 5.0e-5;

/// Advances for `seconds` with these duties.
fn run(plant: &mut Plant<'_>, seconds: f64, duty: &[f64]) {
    for _ in 0..(seconds / STEP).round() as usize {
        plant.advance(duty, &Shake::default());
    }
}

/// A robot without any loss: no motor, no friction, no gear loss.
fn lossless() -> Machine {
    let mut machine = Machine::ideal(&Robot::standard());
    machine.power.torque_constant = 0.0;
    machine.power.motor_friction_nm = 0.0;
    machine.power.gear_efficiency = 1.0;
    machine
}

#[test]
fn a_passive_robot_never_gains_energy() {
    let mut machine = Machine::ideal(&Robot::standard());
    machine.ground.creep_s_per_kg = 5e-5;
    machine.ground.slip_ratio_per_n = 2e-4;
    machine.centre_of_mass_m = [0.01, -0.006];
    for (i, wheel) in machine.wheels.iter_mut().enumerate() {
        wheel.roller_drag_n = 0.06;
        wheel.dry_nm = [0.004; 2];
        wheel.viscous_nms = 1e-5;
        wheel.mount.drive_rad += 0.05 * i as f64;
        wheel.play_rad = if i == 1 { 0.03 } else { 0.0 };
    }
    for start in [[0.8, 0.3, 0.0], [0.0, 0.0, 6.0], [-0.5, 0.6, -4.0]] {
        let mut plant = Plant::new(&machine, [0.0, 0.0, 0.7], STEP, &[]);
        plant.set_twist(start);
        let first = plant.energy_j();
        let mut before = first;
        for _ in 0..2000 {
            run(&mut plant, 0.001, &[0.0; 3]);
            let now = plant.energy_j();
            assert!(now <= before + 2e-5 * first, "energy rose from {before} to {now} of {first}");
            before = now;
        }
        assert!(before < 0.35 * first, "friction takes energy: {before} of {first}");
    }
}

#[test]
fn a_lossless_robot_keeps_its_energy() {
    let machine = lossless();
    let mut plant = Plant::new(&machine, [0.0; 3], STEP, &[]);
    plant.set_twist([0.8, 0.3, 3.0]);
    let before = plant.energy_j();
    run(&mut plant, 3.0, &[0.0; 3]);
    let after = plant.energy_j();
    assert!((after / before - 1.0).abs() < 2e-3, "{before} J became {after} J");
}

#[test]
fn momentum_is_force_times_time() {
    let mut machine = lossless();
    machine.ground.friction_static = 0.0;
    machine.ground.friction_sliding = 0.0;
    let hit = Hit { start_s: 0.1, end_s: 0.3, force_n: [1.2, -0.5], moment_nm: 0.01 };
    let mut plant = Plant::new(&machine, [0.0; 3], STEP, &[hit]);
    run(&mut plant, 0.5, &[0.0; 3]);
    let [vx, vy, spin] = plant.twist();
    assert!((vx - 1.2 * 0.2 / machine.mass_kg).abs() < 1e-4);
    assert!((vy + 0.5 * 0.2 / machine.mass_kg).abs() < 1e-4);
    assert!((spin - 0.01 * 0.2 / machine.yaw_inertia_kg_m2).abs() < 1e-3);
}

#[test]
fn unloaded_wheels_turn_as_fast_as_the_motor_equation_says() {
    let robot = Robot { blocks: true, ..Robot::standard() };
    let mut machine = Machine::ideal(&robot);
    machine.power.battery_ohm = 0.05;
    let viscous = 2e-5;
    machine.wheels.iter_mut().for_each(|wheel| wheel.viscous_nms = viscous);
    for duty in [0.2, 0.5, -0.9] {
        let mut plant = Plant::new(&machine, [0.0; 3], STEP, &[]);
        run(&mut plant, 1.5, &[duty; 3]);
        let speed = plant.rotor_speed(0);
        // eta·n·k·i = n·T_f + b·w on every wheel; u·(V - 3·R_b·u·i) = R·i + k·n·w.
        let power = &machine.power;
        let gain = power.gear_ratio * power.torque_constant;
        let friction = power.gear_ratio * power.motor_friction_nm;
        let current = (friction * duty.signum() + viscous * speed) / (power.gear_efficiency * gain);
        let volts = duty * (power.open_v - 3.0 * power.battery_ohm * duty * current);
        let expected = (volts - power.resistance_ohm * current) / gain;
        assert!((speed / expected - 1.0).abs() < 2e-3, "duty {duty}: {speed} instead of {expected}");
    }
}

#[test]
fn the_robot_accelerates_as_torque_over_mass_says() {
    let mut machine = Machine::ideal(&Robot::standard());
    machine.power.motor_friction_nm = 0.0;
    machine.power.gear_efficiency = 1.0;
    let mut plant = Plant::new(&machine, [0.0; 3], STEP, &[]);
    run(&mut plant, 0.4, &[0.0, 0.7, -0.7]);
    let (power, wheel) = (&machine.power, &machine.wheels[1]);
    let gain = power.gear_ratio * power.torque_constant;
    let inertia = wheel.inertia_kg_m2 + power.gear_ratio.powi(2) * power.rotor_inertia;
    // Wheels 2 and 3 push at 30 degrees to the way ahead; all three turn with the robot.
    let push = 2.0 * 30_f64.to_radians().cos();
    let radius = wheel.radius_m;
    let mass = machine.mass_kg + 1.5 * inertia / (radius * radius);
    let mut speed = 0.0;
    for _ in 0..40_000 {
        let rim = speed * 30_f64.to_radians().cos();
        let torque = gain * (0.7 * power.open_v - gain * rim / radius) / power.resistance_ohm;
        speed += 1e-5 * push * torque / radius / mass;
    }
    let seen = plant.twist();
    assert!((seen[1] / speed - 1.0).abs() < 2e-3, "{} m/s instead of {speed} m/s", seen[1]);
    assert!(seen[0].abs() < 1e-6 && seen[2].abs() < 1e-5);
    // The same on the spot.
    let mut plant = Plant::new(&machine, [0.0; 3], STEP, &[]);
    run(&mut plant, 0.2, &[0.5; 3]);
    let moment = machine.yaw_inertia_kg_m2 + 3.0 * inertia * (0.085 / radius).powi(2);
    let mut spin = 0.0;
    for _ in 0..20_000 {
        let torque = gain * (0.5 * power.open_v - gain * spin * 0.085 / radius) / power.resistance_ohm;
        spin += 1e-5 * 3.0 * torque * 0.085 / radius / moment;
    }
    let seen = -plant.twist()[2];
    assert!((seen / spin - 1.0).abs() < 2e-3, "{seen} rad/s instead of {spin} rad/s");
}

#[test]
fn without_slip_the_wheels_follow_the_kinematic_equation() {
    let robot = Robot::standard();
    let mut machine = Machine::ideal(&robot);
    let skew = [0.07, -0.052, 0.035];
    for (wheel, skew) in machine.wheels.iter_mut().zip(skew) {
        wheel.mount.drive_rad -= skew;
    }
    let mut plant = Plant::new(&machine, [0.0, 0.0, 0.4], STEP, &[]);
    let (mut error, mut power) = (0.0, 0.0);
    for k in 0..3000 {
        let time = f64::from(k) * 0.001;
        let duty = [0.5 * (3.0 * time).sin(), 0.4 * (4.1 * time + 1.0).sin(), 0.5 * (2.3 * time + 2.0).cos()];
        run(&mut plant, 0.001, &duty);
        let [vx, vy, spin] = plant.twist();
        let (sin, cos) = plant.pose()[2].sin_cos();
        let body = [cos * vx + sin * vy, -sin * vx + cos * vy, spin];
        for (i, wheel) in machine.wheels.iter().enumerate() {
            let ideal = wheel.mount.rim_speed(body) / wheel.radius_m;
            error += (plant.rotor_speed(i) - ideal).powi(2);
            power += ideal * ideal;
        }
    }
    let relative = (error / power).sqrt();
    assert!(relative < 2e-3, "relative slip {relative}");
}

#[test]
fn dry_friction_holds_the_robot_on_a_slope_and_lets_go_beyond() {
    let mut machine = Machine::ideal(&Robot::standard());
    machine.wheels.iter_mut().for_each(|wheel| wheel.dry_nm = [0.005; 2]);
    let push = machine.mass_kg * GRAVITY;
    machine.ground.tilt_rad = [0.2 / push, 0.1 / push];
    let mut plant = Plant::new(&machine, [0.0; 3], STEP, &[]);
    run(&mut plant, 3.0, &[0.0; 3]);
    let [x, y, heading] = plant.pose();
    assert!(x.hypot(y) < 5e-5 && heading.abs() < 5e-4, "crept to {x} {y} {heading}");
    machine.ground.tilt_rad = [1.2 / push, 0.0];
    let mut plant = Plant::new(&machine, [0.0; 3], STEP, &[]);
    run(&mut plant, 3.0, &[0.0; 3]);
    assert!(plant.pose()[0] > 0.01, "held at {:?}", plant.pose());
}

#[test]
fn a_wheel_on_a_slippery_floor_spins_and_the_robot_gets_no_more_than_the_friction() {
    let mut machine = Machine::ideal(&Robot::standard());
    machine.ground.friction_static = 0.15;
    machine.ground.friction_sliding = 0.12;
    let mut plant = Plant::new(&machine, [0.0; 3], STEP, &[]);
    // Ahead: wheel 1 rolls sideways, wheels 2 and 3 pull at 30 degrees to the direction of travel.
    run(&mut plant, 0.5, &[0.0, 1.0, -1.0]);
    let speed = plant.twist()[1];
    let most = 0.15 * GRAVITY * 0.5;
    let rim = plant.rotor_speed(1) * machine.wheels[1].radius_m;
    assert!(speed > 0.2 * most && speed < most, "{speed} of {most}");
    assert!(rim > 1.5 * speed, "rim {rim} against {speed}");
}

#[test]
fn halving_the_step_changes_little() {
    let robot = Robot { control_rate_hz: 1000.0, ..Robot::standard() };
    let machine = Machine::ideal(&robot);
    let path = |step: f64| {
        let mut plant = Plant::new(&machine, [0.0; 3], step, &[]);
        for k in 0..(2.0 / step).round() as usize {
            let time = k as f64 * step;
            let duty = [0.6 * (3.0 * time).sin(), 0.5 * (4.1 * time).sin(), -0.5 * (2.3 * time).sin()];
            plant.advance(&duty, &Shake::default());
        }
        plant.pose()
    };
    let (coarse, fine) = (path(5e-5), path(1.25e-5));
    let travelled = fine[0].hypot(fine[1]);
    let apart = (coarse[0] - fine[0]).hypot(coarse[1] - fine[1]);
    assert!(apart < 2e-3 * travelled + 2e-4, "{apart} m apart after {travelled} m");
}

#[test]
fn counts_and_camera_agree_without_nuisances() {
    let robot = Robot::standard();
    let mut machine = Machine::ideal(&robot);
    machine.camera.noise_m = 0.0;
    machine.camera.noise_rad = 0.0;
    let commands = (0..1200)
        .map(|k| {
            let time = f64::from(k) * 0.005;
            [0.4 * (2.0 * time).sin(), 0.3 * (1.3 * time).sin(), 1.5 * (0.9 * time).sin()]
        })
        .collect();
    let start = [0.2, -0.1, 1.0];
    let drive = Drive { name: "test".into(), commands, period_s: 0.005, start, hits: Vec::new() };
    let log = simulate_run(&robot, &machine, &drive, 1, 0);
    assert_eq!(log.rows.len(), 6000);
    assert!(log.to_csv(Columns::ALL).lines().count() == 6001);
    // Midpoint odometry from counts with the inverse of the kinematic equation for three equal wheels.
    let metres = robot.wheel_radius_m * robot.speed_quantum() / robot.control_rate_hz;
    let mounts = robot.mounts();
    let seen = *log.frames.last().unwrap();
    let mut pose = start;
    for pair in log.rows[..=seen.tick].windows(2) {
        let mut delta = [0.0; 3];
        for (i, mount) in mounts.iter().enumerate() {
            let rim = (pair[1].counts[i] - pair[0].counts[i]) as f64 * metres;
            let [gx, gy] = mount.grip();
            delta[0] += 2.0 / 3.0 * gx * rim;
            delta[1] += 2.0 / 3.0 * gy * rim;
            delta[2] -= rim / (3.0 * 0.085);
        }
        let (sin, cos) = (pose[2] + 0.5 * delta[2]).sin_cos();
        pose[0] += cos * delta[0] - sin * delta[1];
        pose[1] += sin * delta[0] + cos * delta[1];
        pose[2] += delta[2];
    }
    let apart = (seen.pose[0] - pose[0]).hypot(seen.pose[1] - pose[1]);
    assert!(apart < 0.0015, "{apart} m apart: {seen:?} {pose:?}");
    assert!((truth::wrap(seen.pose[2] - pose[2])).abs() < 0.004, "{seen:?} {pose:?}");
}
