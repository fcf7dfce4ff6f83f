//! Motors, gears, bridge, battery and friction at the wheel shaft.

use super::*;
use crate::motor::Axis;

fn axis() -> Axis {
    Axis::of(&Robot::racbot())
}

/// Speed at which a lifted wheel settles under a duty, with friction and damping beyond nominal.
fn settled(duty: f64, friction: f64, damping: f64) -> f64 {
    let a = axis();
    duty.signum() * (a.torque_per_volt * 7.2 * duty.abs() - a.coulomb - friction) / (a.damping + damping)
}

#[test]
fn friction_at_the_wheel_shaft() {
    let speeds = |name, p: &[(&str, f64)]| {
        let mut plant = lifted(name, p);
        run(&mut plant, [0.8, -0.8, 0.8], 2000);
        [0, 1, 2].map(|i| speed(&plant, i))
    };
    let [one, two, three] = speeds("coulomb-friction", &[("torque_1_nm", 0.02), ("torque_nm", 0.005)]);
    close(one, settled(0.8, 0.025, 0.0), 1e-3);
    close(two, settled(-0.8, 0.005, 0.0), 1e-3);
    close(three, settled(0.8, 0.005, 0.0), 1e-3);
    let [one, two, _] = speeds("viscous-friction", &[("coefficient_1_nms", 1e-4)]);
    close(one, settled(0.8, 0.0, 1e-4), 1e-3);
    close(two, settled(-0.8, 0.0, 0.0), 1e-3);
    let [one, two, _] = speeds("asymmetric-friction", &[("torque_nm", 0.01), ("sense", -1.0)]);
    close(one, settled(0.8, 0.0, 0.0), 1e-3);
    close(two, settled(-0.8, 0.01, 0.0), 1e-3);
    let [one, _, three] = speeds("heading-drag", &[("mean_nm", 0.004), ("cos_nm", 0.003), ("harmonic", 2.0)]);
    close(one, settled(0.8, 0.007, 0.0), 1e-3);
    close(three, settled(0.8, 0.007, 0.0), 1e-3);
    let [one, ..] = speeds("stribeck-friction", &[("torque_nm", 0.02), ("speed_rad_s", 3.0)]);
    close(one, settled(0.8, 0.0, 0.0), 1e-3);
}

#[test]
fn a_weight_hangs_where_its_torque_is_0() {
    let mut plant = lifted("gravity-load", &[("sin_1_nm", -0.02), ("cos_1_nm", 0.01)]);
    run(&mut plant, [0.0; 3], 3000);
    let per_rad = Robot::racbot().counts_per_wheel_rad();
    // Friction holds it a little before.
    close(plant.encoder_after()[0] / per_rad, 0.5_f64.atan(), 0.06);
    assert_eq!(plant.encoder_after()[1..], [0.0; 2]);
}

#[test]
fn an_encoder_beside_the_middle_reads_ahead_once_a_turn() {
    let run = |name: &str, parameters: &[(&str, f64)]| {
        let mut plant = lifted(name, parameters);
        run(&mut plant, [0.5; 3], 400);
        plant.encoder_after()[0] / Robot::racbot().counts_per_wheel_rad()
    };
    let shaft = run("encoder-eccentricity", &[]);
    let read = run("encoder-eccentricity", &[("sin_1_rad", 0.03), ("cos_1_rad", -0.02), ("order", 2.0)]);
    let (sin, cos) = (2.0 * shaft).sin_cos();
    assert!(shaft > 1.0);
    close(read - shaft, 0.03 * sin - 0.02 * (cos - 1.0), 1e-9);
}

#[test]
fn a_spring_turns_back_to_its_rest() {
    let mut plant = lifted("joint-spring", &[("stiffness_1_nm_per_rad", 0.02), ("preload_1_nm", 0.03)]);
    run(&mut plant, [0.0; 3], 3000);
    let per_rad = Robot::racbot().counts_per_wheel_rad();
    // Friction holds it a little before.
    close(plant.encoder_after()[0] / per_rad, 1.5, 0.06);
    assert_eq!(plant.encoder_after()[1..], [0.0; 2]);
}

#[test]
fn a_weight_on_a_rope_pulls_wherever_it_is() {
    let mut plant = lifted("hanging-load", &[("torque_1_nm", 0.03)]);
    run(&mut plant, [0.0; 3], 3000);
    let per_rad = Robot::racbot().counts_per_wheel_rad();
    // The motor brakes it, and nothing holds it.
    assert!(plant.encoder_after()[0] / per_rad > 10.0, "{:?}", plant.encoder_after());
    assert_eq!(plant.encoder_after()[1..], [0.0; 2]);
}

#[test]
fn what_sticks_lets_go_at_the_stribeck_torque() {
    let moved = |torque: f64| {
        let mut plant = lifted("stribeck-friction", &[("torque_nm", 0.02), ("speed_rad_s", 3.0)]);
        let duty = torque / (axis().torque_per_volt * 7.2);
        run(&mut plant, [duty; 3], 200);
        speed(&plant, 0)
    };
    assert_eq!(moved(0.02), 0.0);
    assert!(moved(0.022) > 10.0);
}

