//! Robots that carry more than their file says, and rub more.

use std::path::Path;

use gap::{Options, analyse};
use model::manoeuvre::Manoeuvre::{Chirp, Spin};
use runs::robot::Robot;

use super::common::{names, simulate, value, with};

/// Four mecanum wheels under 150 kg.
const FILE: &str = "wheel_radius_m = 0.125\nmass_kg = 150\nyaw_inertia_kg_m2 = 25\ngear_ratio = 25\n\
    encoder_counts_per_motor_rev = 4096\ncontrol_rate_hz = 250\nwheel_inertia_kg_m2 = 0.03\nsupply_v = 48\n\
    camera_rate_hz = 100\nduty_quantum = 0.001\n[motor]\nresistance_ohm = 0.16\ntorque_constant = 0.12\n\
    rotor_inertia = 0.0003\nfriction_torque = 0.05\n[pi]\nkp = 0.125\nki = 0.625\n\
    [[wheel]]\nx_m = -0.35\ny_m = 0.4\ndrive_deg = 90\nroller_deg = -45\n\
    [[wheel]]\nx_m = 0.35\ny_m = 0.4\ndrive_deg = 90\nroller_deg = 45\n\
    [[wheel]]\nx_m = -0.35\ny_m = -0.4\ndrive_deg = 90\nroller_deg = 45\n\
    [[wheel]]\nx_m = 0.35\ny_m = -0.4\ndrive_deg = 90\nroller_deg = -45\n";

/// Motors of 20 % less torque and 2.4 times the friction did the same and were tried first; as the one undid most of the other,
/// motors of 10 % more torque were all that was named, four floors from the drive.
#[test]
fn friction_is_named_beside_what_does_not_undo_it() {
    let robot = Robot::parse(FILE, Path::new("robot.toml")).unwrap();
    let hidden: [(&str, &[(&str, f64)]); 3] = [
        ("robot-mass", &[("scale", 0.33)]),
        ("yaw-inertia", &[("scale", 0.33)]),
        ("viscous-friction", &[("coefficient_nms", 5.6)]),
    ];
    let effects = hidden.iter().flat_map(|(name, parameters)| with(&robot, name, parameters).effects);
    let truth = Robot { effects: effects.collect(), ..robot.clone() };
    let a = analyse(&simulate(&truth, &[Spin, Chirp], 91), &Options::default()).unwrap();
    let said = a.terminal_summary();
    assert!(names(&a).contains(&"viscous-friction") && !names(&a).contains(&"torque-constant"), "{said}");
    // Motors that give 23 % less torque for their speed have that share of the friction less, too.
    assert!((value(&a, "coefficient_nms") / 5.6 - 0.9).abs() < 0.2, "{said}");
    let carried = |set: &Vec<String>| set.iter().any(|name| name == "robot-mass");
    assert!(names(&a).contains(&"robot-mass") || a.alternatives.iter().any(carried), "{said}");
}
