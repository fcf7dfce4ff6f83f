//! What duties and currents beside each other say of the motors' winding: V duty = R i + k w, whatever they move.

use estimation::sign_flips::p_value;
use estimation::statistics::t_quantile_975;
use nalgebra::{DVector, Matrix2, Vector2};
use runs::robot::Robot;
use runs::{DutySource, Log, drive_lacks};

use super::samples::FEWEST;
use super::signals::{Signals, signals_late};
use super::{Mistake, is_true, short};

/// Share of the squared volts that the speed alone leaves, which currents may leave of them: else they are not these motors',
/// or a supply's. The controller of an electric bicycle, which measures its motor's current, left 0.004.
const BESIDE_SPEED: f64 = 0.1;
/// Volts that may be left, RMS, in those that were there: an amplifier that drops more has a law of its own. Reasoned; that
/// controller left 0.009.
const LEFT: f64 = 0.03;
/// Amperes per volt, RMS, of one motor's sensor in one log, as a share of the usual ones, below which it reads nothing. A motor
/// without a load took a tenth of what it took at the start of its run; a sensor that was not connected, a hundredth.
const SILENT: f64 = 0.03;
/// Longest time, s, by which currents are looked for after the duties of their row. Reasoned: a loop of speeds is hardly steady
/// beyond it.
const LATEST_S: f64 = 0.1;
/// Stretches of the logs without one of which the law is fitted in turn.
const BLOCKS: usize = 20;

/// Resistance and back-EMF constant of the motors as duties, currents and speeds have them, all motors alike.
#[derive(Debug, Clone, PartialEq)]
pub struct Winding {
    /// Terminal resistance, ohm.
    pub resistance_ohm: f64,
    /// Back-EMF constant at the motor shaft, V s/rad.
    pub back_emf: f64,
    /// Half of their 95 % intervals, by leaving out one stretch of the logs after the other.
    pub half: [f64; 2],
    /// Sums over each stretch.
    blocks: Vec<Sums>,
}

/// Sums of squares and products of currents, speeds and volts.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct Sums {
    normal: Matrix2<f64>,
    right: Vector2<f64>,
    square: f64,
    n: usize,
}

impl Sums {
    fn add(&mut self, row: Vector2<f64>, volts: f64) {
        self.normal += row * row.transpose();
        self.right += row * volts;
        self.square += volts * volts;
        self.n += 1;
    }

    fn without(&self, other: &Self) -> Self {
        Self {
            normal: self.normal - other.normal,
            right: self.right - other.right,
            square: self.square - other.square,
            n: self.n - other.n,
        }
    }

    fn solved(&self) -> Option<Vector2<f64>> {
        Some(self.normal.try_inverse()? * self.right)
    }
}

impl Winding {
    /// Of logs that have both; `None` where the law does not hold, or currents tell too little.
    pub fn of(robot: &Robot, logs: &[Log]) -> Option<Self> {
        if !drive_lacks(robot).is_empty() || robot.motor.back_emf() <= 0.0 {
            return None;
        }
        let both = |log: &&Log| log.layout().source.duties != DutySource::Currents && !log.layout().current.is_empty();
        let logs: Vec<&Log> = logs.iter().filter(both).collect();
        let tick_s = logs.iter().filter_map(|log| log.tick_s()).reduce(f64::min)?;
        let Law { blocks, all, found, left } = Law::of(robot, &logs, 0)?;
        let by_speed = all.square - all.right[1] * all.right[1] / all.normal[(1, 1)];
        let holds = left < BESIDE_SPEED * by_speed && left < LEFT * LEFT * all.square;
        if all.n < FEWEST || blocks.len() < BLOCKS / 2 || !holds || found.min() <= 0.0 {
            return None;
        }
        let jackknife: Vec<Vector2<f64>> = blocks.iter().filter_map(|block| all.without(block).solved()).collect();
        let n = jackknife.len() as f64;
        let mean = jackknife.iter().sum::<Vector2<f64>>() / n;
        let spread = jackknife.iter().map(|x| (x - mean).component_mul(&(x - mean))).sum::<Vector2<f64>>();
        let half = [0, 1].map(|i| t_quantile_975(jackknife.len() - 1) * ((n - 1.0) / n * spread[i]).sqrt());
        // Duties that act later than their rows are said to flow less than they do, as through more ohms: where another lateness
        // leaves less, and says another winding, the logs tell an age and no winding.
        let nearer = |a: Law, b: Law| if b.left * a.all.square < a.left * b.all.square { b } else { a };
        let says_another = |law: &Law| {
            let other = (0..2).any(|i| (law.found[i] - found[i]).abs() > half[i]);
            other && law.left * all.square < left * law.all.square
        };
        let late = latenesses(tick_s).filter_map(|rows| Law::of(robot, &logs, rows)).reduce(nearer);
        if late.is_some_and(|late| says_another(&late)) {
            return None;
        }
        Some(Self { resistance_ohm: found[0], back_emf: found[1], half, blocks })
    }

    /// Two-sided p-value of the difference from a winding of so many ohm and V s/rad, by flipping the signs of stretches.
    pub fn differs(&self, resistance_ohm: f64, back_emf: f64) -> f64 {
        let other = Vector2::new(resistance_ohm, back_emf);
        let score = |block: &Sums| DVector::from_iterator(2, (block.right - block.normal * other).iter().copied());
        p_value(&self.blocks.iter().map(score).collect::<Vec<_>>())
    }

    /// In words.
    pub fn said(&self) -> String {
        format!(
            "duties and currents beside each other say {} ohm and {} V s/rad",
            short(self.resistance_ohm),
            short(self.back_emf)
        )
    }
}

