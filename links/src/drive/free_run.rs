//! Free simulation: how far the speeds of a model run away from those of the log.
//!
//! Unexplained torques say how much would have to be added to a model at every moment, and a model whose motors give
//! nothing and whose wheels have nothing to move needs little. Left to itself such a model goes nowhere: its speeds
//! stay what they were. So what is named must not make the speeds of a free simulation worse.
//!
//! With e = simulated − measured speed, M the inertia, D the damping by the motors' back-EMF and r the unexplained
//! torque, M ė = −r − D e. Loads keep the direction of the measured motion, so that a wheel that stands does not
//! decide.

use nalgebra::{DMatrix, DVector};

use super::{DriveLink, DriveModel, DriveResiduals};

/// Sum of squares of speeds run away, (rad/s)², one for each free run of the simulation; each begins at the speeds of
/// the log and lasts for a cluster, or until a wheel may have been stuck or slipped.
pub fn runaway(link: &DriveLink, model: &DriveModel) -> Option<Vec<f64>> {
    let mechanics = model.mechanics()?;
    // In its own torque, whose inertia turns it into what its speeds gain.
    let residuals = link.residuals_in_own_torque(model)?;
    let damping = model.axes.iter().map(|a| a.braking(model.gear_ratio) * a.encoder_scale);
    let damping = DVector::from_iterator(model.axes.len(), damping);
    let free = followed(link, model);
    // Test functions overlap by half: each stands for that much of the log.
    Some(squares(link, &residuals, &mechanics.response, (&damping, free.as_deref()), 0.5 * link.length()))
}

/// Share of each test function in which the current follows speed, `[wheel][test function]`: a motor at its limit, or below
/// what its bridge drops, brakes nothing that runs away. `None` where it always does.
fn followed(link: &DriveLink, model: &DriveModel) -> Option<Vec<Vec<f64>>> {
    if model.current_limit_a.is_infinite() && model.bridge_drop_v == 0.0 {
        return None;
    }
    let g = model.gear_ratio;
    Some(link.means(model.axes.len(), |s, k, out| {
        for (i, (slot, a)) in out.iter_mut().zip(&model.axes).enumerate() {
            let asked = a.asks_a(s.duty[i][k] * model.supply_at(s, k), g, s.speed[i][k]);
            let dropped = model.bridge_drop_v / a.resistance;
            *slot = f64::from(u8::from(asked.abs() >= dropped && asked.abs() - dropped < model.current_limit_a));
        }
    }))
}

/// Sum of squares of what a model leaves in the torque of its own inertia, in units of the noise, one for each cluster.
///
/// In the torque of a fixed inertia a robot too heavy to move leaves what was measured and no more, which is less than
/// a model leaves whose friction nobody told. In its own torque it leaves more the heavier it is, and friction,
/// whatever its law, does not pass for inertia: over a drive that ends as it begins no function of the speed correlates
/// with the acceleration. A robot too light is the other way round: what is named must be better in both.
pub fn in_own_torque(link: &DriveLink, model: &DriveModel) -> Option<Vec<f64>> {
    let residuals = link.residuals_in_own_torque(model)?;
    let mut out: Vec<f64> = Vec::new();
    let mut before = None;
    for b in 0..link.len() {
        if before != Some(link.cluster(b)) {
            out.push(0.0);
            before = Some(link.cluster(b));
        }
        let weighted = residuals.torque[b].iter().zip(&residuals.weights[b]).zip(&link.noise);
        let weighted = weighted.map(|((t, w), s)| (w * t / s).powi(2));
        if let Some(last) = out.last_mut() {
            *last += weighted.sum::<f64>();
        }
    }
    Some(out)
}

fn squares(
    link: &DriveLink,
    residuals: &DriveResiduals,
    response: &DMatrix<f64>,
    (damping, free): (&DVector<f64>, Option<&[Vec<f64>]>),
    hop: f64,
) -> Vec<f64> {
    let n = damping.len();
    let Some(mut step) = implicit(response, damping, hop) else { return Vec::new() };
    let mut out: Vec<f64> = Vec::new();
    let mut e = DVector::zeros(n);
    let mut before: Option<(usize, usize)> = None;
    for b in 0..link.len() {
        let at = (link.place(b).0, link.cluster(b));
        if before != Some(at) {
            out.push(0.0);
            e.fill(0.0);
            before = Some(at);
        }
        if residuals.weights[b].contains(&0.0) {
            e.fill(0.0);
            continue;
        }
        if let Some(free) = free {
            let left = DVector::from_fn(n, |i, _| damping[i] * free[i][b]);
            step = implicit(response, &left, hop).unwrap_or(step);
        }
        let torque = DVector::from_column_slice(&residuals.torque[b]);
        e = &step * (e - response * torque * hop);
        if let Some(last) = out.last_mut() {
            *last += e.norm_squared();
        }
    }
    out
}

/// (1 + h·M⁻¹·D)⁻¹: a step of implicit Euler, stable however slow the log.
fn implicit(response: &DMatrix<f64>, damping: &DVector<f64>, h: f64) -> Option<DMatrix<f64>> {
    let n = damping.len();
    (DMatrix::identity(n, n) + response * DMatrix::from_diagonal(damping) * h).try_inverse()
}

/// Whether free simulations of one model run away further than those of another: their difference over all runs, in
/// units of its own spread, beyond `sigmas`.
pub fn further(one: &[f64], other: &[f64], sigmas: f64) -> bool {
    let differences = || one.iter().zip(other).map(|(a, b)| a - b);
    let sum: f64 = differences().sum();
    sum.is_nan() || sum > sigmas * differences().map(|d| d * d).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_is_that_of_a_motor_that_settles() {
        // 2 kg m², 4 Nm s/rad: a time constant of half a second; a constant torque missing of 8 Nm is 2 rad/s.
        let (response, damping) = (DMatrix::from_element(1, 1, 0.5), DVector::from_element(1, 4.0));
        for h in [1e-3, 0.1, 10.0] {
            let step = implicit(&response, &damping, h).unwrap();
            let mut e = DVector::zeros(1);
            for _ in 0..(20.0 / h) as usize + 20 {
                e = &step * (e - &response * DVector::from_element(1, 8.0) * h);
            }
            assert!((e[0] + 2.0).abs() < 1e-6, "{h}: {}", e[0]);
        }
    }

    #[test]
    fn only_what_is_worse_in_many_runs_is_worse() {
        assert!(further(&[2.0; 20], &[1.0; 20], 2.0));
        assert!(!further(&[1.0; 20], &[1.0; 20], 2.0) && !further(&[1.0; 20], &[2.0; 20], 2.0));
        let mut once = [1.0; 20];
        once[3] = 50.0;
        assert!(!further(&once, &[1.0; 20], 2.0));
        assert!(further(&[f64::NAN], &[1.0], 2.0));
    }
}
