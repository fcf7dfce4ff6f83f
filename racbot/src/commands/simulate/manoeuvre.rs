//! `racbot simulate --manoeuvre`: runs that show particular effects, for a data set.

use crate::terminal::progress::Progress;
use crate::terminal::{Answer, Failure, Table, Target, wrapped};
use model::effects::Applied;
use model::manoeuvre::{Manoeuvre, simulate};
use runs::error::InputError;
use runs::frames::Pose;
use runs::robot::Robot;
use serde_json::json;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// As the command line says it; what is none is told which there are.
#[derive(Clone, Copy, Debug)]
pub(super) struct Name(pub(super) Manoeuvre);

impl std::str::FromStr for Name {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let known = || Manoeuvre::ALL.map(Manoeuvre::name).join(", ");
        Manoeuvre::from_name(text).map(Self).ok_or_else(|| format!("no such manoeuvre; there are {}", known()))
    }
}

/// Runs of one manoeuvre.
pub(super) struct Runs<'a> {
    pub(super) manoeuvre: Manoeuvre,
    /// Controller's belief; its effects belong to the file, not to the belief.
    pub(super) believed: &'a Robot,
    /// The robot that is driven, hidden effects included.
    pub(super) actual: &'a Robot,
    pub(super) camera: bool,
    pub(super) start: Pose,
    pub(super) seed: u64,
    /// How often it is driven, each time from another heading.
    pub(super) times: u32,
    pub(super) out: &'a Path,
    pub(super) name: &'a str,
    pub(super) target: Target,
}

impl Runs<'_> {
    pub(super) fn drive(&self) -> Result<Answer, Failure> {
        let believed = Robot { support: self.manoeuvre.support(), ..self.believed.clone() };
        let applied = Applied::of(&Robot { support: self.manoeuvre.support(), ..self.actual.clone() });
        let file = self.out.join("robot.toml");
        let name = |k: u32| if self.times == 1 { self.name.to_owned() } else { format!("{}_{}", self.name, k + 1) };
        let path = |k: u32| self.out.join(format!("{}.csv", name(k)));
        self.target.check_free((0..self.times).map(path))?;
        let written = write_robot(&file, &believed, self.target)?;
        let progress = Progress::new(format!("driving {}", self.manoeuvre.name()), u64::from(self.times));
        let mut table = Table::new(1, &["run", "seconds", "ticks", "frames"]);
        let mut files: Vec<PathBuf> = Vec::new();
        for k in 0..self.times {
            // The golden angle: no two runs cross the field alike.
            let turned = Pose { theta: self.start.theta + 2.399_963 * f64::from(k), ..self.start };
            let mut run = simulate(self.manoeuvre, &applied, &believed, turned, self.seed + u64::from(k))
                .map_err(|error| Failure::data(format!("the robot's wheels: {error}")))?;
            if !self.camera {
                run.camera.clear();
                run.has_camera = false;
            }
            let path = path(k);
            run.save(&path, self.target.existing())?;
            let figures = [format!("{:.1}", run.duration_s()), run.len().to_string(), run.camera.len().to_string()];
            table.row([name(k)].into_iter().chain(figures));
            files.push(path);
            progress.at(u64::from(k + 1));
        }
        drop(progress);
        let mut text = format!("{}: {}\n\n{}\n", self.manoeuvre.name(), self.manoeuvre.purpose(), table.render());
        if !applied.unsupported.is_empty() {
            text += &wrapped(&format!("not simulated: the effects {}", applied.unsupported.join(", ")), 2);
        }
        let robot = if written { "and robot.toml" } else { "beside the robot.toml that was there" };
        let _ = writeln!(text, "{}", wrapped(&format!("written to {} {robot}", self.out.display()), 2).trim_end());
        let json = json!({
            "manoeuvre": self.manoeuvre.name(),
            "files": files.iter().map(|file| file.to_string_lossy()).collect::<Vec<_>>(),
            "robot": file.to_string_lossy(),
            "unsupported": applied.unsupported,
        });
        Ok(Answer { text, json, wrong: None })
    }
}

/// Writes the robot's file, unless it is there already; another robot's is not touched.
fn write_robot(file: &Path, believed: &Robot, target: Target) -> Result<bool, Failure> {
    if !file.exists() {
        target.save(file, &believed.to_toml())?;
        return Ok(true);
    }
    if Robot::load(file)? == *believed {
        return Ok(false);
    }
    let what = "describes another robot than the one that is to drive";
    let hint = "give its folder another name with --out, or this file with --robot";
    Err(InputError::new(file, what, hint).into())
}
