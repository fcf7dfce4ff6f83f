//! `racbot init`

use crate::terminal::{Answer, Failure, Target};
use clap::{Args, ValueEnum};
use model::setup::is_tick;
use runs::Run;
use runs::error::InputError;
use runs::frames::wrap_angle;
use runs::robot::Robot;
use serde_json::json;
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use super::axes;

/// Options of `init`.
#[derive(Args, Debug)]
pub(crate) struct Options {
    /// File to write
    #[arg(value_name = "FILE", default_value = "robot.toml")]
    file: PathBuf,

    /// Angles in degrees from the --x axis, counter-clockwise, at which the wheels stand, in the order of the motors,
    /// such as 60,135,225,300
    #[arg(long, value_name = "DEG,..", allow_hyphen_values = true, value_delimiter = ',')]
    wheels: Vec<f64>,

    /// Where your x axis points: forward (ROS, the SSL) or right (racbot's own)
    #[arg(long, value_enum, default_value_t)]
    x: Axis,

    /// Which way positive speed of the wheels turns the robot
    #[arg(long, value_enum, default_value_t)]
    turns: Turns,

    /// Two wheels on one axle, right and left, so many millimetres apart (differential drive)
    #[arg(long, value_name = "MM", conflicts_with_all = ["wheels", "mecanum_mm"])]
    track_mm: Option<f64>,

    /// Four mecanum wheels, front left, front right, rear left, rear right: wheel base and track
    #[arg(long, value_name = "BASE,TRACK", conflicts_with = "wheels", value_delimiter = ',', num_args = 1)]
    mecanum_mm: Vec<f64>,

    /// One axis alone on a bench, such as a servo or a linear drive: a motor, its gear and a load; with a --log of several,
    /// such as an arm's, a folder axis_1, axis_2, ... of each beside FILE
    #[arg(long, conflicts_with_all = ["wheels", "track_mm", "mecanum_mm"])]
    axis: bool,

    /// With --axis: moment of inertia of the load at the output shaft [default: 0]
    #[arg(long, value_name = "KGM2", requires = "axis")]
    load_inertia: Option<f64>,

    /// Radius of the wheels
    #[arg(long, value_name = "MM")]
    radius_mm: Option<f64>,

    /// Distance of the wheels from the centre
    #[arg(long, value_name = "MM")]
    body_radius_mm: Option<f64>,

    /// Motor turns per wheel turn
    #[arg(long, value_name = "N")]
    gear: Option<f64>,

    /// Encoder counts per turn of the motor, four per line
    #[arg(long, value_name = "N", conflicts_with = "counts_per_wheel_rev")]
    counts_per_motor_rev: Option<f64>,

    /// Encoder counts per turn of the wheel
    #[arg(long, value_name = "N")]
    counts_per_wheel_rev: Option<f64>,

    /// Control ticks a second [default: with --log, its rows a second]
    #[arg(long, value_name = "HZ")]
    rate_hz: Option<f64>,

    /// Camera frames a second
    #[arg(long, value_name = "HZ")]
    camera_hz: Option<f64>,

    /// Mass of the whole robot
    #[arg(long, value_name = "KG")]
    mass_kg: Option<f64>,

    /// Moment of inertia about the vertical [default: that of a disc as wide as the wheels stand apart]
    #[arg(long, value_name = "KGM2")]
    yaw_inertia: Option<f64>,

    /// Supply of the motors
    #[arg(long, value_name = "V")]
    supply_v: Option<f64>,

    /// Terminal resistance of a motor
    #[arg(long, value_name = "OHM")]
    resistance_ohm: Option<f64>,

    /// Torque constant of a motor, Nm/A (60 / (2 pi kv))
    #[arg(long, value_name = "NM/A")]
    torque_constant: Option<f64>,

    /// Inertia of a motor's rotor about its own shaft
    #[arg(long, value_name = "KGM2")]
    rotor_inertia: Option<f64>,

    /// Ask only for what this log needs: a run, or a folder of them
    #[arg(long, value_name = "LOG")]
    log: Option<PathBuf>,

    #[command(flatten)]
    target: Target,
}

/// Where x points.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum Axis {
    Forward,
    #[default]
    Right,
}

