//! What the motors of `robot.toml` can move, against what the logs show them moving.
//!
//! Data sheets give grams, g cm², mNm and mΩ. A number that was copied without its unit is 10³ to 10⁷ times off, and then
//! what is to be moved needs many times the torque that all motors give when they stall. Duties that were scaled once too
//! often are 100 or 255 times too small for the work that was done.

use runs::robot::{Robot, Support};
use runs::{Columns, DutySource, Log, drive_lacks, is_dead_reckoning};

use super::samples::{MOST_TICKS, Wheels};
use super::{Mistake, short};

/// Length of the stretches whose mean speeds are compared, s, and stretches between two that are.
const SPAN_S: f64 = 0.05;
const APART: usize = 10;
/// Stretches of a log that are looked at.
const MOST: usize = 20_000;
/// Share of the gains of speed that are no more than the one that counts: what is lost or jumps is rarer.
const MOST_GAINS: f64 = 0.99;
/// Fewest gains from which anything is said.
const FEWEST: usize = 20;
/// Times the torque at stall, or the speed without load, from which the motors cannot have done it. One is beyond what they
/// can; a motor twice as strong as its data sheet on a full battery makes no more than this.
const IMPOSSIBLE: f64 = 3.0;
/// The same for the inertia of an axis on blocks, which a weight or a spring may move faster than its motor does: a pendulum
/// that its motor swings up by and by weighs some times what the motor lifts. The least error of a unit is 10³.
pub(super) const IMPOSSIBLE_BESIDE_LOADS: f64 = 10.0;
/// Most that a floor passes on to a robot, m/s²: a coefficient of friction of 1. Wheels that slip gain more.
const GRAVITY: f64 = 9.81;

/// Rank of the torques that the wheels' work asks for, from the least, that counts for duties: pushes and falls are rarer.
const MOST_WORK: f64 = 0.9;

