//! `racbot simulate`

mod manoeuvre;
mod smart;

use super::fpga_options::{FpgaChoice, SpeedChoice};
use super::options::Hidden;
use super::start::Start;
use crate::terminal::progress::Progress;
use crate::terminal::{Answer, Failure, Table, Target, positive, wrapped};
use clap::{Args, ValueEnum};
use model::effects::{Applied, ControlDeviations};
use model::plant::{Contact, Deviations};
use model::trajectory::{FIG_6, SetPoint};
use plot::Color;
use plot::page::Page;
use runs::error::InputError;
use runs::robot::Robot;
use serde_json::{Value, json};
use simulator::closed_loop::picture::{Curve, speeds, trajectory};
use simulator::closed_loop::{Control, Drive, Driven, Ending};
use simulator::fpga::{BitTrue, Fpga, Kind};
use simulator::imu::VirtualImu;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Where runs go, and what they are called, where nothing is said.
const OUT: &str = "out/simulate";
const NAME: &str = "run";
const SMART_OUT: &str = "out/smart";

/// Options of `simulate`.
#[derive(Args, Debug)]
pub(crate) struct Options {
    /// Robot as the controller believes it to be [default: the built-in one of the paper]
    #[arg(long, value_name = "FILE")]
    robot: Option<PathBuf>,

    /// Set points: CSV lines `x, y, v, omega[, stop]`, or TOML [default: the four of the paper's Fig. 6]
    #[arg(long, value_name = "FILE")]
    setpoints: Option<PathBuf>,

    /// Drive a manoeuvre of the library instead, commands only, in floating point: spin, star, square, chirp,
    /// stop-and-go, creep, full-duty, blocks. The runs make, or join, the data set in --out
    #[arg(long, value_name = "NAME", conflicts_with_all = ["setpoints", "fpga", "speed_mode", "controller", "limit_s"])]
    manoeuvre: Option<manoeuvre::Name>,

    /// How often the manoeuvre is driven, each time from another heading, a run each
    #[arg(long, value_name = "N", default_value_t = 1, requires = "manoeuvre", value_parser = clap::value_parser!(u32).range(1..=1000))]
    times: u32,

    /// Fetch a ball and drive to given coordinates by wheels, gyroscope and on-board camera, the overhead camera off;
    /// --seed draws the start. Writes runs, pictures and a report page
    #[arg(long, conflicts_with_all = ["robot", "setpoints", "manoeuvre", "fpga", "speed_mode", "controller", "limit_s", "camera", "start", "name", "hidden", "skew_deg"])]
    smart: bool,

    /// What is wrong with the on-board camera
    #[arg(long, value_enum, value_name = "FAULT", requires = "smart")]
    camera_fault: Option<smart::CameraFault>,

    #[command(flatten)]
    hidden: Hidden,

    /// What the overhead camera is for
    #[arg(long, value_name = "USE", num_args = 0..=1, default_value = "log", default_missing_value = "correct")]
    camera: CameraUse,

    /// Start pose: x and y in metres, heading of the body's x axis in degrees
    #[arg(long, value_name = "X,Y,DEG", default_value = "0,0,0", allow_hyphen_values = true)]
    start: Start,

    /// Seed of the camera's noise
    #[arg(long, default_value_t = 1)]
    seed: u64,

    /// FPGA that closes the speed loops
    #[arg(long, value_enum, default_value_t)]
    fpga: FpgaChoice,

    /// How the FPGA measures speeds
    #[arg(long, value_enum, default_value_t)]
    speed_mode: SpeedChoice,

    /// Who steers
    #[arg(long, value_enum, default_value_t)]
    controller: ControllerChoice,

    /// Longest drive in seconds [default: 60; 0.02 on rust-hdl, which takes minutes for a second]
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    limit_s: Option<f64>,

    /// Folder for the run, robot.toml and pictures: a data set for the other commands, which another run joins
    /// under another --name [default: out/simulate, or the first free of out/simulate-2 ...]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,

    #[command(flatten)]
    target: Target,

    /// Name of the run in the folder
    #[arg(long, value_name = "NAME", default_value = NAME, value_parser = run_name)]
    name: String,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum CameraUse {
    /// There is none
    Off,
    /// It is logged, the controller does not see it
    Log,
    /// It is logged and corrects the controller's pose
    Correct,
}

/// Who steers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum ControllerChoice {
    /// Limits of speed and acceleration, slows down for corners
    #[default]
    Follower,
    /// As in the paper: straight at the next set point at its full speed
    Paper,
}

