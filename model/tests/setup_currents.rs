//! Currents the wrong way round, and such as nobody read, are told.

use model::setup::{Mistake, Winding, mistakes};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use runs::Logs;

const ROBOT: &str = "encoder_counts_per_wheel_rev = 65536\ngear_ratio = 1\nsupport = \"blocks\"\nwheel_radius_m = 1\n\
    wheel_inertia_kg_m2 = 0\n[motor]\ntorque_constant = 0.0066\nrotor_inertia = 7e-6\nfriction_torque = 0\n[[wheel]]\nx_m = 0\n\
    y_m = 0\ndrive_deg = 0\n";

/// A small brushless motor between rest and two speeds, in both ways; its currents are measured. `sign` is that of its log; `idles`
/// switches its drive off in place of braking, and leaves the last reading in the log.
fn told(sign: f64, idles: bool) -> Vec<String> {
    let mut random = ChaCha8Rng::seed_from_u64(7);
    let (mut speed, mut angle, mut amps) = (0.0_f64, 0.0_f64, 0.0);
    let mut rows = "t,enc_1,current_1\n".to_owned();
    for k in 0..3000 {
        let wanted = [0.0, 900.0, 0.0, -900.0, -1700.0, 0.0, 1700.0][k / 35 % 7];
        let off = idles && wanted == 0.0;
        let asked = if off { 0.0 } else { (0.2 * (wanted - speed)).clamp(-12.0, 12.0) };
        if !off {
            amps = asked + 0.3 * random.random_range(-1.0..1.0);
        }
        rows += &format!("{},{},{}\n", 0.011 * k as f64, (angle / std::f64::consts::TAU * 65536.0) as i64, sign * amps);
        for _ in 0..20 {
            let torque = 0.0066 * if off { 0.0 } else { (0.2 * (wanted - speed)).clamp(-12.0, 12.0) };
            let against = 0.003 * (speed / 5.0).tanh() + 8e-6 * speed;
            speed += 0.011 / 20.0 * (torque - against) / 7e-6;
            angle += 0.011 / 20.0 * speed;
        }
    }
    said_of(&rows)
}

fn said_of(rows: &str) -> Vec<String> {
    said_by(ROBOT, rows)
}

fn said_by(robot: &str, rows: &str) -> Vec<String> {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("robot.toml"), robot).unwrap();
    std::fs::write(folder.path().join("run_1.csv"), rows).unwrap();
    mistakes(&Logs::open(folder.path()).unwrap()).iter().map(Mistake::sentence).collect()
}

/// Two thirds of its way go against such a current, and what it goes while it brakes does not.
#[test]
fn currents_the_wrong_way_round_are_told_of_a_motor_that_brakes_as_well() {
    let said = told(-1.0, false);
    assert!(
        said.len() == 1 && said[0].starts_with("current_1: the axis turns the other way than it drives"),
        "{said:?}"
    );
    assert_eq!(told(1.0, false), Vec::<String>::new());
}

/// A winch lifts a load and lets it down again: its currents have one sign throughout, whichever that is, and friction alone tells
/// which way it is driven. `lag` is how many rows the currents are ahead of the counts.
#[test]
fn currents_of_a_winch_the_wrong_way_round_are_told_by_its_friction() {
    let lifted = |sign: f64, rubs: f64, lag: usize| {
        let mut random = ChaCha8Rng::seed_from_u64(7);
        let (mut speed, mut angle) = (0.0_f64, 0.0_f64);
        let (mut counts, mut currents) = (Vec::new(), Vec::new());
        for k in 0..3000 {
            let wanted = [0.0, 6.0, 0.0, -6.0][k / 150 % 4];
            let acceleration = (4.0 * (wanted - speed)).clamp(-20.0, 20.0);
            counts.push((angle / std::f64::consts::TAU * 65536.0) as i64);
            let torque = 0.9 + rubs * (speed / 0.05).tanh() + 0.002 * acceleration;
            currents.push(sign * (torque / 0.0551 + 0.5 * random.random_range(-1.0..1.0)));
            speed += 0.03 * acceleration;
            angle += 0.03 * speed;
        }
        let rows = counts.iter().zip(&currents[lag..]).enumerate();
        let rows: String = rows.map(|(k, (n, i))| format!("{},{n},{i}\n", 0.03 * k as f64)).collect();
        said_by(&ROBOT.replace("0.0066", "0.0551").replace("7e-6", "2e-3"), &format!("t,enc_1,current_1\n{rows}"))
    };
    let said = lifted(-1.0, 0.08, 0);
    assert!(said.len() == 1 && said[0].starts_with("current_1: at the same places the axis is driven"), "{said:?}");
    for (sign, rubs, lag) in [(1.0, 0.08, 0), (1.0, 0.08, 3), (-1.0, 0.0, 0), (-1.0, 0.0, 3)] {
        assert_eq!(lifted(sign, rubs, lag), Vec::<String>::new(), "{sign} {rubs} {lag}");
    }
}

