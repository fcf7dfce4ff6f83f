//! `racbot convert`

use super::record::check_name;
use crate::terminal::{Answer, Failure, Target, wrapped};
use clap::Args;
use runs::CLOCK_OFF_S;
use runs::error::InputError;
use runs::import::{Clock, Imported, Joined, Map, Table, draft, draft_two, drives};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// Options of `convert`.
#[derive(Args, Debug)]
#[command(
    after_help = "IN may be any table of numbers as text (CSV, PlotJuggler's too; tabs or blanks; names of columns or none), JSON, a \
ROS 2 bag in an MCAP, a game log of the small-size league (.log, .log.gz) or a WPILib log. MAP.toml says which of its series is which column, such as\n\n  \
[columns]\n  enc_1 = \"left/ticks\"\n  cam_x = { from = \"pose.x\", unit = \"mm\" }\n  [frame]\n  x = \"forward\"\n\n\
The pose may be in a second file, of motion capture or another camera, on a clock of its own: [truth]. \
docs/book/src/log-format.md has all of it."
)]
pub(crate) struct Options {
    /// Map, file to read, file to write (*.csv or *.mcap); or map, files or folders to read, and the folder to write to;
    /// with --list the file to read alone
    #[arg(value_name = "MAP IN OUT", required = true, num_args = 1..)]
    files: Vec<PathBuf>,

    /// List the series of a file
    #[arg(long, conflicts_with = "draft")]
    list: bool,

    /// Write a first map for a file, guessed from names and ranges: `racbot convert --draft IN map.toml`
    #[arg(long)]
    draft: bool,

    /// Second file, with the pose; else the one that the map's `[truth]` names. Of several logs a pattern: {stem}, {number}
    /// and {folder} are the log's
    #[arg(long, value_name = "FILE", conflicts_with = "list")]
    truth: Option<PathBuf>,

    #[command(flatten)]
    target: Target,
}

impl Options {
    pub(crate) fn run(&self) -> Result<Answer, Failure> {
        match &self.files[..] {
            [file] if self.list => list(file),
            _ if self.list => Err(Failure::usage("--list: give one file")),
            [file] if self.draft => self.draft(file, None),
            [file, map] if self.draft => self.draft(file, Some(map)),
            _ if self.draft => Err(Failure::usage("--draft: give the file to read, and the map to write")),
            [map, file, out] if !(is_folder(out) || file.is_dir()) => self.convert(map, file, out),
            [map, files @ .., folder] if !files.is_empty() => self.convert_all(map, files, folder),
            _ => Err(Failure::usage(
                "give a map, a file to read and a file to write; `racbot convert --draft IN map.toml` writes a first \
                 map, `racbot convert --list IN` shows what a file holds",
            )),
        }
    }

    fn draft(&self, file: &Path, map: Option<&PathBuf>) -> Result<Answer, Failure> {
        Target::check_apart([Some(file), self.truth.as_deref()].into_iter().flatten(), map)?;
        self.target.check_free(map)?;
        let log = survey(file)?;
        let text = match &self.truth {
            Some(truth) => draft_two([(&log, file), (&survey(truth)?, truth)]),
            None => draft(&log),
        };
        let Some(map) = map else { return Ok(Answer { json: json!({ "map": text }), text, wrong: None }) };
        self.target.save(map, &text)?;
        let json = json!({ "map": map.to_string_lossy() });
        let said = format!(
            "{}: check every line, then racbot convert {} {} OUT.csv",
            map.display(),
            map.display(),
            file.display()
        );
        Ok(Answer { text: wrapped(&said, 2), json, wrong: None })
    }

    fn convert(&self, map: &Path, file: &Path, out: &Path) -> Result<Answer, Failure> {
        check_name(out, ", and a folder for several ends with /")?;
        Target::check_apart([Some(map), Some(file), self.truth.as_deref()].into_iter().flatten(), [out])?;
        self.target.check_free([out])?;
        let (text, json) = self.written(Map::load(map)?.import(file, self.truth.as_deref())?, out)?;
        Ok(Answer { text, json, wrong: None })
    }

