//! Symmetric matrices, half of which is kept: hundreds of them make up a linearised log.

use std::ops::Index;

use nalgebra::{DMatrix, DVector};

use crate::sums::dot;

/// A symmetric matrix, the columns of its upper triangle one after the other.
#[derive(Debug, Clone, PartialEq)]
pub struct Symmetric {
    order: usize,
    upper: Vec<f64>,
}

impl Symmetric {
    /// The symmetric matrix with the upper triangle of `full`.
    ///
    /// # Panics
    /// If `full` is not square.
    pub fn of(full: &DMatrix<f64>) -> Self {
        assert!(full.is_square(), "a symmetric matrix is square, not {} by {}", full.nrows(), full.ncols());
        let order = full.ncols();
        let mut upper = Vec::with_capacity(order * (order + 1) / 2);
        for (c, column) in full.as_slice().chunks_exact(full.nrows().max(1)).enumerate() {
            upper.extend_from_slice(&column[..=c]);
        }
        Self { order, upper }
    }

    /// The matrix with rows and columns that stand several times: i is `of[i]` of this one's.
    ///
    /// # Panics
    /// If this one has not so many.
    pub fn spread(&self, of: &[usize]) -> Self {
        let mut upper = Vec::with_capacity(of.len() * (of.len() + 1) / 2);
        for (c, column) in of.iter().enumerate() {
            upper.extend(of[..=c].iter().map(|row| self[(*row, *column)]));
        }
        Self { order: of.len(), upper }
    }

    /// Both halves, as other matrices have them.
    pub fn full(&self) -> DMatrix<f64> {
        let mut sum = DMatrix::zeros(self.order, self.order);
        self.add_to(&mut sum);
        sum
    }

    /// Adds it to a full matrix of the same order.
    ///
    /// # Panics
    /// If that is smaller.
    pub fn add_to(&self, sum: &mut DMatrix<f64>) {
        let mut upper = self.upper.iter();
        for c in 0..self.order {
            for (r, x) in (0..=c).zip(&mut upper) {
                sum[(r, c)] += x;
                if r < c {
                    sum[(c, r)] += x;
                }
            }
        }
    }

    /// Adds another one of the same order.
    ///
    /// # Panics
    /// If it is of another order.
    pub fn add(&mut self, other: &Self) {
        assert_eq!(self.order, other.order, "only matrices of one order have a sum");
        self.upper.iter_mut().zip(&other.upper).for_each(|(a, b)| *a += b);
    }

    /// Multiplies it by a number.
    pub fn scale(&mut self, factor: f64) {
        self.upper.iter_mut().for_each(|x| *x *= factor);
    }

    /// Product with a vector of the same order.
    ///
    /// # Panics
    /// If the vector is shorter.
    pub fn times(&self, x: &DVector<f64>) -> DVector<f64> {
        let mut sum = DVector::zeros(self.order);
        let (out, x) = (sum.as_mut_slice(), x.as_slice());
        let mut upper = self.upper.as_slice();
        for c in 0..self.order {
            let (column, rest) = upper.split_at(c + 1);
            upper = rest;
            out[..c].iter_mut().zip(column).for_each(|(slot, a)| *slot += a * x[c]);
            out[c] += dot(column, x);
        }
        sum
    }

    /// Quadratic form xᵀ A x, of a vector of the same order.
    ///
    /// # Panics
    /// If the vector is shorter.
    pub fn square(&self, x: &DVector<f64>) -> f64 {
        let mut upper = self.upper.iter();
        let column = |c: usize| {
            let above: f64 = (0..c).zip(&mut upper).map(|(r, a)| a * x[r]).sum();
            x[c] * (2.0 * above + upper.next().map_or(0.0, |a| a * x[c]))
        };
        (0..self.order).map(column).sum()
    }
}

impl Index<(usize, usize)> for Symmetric {
    type Output = f64;

    fn index(&self, (row, column): (usize, usize)) -> &f64 {
        let (low, high) = if row < column { (row, column) } else { (column, row) };
        &self.upper[high * (high + 1) / 2 + low]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_of_it_tells_all() {
        let root = DMatrix::from_fn(5, 4, |r, c| (3 * r + 7 * c) as f64 % 5.0 - 1.5);
        let full = root.transpose() * &root;
        let half = Symmetric::of(&full);
        assert_eq!(half.full(), full);
        assert!((0..4).all(|r| (0..4).all(|c| half[(r, c)] == full[(r, c)])));
        let x = DVector::from_fn(4, |i, _| 0.5 - i as f64);
        assert!((half.square(&x) - (x.transpose() * &full * &x)[0]).abs() < 1e-12);
        assert!((half.times(&x) - &full * &x).amax() < 1e-12);
        let spread = half.spread(&[2, 0, 2]);
        assert_eq!(spread.full(), full.select_rows(&[2, 0, 2]).select_columns(&[2, 0, 2]));
        let mut twice = half.clone();
        twice.add(&half);
        twice.scale(0.5);
        assert_eq!(twice, half);
    }
}
