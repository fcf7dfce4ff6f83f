//! What a map says of one file, and the run that it makes of it.

use std::collections::BTreeMap;
use std::path::Path;

use super::columns::{RATES, Source, constants, wanted};
use super::csv::{COARSE, coarse};
use super::fill::{Wanted, begins_again, chain, counts, has_steps, integrate, is_not_read, signs, unwrapped};
use super::frame::{Axis, Frame, Sense, Up};
use super::time::{Time, nanoseconds};
use super::{Format, Series, Table, misread, units};
use crate::columns::{Column, GROUPS, MOST_DUTY, missing_member};
use crate::error::InputError;
use crate::frames::Pose;
use crate::{CameraSample, Run};

/// How one file is read.
#[derive(Debug, Clone, Default)]
pub(super) struct Reading {
    pub(super) format: Option<String>,
    pub(super) time: Time,
    pub(super) frame: Frame,
    pub(super) columns: BTreeMap<String, Source>,
    /// Nothing else than the pose is wanted of it.
    pub(super) pose_alone: bool,
}

/// A run made of a file.
pub(super) struct Made {
    pub(super) run: Run,
    /// The file's time at the run's 0, s.
    pub(super) first_s: f64,
    /// Samples of the pose in the file, those with the time of another among them.
    pub(super) poses: usize,
}

/// Samples of a series that stand at the time of the one before, to the nanosecond, with another value: only one of them can be
/// in a run.
fn crowded(series: &Series) -> usize {
    let at = |k: usize| (nanoseconds(series.t[k]), series.values[k]);
    let same = |k: &usize| {
        let ((t, value), (before, other)) = (at(*k), at(*k - 1));
        t == before && value != other
    };
    (1..series.t.len()).filter(same).count()
}

/// What to say of a series whose times do not tell its samples apart.
fn too_coarse(series: &Series, path: &Path) -> InputError {
    let mut times: Vec<i64> = series.t.iter().map(|t| nanoseconds(*t)).collect();
    times.dedup();
    let rows = series.t.len();
    match times[..] {
        [first, .., last] => coarse(path, [rows, times.len()], Some(rows as f64 / ((last - first) as f64 / 1e9))),
        _ => {
            let error = coarse(path, [rows, times.len()], None);
            let why =
                "write times with all their digits (a spreadsheet leaves some out of long ones), and name their unit";
            InputError { hint: format!("{why}; or {}", error.hint), ..error }
        }
    }
}

impl Reading {
    /// Whether everything in it is known.
    pub(super) fn check(&self) -> Result<(), InputError> {
        if let Some(name) = self.format.as_deref().filter(|name| Format::from_name(name).is_none()) {
            let hint = "give csv, plotjuggler, json, ros2, ssl-log or wpilog, or leave it out";
            return Err(InputError::new(Path::new(""), format!("{name:?} is no format"), hint).field("format"));
        }
        self.time.clock()?;
        wanted(&self.columns).map(|_| ())
    }

    /// The kind of file, if the map says it.
    pub(super) fn format(&self) -> Option<Format> {
        self.format.as_deref().and_then(Format::from_name)
    }

    pub(super) fn table(&self, file: &Path) -> Result<Table, InputError> {
        Table::read(file, self.format(), &self.time.clock()?)
    }

    /// What the owner of a file would want to know of what is made of it.
    pub(super) fn remarks(&self, table: &Table) -> Vec<String> {
        let wanted = wanted(&self.columns).unwrap_or_default();
        let of_column = |w: &Wanted| {
            let Series { t, values, .. } = table.find(w.from)?;
            is_not_read(w, values)
                .or_else(|| begins_again(w, values))
                .or_else(|| has_steps(w, values))
                .or_else(|| misread::remark(w, t, values))
        };
        let of_columns = wanted.iter().filter_map(of_column);
        let crowded = wanted.iter().filter_map(|w| table.find(w.from)).map(|s| (crowded(s), s.t.len())).max();
        let lost = crowded.filter(|(lost, _)| *lost > 0).map(|(lost, all)| {
            format!(
                "{lost} of {all} rows have the time of the one before, and other values: the last of a time counts; of a beat \
                 whose times lack digits say rate_hz in place of the column"
            )
        });
        table.remarks.iter().cloned().chain(of_columns).chain(lost).collect()
    }

