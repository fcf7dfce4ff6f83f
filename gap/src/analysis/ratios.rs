//! Behind measured currents only ratios show: the torque constant, all inertia and all friction times one factor change
//! nothing.

use model::motor::{COPPER_PER_K, MAGNET_PER_K};
use runs::is_from_speeds;
use runs::robot::{Robot, Support};

use super::found::Named;
use super::look_alikes::{Against, LookAlike};
use super::study::Outcome;
use crate::controller::ENCODER_SCALE;
use crate::state::{Active, State};
use links::effect::{Link, Sizes};
use links::effects;
use links::pieces::Pieces;

/// The one that all others are told relative to.
pub(super) const TORQUE_CONSTANT: &str = "torque-constant";
pub(super) const WINDING: &str = "winding-resistance";
const HEATING: &str = "motor-heating";
const ROTOR_INERTIA: &str = "rotor-inertia";
/// Frictions that the factor may change without a name, as long as what a file has of them is small.
pub(super) const FRICTIONS: [&str; 2] = ["coulomb-friction", "viscous-friction"];
const HANGING_LOAD: &str = "hanging-load";
pub(super) const DEAD_BAND: &str = "dead-band";

fn inertias(support: Support) -> &'static [&'static str] {
    match support {
        Support::Blocks => &[ROTOR_INERTIA],
        Support::Floor => &["robot-mass", "yaw-inertia"],
    }
}

fn scale(named: &[Named], name: &str) -> Option<f64> {
    let parameters = &named.iter().find(|n| n.name == name)?.parameters;
    parameters.iter().find(|(p, ..)| p == "scale").map(|(_, value, _)| *value)
}

/// The torque constant where both sides of a ratio are named: their common factor is then chosen by what is not named.
pub(super) fn on_both_sides(named: &[Named], support: Support) -> Option<Against> {
    let inertias = inertias(support);
    // The constant of one motor is no common factor.
    let both =
        scale(named, TORQUE_CONSTANT).is_some() && inertias.iter().all(|name| named.iter().any(|n| n.name == *name));
    both.then(|| Against {
        names: vec![TORQUE_CONSTANT.to_owned()],
        said: format!(
            "Behind currents only ratios show: {TORQUE_CONSTANT} and {} could be named with any common factor. Sizes are those \
             beside the file's torque constant.",
            inertias.join(" and ")
        ),
    })
}

/// A rotor's inertia that is named on an axis with a load stands for both: what both together turn as.
pub(super) fn of_rotor_and_load(named: &[Named], robot: &Robot) -> Option<LookAlike> {
    let file = robot.gear_ratio.powi(2) * robot.motor.rotor_inertia + robot.wheel_inertia_kg_m2;
    if robot.support != Support::Blocks || robot.wheel_inertia_kg_m2 <= 0.0 {
        return None;
    }
    let more = scale(named, ROTOR_INERTIA)?;
    Some(LookAlike::said(format!(
        "{ROTOR_INERTIA} stands for rotor and load: at the output shaft both together turn as {:.3e} kg m², where the file has \
         {file:.3e} ({:+.0} %). Logs of an axis alone do not tell which of {ROTOR_INERTIA} and wheel_inertia_kg_m2 is off.",
        file * (1.0 + more),
        100.0 * more
    )))
}

