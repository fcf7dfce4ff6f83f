//! Every effect does what its equation says.

mod body;
mod control;
mod drive;
mod wheels;

use super::*;
use runs::frames::{Pose, Twist};
use runs::robot::{EffectParameter, Support};

fn robot(name: &str, parameters: &[(&str, f64)]) -> Robot {
    let parameters = parameters
        .iter()
        .map(|(n, v)| ((*n).to_owned(), EffectParameter { value: *v, ..Default::default() }))
        .collect();
    let effect = Effect { name: name.to_owned(), parameters, ..Effect::default() };
    Robot { effects: vec![effect], ..Robot::racbot() }
}

fn applied(name: &str, parameters: &[(&str, f64)]) -> Applied {
    let applied = Applied::of(&robot(name, parameters));
    assert!(applied.unsupported.is_empty(), "{name}");
    applied
}

/// The same with the wheels off the floor, and gears that lose nothing of what friction takes.
fn lifted(name: &str, parameters: &[(&str, f64)]) -> Plant {
    let mut applied = applied(name, parameters);
    applied.robot.support = Support::Blocks;
    applied.robot.gear_efficiency = 1.0;
    applied.plant().unwrap()
}

/// Without friction, and with motors that neither brake nor weigh: what is left is the body.
fn thrown(name: &str, parameters: &[(&str, f64)], twist: Twist) -> Plant {
    let mut applied = applied(name, parameters);
    applied.robot.gear_efficiency = 1.0;
    applied.robot.motor.friction_torque = 0.0;
    applied.robot.motor.resistance_ohm = 1e6;
    applied.robot.motor.rotor_inertia = 1e-13;
    applied.plant().unwrap().moving(twist)
}

fn run(plant: &mut Plant, duty: [f64; 3], ticks: usize) {
    for _ in 0..ticks {
        plant.step(&duty, 7.2, 0.001);
    }
}

fn speed(plant: &Plant, wheel: usize) -> f64 {
    plant.wheel_speeds().nth(wheel).unwrap()
}

/// Velocity in the world, m/s.
fn velocity(plant: &Plant) -> [f64; 2] {
    let (t, (s, c)) = (plant.twist(), plant.pose().theta.sin_cos());
    [c * t.vx - s * t.vy, s * t.vx + c * t.vy]
}

fn close(found: f64, expected: f64, relative: f64) {
    assert!((found - expected).abs() <= relative * expected.abs(), "{found} instead of {expected}");
}

#[test]
fn what_cannot_be_simulated_is_said() {
    assert_eq!(Applied::of(&robot("my-rub", &[("c", 0.5)])).unsupported, ["my-rub"]);
}

#[test]
fn a_misspelt_parameter_is_found() {
    let pair = |a: &str, b: &str| (a.to_owned(), b.to_owned());
    assert_eq!(
        Applied::unread(&robot("wheel-radius", &[("scale_3", 0.01), ("scal_2", 0.01)])),
        [pair("wheel-radius", "scal_2")]
    );
    assert_eq!(Applied::unread(&robot("wheel-skew", &[("skew_4_rad", 0.01)])), [pair("wheel-skew", "skew_4_rad")]);
    assert_eq!(Applied::unread(&robot("wheel-skew", &[("skew_1_rad", 0.0)])), []);
    assert_eq!(Applied::unread(&robot("my-rub", &[("c", 0.5)])), [], "a user's own");
}
