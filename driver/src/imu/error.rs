//! What can be wrong with an inertial sensor at start.

use crate::BoardError;

/// A sensor that cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum ImuError {
    /// A transfer to the card failed.
    #[error(transparent)]
    Board(#[from] BoardError),
    /// The design has no reader.
    #[error("the design on the card cannot read an inertial sensor; load one of map version 2.3 or later")]
    NoReader,
    /// A type that nobody knows here.
    #[error("imu.sensor: `{0}` is no known type; choose one of {known}", known = names())]
    Type(String),
    /// Nobody answers.
    #[error(
        "the inertial sensor does not answer: its identification register reads {found:#04x}; look at its supply, at chip \
         select and at the line from the sensor"
    )]
    Absent {
        /// What the line gave.
        found: u8,
    },
    /// Another sensor.
    #[error("imu.sensor says {expected}, but the sensor says {found:#04x}{}; correct robot.toml", .is.map(|name| format!(", which is {name}")).unwrap_or_default())]
    Another {
        /// By `robot.toml`.
        expected: &'static str,
        /// What it says.
        found: u8,
        /// The type that says so, if known.
        is: Option<&'static str>,
    },
    /// A register that does not take its value.
    #[error(
        "register {register:#04x} of the inertial sensor reads {found:#04x} after {written:#04x} was written; the line to the \
         sensor changes bits: shorten it, or slow it down"
    )]
    ReadBack {
        /// Address on the sensor.
        register: u8,
        /// What was written.
        written: u8,
        /// What it reads.
        found: u8,
    },
    /// No data-ready edges.
    #[error("the inertial sensor never says that data are ready; look at the line from its INT1 pin")]
    NotReady,
    /// The same words again and again.
    #[error("the inertial sensor sends the same {0} times over; it hangs: switch it off and on")]
    Frozen(usize),
    /// Gravity is not that of the Earth.
    #[error(
        "at rest the accelerometer shows {measured:.2} m/s² instead of 9.81: its range is not the one that was set, or the \
         robot moves"
    )]
    Range {
        /// Length of the vector of acceleration at rest, m/s².
        measured: f64,
    },
    /// Gravity is not where `axes` says.
    #[error(
        "imu.axes: upwards is the sensor's {found} axis, not its {expected} axis; correct robot.toml, or stand the robot on its wheels"
    )]
    Axes {
        /// By `robot.toml`.
        expected: String,
        /// Nearest axis to upwards.
        found: String,
    },
    /// Mean or scatter of the gyroscope is that of no robot at rest.
    #[error(
        "the robot turns while the gyroscope's bias is measured: {mean_deg_s:.1} °/s, scatter {scatter_deg_s:.1} °/s; keep it \
         still until it is armed"
    )]
    Moving {
        /// Largest mean of an axis.
        mean_deg_s: f64,
        /// Largest standard deviation of an axis.
        scatter_deg_s: f64,
    },
    /// An axis that does not answer its own test.
    #[error(
        "the self-test moves the {triad}'s {axis} axis by {answer:.2} {unit}; the data sheet asks for {least:.2} to {most:.2}: \
         the sensor is broken"
    )]
    SelfTest {
        /// Gyroscope or accelerometer.
        triad: &'static str,
        /// In the body's frame: x, y or z.
        axis: char,
        /// Change of the mean.
        answer: f64,
        /// By the data sheet.
        least: f64,
        /// By the data sheet, or what its range can show.
        most: f64,
        /// Of all three.
        unit: &'static str,
    },
}

fn names() -> String {
    super::KINDS.map(|kind| kind.name).join(", ")
}