pub(super) fn mistakes(robot: &Robot, logs: &[Log]) -> Vec<Mistake> {
    if is_dead_reckoning(robot) || !drive_lacks(robot).is_empty() {
        return Vec::new();
    }
    let seen: Vec<Gains> = logs.iter().map(|log| Gains::of(robot, log)).collect();
    if !seen.iter().any(|gains| gains.moves) {
        return Vec::new();
    }
    let ranked = |of: fn(&Gains) -> &Vec<f64>, share: f64| {
        let mut all: Vec<f64> = seen.iter().flat_map(|gains| of(gains).iter().copied()).collect();
        if all.len() < FEWEST {
            return 0.0;
        }
        let rank = (share * (all.len() - 1) as f64) as usize;
        *all.select_nth_unstable_by(rank, f64::total_cmp).1
    };
    let at = |of| ranked(of, MOST_GAINS);
    let (torque, emf) = (robot.motor.torque_constant, robot.motor.back_emf());
    if emf > 0.0 && (torque / emf).max(emf / torque) > IMPOSSIBLE {
        let what = format!(
            "{} Nm/A, and back_emf_constant {} V s/rad: in these units both are one number, whatever the motor",
            short(torque),
            short(emf)
        );
        let remedy = "write what the data sheet gives in mNm/A as 0.001 Nm/A, and V per 1000/min as 0.00955 V s/rad";
        return vec![Mistake::new("motor-unit", "motor.torque_constant", what, remedy.to_owned())];
    }
    let (speed, top) = (at(|gains| &gains.speed), robot.no_load_wheel_speed(robot.supply_v));
    if speed > IMPOSSIBLE * top {
        let what = format!("the wheels turn at {} rad/s, and their motors at {} at most", short(speed), short(top));
        let remedy =
            "write torque_constant in Nm/A (1 mNm/A = 0.001), back_emf_constant in V s/rad and supply_v in volts";
        return vec![Mistake::new("motor-unit", "motor.torque_constant", what, remedy.to_owned())];
    }
    // Where currents are logged they are what the motors had, and the file may not tell what they have at stall.
    let amps = logged_amps(robot, logs);
    let stall = robot.motor.torque_constant * amps.unwrap_or(robot.supply_v / robot.motor.resistance_ohm);
    let [gives_at, by] = match amps {
        Some(_) => ["by their greatest current", "torque_constant times the current"],
        None => ["at stall", "torque_constant times supply_v by resistance_ohm"],
    };
    if robot.motor.friction_torque > stall {
        let what = format!(
            "the wheels turn, but motors that give {} Nm {gives_at} ({by}) cannot turn against {} Nm of their own friction",
            short(stall),
            short(robot.motor.friction_torque)
        );
        let units = ["torque_constant in Nm/A and resistance_ohm in ohm", "torque_constant in Nm/A and currents in A"];
        let remedy = format!("write friction_torque in Nm (1 mNm = 0.001), {}", units[usize::from(amps.is_some())]);
        return vec![Mistake::new("motor-unit", "motor.friction_torque", what, remedy)];
    }
    // Each inertia by itself, and the torque of one wheel that moves it.
    let (gear, radius) = (robot.gear_ratio, robot.wheel_radius_m);
    let axis = at(|gains| &gains.axis);
    let mut needs = vec![
        ("motor.rotor_inertia", robot.motor.rotor_inertia, gear * gear * robot.motor.rotor_inertia * axis),
        ("wheel_inertia_kg_m2", robot.wheel_inertia_kg_m2, robot.wheel_inertia_kg_m2 * axis),
    ];
    let geometry = robot.geometry().ok().filter(|_| robot.support == Support::Floor);
    if let Some(geometry) = &geometry {
        let wheels = geometry.wheels();
        let arm = wheels.iter().map(|w| w.x_m.hypot(w.y_m)).fold(f64::MIN_POSITIVE, f64::max);
        let each = radius / wheels.len() as f64;
        let way = at(|gains| &gains.way).min(GRAVITY);
        let turn = at(|gains| &gains.turn).min(GRAVITY / arm);
        needs.push(("mass_kg", robot.mass_kg, robot.mass_kg * way * each));
        needs.push(("yaw_inertia_kg_m2", robot.yaw_inertia_kg_m2, robot.yaw_inertia_kg_m2 * turn / arm * each));
    }
    let gives = gear * stall;
    let impossible = if geometry.is_some() { IMPOSSIBLE } else { IMPOSSIBLE_BESIDE_LOADS };
    needs.retain(|(.., torque)| *torque > impossible * gives);
    if needs.is_empty() {
        return duties(logs, gives, ranked(|gains| &gains.work, MOST_WORK)).into_iter().collect();
    }
    needs
        .into_iter()
        .map(|(key, value, torque)| {
            let what = format!(
                "with {} each wheel needs {} Nm to gain speed as the logs show, {} times what its motor gives {}",
                short(value),
                short(torque),
                short(torque / gives),
                gives_at.replace("their", "its")
            );
            let unit = match key {
                "mass_kg" => "write kilograms (1 g = 0.001)",
                _ => "write kg m² (1 g cm² = 0.0000001, 1 kg cm² = 0.0001)",
            };
            let others = ["resistance_ohm", "the unit of the currents"][usize::from(amps.is_some())];
            let remedy =
                format!("{unit}, if torque_constant, {others} and gear_ratio (motor turns per wheel turn) are right");
            Mistake::new("motor-unit", key, what, remedy)
        })
        .collect()
}

/// Duties that are too small for the torque that the wheels' work needs, Nm; `gives` is what a motor gives a wheel at stall.
fn duties(logs: &[Log], gives: f64, needs: f64) -> Option<Mistake> {
    logs.first().filter(|log| log.layout().source.duties == DutySource::Duties)?;
    let most = greatest(logs);
    if most <= 0.0 || needs <= IMPOSSIBLE_BESIDE_LOADS * most * gives {
        return None;
    }
    let what = format!(
        "no duty is greater than {}, with which a motor gives a wheel {} Nm at most; to gain speed as the logs show it needs \
         {} Nm",
        short(most),
        short(most * gives),
        short(needs)
    );
    let remedy = "log the duty as a share of the supply (1 for all of it): was it scaled twice, as a share that is taken for \
                  percent, or is it a position, a speed or of another motor? If not, check the inertias of robot.toml";
    Some(Mistake::new("duty-unit", "duty_1", what, remedy.to_owned()))
}

/// The greatest duty of any motor.
fn greatest(logs: &[Log]) -> f64 {
    let of = |log: &Log| {
        let part = log.part(0..log.len().min(MOST_TICKS), Columns { duty: true, ..Columns::NONE });
        part.duty.iter().flatten().filter(|d| d.is_finite()).fold(0.0_f64, |most, d| most.max(d.abs()))
    };
    logs.iter().map(of).fold(0.0, f64::max)
}

