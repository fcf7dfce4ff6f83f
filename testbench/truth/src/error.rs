//! What can go wrong: the request, or the disk.

use std::fmt;
use std::path::PathBuf;

/// An error of this crate.
#[derive(Debug)]
pub enum Error {
    /// No effect has this name.
    UnknownEffect(String),
    /// No kind of case has this name.
    UnknownKind(String),
    /// The size level is not 1 to 5.
    Size(u8),
    /// The conditions contradict each other or leave nothing to log.
    Conditions(String),
    /// A file could not be written or read.
    File(PathBuf, std::io::Error),
    /// The simulation of a run left all bounds.
    Diverged {
        /// Seed of the case.
        seed: u64,
        /// Log that was to be written.
        file: String,
        /// First tick without a state.
        tick: usize,
    },
    /// A truth file could not be turned into JSON.
    Json(serde_json::Error),
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::UnknownEffect(name) => write!(f, "no effect is called `{name}`; --list prints all names"),
            Self::UnknownKind(text) => {
                write!(f, "no kind of case is called `{text}`; --help prints the kinds, --list the effects")
            }
            Self::Size(size) => write!(f, "size {size} is not between 1 (near the detection limit) and 5 (gross)"),
            Self::Conditions(why) => write!(f, "these conditions do not go together: {why}"),
            Self::File(path, source) => write!(f, "{}: {source}", path.display()),
            Self::Diverged { seed, file, tick } => {
                write!(f, "the simulation of case {seed} diverged in {file} before tick {tick}; draw another seed")
            }
            Self::Json(source) => write!(f, "truth file: {source}"),
        }
    }
}

impl std::error::Error for Error {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::File(_, source) => Some(source),
            Self::Json(source) => Some(source),
            _ => None,
        }
    }
}

impl From<serde_json::Error> for Error {
    fn from(source: serde_json::Error) -> Self {
        Self::Json(source)
    }
}
