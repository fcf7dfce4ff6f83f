//! Why a command could not be done: one line.

use super::Exit;
use runs::error::InputError;
use std::fmt::Display;
use std::io::Write;
use std::path::Path;

/// See the module.
#[derive(Clone, Debug)]
pub(crate) struct Failure {
    what: String,
    exit: Exit,
    /// Whether the lines are an excerpt with a caret and must stay as they are.
    excerpt: bool,
}

impl Failure {
    /// The input is wrong.
    pub(crate) fn data(what: impl Display) -> Self {
        Self { what: what.to_string(), exit: Exit::BadData, excerpt: false }
    }

    /// The command line is wrong.
    pub(crate) fn usage(what: impl Display) -> Self {
        Self { what: what.to_string(), exit: Exit::Usage, excerpt: false }
    }

    /// The input is wrong, and lines of it show where.
    #[cfg(feature = "simulation")]
    pub(crate) fn excerpt(what: impl Display) -> Self {
        Self { excerpt: true, ..Self::data(what) }
    }

    /// Something in or about a file is wrong.
    pub(crate) fn about(file: &Path, what: impl Display) -> Self {
        Self::data(format!("{}: {what}", file.display()))
    }

    /// Prints the line, and says how the command ends.
    pub(crate) fn print(&self) -> Exit {
        let one_line = || self.what.split_whitespace().collect::<Vec<_>>().join(" ");
        let line = if self.excerpt { self.what.trim_end().to_owned() } else { one_line() };
        // Where standard error is gone there is nobody to tell.
        let _ = writeln!(std::io::stderr(), "racbot: {line}");
        self.exit
    }
}

impl From<InputError> for Failure {
    fn from(error: InputError) -> Self {
        Self::data(error)
    }
}
