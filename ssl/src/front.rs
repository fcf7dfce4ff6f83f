//! Datagrams to orders, and the answers. The same before simulated robots and before a card.

use crate::Code;
use crate::messages::{
    MoveCommand, MoveWheelVelocity, RobotCommand, RobotControl, RobotControlResponse, RobotFeedback, SimulatorCommand,
    SimulatorError, SimulatorResponse,
};
use crate::pilot::{Kick, Motion, Order, Pilot};
use prost::Message;
use runs::frames::Twist;
use runs::geometry::Geometry;
use std::cell::RefCell;
use std::fmt;
use std::rc::Rc;

/// Robots that one team can have on the field.
pub const TEAM: usize = 16;
/// Errors in one answer: an answer is no larger than a datagram that everybody can receive.
const ERRORS: usize = 16;
/// Numbers beyond this are no velocities of a robot, m/s and rad/s.
const LARGEST: f32 = 1_000.0;
/// Steepest chip kick, degrees.
const STEEPEST: f32 = 75.0;

/// A team: told by the port alone, no message of a robot carries it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Team {
    /// Port 10301.
    Blue,
    /// Port 10302.
    Yellow,
}

impl fmt::Display for Team {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(if *self == Self::Blue { "blue" } else { "yellow" })
    }
}

impl std::str::FromStr for Team {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "blue" => Ok(Self::Blue),
            "yellow" => Ok(Self::Yellow),
            _ => Err(format!("'{text}' is neither blue nor yellow")),
        }
    }
}

/// What a robot has beside its wheels.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct State {
    /// The ball sensor sees the ball.
    pub ball: bool,
    /// Why it is switched off, if it is, and how it is had back.
    pub fault: Option<String>,
    /// Fastest straight and chip kick, m/s; 0 for a kick it does not have.
    pub fastest_kick: [f64; 2],
    /// Whether it has a dribbler.
    pub dribbler: bool,
}

/// What stands behind a front.
pub trait Robots {
    /// What drives robot `id` of `team`, and where it is; `None` where that robot is not on the field.
    fn robot(&mut self, team: Team, id: u32) -> Option<(Rc<RefCell<Pilot>>, State)>;

    /// Does what the control port is asked for; what could not be done.
    fn simulator(&mut self, command: &SimulatorCommand) -> Vec<SimulatorError>;
}

/// Answers a datagram to a team's port.
pub fn control(robots: &mut impl Robots, team: Team, datagram: &[u8]) -> Vec<u8> {
    let mut answer = RobotControlResponse::default();
    match RobotControl::decode(datagram) {
        Err(error) => answer.errors.push(Code::Unreadable.says(format!("no RobotControl: {error}"))),
        Ok(message) => {
            if message.robot_commands.len() > TEAM {
                let what = format!("{} robots in a message; the first {TEAM} are heard", message.robot_commands.len());
                answer.errors.push(Code::TooMany.says(what));
            }
            for command in message.robot_commands.iter().take(TEAM) {
                one(robots, team, command, &mut answer);
            }
        }
    }
    answer.errors.truncate(ERRORS);
    answer.encode_to_vec()
}

/// Answers a datagram to the control port.
pub fn simulator(robots: &mut impl Robots, datagram: &[u8]) -> Vec<u8> {
    let mut errors = match SimulatorCommand::decode(datagram) {
        Err(error) => vec![Code::Unreadable.says(format!("no SimulatorCommand: {error}"))],
        Ok(command) => robots.simulator(&command),
    };
    errors.truncate(ERRORS);
    SimulatorResponse { errors }.encode_to_vec()
}

fn one(robots: &mut impl Robots, team: Team, command: &RobotCommand, answer: &mut RobotControlResponse) {
    let id = command.id;
    let Some((pilot, state)) = robots.robot(team, id) else {
        answer.errors.push(Code::UnknownRobot.says(format!("{team} has no robot {id} on the field")));
        return;
    };
    let mut pilot = pilot.borrow_mut();
    let mut complain = |code: Code, what: String| answer.errors.push(code.says(format!("{team} {id}: {what}")));
    if let Some(fault) = &state.fault {
        complain(Code::RobotFault, fault.clone());
    }
    let mut order = Order::default();
    let mut taken = true;
    if let Some(wanted) = command.move_command.and_then(|it| it.command) {
        match motion(&wanted, pilot.geometry()) {
            Ok(motion) => order.motion = Some(motion),
            Err((code, what)) => {
                complain(code, what);
                taken = false;
            }
        }
    }
    match kick(command, &state) {
        Ok(kick) => order.kick = kick,
        Err((code, what)) => complain(code, what),
    }
    match command.dribbler_speed {
        None => {}
        Some(rpm) if !rpm.is_finite() || rpm < 0.0 => complain(Code::Value, format!("dribbler_speed: {rpm} rpm")),
        Some(rpm) if rpm > 0.0 && !state.dribbler => complain(Code::Dribbler, "it has no dribbler".to_owned()),
        Some(rpm) => order.dribbler_rpm = f64::from(rpm),
    }
    // A motion that cannot be is not replaced by the one before: the robot runs into its time-out.
    if taken {
        pilot.order(order);
    }
    answer.feedback.push(RobotFeedback { id, dribbler_ball_contact: Some(state.ball) });
}

