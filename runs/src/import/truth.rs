//! The table `[truth]` of a map: a second file, in which another machine saw the robot.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::Deserialize;

use super::columns::Source;
use super::frame::Frame;
use super::reading::Reading;
use super::time::Time;
use crate::error::InputError;

/// The table as its TOML has it.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Text {
    /// Its name, from the log's folder; see [`filled`].
    file: Option<String>,
    #[serde(default)]
    clock: Clocks,
    #[serde(default)]
    offset_s: f64,
    format: Option<String>,
    #[serde(default)]
    time: Time,
    /// Else that of the log.
    frame: Option<Frame>,
    #[serde(default)]
    columns: BTreeMap<String, Source>,
}

/// How the clocks of both files stand to each other.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Clocks {
    /// One clock.
    #[default]
    Same,
    /// Each file counts from its own start, and both began together.
    Own,
    /// Nothing is known: the motion tells.
    Match,
}

/// The second file.
#[derive(Debug, Clone)]
pub(super) struct Truth {
    file: Option<String>,
    pub(super) clock: Clocks,
    /// What is added to its times, s.
    pub(super) offset_s: f64,
    pub(super) reading: Reading,
}

impl Truth {
    /// Of a map whose log is read so.
    pub(super) fn new(text: Text, log: &Reading) -> Result<Self, InputError> {
        let Text { file, clock, offset_s, format, time, frame, columns } = text;
        let fail = |field: &str, what: &str, hint: &str| {
            Err(InputError::new(Path::new(""), what, hint).field(format!("truth.{field}")))
        };
        if let Some(name) = columns.keys().find(|name| !name.starts_with("cam_")) {
            let hint = "its columns are cam_x, cam_y and cam_theta; everything else is the log's";
            return fail(&format!("columns.{name}"), "the second file has the pose alone", hint);
        }
        if let Some(name) = log.columns.keys().find(|name| name.starts_with("cam_")) {
            let hint = "leave it out of [columns], or leave [truth] out";
            return fail("columns", &format!("the pose is in two files: {name} is in [columns], too"), hint);
        }
        if !offset_s.is_finite() || clock == Clocks::Match && offset_s != 0.0 {
            let hint = "give seconds that are added to its times, with clock = \"same\" or \"own\"";
            return fail("offset_s", "there is nothing that it could mean", hint);
        }
        if time.keep {
            return fail("time.keep", "the run has the log's time", "write it in the log's [time]");
        }
        let reading = Reading { format, time, frame: frame.unwrap_or(log.frame), columns, pose_alone: true };
        reading.check().map_err(|e| InputError { field: format!("truth.{}", e.field), ..e })?;
        Ok(Self { file, clock, offset_s, reading })
    }

    /// The file that belongs to a log.
    pub(super) fn beside(&self, log: &Path) -> Result<PathBuf, InputError> {
        let Some(pattern) = &self.file else {
            let hint = "write file = \"{stem}_mocap.csv\", from the log's folder, or name it with --truth FILE";
            let what = "the map does not say which file";
            return Err(InputError::new(Path::new(""), what, hint).field("truth.file"));
        };
        let name = filled(pattern, log).map_err(|e| e.field("truth.file"))?;
        Ok(log.parent().unwrap_or(Path::new("")).join(name))
    }
}

/// A pattern's name for a log: `{stem}` is the log's name without its ending, `{number}` the last number in it, `{folder}` the
/// name of the folder that it is in.
///
/// # Errors
/// [`InputError`] where the log has no number, or is in no folder that has a name.
pub(super) fn filled(pattern: &str, log: &Path) -> Result<String, InputError> {
    let fail = |what: String, hint: &str| Err(InputError::new(Path::new(""), what, hint));
    let stem = stem(log);
    let number = number(&stem);
    if pattern.contains(NUMBER) && number.is_none() {
        return fail(format!("{stem:?} has no number"), "use {stem}, or name the file with --truth FILE");
    }
    let folder = folder(log);
    if pattern.contains(FOLDER) && folder.is_none() {
        return fail(format!("{} is in no folder with a name", log.display()), "give the log with its folder");
    }
    let name = pattern.replace(STEM, &stem).replace(NUMBER, number.unwrap_or_default());
    Ok(name.replace(FOLDER, &folder.unwrap_or_default()))
}

