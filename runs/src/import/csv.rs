//! Any text table with a column of time; empty fields and texts are no samples. PlotJuggler's exports have the time in
//! `__time`. Lines that begin with a word, such as `ODOM 0.1 2.5`, are one table a word: `ODOM/column_2`. Numbers that follow
//! their names, `t,340,PWM,60`, are a table with those names. Where a column says whose each row is, they are one a motor.

use std::collections::BTreeMap;
use std::path::Path;

use super::line::with_units;
use super::rows::{self, Rows};
use super::sheet::{Sheet, numbered};
use super::{Clock, Table, dates, heading, owner, titles};
use crate::error::InputError;

/// Rows without a number below the names at most, and before the numbers: units, and short names.
const HEADER_ROWS: usize = 2;

/// Rows of one time, of all, from which times are too coarse to tell rows apart.
pub(super) const COARSE: f64 = 0.5;

/// Rows that are looked at for dates: at up to so many a second whole seconds show that they go on.
const DATED: usize = 1000;

/// Share of a file's rows that have more fields than its names and its first row, from which these are columns. Reasoned: a row
/// that is torn, or runs into the next one, is one of many.
const WIDER: f64 = 0.05;

pub(super) fn read(bytes: &[u8], path: &Path, clock: &Clock) -> Result<Table, InputError> {
    let error = match read_by(bytes, path, clock) {
        Err(error) if clock.rows && clock.column.is_none() => error,
        done => return done,
    };
    // Whoever looks what is in a file gets to see the rest of it, too, where its time is none.
    let counted = Clock { column: Some(""), ..*clock };
    let mut table = read_by(bytes, path, &counted).map_err(|_| error.clone())?;
    table.remarks.push(format!("{}: {}; {}", error.field, error.what, error.hint));
    Ok(table)
}

