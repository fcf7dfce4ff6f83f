//! The map: which series is which column, in which unit, sign and frame.

use std::collections::BTreeMap;
use std::f64::consts::{FRAC_PI_2, TAU};
use std::path::{Path, PathBuf};

use serde::Deserialize;

use super::fill::{Wanted, counts, integrate, speeds_of_commands, unwrapped};
use super::{Clock, Format, Table, units};
use crate::columns::{Column, GROUPS, missing_member};
use crate::error::{InputError, line_and_column, nearest};
use crate::frames::{Pose, wrap_angle};
use crate::geometry::Geometry;
use crate::robot::Robot;
use crate::{CameraSample, Run};

/// A map as its TOML has it; see `docs/book/src/log-format.md`.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Map {
    format: Option<String>,
    #[serde(default)]
    time: Time,
    #[serde(default)]
    frame: Frame,
    #[serde(default)]
    columns: BTreeMap<String, Source>,
    #[serde(default)]
    derive: Derive,
    /// What [`Derive::speeds`] names.
    #[serde(skip)]
    geometry: Option<Geometry>,
}

#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct Derive {
    /// A `robot.toml`, from the map's folder: wheel speeds are those that its geometry makes of the commands, for a
    /// robot whose wheels nobody logged.
    speeds: Option<PathBuf>,
}

#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct Time {
    column: Option<String>,
    unit: Option<String>,
    /// Rows a second, of a file without a column of time.
    rate_hz: Option<f64>,
    /// Which recording of a file with several, from 1.
    recording: Option<usize>,
    /// Keep the file's time instead of beginning at 0.
    #[serde(default)]
    keep: bool,
}

#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct Frame {
    #[serde(default)]
    x: Axis,
    #[serde(default)]
    y: Up,
    #[serde(default)]
    headings: Sense,
}

#[derive(Debug, Clone, Copy, Default, PartialEq, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Axis {
    #[default]
    Right,
    Forward,
}

#[derive(Debug, Clone, Copy, Default, PartialEq, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Up {
    #[default]
    Up,
    Down,
}

#[derive(Debug, Clone, Copy, Default, PartialEq, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Sense {
    #[default]
    CounterClockwise,
    Clockwise,
}

#[derive(Debug, Clone)]
enum Source {
    Name(String),
    Scaled(Scaled),
}

/// As text or table, with the fault of the table, which an untagged enum would not say.
impl<'de> Deserialize<'de> for Source {
    fn deserialize<D: serde::Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        struct Either;
        impl<'de> serde::de::Visitor<'de> for Either {
            type Value = Source;

            fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
                f.write_str("the name of a series, or { from = \"its name\", unit = \"mm\" }")
            }

            fn visit_str<E>(self, name: &str) -> Result<Source, E> {
                Ok(Source::Name(name.to_owned()))
            }

            fn visit_map<A: serde::de::MapAccess<'de>>(self, map: A) -> Result<Source, A::Error> {
                Scaled::deserialize(serde::de::value::MapAccessDeserializer::new(map)).map(Source::Scaled)
            }
        }
        from.deserialize_any(Either)
    }
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
struct Scaled {
    from: String,
    #[serde(default)]
    unit: String,
    scale: Option<f64>,
    #[serde(default)]
    offset: f64,
    /// Counts a turn of an encoder whose log has angles.
    counts_per_rev: Option<f64>,
    /// The value is known but for multiples of this, such as 4096 of an encoder of one turn or 65536 of a number of 16
    /// bits, in the file's unit.
    wraps: Option<f64>,
}

/// Velocities of the body that its odometry was made of: integrated, they are the odometry.
const RATES: [&str; 3] = ["odom_vx", "odom_vy", "odom_w"];

impl Map {
    /// Reads a map.
    ///
    /// # Errors
    /// [`InputError`] with line and column for text that is no TOML or has keys that no map has, and for formats, columns
    /// and units that nobody knows.
    pub fn load(path: &Path) -> Result<Self, InputError> {
        let text = std::fs::read_to_string(path).map_err(|e| InputError::io(path, &e))?;
        Self::parse(&text, path)
    }