/// What wrong counts mean that an axis alone shows, and what does the same.
pub(super) fn of_wrong_counts(named: &[Named], robot: &Robot) -> Option<LookAlike> {
    let more = scale(named, ENCODER_SCALE).filter(|_| robot.support == Support::Blocks)?;
    let names = [ENCODER_SCALE, FRICTIONS[1], ROTOR_INERTIA];
    let beside = |name: &&str| named.iter().any(|n| n.name == **name);
    let names: &[&'static str] = if names[1..].iter().any(beside) { &[] } else { &names };
    let is = match is_from_speeds(robot) {
        true => format!("the speeds of the log are {:.3} times those of the shaft", 1.0 + more),
        false => format!("encoder_counts_per_motor_rev = {:.0}", robot.encoder_counts_per_motor_rev * (1.0 + more)),
    };
    let said = format!(
        "{ENCODER_SCALE}, from what the drive does: {is}. Without a look from outside that is known only beside the motor and the \
         inertia of the file, for a viscous friction with an inertia does the same. Turn the shaft by hand and count."
    );
    Some(LookAlike::open(said, names))
}

/// The same of one wheel of several, whose fellows tell it by what they move together.
pub(super) fn of_one_encoder(named: &[Named], robot: &Robot) -> Option<LookAlike> {
    let told = named.iter().find(|n| n.name == ENCODER_SCALE && n.link == Link::Drive)?;
    let [wheel] = told.wheels[..] else { return None };
    let more = told.parameters.iter().find(|(p, ..)| *p == format!("scale_{wheel}"))?.1;
    let is = match is_from_speeds(robot) {
        true => format!("its speeds in the log are {:.3} times those of the wheel", 1.0 + more),
        false => format!("{:.0} counts a turn of that motor", robot.encoder_counts_per_motor_rev * (1.0 + more)),
    };
    Some(LookAlike::said(format!(
        "{ENCODER_SCALE} of wheel {wheel}, from what the drive does: {is}. Turn the wheel by hand and count; the file has one \
         number for all wheels, so that the remedy is at that encoder or in its decoder."
    )))
}

/// What is named of one motor on the drive where the camera has another radius of its wheel that is tied with its counts: these
/// make both, a wheel that is larger and a motor that is off. No motor has a name beside them.
pub(super) fn of_the_same_counts(named: &[Named], seen: &[Named], ties: &[Vec<String>]) -> Option<Against> {
    let radius = seen.iter().find(|n| n.name == RADIUS && n.wheels.len() == 1)?;
    let tied = |set: &Vec<String>| {
        set.first().is_some_and(|first| first == RADIUS) && set.iter().any(|n| COUNTS.contains(&n.as_str()))
    };
    let of_it = |n: &&Named| n.link == Link::Drive && n.wheels == radius.wheels && MOTORS.contains(&n.name.as_str());
    let motor = named.iter().find(of_it)?;
    ties.iter().any(tied).then(|| Against {
        names: MOTORS.map(str::to_owned).to_vec(),
        said: format!(
            "Fitted on the drive link, and not named: {}; counts of that wheel that are others make a radius and a motor of them.",
            motor.name
        ),
    })
}

const RADIUS: &str = "wheel-radius";
const COUNTS: [&str; 2] = [ENCODER_SCALE, "encoder-loss"];
const MOTORS: [&str; 2] = [TORQUE_CONSTANT, WINDING];

/// Windings of more resistance give that much less torque at any speed: so moves a robot with a load that its file lacks, which
/// rubs as much more as it weighs. What has to be put on the scales.
pub(super) fn of_a_load(named: &[Named], robot: &Robot) -> Option<LookAlike> {
    let winding = named.iter().find(|n| n.name == WINDING && n.link == Link::Drive)?;
    let more = scale(named, WINDING).filter(|more| *more > 0.0 && winding.wheels.len() != 1)?;
    let names = inertias(Support::Floor);
    if robot.support != Support::Floor || named.iter().any(|n| names.contains(&n.name.as_str())) {
        return None;
    }
    let inverse = robot.geometry().ok()?.inverse().clone();
    let [across, along] = [0, 1].map(|axis| inverse.column(axis).norm_squared());
    let turns = robot.wheel_inertia_kg_m2 + robot.gear_ratio.powi(2) * robot.motor.rotor_inertia;
    let load = more * (robot.mass_kg + turns * across.max(along));
    let said = format!(
        "A load of {load:.2} kg that the file lacks, and that rubs as much more as it weighs, does what {WINDING} does: weigh the \
         robot."
    );
    Some(LookAlike::beside(said, &[&[WINDING], names].concat()))
}

/// What a caster does that drags: on a differential drive, where it is about as far behind the axle as a wheel is beside the
/// middle, the friction of both wheels by another name.
pub(super) fn of_a_caster(named: &[Named], robot: &Robot) -> Option<LookAlike> {
    let friction = named.iter().find(|n| n.name == FRICTIONS[0] && n.wheels.len() != 1 && n.link == Link::Drive)?;
    let torque = friction.parameters.iter().find(|(p, ..)| p == "torque_nm")?.1;
    let two = robot.support == Support::Floor && robot.geometry().ok()?.is_differential();
    (two && torque > 0.0).then(|| {
        let force = torque * robot.wheel_count() as f64 / robot.wheel_radius_m;
        LookAlike::said(format!(
            "A caster that drags with {force:.2} N about as far from the axle as a wheel is from the middle does what \
             {} of the wheels does here: lift it, or pull the robot with its wheels off the floor.",
            FRICTIONS[0]
        ))
    })
}

/// What a motor that is warm all the time may be as well: warmth is so much more resistance with so much less of the constants, and
/// another motor has both.
pub(super) fn of_warmth(named: &[Named]) -> Option<LookAlike> {
    let warm = named.iter().find(|n| n.name == HEATING)?;
    let kelvin = warm.parameters.iter().find(|(p, ..)| p == "start_k")?.1;
    let [resistance, constant] = [COPPER_PER_K, MAGNET_PER_K].map(|per_k| 100.0 * per_k * kelvin);
    let said = format!(
        "A motor {kelvin:.0} K warmer than its data sheet from the start is one of {resistance:.0} % more resistance and a constant \
         {constant:.0} % smaller: measure the resistance of the winding cold."
    );
    Some(LookAlike::beside(said, &[HEATING, WINDING, TORQUE_CONSTANT]))
}

/// Counts of a turn in those of the file, where a decoder misses edges: one of two, or three of four.
const DECODED: [f64; 2] = [0.5, 0.25];

/// A wheel whose speeds are a part of the true ones shows its back-EMF as so much more braking, and its inertia as so much
/// more: what a viscous friction that is just that may be instead. A camera would have `seen` the counts.
pub(super) fn of_counts(named: &[Named], robot: &Robot, seen: bool) -> Option<LookAlike> {
    let viscous = named.iter().find(|n| n.name == FRICTIONS[1] && n.wheels.len() < 2)?;
    let [low, high] = viscous.parameters.iter().find(|(p, ..)| p.starts_with("coefficient"))?.2.ends()?;
    let motor = &robot.motor;
    let by_itself = robot.gear_ratio.powi(2) * motor.torque_constant * motor.back_emf() / motor.resistance_ohm;
    let told = |part: &&f64| (low..=high).contains(&((1.0 / **part - 1.0) * by_itself));
    let part = DECODED.iter().find(told).filter(|_| !seen && !is_from_speeds(robot))?;
    let counts = part * robot.encoder_counts_per_motor_rev;
    let (of, with) = match viscous.wheels[..] {
        [wheel] => (format!(" of wheel {wheel}"), format!("{counts:.0} counts a turn of that motor")),
        _ => (String::new(), format!("encoder_counts_per_motor_rev = {counts:.0}")),
    };
    let said = format!(
        "The viscous friction{of} is {:.0} times what the back-EMF brakes by itself: an encoder that gives {part} of the counts \
         of the file shows a motor so. Turn the shaft by hand and count: with {with} that is the cause, and what is named with \
         it as well.",
        1.0 / part - 1.0,
    );
    Some(LookAlike::open(said, &[FRICTIONS[1], ENCODER_SCALE]))
}

/// A weight that helps an axis on, where no log turns it the other way: what does the same there. From `turns` of the fastest speed
/// on it turns.
pub(super) fn of_one_way(named: &[Named], pieces: &Pieces, turns: f64) -> Option<LookAlike> {
    let weight = named.iter().find(|n| n.name == HANGING_LOAD)?;
    let [wheel] = weight.wheels[..] else { return None };
    let helps = weight.parameters.first()?.1.signum();
    let speeds = pieces.iter().flat_map(|s| s.speed[wheel - 1].to_vec());
    let [against, with] = speeds.fold([0.0_f64; 2], |[low, high], w| [low.min(helps * w), high.max(helps * w)]);
    let said = format!(
        "{HANGING_LOAD} helps the axis on, which no log turns the other way: a bridge that gives more than its duties say, as a \
         {DEAD_BAND} below 0, does the same there. Drive it both ways."
    );
    (-against <= turns * with).then(|| LookAlike::open(said, &[HANGING_LOAD, DEAD_BAND]))
}

/// Ties a rotor that is named with the torque constant that does the same, or the other way round, where the factor
/// between them asks no friction for more than goes without a name. `start` is the model without what is named.
pub(super) fn tie(outcome: &mut Outcome, start: &State, sizes: &Sizes) {
    let robot = &start.robot;
    let [motor, rotor] = [TORQUE_CONSTANT, ROTOR_INERTIA].map(|name| scale(&outcome.named, name));
    let (own, other, factor) = match (motor, rotor) {
        (Some(s), None) => (TORQUE_CONSTANT, ROTOR_INERTIA, 1.0 / (1.0 + s)),
        (None, Some(s)) => (ROTOR_INERTIA, TORQUE_CONSTANT, 1.0 / (1.0 + s)),
        _ => return,
    };
    if robot.support != Support::Blocks || !FRICTIONS.iter().all(|name| is_free(name, outcome, start, sizes, factor)) {
        return;
    }
    outcome.tie(&[own, other], true);
}

/// Whether a friction may take the factor: it is named anyway, or what the model has of it changes by less than what
/// matters.
fn is_free(name: &str, outcome: &Outcome, start: &State, sizes: &Sizes, factor: f64) -> bool {
    let robot = &start.robot;
    let form = effects::find(name).and_then(|e| e.forms_in(robot, sizes).into_iter().next());
    let Some(parameter) = form.and_then(|f| f.free.into_iter().next()) else { return false };
    let of_motor = if name == FRICTIONS[0] { robot.gear_ratio * robot.motor.friction_torque } else { 0.0 };
    let given = |a: &Active| a.values.0.iter().map(|(_, v)| v.abs()).sum::<f64>();
    let stated: f64 = start.active.iter().filter(|a| a.effect.name() == name).map(given).sum();
    outcome.named.iter().any(|n| n.name == name) || (factor - 1.0).abs() * (of_motor + stated) < parameter.material
}

#[cfg(test)]
mod tests {
    use runs::geometry::Wheel;
    use runs::robot::Layout;

    use super::*;
    use crate::evidence::Interval;

    fn viscous(wheels: &[usize], parameter: &str, [low, high]: [f64; 2]) -> [Named; 1] {
        let known = (parameter.to_owned(), 0.5 * (low + high), Interval::Ci95([low, high]));
        [Named { parameters: vec![known], ..Named::bare(FRICTIONS[1], Link::Drive, wheels) }]
    }

    #[test]
    fn a_radius_that_may_be_counts_and_a_motor_on_one_wheel_are_one_cause() {
        let seen = [Named::bare("wheel-radius", Link::Motion, &[3])];
        let ties = [["wheel-radius", "encoder-scale"].map(str::to_owned).to_vec()];
        let of = |link: Link, wheels: &[usize], ties: &[Vec<String>]| {
            let named = [Named::bare("torque-constant", link, wheels)];
            of_the_same_counts(&named, &seen, ties).map(|against| against.names)
        };
        assert_eq!(of(Link::Drive, &[3], &ties).unwrap(), ["torque-constant", "winding-resistance"]);
        assert_eq!((of(Link::Drive, &[2], &ties), of(Link::Drive, &[], &ties)), (None, None));
        assert_eq!(of(Link::Drive, &[3], &[]), None);
    }

    #[test]
    fn friction_that_is_the_brake_of_the_motor_may_be_lost_counts() {
        let robot = Robot::racbot();
        let motor = &robot.motor;
        let brakes = robot.gear_ratio.powi(2) * motor.torque_constant * motor.back_emf() / motor.resistance_ohm;
        let about = |times: f64| [0.9 * times * brakes, 1.1 * times * brakes];
        let said = |named: &[Named], seen: bool| of_counts(named, &robot, seen).map(|alike| alike.said);
        // Half of the counts: speeds twice as large, which brake once more; a quarter: three times more.
        let half = said(&viscous(&[2], "coefficient_2_nms", about(1.0)), false).unwrap();
        assert!(half.contains("of wheel 2") && half.contains("0.5 of the counts"), "{half}");
        let quarter = said(&viscous(&[], "coefficient_nms", about(3.0)), false).unwrap();
        assert!(!quarter.contains("wheel") && quarter.contains("0.25 of the counts"), "{quarter}");
        let whole = format!("encoder_counts_per_motor_rev = {:.0}", 0.25 * robot.encoder_counts_per_motor_rev);
        assert!(quarter.contains(&whole), "{quarter}");
        // A camera sees the counts; of another size, or of several wheels each its own, it is a friction.
        assert_eq!(said(&viscous(&[2], "coefficient_2_nms", about(1.0)), true), None);
        assert_eq!(said(&viscous(&[], "coefficient_nms", about(1.8)), false), None);
        assert_eq!(said(&viscous(&[1, 2], "coefficient_1_nms", about(1.0)), false), None);
    }

    #[test]
    fn what_may_be_a_load_or_a_caster_is_said() {
        let wheel = |x_m: f64| Wheel { x_m, y_m: 0.0, drive_rad: std::f64::consts::FRAC_PI_2, roller_rad: 0.0 };
        let mut two = Robot { layout: Layout::Wheels(vec![wheel(0.2), wheel(-0.2)]), ..Robot::racbot() };
        two.wheel_radius_m = 0.05;
        (two.wheel_inertia_kg_m2, two.motor.rotor_inertia, two.mass_kg) = (0.005, 0.0, 10.0);
        let named = |name: &str, parameter: &str, value: f64, wheels: &[usize]| {
            let known = (parameter.to_owned(), value, Interval::Exact);
            [Named { parameters: vec![known], ..Named::bare(name, Link::Drive, wheels) }]
        };
        // Ten kilograms and two wheels that turn as two more each: a quarter of that.
        let load = of_a_load(&named(WINDING, "scale", 0.25, &[]), &two).unwrap();
        assert!(load.said.contains("3.50 kg") && load.names == [WINDING, "robot-mass", "yaw-inertia"], "{load:?}");
        // A load takes nothing off, and not off one wheel; on blocks there is none.
        assert!(of_a_load(&named(WINDING, "scale", -0.25, &[]), &two).is_none());
        assert!(of_a_load(&named(WINDING, "scale_1", 0.25, &[1]), &two).is_none());
        let lifted = Robot { support: Support::Blocks, ..two.clone() };
        assert!(of_a_load(&named(WINDING, "scale", 0.25, &[]), &lifted).is_none());

        let warm = of_warmth(&named(HEATING, "start_k", 100.0, &[])).unwrap();
        assert!(warm.said.contains(" 39 % more") && warm.said.contains(" 11 % smaller"), "{warm:?}");
        assert_eq!(warm.names, [HEATING, WINDING, TORQUE_CONSTANT]);
        assert!(of_warmth(&named(HEATING, "rise", 1.0, &[])).is_none());

        let dry = named(FRICTIONS[0], "torque_nm", 0.1, &[]);
        assert!(of_a_caster(&dry, &two).unwrap().said.contains("4.00 N"));
        assert!(of_a_caster(&dry, &Robot::racbot()).is_none() && of_a_caster(&dry, &lifted).is_none());
        assert!(of_a_caster(&named(FRICTIONS[0], "torque_1_nm", 0.1, &[1]), &two).is_none());
    }
}
