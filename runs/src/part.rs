//! Parts of a run: some ticks of some columns.

use std::ops::Range;

use super::{CameraSample, Run};

/// Columns of a log beside the time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Columns {
    /// Commanded body twist.
    pub command: bool,
    /// Wheel speed set points.
    pub reference: bool,
    /// Encoder counts.
    pub counts: bool,
    /// Whether the duties belong to the part.
    pub duty: bool,
    /// Measured wheel speeds.
    pub measured: bool,
    /// Supply voltage.
    pub supply: bool,
    /// Wheel speeds, currents, dead reckoning and inertial sensors.
    pub sensors: bool,
}

impl Columns {
    /// A log with nothing left out.
    pub const ALL: Self =
        Self { command: true, reference: true, counts: true, duty: true, measured: true, supply: true, sensors: true };
    /// The time alone.
    pub const NONE: Self = Self {
        command: false,
        reference: false,
        counts: false,
        duty: false,
        measured: false,
        supply: false,
        sensors: false,
    };
}

impl Run {
    /// What a log of several axes says of one of them, as a log of an axis alone.
    #[must_use]
    pub fn axis(&self, axis: usize) -> Self {
        // What is logged of each axis at times of its own leaves ticks that are the others' alone.
        let own = self.told_of(axis..axis + 1, false);
        let run = if own.is_empty() { self.clone() } else { self.of_ticks(&own) };
        let one = |group: Vec<Vec<f64>>| group.into_iter().nth(axis).into_iter().collect::<Vec<_>>();
        Self {
            name: run.name,
            t: run.t,
            reference: one(run.reference),
            counts: run.counts.into_iter().nth(axis).into_iter().collect(),
            count_gaps: run.count_gaps.into_iter().nth(axis).into_iter().collect(),
            duty: one(run.duty),
            measured: one(run.measured),
            supply_v: run.supply_v,
            speed: one(run.speed),
            current: one(run.current),
            source: run.source,
            ..Self::default()
        }
    }

    /// Ticks at which a wheel of these was read, set or driven, or with `commanded` the robot was; others are a camera's, or
    /// another sensor's.
    #[must_use]
    pub fn told_of(&self, wheels: Range<usize>, commanded: bool) -> Vec<usize> {
        let groups = [&self.reference, &self.duty, &self.measured, &self.speed, &self.current];
        let of_wheels = |group: &'_ &Vec<Vec<f64>>| wheels.start.min(group.len())..wheels.end.min(group.len());
        let columns: Vec<&Vec<f64>> = groups
            .iter()
            .flat_map(|group| &group[of_wheels(group)])
            .chain(self.command.iter().flatten().filter(|_| commanded))
            .filter(|column| column.len() == self.len())
            .collect();
        let counted: Vec<&Vec<usize>> = wheels
            .filter(|wheel| self.counts.get(*wheel).is_some_and(|counts| counts.len() == self.len()))
            .filter_map(|wheel| self.count_gaps.get(wheel))
            .collect();
        let told = |tick: &usize| {
            counted.iter().any(|gaps| gaps.binary_search(tick).is_err())
                || columns.iter().any(|column| column[*tick].is_finite())
        };
        (0..self.len()).filter(told).collect()
    }

    /// Some ticks of a run, without the camera's frames and unknown columns.
    #[must_use]
    pub fn of_ticks(&self, ticks: &[usize]) -> Self {
        let of = |column: &Vec<f64>| ticks.iter().map(|tick| column[*tick]).collect::<Vec<f64>>();
        let mut run =
            Self { camera: Vec::new(), has_camera: false, other: Vec::new(), notes: Vec::new(), ..self.clone() };
        run.reals_mut().into_iter().filter(|column| !column.is_empty()).for_each(|column| *column = of(column));
        for counts in run.counts.iter_mut().filter(|counts| !counts.is_empty()) {
            *counts = ticks.iter().map(|tick| counts[*tick]).collect();
        }
        for gaps in &mut run.count_gaps {
            let own = ticks.iter().enumerate().filter(|(_, tick)| gaps.binary_search(tick).is_ok());
            *gaps = own.map(|(tick, _)| tick).collect();
        }
        run
    }

    /// The columns of numbers, the time first.
    pub(super) fn reals(&self) -> Vec<&Vec<f64>> {
        let wheels = [&self.reference, &self.duty, &self.measured].into_iter().flatten();
        let sensors = [&self.speed, &self.current].into_iter().flatten();
        let triples = [&self.odometry, &self.gyro, &self.acceleration].into_iter().flatten().flatten();
        std::iter::once(&self.t)
            .chain(self.command.iter().flatten())
            .chain(wheels)
            .chain(&self.supply_v)
            .chain(sensors)
            .chain(triples)
            .chain(&self.imu_temp)
            .collect()
    }

