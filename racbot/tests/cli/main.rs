//! The command as its users meet it: exit codes, one-line errors, tables, JSON.
#![cfg(feature = "simulation")]

mod bad_data;
mod card;
mod drive;
mod good_data;
mod joined;
mod names;
mod printed;
mod radio;
mod serve;
mod set_up;
mod usage;
#[cfg(feature = "vision")]
mod vision;

use assert_cmd::Command;
use serde_json::Value;
use std::path::{Path, PathBuf};

/// Data that comes with the repository.
fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../data").join(name)
}

/// What came of a call.
struct Outcome {
    code: Option<i32>,
    stdout: String,
    stderr: String,
}

impl Outcome {
    #[track_caller]
    fn done(self) -> Self {
        assert_eq!(self.code, Some(0), "{}", self.stderr);
        assert_eq!(self.stderr, "");
        self
    }

    fn json(&self) -> Value {
        serde_json::from_str(&self.stdout).unwrap()
    }

    /// Fails with this code and one line that holds all of these.
    #[track_caller]
    fn refused(&self, code: i32, parts: &[&str]) {
        assert_eq!(self.code, Some(code), "{}{}", self.stdout, self.stderr);
        assert_eq!(self.stdout, "");
        if code == 1 {
            assert_eq!(self.stderr.lines().count(), 1, "{}", self.stderr);
            assert!(self.stderr.starts_with("racbot: "), "{}", self.stderr);
        }
        for part in parts {
            assert!(self.stderr.contains(part), "no {part:?} in {}", self.stderr);
        }
    }

    #[track_caller]
    fn fits_80_columns(self) -> Self {
        for line in self.stdout.lines() {
            assert!(line.chars().count() <= 80, "{line}");
        }
        self
    }
}

/// Runs racbot in a folder.
fn racbot(folder: &Path, arguments: &[&str]) -> Outcome {
    let output = Command::cargo_bin("racbot").unwrap().current_dir(folder).args(arguments).output().unwrap();
    Outcome {
        code: output.status.code(),
        stdout: String::from_utf8(output.stdout).unwrap(),
        stderr: String::from_utf8(output.stderr).unwrap(),
    }
}
