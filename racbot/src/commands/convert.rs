//! `racbot convert`

use crate::terminal::{Answer, Failure, Target, wrapped};
use clap::Args;
use runs::import::{Clock, Map, Table, draft};
use serde_json::json;
use std::path::{Path, PathBuf};

/// Options of `convert`.
#[derive(Args, Debug)]
#[command(
    after_help = "IN may be any table of numbers as text (CSV, PlotJuggler's too; tabs or blanks; names of columns or none), JSON, a \
ROS 2 bag in an MCAP, a game log of the small-size league (.log, .log.gz) or a WPILib log. MAP.toml says which of its series is which column, such as\n\n  \
[columns]\n  enc_1 = \"left/ticks\"\n  cam_x = { from = \"pose.x\", unit = \"mm\" }\n  [frame]\n  x = \"forward\"\n\n\
docs/book/src/log-format.md has all of it."
)]
pub(crate) struct Options {
    /// Map, file to read, file to write (*.csv or *.mcap); with --list the file to read alone
    #[arg(value_name = "MAP IN OUT", required = true, num_args = 1..=3)]
    files: Vec<PathBuf>,

    /// List the series of a file
    #[arg(long, conflicts_with = "draft")]
    list: bool,

    /// Write a first map for a file, guessed from names and ranges: `racbot convert --draft IN map.toml`
    #[arg(long)]
    draft: bool,

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
            [map, file, out] => self.convert(map, file, out),
            _ => Err(Failure::usage(
                "give a map, a file to read and a file to write; `racbot convert --draft IN map.toml` writes a first \
                 map, `racbot convert --list IN` shows what a file holds",
            )),
        }
    }

    fn draft(&self, file: &Path, map: Option<&PathBuf>) -> Result<Answer, Failure> {
        self.target.check_free(map)?;
        let text = draft(&survey(file)?);
        let Some(map) = map else { return Ok(Answer { json: json!({ "map": text }), text, wrong: None }) };
        self.target.save(map, &text)?;
        let json = json!({ "map": map });
        let said = format!(
            "{}: check every line, then racbot convert {} {} OUT.csv",
            map.display(),
            map.display(),
            file.display()
        );
        Ok(Answer { text: wrapped(&said, 2), json, wrong: None })
    }

    fn convert(&self, map: &Path, file: &Path, out: &Path) -> Result<Answer, Failure> {
        if !out.extension().is_some_and(|e| e.eq_ignore_ascii_case("csv") || e.eq_ignore_ascii_case("mcap")) {
            return Err(Failure::about(out, "is neither *.csv nor *.mcap; runs are one of the two"));
        }
        self.target.check_free([out])?;
        let map = Map::load(map)?;
        let table = Table::read(file, map.format(), &map.time()?)?;
        let run = map.run(&table, file)?;
        if let Some(folder) = out.parent().filter(|f| !f.as_os_str().is_empty()) {
            std::fs::create_dir_all(folder).map_err(|error| runs::error::InputError::io(folder, &error))?;
        }
        run.save(out, self.target.existing())?;
        let said = format!(
            "{}: {} ticks in {:.1} s, {} camera poses",
            out.display(),
            run.len(),
            run.duration_s(),
            run.camera.len()
        );
        let json = json!({
            "run": out, "ticks": run.len(), "seconds": run.duration_s(), "camera": run.camera.len(),
            "wheels": run.wheel_count(),
        });
        Ok(Answer { text: wrapped(&said, 2), json, wrong: None })
    }
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
    let json = json!({ "series": table.series.iter().map(|s| json!({ "name": s.name, "samples": s.values.len() })).collect::<Vec<_>>() });
    Ok(Answer { text, json, wrong: None })
}
