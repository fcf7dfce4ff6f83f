//! A run that is recorded into memory instead of a file.

use runs::{CameraSample, Layout, Run, RunStream, Tick};
use std::io;
use std::sync::{Arc, Mutex, PoisonError};

/// Takes ticks as a file would; clones are the same run.
#[derive(Clone, Debug)]
pub(super) struct MemoryStream(Arc<Mutex<Run>>);

impl MemoryStream {
    pub(super) fn new(layout: Layout) -> Self {
        let columns = |wheels: usize| vec![Vec::new(); wheels];
        Self(Arc::new(Mutex::new(Run {
            name: "run".to_owned(),
            command: layout.command.then(Default::default),
            reference: columns(layout.references),
            counts: vec![Vec::new(); layout.counts],
            count_gaps: vec![Vec::new(); layout.counts],
            duty: columns(layout.duties),
            measured: columns(layout.measured),
            supply_v: layout.supply.then(Vec::new),
            has_camera: layout.camera,
            gyro: layout.gyro.then(Default::default),
            acceleration: layout.acceleration.then(Default::default),
            imu_temp: layout.imu_temp.then(Vec::new),
            ..Run::default()
        })))
    }

    /// What was recorded.
    pub(super) fn take(&self) -> Run {
        std::mem::take(&mut *self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

impl RunStream for MemoryStream {
    fn tick(&mut self, tick: &Tick<'_>) -> io::Result<()> {
        let mut run = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let run = &mut *run;
        if let Some(pose) = tick.camera {
            run.camera.push(CameraSample { tick: run.t.len(), pose });
        }
        for (wheel, (counts, gaps)) in run.counts.iter_mut().zip(&mut run.count_gaps).enumerate() {
            let count = tick.counts.get(wheel).copied().flatten();
            if count.is_none() {
                gaps.push(run.t.len());
            }
            counts.push(count.or_else(|| counts.last().copied()).unwrap_or_default());
        }
        run.t.push(tick.t);
        for (column, value) in run.command.iter_mut().flatten().zip(tick.command) {
            column.push(value);
        }
        for (columns, values) in
            [(&mut run.reference, tick.reference), (&mut run.duty, tick.duty), (&mut run.measured, tick.measured)]
        {
            columns.iter_mut().zip(values).for_each(|(column, value)| column.push(*value));
        }
        let felt = [(&mut run.gyro, tick.gyro), (&mut run.acceleration, tick.acceleration)];
        for (column, value) in felt.into_iter().flat_map(|(group, values)| group.iter_mut().flatten().zip(values)) {
            column.push(value);
        }
        if let Some(temperature) = &mut run.imu_temp {
            temperature.push(tick.imu_temp);
        }
        if let Some(supply) = &mut run.supply_v {
            supply.push(tick.supply_v);
        }
        Ok(())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }

    fn finish(&mut self) -> io::Result<()> {
        Ok(())
    }
}