/// Sense of rotation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum Turns {
    #[default]
    Clockwise,
    Counterclockwise,
}

/// A key of the file: its value, and what it means.
struct Key {
    name: &'static str,
    flag: &'static str,
    value: Option<f64>,
    meaning: &'static str,
    needed: bool,
}

impl Options {
    pub(crate) fn run(&self) -> Result<Answer, Failure> {
        // Of several axes other files are written.
        if !(self.axis && self.log.is_some()) {
            self.target.check_free([&self.file])?;
        }
        let wheels = self.layout()?;
        let log = self.log.as_deref().map(signals).transpose()?;
        let of = |signal: fn(&Run) -> bool| log.as_ref().is_some_and(signal);
        let counts = of(|run| !run.counts.is_empty());
        let speeds = counts || of(|run| !run.speed.is_empty() || !run.measured.is_empty());
        let drives = of(|run| !run.duty.is_empty() || !run.current.is_empty());
        let duties = of(|run| !run.duty.is_empty());
        // Six digits: the median of a log's steps is no finer, and ticks need not fall on a decimal.
        let logged = log.as_ref().and_then(Run::tick_s).filter(|tick| is_tick(*tick));
        let logged = logged.and_then(|tick| format!("{:.5e}", 1.0 / tick).parse::<f64>().ok());
        let by_log = logged.filter(|_| self.rate_hz.is_none());
        // The wheels stand on its edge, however their places were given.
        let apart = wheels.iter().map(|[x, y, ..]| x.hypot(*y)).reduce(f64::max);
        let radius = self.body_radius_mm.map(|r| 1e-3 * r).or(apart).filter(|r| *r > 0.0);
        let disc = self.mass_kg.zip(radius).map(|(m, r)| 0.5 * m * r * r);
        let key = |name, flag, value, needed, meaning| Key { name, flag, value, meaning, needed };
        let mut keys = vec![
            key(
                "wheel_radius_m",
                "--radius-mm",
                self.radius_mm.map(|r| 1e-3 * r).or(self.axis.then_some(1.0)),
                speeds || log.is_none(),
                "wheel radius",
            ),
            key(
                "gear_ratio",
                "--gear",
                self.gear,
                counts && self.counts_per_wheel_rev.is_none() || drives,
                "motor turns per wheel turn",
            ),
        ];
        match self.counts_per_wheel_rev {
            Some(n) => {
                keys.push(key(
                    "encoder_counts_per_wheel_rev",
                    "--counts-per-wheel-rev",
                    Some(n),
                    false,
                    "counts per turn of the wheel",
                ));
            }
            None => keys.push(key(
                "encoder_counts_per_motor_rev",
                "--counts-per-motor-rev (or --counts-per-wheel-rev)",
                self.counts_per_motor_rev,
                counts,
                "counts per turn of the motor, four per line",
            )),
        }
        keys.extend([
            key(
                "control_rate_hz",
                "--rate-hz",
                self.rate_hz.or(by_log),
                false,
                if by_log.is_some() {
                    "rows of the log a second; more where the controller has more ticks"
                } else {
                    "control ticks a second; else taken from the log"
                },
            ),
            key(
                "camera_rate_hz",
                "--camera-hz",
                self.camera_hz,
                false,
                "camera frames a second; else taken from the log",
            ),
        ]);
        if self.axis {
            let load = Some(self.load_inertia.unwrap_or(0.0));
            keys.push(key("wheel_inertia_kg_m2", "--load-inertia", load, false, "load at the output shaft"));
        } else {
            let inertia = self.yaw_inertia.or(disc);
            let meaning = "moment of inertia about the vertical";
            keys.push(key("mass_kg", "--mass-kg", self.mass_kg, drives, "mass of the whole robot"));
            keys.push(key("yaw_inertia_kg_m2", "--yaw-inertia", inertia, drives, meaning));
        }
        keys.extend([key("supply_v", "--supply-v", self.supply_v, duties, "motor supply")]);
        let motor = [
            key("resistance_ohm", "--resistance-ohm", self.resistance_ohm, duties, "terminal resistance"),
            key("torque_constant", "--torque-constant", self.torque_constant, drives, "Nm/A"),
            key("rotor_inertia", "--rotor-inertia", self.rotor_inertia, drives, "kg m2, at the motor shaft"),
            key("friction_torque", "", Some(0.0), false, "Nm, at the motor shaft; `racbot gap` finds more"),
        ];
        let mut missing: Vec<String> = Vec::new();
        if wheels.is_empty() && (speeds || log.is_none()) {
            missing.push("--wheels DEG,.. with --body-radius-mm (or --track-mm, --mecanum-mm, --axis)".to_owned());
        }
        let asked = keys.iter().chain(&motor).filter(|k| k.needed && k.value.is_none());
        missing.extend(asked.map(|k| format!("{} ({})", k.flag, k.meaning)));
        if !missing.is_empty() {
            let whose = self.log.as_ref().map_or(String::new(), |log| format!("for {}: ", log.display()));
            return Err(Failure::usage(format!("{whose}say {}", missing.join(", "))));
        }
        let text = self.text(&keys, &motor, &wheels);
        // What was written must be read. Where it is not, nobody has seen the file: an option was wrong.
        Robot::parse_partial(&text, &self.file).map_err(|error| self.usage(&error, keys.iter().chain(&motor)))?;
        let axes = log.as_ref().filter(|_| self.axis).map_or(1, Run::wheel_count);
        if let Some(log) = self.log.as_deref().filter(|_| axes > 1) {
            return axes::apart(&self.file, &text, &logs(log)?, axes, self.target);
        }
        self.target.save(&self.file, &text)?;
        let what = if self.axis { "one axis".to_owned() } else { format!("{} wheels", wheels.len()) };
        let rate =
            by_log.map_or(String::new(), |rate| format!(" and control_rate_hz = {}, the log's rows", number(rate)));
        let said = format!("{} with {what}{rate}\n", self.file.display());
        Ok(Answer {
            text: said,
            json: json!({ "robot": self.file.to_string_lossy(), "wheels": wheels.len() }),
            wrong: None,
        })
    }

