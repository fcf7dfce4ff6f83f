//! Geometry, encoders, camera.

use super::*;
use crate::plant::{Contact, Creep};

#[test]
fn geometry() {
    let nominal = Robot::racbot().layout.wheels();
    let wheels = |name, p: &[(&str, f64)]| applied(name, p).robot.layout.wheels();
    let skewed = wheels("wheel-skew", &[("skew_2_rad", 0.05)]);
    close(skewed[1].drive_rad, nominal[1].drive_rad - 0.05, 1e-12);
    assert_eq!(skewed[0], nominal[0]);
    let moved = wheels("wheel-angle", &[("angle_1_rad", 0.1)]);
    close(moved[0].drive_rad, nominal[0].drive_rad + 0.1, 1e-12);
    close(moved[0].x_m, -0.085 * 0.1_f64.sin(), 1e-12);
    close(wheels("body-radius", &[("scale", 0.1)])[0].y_m, 0.0935, 1e-12);
    close(applied("wheel-radius-common", &[("scale", 0.1)]).robot.wheel_radius_m, 0.030_25, 1e-12);
}

#[test]
fn a_larger_wheel_turns_less_for_the_same_way() {
    for floor in [Contact::Rolling, Contact::Friction { friction_coefficient: 0.9, creep: Creep::at_rest(1e-4) }] {
        let large = Applied { contact: floor, ..applied("wheel-radius", &[("scale_2", 0.1)]) };
        let mut plant = large.plant().unwrap().moving(Twist::new(0.0, 0.5, 0.0));
        run(&mut plant, [0.0, 0.3, -0.3], 500);
        let way = plant.geometry().wheel_speed(1, plant.twist());
        close(speed(&plant, 1), way / 1.1, 0.01);
    }
}

/// Counts of wheel 2 under constant duty, and its true angle in counts.
fn counted(name: &str, parameters: &[(&str, f64)], ticks: usize) -> f64 {
    let mut plant = applied(name, parameters).plant().unwrap();
    run(&mut plant, [0.0, 0.4, -0.4], ticks);
    plant.encoder_after()[1]
}

#[test]
fn encoders() {
    let true_counts = |ticks| counted("wheel-skew", &[], ticks);
    close(counted("encoder-scale", &[("scale_2", 0.25)], 800), true_counts(800) * 1.25, 1e-9);
    close(counted("encoder-lag", &[("latency_s", 0.0205)], 800), 0.5 * (true_counts(780) + true_counts(779)), 1e-9);
    // Late by its time constant, of what turns steadily.
    let steady = true_counts(1500) - true_counts(1499);
    close(counted("speed-filter", &[("time_s", 0.02)], 1500), true_counts(1500) - 20.0 * steady, 2e-3);
    close(counted("encoder-loss", &[("loss_2", 0.1), ("threshold_rad_s", 0.0)], 800), 0.9 * true_counts(800), 1e-3);
    close(counted("encoder-loss", &[("loss_2", 0.1), ("threshold_rad_s", 500.0)], 800), true_counts(800), 1e-9);
    // Only what turns faster than the threshold is lost.
    let speed_at = |ticks: usize| (true_counts(ticks + 1) - true_counts(ticks - 1)) / 0.002;
    let threshold = speed_at(300) / Robot::racbot().counts_per_wheel_rad();
    let lossy = counted("encoder-loss", &[("loss_2", 0.1), ("threshold_rad_s", threshold)], 800);
    close(lossy, true_counts(300) + 0.9 * (true_counts(800) - true_counts(300)), 1e-3);
}

#[test]
fn play_is_crossed_when_the_torque_changes_sides() {
    let counts = |play: f64| {
        let mut plant = applied("gear-backlash", &[("play_2_rad", play)]).plant().unwrap();
        run(&mut plant, [0.0, 0.5, -0.5], 300);
        let pushed = plant.encoder_after()[1];
        run(&mut plant, [0.0, -0.5, 0.5], 100);
        (pushed, plant.encoder_after()[1])
    };
    let ((a0, b0), (a1, b1)) = (counts(0.0), counts(0.4));
    let half = 0.2 * Robot::racbot().counts_per_motor_rad();
    close(a1 - a0, half, 1e-6);
    close(b1 - b0, -half, 1e-6);
}

