//! What a named effect cannot be told from, how sure it is, and the figures of its link.

use estimation::normal_equations::Cluster;
use estimation::parallel::each;
use nalgebra::{DMatrix, DVector};

use super::{Design, Selection, Trial, finish, is_material, leaves_far_more, placed, settle, stopped};
use crate::problem::{Linear, Problem};
use crate::state::Active;
use crate::thresholds::Thresholds;

/// Held-out RMS of a link in units of its noise, and the same with what is immaterial adjusted.
pub fn figures(design: &Design) -> (f64, f64) {
    let equations = &design.linear.equations;
    let (square, n) = equations.plain();
    let adjusted: f64 =
        design.penalised().held_out(&design.held).iter().zip(&equations.clusters).map(|(l, c)| l / c.weight).sum();
    let raw = (square / n.max(1.0)).sqrt();
    (raw, (adjusted / n.max(1.0)).sqrt().min(raw))
}

/// Two-sided p-value of an effect by flipping the signs of whole clusters, from a linearisation without it.
pub fn sign_flip(linear: &Linear, candidate: usize) -> f64 {
    let columns = linear.of_candidate(candidate);
    let clusters = &linear.equations.clusters;
    let score = |c: &Cluster| DVector::from_fn(columns.len(), |p, _| c.jr[columns[p]]);
    estimation::sign_flips::p_value(&clusters.iter().map(score).collect::<Vec<_>>())
}

/// What explains as much as an active effect when that is taken out.
pub struct Alternatives {
    /// Linearised without the effect.
    pub design: Design,
    /// Sets of names that do as well, the effect's own among them.
    pub sets: Vec<Vec<String>>,
    /// Whether a single alternative has no more parameters and no convention prefers the named effect.
    pub ambiguous: bool,
    /// Effects that the named ones can do with a part of what they are free to do, this one's share of it among them:
    /// how much of it is theirs does not show.
    pub shared: Vec<String>,
}

/// Pairs between which the drawing decides: wheels are mounted where they are drawn, and a camera was calibrated.
const CONVENTIONS: [(&str, &str); 4] = [
    ("wheel-skew", "wheel-angle"),
    ("wheel-skew", "marker-heading"),
    ("wheel-radius", "camera-scale"),
    ("wheel-radius-common", "camera-scale"),
];

/// Of which each is the sum of the two others, in any log: a friction is twice that of one sense and a weight that pulls the
/// other way. That says nothing of a log, and one is more likely than two that undo each other one way.
const SUMS: [[&str; 3]; 1] = [["coulomb-friction", "asymmetric-friction", "hanging-load"]];