    /// Reads the text of a map; `path` is for the error messages.
    ///
    /// # Errors
    /// As [`Map::load`].
    pub fn parse(text: &str, path: &Path) -> Result<Self, InputError> {
        let mut map: Self = toml::from_str(text).map_err(|e| {
            let (line, column) = line_and_column(text, e.span().map_or(0, |s| s.start));
            let hint = "see docs/book/src/log-format.md for what a map may say";
            InputError::new(path, e.message().replace('\n', " "), hint).at(line, column)
        })?;
        if let Some(name) = map.format.as_deref().filter(|name| Format::from_name(name).is_none()) {
            let hint = "give csv, plotjuggler, json, ros2, ssl-log or wpilog, or leave it out";
            return Err(InputError::new(path, format!("{name:?} is no format"), hint).field("format"));
        }
        map.time_unit().map_err(|e| InputError { file: path.to_owned(), ..e })?;
        map.wanted().map_err(|e| InputError { file: path.to_owned(), ..e })?;
        if let Some(robot) = &map.derive.speeds {
            let file = path.parent().unwrap_or(Path::new("")).join(robot);
            let geometry = Robot::load_partial(&file)?.geometry();
            map.geometry =
                Some(geometry.map_err(|e| InputError::new(&file, e.to_string(), "give the places of its wheels"))?);
        }
        Ok(map)
    }

    /// The kind of file that it is for, if it says so.
    pub fn format(&self) -> Option<Format> {
        self.format.as_deref().and_then(Format::from_name)
    }

