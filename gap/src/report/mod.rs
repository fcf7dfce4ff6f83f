//! The analysis as JSON, as text for a terminal, as a page, and as files.

mod firmware;
mod html;
mod json;
mod regimes;
mod terminal;
mod words;

use runs::output::{Existing, check_free, write_whole};
use std::path::Path;

use crate::GapError;
use crate::analysis::Analysis;

/// Names of the files of a report.
pub(crate) const FILES: [&str; 3] = ["gap.json", "report.html", "robot.toml"];

impl Analysis {
    /// `gap.json`.
    pub fn to_json(&self) -> serde_json::Value {
        json::json(self)
    }

    /// A summary for a terminal 80 columns wide.
    pub fn terminal_summary(&self) -> String {
        terminal::summary(self)
    }

    /// The report as one self-contained page.
    pub fn html(&self) -> String {
        html::page(self)
    }

    /// Writes all files of the report into a folder; those that are there are replaced.
    ///
    /// # Errors
    /// [`GapError::Write`] naming the file.
    pub fn write(&self, folder: impl AsRef<Path>) -> Result<(), GapError> {
        self.save(folder, Existing::Replace)
    }

    /// The same, where files that are there may have to stay; then nothing is written.
    ///
    /// # Errors
    /// [`GapError::Write`] naming the file.
    pub fn save(&self, folder: impl AsRef<Path>, existing: Existing) -> Result<(), GapError> {
        let folder = folder.as_ref();
        let fault = |e: &dyn std::fmt::Display| GapError::Write(e.to_string());
        let json = serde_json::to_string_pretty(&self.to_json()).map_err(|e| fault(&e))? + "\n";
        for name in FILES {
            check_free(&folder.join(name), existing).map_err(|e| fault(&e))?;
        }
        for (name, text) in FILES.into_iter().zip([json, self.html(), self.robot_text.clone()]) {
            write_whole(&folder.join(name), text.as_bytes(), existing).map_err(|e| fault(&e))?;
        }
        Ok(())
    }
}
