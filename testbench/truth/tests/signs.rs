//! Every effect acts in the direction that its parameters state.

use truth::{Case, Drive, Kind, Log, Machine, Plant, Robot, Shake, draw, simulate, simulate_run};

/// The robot of this seed with the effect, and without.
fn pair(seed: u64, effect: &str) -> (Case, Case) {
    let kind: Kind = format!("single:{effect}:5").parse().unwrap();
    (draw(seed, &kind).unwrap(), draw(seed, &Kind::EffectFree).unwrap())
}

fn parameter(case: &Case, name: &str) -> f64 {
    case.effects[0].parameters[name]
}

/// Distance (m) and turn (rad) after a second from standstill with these duties.
fn response(case: &Case, duty: [f64; 3]) -> (f64, f64) {
    let mut plant = Plant::new(&case.machine, [0.0; 3], 5e-5, &[]);
    for _ in 0..20_000 {
        plant.advance(&duty, &Shake::default());
    }
    let [x, y, heading] = plant.pose();
    (x.hypot(y), heading)
}

#[test]
fn what_brakes_brakes() {
    for effect in [
        "coulomb-friction",
        "viscous-friction",
        "stribeck-friction",
        "gear-efficiency",
        "roller-friction",
        "dead-band",
        "battery-sag",
        "motor-heating",
    ] {
        let (with, without) = pair(4, effect);
        let (there, here) = (response(&with, [0.0, 0.6, -0.6]).0, response(&without, [0.0, 0.6, -0.6]).0);
        assert!(there < 0.99 * here, "{effect}: {there} m instead of {here} m");
    }
}

#[test]
fn signed_scales_act_with_their_sign() {
    for seed in 0..6 {
        for (effect, up_is_faster, turn) in
            [("robot-mass", false, false), ("torque-constant", true, false), ("yaw-inertia", false, true)]
        {
            let (with, without) = pair(seed, effect);
            let duty = if turn { [0.6; 3] } else { [0.0, 0.6, -0.6] };
            let measure = |case: &Case| {
                let (distance, heading) = response(case, duty);
                if turn { heading.abs() } else { distance }
            };
            let faster = measure(&with) > measure(&without);
            assert_eq!(faster == up_is_faster, parameter(&with, "scale") > 0.0, "{effect} seed {seed}");
        }
    }
}

/// Camera path length and turn over those of the counts, from all runs.
fn camera_over_counts(case: &Case) -> (f64, f64) {
    let radius = 2.0 / 3.0 * case.robot.wheel_radius_m * case.robot.speed_quantum() / case.robot.control_rate_hz;
    let mounts = case.robot.mounts();
    let body_radius = mounts[0].x_m.hypot(mounts[0].y_m);
    let (mut path, mut turn) = ([0.0; 2], [0.0; 2]);
    for Log { rows, frames, .. } in simulate(case) {
        for pair in frames.windows(31).step_by(10) {
            let (first, last) = (pair[0], pair[30]);
            let mut pose = [0.0; 3];
            for ticks in rows[first.tick..=last.tick].windows(2) {
                let mut delta = [0.0; 3];
                for (i, mount) in mounts.iter().enumerate() {
                    let rim = (ticks[1].counts[i] - ticks[0].counts[i]) as f64 * radius;
                    delta[0] += mount.grip()[0] * rim;
                    delta[1] += mount.grip()[1] * rim;
                    delta[2] -= rim / (2.0 * body_radius);
                }
                let (sin, cos) = (pose[2] + 0.5 * delta[2]).sin_cos();
                pose[0] += cos * delta[0] - sin * delta[1];
                pose[1] += sin * delta[0] + cos * delta[1];
                pose[2] += delta[2];
            }
            let counted = pose[0].hypot(pose[1]);
            let seen = (last.pose[0] - first.pose[0]).hypot(last.pose[1] - first.pose[1]);
            path[0] += seen * counted;
            path[1] += counted * counted;
            let turned = pose[2] + truth::wrap(last.pose[2] - first.pose[2] - pose[2]);
            turn[0] += turned * pose[2];
            turn[1] += pose[2] * pose[2];
        }
    }
    (path[0] / path[1], turn[0] / turn[1])
}

#[test]
fn lengths_in_the_camera_follow_radii_and_scales() {
    for seed in [1, 2, 3] {
        for effect in ["wheel-radius-common", "camera-scale", "body-radius", "encoder-scale"] {
            let (with, without) = pair(seed, effect);
            let Some(&scale) = with.effects[0].parameters.get("scale") else { continue };
            let ((path, turn), (plain_path, plain_turn)) = (camera_over_counts(&with), camera_over_counts(&without));
            let (path, turn) = (path / plain_path - 1.0, turn / plain_turn - 1.0);
            let (expected_path, expected_turn) = match effect {
                "wheel-radius-common" => (scale, scale),
                "camera-scale" => (scale, 0.0),
                "body-radius" => (0.0, -scale / (1.0 + scale)),
                _ => (-scale / (1.0 + scale), -scale / (1.0 + scale)),
            };
            assert!((path - expected_path).abs() < 0.012, "{effect} seed {seed}: path {path}, {expected_path}");
            assert!((turn - expected_turn).abs() < 0.02, "{effect} seed {seed}: turn {turn}, {expected_turn}");
        }
    }
}

