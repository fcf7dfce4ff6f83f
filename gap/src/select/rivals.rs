//! What a named effect cannot be told from, how sure it is, and the figures of its link.

use nalgebra::DMatrix;
use rand::{RngExt, SeedableRng};
use rayon::prelude::*;

use super::{Bench, Selection, Trial, finish, is_material, placed, settle};
use crate::options::Thresholds;
use crate::problem::Problem;
use crate::state::Active;

/// Held-out RMS of a link in units of its noise, and the same with what is immaterial adjusted.
pub fn figures(bench: &Bench) -> (f64, f64) {
    let gram = &bench.linear.gram;
    let (square, n) = gram.plain();
    let adjusted: f64 = bench.ridge().held_out(&bench.held).iter().zip(&gram.clusters).map(|(l, c)| l / c.weight).sum();
    let raw = (square / n.max(1.0)).sqrt();
    (raw, (adjusted / n.max(1.0)).sqrt().min(raw))
}

/// Two-sided p-value of an effect by flipping the signs of whole clusters, from a bench without it.
pub fn sign_flip(bench: &Bench, candidate: usize) -> f64 {
    let columns = bench.linear.of_candidate(candidate);
    let clusters = &bench.linear.gram.clusters;
    let m = columns.len();
    let mut spread = DMatrix::<f64>::zeros(m, m);
    let scores: Vec<nalgebra::DVector<f64>> = clusters
        .iter()
        .map(|c| {
            let u = nalgebra::DVector::from_fn(m, |p, _| c.jr[columns[p]]);
            spread += &u * u.transpose();
            u
        })
        .collect();
    let ridge = 1e-9 * spread.trace().max(1e-300);
    let Some(inverse) = (spread + DMatrix::identity(m, m) * ridge).try_inverse() else { return 1.0 };
    let statistic = |signs: &mut dyn FnMut() -> f64| {
        let mut sum = nalgebra::DVector::<f64>::zeros(m);
        for u in &scores {
            sum.axpy(signs(), u, 1.0);
        }
        (sum.transpose() * &inverse * &sum)[0]
    };
    let observed = statistic(&mut || 1.0);
    let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(20_051_123);
    let flips = 4999;
    let reached = (0..flips)
        .filter(|_| {
            let mut sign = || if rng.random::<bool>() { 1.0 } else { -1.0 };
            statistic(&mut sign) >= observed
        })
        .count();
    (reached + 1) as f64 / f64::from(flips + 1)
}

/// What explains as much as an active effect when that is taken out.
pub struct Rivals {
    /// Linearised without the effect.
    pub bench: Bench,
    /// Sets of names that do as well, the effect's own among them.
    pub sets: Vec<Vec<String>>,
    /// Whether a single rival has no more parameters and no convention prefers the named effect.
    pub ambiguous: bool,
}

/// Pairs between which the drawing decides: wheels are mounted where they are drawn.
const CONVENTIONS: [(&str, &str); 2] = [("wheel-skew", "wheel-angle"), ("wheel-skew", "marker-heading")];

/// Finds what an effect cannot be told from.
pub fn rivals(problem: &Problem, found: &Selection, index: usize, all: &[Active], thresholds: &Thresholds) -> Rivals {
    let mut without = found.state.clone();
    let own = without.active.remove(index);
    let bench = Bench::new(problem, &without, all, thresholds);
    let trials = bench.trials(thresholds);
    let name = own.effect.name().to_owned();
    let own_gain = trials
        .iter()
        .filter(|t| bench.candidates[t.candidate].effect.name() == name)
        .map(|t| t.gain)
        .fold(0.0, f64::max);
    let mut sets: Vec<Vec<String>> = Vec::new();
    let mut ambiguous = false;
    let mut tried: Vec<String> = vec![name.clone()];
    let mut told: Vec<String> = vec![name.clone()];
    for t in &trials {
        let candidate = &bench.candidates[t.candidate];
        let rival_name = candidate.effect.name().to_owned();
        if t.gain < own_gain - 12.0 - 0.05 * own_gain || tried.len() > MOST_TRIED {
            break;
        }
        // An effect has several shapes, and which one is the twin shows only after a fit.
        let shapes = tried.iter().filter(|n| **n == rival_name).count();
        if told.contains(&rival_name)
            || shapes >= MOST_SHAPES
            || !t.material
            || without.active.iter().any(|a| a.effect.name() == rival_name)
        {
            continue;
        }
        tried.push(rival_name.clone());
        let mut state = without.clone();
        state.active.insert(index, placed(candidate, &t.values));
        let settled = settle(problem, &mut state, all, thresholds);
        let values = state.active[index].parameters();
        let rival = finish(state, settled, index, thresholds);
        let own_cost = thresholds.cost(own.form.free.len());
        let rival_cost = thresholds.cost(candidate.form.free.len());
        // Without the price of parameters: what the data say.
        let difference = rival.against(found) + own_cost - rival_cost;
        let tie = thresholds.tie(own_gain).max(TIED);
        if difference < tie.max(DOUBTFUL) && is_material(candidate, &values) {
            sets.push(vec![name.clone(), rival_name.clone()]);
            told.push(rival_name.clone());
            let preferred = CONVENTIONS.iter().any(|(a, b)| *a == name && *b == rival_name);
            ambiguous |= difference < tie && candidate.form.free.len() <= own.form.free.len() && !preferred;
        }
    }
    if sets.is_empty() {
        sets.extend(pair_rivals(&bench, &trials, &name, own_gain, thresholds));
    }
    Rivals { bench, sets, ambiguous }
}

/// Shapes of one rival, and rivals in all, that are fitted.
const MOST_SHAPES: usize = 3;
const MOST_TRIED: usize = 6;

/// Objectives closer than this are a tie.
const TIED: f64 = 6.0;
/// Closer than this a rival is listed beside the named effect (Kass and Raftery 1995: very strong from 10).
const DOUBTFUL: f64 = 10.0;

/// Two effects that together do what one does.
fn pair_rivals(
    bench: &Bench,
    trials: &[Trial],
    name: &str,
    own_gain: f64,
    thresholds: &Thresholds,
) -> Option<Vec<String>> {
    let others: Vec<usize> = trials
        .iter()
        .filter(|t| bench.candidates[t.candidate].effect.name() != name && t.gain > 0.0)
        .map(|t| t.candidate)
        .take(14)
        .collect();
    let base = bench.base();
    let from = base.loss + base.penalty;
    let pairs: Vec<(usize, usize)> =
        others.iter().enumerate().flat_map(|(i, a)| others[i + 1..].iter().map(move |b| (*a, *b))).collect();
    let best = pairs
        .into_par_iter()
        .filter(|(a, b)| bench.candidates[*a].effect.name() != bench.candidates[*b].effect.name())
        .filter_map(|(a, b)| {
            let fit = bench.fit(&[a, b]);
            let gain = from - fit.loss - fit.penalty - thresholds.cost(1);
            let sound = [a, b].iter().all(|c| {
                let v = bench.values(&fit, *c);
                bench.within_bounds(*c, &v, &fit) && bench.material(*c, &v)
            });
            (sound && gain > own_gain - thresholds.tie(own_gain).max(TIED)).then_some((gain, a, b))
        })
        .max_by(|x, y| x.0.total_cmp(&y.0))?;
    let n = |c: usize| bench.candidates[c].effect.name().to_owned();
    Some(vec![name.to_owned(), n(best.1), n(best.2)])
}
