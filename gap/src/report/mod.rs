//! The analysis as JSON, as text for a terminal, as a page, and as files.

mod html;
mod json;
mod regimes;
mod terminal;
mod units;
mod words;

use std::path::Path;

use crate::GapError;
use crate::analysis::Analysis;

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

    /// Writes `gap.json`, `report.html` and `robot.toml` into a folder.
    ///
    /// # Errors
    /// [`GapError::Write`] naming the file.
    pub fn write(&self, folder: impl AsRef<Path>) -> Result<(), GapError> {
        let folder = folder.as_ref();
        let fault = |path: &Path, e: &dyn std::fmt::Display| GapError::Write(format!("{}: {e}", path.display()));
        std::fs::create_dir_all(folder).map_err(|e| fault(folder, &e))?;
        let json = serde_json::to_string_pretty(&self.to_json()).map_err(|e| fault(folder, &e))? + "\n";
        for (name, text) in [("gap.json", json), ("report.html", self.html())] {
            let path = folder.join(name);
            std::fs::write(&path, text).map_err(|e| fault(&path, &e))?;
        }
        let path = folder.join("robot.toml");
        std::fs::write(&path, &self.robot_text).map_err(|e| fault(&path, &e))
    }
}

/// A number with three significant digits.
pub(crate) fn short(x: f64) -> String {
    if x == 0.0 || !x.is_finite() {
        return format!("{x}");
    }
    let digits = (2 - x.abs().log10().floor() as i32).clamp(0, 9) as usize;
    format!("{x:.digits$}")
}