#[test]
fn bridge() {
    let way = |name, p: &[(&str, f64)], duty: [f64; 3]| {
        let mut plant = applied(name, p).plant().unwrap();
        run(&mut plant, duty, 400);
        plant.encoder_after().to_vec()
    };
    let plain = |duty| way("wheel-skew", &[], duty);
    assert_eq!(way("dead-band", &[("duty", 0.1)], [0.05, -0.09, 0.1]), [0.0; 3]);
    assert_eq!(way("dead-band", &[("duty", 0.125)], [0.375, -0.625, 0.0]), plain([0.25, -0.5, 0.0]));
    assert_eq!(way("drive-curve", &[("curvature", 0.5)], [0.5, -1.0, 0.0]), plain([0.375, -1.0, 0.0]));
}

#[test]
fn no_motor_has_more_than_its_driver_lets_through() {
    // 1.2 A of the 3.71 that the winding draws at a standstill, whichever way it is driven; 0.3 duties ask for less.
    let moved = |name, p: &[(&str, f64)], duty: f64| {
        let mut plant = lifted(name, p);
        plant.step(&[duty, -duty, 0.0], 7.2, 1e-6);
        speed(&plant, 0)
    };
    let (limited, plain) = ([("limit_a", 1.2)], |duty| moved("wheel-skew", &[], duty));
    close(moved("current-limit", &limited, 1.0), plain(1.2 * 1.94 / 7.2), 1e-6);
    close(moved("current-limit", &limited, -1.0), -plain(1.2 * 1.94 / 7.2), 1e-6);
    close(moved("current-limit", &limited, 0.3), plain(0.3), 1e-9);
    // A wheel that runs at full speed and is driven back is braked by no more.
    let braked = |p: &[(&str, f64)]| {
        let mut plant = lifted("current-limit", p);
        run(&mut plant, [1.0, 1.0, 0.0], 4000);
        let before = speed(&plant, 0);
        plant.step(&[-1.0, -1.0, 0.0], 7.2, 1e-4);
        before - speed(&plant, 0)
    };
    assert!(braked(&limited) < 0.4 * braked(&[("limit_a", 50.0)]), "{}", braked(&limited));
}

#[test]
fn a_bridge_takes_its_drop_off_whichever_way_the_current_goes() {
    let moved = |name, p: &[(&str, f64)], duty: f64| {
        let mut plant = lifted(name, p);
        plant.step(&[duty, -duty, 0.0], 7.2, 1e-6);
        speed(&plant, 0)
    };
    let (dropped, plain) = ([("drop_v", 1.8)], |duty| moved("wheel-skew", &[], duty));
    close(moved("bridge-drop", &dropped, 0.75), plain(0.5), 1e-6);
    close(moved("bridge-drop", &dropped, -0.75), -plain(0.5), 1e-6);
    assert_eq!(moved("bridge-drop", &dropped, 0.25), 0.0);
    // A wheel that runs and is braked loses that of the braking, too.
    let braked = |p: &[(&str, f64)]| {
        let mut plant = lifted("bridge-drop", p);
        plant.step(&[0.0; 3], 7.2, 1e-6);
        run(&mut plant, [0.9, 0.9, 0.0], 4000);
        let before = speed(&plant, 0);
        plant.step(&[-0.25, -0.25, 0.0], 7.2, 1e-4);
        (before - speed(&plant, 0)) / (before + 0.25 * 7.2 / (0.00692 * 3.71))
    };
    assert!(braked(&dropped) < 0.9 * braked(&[]), "{} of {}", braked(&dropped), braked(&[]));
}

#[test]
fn duties_come_late() {
    let mut late = applied("actuation-latency", &[("latency_s", 0.0055)]).plant().unwrap();
    let mut plain = applied("wheel-skew", &[]).plant().unwrap();
    let duty = |k: usize| if k < 40 { [0.0, 0.5, -0.5] } else { [0.2, -0.5, 0.5] };
    for k in 0..100 {
        late.step(&duty(k), 7.2, 0.001);
        let at = |age: usize| k.checked_sub(age).map_or([0.0; 3], duty);
        let [a, b] = [at(5), at(6)];
        plain.step(&[0, 1, 2].map(|i| 0.5 * (a[i] + b[i])), 7.2, 0.001);
    }
    for (a, b) in late.encoder_after().iter().zip(plain.encoder_after()) {
        assert!((a - b).abs() < 1e-9, "{a} {b}");
    }
}

#[test]
fn the_battery_gives_way_under_the_sum_of_the_currents() {
    let moved = |name, p: &[(&str, f64)], supply: f64| {
        let mut plant = lifted(name, p);
        plant.step(&[1.0, -1.0, 0.5], supply, 1e-6);
        speed(&plant, 0)
    };
    // At standstill: V = (7.2 − 0.2)/(1 + 0.4·(1 + 1 + 0.25)/1.94).
    let left = 7.0 / (1.0 + 0.4 * 2.25 / 1.94);
    let sagging = moved("battery-sag", &[("drop_v", 0.2), ("resistance_ohm", 0.4)], 7.2);
    close(sagging, moved("wheel-skew", &[], left), 1e-6);
}

