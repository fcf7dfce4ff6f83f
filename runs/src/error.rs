//! One error type for everything a user can hand us in a file.

use std::fmt;
use std::path::{Path, PathBuf};

/// What is wrong in an input file, where, and what to do about it.
///
/// Displayed in one line, in the form editors can jump to:
/// `robot.toml:5:11: mass_kg: -2.4 is not positive; give the mass of the whole robot in kilograms`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct InputError {
    /// File or folder.
    pub file: PathBuf,
    /// Line, from 1; `None` where the whole file is meant.
    pub line: Option<u32>,
    /// Column in characters, from 1.
    pub column: Option<u32>,
    /// Field or column name; empty where the whole line or file is meant.
    pub field: String,
    /// What is wrong.
    pub what: String,
    /// What to do.
    pub hint: String,
}

impl InputError {
    /// An error about a whole file.
    pub fn new(file: &Path, what: impl Into<String>, hint: impl Into<String>) -> Self {
        Self {
            file: file.to_owned(),
            line: None,
            column: None,
            field: String::new(),
            what: what.into(),
            hint: hint.into(),
        }
    }

    /// The same error at a line and column, both from 1.
    #[must_use]
    pub fn at(mut self, line: usize, column: usize) -> Self {
        self.line = u32::try_from(line).ok();
        self.column = u32::try_from(column).ok();
        self
    }

    /// The same error about a named field.
    #[must_use]
    pub fn field(mut self, field: impl Into<String>) -> Self {
        self.field = field.into();
        self
    }

    /// A failed read or write.
    pub fn io(file: &Path, error: &std::io::Error) -> Self {
        let hint = match error.kind() {
            std::io::ErrorKind::NotFound => "check the path",
            std::io::ErrorKind::PermissionDenied => "check the permissions",
            std::io::ErrorKind::IsADirectory => "give a file, not a folder",
            std::io::ErrorKind::NotADirectory => "a file stands where the path has a folder",
            std::io::ErrorKind::AlreadyExists => "a file stands where a folder is to be",
            std::io::ErrorKind::StorageFull => "make room on the medium",
            std::io::ErrorKind::InvalidData => "save the file as UTF-8 text",
            _ => "check the file and the medium it is on",
        };
        Self::new(file, error.to_string(), hint)
    }
}

impl fmt::Display for InputError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.file.display())?;
        if let Some(line) = self.line {
            write!(f, ":{line}")?;
            if let Some(column) = self.column {
                write!(f, ":{column}")?;
            }
        }
        write!(f, ": ")?;
        if !self.field.is_empty() {
            write!(f, "{}: ", self.field)?;
        }
        write!(f, "{}", self.what)?;
        if !self.hint.is_empty() {
            write!(f, "; {}", self.hint)?;
        }
        Ok(())
    }
}

impl std::error::Error for InputError {}

/// Line and column (both from 1, column in characters) of a byte offset.
pub fn line_and_column(text: &str, offset: usize) -> (usize, usize) {
    let mut end = offset.min(text.len());
    while !text.is_char_boundary(end) {
        end -= 1;
    }
    let before = &text[..end];
    let line = before.matches('\n').count() + 1;
    let start = before.rfind('\n').map_or(0, |i| i + 1);
    (line, before[start..].chars().count() + 1)
}

/// The known name closest to `name`, if it is close enough to be a slip of the keyboard.
pub fn nearest<'a>(name: &str, known: &[&'a str]) -> Option<&'a str> {
    closest(name, known).filter(|(distance, k)| *distance <= 2 + k.len() / 4).map(|(_, k)| k)
}

/// The same where `name` may be somebody's own as well: two letters wrong at most.
pub fn slip<'a>(name: &str, known: &[&'a str]) -> Option<&'a str> {
    closest(name, known).filter(|(distance, _)| *distance <= 2).map(|(_, k)| k)
}

fn closest<'a>(name: &str, known: &[&'a str]) -> Option<(usize, &'a str)> {
    known.iter().map(|k| (strsim::levenshtein(name, k), *k)).min()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn offsets_become_lines_and_columns() {
        assert_eq!(line_and_column("ab\ncd", 0), (1, 1));
        assert_eq!(line_and_column("ab\ncd", 4), (2, 2));
        assert_eq!(line_and_column("é\né=1", 4), (2, 1));
        assert_eq!(line_and_column("é\né=1", 5), (2, 2));
        assert_eq!(line_and_column("a", 99), (1, 2));
    }

    #[test]
    fn slips_are_recognised_and_strangers_are_not() {
        let known = ["mass_kg", "gear_ratio", "supply_v"];
        assert_eq!(nearest("mas_kg", &known), Some("mass_kg"));
        assert_eq!(nearest("gear_ration", &known), Some("gear_ratio"));
        assert_eq!(nearest("colour_of_the_lid", &known), None);
    }

    #[test]
    fn display_is_one_line_an_editor_can_jump_to() {
        let e =
            InputError::new(Path::new("robot.toml"), "-2 is not positive", "give kilograms").at(5, 11).field("mass_kg");
        assert_eq!(e.to_string(), "robot.toml:5:11: mass_kg: -2 is not positive; give kilograms");
    }
}