#[test]
fn the_last_reading_of_a_drive_that_is_off_is_told() {
    let said = told(1.0, true);
    assert!(said.len() == 1 && said[0].starts_with("current_1: it stays at "), "{said:?}");
}

/// A loop that was asked for constant currents between sweeps: what gains speed is not off.
#[test]
fn a_current_that_drives_is_no_last_reading() {
    let (mut speed, mut angle) = (0.0_f64, 0.0_f64);
    let mut rows = "t,enc_1,current_1\n".to_owned();
    for k in 0..3000_u32 {
        let t = 0.011 * f64::from(k);
        let amps = match k / 40 % 6 {
            0 => 1.2,
            1 => -1.2,
            _ => 2.0 * (7.0 * t).sin(),
        };
        rows += &format!("{t},{},{amps}\n", (angle / std::f64::consts::TAU * 65536.0) as i64);
        for _ in 0..20 {
            let against = 0.003 * (speed / 5.0).tanh() + 8e-6 * speed;
            speed += 0.011 / 20.0 * (0.0066 * amps - against) / 7e-6;
            angle += 0.011 / 20.0 * speed;
        }
    }
    assert_eq!(said_of(&rows), Vec::<String>::new());
}

/// A sensor that resolves 20 mA, of a motor that now and then turns evenly: there the same is read in many rows.
#[test]
fn what_a_coarse_sensor_reads_of_an_even_drive_is_no_last_reading() {
    let mut random = ChaCha8Rng::seed_from_u64(7);
    let (mut speed, mut angle) = (0.0_f64, 0.0_f64);
    let mut rows = "t,enc_1,current_1\n".to_owned();
    for k in 0..6000_u32 {
        let t = 0.011 * f64::from(k);
        let wanted = if k / 60 % 8 == 0 { 900.0 } else { 600.0 * (7.0 * t).sin() };
        let asked = |speed: f64| (0.2 * (wanted - speed)).clamp(-12.0, 12.0);
        let amps = (50.0 * (asked(speed) + 0.006 * random.random_range(-1.0..1.0))).round() / 50.0;
        rows += &format!("{t},{},{amps}\n", (angle / std::f64::consts::TAU * 65536.0) as i64);
        for _ in 0..20 {
            let against = 0.003 * (speed / 5.0).tanh() + 8e-6 * speed;
            speed += 0.011 / 20.0 * (0.0066 * asked(speed) - against) / 7e-6;
            angle += 0.011 / 20.0 * speed;
        }
    }
    assert_eq!(said_of(&rows), Vec::<String>::new());
}

/// A motor under the duties of the rows, of 1.2 ohm and 0.0066 V s/rad, which act so many rows later; currents as somebody logs
/// them.
fn driven(set: fn(usize) -> f64, late: usize, logged: fn(f64, f64) -> f64) -> String {
    let mut random = ChaCha8Rng::seed_from_u64(9);
    let (mut speed, mut angle) = (0.0_f64, 0.0_f64);
    let mut rows = "t,enc_1,duty_1,current_1\n".to_owned();
    for k in 0..4000_usize {
        let duty = set(k.saturating_sub(late));
        let driven = |speed: f64| (12.0 * duty - 0.0066 * speed) / 1.2;
        let amps = logged(driven(speed), duty) + 0.02 * random.random_range(-1.0..1.0);
        let counts = (angle / std::f64::consts::TAU * 65536.0) as i64;
        rows += &format!("{},{counts},{},{amps}\n", 0.005 * k as f64, set(k));
        for _ in 0..20 {
            let against = 0.003 * (speed / 5.0).tanh() + 8e-6 * speed;
            speed += 0.005 / 20.0 * (0.0066 * driven(speed) - against) / 7e-6;
            angle += 0.005 / 20.0 * speed;
        }
    }
    rows
}

/// A file with such a winding.
fn file_of(ohm: f64, kt: f64) -> String {
    let file = ROBOT.replace("torque_constant = 0.0066", &format!("torque_constant = {kt}\nresistance_ohm = {ohm}"));
    format!("supply_v = 12\n{file}")
}

fn said_of_a_winding(ohm: f64, kt: f64, logged: fn(f64, f64) -> f64) -> Vec<String> {
    let steps = |k: usize| [0.3, 0.8, -0.2, -0.7, 0.5, -0.5][k / 60 % 6];
    said_by(&file_of(ohm, kt), &driven(steps, 0, logged))
}