    /// The option that a mistake in the text came by.
    fn usage<'a>(&self, error: &InputError, mut keys: impl Iterator<Item = &'a Key>) -> Failure {
        let name = error.field.rsplit('.').next().unwrap_or_default();
        let layout = [("--track-mm", self.track_mm.is_some()), ("--mecanum-mm", !self.mecanum_mm.is_empty())];
        let flag = match keys.find(|key| key.name == name) {
            Some(key) => key.flag.split(' ').next().unwrap_or_default(),
            None => layout.into_iter().find(|(_, given)| *given).map_or("--wheels", |(flag, _)| flag),
        };
        Failure::usage(format!("{flag}: {}; {}", error.what, error.hint))
    }

    /// Place (m), drive direction and roller angle (rad) of every wheel, x to the right.
    fn layout(&self) -> Result<Vec<[f64; 4]>, Failure> {
        let lengths = [self.track_mm, self.radius_mm, self.body_radius_mm];
        let numbers = lengths.into_iter().flatten().chain(self.mecanum_mm.iter().copied());
        if numbers.chain(self.gear).any(|x| !(x.is_finite() && x > 0.0)) || self.wheels.iter().any(|x| !x.is_finite()) {
            return Err(Failure::usage("lengths and ratios are positive numbers, angles numbers"));
        }
        if self.axis {
            return Ok(vec![[0.0; 4]]);
        }
        if let Some(track) = self.track_mm {
            let half = 0.5e-3 * track;
            return Ok([half, -half].map(|x| [x, 0.0, FRAC_PI_2, 0.0]).to_vec());
        }
        if !self.mecanum_mm.is_empty() {
            let [base, track] = self.mecanum_mm[..] else {
                return Err(Failure::usage("--mecanum-mm: give wheel base and track, such as 200,180"));
            };
            let (y, x) = (0.5e-3 * base, 0.5e-3 * track);
            let corners = [(-x, y, -1.0), (x, y, 1.0), (-x, -y, 1.0), (x, -y, -1.0)];
            return Ok(corners.map(|(x, y, side)| [x, y, FRAC_PI_2, side * FRAC_PI_4]).to_vec());
        }
        if self.wheels.is_empty() {
            return Ok(Vec::new());
        }
        let Some(radius) = self.body_radius_mm.map(|r| 1e-3 * r) else {
            return Err(Failure::usage("--wheels: say how far they are from the centre, too: --body-radius-mm"));
        };
        let forward = if self.x == Axis::Forward { FRAC_PI_2 } else { 0.0 };
        let sense = if self.turns == Turns::Clockwise { -FRAC_PI_2 } else { FRAC_PI_2 };
        let wheel = |deg: &f64| {
            let mount = wrap_angle(deg.to_radians() + forward);
            [radius * mount.cos(), radius * mount.sin(), wrap_angle(mount + sense), 0.0]
        };
        Ok(self.wheels.iter().map(wheel).collect())
    }

    fn text(&self, keys: &[Key], motor: &[Key], wheels: &[[f64; 4]]) -> String {
        let mut out = String::from(
            "# Robot parameters, SI units. Body frame: x to the right, y forward, angles counter-clockwise from x.\n\
             # What is commented out is not known; what needs it says so. Written by `racbot init`.\n",
        );
        let line = |out: &mut String, k: &Key| {
            let _ = match k.value {
                Some(x) => writeln!(out, "{} = {}  # {}", k.name, number(x), k.meaning),
                None => writeln!(out, "# {} =   # {}", k.name, k.meaning),
            };
        };
        if self.axis {
            out +=
                "support = \"blocks\"  # no floor: the axis alone; of a linear axis travel_per_rev_m may stand here\n";
        }
        keys.iter().for_each(|k| line(&mut out, k));
        let known = motor.iter().any(|k| k.value.is_some_and(|x| x != 0.0));
        let _ = writeln!(out, "\n{}", if known { "[motor]" } else { "# [motor]" });
        motor.iter().filter(|k| known || k.value.is_none()).for_each(|k| line(&mut out, k));
        out += "\n# [pi]  # where the firmware has racbot's law; without it `racbot simulate` takes gains that suit\n\
                # kp =   # duty per rad/s at the wheel\n# ki =   # duty per rad at the wheel\n";
        for (i, [x, y, drive, roller]) in wheels.iter().enumerate() {
            let _ = writeln!(out, "\n[[wheel]]  # {}", i + 1);
            let _ = writeln!(out, "x_m = {}  # to the right\ny_m = {}  # forward", place(*x), place(*y));
            let _ = writeln!(out, "drive_deg = {}  # where positive speed drives it", place(drive.to_degrees()));
            let _ = writeln!(
                out,
                "roller_deg = {}  # 0: omni wheel or tyre; 45 or -45: mecanum",
                place(roller.to_degrees())
            );
        }
        out
    }
}

