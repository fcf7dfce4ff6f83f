//! Logs in JSON: records (`[{"t": 0, "pos": 1}, ...]`, or one a line), columns (`{"t": [...], "pos": [...]}`) and rows
//! (`[[0, 1], ...]`), at any depth. Names of nested fields are joined by `/`; a file of several tables has theirs before
//! them.

use std::borrow::Cow;
use std::collections::HashMap;
use std::path::Path;

use serde_json::Value;

use super::rows::{self, Rows};
use super::sheet::numbered;
use super::{Clock, Table, sysid};
use crate::error::InputError;

/// From so many numbers on an array is a column of a log; below, a vector of one sample: the longest usual one is the
/// covariance of a pose, 36 numbers.
const COLUMN: usize = 40;

/// A table: its place in the file, names of its columns, and its rows.
struct Found {
    place: String,
    columns: Vec<String>,
    rows: Vec<Vec<Option<f64>>>,
}

pub(super) fn is_json(name: &str, bytes: &[u8]) -> bool {
    let named = [".json", ".jsonl", ".ndjson"].iter().any(|end| name.ends_with(end));
    let open = bytes.trim_ascii_start().strip_prefix(b"{");
    named || open.is_some_and(|inside| inside.trim_ascii_start().starts_with(b"\""))
}

pub(super) fn read(bytes: &[u8], path: &Path, clock: &Clock) -> Result<Table, InputError> {
    let bytes = without_nan(bytes);
    let mut values = Vec::new();
    for value in serde_json::Deserializer::from_slice(&bytes).into_iter::<Value>() {
        match value {
            Ok(value) => values.push(value),
            // A log of a robot that was switched off ends with its last whole record.
            Err(e) if e.is_eof() && values.len() > 1 => break,
            Err(e) => {
                let hint = "save the log as JSON, an array of records or one record a line";
                return Err(InputError::new(path, e.to_string(), hint).at(e.line(), e.column()));
            }
        }
    }
    let whole = if values.len() == 1 { values.remove(0) } else { Value::Array(values) };
    let mut found = Vec::new();
    search(&whole, "", &mut found);
    let mut table = Table::default();
    if let Some(names) = tests(&whole, &found).filter(|names| clock.column.is_none_or(|time| names.contains(&time))) {
        let names: Vec<String> = names.iter().map(|name| (*name).to_owned()).collect();
        if let Some(mut rows) = Rows::new("", &names, clock) {
            for (number, test) in found.iter().enumerate() {
                if number > 0 {
                    rows.restart(&mut table, number + 1);
                }
                test.put(&mut rows, &mut table);
                table.recordings.push(test.place.clone());
            }
            table.time = rows.time();
            rows.finish(&mut table, "row");
            return Ok(table);
        }
    }
    let alone = found.len() == 1;
    let mut timeless = None;
    for one in &found {
        let prefix = if alone || one.place.is_empty() { String::new() } else { format!("{}/", one.place) };
        let Some(mut rows) = Rows::new(&prefix, &one.columns, clock) else {
            timeless.get_or_insert_with(|| {
                let named: Vec<String> = one.columns.iter().map(|name| format!("{prefix}{name}")).collect();
                rows::timeless(path, &named, clock)
            });
            continue;
        };
        one.put(&mut rows, &mut table);
        table.time = table.time.take().or(rows.time());
        rows.finish(&mut table, "row");
    }
    match timeless {
        Some(error) if table.series.is_empty() => Err(error),
        _ => Ok(table),
    }
}

/// What the columns of all tables are, where the file is a characterisation of a machine, with a table each test.
fn tests(whole: &Value, found: &[Found]) -> Option<&'static [&'static str]> {
    let width = found.first()?.columns.len();
    let alike = |test: &Found| test.columns == numbered(width);
    sysid::columns(whole, width).filter(|_| found.iter().all(alike))
}

/// The same bytes with null where Python writes NaN and Infinity, which no JSON has.
fn without_nan(bytes: &[u8]) -> Cow<'_, [u8]> {
    let mut out = Vec::new();
    let (mut done, mut at, mut quoted) = (0, 0, false);
    while at < bytes.len() {
        let word = [&b"-Infinity"[..], b"Infinity", b"NaN"].into_iter().find(|w| !quoted && bytes[at..].starts_with(w));
        match (bytes[at], word) {
            (_, Some(word)) => {
                out.extend_from_slice(&bytes[done..at]);
                out.extend_from_slice(b"null");
                at += word.len();
                done = at;
                continue;
            }
            (b'\\', _) if quoted => at += 1,
            (b'"', _) => quoted = !quoted,
            _ => {}
        }
        at += 1;
    }
    if done == 0 {
        return Cow::Borrowed(bytes);
    }
    out.extend_from_slice(&bytes[done..]);
    Cow::Owned(out)
}

