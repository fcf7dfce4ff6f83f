//! `racbot generate`

use crate::terminal::{Answer, Failure, Table, Target};
use clap::Args;
use hdl::design::{File, files};
use runs::error::InputError;
use serde_json::json;
use std::path::{Path, PathBuf};

/// Options of `generate`.
#[derive(Args, Debug)]
pub(crate) struct Options {
    /// Folder to write to, or to check
    #[arg(long, value_name = "DIR", default_value = "generated")]
    out: PathBuf,

    /// Write nothing; fail if a file in the folder is not what would be written
    #[arg(long)]
    check: bool,

    #[command(flatten)]
    target: Target,
}

impl Options {
    pub(crate) fn run(&self) -> Result<Answer, Failure> {
        let files = files().map_err(Failure::data)?;
        if self.check {
            return check(&self.out, &files);
        }
        let mut table = Table::new(1, &["file", "bytes"]);
        let mut written = Vec::new();
        for file in &files {
            let path = self.out.join(&file.name);
            self.target.save(&path, &file.text)?;
            table.row([path.display().to_string(), file.text.len().to_string()]);
            written.push(json!({ "file": path.to_string_lossy(), "bytes": file.text.len() }));
        }
        Ok(Answer { text: table.render(), json: json!({ "written": written }), wrong: None })
    }
}

fn check(folder: &Path, files: &[File]) -> Result<Answer, Failure> {
    let mut table = Table::new(2, &["file", "state"]);
    let mut states = Vec::new();
    let mut wrong = None;
    for file in files {
        let path = folder.join(&file.name);
        let difference = compare(&path, &file.text)?;
        let state = difference.map_or_else(|| "current".to_owned(), |line| format!("differs from line {line} on"));
        table.row([path.display().to_string(), state]);
        states.push(json!({ "file": path.to_string_lossy(), "current": difference.is_none(), "line": difference }));
        if let (None, Some(line)) = (&wrong, difference) {
            let path = path.display();
            wrong = Some(format!(
                "{path}:{line}: is not what the gateware emits; run racbot generate --force --out {}",
                folder.display()
            ));
        }
    }
    Ok(Answer { text: table.render(), json: json!({ "current": wrong.is_none(), "files": states }), wrong })
}

/// The first line, from 1, in which a file differs from its fresh text.
fn compare(path: &Path, fresh: &str) -> Result<Option<usize>, Failure> {
    let text = std::fs::read(path).map_err(|error| InputError::io(path, &error))?;
    let text = String::from_utf8_lossy(&text);
    if text == fresh {
        return Ok(None);
    }
    let same = text.lines().zip(fresh.lines()).take_while(|(found, fresh)| found == fresh).count();
    Ok(Some(same + 1))
}
