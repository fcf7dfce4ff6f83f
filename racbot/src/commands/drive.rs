//! `racbot drive`

use super::record::{Kept, Record};
use super::start::Start;
use crate::card::{CardOptions, Pace, ReadyCard};
use crate::terminal::{Answer, Failure, Table, Target, entry, positive};
use clap::{Args, ValueEnum};
use driver::Board;
use driver::drive::{Control, Driven, Ending, Plan};
use driver::pci::Use;
use driver::realtime::{Rights, stop_on_signals};
use driver::recording::{Recorded, logged_robot};
use fixed_kin::speed::SpeedMode;
use model::trajectory::{Arrival, SetPoint};
use runs::frames::Pose;
use runs::robot::Robot;
use serde_json::{Value, json};
use std::fmt::Write as _;
use std::path::PathBuf;

/// Options of `drive`.
#[derive(Args, Debug)]
pub(crate) struct Options {
    /// Set points: CSV lines `x, y, v, omega[, stop]`, or TOML
    #[arg(long, value_name = "FILE")]
    setpoints: PathBuf,

    /// The robot; its effects are honoured: skew and radii go into the card [default: the paper's]
    #[arg(long, value_name = "FILE")]
    robot: Option<PathBuf>,

    #[command(flatten)]
    card: CardOptions,

    /// Record the run: .csv, or .mcap for Foxglove and Rerun; robot.toml is put beside it
    #[arg(long, value_name = "FILE")]
    record: Option<PathBuf>,

    #[command(flatten)]
    target: Target,

    /// Let poses from a camera correct the controller's, where there is one
    #[arg(long)]
    camera: bool,

    #[cfg(feature = "vision")]
    #[command(flatten)]
    vision: crate::onboard::Vision,

    /// Standard deviation of the place above which the robot stops and looks round [default with --vision: half of the
    /// carpet outside the lines; without: never]
    #[arg(long, value_name = "M")]
    sure_m: Option<f64>,

    /// Start pose: x and y in metres, heading of the body's x axis in degrees
    #[arg(long, value_name = "X,Y,DEG", default_value = "0,0,0", allow_hyphen_values = true)]
    start: Start,

    /// Who steers
    #[arg(long, value_enum, default_value_t)]
    controller: Steering,

    /// How the FPGA measures speeds
    #[arg(long, value_enum, default_value_t)]
    speed_mode: Speeds,

    /// Longest drive in seconds
    #[arg(long, value_name = "S", default_value_t = 60.0)]
    limit_s: f64,

    /// Real-time priority asked for
    #[arg(long, value_name = "N", default_value_t = 80, value_parser = clap::value_parser!(u8).range(1..=99))]
    priority: u8,

    #[cfg(feature = "simulation")]
    #[command(flatten)]
    hidden: super::options::Hidden,

    /// Where the built-in card's robot stands, unknown to the controller [default: where --start says]
    #[cfg(feature = "simulation")]
    #[arg(long, value_name = "X,Y,DEG", allow_hyphen_values = true)]
    stands: Option<Start>,

    /// Drive the built-in card in real time, not as fast as it can be computed
    #[cfg(feature = "simulation")]
    #[arg(long)]
    real_time: bool,
}

/// Who steers.
#[derive(Clone, Copy, Debug, Default, ValueEnum)]
enum Steering {
    /// Limits of speed and acceleration, slows down for corners
    #[default]
    Follower,
    /// As in the paper: straight at the next set point at its full speed
    Paper,
}

/// How speeds are measured.
#[derive(Clone, Copy, Debug, Default, ValueEnum)]
enum Speeds {
    /// Count difference of a control tick
    #[default]
    Difference,
    /// Counts between edges over the time between them
    CountAndTime,
}

/// All that there is to tell.
struct Report<'a> {
    /// Where the robot of a built-in card stands at the end.
    stands: Option<Pose>,
    name: &'a str,
    clock_hz: f64,
    plan: &'a Plan,
    driven: &'a Driven,
    recorded: Option<&'a Recorded>,
    robot_file: Option<String>,
    remarks: Vec<String>,
}

