//! The noise floor of the drive link.

use nalgebra::{DMatrix, DVector};

use super::{DriveLink, DriveModel, DriveResiduals, smooth_sign};
use crate::thresholds;
use estimation::normal_equations::solve;
use runs::robot::Support;

/// Torque below which no drive is predicted, Nm as a share of what the motors reach in the logs.
const LEAST: f64 = 0.001;

/// A generic regression of unexplained torques: smooth functions of the wheel's own and the other
/// wheels' speed, direction, duty and sideways motion, and of the heading. It knows nothing of the
/// catalogue and is fixed before any effect is fitted.
pub struct Generic {
    shared: Vec<Vec<f64>>,
    /// Columns of each wheel alone.
    own: Vec<Vec<Vec<f64>>>,
}

/// What a generic regression leaves of one wheel's torques.
pub struct Left {
    /// The test functions that count.
    pub test_functions: Vec<usize>,
    /// Torque left, Nm, one a test function.
    pub torque: Vec<f64>,
    /// Standard deviation, Nm.
    pub scatter: f64,
}

/// Columns of a wheel that no other shares.
const ALONE: usize = 4;
/// Further ones of an axis on blocks, which may turn a weight or an encoder that sits beside its middle.
const ONCE_A_TURN: usize = 6;
/// Columns of the way a robot drives; on blocks it stands still.
const DRIVES: usize = 6;
const STANDS: usize = 1;
/// Test functions that a column needs.
pub const FEWEST_PER_COLUMN: usize = 3;

/// Number of columns that the wheels share, and of each alone.
fn columns(link: &DriveLink) -> (usize, usize) {
    let (body, alone) = match link.pieces.robot().support {
        Support::Blocks => (STANDS, ALONE + ONCE_A_TURN),
        Support::Floor => (DRIVES, ALONE),
    };
    (3 * link.noise.len() + body, alone)
}

impl Generic {
    /// Functions that describe one wheel.
    pub fn columns_of_wheel(link: &DriveLink) -> usize {
        let (shared, alone) = columns(link);
        shared + alone
    }

    /// Its columns, the likeliest first.
    pub fn new(link: &DriveLink) -> Self {
        let n = link.noise.len();
        let slides = thresholds::SLIDES * link.pieces.robot().wheel_radius_m;
        let (shared, alone) = columns(link);
        let mut all = link.means(shared + alone * n, |s, k, out| {
            let (common, own) = out.split_at_mut(shared);
            let (wheels, body) = common.split_at_mut(3 * n);
            for i in 0..n {
                let (speed, duty) = (s.speed[i][k], s.duty[i][k]);
                let sign = smooth_sign(speed, s.turning);
                wheels[3 * i..3 * i + 3].copy_from_slice(&[sign, speed, duty]);
                let (laws, turning) = own[alone * i..][..alone].split_at_mut(ALONE);
                laws.copy_from_slice(&[speed * speed.abs(), duty.abs() * sign, duty.powi(3), sign.abs()]);
                if !turning.is_empty() {
                    let [sin, cos] = s.shaft_sin_cos(i, k);
                    let square = speed * speed;
                    turning.copy_from_slice(&[sin, cos, speed * sin, speed * cos, square * sin, square * cos]);
                }
            }
            let (heading, twist) = (s.heading[k], s.twist[k]);
            let drives = [
                heading.cos(),
                heading.sin(),
                smooth_sign(twist.vx, slides * s.turning),
                smooth_sign(twist.vy, slides * s.turning),
                twist.vx * twist.omega,
                twist.vy * twist.omega,
            ];
            body.copy_from_slice(if body.len() == STANDS { &[1.0] } else { &drives });
        });
        let mut rest = all.split_off(shared).into_iter();
        let own = (0..n).map(|_| rest.by_ref().take(alone).collect()).collect();
        Self { shared: all, own }
    }

    /// What it leaves of a wheel's torques; `None` where the logs are too short to say. Short logs have the likeliest
    /// columns only, with those of direction, speed and duty of every wheel at least.
    pub fn leaves(&self, link: &DriveLink, residuals: &DriveResiduals, wheel: usize) -> Option<Left> {
        let test_functions: Vec<usize> = link.counted(wheel).collect();
        let most = test_functions.len() / FEWEST_PER_COLUMN;
        let columns: Vec<&Vec<f64>> = self.shared.iter().chain(&self.own[wheel]).take(most).collect();
        if columns.len() < self.shared.len() {
            return None;
        }
        let torque = |b: usize| residuals.torque[b][wheel];
        let m = columns.len();
        let product = |p: usize, q: usize| test_functions.iter().map(|b| columns[p][*b] * columns[q][*b]).sum::<f64>();
        let mut square = DMatrix::zeros(m, m);
        for p in 0..m {
            for q in 0..=p {
                square[(p, q)] = product(p, q);
                square[(q, p)] = square[(p, q)];
            }
        }
        let x = solve(
            &square,
            &DVector::from_fn(m, |p, _| test_functions.iter().map(|b| columns[p][*b] * torque(*b)).sum()),
        );
        let fitted = |b: usize| columns.iter().zip(x.iter()).map(|(column, x)| column[b] * x).sum::<f64>();
        let left: Vec<f64> = test_functions.iter().map(|b| torque(*b) - fitted(*b)).collect();
        let scatter = (left.iter().map(|l| l * l).sum::<f64>() / (test_functions.len() - m) as f64).sqrt();
        Some(Left { test_functions, torque: left, scatter })
    }
}