    /// Every file, and every recording in one, a run in the folder; what cannot be read is left out, and said.
    fn convert_all(&self, map: &Path, files: &[PathBuf], folder: &Path) -> Result<Answer, Failure> {
        if folder.extension().is_some() && !is_folder(folder) {
            let what = "of several files give the folder for their runs last, such as set/";
            return Err(Failure::usage(format!("{}: {what}", folder.display())));
        }
        let map = Map::load(map)?;
        let pattern = self.truth.as_ref().map(|truth| truth.to_string_lossy());
        let all = drives(&map, files, pattern.as_deref(), folder)?;
        if let (Some(pattern), true) = (&pattern, all.len() > 1)
            && !["{stem}", "{number}", "{folder}"].iter().any(|part| pattern.contains(part))
        {
            return Err(Failure::usage(format!(
                "--truth {pattern}: one for all; of several logs {{stem}}, {{number}} or {{folder}} say whose it is"
            )));
        }
        let read = all.iter().flat_map(|drive| drive.truth.iter().chain([&drive.log]));
        Target::check_apart(read, all.iter().map(|drive| &drive.run))?;
        self.target.check_free(all.iter().map(|drive| &drive.run))?;
        let (mut text, mut done, mut failed) = (String::new(), Vec::new(), Vec::new());
        for drive in &all {
            let log = &drive.log;
            let each = map.import_each(log, drive.truth.as_deref());
            for (recording, imported) in each.unwrap_or_else(|error| vec![(None, Err(error))]) {
                let run = recording.as_ref().map_or_else(|| drive.run.clone(), |name| drive.run_of(name));
                match imported.and_then(|imported| self.written(imported, &run)) {
                    Ok((said, json)) => {
                        text += &said;
                        done.push(json);
                    }
                    Err(error) => {
                        let said = error.to_string();
                        // An error about the map or the second file says not whose.
                        let said = if error.file == *log { said } else { format!("{}: {said}", log.display()) };
                        let said = recording.map_or(said.clone(), |name| format!("{said} (recording {name})"));
                        text += &wrapped(&format!("left out: {said}"), 2);
                        failed.push((log, said));
                    }
                }
            }
        }
        let total = done.len() + failed.len();
        let names: Vec<String> = failed.iter().map(|(log, _)| log.display().to_string()).collect();
        let wrong = match &failed[..] {
            [] => None,
            [(_, said)] => Some(format!("1 of {total} runs is left out: {said}")),
            _ => Some(format!("{} of {total} runs are left out: {}", failed.len(), names.join(", "))),
        };
        let failed: Vec<Value> =
            failed.iter().map(|(log, said)| json!({ "file": log.to_string_lossy(), "why": said })).collect();
        Ok(Answer { text, json: json!({ "runs": done, "left_out": failed }), wrong })
    }

    /// Writes a run, and says what came of it.
    fn written(&self, imported: Imported, out: &Path) -> Result<(String, Value), InputError> {
        let Imported { run, joined, remarks } = imported;
        if let Some(folder) = out.parent().filter(|f| !f.as_os_str().is_empty()) {
            std::fs::create_dir_all(folder).map_err(|error| InputError::io(folder, &error))?;
        }
        run.save(out, self.target.existing())?;
        let mut text = wrapped(
            &format!(
                "{}: {} ticks in {:.1} s, {} camera poses",
                out.display(),
                run.len(),
                run.duration_s(),
                run.camera.len()
            ),
            2,
        );
        if let Some(joined) = &joined {
            text += &wrapped(&told(joined), 2);
        }
        text += &notes(&remarks);
        let json = json!({
            "remarks": remarks,
            "run": out.to_string_lossy(), "ticks": run.len(), "seconds": run.duration_s(), "camera": run.camera.len(),
            "wheels": run.wheel_count(),
            "truth": joined.map(|j| json!({
                "file": j.file.to_string_lossy(), "offset_s": j.offset_s, "apart_s": j.apart_s,
                "matched": j.matched.map(|m| json!({ "share": m.share, "elsewhere": m.rival })),
                "before": j.outside[0], "after": j.outside[1], "incomplete": j.incomplete, "alike": j.alike,
            })),
        });
        Ok((text, json))
    }
}

/// Whether a path is meant as a folder.
fn is_folder(path: &Path) -> bool {
    path.is_dir() || path.as_os_str().to_string_lossy().ends_with(std::path::MAIN_SEPARATOR)
}

/// How the poses of a second file came into a run.
fn told(joined: &Joined) -> String {
    let mut said = format!("poses of {}", joined.file.display());
    if joined.offset_s != 0.0 {
        said += &format!(", {:.4} s added to its times", joined.offset_s);
    }
    if let Some(found) = joined.matched {
        said += &format!(
            ": found by the motion, {:.0} % of which the poses explain there, and {:.0} % at most elsewhere; a latency \
             of the camera is in it",
            100.0 * found.share,
            100.0 * found.rival
        );
    }
    let [before, after] = joined.outside;
    let left_out = [
        (before, "before the log's first row"),
        (after, "after its last"),
        (joined.incomplete, "with a part missing"),
        (joined.alike, "with the time of another"),
    ];
    let left_out: Vec<String> =
        left_out.iter().filter(|(n, _)| *n > 0).map(|(n, what)| format!("{n} {what}")).collect();
    if !left_out.is_empty() {
        said += &format!("; left out: {}", left_out.join(", "));
    }
    if let Some(apart) = joined.apart_s {
        said += &format!(
            ". By the motion {apart:.2} s are still to be added, more than `racbot gap` looks for ({CLOCK_OFF_S} s): see \
             offset_s and clock = \"match\" in [truth]"
        );
    }
    said
}

/// Everything in a file, of a CSV without a column of time by its rows.
fn survey(file: &Path) -> Result<Table, Failure> {
    Ok(Table::read(file, None, &Clock { rows: true, ..Clock::default() })?)
}

fn list(file: &Path) -> Result<Answer, Failure> {
    let table = survey(file)?;
    let mut text = String::new();
    if let Some((name, unit)) = &table.time {
        text += &format!("{name}  the time, its unit {unit} s\n");
    }
    for s in &table.series {
        let [low, high] = s.range();
        text += &format!("{}  {} samples, {low:.6} to {high:.6}\n", s.name, s.values.len());
    }
    text += &notes(&table.remarks);
    let json = json!({ "series": table.series.iter().map(|s| json!({ "name": s.name, "samples": s.values.len() })).collect::<Vec<_>>(),
        "remarks": table.remarks });
    Ok(Answer { text, json, wrong: None })
}

/// What the owner of a file would want to know of it.
fn notes(remarks: &[String]) -> String {
    remarks.iter().map(|remark| wrapped(&format!("note: {remark}"), 2)).collect()
}
