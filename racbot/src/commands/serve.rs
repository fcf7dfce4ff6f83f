//! `racbot serve`

use super::record::{Kept, Record};
use super::start::Start;
use crate::card::{CardOptions, Pace, ReadyCard};
use crate::terminal::{Answer, Failure, Target, entry, positive};
use clap::Args;
use driver::Board;
use driver::drive::{Ending, NoSource, Plan, PoseSource};
use driver::pci::Use;
use driver::realtime::{Rights, stop_on_signals};
use driver::recording::logged_robot;
use serde_json::json;
use ssl::card::{Link, Served};
use ssl::front::Team;
use ssl::server::{Addresses, Sockets, Traffic};
use std::io::ErrorKind;
use std::net::{Ipv4Addr, SocketAddr};
use std::path::{Path, PathBuf};

/// Options of `serve`.
#[derive(Args, Debug)]
#[command(after_help = "Vision is multicast. On the loopback interface, where it is sent by default, a client has to \
join by that interface (127.0.0.1); software that joins by the default one sees it with --interface and the address of \
the network card, or with --vision-to and its own port. docs/book/src/serve.md shows both.")]
pub(crate) struct Options {
    /// Robot: FILE for all, blue=FILE for a team, blue:3=FILE for one; its effects are what the robot does beyond what
    /// its own controller knows [default: the paper's]
    #[arg(long, value_name = "[WHO=]FILE")]
    robot: Vec<Which>,

    /// Address of the interface to listen on and send vision from; 0.0.0.0 for all
    #[arg(long, value_name = "ADDR", default_value_t = Ipv4Addr::LOCALHOST)]
    interface: Ipv4Addr,

    /// UDP ports of control, the blue and the yellow team; 0 for any free one
    #[arg(long, value_name = "C,B,Y", default_value = "10300,10301,10302")]
    ports: Ports,

    #[cfg(feature = "simulation")]
    #[command(flatten)]
    simulated: Simulated,

    #[command(flatten)]
    card: CardOptions,

    /// With --card: team and number of its robot
    #[arg(long, value_name = "TEAM:ID", default_value = "blue:0")]
    #[cfg_attr(feature = "simulation", arg(requires = "card"))]
    as_robot: Who,

    /// With --card: where the robot stands, x and y in metres, heading of the body's x axis in degrees
    #[arg(long, value_name = "X,Y,DEG", default_value = "0,0,0", allow_hyphen_values = true)]
    #[cfg_attr(feature = "simulation", arg(requires = "card"))]
    start: Start,

    /// With --card: record the drive, .csv or .mcap; robot.toml is put beside it
    #[arg(long, value_name = "FILE")]
    #[cfg_attr(feature = "simulation", arg(requires = "card"))]
    record: Option<PathBuf>,

    #[command(flatten)]
    target: Target,

    /// With --card: end at the first fault; without, the robot rests, says so, and is armed again once nobody has asked
    /// for motion for half a second. An emergency stop always ends it
    #[arg(long)]
    #[cfg_attr(feature = "simulation", arg(requires = "card"))]
    stay_off: bool,

    /// With --card: real-time priority asked for
    #[arg(long, value_name = "N", default_value_t = 80, value_parser = clap::value_parser!(u8).range(1..=99))]
    #[cfg_attr(feature = "simulation", arg(requires = "card"))]
    priority: u8,

    /// End after so many seconds [default: when interrupted]
    #[arg(long, value_name = "S")]
    seconds: Option<f64>,
}

/// Options of the simulated field.
#[cfg(feature = "simulation")]
#[derive(Args, Debug)]
struct Simulated {
    /// Blue robots
    #[arg(long, value_name = "N", conflicts_with = "card", default_value_t = 6, value_parser = clap::value_parser!(u32).range(0..=16))]
    blue: u32,

    /// Yellow robots
    #[arg(long, value_name = "N", conflicts_with = "card", default_value_t = 6, value_parser = clap::value_parser!(u32).range(0..=16))]
    yellow: u32,

    /// Field of division a or b
    #[arg(long, conflicts_with = "card", value_enum, default_value_t)]
    field: Division,

