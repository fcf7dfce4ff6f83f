//! `racbot radio`

use crate::terminal::{Answer, Failure, Target, positive};
use clap::Args;
use driver::radio::{BaseStation, HexLine, Line, RadioError, Sent, SerialLine};
use driver::realtime::{Clock, MonotonicClock, stop_on_signals};
use driver::{Scale, Settings};
use runs::Run;
use runs::frames::Twist;
use runs::robot::Robot;
use serde_json::json;
use std::path::{Path, PathBuf};
use std::str::FromStr;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

/// Options of `radio`.
#[derive(Args, Debug)]
pub(crate) struct Options {
    /// Number of the robot, 0 to 15, as its straps say
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(0..=15))]
    number: u8,

    /// Serial port of the radio module, such as /dev/ttyUSB0; the robot moves
    #[arg(long, value_name = "DEVICE", required_unless_present = "out")]
    line: Option<PathBuf>,

    /// File for the frames as text, instead: time in seconds, bytes in hexadecimal
    #[arg(long, value_name = "FILE", conflicts_with = "line")]
    out: Option<PathBuf>,

    #[command(flatten)]
    target: Target,

    /// Body velocity in m/s, m/s and rad/s: right, forward, anticlockwise
    #[arg(long, value_name = "X,Y,OMEGA", allow_hyphen_values = true, requires = "seconds")]
    #[arg(required_unless_present = "commands")]
    velocity: Option<Velocity>,

    /// How long, in seconds
    #[arg(long, value_name = "S")]
    seconds: Option<f64>,

    /// A log whose commands (cmd_vx, cmd_vy, cmd_w) the robot is to follow, instead of one velocity
    #[arg(long, value_name = "RUN", conflicts_with_all = ["velocity", "seconds"])]
    commands: Option<PathBuf>,

    /// The robot [default: the paper's]
    #[arg(long, value_name = "FILE")]
    robot: Option<PathBuf>,

    /// Clock that the robot's board feeds to LCLK, in hertz
    #[arg(long, value_name = "HZ", default_value_t = 33_333_333.0)]
    clock_hz: f64,
}

/// A body velocity on the command line.
#[derive(Clone, Copy, Debug)]
struct Velocity(Twist);

impl FromStr for Velocity {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parts: Option<Vec<f64>> =
            text.split(',').map(|part| part.trim().parse().ok().filter(|x: &f64| x.is_finite())).collect();
        match parts.as_deref() {
            Some(&[vx, vy, omega]) => Ok(Self(Twist { vx, vy, omega })),
            _ => Err(format!("'{text}' is no velocity: three numbers, m/s, m/s and rad/s, with commas between them")),
        }
    }
}

/// Longest drive, s.
const LONGEST: f64 = 3600.0;

impl Options {
    pub(crate) fn run(&self) -> Result<Answer, Failure> {
        let seconds = self.seconds.unwrap_or(0.0);
        if self.velocity.is_some() {
            positive("--seconds", seconds, LONGEST)?;
        }
        if !(1e6..=1e8).contains(&self.clock_hz) {
            return Err(Failure::usage(format!("--clock-hz: {} is not between 1e6 and 1e8", self.clock_hz)));
        }
        if let Some(out) = &self.out {
            Target::check_apart([&self.commands, &self.robot].into_iter().flatten(), [out])?;
        }
        let robot = super::driven::robot(self.robot.as_deref())?;
        let velocity = self.velocity(seconds, &robot)?;
        let about = |error: &dyn std::fmt::Display| match &self.robot {
            Some(file) => Failure::about(file, error),
            None => Failure::data(error),
        };
        let scale = Scale::new(&robot, self.clock_hz).map_err(|error| about(&error))?;
        let stop = stop_on_signals().map_err(Failure::data)?;
        let (to, sent) = match (&self.line, &self.out) {
            (Some(device), _) => {
                let line = SerialLine::open(device).map_err(|error| Failure::about(device, error))?;
                (device, self.send(device, line, &mut MonotonicClock, scale, velocity, &stop)?)
            }
            (None, Some(file)) => {
                let mut text = Vec::new();
                let sent = self.send(file, HexLine(&mut text), &mut NoTime::default(), scale, velocity, &stop)?;
                self.target.save(file, &text)?;
                (file, sent)
            }
            (None, None) => unreachable!("the command line asks for one of them"),
        };
        let Sent { boots, velocities, stopped } = sent;
        let early = if stopped { ", stopped early" } else { "" };
        let text = format!(
            "robot    {}\nline     {}\nsent     {boots} boot frames, {velocities} velocities{early}; switched off\n",
            self.number,
            to.display()
        );
        let json = json!({
            "robot": self.number, "line": to.to_string_lossy(), "boots": boots, "velocities": velocities, "stopped": stopped,
        });
        Ok(Answer { text, json, wrong: None })
    }