/// To twelve digits, without the noise of a unit that was changed.
fn number(x: f64) -> String {
    let rounded = format!("{x:.11e}").parse().unwrap_or(x);
    match rounded {
        _ if !x.is_finite() => x.to_string().to_lowercase(),
        0.0 => "0".to_owned(),
        _ if (1e-6..1e15).contains(&f64::abs(rounded)) => rounded.to_string(),
        _ => format!("{rounded:e}"),
    }
}

/// To a nanometre and a nanodegree, without the noise of sines; coarser, `gap` would see it in the set points.
fn place(x: f64) -> String {
    number((x * 1e9).round() / 1e9 + 0.0)
}

/// The columns of a log, or of the first of a folder.
fn signals(path: &Path) -> Result<Run, Failure> {
    Ok(Run::read(&logs(path)?[0])?)
}

/// A log, or all logs of a folder: one or more.
fn logs(path: &Path) -> Result<Vec<PathBuf>, Failure> {
    if !path.is_dir() {
        return Ok(vec![path.to_owned()]);
    }
    let entries = std::fs::read_dir(path).map_err(|error| InputError::io(path, &error))?;
    let mut files: Vec<PathBuf> = entries.filter_map(|e| Some(e.ok()?.path())).collect();
    files.retain(|f| f.extension().is_some_and(|e| e.eq_ignore_ascii_case("csv") || e.eq_ignore_ascii_case("mcap")));
    files.sort();
    if files.is_empty() {
        return Err(Failure::about(path, "holds no *.csv or *.mcap; name a log"));
    }
    Ok(files)
}