fn read_by(bytes: &[u8], path: &Path, clock: &Clock) -> Result<Table, InputError> {
    let Sheet { names, rows: text, separator, tagged } = Sheet::of(bytes);
    let own = || titles::frames_per_s(bytes).filter(|_| clock.column.is_none());
    let rate_hz = clock.rate_hz.or_else(own);
    let dated = if clock.column.is_none() && rate_hz.is_none() {
        dated(if tagged { Some(&[]) } else { names.as_deref() }, &text, separator)
    } else {
        None
    };
    let clock = &Clock { rate_hz, column: clock.column.or(dated.as_deref()), ..*clock };
    let mut csv = ::csv::ReaderBuilder::new()
        .delimiter(separator)
        .flexible(true)
        .has_headers(false)
        .trim(::csv::Trim::All)
        .from_reader(&*text);
    let mut record = ::csv::ByteRecord::new();
    let mut lines = Lines { text: &text, at: 0, line: 1 };
    let mut next = |record: &mut ::csv::ByteRecord| {
        csv.read_byte_record(record).map_err(|e| InputError::new(path, e.to_string(), "save the log as CSV"))
    };
    let mut table = Table::default();
    // Kinds of rows, each with its columns and times of day: one, but where every line begins with a word that says what it is.
    let mut kinds: Vec<(Vec<u8>, Option<Rows>, Days)> = Vec::new();
    let mut timeless = None;
    // Whether a row is read and not looked at yet.
    let mut pending = false;
    let mut widths = Widths::default();
    let mut begin = |prefix: &str, names: Vec<String>| {
        let rows = Rows::new(prefix, &names, clock);
        if rows.is_none() {
            timeless.get_or_insert_with(|| rows::timeless(path, &names, clock));
        }
        rows
    };
    // The column that says whose a row is, and the names of all.
    let mut own: Option<(usize, Vec<String>)> = None;
    if !tagged {
        let texts = |record: &::csv::ByteRecord| -> Vec<String> {
            record.iter().map(|field| String::from_utf8_lossy(field).trim().to_owned()).collect()
        };
        let mut names = match names {
            Some(names) => names,
            None if next(&mut record)? => texts(&record),
            None => return Err(InputError::new(path, "is empty", "give a file with rows of numbers")),
        };
        // Below the names may stand their units, and other names.
        for _ in 0..HEADER_ROWS {
            pending = next(&mut record)?;
            let fields = texts(&record);
            if !pending || fields.iter().all(String::is_empty) || record.iter().any(|f| number(f, separator).is_some())
            {
                break;
            }
            names = with_units(names, &fields);
            pending = false;
        }
        widths.names = names.len();
        // Numbers beyond the names have none; a separator ends the lines of some writers.
        if pending && !names.is_empty() {
            let ended = usize::from(record.iter().next_back() == Some(b""));
            let first = record.len() - ended;
            let later = wider(&text, separator, first.max(widths.names));
            names.extend(numbered(later.map_or(first, |(fields, _)| fields)).into_iter().skip(widths.names));
            table.remarks.extend(later.map(|(fields, line)| {
                format!(
                    "from line {line} on rows have {fields} fields, and {} names stand above them: the others are {}, ...",
                    widths.names,
                    names[widths.names],
                )
            }));
        }
        own = match clock.of {
            Some(wanted) => Some(names.iter().position(|name| name == wanted).ok_or_else(|| {
                let hint = format!("it has {}", names.join(", "));
                InputError::new(path, format!("has no column {wanted:?}"), hint).field("time.rows_of")
            })?),
            None => owner::find(&names, &text, separator).and_then(|(at, keys)| {
                if !clock.rows {
                    table.remarks.push(format!(
                        "column {name:?} says whose each row is ({}): [time] rows_of = {name:?} in the map makes a table of \
                         each, with series such as {:?}",
                        keys.join(", "),
                        format!("{}/{}", keys[0], names.iter().rfind(|other| **other != names[at]).unwrap_or(&names[at])),
                        name = names[at],
                    ));
                }
                clock.rows.then_some(at)
            }),
        }
        .map(|at| (at, names.clone()));
        match &own {
            Some((at, _)) => table.of = Some(names[*at].clone()),
            None => kinds.push((Vec::new(), begin("", names), Days::default())),
        }
    }
    while std::mem::take(&mut pending) || next(&mut record)? {
        let key = own.as_ref().map(|(at, _)| owner::key(record.get(*at).unwrap_or_default()));
        if key.as_ref().is_some_and(String::is_empty) {
            continue;
        }
        let tag = match &key {
            Some(key) => key.as_bytes(),
            None if tagged => record.get(0).unwrap_or_default(),
            None => b"",
        };
        let at = kinds.iter().position(|(known, ..)| known == tag).unwrap_or_else(|| {
            let names = own.as_ref().map_or_else(|| numbered(record.len()), |(_, names)| names.clone());
            let rows = begin(&format!("{}/", String::from_utf8_lossy(tag)), names);
            kinds.push((tag.to_owned(), rows, Days::default()));
            kinds.len() - 1
        });
        let (_, Some(rows), days) = &mut kinds[at] else { continue };
        let line = lines.of(record.position().map_or(0, ::csv::Position::byte) as usize);
        widths.see(&record);
        let of = own.as_ref().map(|(at, _)| *at);
        let plain = |i: usize| record.get(i).filter(|_| Some(i) != of).and_then(|field| number(field, separator));
        let mut dated = None;
        if let Some((at, name)) = rows.time_column()
            && let Some(field) = record.get(at).filter(|f| !f.is_empty())
            && plain(at).is_none()
        {
            let text = String::from_utf8_lossy(field);
            let Some(seconds) = dates::seconds(&text) else {
                let hint = "write times as numbers, or as 2024-05-01T12:00:03.25 or 12:00:03.25";
                return Err(InputError::new(path, format!("{text:?} is no time"), hint).at(line, 1).field(name));
            };
            days.see(seconds, line, name);
            dated = Some((at, rows.in_its_unit(seconds)));
        }
        rows.push(&mut table, line, |i| dated.filter(|(at, _)| *at == i).map(|(_, t)| t).or_else(|| plain(i)));
    }
    if let Some(error) = kinds.iter().find_map(|(.., days)| days.too_coarse(path)) {
        return Err(error);
    }
    match timeless {
        Some(error) if kinds.iter().all(|(_, rows, _)| rows.is_none()) => return Err(error),
        _ => table.time = kinds.iter().flat_map(|(_, rows, _)| rows).find_map(Rows::time),
    }
    if let (Some((_, names)), Some((name, _))) = (&own, &mut table.time) {
        *name = names.iter().find(|own| name.ends_with(&format!("/{own}"))).unwrap_or(name).clone();
    }
    kinds.into_iter().filter_map(|(_, rows, _)| rows).for_each(|rows| rows.finish(&mut table, "line"));
    table.remarks.extend(widths.remark());
    headings(&mut table);
    super::rotations::headings(&mut table);
    Ok(table)
}

