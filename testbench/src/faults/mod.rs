//! What goes wrong on purpose, and what must hold all the same.
//!
//! [`FaultyBus`] wraps any registers; [`Rig`] is a small virtual robot in simulated time whose cables, clock,
//! camera and host can fail; [`campaign`] drives it through thousands of seeded faults. After each of them
//! the robot has driven as commanded, or its outputs are off in the stated time and an error names the cause;
//! and the recording can be read up to its last flush.

mod bus;
pub mod campaign;
mod judge;
mod memory;
mod rig;

pub use bus::{BusFault, FaultyBus, Trouble};
pub use judge::{Outcome, Verdict};
pub use rig::{Cable, Rig, RigFault};
