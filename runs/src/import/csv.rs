//! Any CSV with a header row and a column of time; empty fields and texts are no samples. PlotJuggler's exports have the
//! time in `__time`.

use std::path::Path;

use super::Table;
use crate::error::InputError;
use crate::read::separator;

/// Names that time goes by.
const TIMES: [&str; 12] = [
    "t",
    "time",
    "timestamp",
    "__time",
    "time_s",
    "t_s",
    "stamp",
    "seconds",
    "time (s)",
    "time [s]",
    "timestamp_s",
    "elapsed",
];

pub(super) fn read(bytes: &[u8], path: &Path, (time, unit): (Option<&str>, f64)) -> Result<Table, InputError> {
    let separator = separator(bytes);
    let mut csv = ::csv::ReaderBuilder::new()
        .delimiter(separator)
        .flexible(true)
        .has_headers(false)
        .trim(::csv::Trim::All)
        .from_reader(bytes);
    let mut record = ::csv::ByteRecord::new();
    let mut next = |record: &mut ::csv::ByteRecord| {
        csv.read_byte_record(record).map_err(|e| InputError::new(path, e.to_string(), "save the log as CSV"))
    };
    if !next(&mut record)? {
        return Err(InputError::new(path, "is empty", "give a file with a header row"));
    }
    let names: Vec<String> = record
        .iter()
        .map(|field| String::from_utf8_lossy(field.strip_prefix(b"\xef\xbb\xbf").unwrap_or(field)).trim().to_owned())
        .collect();
    let at = match time {
        Some(name) => names.iter().position(|n| n == name),
        None => names.iter().position(|n| TIMES.contains(&n.to_lowercase().as_str())),
    };
    let Some(at) = at else {
        let wanted = time.map_or("no column of time".to_owned(), |name| format!("no column {name:?}"));
        let hint = format!("name it in the map, [time] column = \"...\": it has {}", names.join(", "));
        return Err(InputError::new(path, wanted, hint).at(1, 1));
    };
    let mut table = Table::default();
    let number = |field: &[u8]| {
        let text = std::str::from_utf8(field).ok()?;
        let text = if separator == b',' { text.to_owned() } else { text.replace(',', ".") };
        text.parse::<f64>().ok()
    };
    while next(&mut record)? {
        let Some(field) = record.get(at).filter(|f| !f.is_empty()) else { continue };
        let Some(t) = number(field) else {
            let what = format!("{:?} is no time", String::from_utf8_lossy(field));
            let line = record.position().map_or(1, ::csv::Position::line);
            return Err(InputError::new(path, what, "write times as numbers")
                .at(line as usize, 1)
                .field(names[at].clone()));
        };
        for (i, (name, field)) in names.iter().zip(&record).enumerate() {
            if i != at
                && let Some(value) = number(field)
            {
                table.push(name, t * unit, value);
            }
        }
    }
    Ok(table)
}