#[test]
fn a_rippled_wheel_rolls_by_its_angle() {
    let (a, b, order) = (0.03, -0.02, 5.0);
    let parameters = [("cos_2", a), ("sin_2", b), ("cos_3", a), ("sin_3", -b), ("order", order)];
    let mut plant = applied("roller-ripple", &parameters).plant().unwrap();
    run(&mut plant, [0.0, 0.3, -0.3], 900);
    // The integral of r(1 + a cos nφ + b sin nφ) over the wheel's turn, on both rear wheels alike.
    let phi = plant.encoder_after()[1] / Robot::racbot().counts_per_wheel_rad();
    let way = phi + (a * (order * phi).sin() - b * ((order * phi).cos() - 1.0)) / order;
    close(plant.pose().y, 0.0275 * way / (3.0_f64.sqrt() / 2.0), 3e-3);
    assert!((way / phi - 1.0).abs() > 1e-4);
}

#[test]
fn a_ripple_found_by_order_analysis_acts_on_its_wheels() {
    let mut robot = robot("roller-ripple", &[("amplitude", 0.02), ("count", 15.0)]);
    robot.effects[0].wheels = vec![3];
    let mut d = Applied::of(&robot).deviations;
    assert_eq!(d.ripple_order, 15.0);
    let ripples: Vec<[f64; 2]> = d.wheels_mut(3).iter().map(|w| w.ripple).collect();
    assert_eq!(ripples, [[0.0, 0.0], [0.0, 0.0], [0.02, 0.0]]);
}

#[test]
fn contact() {
    let slip = applied("wheel-slip", &[("friction_coefficient", 0.3)]).contact;
    assert!(matches!(slip, Contact::Friction { friction_coefficient, .. } if friction_coefficient == 0.3));
    let creep = applied("wheel-creep", &[("creep_s_per_kg", 0.02)]).contact;
    assert!(matches!(creep, Contact::Friction { creep, .. } if creep == Creep::at_rest(0.02)));
    let rolled = applied("wheel-creep", &[("creep_per_n", 0.02)]).contact;
    assert!(matches!(rolled, Contact::Friction { creep, .. } if creep == Creep { s_per_kg: 0.0, per_n: 0.02 }));
}

#[test]
fn camera_and_marker() {
    let pose = Pose::new(1.0, 2.0, std::f64::consts::FRAC_PI_2);
    let image = |name, p: &[(&str, f64)]| applied(name, p).camera.image(pose);
    assert_eq!(image("camera-scale", &[("scale", 0.1)]), Pose::new(1.1, 2.2, pose.theta));
    close(image("marker-heading", &[("angle_rad", 0.1)]).theta, pose.theta + 0.1, 1e-12);
    let offset = image("marker-offset", &[("x_m", 0.01), ("y_m", 0.02)]);
    assert!((offset.x - 0.98).abs() < 1e-12 && (offset.y - 2.01).abs() < 1e-12);
    close(image("lens-distortion", &[("k1_per_m2", 0.01)]).y, 2.0 * 1.05, 1e-12);
    close(applied("camera-latency", &[("latency_s", 0.07)]).camera.latency_s, 0.07, 1e-12);
}

#[test]
fn a_wheel_on_blocks_stands_while_its_rotor_crosses_the_play() {
    let counted = |play: f64, held: f64| {
        let mut hidden = robot("coulomb-friction", &[("torque_nm", 0.004)]);
        hidden.effects.extend(robot("gear-backlash", &[("play_rad", play), ("load_friction_nm", held)]).effects);
        (hidden.support, hidden.wheel_inertia_kg_m2) = (Support::Blocks, 1e-5);
        let mut plant = Applied::of(&hidden).plant().unwrap();
        // Pushed forwards until friction stops it.
        run(&mut plant, [0.06; 3], 300);
        run(&mut plant, [0.02; 3], 300);
        let rests = plant.encoder_after()[0];
        // The friction of the rotor alone lets it turn, that of both does not.
        run(&mut plant, [-0.02; 3], 400);
        (rests - plant.encoder_after()[0]) / Robot::racbot().counts_per_motor_rad()
    };
    assert_eq!(counted(0.0, 0.0), 0.0);
    // When the flanks meet, the rotor takes its wheel along for a little.
    let turned = counted(0.4, 0.004);
    assert!((0.4..0.44).contains(&turned), "{turned}");
    // Where the rotor has all of the friction it stands with its wheel.
    assert_eq!(counted(0.4, 0.0), 0.0);
}
