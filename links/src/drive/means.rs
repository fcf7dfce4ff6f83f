//! Mean torques and forces over test functions. What they are without the loads in proportion to a number, whatever the
//! inertias, is the same for many models, and so is what each of those loads gives at the value 1: both are worked out once.

use std::hash::{DefaultHasher, Hash, Hasher};
use std::ops::Range;
use std::sync::Arc;

use nalgebra::DMatrix;

use super::forces::Base;
use super::kept::{Key, Rows};
use super::laid::Laid;
use super::test_functions::{DriveLink, add_product};
use super::{DriveModel, Unit};
use crate::segment::Segment;
use estimation::sums::dot;

/// Test functions of one segment, at which models are looked at.
pub(super) struct Place<'a> {
    link: &'a DriveLink<'a>,
    segment: &'a Segment,
    range: &'a Range<usize>,
    laid: &'a Laid,
    /// A model whose torques many others have, too.
    shared: (u64, Base<'a>),
}

impl<'a> Place<'a> {
    pub(super) fn new(
        link: &'a DriveLink<'a>,
        segment: &'a Segment,
        range: &'a Range<usize>,
        laid: &'a Laid,
        shared: &'a DriveModel,
    ) -> Self {
        let shared = (shared.torques_identity(), Base::new(shared, segment));
        Self { link, segment, range, laid, shared }
    }

    /// Unexplained accelerations by a model's torques and forces, in the torque of an inertia, its own if none is given, Nm,
    /// one a wheel of each test function.
    ///
    /// The equation of motion is solved for the acceleration, which carries the noise; the torques that motors give are
    /// known. Residuals are given in the torque of the link's own inertia: one unit for all models, so that noise makes
    /// none of them lighter or heavier. [`super::in_own_torque`] has what that unit cannot tell.
    pub(super) fn left(&self, model: &DriveModel, inertia: Option<&DMatrix<f64>>) -> Option<Vec<f64>> {
        let (mechanics, n) = (self.link.mechanics(model, self.segment)?, model.wheels.len());
        let inertia = inertia.unwrap_or(&mechanics.inertia);
        let offsets: Vec<_> = model.offsets.iter().map(|(what, o)| (*what, o(model, self.segment))).collect();
        let given = inertia * mechanics.encoders_per_torque(model);
        let mut torques = vec![0.0; n * self.range.len()];
        for (measured, torque) in self.laid.measured.iter().zip(torques.chunks_exact_mut(n)) {
            add_product(torque, inertia, 1.0, measured.as_slice());
        }
        for (row, means) in self.means(model) {
            let per_torque = given.column(row);
            for (mean, torque) in means.iter().zip(torques.chunks_exact_mut(n)) {
                torque.iter_mut().zip(per_torque.iter()).for_each(|(slot, x)| *slot -= x * mean);
            }
        }
        if !offsets.is_empty() {
            let own = self.link.test_functions[self.range.clone()].iter().zip(&self.laid.shapes);
            for ((b, shape), torque) in own.zip(torques.chunks_exact_mut(n)) {
                for offset in &offsets {
                    // What the encoders are ahead of their wheels is no acceleration of these.
                    add_product(torque, inertia, -1.0, b.offset(shape, offset, &mechanics, model).as_slice());
                }
            }
        }
        Some(torques)
    }

    /// Means of a model's torques and forces, by their rows.
    fn means(&self, model: &DriveModel) -> Vec<(usize, Vec<f64>)> {
        let rows = model.wheels.len() + 3;
        let torques = model.torques_identity();
        let own = Base::new(model, self.segment);
        let shared = Some(&self.shared.1).filter(|_| self.shared.0 == torques);
        let torque = self.once((torques, None), || {
            let forces = shared.map_or_else(|| own.forces(), Base::forces);
            self.over_test_functions(forces.iter().map(|row| Some(row.as_slice())))
        });
        let mut sum: Vec<Option<Vec<f64>>> = vec![None; rows];
        for (row, means) in &*torque {
            sum[*row] = Some(means.clone());
        }
        let motion = model.motion_identity();
        for load in model.proportional.iter().filter(|load| model.adds_up(load)) {
            let looks_at = if load.looks_at_motors { torques } else { motion };
            for unit in &load.units {
                let rows = self.once(unit.key(looks_at), || {
                    let rows = shared.map_or_else(|| own.of_load(&unit.loads), |base| base.of_load(&unit.loads));
                    self.over_test_functions(rows.into_iter())
                });
                for (row, means) in &*rows {
                    let sum = sum[*row].get_or_insert_with(|| vec![0.0; means.len()]);
                    sum.iter_mut().zip(means).for_each(|(sum, mean)| *sum += unit.value * mean);
                }
            }
        }
        sum.into_iter().enumerate().filter_map(|(row, means)| Some((row, means?))).collect()
    }

    fn once(&self, key: Key, make: impl FnOnce() -> Rows) -> Arc<Rows> {
        self.link.kept.once(self.range.start, key, make)
    }

    /// Means over every test function of what is there at the ticks, by rows; of none that is 0 throughout.
    fn over_test_functions<R: AsRef<[f64]>>(&self, rows: impl Iterator<Item = Option<R>>) -> Rows {
        let own = || self.link.test_functions[self.range.clone()].iter().zip(&self.laid.shapes);
        let mean = |row: &[f64]| own().map(|(b, shape)| dot(&shape.force, &row[b.first..])).collect();
        let there = rows.enumerate().filter_map(|(i, row)| Some((i, row?)));
        there
            .filter(|(_, row)| row.as_ref().iter().any(|x| *x != 0.0))
            .map(|(i, row)| (i, mean(row.as_ref())))
            .collect()
    }
}

impl Unit {
    /// Under which it is kept, beside the motion and the motors that it looks at.
    fn key(&self, looks_at: u64) -> Key {
        let mut hasher = DefaultHasher::new();
        self.of.hash(&mut hasher);
        (looks_at, Some(hasher.finish()))
    }
}
