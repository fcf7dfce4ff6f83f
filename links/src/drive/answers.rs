//! What speed loops answer: the part of duties and speeds that their set points do not account for.
//!
//! A loop answers every torque that a model lacks, so that its duties go with what is left: a regression on them takes
//! the answer for a motor. Set points know nothing of such torques, and what they make of duties and speeds is all that
//! may speak for an effect (instrumental variables: Söderström and Stoica, Instrumental Variable Methods for System
//! Identification, 1983). The rest stands beside every effect in columns of its own, which comes to the same.

use std::ops::Range;

use nalgebra::{DMatrix, DVector};
use runs::robot::Support;

use super::{DriveLink, DriveResiduals, FEWEST_PER_COLUMN, smooth_sign};
use crate::thresholds::ACCOUNTED_FOR;
use estimation::normal_equations::solve;

/// Ages of a set point that tell, in lengths of a test function; and those of which the direction does, too.
const AGES: [f64; 5] = [0.0, 0.25, 0.5, 1.0, 2.0];
const DIRECTIONS: usize = 3;

/// What a wheel's loop answers in: the voltage of its motor, and its speed.
const WAYS: usize = 2;

/// The answers of every wheel's loop, `[wheel][way][test function]`.
pub struct Answers(Vec<[Vec<f64>; WAYS]>);

impl Answers {
    /// Of a data set with set points; `None` where they account for too little, or are not logged, and where an inertial
    /// sensor tells of wheels that slip, whose rows have no loop.
    pub fn of(link: &DriveLink) -> Option<Self> {
        let n = link.noise.len();
        let logged = |b: usize| link.pieces.get(link.place(b).0).reference.len() == n;
        if link.felt.is_some() || !logged(0) || !logged(link.len() - 1) {
            return None;
        }
        let each = AGES.len() + DIRECTIONS;
        let ages = AGES.map(|age| link.tick_count(age * link.length()));
        let mut made = link.means((WAYS + each) * n, |s, k, out| {
            let (ways, told) = out.split_at_mut(WAYS * n);
            for i in 0..n {
                ways[WAYS * i..][..WAYS].copy_from_slice(&[s.duty[i][k] * s.supply[k], s.speed[i][k]]);
                for (age, ticks) in ages.iter().enumerate() {
                    // A run without set points makes what follows NaN, and accounts for nothing.
                    let set = s.reference.get(i).map_or(f64::NAN, |set| set[k.saturating_sub(*ticks)]);
                    told[each * i + age] = set;
                    if age < DIRECTIONS {
                        told[each * i + AGES.len() + age] = smooth_sign(set, s.turning);
                    }
                }
            }
        });
        let told = made.split_off(WAYS * n);
        // A robot's wheels move each other.
        let alone = link.pieces.robot().support == Support::Blocks;
        let wheel = |i: usize| -> Option<[Vec<f64>; WAYS]> {
            let own = if alone { each * i..each * (i + 1) } else { 0..told.len() };
            let used: Vec<usize> = link.counted(i).collect();
            if used.len() < FEWEST_PER_COLUMN * (own.len() + 1) {
                return None;
            }
            let columns = DMatrix::from_fn(used.len(), own.len() + 1, |row, column| {
                if column == 0 { 1.0 } else { told[own.start + column - 1][used[row]] }
            });
            let information = columns.transpose() * &columns;
            let mut ways = [0, 1].map(|way| {
                let value = DVector::from_fn(used.len(), |row, _| made[WAYS * i + way][used[row]]);
                let left = &value - &columns * solve(&information, &(columns.transpose() * &value));
                let varies = value.add_scalar(-value.mean()).norm_squared();
                let accounted = 1.0 - left.norm_squared() / varies;
                if accounted.is_nan() || accounted < ACCOUNTED_FOR {
                    return None;
                }
                let mut all = vec![0.0; link.len()];
                used.iter().zip(left.iter()).for_each(|(b, x)| all[*b] = *x);
                Some(all)
            });
            Some([ways[0].take()?, ways[1].take()?])
        };
        (0..n).map(wheel).collect::<Option<_>>().map(Self)
    }

    /// Columns that they take.
    pub(super) fn columns(&self) -> usize {
        WAYS * self.0.len()
    }

    /// Writes their columns into those of a cluster from `from` on; a row each test function and wheel.
    pub(super) fn fill(&self, jacobian: &mut DMatrix<f64>, from: usize, test_functions: Range<usize>, weights: &[f64]) {
        let n = self.0.len();
        for (place, b) in test_functions.enumerate() {
            for (i, ways) in self.0.iter().enumerate() {
                let row = n * place + i;
                for (way, column) in ways.iter().enumerate() {
                    jacobian[(row, from + WAYS * i + way)] = weights[row] * column[b];
                }
            }
        }
    }

    /// Torques without what they do of them.
    pub(super) fn beside(&self, link: &DriveLink, left: &DriveResiduals) -> DriveResiduals {
        let mut out = left.clone();
        for (i, ways) in self.0.iter().enumerate() {
            let used: Vec<usize> = link.counted(i).collect();
            let columns = DMatrix::from_fn(used.len(), WAYS, |row, way| ways[way][used[row]]);
            let torque = DVector::from_fn(used.len(), |row, _| left.torque[used[row]][i]);
            let done = &columns * solve(&(columns.transpose() * &columns), &(columns.transpose() * torque));
            used.iter().zip(done.iter()).for_each(|(b, done)| out.torque[*b][i] -= done);
        }
        out
    }

    /// How much of what is left on the drive they do.
    pub fn left(&self, link: &DriveLink, left: &DriveResiduals) -> LeftToAnswer {
        let sums = |left: &DriveResiduals| {
            let [mut square, mut torque, mut weights] = [0.0; 3];
            for b in 0..link.len() {
                for ((own, weight), noise) in left.torque[b].iter().zip(link.weights(b)).zip(&link.noise) {
                    square += weight * (own / noise).powi(2);
                    torque += weight * own * own;
                    weights += weight;
                }
            }
            [square, torque / f64::max(weights, f64::MIN_POSITIVE)]
        };
        let ([whole, torque], [beside, torque_beside]) = (sums(left), sums(&self.beside(link, left)));
        LeftToAnswer { whole, beside, answered_nm2: torque - torque_beside }
    }
}

/// What is left on a drive, in squared noise, and beside what loops do of it.
pub struct LeftToAnswer {
    whole: f64,
    /// What no answer does of it.
    pub beside: f64,
    answered_nm2: f64,
}

impl LeftToAnswer {
    /// Share of it that the loops do.
    pub fn share(&self) -> f64 {
        1.0 - self.beside / self.whole.max(f64::MIN_POSITIVE)
    }

    /// Torque that they do, RMS, Nm.
    pub fn answered_nm(&self) -> f64 {
        self.answered_nm2.max(0.0).sqrt()
    }
}
