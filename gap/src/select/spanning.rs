//! Pairs of effects that together do what a named one does.

use nalgebra::{DMatrix, DVector};

use super::design::Design;

/// Pairs of candidates of one parameter that do together, the other named effects adapting, what an active effect does
/// and neither of them does alone; none of them need gain anything by itself. A radius and a camera's scale that cancel
/// turn the robot too far and move it as far as expected, as a wrong body radius does.
pub(super) fn spanning_pairs(design: &Design, index: usize, alike: f64) -> Vec<[usize; 2]> {
    let linear = &design.linear;
    let jj = linear.equations.information();
    let own = design.whole(index);
    let parts = linear.of_active(index);
    let others: Vec<usize> = linear.active().into_iter().filter(|c| !own.0.contains(c) && !parts.contains(c)).collect();
    let candidates: Vec<(usize, usize)> = (0..design.candidates.len())
        .filter_map(|c| {
            let candidate = &design.candidates[c];
            let [column] = linear.of_candidate(c)[..] else { return None };
            let active = design.state.active.iter().any(|a| a.effect.name() == candidate.effect.name());
            let fits = !active && !candidate.effect.probe() && !candidate.switched() && linear.equations.tells(column);
            fits.then_some((c, column))
        })
        .collect();
    // What the other named effects leave of the effect (0) and of each candidate.
    let columns: Vec<(Vec<usize>, Vec<f64>)> =
        std::iter::once(own).chain(candidates.iter().map(|(_, column)| (vec![*column], vec![1.0]))).collect();
    let a = DMatrix::from_fn(others.len(), others.len(), |i, j| jj[(others[i], others[j])]);
    let onto = |(c, p): &(Vec<usize>, Vec<f64>)| {
        DVector::from_fn(others.len(), |i, _| c.iter().zip(p).map(|(c, x)| jj[(others[i], *c)] * x).sum())
    };
    let shadows: Vec<DVector<f64>> = columns.iter().map(onto).collect();
    let solved: Vec<DVector<f64>> = shadows.iter().map(|b| estimation::normal_equations::solve(&a, b)).collect();
    let product = |i: usize, j: usize| {
        let ((ci, pi), (cj, pj)) = (&columns[i], &columns[j]);
        let row = |(c, x): (&usize, &f64)| cj.iter().zip(pj).map(|(d, y)| jj[(*c, *d)] * x * y).sum::<f64>();
        ci.iter().zip(pi).map(row).sum::<f64>() - shadows[i].dot(&solved[j])
    };
    let g = DMatrix::from_fn(columns.len(), columns.len(), product);
    let all = g[(0, 0)];
    let alone = |i: usize| g[(0, i)].powi(2) / g[(i, i)].max(1e-300);
    let enough = alike * all;
    let within = |i: usize, x: f64| {
        let p = &design.candidates[candidates[i - 1].0].form.free[0];
        x > p.bounds[0] && x < p.bounds[1] && p.is_material(x)
    };
    let spans = |i: usize, j: usize| {
        let det = g[(i, i)] * g[(j, j)] - g[(i, j)].powi(2);
        // Two that look alike need each other no more than either alone.
        if det <= (1.0 - alike) * g[(i, i)] * g[(j, j)] || alone(i).max(alone(j)) > enough {
            return false;
        }
        let x = (g[(0, i)] * g[(j, j)] - g[(0, j)] * g[(i, j)]) / det;
        let y = (g[(0, j)] * g[(i, i)] - g[(0, i)] * g[(i, j)]) / det;
        x * g[(0, i)] + y * g[(0, j)] > enough && within(i, x) && within(j, y)
    };
    let name = |i: usize| design.candidates[candidates[i - 1].0].effect.name();
    (1..columns.len())
        .flat_map(|i| (i + 1..columns.len()).map(move |j| (i, j)))
        .filter(|(i, j)| name(*i) != name(*j) && spans(*i, *j))
        .map(|(i, j)| [candidates[i - 1].0, candidates[j - 1].0])
        .collect()
}
