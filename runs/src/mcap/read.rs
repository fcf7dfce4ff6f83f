//! Reading: messages to columns.

use std::collections::hash_map::Entry;
use std::collections::{BTreeMap, HashMap};
use std::path::Path;

use mcap::MAGIC;

use super::fields::{Topic, Value};
use super::records::messages;
use crate::columns::{AS_SHARE, Column, GROUPS, MOST_DUTY, WHEEL_GROUPS, missing_member};
use crate::frames::Pose;
use crate::{CameraSample, Run, RunError};

/// Reads a run; a file that was cut off, as by a kill, is read as far as it goes.
pub(crate) fn read(bytes: &[u8], path: &Path) -> Result<Run, RunError> {
    let damaged = |what: String| RunError::new(path, what, "copy the file again, or recover it with `mcap recover`");
    if !bytes.starts_with(MAGIC) {
        return Err(RunError::new(path, "does not start as an MCAP file does", "give an MCAP file, or rename a CSV"));
    }
    let mut builder = Builder::new(path);
    let mut topics: HashMap<u16, Topic> = HashMap::new();
    let mut values = Vec::new();
    let mut number = 0;
    messages(bytes, damaged, |message| {
        number += 1;
        let channel = message.channel;
        let topic = match topics.entry(channel.id) {
            Entry::Occupied(entry) => entry.into_mut(),
            Entry::Vacant(entry) => {
                let topic = Topic::of(channel, message.schema);
                entry.insert(topic.map_err(|what| damaged(format!("topic {}: {what}", channel.topic)))?)
            }
        };
        let fail = |what: String| damaged(format!("message {number} of topic {}: {what}", channel.topic));
        topic.decode(message.data, &mut values).map_err(fail)?;
        builder.message(number, message.log_time, &values)
    })?;
    builder.finish()
}

/// A run that grows by messages.
struct Builder<'a> {
    path: &'a Path,
    t: Vec<f64>,
    reals: BTreeMap<Column, Vec<f64>>,
    counts: BTreeMap<Column, (Vec<i64>, Vec<usize>)>,
    camera: Vec<CameraSample>,
    /// Poses that wait for their tick.
    waiting: Vec<(f64, Pose)>,
    /// Stamp of t = 0, s, once known.
    origin: Option<f64>,
}

impl<'a> Builder<'a> {
    fn new(path: &'a Path) -> Self {
        Self {
            path,
            t: Vec::new(),
            reals: BTreeMap::new(),
            counts: BTreeMap::new(),
            camera: Vec::new(),
            waiting: Vec::new(),
            origin: None,
        }
    }

    fn fail(&self, message: usize, column: Column, what: &str, hint: &str) -> RunError {
        RunError::new(self.path, format!("message {message}: {what}"), hint).field(column.name())
    }

    fn message(&mut self, number: usize, log_time: u64, values: &[(Column, Value)]) -> Result<(), RunError> {
        if !values.iter().any(|(column, _)| *column != Column::Time) {
            return Ok(());
        }
        for (column, value) in values {
            if !value.real().is_finite() {
                let what = format!("{} is not a finite number", value.real());
                return Err(self.fail(number, *column, &what, "leave the field out if there is no sample"));
            }
        }
        let stamp = log_time as f64 * 1e-9;
        let stated = values.iter().find(|(column, _)| *column == Column::Time).map(|(_, value)| value.real());
        let origin = *self.origin.get_or_insert(stamp - stated.unwrap_or(0.0));
        let t = stated.unwrap_or(stamp - origin);
        self.see(number, t, values)?;
        let columns: Vec<Column> = values.iter().map(|(column, _)| *column).collect();
        if Topic::has_tick(&columns) { self.tick(number, t, values) } else { Ok(()) }
    }

    /// A camera pose, if the message has one: it belongs to the tick of its time, or the next.
    fn see(&mut self, number: usize, t: f64, values: &[(Column, Value)]) -> Result<(), RunError> {
        let part = |i: usize| values.iter().find(|(column, _)| *column == Column::Camera(i)).map(|(_, v)| v.real());
        match (part(0), part(1), part(2)) {
            (None, None, None) => Ok(()),
            (Some(x), Some(y), Some(theta)) => {
                self.waiting.push((t, Pose::new(x, y, theta)));
                if self.t.last() == Some(&t) {
                    self.seen_by(self.t.len() - 1, t);
                }
                Ok(())
            }
            _ => {
                let what = "a camera sample has only a part of x, y and theta";
                Err(self.fail(number, Column::Camera(0), what, "log all three, or none at this tick"))
            }
        }
    }