impl Options {
    pub(crate) fn run(&self) -> Result<Answer, Failure> {
        // Every file first: nothing may move for one that is wrong.
        let set_points = SetPoint::read_file(&self.setpoints)?;
        let robot = super::driven::robot(self.robot.as_deref())?;
        positive("--limit-s", self.limit_s, 3_600.0)?;
        if self.sure_m.is_some_and(|sure| !(sure > 0.0 && sure.is_finite())) {
            return Err(Failure::usage("--sure-m: give metres above 0"));
        }
        Target::check_apart(self.robot.iter().chain([&self.setpoints]), &self.record)?;
        self.recorder().check()?;
        let (actual, pace) = self.built_in(&robot)?;
        #[cfg(feature = "vision")]
        let setting = self.vision.setting()?;
        let plan = self.plan(&robot, &set_points);
        #[cfg(feature = "vision")]
        let by_field = self.vision.is_onboard().then(|| setting.sure_m());
        #[cfg(feature = "vision")]
        let plan = Plan { sure_m: plan.sure_m.or(by_field), ..plan };
        let ready = self.card.ready(Use::Drive, &actual, pace)?;
        ready.stand(self.stands());
        #[cfg(feature = "simulation")]
        let truth = ready.shared.clone();
        #[cfg(feature = "vision")]
        let (ready, refused) = if self.vision.is_onboard() { onboard(ready, setting, pace)? } else { (ready, None) };
        let ReadyCard { name, registers, clock_hz, mut clock, source, .. } = ready;
        let about = |what: &dyn std::fmt::Display| Failure::data(format!("{name}: {what}"));
        let scale = plan.scale(clock_hz).map_err(|error| about(&error))?;
        let logged = logged_robot(&plan.believed(), &scale, &plan.settings);
        let stop = stop_on_signals().map_err(Failure::data)?;
        let mut remarks = Vec::new();
        if self.camera && source.is_none() {
            remarks.push("there is no camera: the pose is odometry's alone".to_owned());
        }
        let mut recording = self.recorder().start(&logged, source.is_some())?;
        if let Some(recording) = recording.as_mut().filter(|_| pace != Pace::Real) {
            recording.wait_where_full();
        }
        if pace == Pace::Real {
            let rights = Rights::acquire(self.priority);
            remarks.extend(rights.remarks().map(str::to_owned));
        }
        let mut source = source.unwrap_or_else(|| Box::new(driver::drive::NoSource));
        let driven = plan
            .drive(Board::new(registers), &mut clock, clock_hz, &mut source, recording.as_mut(), &stop)
            .map_err(|error| about(&error))?;
        #[cfg(feature = "vision")]
        remarks.extend(refused.into_iter().flat_map(|refused| refused()));
        let Kept { run: recorded, robot: robot_file, failed } = self.recorder().finish(recording, &logged);
        #[cfg(feature = "simulation")]
        let stands = truth.map(|card| card.pose());
        #[cfg(not(feature = "simulation"))]
        let stands = None;
        let report = Report {
            stands,
            name: &name,
            clock_hz,
            plan: &plan,
            driven: &driven,
            recorded: recorded.as_ref(),
            robot_file,
            remarks,
        };
        let wrong = match &driven.ending {
            Ending::Fault(fault) => Some(format!("{name}: {fault}")),
            _ => failed,
        };
        Ok(Answer { text: report.text(), json: report.json(), wrong })
    }

    /// The robot behind a built-in card, and its time.
    #[cfg(feature = "simulation")]
    fn built_in(&self, believed: &Robot) -> Result<(Robot, Pace), Failure> {
        if !self.card.is_built_in() {
            if self.hidden.is_given() || self.real_time || self.stands.is_some() {
                return Err(Failure::usage("--hidden, --skew-deg, --stands and --real-time are for --card virtual"));
            }
            return Ok((believed.clone(), Pace::Real));
        }
        Ok((self.hidden.robot(believed)?, if self.real_time { Pace::Real } else { Pace::Simulated }))
    }

    #[cfg(not(feature = "simulation"))]
    fn built_in(&self, believed: &Robot) -> Result<(Robot, Pace), Failure> {
        Ok((believed.clone(), Pace::Real))
    }