/// The lines at which records begin, one after the other. The reader's own count is behind where lines end in CR LF or are
/// empty, for it stops before what ends them.
struct Lines<'a> {
    text: &'a [u8],
    at: usize,
    line: usize,
}

impl Lines<'_> {
    fn of(&mut self, byte: usize) -> usize {
        let ends = self.text.iter().skip(byte).take_while(|b| b"\r\n".contains(b)).count();
        let begin = (byte + ends).min(self.text.len());
        self.line += self.text.get(self.at..begin).map_or(0, |passed| passed.iter().filter(|b| **b == b'\n').count());
        self.at = begin;
        self.line
    }
}

/// Times of day, and how many rows have that of the row before.
#[derive(Default)]
struct Days {
    rows: usize,
    repeated: usize,
    ends: Option<[f64; 2]>,
    /// The first row of another's time: its line, and the column.
    at: Option<(usize, String)>,
}

impl Days {
    fn see(&mut self, seconds: f64, line: usize, name: &str) {
        let [first, last] = self.ends.unwrap_or([seconds, f64::NAN]);
        self.rows += 1;
        if seconds == last {
            self.repeated += 1;
            self.at.get_or_insert_with(|| (line, name.to_owned()));
        }
        self.ends = Some([first, seconds]);
    }

    fn too_coarse(&self, path: &Path) -> Option<InputError> {
        let ([first, last], (line, name)) = (self.ends?, self.at.as_ref()?);
        if (self.repeated as f64) < COARSE * self.rows as f64 {
            return None;
        }
        let rate = self.rows as f64 / (last - first).max(1.0);
        let error = coarse(path, [self.rows, self.rows - self.repeated], Some(rate));
        Some(error.at(*line, 1).field(name.clone()))
    }
}

/// That so many rows have so few times, and how many there seem to be in a second.
pub(super) fn coarse(path: &Path, [rows, times]: [usize; 2], rate: Option<f64>) -> InputError {
    let each = rows as f64 / times.max(1) as f64;
    let rate = rate.map_or_else(|| "100".to_owned(), |rate| format!("{rate:.0}"));
    let hint = format!(
        "give another column of time, or how many rows come in a second in place of one: [time] rate_hz = {rate}"
    );
    InputError::new(path, format!("its times are too coarse: {each:.0} rows have the same"), hint)
}

/// The column that has a date or a time of day in every row, of a table in which no name is that of a time. Without `names`
/// they are the first row; columns without a name are numbered.
fn dated(names: Option<&[String]>, text: &[u8], separator: u8) -> Option<String> {
    let mut csv = ::csv::ReaderBuilder::new()
        .delimiter(separator)
        .flexible(true)
        .has_headers(false)
        .trim(::csv::Trim::All)
        .from_reader(text);
    let mut rows = csv.records().map_while(Result::ok).take(DATED);
    let owned = |record: &::csv::StringRecord| record.iter().map(str::to_owned).collect::<Vec<_>>();
    let named = match names {
        Some(names) => names.to_vec(),
        None => owned(&rows.next()?),
    };
    if rows::named_like_time(&named).is_some() {
        return None;
    }
    let mut rows: Vec<::csv::StringRecord> = rows.collect();
    let units =
        |row: &::csv::StringRecord| row.iter().all(|f| dates::seconds(f).is_none() && f.parse::<f64>().is_err());
    rows.drain(..rows.iter().take(HEADER_ROWS).take_while(|row| units(row)).count());
    let width = rows.first()?.len();
    let at = (0..width).find(|at| {
        let times: Option<Vec<f64>> = rows.iter().map(|row| row.get(*at).and_then(dates::seconds)).collect();
        times.is_some_and(|t| t.windows(2).all(|pair| pair[0] <= pair[1]) && t.first() < t.last())
    })?;
    named.get(at).cloned().or_else(|| numbered(width).into_iter().nth(at))
}