/// One row was 3 % more resistance, three rows 10 %.
#[test]
fn duties_that_act_later_are_no_other_winding() {
    let waves = |k: usize| 0.5 * (0.02 * k as f64).sin() + 0.3 * (0.0073 * k as f64).cos();
    let tells = |late: usize| {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("robot.toml"), file_of(1.2, 0.0066)).unwrap();
        std::fs::write(folder.path().join("run_1.csv"), driven(waves, late, |amps, _| amps)).unwrap();
        let set = Logs::open(folder.path()).unwrap();
        Winding::of(&set.robot, &set.logs).map(|w| w.resistance_ohm)
    };
    assert!(tells(0).is_some_and(|ohm| (ohm / 1.2 - 1.0).abs() < 0.01));
    for late in [1, 3, 8, 15] {
        assert_eq!(tells(late), None, "{late}");
    }
}

#[test]
fn another_motors_winding_is_told_by_duties_and_currents() {
    let motor: fn(f64, f64) -> f64 = |amps, _| amps;
    assert_eq!(said_of_a_winding(1.2, 0.0066, motor), Vec::<String>::new());
    let said = said_of_a_winding(2.4, 0.0066, motor);
    assert!(said.len() == 1 && said[0].starts_with("motor.resistance_ohm: duties and currents"), "{said:?}");
    let told: f64 = said[0].split("say ").nth(1).unwrap().split(' ').next().unwrap().parse().unwrap();
    assert!((told / 1.2 - 1.0).abs() < 0.05, "{said:?}");
    // A battery's current is the motor's times the duty, and tells of no winding.
    assert_eq!(said_of_a_winding(2.4, 0.0066, |amps, duty| amps * duty), Vec::<String>::new());
}

/// Joints of a driver that fills in efforts which it does not measure.
#[test]
fn efforts_that_are_never_anything_but_0_are_not_logged() {
    let rows = |effort: f64, turns: f64| {
        let mut rows = "t,enc_1,current_1\n".to_owned();
        for k in 0..2000_u32 {
            let t = 0.005 * f64::from(k);
            let angle = turns * 65536.0 * ((1.3 * t).sin() + 0.4 * (3.1 * t).sin());
            rows += &format!("{t},{},{}\n", angle as i64, effort * (2.0 * t).cos());
        }
        said_of(&rows)
    };
    let said = rows(0.0, 0.3);
    assert!(said.len() == 1 && said[0].starts_with("current_1: nothing but 0 in 2000 rows"), "{said:?}");
    let told = |said: &[String]| said.iter().any(|said| said.contains("nothing but 0"));
    assert!(!told(&rows(0.1, 0.3)), "it drives");
    assert!(!told(&rows(0.0, 0.0)), "nothing turns");
}

/// An arm's joint on a sum of sines: its torques are those of the motor, before a gear of 101, and the file takes them for the
/// output's. `coupled` is another joint that moves, which no law of this axis knows.
#[test]
fn torques_of_another_shaft_are_told_by_the_inertia() {
    let said = |share: f64, coupled: f64| {
        let mut random = ChaCha8Rng::seed_from_u64(19);
        let mut rows = "t,enc_1,current_1\n".to_owned();
        for k in 0..20_000_u32 {
            let t = 0.001 * f64::from(k);
            let [mut angle, mut speed, mut gains] = [0.0; 3];
            for (n, size) in [(1.0, 0.3), (2.0, 0.12), (3.0, 0.08), (4.0, 0.05), (5.0, 0.04)] {
                let (w, phase) = (0.314 * n, n * n);
                angle += size * (w * t + phase).sin();
                speed += size * w * (w * t + phase).cos();
                gains -= size * w * w * (w * t + phase).sin();
            }
            let friction = 5.0 * (speed / 0.005).tanh() + 10.0 * speed;
            let torque = 1.7 * gains + friction + coupled * (2.3 * t).sin() + 0.3 * random.random_range(-1.0..1.0);
            rows += &format!("{t},{},{}\n", (angle / std::f64::consts::TAU * 524_288.0) as i64, share * torque);
        }
        let robot = ROBOT.replace("= 65536", "= 524288").replace("= 0.0066", "= 1").replace("= 7e-6", "= 2");
        said_by(&robot, &rows)
    };
    for coupled in [0.0, 0.3] {
        assert_eq!(said(1.0, coupled), Vec::<String>::new());
        let of_the_motor = said(1.0 / 101.0, coupled);
        assert!(
            of_the_motor.len() == 1 && of_the_motor[0].starts_with("motor.rotor_inertia: 2 kg m² at the output shaft"),
            "{of_the_motor:?}"
        );
    }
}