/// Finds the tables of a value at a place.
fn search(value: &Value, place: &str, found: &mut Vec<Found>) {
    match value {
        Value::Array(items) if !items.is_empty() && items.iter().all(is_row) => {
            found.push(Found::of(place, items.iter().map(|row| vec![("", row)])));
        }
        Value::Array(items) => (1..).zip(items).for_each(|(i, item)| search(item, &join(place, i), found)),
        Value::Object(fields) => {
            let columns: Vec<(&String, &Vec<Value>)> =
                fields.iter().filter_map(|(name, value)| Some((name, column(value)?))).collect();
            let length = columns.iter().map(|(_, column)| column.len()).max();
            // Arrays of vectors belong to columns of numbers that are as long.
            let rows = |items: &&Vec<Value>| Some(items.len()) == length && items.iter().all(is_row);
            let table: Vec<(&String, &Vec<Value>)> = fields
                .iter()
                .filter_map(|(name, value)| Some((name, column(value).or(value.as_array().filter(rows))?)))
                .collect();
            if let Some(length) = length {
                let row = |i: usize| table.iter().filter_map(move |(name, of)| Some((name.as_str(), of.get(i)?)));
                found.push(Found::of(place, (0..length).map(|i| row(i).collect())));
            }
            for (name, value) in fields {
                if table.iter().all(|(known, _)| *known != name) || length.is_none() {
                    search(value, &join(place, name), found);
                }
            }
        }
        _ => {}
    }
}

/// A long array of numbers, some of which may be missing.
fn column(value: &Value) -> Option<&Vec<Value>> {
    let plain = |item: &Value| number(item).is_some() || item.is_null();
    value
        .as_array()
        .filter(|items| items.len() >= COLUMN && items.iter().all(plain) && items.iter().any(|i| !i.is_null()))
}

/// Whether it is one sample of some quantities.
fn is_row(item: &Value) -> bool {
    let mut some = false;
    let mut fields = |item: &Value| flatten("", item, &mut |_, _| some = true);
    match item {
        Value::Object(_) => fields(item),
        Value::Array(items) if items.iter().all(|i| number(i).is_some() || i.is_null()) => fields(item),
        _ => {}
    }
    some && !holds_column(item)
}

fn holds_column(value: &Value) -> bool {
    match value {
        Value::Array(items) => items.len() >= COLUMN || items.iter().any(holds_column),
        Value::Object(fields) => fields.values().any(holds_column),
        _ => false,
    }
}

impl Found {
    /// Its rows as samples of a table.
    fn put(&self, rows: &mut Rows, table: &mut Table) {
        for (line, row) in (1..).zip(&self.rows) {
            rows.push(table, line, |i| row.get(i).copied().flatten());
        }
    }

    /// Of rows, each of named values.
    fn of<'a>(place: &str, rows: impl Iterator<Item = Vec<(&'a str, &'a Value)>>) -> Self {
        let mut index: HashMap<String, usize> = HashMap::new();
        let mut columns = Vec::new();
        let rows = rows
            .map(|row| {
                let mut out = vec![None; columns.len()];
                for (name, value) in row {
                    flatten(name, value, &mut |name, value| {
                        let at = *index.entry(name).or_insert_with_key(|name| {
                            columns.push(name.clone());
                            columns.len() - 1
                        });
                        out.resize(columns.len(), None);
                        out[at] = Some(value);
                    });
                }
                out
            })
            .collect();
        let unnamed = columns.iter().all(|name| name.parse::<usize>().is_ok());
        Self { place: place.to_owned(), columns: if unnamed { numbered(columns.len()) } else { columns }, rows }
    }
}

/// Every number in a value, by its name.
fn flatten(name: &str, value: &Value, take: &mut dyn FnMut(String, f64)) {
    match value {
        Value::Array(items) => (1..).zip(items).for_each(|(i, item)| flatten(&join(name, i), item, take)),
        Value::Object(fields) => fields.iter().for_each(|(key, item)| flatten(&join(name, key), item, take)),
        _ => {
            if let Some(value) = number(value) {
                take(name.to_owned(), value);
            }
        }
    }
}

fn number(value: &Value) -> Option<f64> {
    value.as_f64().or_else(|| value.as_str()?.trim().parse().ok())
}