    #[command(flatten)]
    hidden: super::options::Hidden,

    /// Send vision there too, as to 127.0.0.1:10006
    #[arg(long, value_name = "ADDR:PORT", conflicts_with = "card")]
    vision_to: Vec<SocketAddr>,

    /// Multicast group and port of vision; `none` for none
    #[arg(long, value_name = "ADDR:PORT", conflicts_with = "card", default_value = "224.5.23.2:10020")]
    vision: String,

    /// Frames of vision a second
    #[arg(long, value_name = "HZ", conflicts_with = "card", default_value_t = 60.0)]
    vision_hz: f64,

    /// Let time pass a frame at a time, after every message of this team: the same messages make the same frames
    #[arg(long, value_name = "TEAM", conflicts_with = "card")]
    lock_step: Option<Team>,

    /// Seed of the cameras' noise
    #[arg(long, conflicts_with = "card", default_value_t = 1)]
    seed: u64,
}

/// A field's size.
#[cfg(feature = "simulation")]
#[derive(Clone, Copy, Debug, Default, clap::ValueEnum)]
enum Division {
    /// 12 m by 9 m
    A,
    /// 9 m by 6 m
    #[default]
    B,
}

/// A robot's team and number.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Who(Team, u32);

impl std::str::FromStr for Who {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (team, id) = text.split_once(':').ok_or_else(|| format!("'{text}' is not as blue:3"))?;
        let id = id.parse().ok().filter(|id| *id < 16).ok_or_else(|| format!("'{id}' is no number from 0 to 15"))?;
        Ok(Self(team.parse()?, id))
    }
}

/// Whose robot a file describes.
#[derive(Clone, Debug)]
struct Which {
    team: Option<Team>,
    id: Option<u32>,
    file: PathBuf,
}

impl std::str::FromStr for Which {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let Some((who, file)) = text.split_once('=') else {
            return Ok(Self { team: None, id: None, file: text.into() });
        };
        let file = file.into();
        if who.contains(':') {
            let Who(team, id) = who.parse()?;
            return Ok(Self { team: Some(team), id: Some(id), file });
        }
        Ok(Self { team: Some(who.parse()?), id: None, file })
    }
}

/// Three ports.
#[derive(Clone, Copy, Debug)]
struct Ports([u16; 3]);

impl std::str::FromStr for Ports {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let ports: Option<Vec<u16>> = text.split(',').map(|port| port.trim().parse().ok()).collect();
        let ports = ports.and_then(|ports| <[u16; 3]>::try_from(ports).ok());
        ports.map(Self).ok_or_else(|| format!("'{text}' is not three ports, as 10300,10301,10302"))
    }
}

impl Options {
    pub(crate) fn run(&self) -> Result<Answer, Failure> {
        if let Some(seconds) = self.seconds {
            positive("--seconds", seconds, 1e9)?;
        }
        #[cfg(feature = "simulation")]
        if self.card.card.is_none() {
            return self.simulate();
        }
        self.drive()
    }

    fn open(&self, vision: &[SocketAddr]) -> Result<Sockets, Failure> {
        let Ports([control, blue, yellow]) = self.ports;
        let addresses = Addresses { interface: self.interface, control, blue, yellow, vision: vision.to_vec() };
        let about = |error: std::io::Error| {
            let hint = match error.kind() {
                ErrorKind::AddrInUse => "another simulator? see --ports",
                ErrorKind::AddrNotAvailable => "--interface is an address of this machine; `ip address` lists them",
                ErrorKind::PermissionDenied => "ports below 1024 are root's: see --ports",
                _ => "see --interface and --ports",
            };
            Failure::data(format!("{error}; {hint}"))
        };
        let sockets = Sockets::open(&addresses).map_err(about)?;
        let [control, blue, yellow] = sockets.local().map_err(about)?;
        let vision: Vec<String> = vision.iter().map(ToString::to_string).collect();
        let vision = if vision.is_empty() { "none".to_owned() } else { vision.join(", ") };
        eprintln!("serving: control {control}, blue {blue}, yellow {yellow}, vision {vision}; Ctrl-C ends it");
        Ok(sockets)
    }

