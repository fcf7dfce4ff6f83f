//! Any text table with a column of time; empty fields and texts are no samples. PlotJuggler's exports have the time in
//! `__time`.

use std::path::Path;

use super::sheet::Sheet;
use super::{Clock, Table, heading, units};
use crate::error::InputError;

/// First words of names that time goes by.
const TIMES: [&str; 12] =
    ["t", "time", "timestamp", "stamp", "seconds", "elapsed", "millis", "micros", "zeit", "clock", "sec", "secs"];

/// The column of time and its unit in seconds, where the map says nothing of it.
fn time_column(names: &[String]) -> Option<(usize, f64)> {
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

pub(super) fn read(bytes: &[u8], path: &Path, time: &Clock) -> Result<Table, InputError> {
    let Sheet { names, rows: text, separator } = Sheet::of(bytes);
    let mut csv = ::csv::ReaderBuilder::new()
        .delimiter(separator)
        .flexible(true)
        .has_headers(false)
        .trim(::csv::Trim::All)
        .from_reader(&*text);
    let mut record = ::csv::ByteRecord::new();
    let mut next = |record: &mut ::csv::ByteRecord| {
        csv.read_byte_record(record).map_err(|e| InputError::new(path, e.to_string(), "save the log as CSV"))
    };
    let names: Vec<String> = match names {
        Some(names) => names,
        None if next(&mut record)? => {
            record.iter().map(|field| String::from_utf8_lossy(field).trim().to_owned()).collect()
        }
        None => return Err(InputError::new(path, "is empty", "give a file with rows of numbers")),
    };
    let found = match time.column {
        Some(name) => names.iter().position(|n| n == name).map(|i| (i, unit_s(name))),
        None => time_column(&names),
    };
    if found.is_none() && !time.rows {
        let wanted = time.column.map_or("no column of time".to_owned(), |name| format!("no column {name:?}"));
        let hint = format!("name it in the map, [time] column = \"...\": it has {}", names.join(", "));
        return Err(InputError::new(path, wanted, hint).at(1, 1));
    }
    let unit = time.unit_s.or(found.map(|(_, unit)| unit)).unwrap_or(1.0);
    let at = found.map(|(at, _)| at);
    let mut table = Table { time: at.map(|at| (names[at].clone(), unit)), ..Table::default() };
    let mut rows = 0.0;
    let number = |field: &[u8]| {
        let text = std::str::from_utf8(field).ok()?;
        let text = if separator == b',' { text.to_owned() } else { text.replace(',', ".") };
        text.parse::<f64>().ok()
    };
    while next(&mut record)? {
        let t = match at {
            Some(at) => {
                let Some(field) = record.get(at).filter(|f| !f.is_empty()) else { continue };
                let Some(t) = number(field) else {
                    let what = format!("{:?} is no time", String::from_utf8_lossy(field));
                    let line = record.position().map_or(1, ::csv::Position::line);
                    return Err(InputError::new(path, what, "write times as numbers")
                        .at(line as usize, 1)
                        .field(names[at].clone()));
                };
                t
            }
            None => rows,
        };
        rows += 1.0;
        for (i, (name, field)) in names.iter().zip(&record).enumerate() {
            if Some(i) != at
                && let Some(value) = number(field)
            {
                table.push(name, t * unit, value);
            }
        }
    }
    headings(&mut table);
    Ok(table)
}

/// Quaternions, four columns whose names differ in their last letter only, give headings: `.../orientation/z` and its
/// like, `.../orientation/yaw`.
fn headings(table: &mut Table) {
    let ends = ["x", "y", "z", "w"];
    let stems: Vec<String> = table.series.iter().filter_map(|s| s.name.strip_suffix('w').map(str::to_owned)).collect();
    for stem in stems {
        let parts: Vec<&super::Series> = ends.iter().filter_map(|end| table.find(&format!("{stem}{end}"))).collect();
        let [x, y, z, w] = parts[..] else { continue };
        let together = [x, y, z].iter().all(|s| s.t == w.t);
        let turned = |i: usize| [x.values[i], y.values[i], z.values[i], w.values[i]];
        let unit = |q: [f64; 4]| (q.iter().map(|c| c * c).sum::<f64>() - 1.0).abs() < 0.02;
        if !together || !(0..w.t.len()).all(|i| unit(turned(i))) {
            continue;
        }
        let times = w.t.clone();
        let yaws: Vec<f64> = (0..times.len()).map(|i| heading(turned(i))).collect();
        for (t, yaw) in times.into_iter().zip(yaws) {
            table.push(&format!("{stem}yaw"), t, yaw);
        }
    }
}