    /// Where the robot of a built-in card stands.
    fn stands(&self) -> Pose {
        #[cfg(feature = "simulation")]
        if let Some(Start(pose)) = self.stands {
            return pose;
        }
        self.start.0
    }

    /// Whether something corrects the pose.
    fn fused(&self) -> bool {
        #[cfg(feature = "vision")]
        if self.vision.is_onboard() {
            return true;
        }
        self.camera
    }

    fn plan(&self, robot: &Robot, set_points: &[SetPoint]) -> Plan {
        let mut plan = Plan::new(robot, set_points);
        plan.control = match self.controller {
            Steering::Follower => Control::Follower,
            Steering::Paper => Control::Paper,
        };
        plan.settings.speed_mode = match self.speed_mode {
            Speeds::Difference => SpeedMode::Difference,
            Speeds::CountAndTime => SpeedMode::CountAndTime,
        };
        #[cfg(feature = "vision")]
        let plan = Plan { start_covariance: self.vision.start_covariance(), ..plan };
        Plan { start: self.start.0, fused: self.fused(), limit_s: self.limit_s, sure_m: self.sure_m, ..plan }
    }

    fn recorder(&self) -> Record<'_> {
        Record { file: self.record.as_deref(), target: self.target }
    }
}

/// Which pictures gave no pose, asked after the drive.
#[cfg(feature = "vision")]
type Refused = Option<Box<dyn FnOnce() -> Vec<String>>>;

/// Puts the camera on the robot in the place of the one above it; the answer says afterwards which pictures gave no pose.
#[cfg(feature = "vision")]
fn onboard(
    mut ready: ReadyCard,
    setting: crate::onboard::Setting,
    pace: Pace,
) -> Result<(ReadyCard, Refused), Failure> {
    let said = |(why, count): (&String, &usize)| format!("{count} pictures of the on-board camera gave no pose: {why}");
    #[cfg(feature = "simulation")]
    if let Some(card) = ready.shared.take() {
        if pace == Pace::Real {
            return Err(Failure::usage(
                "--real-time: the built-in card's on-board camera is rendered, which takes longer",
            ));
        }
        let (source, eye) = setting.built_in(card)?;
        ready.source = Some(source);
        return Ok((ready, Some(Box::new(move || eye.borrow().refused().iter().map(said).collect()))));
    }
    let _ = pace;
    let (source, refusals) = setting.real()?;
    ready.source = Some(source);
    let refused = move || refusals.lock().map(|refused| refused.iter().map(said).collect()).unwrap_or_default();
    Ok((ready, Some(Box::new(refused))))
}