    /// Makes a run of what a file holds; without columns in the map, of the series that have our names. Errors are about
    /// `path`: series that are not there, groups of columns that are not whole, and values that no column takes.
    pub(super) fn made(&self, table: &Table, path: &Path) -> Result<Made, InputError> {
        let fail = |e: InputError| InputError { file: path.to_owned(), ..e };
        if let Some(restart) = table.restart.filter(|_| self.time.recording.is_none()) {
            let what = format!("its time starts again: it holds {} recordings", restart.recordings);
            let hint = if self.pose_alone {
                "say which: recording = 1 in the map's [truth.time], or 2, ..."
            } else {
                "give a folder to write to, which gets a run of each, or recording = 1 in the map's [time], then 2, ..."
            };
            return Err(InputError::new(path, what, hint).at(restart.line, 1));
        }
        let mut wanted = wanted(&self.columns).map_err(fail)?;
        let constants = constants(&self.columns);
        if wanted.is_empty() {
            let ours = table.series.iter().map(|s| (Column::from_name(&s.name), s.name.as_str()));
            let ours = ours.filter(|(column, _)| !matches!(column, Column::Other | Column::Time));
            let ours = ours.filter(|(column, _)| !self.pose_alone || matches!(column, Column::Camera(_)));
            let ours = ours.filter(|(column, _)| constants.iter().all(|(set, _)| set != column));
            wanted.extend(ours.map(|(column, from)| Wanted {
                column,
                from,
                factor: 1.0,
                offset: 0.0,
                limit: None,
                wraps: None,
                turn: None,
                increments: false,
                sign: None,
                rate: false,
            }));
        }
        let mut columns: Vec<Column> = wanted.iter().map(|w| w.column).collect();
        columns.extend(constants.iter().map(|(column, _)| *column));
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
        let stepped = [Column::Odometry, Column::Camera].map(|of| {
            let mut parts =
                wanted.iter().filter(|w| (0..3).any(|i| w.column == of(i))).map(|w| w.increments).peekable();
            let first = parts.peek().copied().unwrap_or(false);
            parts.all(|part| part == first).then_some(first)
        });
        let [Some(odometry_steps), Some(camera_steps)] = stepped else {
            let hint = "say increments = true of x, y and heading, or of none of them";
            return Err(InputError::new(path, "a pose is logged in increments as a whole, or not", hint));
        };
        let sidewards = Column::Odometry(if self.frame.x == Axis::Forward { 1 } else { 0 });
        let no_sideways = (rates || odometry_steps) && !columns.contains(&sidewards);
        if no_sideways {
            columns.push(sidewards);
        }
        if camera_steps && !columns.contains(&Column::Camera(2)) {
            let hint = "steps are seen from the pose before them: map its heading's, too";
            return Err(InputError::new(path, "no such column in the map", hint).field("cam_theta"));
        }
        if wanted.is_empty() {
            let (name, its) = if self.pose_alone { ("cam_x", "truth.columns") } else { ("enc_1", "columns") };
            let what = format!("none of its series is a column of ours: name them in [{its}]");
            return Err(InputError::new(path, what, table.suggestion(name)));
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
        let mut sign_of = Vec::new();
        for w in &wanted {
            let signed = w.sign.map(|name| {
                let none = || {
                    let what = format!("sign: has no series {name:?}");
                    InputError::new(path, what, table.suggestion(name)).field(w.column.name())
                };
                table.find(name).ok_or_else(none)
            });
            sign_of.push(signed.transpose()?);
        }
        if let Some((time, _)) = &table.time {
            let coarse = |s: &&&Series| crowded(s) as f64 >= COARSE * s.t.len().max(2) as f64;
            if let Some(s) = series.iter().find(coarse) {
                return Err(too_coarse(s, path).field(time.clone()));
            }
        }
        let mut keys: Vec<i64> = series.iter().flat_map(|s| s.t.iter().map(|t| nanoseconds(*t))).collect();
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
        for (column, value) in constants {
            if let Some(slot) = run.real_mut(column) {
                slot.fill(value);
            }
        }
        let poses = wanted.iter().zip(&series).filter(|(w, _)| matches!(w.column, Column::Camera(_)));
        let poses = poses.map(|(_, s)| s.t.len()).max().unwrap_or(0);
        let headed = columns.contains(&Column::Camera(2));
        let mut camera = vec![[f64::NAN; 3]; if run.has_camera { ticks } else { 0 }];
        for ((w, s), sign) in wanted.iter().zip(&series).zip(&sign_of) {
            let mut column = vec![f64::NAN; ticks];
            let sign = sign.map_or_else(|| vec![1.0; s.t.len()], |of| signs(of, &s.t));
            for ((t, value), sign) in s.t.iter().zip(unwrapped(w, &misread::left_out(w, &s.values)).iter()).zip(sign) {
                if let Ok(tick) = keys.binary_search(&nanoseconds(*t)) {
                    let value = units::times(*value, sign * w.factor) + w.offset;
                    column[tick] = w.limit.map_or(value, |limit| value.clamp(-limit, limit));
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
                    if let Some(x) = column.iter().find(|x| x.abs() > MOST_DUTY) {
                        let hint = "scale it to a share of the supply, such as unit = \"percent\"; where the \
                                    controller's output is logged before the driver cuts it off, say limit = 1";
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
        let sense = if self.frame.headings == Sense::Clockwise { -1.0 } else { 1.0 };
        if let Some(odometry) = &mut run.odometry {
            if no_sideways && let Column::Odometry(i) = sidewards {
                odometry[i].fill(0.0);
            }
            if rates {
                integrate(&run.t, odometry, sense);
            } else if odometry_steps {
                let [x, y, theta] = odometry;
                let steps = x.iter_mut().zip(y).zip(theta).map(|((x, y), theta)| [x, y, theta]);
                chain(steps, no_sideways, sense);
            }
        }
        if camera_steps {
            let down = if self.frame.y == Up::Down { -1.0 } else { 1.0 };
            chain(camera.iter_mut().map(<[f64; 3]>::each_mut), false, sense * down);
        }
        self.frame.turn(&mut run, &mut camera);
        let whole = |(tick, p): (usize, &[f64; 3])| {
            let known = if headed { &p[..] } else { &p[..2] };
            known.iter().all(|x| x.is_finite()).then(|| CameraSample { tick, pose: Pose::new(p[0], p[1], p[2]) })
        };
        run.camera = camera.iter().enumerate().filter_map(whole).collect();
        Ok(Made { run, first_s: first as f64 / 1e9, poses })
    }
}
