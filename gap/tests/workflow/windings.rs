//! A hub motor whose controller logs duty and motor current: these say what its winding is, whatever it moves.

use gap::{Analysis, Interval};
use links::effect::Link;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use runs::Run;

use super::common::{names, of_files};

/// Torque constant, Nm/A, and resistance, ohm.
const KT: f64 = 1.06;
const OHM: f64 = 0.15;
/// What a rider on a bicycle moves, kg m² at the wheel, and what road and air take, Nm and Nm s².
const INERTIA: f64 = 11.7;
const ROAD_NM: f64 = 3.0;
const AIR_NMS2: f64 = 0.007;
const SUPPLY_V: f64 = 53.0;
const ROW_S: f64 = 0.05;

/// What is said of rides with a throttle by a file with this resistance, constant and inertia.
fn ridden(ohm: f64, kt: f64, inertia: f64) -> Analysis {
    by(&format!(
        "gear_ratio = 1\nsupply_v = {SUPPLY_V}\nsupport = \"blocks\"\nwheel_radius_m = 0.28\n[motor]\nresistance_ohm = {ohm}\n\
         torque_constant = {kt}\nrotor_inertia = {inertia}\nfriction_torque = 0\n[[wheel]]\nx_m = 0\ny_m = 0\ndrive_deg = 0\n"
    ))
}

/// The same by the text of a file.
fn by(text: &str) -> Analysis {
    let run = |seed| {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let mut noise = move |size: f64| size * rng.random_range(-1.0..1.0);
        let mut run = Run { name: format!("run_{seed}"), ..Run::default() };
        let (mut speed, mut current, mut asked) = (2.0_f64, 0.0, 0.0);
        let (mut duties, mut currents, mut speeds, mut volts) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        for k in 0..1200_u32 {
            if k % 80 == 0 {
                asked = [30.0, 55.0, 4.0, 40.0, 8.0][(k / 80 % 5) as usize] * (1.0 + noise(0.2));
            }
            let supply = SUPPLY_V - 0.001 * current;
            let duty = (1000.0 * f64::clamp((asked * OHM + KT * speed) / supply, 0.0, 0.95)).round() / 1000.0;
            let driven = |speed: f64| (duty * supply - KT * speed) / OHM;
            run.t.push(f64::from(k) * ROW_S);
            duties.push(duty);
            currents.push(driven(speed) + noise(0.3));
            speeds.push(speed + noise(0.02));
            volts.push(supply);
            for _ in 0..50 {
                current = driven(speed);
                speed += ROW_S / 50.0 * (KT * current - ROAD_NM - AIR_NMS2 * speed * speed) / INERTIA;
            }
        }
        (run.duty, run.current, run.speed, run.supply_v) = (vec![duties], vec![currents], vec![speeds], Some(volts));
        run
    };
    of_files(text, (0..3).map(|k| run(60 + k)))
}

/// The size of an effect of one parameter, if its interval holds the truth.
fn held(a: &Analysis, name: &str, truth: f64) -> bool {
    let effect = a.effects.iter().find(|e| e.name == name);
    let held = |interval: Interval| interval.ends().is_some_and(|[low, high]| low < truth && truth < high);
    effect.is_some_and(|e| held(e.parameters[0].2))
}

#[test]
fn currents_beside_duties_tell_the_winding() {
    let motor = ["winding-resistance", "torque-constant"];
    let right = ridden(OHM, KT, INERTIA);
    assert!(!names(&right).iter().any(|n| motor.contains(n)), "{}", right.terminal_summary());
    // By the motion alone twice the resistance was half the inertia.
    let a = ridden(2.0 * OHM, KT, INERTIA);
    assert!(held(&a, "winding-resistance", -0.5), "{}", a.terminal_summary());
    assert!(
        !names(&a).contains(&"rotor-inertia") && !names(&a).contains(&"torque-constant"),
        "{}",
        a.terminal_summary()
    );
    let a = ridden(OHM / 1.5, KT / 1.09, INERTIA / 1.46);
    let others = [("winding-resistance", 0.5), ("torque-constant", 0.09), ("rotor-inertia", 0.46)];
    assert!(others.iter().all(|(name, truth)| held(&a, name, *truth)), "{}", a.terminal_summary());
    // Read again with the file that was written, the drive agrees from where it ended.
    let again = by(&a.robot_text);
    assert!(again.effects.is_empty(), "{}", again.terminal_summary());
    let drive = |a: &Analysis| a.links.iter().find(|l| l.link == Link::Drive).map(|l| (l.before, l.after));
    let (Some((before, _)), Some((_, after))) = (drive(&again), drive(&a)) else { panic!("no drive") };
    assert!((before / after - 1.0).abs() < 0.02, "{before} {after}");
}