/// Finds what an effect cannot be told from.
pub fn alternatives(
    problem: &Problem,
    found: &Selection,
    index: usize,
    all: &[Active],
    thresholds: &Thresholds,
) -> Alternatives {
    let mut without = found.state.clone();
    let own = without.active.remove(index);
    let design = Design::new(problem, &without, all, thresholds);
    let trials = design.trials(thresholds);
    let name = own.effect.name().to_owned();
    let own_gain = trials
        .iter()
        .filter(|t| design.candidates[t.candidate].effect.name() == name)
        .map(|t| t.gain)
        .fold(0.0, f64::max);
    // The same signal matters as much under any name.
    let twin = |c: usize| found.design.is_twin(c, index);
    // What the named ones can do only with this one does its part where they are fitted beside it.
    let shared = shared(&found.design, index, thresholds);
    // Far from the noise adjustments would let anything pass for anything: only what does the same counts.
    let counts = |name: &str| {
        let of_name = |c: &usize| found.design.candidates[*c].effect.name() == name;
        !found.bare
            || (0..found.design.candidates.len()).filter(of_name).any(twin)
            || own.form.free.len() == 1 && shared.iter().any(|s| s == name)
    };
    let mut sets: Vec<Vec<String>> = Vec::new();
    let mut ambiguous = false;
    let mut tried: Vec<String> = vec![name.clone()];
    let mut told: Vec<String> = vec![name.clone()];
    // Of an effect's many shapes the one that does the same here is fitted first: a straight line from where the effect
    // is absent shows a large one of them as well as the others.
    let near = trials.iter().take_while(|t| t.gain >= thresholds.near(own_gain));
    let (same, others): (Vec<&Trial>, Vec<&Trial>) = near.partition(|t| twin(t.candidate));
    for t in same.into_iter().chain(others) {
        let candidate = &design.candidates[t.candidate];
        let alternative_name = candidate.effect.name().to_owned();
        if tried.len() > MOST_TRIED {
            break;
        }
        // An effect has several shapes, and which one is the twin shows only after a fit.
        let shapes = tried.iter().filter(|n| **n == alternative_name).count();
        // What each run has of its own holds what all have in common, and is the cause only where they differ.
        if told.contains(&alternative_name)
            || candidate.effect.nuisance()
            || shapes >= MOST_SHAPES
            || !(t.material || twin(t.candidate))
            || without.active.iter().any(|a| a.effect.name() == alternative_name)
            || !counts(&alternative_name)
        {
            continue;
        }
        tried.push(alternative_name.clone());
        let mut state = without.clone();
        state.active.insert(index, placed(candidate, &t.values));
        let settled = settle(problem, &mut state, all, thresholds);
        let values = state.active[index].parameters();
        // A heavier rotor scatters more in its own torque, by as much as motors that are weaker scatter less: what does
        // the same as the named ones together is judged as they were.
        let same = own.form.free.len() == 1 && shared.contains(&alternative_name);
        let astray = if same { Problem::strays } else { Problem::runs_away };
        if stopped(&state.active[index]) || astray(problem, &state, &without, thresholds) {
            continue;
        }
        let alternative = finish(state, settled, index, thresholds);
        let own_cost = thresholds.cost(own.form.free.len());
        let alternative_cost = thresholds.cost(candidate.form.free.len());
        // Without the price of parameters: what the data say.
        let settled = alternative.against(found) + own_cost - alternative_cost;
        // Of what does the same what is held near zero has other sizes, and other penalties, with each: it is tied where
        // either says so.
        let difference = if same { settled.min(own_gain - t.gain) } else { settled };
        let tie = thresholds.tied(own_gain);
        // What does the same here differs by how exact the laws are.
        if !twin(t.candidate)
            && own.form.free.len() <= candidate.form.free.len()
            && leaves_far_more(problem, &alternative, found, thresholds)
        {
            continue;
        }
        // A spring that is all preload is a weight: what has more to fit must do its part by more than that.
        let no_more = candidate.form.free.len() <= own.form.free.len();
        let is_twin = twin(t.candidate) && no_more;
        if difference < tie.max(thresholds.doubtful) && (is_twin || is_material(candidate, &values)) {
            sets.push(vec![name.clone(), alternative_name.clone()]);
            told.push(alternative_name.clone());
            let preferred = CONVENTIONS.iter().any(|(a, b)| *a == name && *b == alternative_name);
            ambiguous |= difference < tie && no_more && !preferred;
        }
    }
    for other in twins_of_parts(&found.design, index, thresholds) {
        if !told.contains(&other) && counts(&other) {
            sets.push(vec![name.clone(), other.clone()]);
            told.push(other);
        }
    }
    let spanning = super::spanning::spanning_pairs(&found.design, index, thresholds.alike);
    let pair = pair_alternatives(&design, &trials, &spanning, &told, own_gain, thresholds);
    sets.extend(pair.filter(|(spanned, _)| *spanned || !found.bare).map(|p| p.1));
    let shared = shared.into_iter().filter(|other| !told.contains(other)).collect();
    Alternatives { design, sets, ambiguous, shared }
}

/// Effects that the active ones together can do, and could not without this one; and those that this one, which has
/// several parameters, can nearly do.
fn shared(design: &Design, index: usize, thresholds: &Thresholds) -> Vec<String> {
    if design.state.active[index].effect.nuisance() {
        return Vec::new();
    }
    let jj = design.linear.equations.information();
    let done = |columns: &[usize], c: usize| {
        let a = DMatrix::from_fn(columns.len(), columns.len(), |i, j| jj[(columns[i], columns[j])]);
        let b = DVector::from_fn(columns.len(), |i, _| jj[(columns[i], c)]);
        b.dot(&estimation::normal_equations::solve(&a, &b)) / jj[(c, c)].max(1e-300)
    };
    let all = design.linear.active();
    let own = design.linear.of_active(index);
    let others: Vec<usize> = all.iter().copied().filter(|c| !own.contains(c)).collect();
    let is_shared = |c: &usize| {
        let candidate = &design.candidates[*c];
        let columns = design.linear.of_candidate(*c);
        let fits = !candidate.effect.probe() && !candidate.switched() && !columns.is_empty();
        let active = design.state.active.iter().any(|a| a.effect.name() == candidate.effect.name());
        let seen = |j: &usize| design.linear.equations.tells(*j);
        fits && !active
            && columns.iter().all(seen)
            && (own.len() > columns.len() && columns.iter().all(|j| done(&own, *j) > thresholds.hides)
                || columns.iter().all(|j| done(&all, *j) > thresholds.alike)
                    && !columns.iter().all(|j| done(&others, *j) > thresholds.alike))
    };
    let mut names: Vec<String> =
        (0..design.candidates.len()).filter(is_shared).map(|c| design.candidates[c].effect.name().to_owned()).collect();
    names.dedup();
    names
}