    /// The file of a robot: the last that names it, its team, or all.
    fn file(&self, team: Team, id: u32) -> Option<&Path> {
        let fits = |which: &&Which| which.team.is_none_or(|t| t == team) && which.id.is_none_or(|i| i == id);
        let rank = |which: &Which| u8::from(which.team.is_some()) + u8::from(which.id.is_some());
        self.robot.iter().filter(fits).max_by_key(|which| rank(which)).map(|which| which.file.as_path())
    }

    /// A real robot, or the built-in card in its place.
    fn drive(&self) -> Result<Answer, Failure> {
        #[cfg(feature = "simulation")]
        if self.simulated.hidden.is_given() {
            return Err(Failure::usage("--hidden and --skew-deg are for simulated robots: leave out --card"));
        }
        let Who(team, id) = self.as_robot;
        let robot = super::driven::robot(self.file(team, id))?;
        let recorder = Record { file: self.record.as_deref(), target: self.target };
        recorder.check()?;
        let plan =
            Plan { start: self.start.0, limit_s: self.seconds.unwrap_or(f64::INFINITY), ..Plan::new(&robot, &[]) };
        let ready = self.card.ready(Use::Drive, &robot, Pace::Real)?;
        ready.stand(self.start.0);
        let ReadyCard { name, registers, clock_hz, clock, source, .. } = ready;
        let about = |what: &dyn std::fmt::Display| Failure::data(format!("{name}: {what}"));
        let scale = plan.scale(clock_hz).map_err(|error| about(&error))?;
        let logged = logged_robot(&plan.believed(), &scale, &plan.settings);
        let mut recording = recorder.start(&logged, source.is_some())?;
        let stop = stop_on_signals().map_err(Failure::data)?;
        let mut sockets = self.open(&[])?;
        let rights = Rights::acquire(self.priority);
        for remark in rights.remarks() {
            eprintln!("{remark}");
        }
        let source: Box<dyn PoseSource> = source.unwrap_or_else(|| Box::new(NoSource));
        let (board, recorded) = (Board::new(registers), recording.as_mut());
        let link = Link { board, clock_hz, clock, source, recording: recorded, fault_ends: self.stay_off };
        let Served { driven, faults } =
            ssl::card::drive(&plan, (team, id), link, &mut sockets, &stop).map_err(|error| about(&error))?;
        let Kept { run: recorded, robot: robot_file, failed } = recorder.finish(recording, &logged);
        let traffic = sockets.traffic();
        let (ended, wrong) = match &driven.ending {
            Ending::Fault(fault) => ("with a fault", Some(format!("{name}: {fault}"))),
            Ending::TimeLimit => ("at the time limit", None),
            _ => ("stopped on request", None),
        };
        let wrong = wrong.or(failed);
        let mut text = entry("ended", &format!("{ended} after {:.2} s", driven.t));
        text += &entry("ticks", &format!("{} seen, {} unseen", driven.ticks, driven.unseen));
        for (t, fault) in &faults {
            text += &entry("rested", &format!("after {t:.2} s: {fault}"));
        }
        text += &heard(&traffic);
        if let Some(recorded) = &recorded {
            text += &entry("recorded", &format!("{}: {} ticks", recorded.file.display(), recorded.ticks));
        }
        if let Some(file) = &robot_file {
            text += &entry("robot", file);
        }
        let json = json!({
            "card": name, "t_s": driven.t, "ticks": driven.ticks, "unseen": driven.unseen, "ended": ended,
            "rested": faults.iter().map(|(t, fault)| json!({ "t_s": t, "fault": fault })).collect::<Vec<_>>(),
            "outputs_off": driven.switched_off.is_ok(), "heard": traffic.heard, "refused": traffic.refused,
            "recorded": recorded.map(|r| json!({ "file": r.file.to_string_lossy(), "ticks": r.ticks, "lost": r.lost })),
        });
        Ok(Answer { text, json, wrong })
    }
}

fn heard(traffic: &Traffic) -> String {
    let refused =
        if traffic.refused > 0 { format!(", {} beyond their senders' rate", traffic.refused) } else { String::new() };
    entry("messages", &format!("{} heard{refused}", traffic.heard))
}

