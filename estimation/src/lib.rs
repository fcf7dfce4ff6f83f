//! Least squares for residuals that come in clusters: correlated with each other within one, independent between two.
//!
//! Pure numbers: nothing of a robot is in it. Linearised residuals are condensed to small matrices a cluster
//! ([`normal_equations`]), which hold all that the rest needs: fits with Gaussian priors, held-out losses and
//! cluster-robust covariances ([`prior`]), fits that leave alone what the data do not fix ([`truncated`]), and tests
//! by flipped signs of whole clusters ([`sign_flips`]). Matrices and vectors are those of [`nalgebra`], which stands here in
//! the version that they are of.
//!
//! ```
//! use estimation::nalgebra::{DMatrix, DVector};
//! use estimation::normal_equations::{Cluster, NormalEquations};
//! use estimation::prior::{Penalised, Role};
//!
//! // Six residuals that are 2 everywhere, and one column of ones.
//! let residual = DVector::from_element(6, 2.0);
//! let equations = NormalEquations::new(vec![Cluster::new(0, 0.0, 6.0, &residual, &DMatrix::from_element(6, 1, 1.0))]);
//! let free = Penalised::new(&equations, 1.0).fit(&[Role::Free]);
//! assert!((free.step[0] - 2.0).abs() < 1e-6);
//! // Held at zero by a prior as informative as the data, it goes half the way.
//! let held = Penalised::new(&equations, 1.0).fit(&[Role::Held(6f64.powf(-0.5), 0.0)]);
//! assert!((held.step[0] - 1.0).abs() < 1e-6);
//! ```

// Several matrices are walked through together, by one index.
#![allow(clippy::needless_range_loop)]

pub mod normal_equations;
pub mod parallel;
pub mod prior;
pub mod sign_flips;
pub mod statistics;
pub mod sums;
mod symmetric;
pub mod truncated;

pub use nalgebra;
pub use symmetric::Symmetric;
