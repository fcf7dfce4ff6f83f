//! Tables of figures in `docs/measured/`: what measures a figure writes it, and fails when the committed table
//! says something else. No figure is copied by hand.
//!
//! A test calls [`Table::check`] or [`Table::check_row`]. As a rule they compare; with `RACBOT_MEASURED=write` in the
//! environment they write:
//!
//! ```sh
//! RACBOT_MEASURED=write cargo test --release -p testbench --test formal
//! ```
//!
//! Only figures that are the same on every machine belong into a table that a test checks. Times and rates are
//! written by benches, with [`Table::write`].

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// Tests of one binary write the rows of a table side by side.
static FILES: Mutex<()> = Mutex::new(());

/// One table of figures, a Markdown file of its own.
#[derive(Debug, Clone, Copy)]
pub struct Table<'a> {
    /// File name in `docs/measured/`, without extension.
    pub name: &'a str,
    /// Heading: what was measured.
    pub title: &'a str,
    /// The command that measures it.
    pub command: &'a str,
    /// Names of the columns, with units.
    pub columns: &'a [&'a str],
}

impl Table<'_> {
    /// Compares all rows with the committed table, or writes them.
    ///
    /// # Panics
    /// When the committed table says something else.
    #[track_caller]
    pub fn check(&self, rows: &[Vec<String>]) {
        let text = self.text(rows.iter().map(|row| line(row)));
        if writing() {
            self.put(&text);
        } else if let Some([measured, committed]) = difference(&text, &self.committed()) {
            panic!("{}", self.stale(&measured, &committed));
        }
    }

    /// Compares one row, found by its first cell, with the committed table, or writes it.
    ///
    /// # Panics
    /// When the committed table has no such row, or another.
    #[track_caller]
    pub fn check_row(&self, row: &[String]) {
        let _one = FILES.lock().unwrap_or_else(PoisonError::into_inner);
        let row = line(row);
        let committed = self.committed();
        if writing() {
            let mut rows: Vec<String> = rows(&committed).map(str::to_owned).collect();
            match rows.iter().position(|line| first_cell(line) == first_cell(&row)) {
                Some(place) => rows[place] = row,
                None => rows.push(row),
            }
            self.put(&self.text(rows));
            return;
        }
        let stated = rows(&committed).find(|line| first_cell(line) == first_cell(&row));
        assert!(stated == Some(&row), "{}", self.stale(&row, stated.unwrap_or("no such row")));
    }

    /// The same for a figure that versions of a tool move a little: numbers may differ by `tolerance` times their
    /// committed value.
    ///
    /// # Panics
    /// When the committed table has no such row, or one farther away.
    #[track_caller]
    pub fn check_row_within(&self, row: &[String], tolerance: f64) {
        let committed = self.committed();
        let stated = rows(&committed).find(|line| first_cell(line) == row[0]).unwrap_or("no such row");
        if writing() || !near(&line(row), stated, tolerance) {
            self.check_row(row);
        }
    }

    /// Writes the table as it is: for benches, whose figures differ from machine to machine.
    pub fn write(&self, rows: &[Vec<String>]) {
        self.put(&self.text(rows.iter().map(|row| line(row))));
    }

    fn committed(&self) -> String {
        fs::read_to_string(self.path()).unwrap_or_default()
    }

    fn stale(&self, measured: &str, committed: &str) -> String {
        format!(
            "docs/measured/{}.md differs from what was measured\n  measured   {measured}\n  committed  {committed}\n\
             where the new figure is right: RACBOT_MEASURED=write {}",
            self.name, self.command
        )
    }

    fn text(&self, rows: impl IntoIterator<Item = String>) -> String {
        let mut text = format!("# {}\n\nMeasured by `{}`.\n\n", self.title, self.command);
        let _ = writeln!(text, "| {} |\n|{}", self.columns.join(" | "), "---|".repeat(self.columns.len()));
        rows.into_iter().for_each(|row| text.push_str(&(row + "\n")));
        text
    }

    fn put(&self, text: &str) {
        fs::create_dir_all(folder()).and_then(|()| fs::write(self.path(), text)).expect("docs/measured can be written");
    }

    fn path(&self) -> PathBuf {
        folder().join(self.name).with_extension("md")
    }
}