/// A drive, and how long it took.
struct Timed {
    driven: Driven,
    /// Seconds of the robot's life per second of computing.
    times_real_time: f64,
}

/// What there is beside the drive itself.
struct Truth {
    /// Whether the robot is another than the controller believes.
    hidden: bool,
    /// Effects that were not simulated, in words.
    not_shown: Option<String>,
}

/// A remark on effects that do not show in a drive over the FPGA, whose logic is the controller.
pub(super) fn not_shown(applied: &Applied) -> Option<String> {
    if applied.control != ControlDeviations::default() || applied.stamp_jitter_s != 0.0 {
        return Some(
            "not simulated: effects on commands, controller and stamps; `racbot simulate --manoeuvre` simulates them"
                .to_owned(),
        );
    }
    let names = applied.unsupported.join(", ");
    (!names.is_empty()).then(|| format!("not simulated: the effects {names}"))
}

/// A run's name is part of a file's in the folder of its data set.
fn run_name(text: &str) -> Result<String, String> {
    let hidden = text.is_empty() || text.starts_with('.');
    if hidden || text.contains(['/', '\0']) {
        return Err("a run's name has no folder in it, and no dot in front".to_owned());
    }
    Ok(text.to_owned())
}

impl Options {
    pub(crate) fn run(&self) -> Result<Answer, Failure> {
        if self.smart {
            let out = self.target.place(self.out.as_deref(), SMART_OUT);
            let smart = smart::Smart { seed: self.seed, fault: self.camera_fault, out: &out, target: self.target };
            return smart.drive();
        }
        let (believed, remark) = super::driven::simulated(self.robot.as_deref())?;
        let mut answer = self.simulated(&believed)?;
        if let Some(remark) = remark {
            answer.text += &wrapped(&remark, 2);
            answer.json["remark"] = json!(remark);
        }
        Ok(answer)
    }

    fn simulated(&self, believed: &Robot) -> Result<Answer, Failure> {
        let actual = self.hidden.robot(believed)?;
        let out = self.target.place(self.out.as_deref(), OUT);
        if let Some(manoeuvre::Name(manoeuvre)) = self.manoeuvre {
            let runs = manoeuvre::Runs {
                manoeuvre,
                believed,
                actual: &actual,
                camera: self.camera != CameraUse::Off,
                start: self.start.0,
                seed: self.seed,
                times: self.times,
                out: &out,
                target: self.target,
                name: &self.name,
            };
            return runs.drive();
        }
        let applied = Applied::of(&actual);
        let set_points = self.set_points()?;
        let drive = Drive {
            actual: applied.robot.clone(),
            contact: applied.contact,
            deviations: applied.deviations.clone(),
            control: match self.controller {
                ControllerChoice::Follower => Control::Follower,
                ControllerChoice::Paper => Control::Paper,
            },
            camera: (self.camera != CameraUse::Off).then_some(applied.camera),
            fused: self.camera == CameraUse::Correct,
            start: self.start.0,
            speed_mode: self.speed_mode.into(),
            limit_s: self.limit_s()?,
            seed: self.seed,
            ..Drive::new(believed, &set_points)
        };
        let hidden = actual != *believed;
        let files = self.files(&out);
        self.target.check_free([&files[0], &files[2], &files[3], &files[4]])?;
        let timed = self.timed(&drive, &Robot { effects: actual.effects.clone(), ..believed.clone() })?;
        let ideal = (hidden || !actual.effects.is_empty()).then(|| {
            let ideal = Drive {
                actual: believed.clone(),
                contact: Contact::default(),
                deviations: Deviations::default(),
                ..drive.clone()
            };
            let nominal = Robot { effects: Vec::new(), ..believed.clone() };
            let card =
                VirtualImu::of_robot(&nominal, self.seed).map_or_else(BitTrue::new, |imu| BitTrue::new().with_imu(imu));
            ideal.run(card, |_| {}).map_err(|error| self.about_robot(error))
        });
        let answer = self.answer(&drive, &timed, &files, &Truth { hidden, not_shown: not_shown(&applied) });
        self.save(&files, &drive, &timed.driven, ideal.transpose()?.as_ref(), &answer.text)?;
        Ok(answer)
    }