    /// The same to be written to.
    pub(super) fn reals_mut(&mut self) -> Vec<&mut Vec<f64>> {
        let wheels = [&mut self.reference, &mut self.duty, &mut self.measured].into_iter().flatten();
        let sensors = [&mut self.speed, &mut self.current].into_iter().flatten();
        let triples = [&mut self.odometry, &mut self.gyro, &mut self.acceleration].into_iter().flatten().flatten();
        std::iter::once(&mut self.t)
            .chain(self.command.iter_mut().flatten())
            .chain(wheels)
            .chain(&mut self.supply_v)
            .chain(sensors)
            .chain(triples)
            .chain(&mut self.imu_temp)
            .collect()
    }

    /// Which of the columns of numbers are wanted.
    pub(super) fn wanted(&self, columns: Columns) -> Vec<bool> {
        let mut wanted = vec![true];
        wanted.extend(self.command.iter().flatten().map(|_| columns.command));
        wanted.extend(self.reference.iter().map(|_| columns.reference));
        wanted.extend(self.duty.iter().map(|_| columns.duty));
        wanted.extend(self.measured.iter().map(|_| columns.measured));
        wanted.extend(self.supply_v.iter().map(|_| columns.supply));
        wanted.resize(self.reals().len(), columns.sensors);
        wanted
    }

    /// A run with these columns and no ticks.
    pub(super) fn emptied(&self, columns: Columns) -> Self {
        let none = |wanted: bool, like: &[Vec<f64>]| vec![Vec::new(); if wanted { like.len() } else { 0 }];
        let triple =
            |like: &Option<[Vec<f64>; 3]>| like.as_ref().filter(|_| columns.sensors).map(|_| Default::default());
        let wheels = if columns.counts { self.counts.len() } else { 0 };
        Self {
            name: self.name.clone(),
            command: self.command.as_ref().filter(|_| columns.command).map(|_| Default::default()),
            reference: none(columns.reference, &self.reference),
            counts: vec![Vec::new(); wheels],
            count_gaps: vec![Vec::new(); wheels],
            duty: none(columns.duty, &self.duty),
            measured: none(columns.measured, &self.measured),
            supply_v: self.supply_v.as_ref().filter(|_| columns.supply).map(|_| Vec::new()),
            speed: none(columns.sensors, &self.speed),
            current: none(columns.sensors, &self.current),
            odometry: triple(&self.odometry),
            gyro: triple(&self.gyro),
            acceleration: triple(&self.acceleration),
            imu_temp: self.imu_temp.as_ref().filter(|_| columns.sensors).map(|_| Vec::new()),
            has_camera: self.has_camera,
            source: self.source,
            notes: self.notes.clone(),
            other: self.other.iter().map(|(name, _)| (name.clone(), Vec::new())).collect(),
            ..Self::default()
        }
    }

    /// Some ticks of some columns, counted from the first of them; the camera's frames and columns that nobody knows
    /// are left out.
    pub(super) fn part(&self, ticks: Range<usize>, columns: Columns) -> Self {
        let mut out = self.emptied(columns);
        out.other.clear();
        let wanted = self.reals().into_iter().zip(self.wanted(columns)).filter(|(_, wanted)| *wanted);
        for (slot, (column, _)) in out.reals_mut().into_iter().zip(wanted) {
            slot.extend_from_slice(&column[ticks.clone()]);
        }
        for (slot, counts) in out.counts.iter_mut().zip(&self.counts) {
            slot.extend_from_slice(&counts[ticks.clone()]);
        }
        for (slot, gaps) in out.count_gaps.iter_mut().zip(&self.count_gaps) {
            let (from, to) = (gaps.partition_point(|g| *g < ticks.start), gaps.partition_point(|g| *g < ticks.end));
            slot.extend(gaps[from..to].iter().map(|g| g - ticks.start));
        }
        out
    }

    /// Evenly spaced ticks without samples.
    pub(super) fn blank(&self, ticks: usize, tick_s: f64, columns: Columns) -> Self {
        let mut out = self.emptied(columns);
        out.other.clear();
        out.reals_mut().into_iter().for_each(|column| column.resize(ticks, f64::NAN));
        out.counts.iter_mut().for_each(|counts| counts.resize(ticks, 0));
        out.t = (0..ticks).map(|k| k as f64 * tick_s).collect();
        out
    }

    /// Adds the ticks that follow, which have the same columns.
    pub(super) fn append(&mut self, mut more: Self) {
        let before = self.len();
        for (slot, column) in self.reals_mut().into_iter().zip(more.reals_mut()) {
            slot.append(column);
        }
        for (slot, counts) in self.counts.iter_mut().zip(&mut more.counts) {
            slot.append(counts);
        }
        for (slot, gaps) in self.count_gaps.iter_mut().zip(&more.count_gaps) {
            slot.extend(gaps.iter().map(|g| before + g));
        }
        self.camera.extend(more.camera.iter().map(|f| CameraSample { tick: before + f.tick, ..*f }));
        self.note(&more.notes);
    }

    /// Adds what is said of ticks that follow, once.
    pub(super) fn note(&mut self, more: &[String]) {
        for note in more {
            if !self.notes.contains(note) {
                self.notes.push(note.clone());
            }
        }
    }
}
