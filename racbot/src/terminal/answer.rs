//! What a command has to say, for people and for programs.

use super::{Exit, Failure};
use serde_json::Value;
use std::io::{ErrorKind, Write, stdout};

/// The result of a command.
#[derive(Clone, Debug, Default)]
pub(crate) struct Answer {
    /// For people, at most 80 columns wide.
    pub(crate) text: String,
    /// For programs.
    pub(crate) json: Value,
    /// What was checked and found wrong: one line; the command then ends with exit code 1.
    pub(crate) wrong: Option<String>,
}

impl Answer {
    /// Prints it, and says how the command ends.
    pub(crate) fn print(&self, json: bool) -> Exit {
        let printed = if json { print(&format!("{:#}\n", self.json)) } else { print(&self.text) };
        match &self.wrong {
            Some(wrong) => Failure::data(wrong).print(),
            None => printed,
        }
    }
}

/// Prints text; a reader that has gone away (`| head`) is no error.
pub(crate) fn print(text: &str) -> Exit {
    let mut out = stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Failure::data(format!("standard output: {error}")).print()
        }
        _ => Exit::Done,
    }
}
