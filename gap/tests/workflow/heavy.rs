//! Robots that carry more than their file says, and rub more.

use std::f64::consts::TAU;
use std::path::Path;

use gap::{Options, analyse};
use model::manoeuvre::Manoeuvre::{Chirp, Spin};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use runs::Run;
use runs::robot::Robot;

use super::common::{names, of_files, simulate, value, with};

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

/// Two wheels on one axle behind a current controller, by equations of motion of its own.
const CARRIER: &str = "wheel_radius_m = 0.08\nmass_kg = 26\nyaw_inertia_kg_m2 = 1.2\ngear_ratio = 14\n\
    encoder_counts_per_motor_rev = 1024\ncontrol_rate_hz = 100\nwheel_inertia_kg_m2 = 0.003\nsupply_v = 24\n\
    [motor]\nresistance_ohm = 0.4\ntorque_constant = 0.05\nrotor_inertia = 5e-5\nfriction_torque = 0.012\n\
    [[wheel]]\nx_m = -0.2\ny_m = 0\ndrive_deg = 90\nroller_deg = 0\n\
    [[wheel]]\nx_m = 0.2\ny_m = 0\ndrive_deg = 90\nroller_deg = 0\n";

/// A run of it under so many kilograms, whose wheels take so much more dry friction (Nm) as they roll, and viscous (Nm s).
fn carried(mass: f64, [dry, viscous]: [f64; 2], seed: u64) -> Run {
    const STEP: f64 = 1e-4;
    let (radius, half, gear, kt) = (0.08_f64, 0.2_f64, 14.0_f64, 0.05);
    let own = 0.003 + 5e-5 * gear * gear;
    let [along, turning] = [mass / 4.0, 1.2 / (4.0 * half * half)].map(|m| m * radius * radius);
    let [a, b] = [own + along + turning, along - turning];
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut run = Run { name: format!("run_{seed}"), ..Run::default() };
    (run.current, run.counts) = (vec![Vec::new(); 2], vec![Vec::new(); 2]);
    let (mut angle, mut speed, mut asked, mut told, mut until) = ([0.0; 2], [0.0_f64; 2], [0.0; 2], [0.0_f64; 2], 0.5);
    for k in 0..160_000_u32 {
        let t = f64::from(k) * STEP;
        if t > until {
            until += rng.random_range(0.6..2.2);
            let [v, w] = [rng.random_range(-12.0..12.0), rng.random_range(-4.0..4.0)];
            asked = [v - w, v + w];
        }
        for i in 0..2 {
            told[i] += (asked[i] - told[i]).clamp(-12.0 * STEP, 12.0 * STEP);
        }
        let current: [f64; 2] = std::array::from_fn(|i| (1.5 * (told[i] - speed[i])).clamp(-15.0, 15.0));
        if k % 100 == 0 {
            run.t.push(t);
            for i in 0..2 {
                run.current[i].push(current[i] + rng.random_range(-0.03..0.03));
                run.counts[i].push((angle[i] / TAU * 1024.0 * gear).floor() as i64);
            }
        }
        let friction = |w: f64| (0.012 * gear + dry) * (w / 0.02).tanh() + viscous * w;
        let [l, r] = std::array::from_fn(|i| kt * gear * current[i] - friction(speed[i]));
        let accelerations = [a * l - b * r, a * r - b * l].map(|x| x / (a * a - b * b));
        for i in 0..2 {
            speed[i] += STEP * accelerations[i];
            angle[i] += STEP * speed[i];
        }
    }
    run
}

/// Weaker motors whose robot turns more easily than its file has it take in the friction of rolling as well, and were named in
/// place of what it carries.
#[test]
fn a_load_is_no_weaker_motor_beside_less_yaw_inertia() {
    for seed in 1..4 {
        let a = of_files(CARRIER, (0..5).map(|k| carried(1.4 * 26.0, [0.07, 0.01], 10 * seed + k)));
        let said = a.terminal_summary();
        assert_eq!(names(&a), ["robot-mass"], "{seed}: {said}");
        assert!((value(&a, "scale") - 0.4).abs() < 0.02, "{seed}: {said}");
    }
}
