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
        let counted = self.count_gaps.get(axis).filter(|_| self.counts.len() > axis);
        let groups = [&self.reference, &self.duty, &self.measured, &self.speed, &self.current];
        // What is logged of each axis at times of its own leaves ticks that are the others' alone.
        let told = |tick: &usize| {
            counted.is_some_and(|gaps| gaps.binary_search(tick).is_err())
                || groups.iter().any(|group| group.get(axis).is_some_and(|column| column[*tick].is_finite()))
        };
        let mut own: Vec<usize> = (0..self.len()).filter(told).collect();
        if own.is_empty() {
            own = (0..self.len()).collect();
        }
        let of = |column: &Vec<f64>| own.iter().map(|tick| column[*tick]).collect::<Vec<f64>>();
        let one = |group: &[Vec<f64>]| group.get(axis).map(of).into_iter().collect::<Vec<_>>();
        let gaps = |gaps: &Vec<usize>| -> Vec<usize> {
            let own = own.iter().enumerate().filter(|(_, tick)| gaps.binary_search(tick).is_ok());
            own.map(|(tick, _)| tick).collect()
        };
        Self {
            name: self.name.clone(),
            t: of(&self.t),
            reference: one(&self.reference),
            counts: self.counts.get(axis).map(|c| own.iter().map(|tick| c[*tick]).collect()).into_iter().collect(),
            count_gaps: self.count_gaps.get(axis).map(gaps).into_iter().collect(),
            duty: one(&self.duty),
            measured: one(&self.measured),
            supply_v: self.supply_v.as_ref().map(of),
            speed: one(&self.speed),
            current: one(&self.current),
            source: self.source,
            ..Self::default()
        }
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