#[test]
fn a_tilted_floor_pulls_downhill_and_a_late_camera_shows_the_past() {
    let (with, without) = pair(2, "floor-tilt");
    let slide = |case: &Case| {
        let mut machine = case.machine.clone();
        machine.power.gear_efficiency = 1.0;
        machine.power.motor_friction_nm = 0.0;
        let mut plant = Plant::new(&machine, [0.0; 3], 5e-5, &[]);
        for _ in 0..40_000 {
            plant.advance(&[0.0; 3], &Shake::default());
        }
        plant.pose()
    };
    let [x, y, _] = slide(&with);
    let along = x * parameter(&with, "x_rad") + y * parameter(&with, "y_rad");
    assert!(along > 0.0 && x.hypot(y) > 0.01, "slid to {x} {y}");
    let [x, y, _] = slide(&without);
    assert!(x.hypot(y) < 1e-6);

    let (with, without) = pair(2, "camera-latency");
    let latency = parameter(&with, "latency_s");
    let (with, without) = (simulate(&with), simulate(&without));
    assert_eq!(with[0].rows, without[0].rows);
    // The noise is the same, so the difference of two frames is the motion during the latency.
    let (mut explained, mut power) = (0.0, 0.0);
    for (late, prompt) in with.iter().zip(&without) {
        for k in 6..late.frames.len().min(prompt.frames.len()) {
            let moved = |axis: usize| prompt.frames[k].pose[axis] - prompt.frames[k - 6].pose[axis];
            let speed = [moved(0) * 10.0, moved(1) * 10.0];
            for (axis, speed) in speed.into_iter().enumerate() {
                explained += (prompt.frames[k].pose[axis] - late.frames[k].pose[axis]) * speed;
                power += speed * speed;
            }
        }
    }
    let seen = explained / power;
    assert!((seen / latency - 1.0).abs() < 0.15, "{seen} s instead of {latency} s");
}

#[test]
fn skews_turn_drive_directions_clockwise_and_angles_turn_wheels_counter_clockwise() {
    for seed in 0..5 {
        for effect in ["wheel-skew", "wheel-angle"] {
            let (with, _) = pair(seed, effect);
            let nominal = with.robot.mounts();
            for (i, (wheel, nominal)) in with.machine.wheels.iter().zip(&nominal).enumerate() {
                let of = |name: String| with.effects[0].parameters.get(&name).copied().unwrap_or(0.0);
                let (skew, angle) = (of(format!("skew_{}_rad", i + 1)), of(format!("angle_{}_rad", i + 1)));
                let spoke = nominal.y_m.atan2(nominal.x_m) + angle;
                let expected = truth::Mount::on_circle(spoke, nominal.x_m.hypot(nominal.y_m), skew);
                assert!((wheel.mount.x_m - expected.x_m).abs() < 1e-12, "{effect} {i}");
                assert!((wheel.mount.y_m - expected.y_m).abs() < 1e-12, "{effect} {i}");
                assert!(truth::wrap(wheel.mount.drive_rad - expected.drive_rad).abs() < 1e-12, "{effect} {i}");
            }
        }
    }
}

#[test]
fn lost_edges_make_the_wheels_turn_further_than_they_count() {
    let robot = Robot::standard();
    let mut machine = Machine::ideal(&robot);
    machine.wheels.iter_mut().for_each(|wheel| wheel.encoder_loss = 0.1);
    let commands = (0..400).map(|k| [0.0, 0.0, if (20..360).contains(&k) { 1.5 } else { 0.0 }]).collect();
    let drive = Drive { name: "turn".into(), commands, period_s: 0.005, start: [0.0; 3], hits: Vec::new() };
    let log = simulate_run(&robot, &machine, &drive, 1, 0);
    let seen = log.frames.last().unwrap().pose[2];
    let counts: i64 = log.rows.last().unwrap().counts.iter().sum();
    let rim = counts as f64 * robot.speed_quantum() / robot.control_rate_hz * robot.wheel_radius_m;
    let counted = -rim / (3.0 * 0.085);
    assert!((counted - 1.5 * 1.7).abs() < 0.1, "the loop follows what it counts: {counted}");
    assert!((seen / counted - 1.0 / 0.9).abs() < 0.02, "turned {seen}, counted {counted}");
}

/// At rest an inertial sensor feels the floor push uphill, and tells the same otherwise.
#[test]
fn a_standing_robot_feels_the_slope() {
    for seed in 0..3 {
        let (with, without) = pair(seed, "floor-tilt");
        let start = [0.4, -0.2, 0.9];
        let drive = Drive {
            name: "rest".to_owned(),
            commands: vec![[0.0; 3]; 60],
            period_s: 1.0 / 60.0,
            start,
            hits: Vec::new(),
        };
        let log = |case: &Case| simulate_run(&case.robot, &case.machine, &drive, case.seed, 0).inertial;
        let (felt, level) = (log(&with), log(&without));
        let part = felt.len() / 2..felt.len();
        let n = part.len() as f64;
        let mean = |i: usize| part.clone().map(|k| felt[k][i] - level[k][i]).sum::<f64>() / n;
        let tilt = ["x_rad", "y_rad"].map(|name| truth::GRAVITY * parameter(&with, name));
        let (sin, cos) = start[2].sin_cos();
        let uphill = [-cos * tilt[0] - sin * tilt[1], sin * tilt[0] - cos * tilt[1]];
        assert!((mean(1) - uphill[0]).abs() < 0.02 && (mean(2) - uphill[1]).abs() < 0.02, "{seed}: {uphill:?}");
        assert!(mean(0).abs() < 0.01, "{seed}");
    }
}
