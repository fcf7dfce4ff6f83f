//! From the control loop to a file: a wait-free ring, and a thread that writes.
//!
//! ```text
//!  control loop ──push──► ring (1 producer, 1 consumer) ──► thread ──► CSV or MCAP
//!     never waits, never allocates              flushes every FLUSH_EVERY
//! ```

mod sample;
mod writer;

pub use sample::{Sample, logged_robot};
pub use writer::{FLUSH_EVERY, RING_SAMPLES, Recorded, Recording, RecordingError};
