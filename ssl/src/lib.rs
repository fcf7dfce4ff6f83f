//! The small-size league's simulation protocol: team software drives the virtual robots, and the real one, unchanged.
//!
//! ```text
//!  10300 control ─┐                          ┌─► world: robots in the FPGA's arithmetic, ball ─► vision
//!  10301 blue ────┼─► gate ─► front ─► pilot ┤
//!  10302 yellow ──┘    ▲         └ answers   └─► card: the driver's loop
//!                 sockets
//! ```
//!
//! [`front`] makes orders of datagrams and answers of what came of them; it knows robots by the seam [`front::Robots`]
//! only. Behind it stands a [`world`], a state machine that is stepped with simulated time, or the [`card`] of a real
//! robot. [`server`] is the thin shell with sockets and a clock. Every robot is steered by a [`pilot`] and driven by
//! [`driver::drive::Session`], the loop of every drive.
//!
//! ```
//! # #[cfg(feature = "simulation")] {
//! use runs::robot::Robot;
//! use ssl::front::{self, Team};
//! use ssl::messages::{Message, MoveCommand, MoveLocalVelocity, RobotCommand, RobotControl, RobotControlResponse};
//! use ssl::{field::Field, messages::RobotMoveCommand, robot::Kind, world::{Options, World}};
//!
//! let kind = Kind::of(&Robot::racbot());
//! let robots = vec![(Team::Blue, 0, kind.clone())];
//! let options = Options { field: Field::B, robots, newcomer: kind, vision_hz: 60.0, epoch_s: 0.0, seed: 1 };
//! let mut world = World::new(options).expect("the robot fits the card");
//! let ahead = MoveCommand::LocalVelocity(MoveLocalVelocity { forward: 0.3, left: 0.0, angular: 0.0 });
//! let move_command = Some(RobotMoveCommand { command: Some(ahead) });
//! let control = RobotControl { robot_commands: vec![RobotCommand { id: 0, move_command, ..Default::default() }] };
//! let answer = front::control(&mut world, Team::Blue, &control.encode_to_vec());
//! assert!(RobotControlResponse::decode(&answer[..]).expect("it answers").errors.is_empty());
//! let frame = world.next_frame().detection.expect("robots are seen");
//! assert_eq!(frame.robots_blue.len(), 1);
//! # }
//! ```

#[cfg(feature = "simulation")]
pub mod ball;
pub mod card;
mod code;
#[cfg(feature = "simulation")]
pub mod contact;
#[cfg(feature = "simulation")]
pub mod field;
pub mod front;
pub mod gate;
#[cfg(feature = "simulation")]
pub mod meet;
pub mod messages;
pub mod pilot;
mod rest;
#[cfg(feature = "simulation")]
pub mod robot;
pub mod server;
pub mod trigger;
#[cfg(feature = "simulation")]
pub mod world;

pub use code::Code;
