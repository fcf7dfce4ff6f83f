//! Any text table with a column of time; empty fields and texts are no samples. PlotJuggler's exports have the time in
//! `__time`. Lines that begin with a word, such as `ODOM 0.1 2.5`, are one table a word: `ODOM/column_2`.

use std::path::Path;

use super::rows::{self, Rows};
use super::sheet::{Sheet, numbered};
use super::{Clock, Table, heading};
use crate::error::InputError;

pub(super) fn read(bytes: &[u8], path: &Path, clock: &Clock) -> Result<Table, InputError> {
    let Sheet { names, rows: text, separator, tagged } = Sheet::of(bytes);
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
    let mut table = Table::default();
    // Kinds of rows, each with its columns: one, but where every line begins with a word that says what it is.
    let mut kinds: Vec<(Vec<u8>, Option<Rows>)> = Vec::new();
    let mut timeless = None;
    let mut begin = |prefix: &str, names: Vec<String>| {
        let rows = Rows::new(prefix, &names, clock);
        if rows.is_none() {
            timeless.get_or_insert_with(|| rows::timeless(path, &names, clock));
        }
        rows
    };
    if !tagged {
        let names = match names {
            Some(names) => names,
            None if next(&mut record)? => {
                record.iter().map(|field| String::from_utf8_lossy(field).trim().to_owned()).collect()
            }
            None => return Err(InputError::new(path, "is empty", "give a file with rows of numbers")),
        };
        kinds.push((Vec::new(), begin("", names)));
    }
    while next(&mut record)? {
        let tag = if tagged { record.get(0).unwrap_or_default() } else { b"" };
        let at = kinds.iter().position(|(known, _)| known == tag).unwrap_or_else(|| {
            let names = numbered(record.len());
            kinds.push((tag.to_owned(), begin(&format!("{}/", String::from_utf8_lossy(tag)), names)));
            kinds.len() - 1
        });
        let Some(rows) = &mut kinds[at].1 else { continue };
        let line = record.position().map_or(1, ::csv::Position::line) as usize;
        let number = |i: usize| record.get(i).and_then(|field| number(field, separator));
        if let Some((at, name)) = rows.time_column()
            && let Some(field) = record.get(at).filter(|f| !f.is_empty())
            && number(at).is_none()
        {
            let what = format!("{:?} is no time", String::from_utf8_lossy(field));
            return Err(InputError::new(path, what, "write times as numbers").at(line, 1).field(name));
        }
        rows.push(&mut table, line, number);
    }
    match timeless {
        Some(error) if kinds.iter().all(|(_, rows)| rows.is_none()) => return Err(error),
        _ => table.time = kinds.iter().flat_map(|(_, rows)| rows).find_map(Rows::time),
    }
    headings(&mut table);
    Ok(table)
}

fn number(field: &[u8], separator: u8) -> Option<f64> {
    let text = std::str::from_utf8(field).ok()?;
    if separator == b',' { text.parse().ok() } else { text.replace(',', ".").parse().ok() }
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