    fn send<L: Line, C: Clock>(
        &self,
        to: &Path,
        line: L,
        clock: &mut C,
        scale: Scale,
        velocity: impl Fn(f64) -> Option<Twist>,
        stop: &AtomicBool,
    ) -> Result<Sent, Failure> {
        let mut station = BaseStation::new(line, self.number, 0, scale, Settings::default());
        station.drive(clock, velocity, stop).map_err(|error| match error {
            RadioError::Line(error) => Failure::about(to, error),
            other => Failure::data(other),
        })
    }

    /// The wanted velocity over time, s.
    fn velocity(&self, seconds: f64, robot: &Robot) -> Result<Box<dyn Fn(f64) -> Option<Twist>>, Failure> {
        let too_fast = too_fast(robot)?;
        if let Some(Velocity(twist)) = self.velocity {
            if let Some(why) = too_fast(twist) {
                return Err(Failure::usage(format!("--velocity: {why}")));
            }
            return Ok(Box::new(move |t| (t < seconds).then_some(twist)));
        }
        let file = self.commands.as_ref().expect("the command line asks for it where there is no velocity");
        let run = Run::read(file)?;
        let Some([vx, vy, omega]) = run.command else {
            return Err(Failure::about(file, "it has no commands: log cmd_vx, cmd_vy and cmd_w"));
        };
        let there = |x: f64| if x.is_finite() { x } else { 0.0 };
        let asked = |row: usize| Twist { vx: there(vx[row]), vy: there(vy[row]), omega: there(omega[row]) };
        if let Some((row, why)) = (0..run.t.len()).find_map(|row| Some((row, too_fast(asked(row))?))) {
            return Err(Failure::about(file, format!("at {} s: {why}", run.t[row])));
        }
        let begun = run.t.first().copied().unwrap_or(0.0);
        let times: Vec<f64> = run.t.iter().map(|t| t - begun).collect();
        Ok(Box::new(move |t| {
            let row = times.partition_point(|time| *time <= t).checked_sub(1)?;
            // Where a sample is missing the last one holds.
            let held = |column: &[f64]| column[..=row].iter().rev().copied().find(|x| x.is_finite()).unwrap_or(0.0);
            (row + 1 < times.len()).then(|| Twist { vx: held(&vx), vy: held(&vy), omega: held(&omega) })
        }))
    }
}

/// Why a velocity is one that no such robot has: a wheel would turn faster than its motor does without any load.
fn too_fast(robot: &Robot) -> Result<impl Fn(Twist) -> Option<String>, Failure> {
    let geometry = robot.geometry().map_err(Failure::data)?;
    let most = robot.no_load_wheel_speed(robot.supply_v);
    Ok(move |twist: Twist| {
        let of = |wheel: usize| geometry.wheel_speed(wheel, twist).abs();
        let wheel = (0..geometry.wheel_count()).max_by(|a, b| of(*a).total_cmp(&of(*b)))?;
        let speed = of(wheel);
        (speed > most).then(|| {
            format!(
                "wheel {} would turn at {speed:.1} rad/s, and its motor without a load at {most:.1}; give at most {:.2} of it",
                wheel + 1,
                most / speed
            )
        })
    })
}

/// Time for frames that nobody waits for.
#[derive(Debug, Default)]
struct NoTime(Duration);

impl Clock for NoTime {
    fn now(&mut self) -> Duration {
        self.0
    }

    fn sleep_until(&mut self, at: Duration) {
        self.0 = self.0.max(at);
    }
}