/// How many names a table has, and how many fields its rows.
#[derive(Default)]
struct Widths {
    names: usize,
    rows: usize,
    /// Fields of the first row, and how many rows have as many.
    fields: usize,
    alike: usize,
}

impl Widths {
    fn see(&mut self, record: &::csv::ByteRecord) {
        // A separator ends the lines of some writers.
        let fields =
            record.len() - usize::from(record.len() == self.names + 1 && record.iter().next_back() == Some(b""));
        if self.rows == 0 {
            self.fields = fields;
        }
        self.rows += 1;
        self.alike += usize::from(fields == self.fields);
    }

    /// What to say where all rows but one, which may be cut off, have more or fewer fields than there are names.
    fn remark(&self) -> Option<String> {
        let Self { names, rows, fields, alike } = *self;
        (names > 0 && rows > 1 && fields != names && alike + 1 >= rows).then(|| {
            format!(
                "{names} names stand above rows of {fields} fields: names may stand above the wrong numbers; compare the \
                 ranges that racbot convert --list shows with what the names say, and correct the header"
            )
        })
    }
}

/// How many fields many rows of a file have, if these are more, and the line of the first such row: it was written on when its
/// program logged more.
fn wider(text: &[u8], separator: u8, names: usize) -> Option<(usize, usize)> {
    let lines = || text.split(|b| *b == b'\n').map(<[u8]>::trim_ascii);
    let fields = |line: &[u8]| {
        let line = line.strip_suffix(&[separator]).unwrap_or(line);
        1 + line.iter().filter(|b| **b == separator).count()
    };
    let mut wide: BTreeMap<usize, usize> = BTreeMap::new();
    // Separators in quotes are a text's.
    for fields in lines().filter(|line| !line.contains(&b'"')).map(fields).filter(|fields| *fields > names) {
        *wide.entry(fields).or_default() += 1;
    }
    let (most, rows) = wide.into_iter().max_by_key(|(_, rows)| *rows)?;
    let often = rows as f64 >= WIDER * lines().count() as f64;
    let at = lines().position(|line| fields(line) == most)?;
    often.then_some((most, at + 1))
}

fn number(field: &[u8], separator: u8) -> Option<f64> {
    let text = std::str::from_utf8(field).ok()?;
    if separator == b',' {
        text.strip_suffix(';').unwrap_or(text).parse().ok()
    } else {
        text.replace(',', ".").parse().ok()
    }
}

