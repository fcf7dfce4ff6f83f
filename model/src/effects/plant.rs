//! Effects on motors, body and floor.

use super::Applied;
use crate::plant::Contact;
use crate::robot::Effect;

/// Coefficient of friction where only creep is given: more than any wheel uses.
const HELD: f64 = 10.0;
/// Creep where only the friction limit is given, s/kg: stiff against every force that occurs.
const STIFF: f64 = 2e-4;

/// Applies an effect if it is one of these.
pub(super) fn apply(effect: &Effect, applied: &mut Applied) -> bool {
    let robot = &mut applied.robot;
    let value = |name: &str| effect.value(name).unwrap_or(0.0);
    let scale = 1.0 + value("scale");
    match effect.name.as_str() {
        "torque-constant" => {
            let back_emf = robot.motor.back_emf() * scale;
            robot.motor.torque_constant *= scale;
            robot.motor.back_emf_constant = Some(back_emf);
        }
        "robot-mass" => robot.mass_kg *= scale,
        "yaw-inertia" => robot.yaw_inertia_kg_m2 *= scale,
        "rotor-inertia" => robot.motor.rotor_inertia *= scale,
        "gear-efficiency" => robot.gear_efficiency = (robot.gear_efficiency + value("scale")).clamp(0.01, 1.0),
        // One wheel alone is beyond a plant whose motors are all alike.
        "coulomb-friction" if effect.value("torque_nm").is_some() => {
            robot.motor.friction_torque += value("torque_nm") / robot.gear_ratio;
        }
        "battery-sag" if value("resistance_ohm") == 0.0 => robot.supply_v -= value("drop_v"),
        "wheel-creep" => applied.contact = friction(applied.contact, None, Some(value("creep_s_per_kg"))),
        "wheel-slip" => applied.contact = friction(applied.contact, effect.value("friction_coefficient"), None),
        _ => return false,
    }
    true
}

fn friction(contact: Contact, limit: Option<f64>, creep: Option<f64>) -> Contact {
    let (old_limit, old_creep) = match contact {
        Contact::Rolling => (HELD, STIFF),
        Contact::Friction { friction_coefficient, creep_s_per_kg } => (friction_coefficient, creep_s_per_kg),
    };
    Contact::Friction {
        friction_coefficient: limit.unwrap_or(old_limit),
        creep_s_per_kg: creep.filter(|c| *c > 0.0).unwrap_or(old_creep),
    }
}