/// Shapes of one alternative, and alternatives in all, that are fitted.
const MOST_SHAPES: usize = 3;
const MOST_TRIED: usize = 6;

/// Effects of one wheel that do what an effect of several does on that wheel.
fn twins_of_parts(design: &Design, index: usize, thresholds: &Thresholds) -> Vec<String> {
    let active = &design.state.active[index];
    let parts: Vec<usize> = design.linear.of_active(index);
    let material = |j: &usize| active.form.free[*j].is_material(active.values.get(&active.form.free[*j].name));
    if active.form.wheels.len() < 2 || (0..parts.len()).filter(material).count() < 2 {
        return Vec::new();
    }
    let jj = design.linear.equations.information();
    let alike = |c: usize, j: usize| {
        let [column] = design.linear.of_candidate(c)[..] else { return false };
        let own = active.values.get(&active.form.free[j].name);
        let size = own * jj[(parts[j], column)] / jj[(column, column)].max(1e-300);
        let bounds = design.candidates[c].form.free[0].bounds;
        let cos2 = jj[(parts[j], column)].powi(2) / (jj[(parts[j], parts[j])] * jj[(column, column)]).max(1e-300);
        cos2 > thresholds.alike && size > bounds[0] && size < bounds[1]
    };
    let twins = (0..design.candidates.len()).filter(|c| {
        let candidate = &design.candidates[*c];
        candidate.effect.name() != active.effect.name()
            && !candidate.switched()
            && (0..parts.len()).filter(material).any(|j| alike(*c, j))
    });
    let mut names: Vec<String> = twins.map(|c| design.candidates[c].effect.name().to_owned()).collect();
    names.dedup();
    names
}

/// Two effects that together do what the first of the `told` does, neither of them told already: one of the pairs that
/// span it before two that merely gain as much, and whether it is one.
fn pair_alternatives(
    design: &Design,
    trials: &[Trial],
    spanning: &[[usize; 2]],
    told: &[String],
    own_gain: f64,
    thresholds: &Thresholds,
) -> Option<(bool, Vec<String>)> {
    let effect = |c: usize| design.candidates[c].effect.name();
    let is_told = |c: usize| told.iter().any(|n| n == effect(c));
    let base = design.base();
    let from = base.loss + base.penalty;
    let best = |pairs: Vec<[usize; 2]>, material: &(dyn Fn(usize, &[f64]) -> bool + Sync)| {
        let gain = |pair: &[usize; 2]| {
            let pair = *pair;
            let is_sum =
                |sum: &[&str; 3]| [told[0].as_str(), effect(pair[0]), effect(pair[1])].iter().all(|n| sum.contains(n));
            if effect(pair[0]) == effect(pair[1]) || SUMS.iter().any(is_sum) {
                return None;
            }
            let fit = design.fit(&pair);
            let gain = from - fit.loss - fit.penalty - thresholds.cost(1);
            let sound = pair.iter().all(|c| {
                let v = design.values(&fit, *c);
                design.within_bounds(*c, &v, &fit) && material(*c, &v)
            });
            (sound && gain > own_gain - thresholds.tied(own_gain)).then_some((gain, pair))
        };
        let gains: Vec<(f64, [usize; 2])> = each(&pairs, &gain).into_iter().flatten().collect();
        let most = gains.iter().map(|g| g.0).fold(f64::NEG_INFINITY, f64::max);
        let parameters =
            |g: &&(f64, [usize; 2])| g.1.iter().map(|c| design.candidates[*c].form.free.len()).sum::<usize>();
        let (_, [a, b]) = gains.iter().filter(|g| g.0 > most - thresholds.tied).min_by_key(parameters)?;
        Some([told[0].as_str(), effect(*a), effect(*b)].map(str::to_owned).to_vec())
    };
    let spanning = spanning.iter().filter(|p| !p.iter().any(|c| is_told(*c))).copied().collect();
    if let Some(set) = best(spanning, &|c, v| is_material(&design.candidates[c], v)) {
        return Some((true, set));
    }
    let mut others: Vec<usize> = trials
        .iter()
        .filter(|t| !is_told(t.candidate) && !t.beyond && t.gain > 0.0)
        .map(|t| t.candidate)
        .take(14)
        .collect();
    // Of equals the simplest, and what comes first in the catalogue.
    others.sort_unstable();
    let pairs = others.iter().enumerate().flat_map(|(i, a)| others[i + 1..].iter().map(move |b| [*a, *b])).collect();
    best(pairs, &|c, v| design.material(c, v)).map(|set| (false, set))
}