impl Report<'_> {
    fn text(&self) -> String {
        let driven = self.driven;
        let mut text = format!("card     {}, {:.4} MHz\n\n", self.name, self.clock_hz / 1e6);
        let mut table = Table::new(2, &["", "set point", "reached at", "off by"]);
        for (number, (point, arrival)) in self.plan.set_points.iter().zip(&driven.arrivals).enumerate() {
            let stop = if point.stop { ", stop" } else { "" };
            let place = format!("({}, {}) at {} m/s, {} rad/s{stop}", point.x, point.y, point.v, point.omega);
            let (when, miss) = match arrival {
                Arrival::Reached { t, miss_m } => (format!("{t:.2} s"), *miss_m),
                Arrival::Stuck { t, distance_m } => (format!("gave up, {t:.2} s"), *distance_m),
                Arrival::Pending => {
                    let pose = driven.belief.pose;
                    ("not reached".to_owned(), (point.x - pose.x).hypot(point.y - pose.y))
                }
            };
            table.row([(number + 1).to_string(), place, when, format!("{:.0} mm", 1e3 * miss)]);
        }
        text += &table.render();
        let outputs = match &driven.switched_off {
            Ok(()) => "outputs off".to_owned(),
            Err(fault) => format!("the watchdog switches off: {fault}"),
        };
        text.push('\n');
        text += &entry("ended", &format!("{} after {:.2} s, {outputs}", self.ending(), driven.t));
        if let Some(stands) = self.stands {
            let pose = driven.belief.pose;
            let off = (stands.x - pose.x).hypot(stands.y - pose.y);
            let place = format!("({:.3}, {:.3}) m by its own belief, in truth {:.0} mm off", pose.x, pose.y, 1e3 * off);
            text += &entry("stands", &place);
        }
        let [min, mean, max] = driven.latency.min_mean_max_us();
        let _ =
            writeln!(text, "ticks    {} seen, {} unseen, {} read again", driven.ticks, driven.unseen, driven.reread);
        let _ = writeln!(text, "wake-up  {min:.0} / {mean:.0} / {max:.0} us, {} missed", driven.latency.missed);
        if let Some(recorded) = self.recorded {
            let lost = if recorded.lost > 0 { format!(", {} lost", recorded.lost) } else { String::new() };
            let _ = writeln!(text, "recorded {}: {} ticks{lost}", recorded.file.display(), recorded.ticks);
        }
        if let Some(file) = &self.robot_file {
            let _ = writeln!(text, "robot    {file}");
        }
        for remark in self.remarks.iter().chain(&self.late_remarks()) {
            text += &entry("note", remark);
        }
        text
    }

    fn ending(&self) -> &'static str {
        match &self.driven.ending {
            Ending::Finished => "at rest",
            Ending::TimeLimit => "at the time limit",
            Ending::Stopped => "stopped on request",
            Ending::Fault(_) => "with a fault",
        }
    }

    fn late_remarks(&self) -> Vec<String> {
        let gone = self.driven.source_gone.map(|since| {
            format!("the camera was silent from {since:.2} s on; the pose since then is odometry's alone")
        });
        let refused = (self.driven.refused > 0)
            .then(|| format!("the card refused {} commits by their checksum; each was sent anew", self.driven.refused));
        let lost = (self.driven.lost > 0).then(|| match self.driven.lost {
            1 => "once the robot did not know well enough where it was, stopped and looked round".to_owned(),
            times => format!("{times} times the robot did not know well enough where it was, stopped and looked round"),
        });
        let stood = self.driven.stood;
        let stood = stood.is_notable().then(|| format!("cleared before arming: {stood}"));
        stood.into_iter().chain(gone).chain(lost).chain(refused).collect()
    }

    fn json(&self) -> Value {
        let driven = self.driven;
        let arrivals = self.plan.set_points.iter().zip(&driven.arrivals).map(|(point, arrival)| {
            let (state, t, off) = match arrival {
                Arrival::Reached { t, miss_m } => ("reached", Some(*t), Some(*miss_m)),
                Arrival::Stuck { t, distance_m } => ("stuck", Some(*t), Some(*distance_m)),
                Arrival::Pending => ("pending", None, None),
            };
            json!({ "x": point.x, "y": point.y, "v": point.v, "omega": point.omega, "stop": point.stop,
                    "state": state, "t_s": t, "off_m": off })
        });
        let [min, mean, max] = driven.latency.min_mean_max_us();
        let ended = match &driven.ending {
            Ending::Finished => "finished",
            Ending::TimeLimit => "time-limit",
            Ending::Stopped => "stopped",
            Ending::Fault(_) => "fault",
        };
        json!({
            "card": self.name, "clock_hz": self.clock_hz, "set_points": arrivals.collect::<Vec<_>>(),
            "ended": ended,
            "fault": match &driven.ending { Ending::Fault(fault) => Some(fault.to_string()), _ => None },
            "cleared_faults": driven.stood.faults, "cleared_encoder_errors": driven.stood.encoder_errors,
            "cleared_stalls": driven.stood.stalls,
            "outputs_off": driven.switched_off.is_ok(), "t_s": driven.t,
            "pose": [driven.belief.pose.x, driven.belief.pose.y, driven.belief.pose.theta],
            "stands": self.stands.map(|pose| [pose.x, pose.y, pose.theta]),
            "ticks": driven.ticks, "unseen": driven.unseen, "read_again": driven.reread, "refused": driven.refused,
            "looked_round": driven.lost,
            "wake_up_us": { "min": min, "avg": mean, "max": max }, "missed": driven.latency.missed,
            "recorded": self.recorded.map(|r| json!({ "file": r.file.to_string_lossy(), "ticks": r.ticks, "lost": r.lost })),
            "remarks": self.remarks.iter().cloned().chain(self.late_remarks()).collect::<Vec<_>>(),
        })
    }
}