    fn set_points(&self) -> Result<Vec<SetPoint>, InputError> {
        self.setpoints.as_ref().map_or_else(|| Ok(FIG_6.to_vec()), SetPoint::read_file)
    }

    fn limit_s(&self) -> Result<f64, Failure> {
        match self.limit_s {
            None if self.fpga.kind() == Kind::RustHdl => Ok(0.02),
            None => Ok(60.0),
            Some(limit) => positive("--limit-s", limit, 3_600.0).map(|()| limit),
        }
    }

    /// Drives with the sensor of a robot with effects.
    fn timed(&self, drive: &Drive, felt: &Robot) -> Result<Timed, Failure> {
        let progress = Progress::new(format!("driving over {}", self.fpga.kind()), (drive.limit_s * 1e3) as u64);
        // Only the bit-true model has a sensor on its pins.
        let sensor = VirtualImu::of_robot(felt, self.seed).filter(|_| self.fpga.kind() == Kind::BitTrue);
        let fpga: Box<dyn Fpga> = match sensor {
            Some(sensor) => Box::new(BitTrue::new().with_imu(sensor)),
            None => self.fpga.open()?,
        };
        let begun = Instant::now();
        let driven = drive.run(fpga, |t| progress.at((t * 1e3) as u64)).map_err(|error| self.about_robot(error))?;
        let times_real_time = driven.track.len() as f64 * drive.believed.tick_s() / begun.elapsed().as_secs_f64();
        Ok(Timed { driven, times_real_time })
    }

    fn about_robot(&self, what: impl std::fmt::Display) -> Failure {
        match &self.robot {
            Some(file) => Failure::about(file, what),
            None => Failure::data(what),
        }
    }

    /// The run, its robot, and the pictures, which a run with a name of its own has for itself.
    fn files(&self, out: &Path) -> [PathBuf; 5] {
        let picture = |what: &str| match self.name.as_str() {
            NAME => out.join(what),
            name => out.join(format!("{name}-{what}")),
        };
        let run = out.join(format!("{}.csv", self.name));
        [run, out.join("robot.toml"), picture("trajectory.svg"), picture("speeds.svg"), picture("index.html")]
    }

    fn save(
        &self,
        files: &[PathBuf; 5],
        drive: &Drive,
        driven: &Driven,
        ideal: Option<&Driven>,
        text: &str,
    ) -> Result<(), Failure> {
        let pictures = [picture(drive, driven, ideal), speeds("Wheel speeds, heading and duties", driven)];
        self.target.save(&files[1], &driven.robot.to_toml())?;
        driven.run.save(&files[0], self.target.existing())?;
        for (file, svg) in files[2..4].iter().zip(&pictures) {
            self.target.save(file, svg)?;
        }
        self.target.save(&files[4], &self.page(text, &pictures))
    }

    fn page(&self, text: &str, pictures: &[String]) -> String {
        let mut page = Page::new("Simulated drive");
        let run = format!("{}.csv", self.name);
        page.links([(run.as_str(), "the run"), ("robot.toml", "its robot.toml")]);
        page.verbatim(text);
        for svg in pictures {
            page.figure(svg, "");
        }
        page.note(
            "Next: this folder is a data set, so `racbot gap` and `racbot calibrate` read it as they read logs. Your own logs: \
             `racbot convert --draft LOG map.toml`.",
        );
        page.finish()
    }

    fn answer(&self, drive: &Drive, timed: &Timed, files: &[PathBuf], truth: &Truth) -> Answer {
        let mut text = format!("{} over the {} FPGA\n\n", headline(drive, truth), self.fpga.kind());
        text += &figures(drive, timed);
        if let Some(remark) = &truth.not_shown {
            text += &wrapped(remark, 2);
        }
        let names: Vec<_> = files.iter().filter_map(|f| f.file_name()).map(|f| f.to_string_lossy()).collect();
        let folder = files[0].parent().unwrap_or(Path::new(""));
        // The label's width stands for its white space, which wrapping would take.
        let written = wrapped(&format!("written------{}: {}", folder.display(), names.join(", ")), 13);
        text += &written.replacen("written------", "written      ", 1);
        let mut json = to_json(drive, timed);
        json["fpga"] = json!(self.fpga.kind().to_string());
        json["files"] = json!(files);
        Answer { text, json, wrong: None }
    }
}