/// `docs/measured/`, or `RACBOT_MEASURED_DIR`.
fn folder() -> PathBuf {
    std::env::var_os("RACBOT_MEASURED_DIR")
        .map_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/measured"), PathBuf::from)
}

fn writing() -> bool {
    std::env::var_os("RACBOT_MEASURED").is_some_and(|value| value == "write")
}

/// The first line that differs, as measured and as committed.
fn difference(measured: &str, committed: &str) -> Option<[String; 2]> {
    let (mut ours, mut theirs) = (measured.lines(), committed.lines());
    loop {
        match (ours.next(), theirs.next()) {
            (None, None) => return None,
            (ours, theirs) if ours == theirs => {}
            (ours, theirs) => return Some([ours, theirs].map(|line| line.unwrap_or("no such line").to_owned())),
        }
    }
}

/// Whether two rows are the same but for numbers that differ by no more than `tolerance` times the committed one.
fn near(measured: &str, committed: &str, tolerance: f64) -> bool {
    let (measured, committed) = (measured.split(" | "), committed.split(" | "));
    let number = |cell: &str| cell.trim_matches(['|', ' ']).parse::<f64>().ok();
    measured.clone().count() == committed.clone().count()
        && measured.zip(committed).all(|(ours, theirs)| match (number(ours), number(theirs)) {
            (Some(ours), Some(theirs)) => (ours - theirs).abs() <= tolerance * theirs.abs(),
            _ => ours == theirs,
        })
}

/// Lines below the head of a table.
fn rows(text: &str) -> impl Iterator<Item = &str> {
    text.lines().skip_while(|line| !line.starts_with("|---")).skip(1)
}

fn line(cells: &[String]) -> String {
    format!("| {} |", cells.join(" | "))
}

fn first_cell(line: &str) -> &str {
    line.trim_start_matches("| ").split(" | ").next().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    const TABLE: Table<'_> =
        Table { name: "speeds", title: "Speeds", command: "cargo test", columns: &["what", "m/s"] };

    fn text(rows: &[&str]) -> String {
        TABLE.text(rows.iter().map(|&row| row.to_owned()))
    }

    #[test]
    fn another_figure_and_a_row_more_or_less_are_noticed() {
        let committed = text(&["| snail | 0.001 |", "| robot | 2.0 |"]);
        assert_eq!(difference(&committed, &committed), None);
        let other = text(&["| snail | 0.001 |", "| robot | 2.1 |"]);
        assert_eq!(difference(&other, &committed), Some(["| robot | 2.1 |", "| robot | 2.0 |"].map(str::to_owned)));
        let fewer = text(&["| snail | 0.001 |"]);
        assert_eq!(difference(&fewer, &committed), Some(["no such line", "| robot | 2.0 |"].map(str::to_owned)));
        assert!(difference(&committed, &fewer).is_some() && difference(&committed, "").is_some());
    }

    #[test]
    fn near_is_near_in_numbers_and_equal_in_words() {
        assert!(near("| ice40 | 55.0 |", "| ice40 | 57.6 |", 0.1));
        assert!(!near("| ice40 | 50.0 |", "| ice40 | 57.6 |", 0.1));
        assert!(!near("| ecp5 | 57.6 |", "| ice40 | 57.6 |", 0.1) && !near("| ice40 |", "| ice40 | 57.6 |", 0.1));
    }

    #[test]
    fn rows_are_found_by_their_first_cell() {
        let committed = text(&["| snail | 0.001 |", "| robot | 2.0 |"]);
        assert_eq!(rows(&committed).map(first_cell).collect::<Vec<_>>(), ["snail", "robot"]);
    }
}