#[cfg(feature = "simulation")]
impl Options {
    fn simulate(&self) -> Result<Answer, Failure> {
        use driver::realtime::{Clock, MonotonicClock};
        use ssl::server::{Served, run, run_in_lock_step};
        use std::sync::atomic::AtomicBool;
        use std::time::Duration;

        let mut world = self.world()?;
        let mut vision = self.simulated.vision_to.clone();
        if self.simulated.vision != "none" {
            let group = self.simulated.vision.parse();
            vision.push(group.map_err(|_| {
                Failure::usage(format!("--vision: '{}' is no address with a port", self.simulated.vision))
            })?);
        }
        let stop = stop_on_signals().map_err(Failure::data)?;
        let mut sockets = self.open(&vision)?;
        let stop: &AtomicBool = &stop;
        let limit = self.seconds.map(Duration::from_secs_f64);
        let mut told = 0;
        let progress = |served: &Served| {
            // Lost time is said when it happens.
            if served.lost > told {
                eprintln!(
                    "at {:.1} s: {} ms left out, this machine is too slow",
                    served.simulated_s,
                    served.lost - told
                );
                told = served.lost;
            }
        };
        let mut clock = MonotonicClock;
        let begun = clock.now();
        let served = match self.simulated.lock_step {
            Some(team) => run_in_lock_step(&mut world, &mut sockets, team, &mut clock, stop, limit, progress),
            None => run(&mut world, &mut sockets, &mut clock, stop, limit, progress),
        };
        let took = (clock.now() - begun).as_secs_f64();
        let mut text = entry("time", &format!("{:.1} s simulated in {took:.1} s", served.simulated_s));
        text += &entry("ticks", &format!("{} of a millisecond, {} lost", served.steps, served.lost));
        text += &heard(&served.traffic);
        text += &entry("vision", &format!("{} frames", served.traffic.frames));
        let json = json!({
            "simulated_s": served.simulated_s, "steps": served.steps, "lost": served.lost,
            "latest_s": served.latest_s, "heard": served.traffic.heard, "refused": served.traffic.refused,
            "frames": served.traffic.frames, "unsent": served.traffic.unsent,
        });
        Ok(Answer { text, json, wrong: None })
    }

    fn world(&self) -> Result<ssl::world::World, Failure> {
        use model::effects::Applied;
        use ssl::field::Field;
        use ssl::robot::Kind;
        use ssl::world::{Options as Beginning, World};
        use std::time::{SystemTime, UNIX_EPOCH};

        let simulated = &self.simulated;
        positive("--vision-hz", simulated.vision_hz, 1_000.0)?;
        let mut remarks = std::collections::BTreeSet::new();
        let mut kind = |file: Option<&Path>| -> Result<Kind, Failure> {
            let (robot, remark) = super::driven::simulated(file)?;
            remarks.extend(remark);
            let believed = Kind::of(&robot);
            let actual = simulated.hidden.robot(&robot)?;
            remarks.extend(super::simulate::not_shown(&Applied::of(&actual)));
            Ok(Kind { actual, ..believed })
        };
        let mut robots = Vec::new();
        for (team, count) in [(Team::Blue, simulated.blue), (Team::Yellow, simulated.yellow)] {
            for id in 0..count {
                robots.push((team, id, kind(self.file(team, id))?));
            }
        }
        let everybody = self.robot.iter().find(|which| which.team.is_none());
        let newcomer = kind(everybody.map(|which| which.file.as_path()))?;
        remarks.iter().for_each(|remark| eprintln!("{remark}"));
        // In lock-step nothing depends on when it is.
        let epoch = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0.0, |since| since.as_secs_f64());
        let epoch_s = if simulated.lock_step.is_some() { 0.0 } else { epoch };
        let field = match simulated.field {
            Division::A => Field::A,
            Division::B => Field::B,
        };
        let options =
            Beginning { field, robots, newcomer, vision_hz: simulated.vision_hz, epoch_s, seed: simulated.seed };
        World::new(options).map_err(Failure::data)
    }
}
