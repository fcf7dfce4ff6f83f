//! Rows of numbers, each with its time, become series. One file may hold several recordings, one after the other: where
//! its time starts again, the next begins.

use std::path::Path;

use super::{Clock, Restart, Table, units};
use crate::error::InputError;

/// First words of names that time goes by.
const TIMES: [&str; 12] =
    ["t", "time", "timestamp", "stamp", "seconds", "elapsed", "millis", "micros", "zeit", "clock", "sec", "secs"];

/// The column of time and its unit in seconds, where the map says nothing of it.
pub(super) fn named_like_time(names: &[String]) -> Option<(usize, f64)> {
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

/// Steps before it in which a step over the end of a register may be: rows are late now and then, and a recording that
/// ended just there by chance is not that near.
const USUAL: f64 = 4.0;

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
    /// The time as the file has it in the last row, its step to that, and what a counter of time lost so far.
    register: (f64, f64, f64),
    /// A row whose time went back, of which the next tells whether a recording begins there: its line, time and fields.
    back: Option<(usize, f64, Vec<Option<f64>>)>,
    /// Rows left out because their time went back: how many, the line of the first and its time in the file's unit.
    left_out: Option<(usize, usize, f64)>,
    /// Rows of numbers without a time that is one: how many, and the line of the first.
    untimed: Option<(usize, usize)>,
    /// Numbers beyond all that a computer holds: how many, and the line and the name of the first.
    endless: Option<(usize, usize, String)>,
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
        Some(Self {
            names,
            clock,
            at,
            unit_s,
            rows: 0.0,
            recording: 1,
            first: None,
            last: 0.0,
            register: (f64::NAN, f64::NAN, 0.0),
            back: None,
            left_out: None,
            untimed: None,
            endless: None,
        })
    }

    /// The column of time and its unit, s.
    pub(super) fn time(&self) -> Option<(String, f64)> {
        self.at.map(|at| (self.names[at].clone(), self.unit_s))
    }

    /// Seconds in the unit of its column of time.
    pub(super) fn in_its_unit(&self, seconds: f64) -> f64 {
        seconds / self.unit_s
    }

    /// The column of time and its name.
    pub(super) fn time_column(&self) -> Option<(usize, &str)> {
        self.at.map(|at| (at, self.names[at].as_str()))
    }

    /// Begins the next recording, whose first row has this line or number.
    pub(super) fn restart(&mut self, table: &mut Table, line: usize) {
        self.recording += 1;
        self.first = None;
        let restart = table.restart.get_or_insert(Restart { line, recordings: 1 });
        restart.recordings = restart.recordings.max(self.recording);
    }

    /// Adds a row of which `line` is the line, or the number; one without time is none.
    pub(super) fn push(&mut self, table: &mut Table, line: usize, row: impl Fn(usize) -> Option<f64>) {
        // Some writers have NaN where there is no number.
        let row = |i: usize| row(i).filter(|x| !x.is_nan());
        let t = match self.at {
            Some(at) => match row(at).filter(|t| t.is_finite()) {
                Some(t) => t,
                None => {
                    if (0..self.names.len()).any(|i| i != at && row(i).is_some()) {
                        self.untimed.get_or_insert((0, line)).0 += 1;
                    }
                    return;
                }
            },
            None => self.rows,
        };
        if let Some(first) = (0..self.names.len()).find(|i| row(*i).is_some_and(f64::is_infinite)) {
            self.endless.get_or_insert_with(|| (0, line, self.names[first].clone())).0 += 1;
        }
        let t = self.counted_on(t);
        self.rows += 1.0;
        let fields: Vec<Option<f64>> = (0..self.names.len()).map(row).collect();
        let goes_back = self.goes_back(t);
        // One row alone, or several of one time, are no recording: a writer that was stopped leaves zeros.
        if self.back.as_ref().is_some_and(|(_, began, _)| *began == t) {
            self.leave_out(line, t);
            return;
        }
        match self.back.take() {
            Some((line, began, fields)) if goes_back => {
                self.restart(table, line);
                self.add(table, began, &fields);
            }
            Some((line, began, _)) => self.leave_out(line, began),
            None => {}
        }
        if self.goes_back(t) {
            self.back = Some((line, t, fields));
        } else {
            self.add(table, t, &fields);
        }
    }

    /// The time of a counter of 16 or 32 bits that began again, which shows by a step over the end that is as usual.
    fn counted_on(&mut self, t: f64) -> f64 {
        let (last, step, lost) = &mut self.register;
        if let Some(wraps) = self.clock.wraps {
            *lost += if t < *last { wraps } else { 0.0 };
            *last = t;
            return t + *lost;
        }
        let again = [16, 32].map(|bits| 2.0_f64.powi(bits)).into_iter().find(|range| {
            let over = t + range - *last;
            t < *last && t >= 0.0 && *last < *range && over > 0.0 && over <= USUAL * *step
        });
        *lost += again.unwrap_or(0.0);
        *step = t + again.unwrap_or(0.0) - *last;
        *last = t;
        t + *lost
    }

    fn leave_out(&mut self, line: usize, t: f64) {
        let (rows, first, began) = self.left_out.get_or_insert((0, line, t));
        *rows += 1;
        // The row that began them is known to be one of them only when the next is read.
        if line < *first {
            (*first, *began) = (line, t);
        }
    }

    /// Says of the table which rows are not in it; `place` is what their numbers count, lines or rows.
    pub(super) fn finish(mut self, table: &mut Table, place: &str) {
        if let Some((line, began, _)) = self.back.take() {
            self.leave_out(line, began);
        }
        let said = |rows: usize, one: &str, more: &str| match rows {
            1 => format!("1 row {one}"),
            _ => format!("{rows} rows {more}"),
        };
        if let Some((rows, line)) = self.untimed {
            let are = said(rows, "is left out: its", "are left out: their");
            table.remarks.push(format!("{are} time is no number, the first in {place} {line}"));
        }
        if let Some((rows, line, name)) = self.endless {
            let have = said(rows, "has", "have");
            let what = "a number without end, taken as no sample";
            table.remarks.push(format!("{have} {what}, the first in {place} {line}, {name}"));
        }
        if let Some((rows, line, t)) = self.left_out {
            let (are, their) = if rows == 1 { ("1 row is", "its") } else { (&*format!("{rows} rows are"), "their") };
            let zeros = if t == 0.0 { ", as where a logger stopped and left zeros" } else { "" };
            table
                .remarks
                .push(format!("{are} left out, the first in {place} {line}: {their} time goes back to {t}{zeros}"));
        }
    }

    /// Whether a recording may begin. Rows that overtook others are no restart: it goes back over half of what was recorded.
    fn goes_back(&self, t: f64) -> bool {
        self.first.is_some_and(|first| t < self.last - 0.5 * (self.last - first))
    }

    fn add(&mut self, table: &mut Table, t: f64, fields: &[Option<f64>]) {
        self.first.get_or_insert(t); // it may be negative
        self.last = t;
        if self.clock.recording.is_some_and(|wanted| wanted != self.recording) {
            return;
        }
        for (i, (name, value)) in self.names.iter().zip(fields).enumerate() {
            if Some(i) != self.at
                && let Some(value) = value
            {
                table.push(name, t * self.unit_s, *value);
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

#[cfg(test)]
mod tests {
    use super::super::Map;
    use super::*;

    fn made(map: &str, text: &str) -> Result<crate::Run, String> {
        let map = Map::parse(map, Path::new("map.toml")).map_err(|e| e.to_string())?;
        let path = Path::new("in.csv");
        let table = Table::of_bytes(text.as_bytes(), path, None, &map.time().unwrap()).map_err(|e| e.to_string())?;
        map.run(&table, path).map_err(|e| e.to_string())
    }

    /// Steps of a motor in one file, each with its own time from 0; a row that another overtook is no new one.
    const STEPS: &str =
        "t,duty,pos\n0.00,0.2,0\n0.02,0.2,1\n0.01,0.2,1\n0.03,0.2,2\n0.0,0.4,9\n0.01,0.4,11\n0.02,0.4,15\n";
    const COLUMNS: &str = "[columns]\nenc_1 = \"pos\"\nduty_1 = \"duty\"\n";

    #[test]
    fn several_recordings_in_a_file_are_several_runs() {
        let error = made(COLUMNS, STEPS).unwrap_err();
        assert_eq!(
            error,
            "in.csv:6:1: its time starts again: it holds 2 recordings; give a folder to write to, which gets a \
             run of each, or recording = 1 in the map's [time], then 2, ..."
        );
        let of = |n: usize| made(&format!("[time]\nrecording = {n}\n{COLUMNS}"), STEPS);
        assert_eq!(
            (of(1).unwrap().counts[0].clone(), of(2).unwrap().t.clone()),
            (vec![0, 1, 1, 2], vec![0.0, 0.01, 0.02])
        );
        assert!(of(3).unwrap_err().contains("has no recording 3: its time starts 2 times"));
        let ramps = "t,duty,pos\n0,0,0\n1,0,0\n2,0,0\n";
        assert!(made(&format!("[time]\nrecording = 2\n{COLUMNS}"), ramps).unwrap_err().contains("starts 1 times"));
    }

    /// Rows of a radio with their packet's number, of 8 bits, some lost.
    #[test]
    fn numbers_of_packets_are_a_time() {
        let of = |time: &str, numbers: &[u32]| {
            let rows: String = numbers.iter().enumerate().map(|(i, n)| format!("{n},0.2,{i}\n")).collect();
            made(&format!("[time]\ncolumn = \"packet\"\n{time}{COLUMNS}"), &format!("packet,duty,pos\n{rows}"))
        };
        let run = of("per_second = 100\nwraps = 256\n", &[250, 252, 255, 1, 200, 255, 3]).unwrap();
        assert_eq!(run.t, [0.0, 0.02, 0.05, 0.07, 2.06, 2.61, 2.65]);
        assert!(of("wraps = 0\n", &[1, 2]).unwrap_err().contains("time.wraps: 0 is no end of a counter"));
    }

    #[test]
    fn a_counter_of_time_that_begins_again_goes_on() {
        let of = |times: &[u64]| {
            let rows: String = times.iter().enumerate().map(|(i, t)| format!("{t},0.2,{i}\n")).collect();
            made(&format!("[time]\nunit = \"ms\"\n{COLUMNS}"), &format!("t,duty,pos\n{rows}"))
        };
        assert_eq!(of(&[65500, 65520, 4, 24, 64]).unwrap().t, [0.0, 0.02, 0.04, 0.06, 0.1]);
        let micros = of(&[4_294_967_000, 4_294_967_200, 104, 304]).unwrap();
        assert!((micros.t[2] - 0.4).abs() < 1e-9 && (micros.t[3] - 0.6).abs() < 1e-9, "{:?}", micros.t);
        // What ended elsewhere is another recording.
        assert!(of(&[60000, 60020, 4, 24, 44]).unwrap_err().contains("2 recordings"));
        assert!(of(&[65000, 65020, 4, 24, 44]).unwrap_err().contains("2 recordings"));
    }

    #[test]
    fn rows_of_one_time_that_went_back_are_no_recording() {
        let rows = "t,duty,pos\n0.00,0.2,0\n0.02,0.2,1\n0,0,0\n0.04,0.2,2\n0.06,0.2,3\n0,0,0\n0,0,0\n";
        assert_eq!(made(COLUMNS, rows).unwrap().counts[0], [0, 1, 2, 3]);
    }

    #[test]
    fn rows_that_are_left_out_are_said() {
        let read = |text: &str| {
            Table::of_bytes(text.as_bytes(), Path::new("in.csv"), None, &Clock::default()).unwrap().remarks
        };
        let rows = "t,duty,pos\n0.00,0.2,0\n0.02,0.2,1\n0.03,0,0\n0.04,0.2,2\n";
        assert_eq!(read(rows), Vec::<String>::new());
        let left = read(&format!("{rows}0,0,0\n0,0,0\n0,0,0\n"));
        assert!(left.len() == 1 && left[0].starts_with("3 rows are left out, the first in line 6"), "{left:?}");
        assert_eq!(read(STEPS), Vec::<String>::new(), "a recording is none");
        let one = read("t,duty,pos\n0.00,0.2,0\n0.02,0.2,1\n0,0,0\n0.04,0.2,2\n0.06,0.2,3\n");
        assert!(one[0].starts_with("1 row is left out, the first in line 4"), "{one:?}");
    }

    #[test]
    fn times_that_tell_no_rows_apart_are_refused_and_some_are_said() {
        let map = "[columns]\nenc_1 = \"n\"\nspeed_1 = \"v\"\n";
        let log = |time: &dyn Fn(u32) -> String, v: &dyn Fn(u32) -> u32| {
            let row = |k| format!("{},{k},{}\n", time(k), v(k));
            format!("time,n,v\n{}", (0..400).map(row).collect::<String>())
        };
        // Seconds, at a hundred rows each.
        let error = made(map, &log(&|k| (k / 100).to_string(), &|k| k)).unwrap_err();
        assert!(error.contains("time: its times are too coarse: 100 rows have the same"), "{error}");
        assert!(error.contains("rate_hz = 133"), "{error}");
        // Nanoseconds of which a spreadsheet kept six digits; and those that somebody took for seconds.
        for time in [&(|_| "1.62766E+18".to_owned()) as &dyn Fn(u32) -> String, &|k| {
            (1_627_660_000_000_000_000 + u64::from(k)).to_string()
        }] {
            let error = made(map, &log(time, &|k| k)).unwrap_err();
            assert!(error.contains("400 rows have the same; write times with all their digits"), "{error}");
        }
        // A row that stands twice is one; of one time with two values one is lost.
        let twice = log(&|k| format!("{}", f64::from(k - k % 2) * 0.01), &|_| 5).replace("n,v", "m,v");
        assert_eq!(made("[columns]\nspeed_1 = \"v\"\n", &twice).unwrap().t.len(), 200);
        let some = log(&|k| (if k % 10 == 9 { k - 1 } else { k }).to_string(), &|_| 5);
        let table = Table::of_bytes(some.as_bytes(), Path::new("log.csv"), None, &Clock::default()).unwrap();
        let remarks = |map: &str| -> Vec<String> {
            let folder = tempfile::tempdir().unwrap();
            let log = folder.path().join("log.csv");
            std::fs::write(&log, &some).unwrap();
            Map::parse(map, Path::new("map.toml")).unwrap().import(&log, None).unwrap().remarks
        };
        assert!(table.remarks.is_empty() && remarks("[columns]\nspeed_1 = \"v\"\n").is_empty());
        let said = remarks(map);
        assert!(said.len() == 1 && said[0].starts_with("40 of 400 rows have the time of the one before"), "{said:?}");
    }

    #[test]
    fn times_that_are_no_numbers_and_numbers_without_end_are_said() {
        let read = |text: &str| {
            Table::of_bytes(text.as_bytes(), Path::new("in.csv"), None, &Clock::default()).unwrap().remarks
        };
        let rows = "t,duty,pos\n0.00,0.2,0\n0.02,0.2,1\n,,\n0.04,nan,2\n";
        assert_eq!(read(rows), Vec::<String>::new(), "a row of nothing, and no sample");
        assert_eq!(
            read(&format!("{rows}nan,0.2,3\n0.06,0.2,4\n1e999,0.2,5\n,0.2,6\n0.08,0.2,7\n0.1,-1e999,8\n")),
            [
                "3 rows are left out: their time is no number, the first in line 6",
                "1 row has a number without end, taken as no sample, the first in line 11, duty",
            ]
        );
        // A line is one as an editor counts it, whatever ends it.
        for (ends, line) in [("\r\n", 4), ("\n", 4), ("\n\n", 7), ("\r\n\r\n", 7)] {
            let text = ["\u{feff}t;duty;pos", "0,00;0,2;0", "0,02;0,2;1", "nan;0,2;3", "0,06;0,2;4", ""].join(ends);
            assert_eq!(read(&text), [format!("1 row is left out: its time is no number, the first in line {line}")]);
        }
    }

    #[test]
    fn what_a_driver_cuts_off_has_a_limit() {
        let text = "t,pid,pos\n0,50,0\n0.02,145,1\n0.04,-160,3\n0.06,-20,3\n";
        let map = |limit: &str| {
            format!("[columns]\nenc_1 = \"pos\"\nduty_1 = {{ from = \"pid\", unit = \"percent\"{limit} }}\n")
        };
        let error = made(&map(""), text).unwrap_err();
        assert!(error.contains("duty 1.45 is not within") && error.contains("limit = 1"), "{error}");
        assert_eq!(made(&map(", limit = 1"), text).unwrap().duty[0], [0.5, 1.0, -1.0, -0.2]);
        assert!(made(&map(", limit = -1"), text).unwrap_err().contains("limit = -1 is no limit"));
    }

    #[test]
    fn a_file_without_time_has_so_many_rows_a_second() {
        let text = "u y\n0.5 0\n0.5 3\n0.5 9\n";
        let columns = "[columns]\nenc_1 = \"y\"\nduty_1 = \"u\"\n";
        assert_eq!(made(&format!("[time]\nrate_hz = 50\n{columns}"), text).unwrap().t, [0.0, 0.02, 0.04]);
        assert!(made(columns, text).unwrap_err().contains("or say how many rows a second it has, rate_hz = 100"));
        for (time, message) in [
            ("rate_hz = 0", "time.rate_hz: 0 rows a second are none"),
            ("rate_hz = 50\ncolumn = \"u\"", "time.rate_hz: there is a column of time, or none"),
        ] {
            let error = made(&format!("[time]\n{time}\n{columns}"), text).unwrap_err();
            assert!(error.contains(message), "{error}");
        }
    }

    #[test]
    fn lines_that_begin_with_a_word_are_a_table_a_word() {
        let text =
            "# log of a robot\nPOSE 0.0 1.0 2.0 0.5\nODOM 0.05 0.2 0.3\nODOM 0.15 0.2 0.3\nPOSE 0.2 1.1 2.0 0.6\n";
        let map = "[time]\ncolumn = \"column_2\"\n[frame]\nx = \"forward\"\n[columns]\nodom_vx = \"ODOM/column_3\"\n\
                   odom_w = \"ODOM/column_4\"\ncam_x = \"POSE/column_3\"\ncam_y = \"POSE/column_4\"\n\
                   cam_theta = \"POSE/column_5\"\n";
        let run = made(map, text).unwrap();
        assert_eq!((run.t.clone(), run.camera.len()), (vec![0.0, 0.05, 0.15, 0.2], 2));
        assert!((run.odometry.as_ref().unwrap()[0][2] - 0.02).abs() < 1e-4);
        // A word that no other row has is the row's own name: one table, as with names above it.
        let own = |head: &str, column: &str| {
            let rows = (0..70).map(|i| format!("frame{i:04}.jpg {i} {} 3\n", 2 * i)).collect::<String>();
            let map = format!("[time]\nrate_hz = 60\n[columns]\nenc_1 = {column:?}\n");
            made(&map, &(head.to_owned() + &rows)).unwrap().counts[0].clone()
        };
        assert_eq!(own("", "column_3")[69], 138);
        assert_eq!(own("# image x y theta\n", "y").len(), 70);
        // One word before numbers is a header: columns of a table that are called 0, 1, 2.
        let header = Table::of_bytes(b"time,0,1\n0.0,5,6\n", Path::new("x.csv"), None, &Clock::default()).unwrap();
        assert_eq!(header.find("1").unwrap().values, [6.0]);
    }
}