/// Rows from one up to [`LATEST_S`], each some quarter more than the one before.
fn latenesses(tick_s: f64) -> impl Iterator<Item = usize> {
    let most = (LATEST_S / tick_s) as usize;
    std::iter::successors(Some(1), |rows| Some(rows + 1 + rows / 4)).take_while(move |rows| *rows <= most)
}

/// The law of a winding with duties so many rows before their currents.
struct Law {
    blocks: Vec<Sums>,
    all: Sums,
    /// Resistance and back-EMF constant.
    found: Vector2<f64>,
    /// Sum of the squared volts that they leave.
    left: f64,
}

impl Law {
    fn of(robot: &Robot, logs: &[&Log], late: usize) -> Option<Self> {
        let signals: Vec<Signals> = logs.iter().filter_map(|log| signals_late(robot, log, late)).collect();
        let rows = heard(signals.iter().flat_map(|s| rows(robot, s)).collect());
        let blocks: Vec<Sums> = rows
            .chunks(rows.len().div_ceil(BLOCKS).max(1))
            .map(|chunk| {
                let mut sums = Sums::default();
                chunk.iter().for_each(|(row, volts)| sums.add(*row, *volts));
                sums
            })
            .collect();
        let mut all = Sums::default();
        rows.iter().for_each(|(row, volts)| all.add(*row, *volts));
        let found = all.solved()?;
        Some(Self { blocks, all, found, left: all.square - all.right.dot(&found) })
    }
}

/// Current and speed of a motor, and its volts.
type Row = (Vector2<f64>, f64);

/// Rows of each motor while a bridge drives it: one that gives nothing brakes, or lets go.
fn rows(robot: &Robot, s: &Signals) -> Vec<Vec<Row>> {
    let motors = s.duty.iter().zip(&s.current).zip(&s.speed);
    let drives = |(row, volts): &Row| *volts != 0.0 && volts.is_finite() && row.iter().all(|x| x.is_finite());
    let of_motor = |((duty, current), speed): ((&Vec<f64>, &Vec<f64>), &Vec<f64>)| {
        let row = |k: usize| (Vector2::new(current[k], robot.gear_ratio * speed[k]), duty[k] * s.volts[k]);
        (0..s.volts.len()).map(row).filter(drives).collect::<Vec<_>>()
    };
    motors.map(of_motor).collect()
}

/// All rows but those of sensors that read nothing: one of them would break the law of all others.
fn heard(motors: Vec<Vec<Row>>) -> Vec<Row> {
    let per_volt = |rows: &Vec<Row>| {
        let square = |of: fn(&Row) -> f64| rows.iter().map(|row| of(row).powi(2)).sum::<f64>();
        (square(|row| row.0[0]) / square(|row| row.1)).sqrt()
    };
    let mut usual: Vec<f64> = motors.iter().map(per_volt).filter(|x| x.is_finite()).collect();
    usual.sort_by(f64::total_cmp);
    let least = usual.get(usual.len() / 2).map_or(0.0, |usual| SILENT * usual);
    motors.into_iter().filter(|rows| per_volt(rows) >= least).flatten().collect()
}

/// A winding in the file that is another motor's.
pub(super) fn mistakes(robot: &Robot, logs: &[Log]) -> Vec<Mistake> {
    let written = |name: &str| robot.effect(name).is_some();
    if written("winding-resistance") || written("torque-constant") {
        return Vec::new();
    }
    let Some(winding) = Winding::of(robot, logs) else { return Vec::new() };
    let filed = (robot.motor.resistance_ohm, robot.motor.back_emf());
    if is_true(winding.resistance_ohm / filed.0) && is_true(winding.back_emf / filed.1) {
        return Vec::new();
    }
    let what = format!("{}, the file {} and {}", winding.said(), short(filed.0), short(filed.1));
    let remedy = format!(
        "write resistance_ohm = {} and torque_constant = {} if the currents are the motors'",
        short(winding.resistance_ohm),
        short(winding.back_emf)
    );
    let mistake = Mistake::new("motor-winding", "motor.resistance_ohm", what, remedy);
    vec![Mistake { nameable: true, ..mistake }]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows of a motor of 4 ohm and 0.007 V s/rad that runs up, seen by a sensor of so much of its current.
    fn motor(seen: f64) -> Vec<Row> {
        let row = |k: u32| {
            let speed = 500.0 * (1.0 - (-f64::from(k) / 100.0).exp());
            (Vector2::new(seen * (4.0 - 0.007 * speed) / 4.0, speed), 4.0)
        };
        (0..400).map(row).collect()
    }

    #[test]
    fn a_sensor_that_reads_nothing_is_left_aside() {
        let of = |seen: &[f64]| heard(seen.iter().map(|seen| motor(*seen)).collect()).len();
        assert_eq!(of(&[1.0, 1.0, 0.005, 1.0]), 1200);
        assert_eq!(of(&[1.0, 0.0]), 400);
        // A motor that drives next to nothing tells its constant; and of one alone nobody knows what is usual.
        assert_eq!(of(&[1.0, 1.0, 0.1]), 1200);
        assert_eq!(of(&[0.005]), 400);
        let mut all = Sums::default();
        heard([1.0, 0.005, 1.0].map(motor).to_vec()).iter().for_each(|(row, volts)| all.add(*row, *volts));
        let found = all.solved().unwrap();
        assert!((found[0] / 4.0 - 1.0).abs() < 1e-9 && (found[1] / 0.007 - 1.0).abs() < 1e-9, "{found}");
    }
}
