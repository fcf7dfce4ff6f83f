//! The files of a data set.

use std::fs;
use std::path::Path;

use crate::error::Error;

/// Name of a run, numbered from 1.
pub(crate) fn run_name(number: u32) -> String {
    format!("run_{number:02}.csv")
}

/// Writes a file into a folder that is there.
pub(crate) fn put(dir: &Path, name: &str, text: &str) -> Result<(), Error> {
    let path = dir.join(name);
    fs::write(&path, text).map_err(|source| Error::File(path, source))
}

/// Makes a folder with the file that describes what is in it.
pub(crate) fn begin(dir: &Path, robot_toml: &str) -> Result<(), Error> {
    fs::create_dir_all(dir).map_err(|source| Error::File(dir.to_owned(), source))?;
    put(dir, "robot.toml", robot_toml)
}