/// The name of the folder of a file.
pub(super) fn folder(file: &Path) -> Option<String> {
    Some(file.parent()?.file_name()?.to_string_lossy().into_owned())
}

const STEM: &str = "{stem}";
const NUMBER: &str = "{number}";
const FOLDER: &str = "{folder}";

/// A name without its endings.
pub(super) fn stem(file: &Path) -> String {
    let name = file.file_name().unwrap_or_default().to_string_lossy();
    let name = name.strip_suffix(".gz").unwrap_or(&name);
    name.rsplit_once('.').map_or(name, |(stem, _)| stem).to_owned()
}

/// The last number in a name, as it is written.
fn number(stem: &str) -> Option<&str> {
    let end = stem.rfind(|c: char| c.is_ascii_digit())? + 1;
    let start = stem[..end]
        .rfind(|c: char| !c.is_ascii_digit())
        .map_or(0, |at| at + stem[at..].chars().next().map_or(1, char::len_utf8));
    Some(&stem[start..end])
}

/// The pattern by which a second file's name follows from a log's, for a map.
pub(super) fn pattern(log: &Path, truth: &Path) -> String {
    let stem = stem(log);
    let name = truth.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let name = match number(&stem) {
        _ if !stem.is_empty() && name.contains(&stem) => name.replacen(&stem, STEM, 1),
        Some(number) if self::number(&self::stem(truth)) == Some(number) => {
            let at = name.rfind(number).unwrap_or(0);
            format!("{}{NUMBER}{}", &name[..at], &name[at + number.len()..])
        }
        _ => name,
    };
    let folder = |file: &Path| file.parent().map_or_else(PathBuf::new, Path::to_owned);
    let (from, to) = (folder(log), folder(truth));
    if to.is_absolute() != from.is_absolute() {
        return to.join(name).to_string_lossy().into_owned();
    }
    let shared = from.components().zip(to.components()).take_while(|(a, b)| a == b).count();
    let up = from.components().skip(shared).map(|_| PathBuf::from(".."));
    let down = to.components().skip(shared).map(|part| PathBuf::from(part.as_os_str()));
    up.chain(down).collect::<PathBuf>().join(name).to_string_lossy().into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn beside(pattern: &str, log: &str) -> Result<String, String> {
        let text = toml::from_str(&format!("file = \"{pattern}\"")).unwrap();
        let truth = Truth::new(text, &Reading::default()).unwrap();
        truth.beside(Path::new(log)).map(|p| p.display().to_string()).map_err(|e| e.to_string())
    }

    #[test]
    fn a_second_files_name_follows_from_the_first() {
        for (pattern, log, file) in [
            ("{stem}_mocap.csv", "a/run_01.csv", "a/run_01_mocap.csv"),
            ("../vicon/take {number}.tsv", "logs/v2_run007.csv", "logs/../vicon/take 007.tsv"),
            ("truth.json", "x.log.gz", "truth.json"),
            ("{stem}.csv", "game.log.gz", "game.csv"),
            ("../truth/{folder}.csv", "set/walk/odom.csv", "set/walk/../truth/walk.csv"),
        ] {
            assert_eq!(beside(pattern, log).unwrap(), file);
        }
        assert!(beside("m{number}.csv", "run.csv").unwrap_err().contains("truth.file: \"run\" has no number"));
    }

    #[test]
    fn a_pattern_leads_back_to_the_file_it_was_made_of() {
        for (log, truth, expected) in [
            ("run_1.csv", "run_1_mocap.csv", "{stem}_mocap.csv"),
            ("set/log3é.csv", "set/vicon3.csv", "vicon{number}.csv"),
            ("logs/a.csv", "mocap/b.csv", "../mocap/b.csv"),
            ("run_12.csv", "gps/track12.csv", "gps/track{number}.csv"),
        ] {
            assert_eq!(pattern(Path::new(log), Path::new(truth)), expected);
        }
    }
}
