//! `racbot check`, and the first stage of what fits logs

use crate::terminal::{Answer, Failure, wrapped};
use clap::Args;
use model::setup::{Mistake, mistakes};
use runs::Logs;
use runs::robot::Robot;
use serde_json::json;
use std::path::{Path, PathBuf};

/// Options of `check`.
#[derive(Args, Debug)]
pub(crate) struct Options {
    /// Folder with robot.toml and runs (*.csv, *.mcap)
    #[arg(value_name = "DATASET")]
    data_set: PathBuf,

    /// Another robot.toml than the data set's own
    #[arg(long, value_name = "FILE")]
    robot: Option<PathBuf>,
}

/// Whether a data set that is set up wrong is looked at all the same.
#[derive(Args, Clone, Copy, Debug, Default)]
pub(super) struct Despite {
    /// Go on although the data set is set up wrong (see `racbot check`): no name and no size that is then found can be
    /// trusted
    #[arg(long)]
    despite_mistakes: bool,
}

impl Despite {
    pub(super) fn mistakes(self) -> bool {
        self.despite_mistakes
    }
}

/// What the first stage says of a data set that goes on.
pub(super) struct Checked {
    /// What an analysis may name by itself.
    hints: Vec<String>,
    /// Mistakes that were to be passed over.
    pub(super) mistakes: Vec<String>,
}

impl Checked {
    /// For the terminal.
    pub(super) fn text(&self) -> String {
        let hints = self.hints.iter().map(|hint| wrapped(&format!("hint: {hint}"), 6));
        let wrong = self.mistakes.iter().map(|mistake| wrapped(&format!("set up wrong: {mistake}"), 2));
        let warned = (!self.mistakes.is_empty()).then(|| {
            let text =
                "Gone on with --despite-mistakes: until that is mended, no name and no size below can be trusted.";
            wrapped(text, 2)
        });
        hints.chain(wrong).chain(warned).collect()
    }
}

/// Opens a data set.
pub(super) fn open(folder: &Path, robot: Option<&Path>) -> Result<Logs<'static>, Failure> {
    Ok(match robot {
        None => Logs::open(folder)?,
        Some(file) => Logs::open_as(folder, Robot::load_partial(file)?)?,
    })
}

/// The robot's file of a data set, or another.
#[cfg(feature = "simulation")]
pub(super) fn robot_file(folder: &Path, robot: Option<&Path>) -> PathBuf {
    robot.map_or_else(|| folder.join("robot.toml"), Path::to_owned)
}

impl Options {
    pub(crate) fn run(&self) -> Result<Answer, Failure> {
        let set = open(&self.data_set, self.robot.as_deref())?;
        // The robot's own binary, which simulates nothing, has no catalogue.
        #[cfg(feature = "simulation")]
        super::options::known_effects(&robot_file(&self.data_set, self.robot.as_deref()), &set.robot, None)?;
        let found = mistakes(&set);
        let mut text = String::new();
        for note in set.notes() {
            text += &wrapped(&format!("note: {note}"), 6);
        }
        for mistake in &found {
            text += &wrapped(&mistake.sentence(), 2);
        }
        if found.is_empty() {
            let ticks: usize = set.logs.iter().map(runs::Log::len).sum();
            text += &wrapped(&format!("no set-up mistake in {} logs of {ticks} ticks", set.logs.len()), 2);
        }
        let json = json!({
            "mistakes": found.iter().map(to_json).collect::<Vec<_>>(),
            "notes": set.notes(),
            "runs": set.logs.iter().map(|log| log.name.clone()).collect::<Vec<_>>(),
        });
        let wrong = (!found.is_empty()).then(|| match found.len() {
            1 => format!("{}: 1 set-up mistake", self.data_set.display()),
            n => format!("{}: {n} set-up mistakes", self.data_set.display()),
        });
        Ok(Answer { text, json, wrong })
    }
}

fn to_json(mistake: &Mistake) -> serde_json::Value {
    json!({
        "kind": mistake.kind,
        "column": mistake.column,
        "what": mistake.what,
        "write": mistake.remedy,
    })
}

/// Refuses a data set that is set up wrong, unless that is to be passed over.
pub(super) fn first_stage(folder: &Path, set: &Logs, despite: Despite) -> Result<Checked, Failure> {
    let (hints, wrong): (Vec<Mistake>, Vec<Mistake>) = mistakes(set).into_iter().partition(|m| m.nameable);
    let said = |mistakes: &[Mistake]| mistakes.iter().map(Mistake::sentence).collect::<Vec<_>>();
    let checked = Checked { hints: said(&hints), mistakes: said(&wrong) };
    if !wrong.is_empty() && !despite.mistakes() {
        let what = checked.mistakes.join("; also ");
        return Err(Failure::about(folder, format!("set up wrong: {what} (--despite-mistakes goes on nevertheless)")));
    }
    Ok(checked)
}