/// Scatter of the unexplained torque of one test function, Nm, one a wheel, and how many neighbouring test functions
/// count as one: what a generic regression leaves is noise.
pub fn floor(link: &DriveLink, residuals: &DriveResiduals, drive_nm: f64) -> (Vec<f64>, f64) {
    let generic = Generic::new(link);
    let beside = link.beside_answers(residuals);
    let mut noise = vec![drive_nm * LEAST; link.noise.len()];
    let (mut lagged, mut power) = (0.0, 0.0);
    for (i, slot) in noise.iter_mut().enumerate() {
        let Some(mut left) = generic.leaves(link, beside.as_ref().unwrap_or(residuals), i) else {
            // Too short for that: the scatter of neighbours.
            *slot = slot.max(neighbours(residuals, i));
            continue;
        };
        if let Some(beside) = &beside {
            // What a loop answered scatters what its set points show (the variance of two-stage least squares).
            let answered = |b: &usize| residuals.torque[*b][i] - beside.torque[*b][i];
            left.torque.iter_mut().zip(&left.test_functions).for_each(|(torque, b)| *torque += answered(b));
            left.scatter = estimation::statistics::rms(left.torque.iter().copied()).max(left.scatter);
        }
        *slot = slot.max(left.scatter);
        for (r, pair) in left.test_functions.windows(2).enumerate() {
            if pair[1] == pair[0] + 1 && link.place(pair[1]).0 == link.place(pair[0]).0 {
                lagged += left.torque[r] * left.torque[r + 1] / (*slot * *slot);
            }
            power += left.torque[r] * left.torque[r] / (*slot * *slot);
        }
    }
    // A first-order correlation and its sum over all lags.
    let rho = if power > 0.0 { (lagged / power).clamp(0.0, 0.8) } else { 0.2 };
    (noise, (1.0 + rho) / (1.0 - rho))
}

/// Share of what a wheel's duty varies that its own motion accounts for, one a wheel: a drive's voltage is what speed,
/// friction, acceleration and, on an axis alone, a weight take. Duties of another drive have next to nothing to do with them.
pub fn accounted(link: &DriveLink, model: &DriveModel) -> Vec<f64> {
    let n = link.noise.len();
    let lifted = link.pieces.robot().support == Support::Blocks;
    let means = link.means(5 * n, |s, k, out| {
        for i in 0..n {
            let speed = s.speed[i][k];
            let [sin, cos] = if lifted { s.shaft_sin_cos(i, k) } else { [0.0; 2] };
            let volts = s.duty[i][k] * s.supply[k];
            out[5 * i..5 * i + 5].copy_from_slice(&[volts, speed, smooth_sign(speed, s.turning), sin, cos]);
        }
    });
    let width = if lifted { 6 } else { 4 };
    let accelerated = link.done(model);
    let of = |i: usize| {
        let used: Vec<usize> = link.counted(i).filter(|b| *b < accelerated.len()).collect();
        let volts = DVector::from_iterator(used.len(), used.iter().map(|b| means[5 * i][*b]));
        let varies = volts.add_scalar(-volts.mean()).norm_squared();
        let motion = DMatrix::from_fn(used.len(), width, |row, column| match column {
            0 => 1.0,
            1 => accelerated[used[row]][i],
            _ => means[5 * i + column - 1][used[row]],
        });
        let x = solve(&(motion.transpose() * &motion), &(motion.transpose() * &volts));
        let left = (&motion * x - &volts).norm_squared();
        // A duty that never varies says nothing of whose it is.
        if varies > 1e-12 * volts.norm_squared() { 1.0 - left / varies } else { 1.0 }
    };
    (0..n).map(of).collect()
}

/// Torque that one count more or less makes in a test function at most, Nm at the wheel shaft: with sin²(πt/L) over L/2, twice
/// by parts, a step of an angle weighs 2π/L² where the slope is largest.
pub fn of_a_count(link: &DriveLink) -> f64 {
    let heaviest = link.inertia.diagonal().iter().copied().fold(0.0, f64::max);
    heaviest * link.sizes.count_rad * std::f64::consts::TAU / link.length().powi(2)
}

fn neighbours(residuals: &DriveResiduals, wheel: usize) -> f64 {
    let mut differences: Vec<f64> = residuals.torque.windows(5).map(|w| (w[4][wheel] - w[0][wheel]).abs()).collect();
    estimation::statistics::median(&mut differences) / (0.6745 * 2.0_f64.sqrt())
}