    /// What it says of the time column of a CSV.
    ///
    /// # Errors
    /// [`InputError`] for a unit that is none of time.
    pub fn time(&self) -> Result<Clock<'_>, InputError> {
        Ok(Clock {
            column: self.time.column.as_deref(),
            unit_s: self.time_unit()?,
            rate_hz: self.time.rate_hz,
            recording: self.time.recording,
            rows: false,
        })
    }

    fn time_unit(&self) -> Result<Option<f64>, InputError> {
        if let Some(rate) = self.time.rate_hz {
            let fail = |what: String, hint: &str| Err(InputError::new(Path::new(""), what, hint).field("time.rate_hz"));
            if !(rate.is_finite() && rate > 0.0) {
                return fail(format!("{rate} rows a second are none"), "such as rate_hz = 100");
            }
            if self.time.column.is_some() || self.time.unit.is_some() {
                return fail("there is a column of time, or none".to_owned(), "give column and unit, or rate_hz");
            }
        }
        let Some(unit) = self.time.unit.as_deref() else { return Ok(None) };
        units::of_time(unit).map(Some).ok_or_else(|| {
            InputError::new(Path::new(""), format!("{unit:?} is no unit of time"), "give s, ms, us or ns")
                .field("time.unit")
        })
    }

    fn wanted(&self) -> Result<Vec<Wanted<'_>>, InputError> {
        let mut wanted = Vec::new();
        for (name, source) in &self.columns {
            let field = format!("columns.{name}");
            let fail = |what: String, hint: String| InputError::new(Path::new(""), what, hint).field(field.clone());
            let rate = RATES.iter().position(|rate| rate == name);
            let column = rate.map_or_else(|| Column::from_name(name), Column::Odometry);
            if matches!(column, Column::Other | Column::Time) {
                let known: Vec<String> = Column::all(4).into_iter().map(Column::name).collect();
                let known: Vec<&str> = known.iter().map(String::as_str).collect();
                let hint = nearest(name, &known).map_or_else(
                    || "the columns are those of docs/book/src/log-format.md; time has a table [time]".to_owned(),
                    |near| format!("did you mean {near}?"),
                );
                return Err(fail("is no column of a run".to_owned(), hint));
            }
            let (from, name, scale, offset, per_rev, wraps) = match source {
                Source::Name(from) => (from, "", 1.0, 0.0, None, None),
                Source::Scaled(s) => {
                    (&s.from, s.unit.as_str(), s.scale.unwrap_or(1.0), s.offset, s.counts_per_rev, s.wraps)
                }
            };
            if let Some(n) = wraps.filter(|n| !(n.is_finite() && *n > 0.0)) {
                return Err(fail(format!("wraps = {n} is no period"), "such as wraps = 4096".to_owned()));
            }
            let angle = ["rad", "deg", "rev"].contains(&name);
            let counted = matches!(column, Column::Counts(_));
            if counted && units::factor(name).is_some() && !matches!(name, "" | "counts" | "lines") && per_rev.is_none()
            {
                let hint = "say what the encoder counts: counts_per_rev = 1440 beside unit = \"rad\", and \
                            encoder_counts_per_wheel_rev = 1440 in robot.toml; any fine number, as 65536, where nobody knows";
                return Err(fail(format!("counts cannot be in {name:?}"), hint.to_owned()));
            }
            if let Some(n) = per_rev.filter(|n| !(counted && angle && n.is_finite() && *n > 0.0)) {
                let hint = "it is a positive number, for an enc_ column whose unit is rad, deg or rev";
                return Err(fail(format!("counts_per_rev = {n} has no meaning here"), hint.to_owned()));
            }
            let Some(unit) = units::factor(name) else {
                return Err(fail(
                    format!("{name:?} is no unit that is known"),
                    format!("give one of {}, or a scale", units::names()),
                ));
            };
            if !(scale.is_finite() && scale != 0.0 && offset.is_finite()) {
                return Err(fail("its scale or offset is no number".to_owned(), "such as scale = -1".to_owned()));
            }
            let factor = unit * scale * per_rev.map_or(1.0, |n| n / TAU);
            wanted.push(Wanted {
                column,
                from,
                factor,
                offset,
                wraps,
                turn: per_rev.map(|_| TAU / unit),
                rate: rate.is_some(),
            });
        }
        Ok(wanted)
    }

    /// Makes a run of what a file holds; without columns in the map, of the series that have our names.
    ///
    /// # Errors
    /// [`InputError`] about `path` for series that are not there, groups of columns that are not whole, and values that no
    /// column takes.
    pub fn run(&self, table: &Table, path: &Path) -> Result<Run, InputError> {
        let fail = |e: InputError| InputError { file: path.to_owned(), ..e };
        if let Some(restart) = table.restart.filter(|_| self.time.recording.is_none()) {
            let what = format!("its time starts again: it holds {} recordings", restart.recordings);
            let hint = "make a run of each: recording = 1 in the map's [time], then 2, ...";
            return Err(InputError::new(path, what, hint).at(restart.line, 1));
        }
        let mut wanted = self.wanted().map_err(fail)?;
        if wanted.is_empty() {
            let ours = table.series.iter().map(|s| (Column::from_name(&s.name), s.name.as_str()));
            let ours = ours.filter(|(column, _)| !matches!(column, Column::Other | Column::Time));
            wanted.extend(ours.map(|(column, from)| Wanted {
                column,
                from,
                factor: 1.0,
                offset: 0.0,
                wraps: None,
                turn: None,
                rate: false,
            }));
        }
        let mut columns: Vec<Column> = wanted.iter().map(|w| w.column).collect();
        // Two wheels on an axle are told no sideways velocity.
        let sideways = Column::Command(if self.frame.x == Axis::Forward { 1 } else { 0 });
        let others = (0..3).map(Column::Command).filter(|c| *c != sideways);
        let straight = !columns.contains(&sideways) && others.into_iter().all(|c| columns.contains(&c));
        if straight {
            columns.push(sideways);
        }
        let rates = wanted.iter().any(|w| w.rate);
        if rates && wanted.iter().any(|w| matches!(w.column, Column::Odometry(_)) && !w.rate) {
            let hint = "map odom_x, odom_y and odom_theta, or odom_vx, odom_vy and odom_w";
            return Err(InputError::new(path, "the odometry is a pose, or its velocities", hint).field("odom_w"));
        }
        let sidewards = Column::Odometry(if self.frame.x == Axis::Forward { 1 } else { 0 });
        let no_sideways = rates && !columns.contains(&sidewards);
        if no_sideways {
            columns.push(sidewards);
        }
        if columns.is_empty() {
            let hint = table.suggestion("enc_1");
            return Err(InputError::new(path, "none of its series is a column of ours: name them in [columns]", hint));
        }
        for (group, at_least) in GROUPS {
            if let Some(column) = missing_member(&columns, group, at_least) {
                let hint = match column {
                    Column::Odometry(_) if rates => "map odom_vx and odom_w; only the sideways one may be left out",
                    Column::Command(_) => {
                        "map cmd_vx, cmd_vy and cmd_w (only the sideways one may be left out), or none"
                    }
                    _ => "map the whole group of columns, or none of it",
                };
                let name = match column {
                    Column::Odometry(i) if rates => RATES[i].to_owned(),
                    column => column.name(),
                };
                return Err(InputError::new(path, "no such column in the map", hint).field(name));
            }
        }
        let mut series = Vec::new();
        for w in &wanted {
            let Some(found) = table.find(w.from) else {
                let what = format!("has no series {:?}", w.from);
                return Err(InputError::new(path, what, table.suggestion(w.from)).field(w.column.name()));
            };
            series.push(found);
        }
        // Times to the nanosecond: what is stamped alike is one tick.
        let key = |t: f64| (t * 1e9).round() as i64;
        let mut keys: Vec<i64> = series.iter().flat_map(|s| s.t.iter().map(|t| key(*t))).collect();
        keys.sort_unstable();
        keys.dedup();
        let first = if self.time.keep { 0 } else { keys.first().copied().unwrap_or(0) };
        let mut run = Run::with_columns(&columns);
        run.t = keys.iter().map(|k| (k - first) as f64 / 1e9).collect();
        let ticks = keys.len();
        run.reals_mut().into_iter().skip(1).for_each(|c| c.resize(ticks, f64::NAN));
        if straight && let Some(slot) = run.real_mut(sideways) {
            slot.fill(0.0);
        }
        let mut camera = vec![[f64::NAN; 3]; if run.has_camera { ticks } else { 0 }];
        for (w, s) in wanted.iter().zip(&series) {
            let mut column = vec![f64::NAN; ticks];
            for (t, value) in s.t.iter().zip(unwrapped(w, &s.values).iter()) {
                if let Ok(tick) = keys.binary_search(&key(*t)) {
                    column[tick] = units::times(*value, w.factor) + w.offset;
                }
            }
            match w.column {
                Column::Counts(wheel) => {
                    // Angles are counts only to rounding; what was never counted is no encoder's.
                    let known: Vec<f64> = column.iter().copied().filter(|x| x.is_finite()).collect();
                    let fractions = known.iter().filter(|x| (*x - x.round()).abs() > 0.01).count();
                    if w.factor.abs() == 1.0 && 2 * fractions > known.len() {
                        let hint = "an angle needs its unit: { from = ..., unit = \"rad\", counts_per_rev = 1440 }; a \
                                    speed is a speed_ column";
                        let what = format!("series {:?} has fractions, which no counter has", w.from);
                        return Err(InputError::new(path, what, hint).field(w.column.name()));
                    }
                    counts(&mut run, wheel, &column);
                }
                Column::Camera(i) => camera.iter_mut().zip(&column).for_each(|(pose, x)| pose[i] = *x),
                Column::Duty(_) => {
                    if let Some(x) = column.iter().find(|x| x.abs() > 1.001) {
                        let hint = "scale it to a share of the supply, such as unit = \"percent\"";
                        let what = format!("duty {x} is not within ±1");
                        return Err(InputError::new(path, what, hint).field(w.column.name()));
                    }
                    run.duty.iter_mut().enumerate().filter(|(i, _)| w.column == Column::Duty(*i)).for_each(
                        |(_, slot)| {
                            slot.clone_from(&column);
                        },
                    );
                }
                other => {
                    if let Some(slot) = run.real_mut(other) {
                        *slot = column;
                    }
                }
            }
        }
        if rates && let Some(odometry) = &mut run.odometry {
            if no_sideways && let Column::Odometry(i) = sidewards {
                odometry[i].fill(0.0);
            }
            integrate(&run.t, odometry, if self.frame.headings == Sense::Clockwise { -1.0 } else { 1.0 });
        }
        self.turn(&mut run, &mut camera);
        if let Some(geometry) = &self.geometry {
            speeds_of_commands(&mut run, geometry, path)?;
        }
        let whole = |(tick, p): (usize, &[f64; 3])| {
            p.iter().all(|x| x.is_finite()).then(|| CameraSample { tick, pose: Pose::new(p[0], p[1], p[2]) })
        };
        run.camera = camera.iter().enumerate().filter_map(whole).collect();
        Ok(run)
    }

    /// Into our frame: x to the right, y forward, headings of x, counter-clockwise.
    fn turn(&self, run: &mut Run, camera: &mut [[f64; 3]]) {
        let f = &self.frame;
        let sign = if f.headings == Sense::Clockwise { -1.0 } else { 1.0 };
        let quarter = if f.x == Axis::Forward { FRAC_PI_2 } else { 0.0 };
        let heading = |theta: f64| wrap_angle(sign * theta - quarter);
        for pose in camera {
            pose[1] *= if f.y == Up::Down { -1.0 } else { 1.0 };
            pose[2] = heading(pose[2]);
        }
        if let Some([_, _, theta]) = &mut run.odometry {
            theta.iter_mut().for_each(|t| *t = heading(*t));
        }
        for rates in
            [run.command.as_mut().map(|c| &mut c[2]), run.gyro.as_mut().map(|g| &mut g[2])].into_iter().flatten()
        {
            rates.iter_mut().for_each(|w| *w *= sign);
        }
        if f.x == Axis::Forward {
            for [x, y, _] in [&mut run.command, &mut run.gyro, &mut run.acceleration].into_iter().flatten() {
                for (x, y) in x.iter_mut().zip(y) {
                    (*x, *y) = (-*y, *x);
                }
            }
        }
    }
}
