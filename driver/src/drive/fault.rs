//! Why a drive was ended by the host.

use crate::{BoardError, fault_names};
use std::fmt;
use std::time::Duration;

/// A cause; the outputs are off when somebody reads it.
#[derive(Debug)]
pub enum Fault {
    /// The card switched off by itself.
    Disarmed {
        /// Fault register.
        faults: u32,
        /// What came first.
        first: u32,
        /// Longest time between two commits, which tells a host that slept from a bus that lost words.
        silence: Duration,
    },
    /// No control tick.
    NoTick {
        /// For how long.
        silence: Duration,
    },
    /// The card's clock is not what was measured.
    Clock {
        /// Share of the measured clock.
        ratio: f64,
    },
    /// A word of a snapshot that cannot be.
    Misread {
        /// From 1.
        wheel: usize,
        /// Which word: duty, speed or set point.
        what: &'static str,
    },
    /// The robot no longer comes nearer to where it should go.
    GaveUp {
        /// Set point, from 1.
        point: usize,
        /// Distance by the controller's pose, m.
        distance_m: f64,
    },
    /// The robot does not know where it is, and looking round did not tell.
    Lost {
        /// Standard deviation of the place, m.
        sd_m: f64,
        /// What it has to be below, m.
        limit_m: f64,
    },
    /// A count that no wheel can make.
    CountJump {
        /// From 1.
        wheel: usize,
        /// What the encoder seems to have counted in between.
        counts: i64,
        /// What the motor can do in the time.
        limit: f64,
    },
    /// Driven hard, and the encoder stands still.
    StandsStill {
        /// From 1.
        wheel: usize,
    },
    /// Full drive one way, motion the other.
    Backwards {
        /// From 1.
        wheel: usize,
    },
    /// A speed far from its set point for long.
    DoesNotFollow {
        /// From 1.
        wheel: usize,
        /// Measured, rad/s.
        speed: f64,
        /// Set point, rad/s.
        reference: f64,
    },
    /// Commits with the wrong checksum, one after the other.
    Refused {
        /// How many.
        commits: u32,
    },
    /// The card gave no proper answer.
    Board(BoardError),
}

impl From<BoardError> for Fault {
    fn from(error: BoardError) -> Self {
        Self::Board(error)
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Disarmed { faults, first, silence } => write!(
                f,
                "the card switched off: {}, first {}; the longest time between two commits was {:.1} ms",
                fault_names(*faults),
                fault_names(*first),
                silence.as_secs_f64() * 1e3
            ),
            Self::NoTick { silence } => write!(
                f,
                "no control tick for {:.1} ms; the card's clock stands or its design is gone, load it again",
                silence.as_secs_f64() * 1e3
            ),
            Self::Clock { ratio } => write!(
                f,
                "the card's clock runs at {ratio:.3} of what was measured, so that every speed is wrong by as much; \
                 look at the bus clock, then start again"
            ),
            Self::Misread { wheel, what } => {
                write!(f, "wheel {wheel}: the {what} in the snapshot is beyond what can be; the bus changes reads")
            }
            Self::GaveUp { point, distance_m } => write!(
                f,
                "set point {point}: the robot no longer comes nearer and is {distance_m:.2} m away; look for an \
                 obstacle, a wrong start pose, or a motor or encoder on the wrong axis"
            ),
            Self::Lost { sd_m, limit_m } => write!(
                f,
                "lost: the place is known to {sd_m:.2} m where {limit_m:.2} m are needed, and looking round showed nothing \
                 that tells more; look at the camera, its calibration and the field's sizes, then give the start anew"
            ),
            Self::CountJump { wheel, counts, limit } => write!(
                f,
                "wheel {wheel}: the encoder jumps by {counts} counts where the motor can make {limit:.0}; look for a \
                 disturbed line or a reset counter"
            ),
            Self::StandsStill { wheel } => write!(
                f,
                "wheel {wheel}: driven hard, but the encoder stands still; look for a cut encoder line, a cut motor \
                 line or a blocked wheel"
            ),
            Self::Backwards { wheel } => write!(
                f,
                "wheel {wheel}: turns against full drive; look for swapped encoder lines A and B or a reversed motor"
            ),
            Self::DoesNotFollow { wheel, speed, reference } => write!(
                f,
                "wheel {wheel}: does not follow, {speed:.1} rad/s where {reference:.1} are wanted; look for encoders \
                 or motors swapped between wheels, an empty battery or an obstacle"
            ),
            Self::Refused { commits } => write!(
                f,
                "the card refused {commits} commits in a row by their checksum; the bus loses or changes writes"
            ),
            Self::Board(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for Fault {}