/// What is driven, in a few words.
fn headline(drive: &Drive, truth: &Truth) -> String {
    let hidden = if !truth.hidden { "" } else { ", the true robot hidden from the controller," };
    format!("{} set points{hidden}", drive.set_points.len())
}

/// The trajectory; the ideal one beside it where there is one.
fn picture(drive: &Drive, driven: &Driven, ideal: Option<&Driven>) -> String {
    let title = format!("Trajectory over {} set points", drive.set_points.len());
    let hidden = if drive.fused { "hidden geometry, camera corrects" } else { "hidden geometry" };
    let curves = match ideal {
        None => vec![Curve { label: "robot", driven, color: Color::Green, dashed: false }],
        Some(ideal) => vec![
            Curve { label: "geometry as believed", driven: ideal, color: Color::Green, dashed: false },
            Curve { label: hidden, driven, color: Color::Red, dashed: false },
        ],
    };
    trajectory(&title, &drive.set_points, &curves)
}

/// Set points and figures of merit.
fn figures(drive: &Drive, timed: &Timed) -> String {
    let report = &timed.driven.report;
    let mut table = Table::new(2, &["", "set point", "reached at", "nearest"]);
    let mut text = String::new();
    for (number, (point, at)) in drive.set_points.iter().zip(&report.set_points).enumerate() {
        let stop = if point.stop { ", stop" } else { "" };
        let reached = match (at.reached_at, &at.why_not) {
            (Some(t), None) => format!("{t:.2} s"),
            _ => "missed".to_owned(),
        };
        let place = format!("({}, {}) at {} m/s, {} rad/s{stop}", point.x, point.y, point.v, point.omega);
        table.row([(number + 1).to_string(), place, reached, format!("{:.0} mm", 1e3 * at.miss_m)]);
    }
    text += &table.render();
    text.push('\n');
    for (number, at) in report.set_points.iter().enumerate() {
        if let Some(why) = &at.why_not {
            text += &wrapped(&format!("{}: {why}", number + 1), 3);
        }
    }
    let time = report.time_s.map_or_else(|| "not all reached".to_owned(), |t| format!("{t:.2} s"));
    let _ = writeln!(text, "time         {time} for {:.2} m", report.path_m);
    let (rms, max) = (1e3 * report.path_error_rms_m, 1e3 * report.path_error_max_m);
    let _ = writeln!(text, "path error   {rms:.1} mm RMS, {max:.1} mm at most");
    let _ = writeln!(text, "overshoot    {:.1} mm", 1e3 * report.overshoot_m);
    let ending = match &timed.driven.ending {
        Ending::Finished => "at rest".to_owned(),
        Ending::TimeLimit => format!("after {} s, the time limit", drive.limit_s),
        Ending::Stopped => "stopped".to_owned(),
        Ending::Fault(fault) => fault.to_string(),
    };
    let _ = write!(text, "ended        {}", wrapped(&ending, 13));
    let _ = writeln!(text, "simulated    {} times real time", ratio(timed.times_real_time));
    text
}

/// The same for programs.
fn to_json(drive: &Drive, timed: &Timed) -> Value {
    let report = &timed.driven.report;
    let points = drive.set_points.iter().zip(&report.set_points).map(|(point, at)| {
        json!({
            "x": point.x, "y": point.y, "v": point.v, "omega": point.omega, "stop": point.stop,
            "reached_at_s": at.reached_at, "nearest_m": at.miss_m, "why_not": at.why_not,
        })
    });
    json!({
        "set_points": points.collect::<Vec<_>>(),
        "time_s": report.time_s,
        "path_m": report.path_m,
        "path_error_rms_m": report.path_error_rms_m,
        "path_error_max_m": report.path_error_max_m,
        "overshoot_m": report.overshoot_m,
        "ended": match &timed.driven.ending {
            Ending::Finished => "finished".to_owned(),
            Ending::TimeLimit => "time-limit".to_owned(),
            Ending::Stopped => "stopped".to_owned(),
            Ending::Fault(fault) => fault.to_string(),
        },
        "times_real_time": timed.times_real_time,
    })
}

/// A ratio with two significant figures.
fn ratio(value: f64) -> String {
    if value >= 100.0 {
        let step = 10_f64.powf(value.log10().floor() - 1.0);
        return format!("{:.0}", (value / step).round() * step);
    }
    if value >= 10.0 { format!("{value:.0}") } else { format!("{value:.2}") }
}