    /// Poses that waited for this tick; of several the last one is what the controller knew.
    fn seen_by(&mut self, tick: usize, t: f64) {
        let due = self.waiting.iter().take_while(|(at, _)| *at <= t).count();
        if let Some((_, pose)) = self.waiting.drain(..due).next_back() {
            self.camera.retain(|sample| sample.tick != tick);
            self.camera.push(CameraSample { tick, pose });
        }
    }

    fn tick(&mut self, number: usize, t: f64, values: &[(Column, Value)]) -> Result<(), RunError> {
        if let Some(before) = self.t.last().filter(|before| t <= **before) {
            let what = if t == *before {
                format!("time {t} s stands twice")
            } else {
                format!("time runs backwards, from {before} s to {t} s")
            };
            return Err(self.fail(number, Column::Time, &what, "log one message a tick, in the order of time"));
        }
        let tick = self.t.len();
        for &(column, value) in values {
            match column {
                Column::Time | Column::Camera(_) | Column::Other => {}
                Column::Counts(_) => {
                    let Some(count) = value.count() else {
                        let what = format!("{} is no whole number", value.real());
                        return Err(self.fail(number, column, &what, "log cumulative encoder counts"));
                    };
                    let (counts, gaps) = self.counts.entry(column).or_default();
                    let held = counts.last().copied().unwrap_or(count);
                    gaps.extend(counts.len()..tick);
                    counts.resize(tick, held);
                    counts.push(count);
                }
                Column::Duty(_) if value.real().abs() > MOST_DUTY => {
                    let what = format!("duty {} is not within ±1", value.real());
                    return Err(self.fail(number, column, &what, AS_SHARE));
                }
                _ => {
                    let numbers = self.reals.entry(column).or_default();
                    numbers.resize(tick, f64::NAN);
                    numbers.push(value.real());
                }
            }
        }
        self.t.push(t);
        self.seen_by(tick, t);
        Ok(())
    }

    fn finish(mut self) -> Result<Run, RunError> {
        let has_camera = !self.camera.is_empty() || !self.waiting.is_empty();
        if self.t.is_empty() {
            // A camera log: its poses are the ticks.
            for (t, pose) in std::mem::take(&mut self.waiting) {
                if self.t.last().is_none_or(|last| t > *last) {
                    self.camera.push(CameraSample { tick: self.t.len(), pose });
                    self.t.push(t);
                }
            }
        }
        if self.t.is_empty() {
            let hint = "log at least one message with fields such as t, enc_1, duty_1, in protobuf or JSON";
            return Err(RunError::new(self.path, "holds no ticks", hint));
        }
        let ticks = self.t.len();
        let columns: Vec<Column> = self.reals.keys().chain(self.counts.keys()).copied().collect();
        for (group, at_least) in GROUPS {
            // Poses of the camera are whole, see `see`.
            if let Some(column) = missing_member(&columns, group, at_least) {
                let hint = "log the whole group of fields, or none of it";
                return Err(RunError::new(self.path, "no such field", hint).field(column.name()));
            }
        }
        let width = |group: fn(usize) -> Column| (0..100).take_while(|i| columns.contains(&group(*i))).count();
        let widths = GROUPS[..WHEEL_GROUPS].iter().map(|(group, _)| (width(*group), *group));
        let wheels = widths.clone().map(|(n, _)| n).max().unwrap_or(0);
        if let Some((n, group)) = widths.clone().find(|(n, _)| (1..wheels).contains(n)) {
            let hint = format!("other fields speak of {wheels} wheels; log this one for all of them");
            return Err(RunError::new(self.path, "no such field", hint).field(group(n).name()));
        }
        let mut run = Run::with_columns(&columns);
        for column in Column::all(wheels) {
            if let Some(slot) = run.real_mut(column).filter(|_| column != Column::Time) {
                *slot = self.reals.remove(&column).unwrap_or_default();
                slot.resize(ticks, f64::NAN);
            }
        }
        let (mut counts, mut count_gaps) = (Vec::new(), Vec::new());
        for (mut numbers, mut gaps) in self.counts.into_values() {
            gaps.extend(numbers.len()..ticks);
            numbers.resize(ticks, numbers.last().copied().unwrap_or(0));
            counts.push(numbers);
            count_gaps.push(gaps);
        }
        Ok(Run { t: self.t, counts, count_gaps, camera: self.camera, has_camera, ..run })
    }
}