fn join(place: &str, name: impl std::fmt::Display) -> String {
    if place.is_empty() { name.to_string() } else { format!("{place}/{name}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(text: &str) -> Table {
        Table::of_bytes(text.as_bytes(), Path::new("log.json"), None, &Clock::default()).unwrap()
    }

    fn names(table: &Table) -> Vec<&str> {
        table.series.iter().map(|s| s.name.as_str()).collect()
    }

    #[test]
    fn records_columns_and_lines_are_tables() {
        // Records beside what is known of the machine; a vector, a text and a NaN of Python in them.
        let servo = r#"{"mass": 0.5, "entries": [
            {"timestamp": 0.00, "position": 0.1, "q": [1, 2], "motor": {"volts": "7.4"}, "mode": "on"},
            {"timestamp": 0.01, "position": NaN, "q": [3, 4], "motor": {"volts": "7.3"}, "mode": "NaN"}]}"#;
        let read = table(servo);
        assert_eq!(names(&read), ["motor/volts", "position", "q/1", "q/2"]);
        assert_eq!(read.find("q/2").unwrap().values, [2.0, 4.0]);
        assert_eq!((read.find("position").unwrap().t.len(), read.find("motor/volts").unwrap().t[1]), (1, 0.01));
        assert_eq!(read.time, Some(("timestamp".to_owned(), 1.0)));
        // One record a line, the last cut off.
        let lines = table("{\"t\": 1, \"a\": 5}\n{\"t\": 2, \"a\": 6}\n{\"t\": 3, ");
        assert_eq!(lines.find("a").unwrap().values, [5.0, 6.0]);
        // Columns, and rows that belong to them; another table beside.
        let numbers = |from: usize| (from..from + COLUMN).map(|i| i.to_string()).collect::<Vec<_>>().join(",");
        let pairs = (0..COLUMN).map(|i| format!("[{i},{}]", i + 1)).collect::<Vec<_>>().join(",");
        let columns = format!(
            "{{\"t\": [{}], \"speed\": [{}], \"xy\": [{pairs}], \"note\": [1, 2], \"other\": {{\"t\": [{}], \"u\": [{}]}}}}",
            numbers(0),
            numbers(7),
            numbers(0),
            numbers(9)
        );
        let read = table(&columns);
        assert_eq!(names(&read), ["speed", "xy/1", "xy/2", "other/u"]);
        assert_eq!((read.find("xy/2").unwrap().values[3], read.find("other/u").unwrap().values[0]), (4.0, 9.0));
    }

    #[test]
    fn tests_of_a_machine_are_recordings_with_names() {
        let of = |fast: &str, slow: &str| {
            format!(r#"{{"fast-forward": [{fast}], "slow-forward": [{slow}], "test": "Simple"}}"#)
        };
        // The second test was recorded after the first: the time goes on.
        let text = of("[5.0, 7, 0.5, 1], [5.02, 7, 0.6, 2]", "[9.0, 1, 0.7, 1], [9.02, 1, 0.8, 2], [9.04, 1, 0.9, 2]");
        let read = |recording| {
            let clock = Clock { recording, ..Clock::default() };
            Table::of_bytes(text.as_bytes(), Path::new("sysid.json"), None, &clock)
        };
        let all = read(None).unwrap();
        assert_eq!(names(&all), ["motor_voltage", "position (rev)", "motor_velocity (rev/s)"]);
        assert_eq!(all.recordings, ["fast-forward", "slow-forward"]);
        assert_eq!(all.restart.map(|restart| restart.recordings), Some(2));
        let slow = read(Some(2)).unwrap();
        assert_eq!(slow.find("position (rev)").unwrap().values, [0.7, 0.8, 0.9]);
        assert!(read(Some(3)).unwrap_err().to_string().contains("has no recording 3"));
        // Rows of a width that nobody writes keep their numbers, and tables of two widths are no tests of one machine.
        let other = |text: &str| {
            let clock = Clock { column: Some("column_1"), ..Clock::default() };
            let table = Table::of_bytes(text.as_bytes(), Path::new("x.json"), None, &clock).unwrap();
            table.series.iter().map(|s| s.name.clone()).collect::<Vec<_>>()
        };
        assert!(other(&of("[1, 2, 3, 4, 5]", "[2, 2, 3, 4, 5]")).contains(&"slow-forward/column_5".to_owned()));
        let two = r#"{"fast-forward": [[1, 2, 3, 4]], "slow-forward": [[1, 2, 3], [2, 3, 4]]}"#;
        assert!(other(two).contains(&"fast-forward/column_4".to_owned()));
    }

    #[test]
    fn rows_of_numbers_are_named_by_their_test() {
        let text =
            r#"{"slow-forward": [[0.0, 1.5, 0.0], [0.02, 1.6, 0.1]], "fast-forward": [[5.0, 7, 0], [5.02, 7, 1]]}"#;
        let clock = Clock { column: Some("column_1"), ..Clock::default() };
        let read = Table::of_bytes(text.as_bytes(), Path::new("sysid.json"), None, &clock).unwrap();
        assert_eq!(read.find("fast-forward/column_3").unwrap().t, [5.0, 5.02]);
        assert_eq!(read.find("slow-forward/column_2").unwrap().values, [1.5, 1.6]);
        let one = Clock { column: Some("slow-forward/column_1"), ..Clock::default() };
        let read = Table::of_bytes(text.as_bytes(), Path::new("sysid.json"), None, &one).unwrap();
        assert_eq!(names(&read), ["slow-forward/column_2", "slow-forward/column_3"]);
        let error = |text: &str| {
            Table::of_bytes(text.as_bytes(), Path::new("x.json"), None, &Clock::default()).unwrap_err().to_string()
        };
        assert!(error(text).contains("no column of time; name it in the map"), "{}", error(text));
        assert!(error("{\"a\": }").starts_with("x.json:1:7: expected value"), "{}", error("{\"a\": }"));
        assert!(error("{\"a\": 1}").contains("holds no numbers that can be read"));
    }
}
