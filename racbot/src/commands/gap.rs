//! `racbot gap`

use super::check::Despite;
use super::options::known_effects;
use crate::terminal::progress::Progress;
use crate::terminal::{Answer, Failure, Target, wrapped};
use clap::Args;
use gap::catalogue::{Description, descriptions};
use gap::user::UserEffect;
use links::effect::Effect;
use runs::error::{InputError, nearest};
use runs::output::{Existing, write_whole};
use runs::robot::Robot;
use serde_json::json;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Options of `gap`.
#[derive(Args, Debug)]
pub(crate) struct Options {
    /// Folder with robot.toml and runs (*.csv); with --undo it may be left out
    #[arg(value_name = "DATASET", required_unless_present_any = ["undo", "list"])]
    data_set: Option<PathBuf>,

    /// Another robot.toml than the data set's own; it may carry effects
    #[arg(long, value_name = "FILE")]
    robot: Option<PathBuf>,

    /// An effect of your own, as an expression in TOML, to be fitted and judged like the built-in ones; may be
    /// given several times. See data/effects/air-drag.toml
    #[arg(long, value_name = "FILE")]
    effect: Vec<PathBuf>,

    /// Folder for report.html, gap.json and the robot.toml with the named effects [default: out/gap, or the first
    /// free of out/gap-2 ...]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,

    #[command(flatten)]
    target: Target,

    #[command(flatten)]
    despite: Despite,

    /// Take an effect out of a robot.toml (--robot, or that of the data set) again; analyse nothing
    #[arg(long, value_name = "NAME")]
    undo: Option<String>,

    /// List the catalogue of effects, or describe one; analyse nothing
    #[arg(long, value_name = "NAME", num_args = 0..=1, conflicts_with_all = ["undo", "data_set"])]
    list: Option<Option<String>>,
}

impl Options {
    pub(crate) fn run(&self) -> Result<Answer, Failure> {
        if let Some(name) = &self.undo {
            return self.undo(name);
        }
        if let Some(name) = &self.list {
            return list(name.as_deref());
        }
        let Some(folder) = &self.data_set else { return Err(Failure::usage("<DATASET> is missing")) };
        let set = super::check::open(folder, self.robot.as_deref())?;
        let own = self.own()?;
        known_effects(&super::check::robot_file(folder, self.robot.as_deref()), &set.robot, Some(&own))?;
        let checked = super::check::first_stage(folder, &set, self.despite)?;
        let out = self.target.place(self.out.as_deref(), "out/gap");
        self.target.check_free(["gap.json", "report.html", "robot.toml"].map(|name| out.join(name)))?;
        let bar = Progress::new("looking for the missing effect", 100);
        let progress: gap::options::Progress = Box::new(move |share| bar.at((100.0 * share).round() as u64));
        let options = gap::Options {
            robot_file: self.robot.clone(),
            progress: Some(progress),
            effects: own,
            mistakes: checked.mistakes.clone(),
            ..gap::Options::default()
        };
        let analysis = gap::analyse_logs(&set, &options).map_err(|error| Failure::about(folder, error))?;
        drop(options);
        analysis.save(&out, self.target.existing()).map_err(Failure::data)?;
        let text =
            format!("{}{}\nreport in {}\n", checked.text(), analysis.terminal_summary().trim_end(), out.display());
        Ok(Answer { text, json: analysis.to_json(), wrong: None })
    }

    /// The user's own effects.
    fn own(&self) -> Result<Vec<Arc<dyn Effect>>, Failure> {
        let mut effects: Vec<Arc<dyn Effect>> = Vec::new();
        for file in &self.effect {
            let effect = UserEffect::load(file).map_err(Failure::excerpt)?;
            if effects.iter().any(|e| e.name() == effect.name()) {
                return Err(Failure::about(file, format!("name: a second effect is called {}", effect.name())));
            }
            effects.push(Arc::new(effect));
        }
        Ok(effects)
    }

    fn undo(&self, name: &str) -> Result<Answer, Failure> {
        let of_set = self.data_set.as_ref().map(|folder| folder.join("robot.toml"));
        let Some(file) = self.robot.clone().or(of_set) else {
            return Err(Failure::usage("--undo: say which robot.toml, with --robot or a data set"));
        };
        let robot = Robot::load_partial(&file)?;
        let Some(without) = gap::undo(&robot, name) else {
            return Err(unknown_effect(&file, &robot, name).into());
        };
        let text = std::fs::read_to_string(&file).map_err(|error| InputError::io(&file, &error))?;
        // An edit of this very file, which was asked for.
        write_whole(&file, Robot::edited(&text, &without.effects, &file)?.as_bytes(), Existing::Replace)?;
        let text = wrapped(&format!("{name} is taken out of {}", file.display()), 2);
        Ok(Answer { text, json: json!({ "removed": name, "robot": file.to_string_lossy() }), wrong: None })
    }
}

/// The catalogue in lines, or an effect's own page.
fn list(name: Option<&str>) -> Result<Answer, Failure> {
    let all = descriptions();
    let Some(name) = name else {
        let line = |d: &Description| {
            format!("{} ({})\n{}", d.name, d.links[0].name(), wrapped(&format!("- {}", d.short()), 2))
        };
        let text: String = all.iter().map(line).collect();
        return Ok(Answer {
            text,
            json: json!({ "effects": all.iter().map(to_json).collect::<Vec<_>>() }),
            wrong: None,
        });
    };
    let Some(found) = all.iter().find(|d| d.name == name) else {
        let names: Vec<&str> = all.iter().map(|d| d.name.as_str()).collect();
        let hint = nearest(name, &names).map_or_else(String::new, |near| format!("; did you mean {near}?"));
        return Err(Failure::usage(format!("--list: the catalogue has no effect {name}{hint}")));
    };
    Ok(Answer { text: found.markdown(), json: to_json(found), wrong: None })
}

fn to_json(d: &Description) -> serde_json::Value {
    let [always, square] = d.twins();
    json!({
        "name": d.name, "links": d.links.iter().map(|l| l.name()).collect::<Vec<_>>(), "equation": d.equation,
        "reference": d.reference, "simulated": d.simulated,
        "parameters": d.parameters.iter().map(|p| json!({
            "name": p.name, "unit": p.unit, "bounds": p.bounds, "material": p.material,
        })).collect::<Vec<_>>(),
        "twins": { "always": always, "in_a_square": square },
        "measurement": d.measurement.as_ref().map(|(how, minutes)| json!({ "how": how, "minutes": minutes })),
    })
}

fn unknown_effect(file: &Path, robot: &Robot, name: &str) -> InputError {
    let names: Vec<&str> = robot.effects.iter().map(|effect| effect.name.as_str()).collect();
    let hint = if names.is_empty() { "it carries none".to_owned() } else { format!("it carries {}", names.join(", ")) };
    InputError::new(file, format!("carries no effect {name}"), hint)
}
