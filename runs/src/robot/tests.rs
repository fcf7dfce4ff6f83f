use super::*;
use std::path::PathBuf;

fn shipped() -> String {
    std::fs::read_to_string(shipped_path()).unwrap()
}

fn shipped_path() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../data/robot.toml")
}

fn error(text: &str) -> InputError {
    Robot::parse(text, Path::new("robot.toml")).unwrap_err()
}

fn without(line: &str) -> String {
    let kept: Vec<&str> = EXAMPLE.lines().filter(|l| !l.starts_with(line)).collect();
    kept.join("\n")
}

fn with(line: &str, replacement: &str) -> String {
    assert!(EXAMPLE.contains(line));
    EXAMPLE.replace(line, replacement)
}

const EXAMPLE: &str = "\
wheel_radius_m = 0.0275
body_radius_m = 0.085
skew_rad = [0.0, 0.1, 0.0]
mass_kg = 2.4
yaw_inertia_kg_m2 = 0.0095
gear_ratio = 3.71
encoder_counts_per_motor_rev = 2048
supply_v = 7.2
control_rate_hz = 1000
camera_rate_hz = 60
camera_latency_s = 0.02
camera_noise = [0.0015, 0.0015, 0.009]
duty_quantum = 0.001
support = \"blocks\"
[motor]
resistance_ohm = 1.94
torque_constant = 0.00692
back_emf_constant = 0.0070
rotor_inertia = 2.7e-7
friction_torque = 0.00015
[pi]
kp = 0.15
ki = 0.8
arithmetic = \"fixed-kin\"
registers = { kp = 157, ki = -3 }
[[effect]]
name = \"wheel-skew\"
wheels = [1, 2, 3]
runs = [\"run_01\", \"run_02\"]
found = 2026-11-20T10:00:00Z
[effect.parameters]
skew_1_rad = { value = 0.0698, ci95 = [0.069, 0.0705], note = \"ok\" }
\"odd key\" = { value = 1 }
[effect.evidence]
gain = 12.5
[effect.evidence.links]
motion = [1, 2]
";

/// A wheel in front, driving to the right.
fn wheel(y_m: f64) -> String {
    format!("[[wheel]]\nx_m = 0\ny_m = {y_m}\ndrive_rad = 0\n")
}

#[test]
fn files_are_read_as_their_owners_write_them() {
    let read = |text: &str| Robot::parse(text, Path::new("r")).unwrap();
    let of = |line: &str, with_this: &str| read(&with(line, with_this));
    let plain = read(EXAMPLE);
    // Any counts: on the output shaft, not whole, and more than 32 bits.
    let fine = of("encoder_counts_per_motor_rev = 2048", "encoder_counts_per_wheel_rev = 1e9");
    assert!((fine.counts_per_wheel_rad() / (1e9 / TAU) - 1.0).abs() < 1e-12);
    let odd = of("= 2048", "= 43.7");
    assert_eq!(odd.encoder_counts_per_motor_rev, 43.7);
    assert_eq!(Robot::parse(&fine.to_toml(), Path::new("again")).unwrap(), fine);
    // A linear axis of which a radian is a metre: kilograms and newtons.
    assert_eq!(of("rotor_inertia = 2.7e-7", "rotor_inertia = 95").motor.rotor_inertia, 95.0);
    let axis = of("wheel_radius_m = 0.0275", "travel_per_rev_m = 0.02");
    assert!((axis.wheel_radius_m * TAU - 0.02).abs() < 1e-15);
    // Degrees, turns, and skews that nobody wrote.
    assert_eq!(of("skew_rad = [0.0, 0.1, 0.0]", "skew_deg = [0, 365, -720]").layout, {
        let skew_rad = [0.0, 5.0_f64.to_radians(), 0.0];
        let Layout::Rac { skew_rad: read, .. } = of("skew_rad = [0.0, 0.1, 0.0]", "skew_deg = [0, 365, -720]").layout
        else {
            panic!("is the paper's robot")
        };
        assert!(read.iter().zip(skew_rad).all(|(a, b)| (a - b).abs() < 1e-12), "{read:?}");
        Layout::Rac { body_radius_m: 0.085, skew_rad: read }
    });
    assert_eq!(read(&without("skew_rad")).layout, Layout::Rac { body_radius_m: 0.085, skew_rad: [0.0; 3] });
    let turned = without("skew_rad")
        + "\n[[wheel]]\nx_m = 0\ny_m = 0.085\ndrive_deg = 725\n[[wheel]]\nx_m = 0.085\ny_m = 0\ndrive_deg = -90\n\
           [[wheel]]\nx_m = -0.085\ny_m = 0\ndrive_rad = 1.5707963\nroller_deg = 45\n";
    let wheels = read(&turned).layout.wheels();
    assert!((wheels[0].drive_rad - 5.0_f64.to_radians()).abs() < 1e-12);
    assert!((wheels[2].roller_rad - std::f64::consts::FRAC_PI_4).abs() < 1e-12);
    // Both descriptions, where they agree.
    let mut both = Robot { layout: Layout::Wheels(plain.layout.wheels()), ..plain.clone() }.to_toml();
    both = format!("body_radius_m = 0.0851\nskew_deg = [0, 5.73, 0]\n{both}");
    assert_eq!(read(&both).layout.wheels(), plain.layout.wheels());
    assert_eq!(read(&both.replace("5.73", "0")).layout.wheels(), plain.layout.wheels(), "no skew is said");
}

#[test]
fn what_only_some_answers_need_may_be_missing() {
    let little = "wheel_radius_m = 0.03\nencoder_counts_per_wheel_rev = 4096\nbody_radius_m = 0.08\n";
    let robot = Robot::parse_partial(little, Path::new("r")).unwrap();
    assert!(robot.missing.iter().any(|m| m == "motor.resistance_ohm") && robot.missing.iter().any(|m| m == "mass_kg"));
    assert_eq!(robot.lacks(&["encoder_counts_per_motor_rev", "wheel_radius_m", "supply_v"]), ["supply_v"]);
    assert!(robot.no_load_wheel_speed(7.2).is_infinite(), "nothing is known of the motor");
    assert_eq!(Robot::parse_partial(&robot.to_toml(), Path::new("again")).unwrap(), robot, "{}", robot.to_toml());
    let e = error(little);
    assert!(e.field.contains("mass_kg") && e.field.contains("motor.torque_constant"), "all at once: {e}");
    let none = Robot::parse_partial("", Path::new("r")).unwrap();
    assert_eq!(none.lacks(&[WHEELS]), [WHEELS]);
    assert!(error("").what.contains("missing"));
}

#[test]
fn parameters_of_an_effect_are_numbers_or_tables_and_nowhere_else() {
    let with = |effect: &str| Robot::racbot().to_toml() + "\n[[effect]]\nname = \"wheel-radius\"\n" + effect;
    let robot = Robot::parse(&with("[effect.parameters]\nscale_2 = -0.03\n"), Path::new("r")).unwrap();
    assert_eq!(robot.effects[0].value("scale_2"), Some(-0.03));
    let e = error(&with("scale_2 = -0.03\n"));
    assert!(e.field.contains("scale_2") && e.line.is_some() && e.hint.contains("[effect.parameters]"), "{e}");
}

#[test]
fn the_shipped_file_is_the_built_in_robot() {
    assert_eq!(Robot::load(shipped_path()).unwrap(), Robot::racbot());
    let g = Robot::racbot().geometry().unwrap();
    assert_eq!(g.wheel_count(), 3);
    assert!((Robot::racbot().counts_per_wheel_rad() - 2048.0 * 3.71 / TAU).abs() < 1e-9);
}

#[test]
fn every_field_survives_writing_and_reading() {
    let robot = Robot::parse(EXAMPLE, Path::new("robot.toml")).unwrap();
    assert_eq!(robot.camera_noise, Some([0.0015, 0.0015, 0.009]));
    assert_eq!(robot.support, Support::Blocks);
    assert_eq!((robot.gear_efficiency, robot.wheel_inertia_kg_m2), (1.0, 0.0));
    assert_eq!(robot.motor.back_emf(), 0.0070);
    assert_eq!(robot.pi.arithmetic.as_deref(), Some("fixed-kin"));
    assert!(robot.pi.registers.contains(&("ki".to_owned(), -3)));
    let effect = robot.effect("wheel-skew").unwrap();
    assert_eq!(effect.value("skew_1_rad"), Some(0.0698));
    assert_eq!(effect.parameters[0].1.ci95, Some([0.069, 0.0705]));
    assert!(effect.other["evidence"]["links"]["motion"].is_array());
    assert!(effect.other["found"].is_datetime());
    let text = robot.to_toml();
    assert_eq!(Robot::parse(&text, Path::new("again")).unwrap(), robot, "{text}");
}

#[test]
fn wheels_survive_writing_and_reading() {
    let mut robot = Robot::racbot();
    robot.layout = Layout::Wheels(rac_wheels(0.085, [0.1, 0.0, 0.0]));
    let again = Robot::parse(&robot.to_toml(), Path::new("again")).unwrap();
    assert_eq!(again, robot);
    assert_eq!(again.geometry().unwrap(), Geometry::rac(0.0275, 0.085, [0.1, 0.0, 0.0]).unwrap());
}

#[test]
fn byte_order_mark_and_windows_line_ends_are_accepted() {
    let text = format!("\u{feff}{}", shipped().replace('\n', "\r\n"));
    assert_eq!(Robot::parse(&text, Path::new("r")).unwrap(), Robot::racbot());
}

#[test]
fn errors_say_where_what_and_what_to_do() {
    let table: Vec<(String, &str, u32, &str)> = vec![
        (without("supply_v"), "supply_v", 1, "is missing"),
        (without("support").replace("mass_kg = 2.4", ""), "mass_kg", 1, "is missing"),
        (with("rotor_inertia = 2.7e-7", "rotor_inertia = 0"), "motor.rotor_inertia", 15, "is missing"),
        (without("kp ="), "pi.kp", 20, "is missing"),
        (with("mass_kg = 2.4", "mass_kg = -2.4"), "mass_kg", 4, "-2.4 is not positive"),
        (with("mass_kg = 2.4", "mass_kg = nan"), "mass_kg", 4, "not a finite"),
        (with("mass_kg = 2.4", "mass_kg = \"2.4\""), "mass_kg", 4, "no number"),
        (with("supply_v = 7.2", "suply_v = 7.2"), "suply_v", 8, "not a known field"),
        (with("kp = 0.15", "kp = 0.15\nkd = 1"), "pi.kd", 23, "not a known field"),
        (with("[0.0, 0.1, 0.0]", "[0.0, 0.1]"), "skew_rad", 3, "has 2 entries"),
        (with("[0.0, 0.1, 0.0]", "[0.0, inf, 0.0]"), "skew_rad", 3, "not a finite"),
        (with("= 2048", "= -2048"), "encoder_counts_per_motor_rev", 7, "not positive"),
        (
            with("= 2048", "= 2048\nencoder_counts_per_wheel_rev = 9000"),
            "encoder_counts_per_wheel_rev",
            8,
            "contradicts",
        ),
        (without("mass_kg").replace("blocks", "floor").replace("\nki = 0.8", ""), "mass_kg, pi.ki", 1, "are missing"),
        (with("\"blocks\"", "\"bricks\""), "support", 14, "neither"),
        (with("value = 0.0698", "value = \"x\""), "skew_1_rad.value", 33, "no number"),
        (with("name = \"wheel-skew\"", "nam = 1"), "effect.name", 27, "is missing"),
        (format!("{EXAMPLE}{}", wheel(0.1)), "body_radius_m", 2, "wheel 1 stands 0.1000 m from the centre"),
        (format!("{EXAMPLE}{}", wheel(0.085).repeat(3)), "skew_rad", 3, "wheel 2 drives another way"),
        (format!("{EXAMPLE}{}", wheel(0.085)), "skew_rad", 3, "has 3 entries, but there are 1"),
        (format!("{EXAMPLE}[[wheel]]\nx_m = 0"), "wheel.y_m", 38, "is missing"),
        (with("mass_kg = 2.4", "mass_kg = = 2"), "", 4, ""),
        (with("mass_kg = 2.4", "mass_kg = 2.4\nmass_kg = 2.4"), "", 5, "duplicate"),
    ];
    for (text, field, line, what) in table {
        let e = error(&text);
        assert_eq!(e.field, field, "{e}");
        assert!(e.what.contains(what), "{e}");
        assert!(e.line.is_some_and(|l| l.abs_diff(line) <= 1), "line {line} expected: {e}");
        assert!(!e.hint.is_empty() && e.column.is_some(), "{e}");
    }
    assert!(error(&with("supply_v = 7.2", "suply_v = 7.2")).hint.contains("supply_v"));
    assert!(error("").what.contains("missing"));
}

#[test]
fn wheels_that_cannot_drive_are_refused() {
    let text = with("[0.0, 0.1, 0.0]", "[1.5707963267948966, 1.5707963267948966, 1.5707963267948966]");
    assert!(error(&text).what.contains("singular"), "{}", error(&text));
    let mut robot = Robot::racbot();
    robot.layout = Layout::Wheels(rac_wheels(0.085, [0.0; 3])[..2].to_vec());
    assert!(robot.validate(Path::new("r")).unwrap_err().what.contains("one axle"));
    robot = Robot { mass_kg: f64::INFINITY, ..Robot::racbot() };
    assert_eq!(robot.validate(Path::new("r")).unwrap_err().field, "mass_kg");
}

#[test]
fn one_axis_alone_is_a_robot_on_blocks() {
    let text = "wheel_radius_m = 0.02\ngear_ratio = 1\nencoder_counts_per_motor_rev = 4096\nsupply_v = 10\n\
                control_rate_hz = 1000\nsupport = \"blocks\"\nwheel_inertia_kg_m2 = 0.038\n\
                [motor]\nresistance_ohm = 1\ntorque_constant = 0.7\nback_emf_constant = 0\nrotor_inertia = 0\n\
                friction_torque = 0\n[[wheel]]\nx_m = 0\ny_m = 0.1\ndrive_rad = 0\n";
    let robot = Robot::parse(text, Path::new("r")).unwrap();
    assert_eq!((robot.wheel_count(), robot.pi.kp, robot.pi.ki), (1, 0.0, 0.0));
    assert_eq!(robot.geometry().unwrap().twist(&[3.0]), crate::frames::Twist::default());
    assert!(robot.no_load_wheel_speed(10.0).is_infinite());
    assert_eq!(robot.camera_rate_hz, 0.0, "unknown");
    assert_eq!(Robot::parse(&robot.to_toml(), Path::new("again")).unwrap(), robot, "{}", robot.to_toml());
    assert!(error(&text.replace("blocks", "floor")).what.contains("missing"), "the body counts on the floor");

    let three = Robot { support: Support::Blocks, ..Robot::racbot() };
    assert_eq!(three.first_axes(1).layout.wheels(), three.layout.wheels()[..1]);
    assert_eq!(three.first_axes(3), three);
}

#[test]
fn what_is_no_slip_of_a_known_key_is_kept() {
    let text = with("mass_kg = 2.4", "mass_kg = 2.4\nseason = { year = 2005 }");
    let text = text.replace("[motor]", "[motor]\ninductance_h = 4.5e-5");
    let robot = Robot::parse(&text, Path::new("r")).unwrap();
    let kept: Vec<_> = robot.other.iter().map(|(table, key, _)| (table.as_str(), key.as_str())).collect();
    assert_eq!(kept, [("", "season"), ("motor", "inductance_h")]);
    assert_eq!(Robot::parse(&robot.to_toml(), Path::new("again")).unwrap(), robot, "{}", robot.to_toml());
}

#[test]
fn numbers_of_any_size_are_short_to_read_wherever_they_stand() {
    let effect = "\n[[effect]]\nname = \"wheel-radius\"\np_value = 2e-308\nseen = [1e-300, { least = -1e300 }]\n\
                  [effect.parameters]\nscale_2 = { value = 1e-250, resolution = [9e-251, 1.1e-250] }\n";
    let text = with("mass_kg = 2.4", "mass_kg = 2.4\nweakest = { n = 5e-324 }") + effect;
    let robot = Robot::parse(&text, Path::new("r")).unwrap();
    let written = [robot.to_toml(), Robot::edited(&text, &[], Path::new("r")).unwrap()];
    let again = Robot::edited(&written[1], &robot.effects, Path::new("r")).unwrap();
    for text in [&written[0], &again] {
        assert!(text.lines().all(|line| line.len() < 120), "{text}");
        assert_eq!(Robot::parse(text, Path::new("again")).unwrap(), robot, "{text}");
    }
}

#[test]
fn a_missing_file_is_one_clear_error() {
    let e = Robot::load("/nowhere/robot.toml").unwrap_err();
    assert_eq!(e.file, Path::new("/nowhere/robot.toml"));
    assert_eq!(e.hint, "check the path");
}