/// Quaternions, columns whose names differ in their last letter only, give headings: `.../orientation/z` and its like,
/// `.../orientation/yaw`. What only turns on the floor may have `z` and `w` alone.
fn headings(table: &mut Table) {
    let stems: Vec<String> = table.series.iter().filter_map(|s| s.name.strip_suffix('w').map(str::to_owned)).collect();
    for stem in stems {
        let [x, y, z, w] = ["x", "y", "z", "w"].map(|end| table.find(&format!("{stem}{end}")));
        let (Some(z), Some(w)) = (z, w) else { continue };
        let tilts = [x, y].into_iter().flatten().collect::<Vec<_>>();
        if tilts.len() == 1 || tilts.iter().chain([&z]).any(|s| s.t != w.t) {
            continue;
        }
        let turned = |i: usize| {
            let tilt = |k: usize| tilts.get(k).map_or(0.0, |s| s.values[i]);
            [tilt(0), tilt(1), z.values[i], w.values[i]]
        };
        let unit = |q: [f64; 4]| (q.iter().map(|c| c * c).sum::<f64>() - 1.0).abs() < 0.02;
        if !(0..w.t.len()).all(|i| unit(turned(i))) {
            continue;
        }
        let times = w.t.clone();
        let yaws: Vec<f64> = (0..times.len()).map(|i| heading(turned(i))).collect();
        for (t, yaw) in times.into_iter().zip(yaws) {
            table.push(&format!("{stem}yaw"), t, yaw);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(text: &str) -> Result<Table, InputError> {
        read(text.as_bytes(), Path::new("x.csv"), &Clock::default())
    }

    #[test]
    fn numbers_behind_their_names_are_columns() {
        let read =
            table("=~=~= a terminal's log =~=~=\nt,1,PWM,0,v,0.5\nt,2,PWM,9,v,0.7\nt,3,PWM,-9,v,\nt,4,PWM,1,v,1\n")
                .unwrap();
        assert_eq!(read.find("PWM").unwrap().values, [0.0, 9.0, 1.0]);
        assert_eq!(read.find("v").unwrap().t, [1.0, 2.0, 4.0]);
    }

    #[test]
    fn quaternions_are_headings() {
        let [half, whole] = [0.5_f64.sqrt(), std::f64::consts::FRAC_PI_2];
        let yaw = |text: &str, name: &str| table(text).unwrap().find(name).map(|s| s.values.clone());
        for text in [
            format!("t,q/z,q/w\n0,0,1\n1,{half},{half}\n"),
            format!("t,q/x,q/y,q/z,q/w\n0,0,0,0,1\n1,0,0,{half},{half}\n"),
        ] {
            let yaw = yaw(&text, "q/yaw").unwrap();
            assert!(yaw[0] == 0.0 && (yaw[1] - whole).abs() < 1e-9, "{yaw:?}");
        }
        // Speeds and what tilts without saying how far are none.
        assert_eq!(yaw("t,z,w\n0,0.1,0.3\n1,0.1,0.4\n", "yaw"), None);
        assert_eq!(yaw("t,q/x,q/z,q/w\n0,0,0,1\n1,0,0,1\n", "q/yaw"), None);
    }

    #[test]
    fn names_after_the_mark_of_a_remark_may_stand_above_times_of_day() {
        let text = "#time;posL;velL\n0:00:00.010;5725.0;96.0\n0:00:00.110;6955.0;156.0\n0:00:01.210;8000.0;160.0\n";
        let table = table(text).unwrap();
        let place = table.find("posL").unwrap();
        assert_eq!(place.values, [5725.0, 6955.0, 8000.0]);
        assert!((place.t[2] - place.t[0] - 1.2).abs() < 1e-9, "{:?}", place.t);
    }

    #[test]
    fn more_names_than_numbers_are_said() {
        let remarks = |text: &str| table(text).unwrap().remarks;
        let shifted = remarks("t,spare,x,y\n0,1,2\n1,1,2\n2,1,3\n3,1\n");
        assert!(shifted.len() == 1 && shifted[0].starts_with("4 names stand above rows of 3 fields"), "{shifted:?}");
        assert_eq!(remarks("t x\n0 1 2\n1 1 2\n").len(), 1);
        // What stands beyond the names is shown.
        assert_eq!(table("t x\n0 1 2\n1 1 3\n").unwrap().find("column_3").unwrap().values, [2.0, 3.0]);
        // A program that logged more from some day on, into the same file; one torn row is none.
        let rows = |k: usize| (0..k).map(|k| format!("{k},0.1,5\n")).collect::<String>();
        let wide = (40..49).map(|k| format!("{k},0.1,5,24.1,2\n")).collect::<String>();
        let later = table(&format!("t,duty,rpm\n{}{wide}", rows(40))).unwrap();
        let torn = table(&format!("t,duty,rpm\n{}40,1,5,2\n", rows(40))).unwrap();
        assert_eq!(later.find("column_4").unwrap().values, [24.1; 9]);
        assert!(later.remarks[0].starts_with("from line 42 on rows have 5 fields, and 3 names"), "{:?}", later.remarks);
        let quoted = "40,\"a,b\",5\n".repeat(9);
        assert!(table(&format!("t,duty,rpm\n{}{quoted}", rows(40))).unwrap().find("column_4").is_none());
        assert!(torn.find("column_4").is_none() && torn.remarks.is_empty(), "{:?}", torn.remarks);
        for right in ["t,x\n0,1,\n1,1,\n", "t,x,\n0,1,\n1,1,\n", "t,x,y\n0,1,\n1,1\n2,,3\n", "t,x\n0,1\n1\n"] {
            assert_eq!(remarks(right), Vec::<String>::new(), "{right}");
        }
    }

    #[test]
    fn dates_are_the_time_of_a_table_in_which_no_name_is() {
        let rows = |before: &str| {
            (0..90)
                .map(|k| format!("{before}2024-05-01 12:00:{:02}.{},{k},{}\n", k / 2, k % 2 * 5, 3 * k))
                .collect::<String>()
        };
        for (head, before, column, other) in [
            ("", "", "column_1", "column_3"),
            ("when,left,right\n", "", "when", "right"),
            ("when,left,right\n,ticks,ticks\n", "", "when", "right [ticks]"),
            ("", "ODOM,", "ODOM/column_2", "ODOM/column_4"),
        ] {
            let table = table(&(head.to_owned() + &rows(before))).unwrap();
            assert_eq!(table.time.as_ref().map(|(name, _)| name.as_str()), Some(column));
            let t = &table.find(other).unwrap().t;
            assert!(t.len() == 90 && t.windows(2).all(|w| (w[1] - w[0] - 0.5).abs() < 1e-6), "{head:?} {t:?}");
        }
        // The day on which a file was begun, or a name that is that of a time, leave things as they were.
        let begun = "day,n,m\n2024-05-01 12:00:00,1,2\n2024-05-01 12:00:00,2,4\n2024-05-01 12:00:00,3,6\n";
        assert!(table(begun).unwrap_err().to_string().contains("no column of time"));
        let both = table("saved,t,m\n2024-05-01 12:00:00,1,2\n2024-05-01 12:00:01,3,4\n").unwrap();
        assert_eq!(both.find("m").unwrap().t, [1.0, 3.0]);
    }

    /// Every motor has a row of its own at each time.
    #[test]
    fn rows_of_several_motors_share_their_times_of_day() {
        let row = |k: usize| ["A", "B", "C"].map(|m| format!("{m},2024-05-01 12:00:{k:02},{k}\n")).concat();
        let text = format!("motor,time,speed\n{}", (0..50).map(row).collect::<String>());
        let clock = Clock { of: Some("motor"), ..Clock::default() };
        let table = read(text.as_bytes(), Path::new("x.csv"), &clock).unwrap();
        assert_eq!(table.find("C/speed").unwrap().t.len(), 50);
    }

    #[test]
    fn times_of_day_are_times_unless_they_are_too_coarse() {
        let plain =
            table("TIMESTAMP,a\n2024-05-01 12:00:59.90,1\n2024-05-01 12:01:00.15,2\n2024-05-01 12:01:00.40,3\n");
        let times = &plain.unwrap().series[0].t;
        assert!((times[1] - times[0] - 0.25).abs() < 1e-6 && (times[2] - times[1] - 0.25).abs() < 1e-6, "{times:?}");
        let rows: String = (0..90).map(|k| format!("2022-11-16.19:06:{:02},{k}\n", 18 + k / 30)).collect();
        let text = format!("TIMESTAMP,a\n{rows}");
        let error = table(&text).unwrap_err().to_string();
        assert!(error.contains("TIMESTAMP: its times are too coarse: 30 rows have the same"), "{error}");
        assert!(error.contains("rate_hz = 45"), "{error}");
        // Whoever asks what is in it is shown the rest.
        let seen = read(text.as_bytes(), Path::new("x.csv"), &Clock { rows: true, ..Clock::default() });
        let seen = seen.unwrap();
        assert!(seen.time.is_none() && seen.find("a").is_some_and(|a| a.values.len() == 90), "{:?}", seen.remarks);
        assert!(seen.remarks[0].starts_with("TIMESTAMP: its times are too coarse"), "{:?}", seen.remarks);
    }

    #[test]
    fn rows_of_units_and_short_names_belong_to_the_header() {
        let text = "Time;1st motor position;2nd motor position;Angle;State\nms;ticks;ticks;deg;\nt;m1pos;m2pos;ang;s\n\
                    0,5;1;2;90;on\n20,5;3;5;91;on\n";
        let read = table(text).unwrap();
        assert_eq!(read.time, Some(("Time [ms]".to_owned(), 1e-3)));
        assert_eq!(read.find("1st motor position [ticks]").unwrap().values, [1.0, 3.0]);
        assert_eq!(read.find("Angle [deg]").unwrap().t, [0.0005, 0.0205]);
        // Two of words that are no units change no name, and a table that never has a number is refused.
        let plain = table("t,a\nfirst,second\n0,1\n1,2\n").unwrap();
        assert_eq!(plain.find("a").unwrap().values, [1.0, 2.0]);
        let error = table("t,a\nx,y\nx,y\nx,y\nx,y\n").unwrap_err().to_string();
        assert!(error.contains("x.csv:4:1") && error.contains("is no time"), "{error}");
    }
}
