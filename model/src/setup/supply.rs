//! The supply of which duties and speeds speak.

use nalgebra::{DMatrix, DVector, Matrix2, Vector2};
use runs::robot::{Robot, Support};
use runs::{drive_lacks, is_from_speeds};

use super::samples::{BOTH_WAYS, FEWEST};
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

/// Largest duty that no limit holds.
pub(super) const WITHIN: f64 = 0.97;
/// Of what stands in a row of the regression, how much is the axis's own: duty, speed, direction.
const OWN: usize = 3;
/// Share of the squares from which a combination of accelerations is none: three ways to move make those of four wheels.
const SINGULAR: f64 = 1e-9;
/// How many times too small duties are that were scaled once too often, and as what.
const SCALED: [(f64, &str); 3] = [
    (100.0, "as of shares that were taken for percent"),
    (2.55, "as of percent that were taken for 0 to 255"),
    (255.0, "as of shares that were taken for 0 to 255"),
];

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
    let ratio = volts / robot.supply_v;
    if let Some((of, taken)) = SCALED.into_iter().find(|(of, _)| near(ratio, *of)) {
        remedy += &format!(", or the unit of the duties: {} times as large, {taken}, all agrees", short(of));
    } else if !is_from_speeds(robot) {
        remedy += " and the encoder's counts";
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
    // Each axis: duty = a·speed + b·direction + what all axes' accelerations take + a load that hangs; a is back-EMF over
    // supply. What is left of duty, speed and direction without the others tells a and b, which all axes share.
    let (mut normal, mut right, mut speeds) = (Matrix2::<f64>::zeros(), Vector2::<f64>::zeros(), 0.0);
    let (mut left, mut square, mut n) = (0.0, 0.0, 0.0);
    let axes = signals.iter().map(|s| s.duty.len()).max().unwrap_or(0);
    for i in (0..axes).filter(|i| which(*i)) {
        let rows = rows(robot, signals, i);
        let Some(first) = rows.first() else { continue };
        let others = first.len() - OWN;
        let mut all = DMatrix::<f64>::zeros(first.len(), first.len());
        rows.iter().for_each(|row| all.ger(1.0, row, row, 1.0));
        let own = all.view((0, 0), (OWN, OWN));
        let across = all.view((0, OWN), (OWN, others));
        let beside = all.view((OWN, OWN), (others, others));
        let inverse = beside.into_owned().pseudo_inverse(SINGULAR * beside.trace()).ok()?;
        let apart = own - across * inverse * across.transpose();
        normal += apart.fixed_view::<2, 2>(1, 1);
        right += apart.fixed_view::<2, 1>(1, 0);
        left += apart[(0, 0)];
        square += own[(0, 0)];
        speeds += own[(1, 1)];
        n += rows.len() as f64;
    }
    let inverse = normal.try_inverse()?;
    let solved = inverse * right;
    let explained = 1.0 - (left - solved.dot(&right)) / square;
    // At one speed each way it is friction or back-EMF; and a bridge that coasts, or much friction, leaves little of a speed.
    let beside = 1.0 / (inverse[(0, 0)] * speeds);
    let by_speed = solved.x * (speeds / n).sqrt();
    let apart = beside >= BESIDE && by_speed >= solved.y.abs();
    let tells = n >= FEWEST as f64 && explained >= BY_SPEED && solved.x > 0.0 && apart;
    tells.then(|| robot.gear_ratio * robot.motor.back_emf() / solved.x)
}

/// Duty, speed and direction of an axis, and the accelerations of all that may take a part of its duty. On blocks they are
/// told from their means, which a load that hangs changes; of an axis that turns one way only it is friction by another name.
fn rows(robot: &Robot, signals: &[Signals], axis: usize) -> Vec<DVector<f64>> {
    let blocks = robot.support == Support::Blocks;
    let of = |s: &Signals, k: usize| {
        let (duty, speed) = (s.duty[axis][k], s.speed[axis][k]);
        let accelerations = s.acceleration.iter().enumerate().filter(|(i, _)| !blocks || *i == axis).map(|(_, a)| a[k]);
        let row: Vec<f64> = [duty, speed, speed.signum()].into_iter().chain(accelerations).collect();
        let tells = row.iter().all(|x| x.is_finite()) && duty.abs() < WITHIN && speed.abs() > 1e-6;
        tells.then(|| DVector::from_vec(row))
    };
    let logs = signals.iter().filter(|s| axis < s.duty.len());
    let mut rows: Vec<DVector<f64>> =
        logs.flat_map(|s| (0..s.duty[axis].len()).filter_map(move |k| of(s, k))).collect();
    let back = rows.iter().filter(|row| row[1] < 0.0).count();
    let both_ways = back.min(rows.len() - back) as f64 >= BOTH_WAYS * rows.len() as f64;
    if blocks
        && both_ways
        && let Some(first) = rows.first()
    {
        let mean = rows.iter().fold(DVector::zeros(first.len()), |sum, row| sum + row) / rows.len() as f64;
        rows.iter_mut().for_each(|row| *row -= &mean);
    }
    rows
}
