//! What a model leaves of the test functions, and the derivatives of that.

use std::borrow::Cow;
use std::ops::Range;

use estimation::normal_equations::Cluster;
use estimation::parallel::{each, numbered};
use nalgebra::{DMatrix, DVector};

use super::DriveModel;
use super::answers::Answers;
use super::means::Place;
use super::test_functions::{DriveLink, DriveResiduals};

/// A direction in which the drive is differentiated.
pub struct Side {
    /// Model at the low end; `None` for the model itself.
    pub low: Option<DriveModel>,
    /// Model at the high end.
    pub high: DriveModel,
    /// Step between them.
    pub step: f64,
}

impl DriveLink<'_> {
    /// Unexplained torques under a model, Nm: what the inertia of the link's own robot takes for the accelerations that
    /// the model does not predict.
    pub fn residuals(&self, model: &DriveModel) -> Option<DriveResiduals> {
        self.residuals_in(model, Some(&self.inertia))
    }

    /// The same in the torque of the model's own inertia: what would have to be added to it.
    pub fn residuals_in_own_torque(&self, model: &DriveModel) -> Option<DriveResiduals> {
        self.residuals_in(model, None)
    }

    fn residuals_in(&self, model: &DriveModel, inertia: Option<&DMatrix<f64>>) -> Option<DriveResiduals> {
        let part = |range: &Range<usize>| -> Option<Vec<Vec<f64>>> {
            let s = self.pieces.get(self.test_functions[range.start].segment);
            let laid = self.laid(&s, range);
            let left = Place::new(self, &s, range, &laid, model).left(model, inertia)?;
            Some(left.chunks_exact(self.noise.len()).map(<[f64]>::to_vec).collect())
        };
        let torque: Option<Vec<_>> = each(&self.by_segment(), &part).into_iter().collect();
        Some(DriveResiduals {
            run: self.test_functions.iter().map(|b| self.pieces.run(b.segment)).collect(),
            at: self.test_functions.iter().map(|b| (b.segment, b.middle())).collect(),
            torque: torque?.concat(),
            weights: self.test_functions.iter().map(|b| b.weights.clone()).collect(),
        })
    }

    /// Linearises: residuals and derivatives along each side, per cluster.
    pub fn linearise(&self, model: &DriveModel, sides: &[Side]) -> Vec<Cluster> {
        let n = self.noise.len();
        let beside = self.answers.as_ref().map_or(0, Answers::columns);
        let mut clusters = Vec::new();
        if !sides.is_empty() {
            self.kept.begin();
        }
        // Segment by segment, so that the columns of a long log never stand in memory at once.
        for range in self.by_segment() {
            let s = &*self.pieces.get(self.test_functions[range.start].segment);
            let laid = self.laid(s, &range);
            let place = Place::new(self, s, &range, &laid, model);
            let left = |model: &DriveModel| place.left(model, Some(&self.inertia));
            let Some(base) = left(model) else { return Vec::new() };
            let columns: Vec<Option<Vec<f64>>> = numbered(sides.len(), &|i| {
                let side = &sides[i];
                let low = match &side.low {
                    Some(low) => Cow::Owned(left(low)?),
                    None => Cow::Borrowed(&base),
                };
                // What a model explains more is left less.
                Some(low.iter().zip(left(&side.high)?).map(|(low, high)| (low - high) / side.step).collect())
            });
            let mut first = 0;
            for part in self.test_functions[range.clone()].chunk_by(|a, b| a.cluster == b.cluster) {
                let rows = part.len() * n;
                let own = first * n..first * n + rows;
                let weights: Vec<f64> =
                    part.iter().flat_map(|b| b.weights.iter().zip(&self.noise).map(|(w, noise)| w / noise)).collect();
                let residual = DVector::from_fn(rows, |r, _| base[first * n + r] * weights[r]);
                let mut jacobian = DMatrix::zeros(rows, columns.len() + beside);
                for (slots, column) in jacobian.as_mut_slice().chunks_exact_mut(rows).zip(&columns) {
                    let Some(column) = column else { continue };
                    let weighted = column[own.clone()].iter().zip(&weights);
                    slots.iter_mut().zip(weighted).for_each(|(slot, (x, w))| *slot = x * w);
                }
                if let Some(answers) = &self.answers {
                    let test_functions = range.start + first..range.start + first + part.len();
                    answers.fill(&mut jacobian, columns.len(), test_functions, &weights);
                }
                let used: f64 = part.iter().flat_map(|b| &b.weights).sum();
                clusters.push(Cluster::new(s.run, s.t[part[0].first], used, &residual, &jacobian));
                first += part.len();
            }
            clusters.extend(self.felt_clusters(model, sides, s, &range, &laid.shapes));
        }
        if beside > 0 { Cluster::beside(clusters, beside) } else { clusters }
    }
}
