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
