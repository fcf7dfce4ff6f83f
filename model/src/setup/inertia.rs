//! An inertia that the currents of an axis on blocks do not know.

use nalgebra::{DMatrix, DVector};
use runs::robot::{Robot, Support};
use runs::{DutySource, Log, drive_lacks, is_dead_reckoning};

use super::motors::IMPOSSIBLE_BESIDE_LOADS;
use super::samples::FEWEST;
use super::signals::{Signals, signals};
use super::{Mistake, short};

/// Standard deviations of chance that torque and acceleration must go together by.
const TOGETHER: f64 = 5.0;

/// What an axis does beside its loads and frictions: squares of torques and accelerations, their product, and rows.
#[derive(Default)]
struct Beside {
    torque: f64,
    acceleration: f64,
    both: f64,
    rows: usize,
}

impl Beside {
    fn add(&mut self, robot: &Robot, signals: &Signals) {
        let ([speed], [acceleration], [current]) =
            (&signals.speed[..], &signals.acceleration[..], &signals.current[..])
        else {
            return;
        };
        let angles = speed.iter().scan(0.0, |angle, w| {
            *angle += w * signals.span_s;
            Some(*angle)
        });
        // Where it turns about, friction is of neither direction.
        let turns = |acceleration: f64| (acceleration.abs() * signals.span_s).max(1e-6);
        let shaft = robot.gear_ratio * robot.motor.torque_constant;
        let all = angles.zip(speed).zip(acceleration.iter().zip(current));
        let rows: Vec<([f64; 2], f64, f64)> = all
            .filter(|((_, w), (a, i))| w.abs() > turns(**a) && a.is_finite() && i.is_finite())
            .map(|((angle, w), (a, i))| ([angle, *w], *a, shaft * i))
            .collect();
        if rows.len() < FEWEST {
            return;
        }
        let middle = rows.iter().map(|([angle, _], ..)| angle).sum::<f64>() / rows.len() as f64;
        let law = rows.iter().flat_map(|([angle, w], ..)| {
            let angle = angle - middle;
            [1.0, *w, w.signum(), angle.sin(), angle.cos(), angle, angle * angle]
        });
        let laws = DMatrix::from_row_iterator(rows.len(), 7, law).qr().q();
        let left = |of: DVector<f64>| &of - &laws * laws.tr_mul(&of);
        let torque = left(DVector::from_iterator(rows.len(), rows.iter().map(|row| row.2)));
        let acceleration = left(DVector::from_iterator(rows.len(), rows.iter().map(|row| row.1)));
        self.torque += torque.norm_squared();
        self.acceleration += acceleration.norm_squared();
        self.both += torque.dot(&acceleration);
        self.rows += rows.len();
    }

    /// The most that turns, kg m² at the output shaft: of what is left of the torques all goes with the accelerations.
    fn most(&self) -> Option<f64> {
        let together = self.both / (self.torque * self.acceleration).sqrt();
        (together * (self.rows as f64).sqrt() >= TOGETHER).then(|| self.torque / self.both)
    }
}

/// Torques of another shaft or in another unit are off by a gear ratio or a factor of ten and more. Whatever noise is in
/// them, and rubs, hangs or pulls, they allow a true file at least the inertia that it has: of 35 recordings of others 0.0 to
/// 1.0 of it turn.
pub(super) fn mistakes(robot: &Robot, logs: &[Log]) -> Vec<Mistake> {
    let currents = logs.first().is_some_and(|log| log.layout().source.duties == DutySource::Currents);
    if !currents || robot.support != Support::Blocks || is_dead_reckoning(robot) || !drive_lacks(robot).is_empty() {
        return Vec::new();
    }
    let mut beside = Beside::default();
    logs.iter().filter_map(|log| signals(robot, log)).for_each(|signals| beside.add(robot, &signals));
    let rotor = robot.gear_ratio.powi(2) * robot.motor.rotor_inertia;
    let turns = rotor + robot.wheel_inertia_kg_m2;
    let Some(most) = beside.most().filter(|most| turns > IMPOSSIBLE_BESIDE_LOADS * most) else { return Vec::new() };
    let key = if rotor > robot.wheel_inertia_kg_m2 { "motor.rotor_inertia" } else { "wheel_inertia_kg_m2" };
    let what = format!(
        "{} kg m² at the output shaft in all, but currents and accelerations speak of {} at most, whatever rubs, hangs or pulls",
        short(turns),
        short(most)
    );
    let remedy = "write kg m²; torques of the motor's shaft want its gear_ratio (motor turns per turn of the output), torques at \
                  the output gear_ratio = 1, and currents in A the motor's torque_constant";
    vec![Mistake::new("motor-unit", key, what, remedy.to_owned())]
}
