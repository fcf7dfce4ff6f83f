//! What every set has, the effect-free ones too: the robot that is driven and the imperfections nobody writes down.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use crate::case::Conditions;
use crate::geometry::Mount;
use crate::machine::Machine;
use crate::robot::{Layout, Robot};

/// A robot under these conditions: that of the example sets, or in three of ten cases a relative of it.
pub(crate) fn draw_robot(conditions: &Conditions, rng: &mut ChaCha8Rng) -> Robot {
    let mut robot = Robot::standard();
    let relative = rng.random_bool(0.3) && !conditions.standard_robot;
    let factors: [f64; 8] = std::array::from_fn(|_| rng.random_range(-1.0..1.0));
    if relative {
        let near = |value: f64, spread: f64, k: usize, digits: i32| {
            let scale = 10_f64.powi(digits);
            (value * (1.0 + spread * factors[k]) * scale).round() / scale
        };
        robot.wheel_radius_m = near(robot.wheel_radius_m, 0.12, 0, 4);
        robot.layout = Layout::Circle(near(0.082, 0.08, 1, 3));
        robot.mass_kg = near(robot.mass_kg, 0.2, 2, 2);
        robot.yaw_inertia_kg_m2 = near(robot.yaw_inertia_kg_m2, 0.2, 3, 4);
        robot.gear_ratio = near(robot.gear_ratio, 0.15, 4, 2);
        robot.gear_efficiency = near(0.87, 0.05, 5, 2);
        robot.resistance_ohm = near(robot.resistance_ohm, 0.15, 6, 2);
        robot.kp = near(robot.kp, 0.25, 7, 3);
    }
    if conditions.wheels == 4 {
        robot.layout = Layout::Listed(four_wheels(rng));
    }
    robot.control_rate_hz = conditions.rate_hz;
    // A faster loop measures speed in coarser quanta; the gain follows so that the duty does not chatter more.
    robot.kp *= (1000.0 / conditions.rate_hz).min(1.0);
    if conditions.blocks {
        robot.blocks = true;
        robot.wheel_inertia_kg_m2 = Some(f64::from(rng.random_range(40..80_u8)) * 1.0e-7);
        // Nothing but the shaft to move: gains for a load a hundred times lighter.
        let slow = (conditions.rate_hz / 1000.0).min(1.0);
        robot.soften();
        robot.kp *= slow;
        robot.ki *= slow;
    }
    if rng.random_bool(0.12) && !conditions.standard_robot {
        robot.soften();
    }
    robot.kp = (robot.kp * 1.0e5).round() / 1.0e5;
    robot.ki = (robot.ki * 1.0e5).round() / 1.0e5;
    if !conditions.blocks && rng.random_bool(0.15) {
        robot.camera_latency_s = Some(f64::from(rng.random_range(5..40_u8)) * 1.0e-3);
    }
    robot.quanta_stated = rng.random_bool(0.3);
    let noise_m = if rng.random_bool(0.5) { 0.0015 } else { rng.random_range(0.0008..0.0025) };
    let noise_rad = noise_m / 0.0015 * 0.5_f64.to_radians();
    robot.camera_noise = Some([noise_m, noise_m, noise_rad]);
    robot
}

/// A square robot: omni wheels as the league places them, or mecanum wheels whose rollers all help it to turn.
fn four_wheels(rng: &mut ChaCha8Rng) -> Vec<Mount> {
    use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};
    if rng.random_bool(0.7) {
        return [33.0_f64, 147.0, 225.0, 315.0].map(|spoke| Mount::on_circle(spoke.to_radians(), 0.083, 0.0)).to_vec();
    }
    [(-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0), (1.0, 1.0)]
        .map(|(side, end): (f64, f64)| Mount {
            x_m: 0.07 * side,
            y_m: 0.09 * end,
            drive_rad: -side * FRAC_PI_2,
            roller_rad: side * end * FRAC_PI_4,
        })
        .to_vec()
}

/// Sliding friction as a share of the static one: least and most.
pub const SLIDING: [f64; 2] = [0.8, 0.95];

/// The robot with all its nuisances.
pub(crate) fn draw_machine(robot: &Robot, rng: &mut ChaCha8Rng) -> Machine {
    let mut machine = Machine::ideal(robot);
    machine.centre_height_m = rng.random_range(0.03..0.045);
    let ground = &mut machine.ground;
    ground.stiffness_n_m = rng.random_range(2.5e4..5.0e4);
    ground.damping_ns_m = rng.random_range(18.0..30.0);
    ground.creep_s_per_kg = rng.random_range(1.0e-5..5.0e-5);
    ground.slip_ratio_per_n = rng.random_range(1.0e-4..4.0e-4);
    ground.friction_static = rng.random_range(0.8..1.05);
    ground.friction_sliding = ground.friction_static * rng.random_range(SLIDING[0]..SLIDING[1]);
    let power = &mut machine.power;
    power.inductance_h = rng.random_range(5.0e-5..9.0e-5);
    power.battery_ohm = rng.random_range(0.045..0.055);
    power.supply_measured = rng.random_bool(0.75);
    power.supply_noise_v = 0.010;
    let [noise_m, _, noise_rad] = robot.camera_noise.unwrap_or([0.0015, 0.0015, 0.0087]);
    machine.camera.noise_m = noise_m;
    machine.camera.noise_rad = noise_rad;
    machine.roughness.force_n = rng.random_range(0.03..0.12);
    machine.roughness.moment_nm = rng.random_range(0.001..0.003);
    machine.roughness.shaft_nm = rng.random_range(1.0e-4..4.0e-4);
    machine.roughness.time_s = rng.random_range(0.03..0.08);
    let inertia = robot.wheel_inertia_kg_m2.unwrap_or_else(|| rng.random_range(4.0e-6..8.0e-6));
    let ripple = rng.random_range(0.0004..0.0012);
    for wheel in &mut machine.wheels {
        wheel.inertia_kg_m2 = inertia;
        wheel.roller_drag_n = rng.random_range(0.05..0.07);
        wheel.viscous_nms = rng.random_range(1.0e-6..6.0e-6);
        wheel.ripple_amplitude = ripple;
        wheel.ripple_phase_rad = rng.random_range(0.0..std::f64::consts::TAU);
    }
    machine
}
