//! Body and floor.

use super::*;

#[test]
fn mass_and_inertia() {
    close(applied("robot-mass", &[("scale", 0.1)]).robot.mass_kg, 2.64, 1e-9);
    close(applied("yaw-inertia", &[("scale", 0.2)]).robot.yaw_inertia_kg_m2, 0.0114, 1e-9);
}

#[test]
fn a_thrown_robot_turns_about_its_centre_of_mass() {
    let (cx, cy) = (0.02, -0.03);
    let mut plant = thrown("centre-of-mass", &[("x_m", cx), ("y_m", cy)], Twist::new(0.6, 0.3, 5.0));
    let centre = |p: &Plant| {
        let at = p.pose().compose(Pose::new(cx, cy, 0.0));
        [at.x, at.y]
    };
    run(&mut plant, [0.0; 3], 1);
    let (a, turned) = (centre(&plant), plant.twist().omega);
    run(&mut plant, [0.0; 3], 400);
    let b = centre(&plant);
    run(&mut plant, [0.0; 3], 400);
    let c = centre(&plant);
    // Straight and steady, though the chassis centre swings around it.
    for i in 0..2 {
        assert!((c[i] - 2.0 * b[i] + a[i]).abs() < 2e-4, "{a:?} {b:?} {c:?}");
    }
    close(plant.twist().omega, turned, 1e-3);
}

#[test]
fn a_tilted_floor_pulls_downhill_whatever_the_heading() {
    for theta in [0.0, 1.0, 3.0] {
        let tilt = [("x_rad", 0.02), ("y_rad", -0.01)];
        let mut plant = thrown("floor-tilt", &tilt, Twist::default()).at(Pose::new(0.0, 0.0, theta));
        run(&mut plant, [0.0; 3], 500);
        close(velocity(&plant)[0], 0.5 * 9.806_65 * 0.02, 1e-3);
        close(velocity(&plant)[1], -0.5 * 9.806_65 * 0.01, 1e-3);
    }
}

#[test]
fn the_carpet_drags_along_its_grain_only() {
    let azimuth = 0.7_f64;
    let mut plant = thrown("carpet-grain", &[("force_n", 0.6), ("azimuth_rad", azimuth)], Twist::new(1.0, 0.0, 0.0));
    run(&mut plant, [0.0; 3], 800);
    let v = velocity(&plant);
    let (along, across) = (v[0] * azimuth.cos() + v[1] * azimuth.sin(), v[1] * azimuth.cos() - v[0] * azimuth.sin());
    close(along, azimuth.cos() - 0.8 * 0.6 / 2.4, 1e-3);
    close(across, -azimuth.sin(), 1e-3);
}

#[test]
fn what_drags_at_the_body_holds_it_back_whichever_way_it_goes() {
    for way in [0.2_f64, 0.7, 2.0] {
        let mut plant = thrown("body-drag", &[("force_n", 0.6)], Twist::new(way.cos(), way.sin(), 0.0));
        run(&mut plant, [0.0; 3], 800);
        close(plant.twist().vx, (1.0 - 0.8 * 0.6 / 2.4) * way.cos(), 1e-3);
        close(plant.twist().vy, (1.0 - 0.8 * 0.6 / 2.4) * way.sin(), 1e-3);
    }
    // No turn on the spot.
    let mut plant = thrown("body-drag", &[("force_n", 0.6)], Twist::new(0.0, 0.0, 5.0));
    run(&mut plant, [0.0; 3], 500);
    close(plant.twist().omega, 5.0, 1e-6);
}

#[test]
fn what_resists_a_turn_slows_no_way() {
    for turn in [1.0, -1.0] {
        let mut plant = thrown("turning-resistance", &[("torque_nm", 0.02)], Twist::new(0.0, 0.0, 5.0 * turn));
        run(&mut plant, [0.0; 3], 500);
        let slowed = turn * plant.twist().omega;
        assert!(slowed > 0.0 && slowed < 4.9, "{slowed}");
    }
    let mut plant = thrown("turning-resistance", &[("torque_nm", 0.02)], Twist::new(1.0, 0.5, 0.0));
    run(&mut plant, [0.0; 3], 500);
    close(plant.twist().vx, 1.0, 1e-6);
}

#[test]
fn rollers_rub_in_the_direction_they_roll_in() {
    // To the right wheel 1 rolls freely on its drive, its rollers stand; the other two slide at 60°
    // to their rollers' direction: 2·F·cos 30°.
    let mut plant = thrown("roller-friction", &[("force_n", 0.3)], Twist::new(1.0, 0.0, 0.0));
    run(&mut plant, [0.0; 3], 500);
    close(plant.twist().vx, 1.0 - 0.5 * 2.0 * 0.3 * 30.0_f64.to_radians().cos() / 2.4, 2e-3);
    // A turn on the spot slides no roller.
    let mut plant = thrown("roller-friction", &[("force_n", 0.3)], Twist::new(0.0, 0.0, 5.0));
    run(&mut plant, [0.0; 3], 500);
    close(plant.twist().omega, 5.0, 1e-6);
}