#[test]
fn a_battery_empties_under_way() {
    let supplied = |scale: f64, fall: f64, s: f64| {
        let mut applied = applied("supply-voltage", &[("scale", scale), ("fall_v_per_s", fall)]);
        applied.robot.support = Support::Blocks;
        applied.robot.motor.friction_torque = 0.0;
        let axis = Axis::of(&applied.robot);
        let (mut plant, dt) = (applied.plant().unwrap(), applied.robot.tick_s());
        for _ in 0..(s / dt).round() as usize {
            plant.step(&[0.5; 3], applied.robot.supply_v, dt);
        }
        speed(&plant, 0) * axis.damping / (0.5 * axis.torque_per_volt)
    };
    close(supplied(-0.1, 0.0, 3.0), 0.9 * 7.2, 1e-3);
    close(supplied(0.0, 0.4, 3.0), 7.2 - 0.4 * 3.0, 0.05);
    // Beyond empty nothing drives it backwards.
    assert!((0.0..1e-6).contains(&supplied(0.0, 4.0, 5.0)));
}

#[test]
fn warm_windings_resist() {
    let mut applied = applied("motor-heating", &[("rise", 0.5), ("time_s", 0.2)]);
    applied.robot.support = Support::Blocks;
    applied.robot.motor.friction_torque = 0.004;
    let cold = Axis::of(&applied.robot);
    let mut plant = applied.plant().unwrap();
    run(&mut plant, [0.8, 0.4, 0.0], 3000);
    for (i, duty) in [0.8, 0.4].into_iter().enumerate() {
        let hot = 1.0 + 0.5 * duty * duty;
        let speed_expected = (cold.torque_per_volt / hot * 7.2 * duty - cold.coulomb) / (cold.damping / hot);
        close(speed(&plant, i), speed_expected, 2e-3);
    }
}

#[test]
fn windings_may_be_warm_from_the_start() {
    let (cold, warm) = (Axis::of(&applied("wheel-skew", &[]).robot), applied("motor-heating", &[("start_k", 50.0)]));
    let warm = Axis::of(&warm.robot);
    let (copper, magnets) = (1.0 + 50.0 * 0.0039, 1.0 - 50.0 * 0.0011);
    close(warm.torque_per_volt, cold.torque_per_volt * magnets / copper, 1e-9);
    close(warm.damping, cold.damping * magnets * magnets / copper, 1e-9);
}

#[test]
fn one_motor_differs_from_the_others() {
    let free = |name, p: &[(&str, f64)]| {
        let mut applied = applied(name, p);
        applied.robot.support = Support::Blocks;
        applied.robot.motor.friction_torque = 0.0;
        let mut plant = applied.plant().unwrap();
        run(&mut plant, [0.5; 3], 3000);
        [0, 1, 2].map(|i| speed(&plant, i))
    };
    // Without friction the no-load speed is the supply's over the constant, whatever the resistance.
    let nominal = free("wheel-skew", &[]);
    let weak = free("torque-constant", &[("scale_2", -0.2)]);
    close(weak[1] / nominal[1], 1.0 / 0.8, 1e-3);
    close(weak[0], nominal[0], 1e-6);
    let both = free("torque-constant", &[("scale", 0.1), ("scale_2", -0.2)]);
    close(both[0] / nominal[0], 1.0 / 1.1, 1e-3);
    close(both[1] / nominal[1], 1.0 / 0.9, 1e-3);
    // At the start a winding of twice the resistance gives half the torque.
    let pushed = |p: &[(&str, f64)]| {
        let mut plant = lifted("winding-resistance", p);
        plant.step(&[1.0; 3], 7.2, 1e-6);
        [0, 1, 2].map(|i| speed(&plant, i))
    };
    let (alike, one) = (pushed(&[]), pushed(&[("scale_3", 1.0)]));
    assert!(one[0] == alike[0] && one[2] < 0.51 * alike[2], "{one:?} of {alike:?}");
}

#[test]
fn figures_of_motor_and_gear() {
    let robot = |name, p: &[(&str, f64)]| applied(name, p).robot;
    let strong = robot("torque-constant", &[("scale", 0.1)]);
    close(strong.motor.torque_constant, 0.007_612, 1e-9);
    close(strong.motor.back_emf(), 0.007_612, 1e-9);
    close(robot("winding-resistance", &[("scale", 0.5)]).motor.resistance_ohm, 2.91, 1e-9);
    close(robot("rotor-inertia", &[("scale", 1.0)]).motor.rotor_inertia, 5.4e-7, 1e-9);
    close(robot("gear-efficiency", &[("scale", -0.08)]).gear_efficiency, 0.8, 1e-9);
}
