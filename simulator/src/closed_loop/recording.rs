//! What the host writes down: a run in memory, of the samples that the driver would write to a file.

use driver::recording::Sample;
use driver::{Scale, Snapshot};
use runs::frames::{Pose, Twist};
use runs::{CameraSample, Run};

/// A run that grows by a row a tick.
#[derive(Debug)]
pub(super) struct Recording {
    run: Run,
    wheels: usize,
}

impl Recording {
    pub(super) fn new(wheels: usize, camera: bool) -> Self {
        let run = Run {
            name: "run".to_owned(),
            command: Some(Default::default()),
            reference: vec![Vec::new(); wheels],
            counts: vec![Vec::new(); wheels],
            count_gaps: vec![Vec::new(); wheels],
            duty: vec![Vec::new(); wheels],
            measured: vec![Vec::new(); wheels],
            supply_v: Some(Vec::new()),
            has_camera: camera,
            ..Run::default()
        };
        Self { run, wheels }
    }

    pub(super) fn row(
        &mut self,
        t: f64,
        command: Twist,
        seen: &Snapshot,
        scale: &Scale,
        supply_v: f64,
        camera: Option<Pose>,
    ) {
        let sample = Sample::of(t, command, seen, seen.counts.map(i64::from), scale, supply_v).with_camera(camera);
        let run = &mut self.run;
        if let Some(pose) = sample.camera {
            run.camera.push(CameraSample { tick: run.t.len(), pose });
        }
        run.t.push(sample.t);
        for (column, value) in run.command.iter_mut().flatten().zip(sample.command) {
            column.push(value);
        }
        for wheel in 0..self.wheels {
            run.reference[wheel].push(sample.reference[wheel]);
            run.counts[wheel].push(sample.counts[wheel]);
            run.duty[wheel].push(sample.duty[wheel]);
            run.measured[wheel].push(sample.measured[wheel]);
        }
        if let Some(supply) = &mut run.supply_v {
            supply.push(sample.supply_v);
        }
    }

    pub(super) fn finish(self) -> Run {
        self.run
    }
}
