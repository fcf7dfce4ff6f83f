//! Logs of several axes, such as an arm's, as a data set of each: its motor, gear and load are its own.

use std::path::{Path, PathBuf};

use runs::Run;
use serde_json::json;

use crate::terminal::{Answer, Failure, Target};

/// Writes beside `file` a folder of each axis, with a robot file of its own and its columns of the logs.
pub(super) fn apart(file: &Path, text: &str, logs: &[PathBuf], axes: usize, target: Target) -> Result<Answer, Failure> {
    let beside = file.parent().unwrap_or_else(|| Path::new(""));
    let folder = |axis: usize| beside.join(format!("axis_{}", axis + 1));
    let log_name = |log: &Path| PathBuf::from(log.file_stem().unwrap_or_default()).with_extension("csv");
    let files = |axis: usize| logs.iter().map(move |log| folder(axis).join(log_name(log)));
    target.check_free((0..axes).flat_map(|axis| files(axis).chain([folder(axis).join("robot.toml")])))?;
    for log in logs {
        let run = Run::read(log)?;
        for axis in 0..axes {
            run.axis(axis).save(folder(axis).join(log_name(log)), target.existing())?;
        }
    }
    for axis in 0..axes {
        target.save(&folder(axis).join("robot.toml"), text)?;
    }
    let [first, last] = [0, axes - 1].map(|axis| folder(axis).display().to_string());
    let said = format!(
        "{first} to {last}: the {axes} axes of the logs, each a data set of its own with its columns of {} log{}\n\
         write into the robot.toml of each what its motor, gear and load are; then racbot check {first}\n",
        logs.len(),
        if logs.len() == 1 { "" } else { "s" },
    );
    let folders: Vec<String> = (0..axes).map(|axis| folder(axis).to_string_lossy().into_owned()).collect();
    Ok(Answer { text: said, json: json!({ "axes": folders }), wrong: None })
}
