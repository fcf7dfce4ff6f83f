//! Rows of numbers, each with its time, become series. One file may hold several recordings, one after the other: where
//! its time starts again, the next begins.

use std::path::Path;

use super::{Clock, Restart, Table, units};
use crate::error::InputError;

/// First words of names that time goes by.
const TIMES: [&str; 12] =
    ["t", "time", "timestamp", "stamp", "seconds", "elapsed", "millis", "micros", "zeit", "clock", "sec", "secs"];

/// The column of time and its unit in seconds, where the map says nothing of it.
fn named_like_time(names: &[String]) -> Option<(usize, f64)> {
    let exact = names.iter().enumerate().find_map(|(i, name)| {
        let plain = name.to_lowercase();
        let mut words = plain.split(|c: char| !c.is_alphanumeric()).filter(|w| !w.is_empty());
        let is_time = |word: Option<&str>| word.is_some_and(|word| TIMES.contains(&word));
        let timed = is_time(words.next())
            && words.next().is_none_or(|word| TIMES.contains(&word) || units::of_time(word).is_some());
        (timed && words.next().is_none()).then(|| (i, unit_s(name)))
    });
    let mut others = names.iter().enumerate().filter(|(_, name)| {
        let plain = name.to_lowercase();
        plain.split(|c: char| !c.is_alphanumeric()).any(|word| ["time", "timestamp", "stamp"].contains(&word))
    });
    // A name with the word anywhere, if it is the only one.
    exact.or_else(|| others.next().filter(|_| others.next().is_none()).map(|(i, name)| (i, unit_s(name))))
}

/// Seconds in the unit of time that a column's name ends in; 1 where it has none.
fn unit_s(name: &str) -> f64 {
    match name.to_lowercase().as_str() {
        "millis" => 1e-3,
        "micros" => 1e-6,
        _ => units::in_name(name).and_then(units::of_time).unwrap_or(1.0),
    }
}

/// Puts the rows of one table into its series.
pub(super) struct Rows<'a> {
    /// Full names of the columns.
    names: Vec<String>,
    clock: &'a Clock<'a>,
    /// The column of time.
    at: Option<usize>,
    unit_s: f64,
    rows: f64,
    /// The recording, from 1, its first time and the last.
    recording: usize,
    first: Option<f64>,
    last: f64,
}

impl<'a> Rows<'a> {
    /// Of a table whose columns' names get a prefix, such as `fast/`. `None` if it has no time, and rows are not counted
    /// instead.
    pub(super) fn new(prefix: &str, names: &[String], clock: &'a Clock<'a>) -> Option<Self> {
        let counted = clock.rate_hz.is_some();
        let found = match clock.column {
            _ if counted => None,
            Some(name) => {
                let own = |n: &String| n == name || name.strip_prefix(prefix).is_some_and(|rest| rest == n);
                names.iter().position(own).map(|i| (i, unit_s(name)))
            }
            None => named_like_time(names),
        };
        if found.is_none() && !clock.rows && !counted {
            return None;
        }
        let unit_s = clock.rate_hz.map(f64::recip).or(clock.unit_s).or(found.map(|(_, unit)| unit)).unwrap_or(1.0);
        let at = found.map(|(at, _)| at);
        let names = names.iter().map(|name| format!("{prefix}{name}")).collect();
        Some(Self { names, clock, at, unit_s, rows: 0.0, recording: 1, first: None, last: 0.0 })
    }

    /// The column of time and its unit, s.
    pub(super) fn time(&self) -> Option<(String, f64)> {
        self.at.map(|at| (self.names[at].clone(), self.unit_s))
    }

    /// The column of time and its name.
    pub(super) fn time_column(&self) -> Option<(usize, &str)> {
        self.at.map(|at| (at, self.names[at].as_str()))
    }

    /// Adds a row of which `line` is the line, or the number; one without time is none.
    pub(super) fn push(&mut self, table: &mut Table, line: usize, row: impl Fn(usize) -> Option<f64>) {
        let t = match self.at {
            Some(at) => match row(at) {
                Some(t) => t,
                None => return,
            },
            None => self.rows,
        };
        self.rows += 1.0;
        // Rows that overtook others are no restart: it goes back over half of what was recorded.
        let first = *self.first.get_or_insert(t);
        if t < self.last - 0.5 * (self.last - first) {
            self.recording += 1;
            self.first = Some(t);
            let restart = table.restart.get_or_insert(Restart { line, recordings: 1 });
            restart.recordings = restart.recordings.max(self.recording);
        }
        self.last = t;
        if self.clock.recording.is_some_and(|wanted| wanted != self.recording) {
            return;
        }
        for (i, name) in self.names.iter().enumerate() {
            if Some(i) != self.at
                && let Some(value) = row(i)
            {
                table.push(name, t * self.unit_s, value);
            }
        }
    }
}

/// What to say of a table without a time.
pub(super) fn timeless(path: &Path, names: &[String], clock: &Clock) -> InputError {
    let wanted = clock.column.map_or("no column of time".to_owned(), |name| format!("no column {name:?}"));
    let hint = format!(
        "name it in the map, [time] column = \"...\", or say how many rows a second it has, rate_hz = 100: it has {}",
        names.join(", ")
    );
    InputError::new(path, wanted, hint).at(1, 1)
}
