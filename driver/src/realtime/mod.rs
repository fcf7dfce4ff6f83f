//! Real time on Linux: an absolute timer, the rights that keep others away, and how late it all is.

mod clock;
mod latency;
mod rights;
mod signals;
mod timer;

pub use clock::{Clock, MonotonicClock};
pub use latency::{Latency, measure_latency};
pub use rights::{Right, Rights};
pub use signals::stop_on_signals;
pub use timer::{Timer, Wake};
