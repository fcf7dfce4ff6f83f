//! The supply of which duties and speeds speak.

use nalgebra::{Matrix3, Vector3};
use runs::robot::Robot;
use runs::{drive_lacks, is_from_speeds};

use super::drive::FEWEST;
use super::signals::Signals;
use super::{Mistake, near, short};

/// Share of the squared duties that speed, direction and acceleration of each axis by itself explain, from which they speak
/// of a supply: on a robot whose wheel 3 lost much in its gear, which the others then carried, it was 0.94 of a square's.
const BY_SPEED: f64 = 0.96;
/// Share of the squared speeds that direction and acceleration must leave for that.
const BESIDE: f64 = 0.02;
/// Ratio of supplies from which they are not one robot's: a battery between full and empty has 1.5.
const SUPPLY: f64 = 1.75;
/// The same by what the duties achieve, which loads falsify.
const BY_DUTIES: [f64; 2] = [0.45, 2.2];

/// A supply in another unit, or of another battery.
pub(super) fn against(robot: &Robot, signals: &[Signals]) -> Option<Mistake> {
    if !drive_lacks(robot).is_empty() {
        return None;
    }
    let mut logged: Vec<f64> = signals.iter().flat_map(|s| s.supply.iter().copied()).collect();
    logged.sort_by(f64::total_cmp);
    if let Some(median) = logged.get(logged.len() / 2) {
        let ratio = median / robot.supply_v;
        if near(ratio, 1000.0) {
            let what = format!("the supply is logged as {}: millivolts", short(*median));
            return Some(Mistake::new("supply", "supply_v", what, "write volts (divide by 1000)".to_owned()));
        }
        if !(1.0 / SUPPLY..=SUPPLY).contains(&ratio) {
            let what = format!("the logs have {} V and robot.toml {} V", short(*median), short(robot.supply_v));
            let remedy = format!("write supply_v = {} in robot.toml if the log is right", short(*median));
            return Some(Mistake::new("supply", "supply_v", what, remedy));
        }
    }
    if robot.motor.back_emf() <= 0.0 {
        return None;
    }
    // One battery feeds all motors: friction of one wheel alone is none.
    let supplies = |which: &dyn Fn(usize) -> bool| by_duties(robot, signals, which);
    let volts = supplies(&|_| true)?;
    let axes = signals.iter().map(|s| s.duty.len()).max().unwrap_or(0);
    let other = |volts: f64| {
        let [low, high] = BY_DUTIES.map(|ratio| ratio * robot.supply_v);
        if volts < low { -1 } else { i32::from(volts > high) }
    };
    if other(volts) == 0 || (0..axes).filter_map(|i| supplies(&|j| i == j)).any(|alone| other(alone) != other(volts)) {
        return None;
    }
    let what =
        format!("duties and speeds speak of a supply of about {} V, not of {} V", short(volts), short(robot.supply_v));
    let mut remedy = "check supply_v, back_emf_constant (or torque_constant) and gear_ratio".to_owned();
    if !is_from_speeds(robot) {
        remedy += " and the encoder's counts";
        let ratio = volts / robot.supply_v;
        for (of, decoding) in [(4.0, "four for every line"), (0.25, "lines, if they are not decoded x4")] {
            if near(ratio, of) {
                let counts = short(of * robot.encoder_counts_per_motor_rev);
                remedy += &format!(": with encoder_counts_per_motor_rev = {counts}, {decoding}, all agrees");
            }
        }
    }
    Some(Mistake::new("supply", "supply_v", what, remedy))
}

/// Supply of which duties and speeds of some axes speak, V; `None` where duties do not follow speeds.
pub(super) fn by_duties(robot: &Robot, signals: &[Signals], which: &dyn Fn(usize) -> bool) -> Option<f64> {
    // duty = a·speed + b·direction + c·acceleration: a is back-EMF over supply.
    let (mut normal, mut right, mut n, mut square) = (Matrix3::<f64>::zeros(), Vector3::<f64>::zeros(), 0, 0.0);
    for s in signals {
        for i in (0..s.duty.len()).filter(|i| which(*i)) {
            for k in 0..s.duty[i].len() {
                let (duty, w, a) = (s.duty[i][k], s.speed[i][k], s.acceleration[i][k]);
                if duty.is_finite() && duty.abs() < 0.97 && w.abs() > 1e-6 {
                    let row = Vector3::new(w, w.signum(), a);
                    normal += row * row.transpose();
                    right += row * duty;
                    square += duty * duty;
                    n += 1;
                }
            }
        }
    }
    let inverse = normal.try_inverse()?;
    let solved = inverse * right;
    let explained = solved.dot(&right) / square;
    // At one speed each way it is friction or back-EMF; and a bridge that coasts, or much friction, leaves little of a speed.
    let beside = 1.0 / (inverse[(0, 0)] * normal[(0, 0)]);
    let by_speed = solved.x * (normal[(0, 0)] / n as f64).sqrt();
    let apart = beside >= BESIDE && by_speed >= solved.y.abs();
    let tells = n >= FEWEST && explained >= BY_SPEED && solved.x > 0.0 && apart;
    tells.then(|| robot.gear_ratio * robot.motor.back_emf() / solved.x)
}
