use super::*;
use crate::robot::EffectParameter;

fn robot(name: &str, parameters: &[(&str, f64)]) -> Robot {
    let parameters = parameters
        .iter()
        .map(|(n, v)| ((*n).to_owned(), EffectParameter { value: *v, ..Default::default() }))
        .collect();
    let effect = Effect { name: name.to_owned(), parameters, ..Effect::default() };
    Robot { effects: vec![effect], ..Robot::racbot() }
}

#[test]
fn parameters_change_what_they_are_about() {
    let skewed = Applied::of(&robot("wheel-skew", &[("skew_2_rad", 0.05)]));
    let nominal = Robot::racbot().layout.wheels();
    let wheels = skewed.robot.layout.wheels();
    assert!((wheels[1].drive_rad - nominal[1].drive_rad + 0.05).abs() < 1e-12);
    assert!((wheels[0].drive_rad - nominal[0].drive_rad).abs() < 1e-12);
    assert!((Applied::of(&robot("robot-mass", &[("scale", 0.1)])).robot.mass_kg - 2.64).abs() < 1e-9);
    assert!((Applied::of(&robot("camera-latency", &[("latency_s", 0.07)])).camera.latency_s - 0.07).abs() < 1e-12);
    let slip = Applied::of(&robot("wheel-slip", &[("friction_coefficient", 0.3)]));
    assert!(matches!(slip.contact, Contact::Friction { friction_coefficient, .. } if friction_coefficient == 0.3));
    let common = Applied::of(&robot("coulomb-friction", &[("torque_nm", 0.0371)]));
    assert!((common.robot.motor.friction_torque - 0.010_15).abs() < 1e-9);
}

#[test]
fn what_cannot_be_simulated_is_said() {
    assert_eq!(Applied::of(&robot("carpet-grain", &[("force_n", 0.5)])).unsupported, ["carpet-grain"]);
    assert!(Applied::of(&robot("marker-offset", &[("x_m", 0.01)])).unsupported.is_empty());
}