fn motion(wanted: &MoveCommand, geometry: &Geometry) -> Result<Motion, (Code, String)> {
    let numbers = |names: &str, values: &[f32]| -> Result<(), (Code, String)> {
        if values.iter().all(|value| value.abs() <= LARGEST) {
            return Ok(());
        }
        Err((Code::Value, format!("{names}: {values:?} m/s or rad/s is no velocity")))
    };
    match wanted {
        MoveCommand::LocalVelocity(v) => {
            numbers("local_velocity", &[v.forward, v.left, v.angular])?;
            let [forward, left, angular] = [v.forward, v.left, v.angular].map(f64::from);
            Ok(Motion::Local(Twist::new(-left, forward, angular)))
        }
        MoveCommand::GlobalVelocity(v) => {
            numbers("global_velocity", &[v.x, v.y, v.angular])?;
            Ok(Motion::Global([v.x, v.y, v.angular].map(f64::from)))
        }
        MoveCommand::WheelVelocity(v) => {
            numbers("wheel_velocity", &[v.front_right, v.back_right, v.back_left, v.front_left])?;
            let corners = corners(geometry).ok_or_else(|| {
                let what = format!(
                    "wheel_velocity is for four wheels, one in each corner; this robot has {}: send local_velocity",
                    geometry.wheel_count()
                );
                (Code::VelocityType, what)
            })?;
            Ok(Motion::Local(twist_of_wheels(v, corners, geometry)))
        }
    }
}

/// Wheels of a robot that has one in each corner: front right, back right, back left, front left.
pub(crate) fn corners(geometry: &Geometry) -> Option<[usize; 4]> {
    let wheels = geometry.wheels();
    let corner = |right: bool, front: bool| {
        let mut found =
            (0..wheels.len()).filter(|i| (wheels[*i].x_m > 0.0) == right && (wheels[*i].y_m > 0.0) == front);
        found.next().filter(|_| found.next().is_none())
    };
    let four = [corner(true, true)?, corner(true, false)?, corner(false, false)?, corner(false, true)?];
    (wheels.len() == 4).then_some(four)
}

/// The body velocity that four wheels make, by least squares: the part by which they would work against each other is
/// left out. Positive turns the robot counter-clockwise.
fn twist_of_wheels(v: &MoveWheelVelocity, corners: [usize; 4], geometry: &Geometry) -> Twist {
    let mut speeds = [0.0; 4];
    for (wheel, speed) in corners.into_iter().zip([v.front_right, v.back_right, v.back_left, v.front_left]) {
        let at = &geometry.wheels()[wheel];
        let (sin, cos) = at.drive_rad.sin_cos();
        let counter_clockwise = at.x_m * sin - at.y_m * cos;
        speeds[wheel] = f64::from(speed).copysign(f64::from(speed) * counter_clockwise) / geometry.wheel_radius_m();
    }
    geometry.twist(&speeds)
}

fn kick(command: &RobotCommand, state: &State) -> Result<Option<Kick>, (Code, String)> {
    let speed = command.kick_speed.unwrap_or(0.0);
    let angle = command.kick_angle.unwrap_or(0.0);
    if !speed.is_finite() || speed < 0.0 {
        return Err((Code::Value, format!("kick_speed: {speed} m/s")));
    }
    if !(0.0..=STEEPEST).contains(&angle) {
        return Err((Code::AngleValue, format!("kick_angle: {angle} degrees is not between 0 and {STEEPEST}")));
    }
    if speed == 0.0 {
        return Ok(None);
    }
    let most = state.fastest_kick[usize::from(angle > 0.0)];
    if most == 0.0 {
        return Err((Code::AngleValue, format!("kick_angle: {angle} degrees; this kicker kicks straight")));
    }
    if f64::from(speed) > most {
        return Err((Code::KickSpeed, format!("kick_speed: {speed} m/s is more than {most} m/s")));
    }
    Ok(Some(Kick { speed: f64::from(speed), angle: f64::from(angle).to_radians() }))
}
