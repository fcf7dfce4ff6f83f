//! What goes to the terminal: answers, failures, tables, progress.

mod answer;
mod failure;
mod number;
#[cfg(feature = "simulation")]
pub(crate) mod progress;
mod table;
mod target;

pub(crate) use answer::{Answer, print};
pub(crate) use failure::Failure;
pub(crate) use number::positive;
pub(crate) use table::{Table, entry, wrapped};
pub(crate) use target::Target;

use std::process::ExitCode;

/// How a command ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Exit {
    /// Done, whatever the verdict.
    Done,
    /// The input is wrong, or what was checked is.
    BadData,
    /// The command line is wrong.
    Usage,
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> Self {
        Self::from(match exit {
            Exit::Done => 0,
            Exit::BadData => 1,
            Exit::Usage => 2,
        })
    }
}
