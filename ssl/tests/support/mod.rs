//! Fields and messages for the tests.

#![allow(dead_code)] // every test uses some of it

use prost::Message;
use runs::robot::Robot;
use ssl::field::Field;
use ssl::front::{self, Team};
use ssl::messages::{
    MoveCommand, MoveLocalVelocity, RobotCommand, RobotControl, RobotControlResponse, RobotMoveCommand,
    SimulatorCommand, SimulatorControl, SimulatorResponse, TeleportBall, TeleportRobot,
};
use ssl::robot::Kind;
use ssl::world::{Options, World};

/// The example robot with four wheels.
pub(crate) fn four_wheels() -> Robot {
    use runs::robot::Layout;
    let angle = |degrees: f64| degrees.to_radians();
    let wheel = |at: f64| runs::geometry::Wheel {
        x_m: 0.08 * angle(at).cos(),
        y_m: 0.08 * angle(at).sin(),
        drive_rad: angle(at + 90.0),
        roller_rad: 0.0,
    };
    Robot { layout: Layout::Wheels([45.0, 135.0, 225.0, 315.0].map(wheel).to_vec()), ..Robot::racbot() }
}

/// A field with these blue robots.
pub(crate) fn field_of(robots: &[Robot]) -> World {
    let kinds = robots.iter().enumerate();
    World::new(Options {
        field: Field::B,
        robots: kinds.map(|(id, robot)| (Team::Blue, id as u32, Kind::of(robot))).collect(),
        newcomer: Kind::of(&Robot::racbot()),
        vision_hz: 60.0,
        epoch_s: 1_700_000_000.0,
        seed: 1,
    })
    .unwrap()
}

/// A robot's command by local velocity.
pub(crate) fn local(id: u32, forward: f32, left: f32, angular: f32) -> RobotCommand {
    moves(id, MoveCommand::LocalVelocity(MoveLocalVelocity { forward, left, angular }))
}

/// One that neither kicks nor dribbles.
pub(crate) fn moves(id: u32, command: MoveCommand) -> RobotCommand {
    RobotCommand { id, move_command: Some(RobotMoveCommand { command: Some(command) }), ..RobotCommand::default() }
}

/// Sends commands of the blue team and reads the answer.
pub(crate) fn tell(world: &mut World, commands: &[RobotCommand]) -> RobotControlResponse {
    let message = RobotControl { robot_commands: commands.to_vec() };
    RobotControlResponse::decode(&front::control(world, Team::Blue, &message.encode_to_vec())[..]).unwrap()
}

/// Sends a command to the control port and reads the codes of the answer.
pub(crate) fn ask(world: &mut World, command: &SimulatorCommand) -> Vec<String> {
    let answer = front::simulator(world, &command.encode_to_vec());
    SimulatorResponse::decode(&answer[..]).unwrap().errors.into_iter().filter_map(|error| error.code).collect()
}

/// Puts the ball somewhere.
pub(crate) fn ball(world: &mut World, to: TeleportBall) -> Vec<String> {
    let control = SimulatorControl { teleport_ball: Some(to), ..SimulatorControl::default() };
    ask(world, &SimulatorCommand { control: Some(control), config: None })
}

/// Puts a robot somewhere.
pub(crate) fn teleport(world: &mut World, to: TeleportRobot) -> Vec<String> {
    let control = SimulatorControl { teleport_robot: vec![to], ..SimulatorControl::default() };
    ask(world, &SimulatorCommand { control: Some(control), config: None })
}

/// Lets milliseconds pass.
pub(crate) fn pass(world: &mut World, milliseconds: u32) {
    for _ in 0..milliseconds {
        world.step();
    }
}