/// The greatest current of any motor, A, where currents are what drives.
fn logged_amps(robot: &Robot, logs: &[Log]) -> Option<f64> {
    logs.first().filter(|log| log.layout().source.duties == DutySource::Currents)?;
    let duty = greatest(logs);
    (duty > 0.0).then(|| duty * robot.supply_v / robot.motor.resistance_ohm)
}

/// Speeds, and gains of speed over half a second, less what the step of a count makes of one.
#[derive(Default)]
struct Gains {
    /// Mean speeds of wheels, rad/s.
    speed: Vec<f64>,
    /// Of wheels, rad/s².
    axis: Vec<f64>,
    /// Of the platform, m/s² and rad/s².
    way: Vec<f64>,
    turn: Vec<f64>,
    /// Torques of each wheel, Nm, by which the machine of the file takes up the energy that it gains, in the ways that its
    /// wheels turn meanwhile, with its friction: no motor does more at a duty, whatever its speed.
    work: Vec<f64>,
    /// Whether any wheel turned by more than the step of a count.
    moves: bool,
}

impl Gains {
    fn of(robot: &Robot, log: &Log) -> Self {
        let mut out = Self::default();
        let (Some(wheels), Some(tick)) = (Wheels::of(robot, log), log.tick_s()) else { return out };
        let (Some(first), Some(last)) = (wheels.t.first(), wheels.t.last()) else { return out };
        let span = SPAN_S.max(2.0 * tick);
        let number = (((last - first) / span).floor().max(0.0) as usize).min(MOST);
        let speed = |k: usize| -> Option<Vec<f64>> {
            let turned = wheels.turned(first + k as f64 * span, first + (k + 1) as f64 * span)?;
            Some(turned.iter().map(|a| a / span).collect())
        };
        let speeds: Vec<Vec<f64>> = (0..number).map_while(speed).collect();
        let step = 1.0 / robot.counts_per_wheel_rad();
        let apart = APART as f64 * span;
        let geometry = robot.geometry().ok();
        // Energy of wheels that turn by so much less than they seem to.
        let energy = |speeds: &[f64], less: f64| -> f64 {
            let sure: Vec<f64> = speeds.iter().map(|w| w.signum() * (w.abs() - less).max(0.0)).collect();
            let spins = robot.gear_ratio.powi(2) * robot.motor.rotor_inertia + robot.wheel_inertia_kg_m2;
            let wheels: f64 = sure.iter().map(|w| 0.5 * spins * w * w).sum();
            let body = geometry.as_ref().filter(|_| robot.support == Support::Floor).map_or(0.0, |geometry| {
                let twist = geometry.twist(&sure);
                let way = twist.vx.powi(2) + twist.vy.powi(2);
                0.5 * (robot.mass_kg * way + robot.yaw_inertia_kg_m2 * twist.omega.powi(2))
            });
            wheels + body
        };
        let least = 2.0 * step / (span * apart);
        for stretch in speeds.windows(APART + 1) {
            let gained = energy(&stretch[APART], 2.0 * step / span) - energy(&stretch[0], -2.0 * step / span);
            let turned: f64 = stretch.iter().flatten().map(|w| w.abs() * span).sum();
            let lost = robot.gear_ratio * robot.motor.friction_torque;
            out.work.extend((gained > 0.0).then_some(gained / turned + lost));
        }
        out.moves = speeds.iter().flatten().any(|w| w.abs() * span > 2.0 * step);
        out.speed.extend(speeds.iter().flatten().map(|w| (w.abs() - 2.0 * step / span).max(0.0)));
        for (before, after) in speeds.iter().zip(speeds.iter().skip(APART)) {
            let gains: Vec<f64> = before.iter().zip(after).map(|(a, b)| (b - a) / apart).collect();
            let sure: Vec<f64> = gains.iter().map(|g| g.signum() * (g.abs() - least).max(0.0)).collect();
            out.axis.extend(sure.iter().map(|g| g.abs()));
            if let Some(geometry) = &geometry {
                let twist = geometry.twist(&sure);
                out.way.push(twist.vx.hypot(twist.vy));
                out.turn.push(twist.omega.abs());
            }
        }
        out
    }
}
