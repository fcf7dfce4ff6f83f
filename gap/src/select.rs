//! Selection: which effects must be named for a link, and which are there but immaterial.

mod alternatives;
mod design;
mod dwarfed;
mod gates;
mod join;
mod late;
mod left;
mod lighter;
mod plain;
mod simpler;
mod spanning;
mod sure;
mod undecided;
mod undone;

use std::sync::{Arc, OnceLock};

use estimation::parallel::each;

use crate::problem::{Owner, Problem};
use crate::state::{Active, State};
use crate::thresholds::Thresholds;
use estimation::normal_equations::NormalEquations;
use estimation::prior::PenalisedFit;
use links::effect::{Effect, Link};
use links::thresholds::Refusal;

use gates::Gates;
use join::join;
use left::Left;

pub use crate::candidates::candidates;
use crate::candidates::does_all;
pub use crate::state::is_material;
pub use alternatives::{Alternatives, alternatives, figures, sign_flip};
pub use design::{Design, Trial};
pub(crate) use dwarfed::dwarfed;
pub(crate) use lighter::{heavier, is_heavier};
pub(crate) use plain::{held_out, plain};
pub(crate) use simpler::one_beside;
pub use sure::estimates;
pub(crate) use undecided::{LATENCY, Late, late_in_place, undecided};
pub(crate) use undone::not_undone;

/// Largest number of effects named on one link.
const MOST: usize = 5;
/// Candidates among which all pairs and triples are tried.
const SHORT_LIST: usize = 9;
/// Rounds of relinearisation while the named effects still move.
const ROUNDS: usize = 3;
/// A removal that costs more than this in the linear approximation is not tried.
const FAR: f64 = 40.0;

/// Outcome of a selection.
pub struct Selection {
    /// The state with the named (and the freed immaterial) effects.
    pub state: State,
    /// Linearised about it.
    pub design: Design,
    /// Sum of squares left, in units of the assumed noise.
    pub loss: f64,
    /// Penalty of what is held near zero, and cost of what is named.
    pub costs: f64,
    /// Whether it was chosen with nothing adjusted beside what is named.
    pub bare: bool,
    /// What was selected and taken back again by its own estimates, and why.
    pub taken_back: Vec<(String, Refusal)>,
    /// See [`Selection::alone`].
    alone: OnceLock<Left>,
}

impl Selection {
    /// The same, linearised on other data.
    pub(crate) fn on(&self, design: Design) -> Self {
        let (state, taken_back, alone) = (self.state.clone(), self.taken_back.clone(), OnceLock::new());
        Self { state, design, loss: self.loss, costs: self.costs, bare: self.bare, taken_back, alone }
    }

    /// The same with nothing adjusted beside what is named.
    pub(crate) fn stripped(self) -> Self {
        Self { bare: true, alone: OnceLock::new(), ..self }
    }

    /// What its effects leave, fitted with nothing adjusted beside them.
    fn alone(&self, problem: &Problem) -> &Left {
        self.alone.get_or_init(|| {
            let mut state = self.state.clone();
            problem.fit(&mut state);
            Left::fitted(problem, &state)
        })
    }

    /// Whether it explains with fewer parameters than another one all but what is next to noise: there a law that is not
    /// exact beside rest, as that of a friction, is no reason to fit more.
    fn is_simpler_and_near(&self, other: &Self, thresholds: &Thresholds) -> bool {
        let parameters = |s: &Self| s.state.active.iter().map(|a| a.form.free.len()).sum::<usize>();
        parameters(self) < parameters(other) && raw(self) < thresholds.far_left
    }

    /// Difference of the objectives of two selections, under one variance; negative if this is
    /// the better one.
    fn against(&self, other: &Self) -> f64 {
        let variance = self.design.variance.min(other.design.variance);
        (self.loss - other.loss) / variance + self.costs - other.costs
    }
}

/// Selects the effects of one link, beginning with those `known` from an earlier look at it.
pub fn select(
    problem: &Problem,
    start: &State,
    known: &[Active],
    catalogue: &[Arc<dyn Effect>],
    thresholds: &Thresholds,
) -> Selection {
    let all = problem.candidates(start, catalogue);
    let light = if known.is_empty() {
        lighter::lighter(problem, start, &all, thresholds)
    } else {
        lighter::kept(problem, start, known, thresholds)
    };
    let best = searched(problem, start, known, &all, thresholds);
    // What is left far above the noise is not a little of everything: another search in which next to nothing is
    // adjusted without a name. Nearer to it, beside what has a name, only for what leaves noise alone, and no more than one
    // law more: several of them fit whatever a law that is not exact leaves.
    let left = raw(&best);
    let named = |s: &Selection| s.state.active[start.active.len()..].iter().filter(|a| a.is_named()).count();
    let far = left >= thresholds.far_left;
    let open = left >= thresholds.worth_saying && named(&best) > 0 && leaves_more_than_its_laws(&best);
    let best = if problem.link() == Link::Drive && (far || open) {
        let other = searched(problem, start, &[], &all, &thresholds.narrow());
        // The same names have their intervals with margins beside them.
        let near = || {
            let few = named(&other) <= named(&best) + 1;
            few && !is_alike(&best, &other) && other.alone(problem).is_noise(thresholds)
        };
        let better = raw(&other) < thresholds.as_well * left && (far || near());
        if named(&other) > 0 && better { other } else { best }
    } else {
        best
    };
    // Beside a gap that wide nothing is a margin: what is missing with it is looked for with nothing adjusted.
    let begun = |laws: &[Active]| plain(problem, start, laws, &all, thresholds, false);
    let other = if light.is_empty() { None } else { begun(&light) };
    let better = |other: &Selection| {
        thresholds.as_well * raw(other) < raw(&best) && !best.is_simpler_and_near(other, thresholds)
    };
    let best = other.filter(better).unwrap_or(best);
    let late = if known.is_empty() { late::late(problem, start, &all, thresholds) } else { None };
    let other = late.map(|age| searched(problem, start, &[age], &all, thresholds));
    // From the best of several ages on it is the same search, nearer to where it ends.
    let best = other.filter(|other| raw(other) < raw(&best)).unwrap_or(best);
    let in_place = problem.in_place(start, catalogue);
    simpler::simpler(problem, start, best, &all, &in_place, thresholds)
}

/// Whether two selections name the same.
fn is_alike(one: &Selection, other: &Selection) -> bool {
    let names = |s: &Selection| {
        let named = s.state.active.iter().filter(|a| a.is_named());
        let mut names: Vec<String> = named.map(|a| a.effect.name().to_owned()).collect();
        names.sort_unstable();
        names
    };
    names(one) == names(other)
}

/// Whether more than noise is left, and than the laws of what is named may leave.
fn leaves_more_than_its_laws(found: &Selection) -> bool {
    let (square, n) = found.design.linear.equations.plain();
    square - n > found.design.left_by_laws()
}

/// RMS of the residuals in units of the noise.
fn raw(found: &Selection) -> f64 {
    let (square, n) = found.design.linear.equations.plain();
    (square / n.max(1.0)).sqrt()
}

/// Whether a law of the drive leaves far more than another, each fitted with nothing adjusted beside it.
fn leaves_far_more(problem: &Problem, worse: &Selection, better: &Selection, thresholds: &Thresholds) -> bool {
    problem.link() == Link::Drive && worse.alone(problem).far_above(better.alone(problem), thresholds)
}

/// Whether a law of the drive leaves no more than another, next to noise, each fitted with nothing adjusted beside it.
fn leaves_as_little(problem: &Problem, law: &Selection, other: &Selection, thresholds: &Thresholds) -> bool {
    problem.link() == Link::Drive && law.alone(problem).is_as_little(other.alone(problem), thresholds)
}

fn searched(problem: &Problem, start: &State, known: &[Active], all: &[Active], thresholds: &Thresholds) -> Selection {
    let from = start.active.len();
    let best = if known.is_empty() {
        first(problem, start, all, thresholds)
    } else {
        let design = beginning(problem, start, known, all, thresholds);
        forward(problem, design, from, all, thresholds)
    };
    let best = backward(problem, best, from, all, thresholds);
    let (best, swapped) = swap(problem, best, from, all, thresholds);
    let (best, joined) = join(problem, start, best, from, all, thresholds);
    let best = if swapped || joined { backward(problem, best, from, all, thresholds) } else { best };
    sure::sure(problem, best, from, all, thresholds)
}

/// The best of a greedy search and of one that begins with a pair or triple.
fn first(problem: &Problem, start: &State, all: &[Active], thresholds: &Thresholds) -> Selection {
    let from = start.active.len();
    let first = Design::new(problem, start, all, thresholds);
    // A pair or triple that a greedy search may miss, from the first linearisation.
    let subset: Vec<Active> = short_subset(&first, thresholds).map_or_else(Vec::new, |s| {
        let fit = first.fit(&s);
        s.iter().map(|c| placed(&first.candidates[*c], &first.values(&fit, *c))).collect()
    });
    let best = forward(problem, first, from, all, thresholds);
    let greedy = &best.state.active[from..];
    let alike = |a: &Active, b: &Active| a.effect.name() == b.effect.name() && a.form.wheels == b.form.wheels;
    let same = subset.len() == greedy.len() && subset.iter().all(|a| greedy.iter().any(|b| alike(a, b)));
    if subset.is_empty() || greedy.is_empty() || same || subset.len() > greedy.len() + 1 {
        return best;
    }
    let larger = subset.len() > greedy.len();
    let design = beginning(problem, start, &subset, all, thresholds);
    let other = forward(problem, design, from, all, thresholds);
    // What is larger must also stand on the held-out runs, every part of it beside the others.
    let better = other.against(&best) < if larger { -thresholds.gain } else { -thresholds.first };
    let stands = || !larger || (from..other.state.active.len()).all(|i| admitted(problem, &other, i, all, thresholds));
    if better && stands() && !problem.runs_away(&other.state, &best.state, thresholds) { other } else { best }
}

/// The design from which effects that are given go on.
fn beginning(problem: &Problem, start: &State, given: &[Active], all: &[Active], thresholds: &Thresholds) -> Design {
    let mut state = start.clone();
    state.active.extend_from_slice(given);
    settle(problem, &mut state, all, thresholds)
}

/// Whether an effect of a selection passes the gates beside the others.
fn admitted(problem: &Problem, found: &Selection, index: usize, all: &[Active], thresholds: &Thresholds) -> bool {
    let mut without = found.state.clone();
    let own = without.active.remove(index);
    let design = Design::new(problem, &without, all, thresholds);
    let is_own = |t: &Trial| {
        let c = &design.candidates[t.candidate];
        c.effect.name() == own.effect.name() && c.form.wheels == own.form.wheels && c.form.fixed == own.form.fixed
    };
    let gates = Gates::new(problem.link(), &design, thresholds);
    design.trials(thresholds).iter().any(|t| is_own(t) && t.gain >= thresholds.gain && gates.pass(t))
}

/// The one effect that explains most where nothing may be adjusted but what is tiny: for a gap that matters
/// although every adjustment that closes it is immaterial by itself.
pub fn single(
    problem: &Problem,
    start: &State,
    catalogue: &[Arc<dyn Effect>],
    thresholds: &Thresholds,
) -> Option<Selection> {
    let all = problem.candidates(start, catalogue);
    let narrow = thresholds.narrow();
    let design = Design::new(problem, start, &all, &narrow);
    let led_out = design.trials(&narrow).into_iter().filter(|t| !is_sure(t, &narrow)).map(|t| t.candidate);
    let mut refused: Vec<usize> = led_out.collect();
    let best = next(problem.link(), &design, &narrow, &refused)?;
    // A little of something else may explain as much; then what is large enough to have a name stands for both.
    let mut material = Some(best.clone());
    while let Some(t) = material.as_ref().filter(|t| !t.material) {
        refused.push(t.candidate);
        material = next(problem.link(), &design, &narrow, &refused);
    }
    let as_good = |t: &Trial| !t.beyond && t.gain >= best.gain - narrow.tie(best.gain);
    let best = material.filter(as_good)?;
    let mut state = start.clone();
    state.active.push(placed(&design.candidates[best.candidate], &best.values));
    // Estimated as it was found: a margin of what is not named would be as wide as the effect.
    let settled = settle(problem, &mut state, &all, &narrow);
    let found = finish(state, settled, start.active.len(), &narrow);
    let found = swap(problem, found, start.active.len(), &all, &narrow).0;
    let found = sure::sure(problem, found, start.active.len(), &all, &narrow);
    let sound =
        found.state.active.last().is_some_and(Active::worth) && !problem.runs_away(&found.state, start, thresholds);
    sound.then_some(found)
}

/// Replaces each effect by whatever explains the same better, or as well and comes earlier in the
/// catalogue.
fn swap(
    problem: &Problem,
    mut best: Selection,
    from: usize,
    all: &[Active],
    thresholds: &Thresholds,
) -> (Selection, bool) {
    let mut changed = false;
    // Along ways fewer parameters may have taken a place, beside which others have simpler equals, too.
    for _ in 0..if problem.is_along_ways() { 2 } else { 1 } {
        for index in from..best.state.active.len() {
            // What took the place may have an equal that comes earlier in turn, which the former explained too much for.
            let mut simpler_alone = false;
            while let Some(other) = swapped(problem, &best, index, simpler_alone, from, all, thresholds) {
                (best, changed, simpler_alone) = (other, true, true);
            }
        }
    }
    (best, changed)
}

/// A selection in which another effect stands for one, if it explains the same better, or as well and comes earlier in the
/// catalogue; or only where it is simpler, too.
fn swapped(
    problem: &Problem,
    best: &Selection,
    index: usize,
    simpler_alone: bool,
    from: usize,
    all: &[Active],
    thresholds: &Thresholds,
) -> Option<Selection> {
    let mut without = best.state.clone();
    let own = without.active.remove(index);
    let rank = |name: &str| all.iter().position(|c| c.effect.name() == name).unwrap_or(usize::MAX);
    let design = Design::new(problem, &without, all, thresholds);
    let trials = design.trials(thresholds);
    let gain_of_own = trials
        .iter()
        .filter(|t| design.candidates[t.candidate].effect.name() == own.effect.name())
        .map(|t| t.gain)
        .fold(0.0, f64::max);
    // Laws that leave much above the noise are not exact enough to decide by little.
    let (square, n) = best.design.linear.equations.plain();
    let open = thresholds.undecided * (square - n).max(0.0) / best.design.variance;
    let far = raw(best) > thresholds.far_left && problem.link() == Link::Drive;
    let tie = thresholds.tie(gain_of_own).max(if far { open } else { 0.0 });
    // What is switched on gains as a whole, and others by a straight line, which promises less of a law that bends: a
    // motor of 130 % more resistance was a current limit.
    let whole = own.switched() && problem.link() == Link::Drive;
    let most = if far || whole || problem.is_along_ways() { 8 } else { 3 };
    let mut tried: Vec<&str> = vec![own.effect.name()];
    for t in &trials {
        let candidate = &design.candidates[t.candidate];
        let name = candidate.effect.name();
        let near = whole && t.gain > 0.0 || t.gain >= thresholds.near(gain_of_own).min(gain_of_own - tie);
        if !near || tried.len() > most {
            break;
        }
        let [own_free, free] = [&own, candidate].map(|a| a.form.free.len());
        let simpler =
            rank(name) < rank(own.effect.name()) && free <= own_free || problem.is_along_ways() && free < own_free;
        if simpler_alone && !simpler
            || tried.contains(&name)
            || !t.material
            || best.state.active.iter().any(|a| a.effect.name() == name)
        {
            continue;
        }
        tried.push(name);
        let mut state = without.clone();
        state.active.insert(index, placed(candidate, &t.values));
        let settled = settle(problem, &mut state, all, thresholds);
        let alternative = finish(state, settled, from, thresholds);
        // What fits best at a bound has no name, and is no reason to take one away.
        if stopped(&alternative.state.active[index]) && !stopped(&own) {
            continue;
        }
        // What leaves far more than another law of no more parameters is not chosen, however it looks with
        // everything else adjusted.
        let [fewer, more] = [own.form.free.len(), candidate.form.free.len()];
        if fewer <= more && leaves_far_more(problem, &alternative, best, thresholds) {
            continue;
        }
        let clear = more <= fewer && leaves_far_more(problem, best, &alternative, thresholds);
        // Ways tell small things apart, and of several parameters some always answer a little of what nothing explains.
        let as_good = if problem.is_along_ways() && free < own_free { thresholds.near[1] * gain_of_own } else { tie };
        let needed = if simpler || clear { tie.max(as_good) } else { -tie };
        let even = || simpler && leaves_as_little(problem, &alternative, best, thresholds);
        if (alternative.against(best) < needed || even())
            && !problem.runs_away(&alternative.state, &without, thresholds)
        {
            return Some(alternative);
        }
    }
    None
}

/// The best pair or triple by the linear objective.
fn short_subset(design: &Design, thresholds: &Thresholds) -> Option<Vec<usize>> {
    let trials = design.trials(thresholds);
    let mut list: Vec<usize> = Vec::new();
    for t in trials.iter().filter(|t| t.gain > 0.0) {
        let name = design.candidates[t.candidate].effect.name();
        if list.iter().filter(|c| design.candidates[**c].effect.name() == name).count() < 2 {
            list.push(t.candidate);
        }
        if list.len() == SHORT_LIST {
            break;
        }
    }
    let mut subsets: Vec<Vec<usize>> = Vec::new();
    for (i, a) in list.iter().enumerate() {
        for (j, b) in list.iter().enumerate().skip(i + 1) {
            subsets.push(vec![*a, *b]);
            for c in list.iter().skip(j + 1) {
                subsets.push(vec![*a, *b, *c]);
            }
        }
    }
    let distinct = |s: &Vec<usize>| {
        s.iter().enumerate().all(|(i, a)| {
            s.iter().skip(i + 1).all(|b| {
                let [a, b] = [a, b].map(|c| &design.candidates[*c]);
                a.effect.name() != b.effect.name() && !does_all(a, b) && !does_all(b, a)
            })
        })
    };
    subsets.retain(distinct);
    let rated = each(&subsets, &|s| {
        let fit = design.fit(s);
        let sound = s.iter().all(|c| {
            let v = design.values(&fit, *c);
            design.within_bounds(*c, &v, &fit) && design.material(*c, &v)
        });
        sound.then(|| (design.objective(&fit, s, thresholds), s.clone()))
    });
    rated.into_iter().flatten().min_by(|a, b| a.0.total_cmp(&b.0)).map(|r| r.1)
}

/// Adds effects one after the other to those of a design, those before `from` not its own.
fn forward(problem: &Problem, mut design: Design, from: usize, all: &[Active], thresholds: &Thresholds) -> Selection {
    let mut state = design.state.clone();
    let mut refused: Vec<usize> = Vec::new();
    let mut beyond: Vec<usize> = Vec::new();
    loop {
        while state.active.len() - from < MOST {
            let Some(next) = next(problem.link(), &design, thresholds, &refused) else { break };
            let mut active = placed(&design.candidates[next.candidate], &next.values);
            active.immaterial = !next.material;
            let mut larger = state.clone();
            replace(&mut larger, active);
            let settled = settle(problem, &mut larger, all, thresholds);
            let gained = improvement(&settled, &design, from, thresholds);
            // A rough guess that the fit confirms, within its bounds, where nothing has a name yet.
            let confirmed = state.active.len() == from
                && gained > thresholds.led_out * thresholds.strong
                && !larger.active.last().is_some_and(stopped);
            let improves = gained > 0.0 && (confirmed || is_sure(&next, thresholds));
            if !improves || problem.runs_away(&larger, &state, thresholds) {
                refused.push(next.candidate);
                continue;
            }
            (state, design) = (larger, settled);
            if next.beyond {
                beyond.push(next.candidate);
            }
        }
        // What the others do not bring back from its bound explains nothing.
        let led = |a: &Active| beyond.iter().position(|c| all[*c].effect.name() == a.effect.name());
        let Some(index) =
            (from..state.active.len()).find(|i| led(&state.active[*i]).is_some() && stopped(&state.active[*i]))
        else {
            break;
        };
        if let Some(known) = led(&state.active.remove(index)) {
            refused.push(beyond.swap_remove(known));
        }
        design = settle(problem, &mut state, all, thresholds);
    }
    finish(state, design, from, thresholds)
}

/// Whether an effect rests at a bound that is not its absence: what only helps beyond it explains nothing.
pub(crate) fn stopped(active: &Active) -> bool {
    active.form.free.iter().any(|p| {
        let v = active.values.get(&p.name);
        v != 0.0 && p.bounds.iter().any(|b| (v - b).abs() < 0.02 * p.scale)
    })
}

/// By how much a fit lowers the objective.
fn improvement(larger: &Design, smaller: &Design, from: usize, thresholds: &Thresholds) -> f64 {
    let variance = larger.variance.min(smaller.variance);
    let objective = |design: &Design| {
        let fit = design.standing();
        design.linear.equations.loss_after(&fit.step) / variance + fit.penalty + cost(&design.state, from, thresholds)
    };
    objective(smaller) - objective(larger)
}

/// Cost of the effects of a state from `from` on.
fn cost(state: &State, from: usize, thresholds: &Thresholds) -> f64 {
    state.active[from..].iter().filter(|a| !a.given).map(|a| thresholds.cost(a.form.free.len())).sum()
}

fn finish(state: State, design: Design, from: usize, thresholds: &Thresholds) -> Selection {
    let fit = design.near();
    let costs = cost(&state, from, thresholds);
    Selection {
        loss: design.linear.equations.loss_after(&fit.step),
        costs: fit.penalty + costs,
        state,
        design,
        bare: false,
        taken_back: Vec::new(),
        alone: OnceLock::new(),
    }
}

/// A selection in which nothing is adjusted beside what is named.
fn finish_bare(problem: &Problem, state: State, from: usize, all: &[Active], thresholds: &Thresholds) -> Selection {
    let design = Design::new(problem, &state, all, thresholds);
    Selection { bare: true, ..finish(state, design, from, thresholds) }
}

/// The same clusters with parts of the runs as folds.
fn in_parts(equations: &NormalEquations, parts: usize) -> NormalEquations {
    equations.with_folds(|i| i % parts)
}

/// A selection with some of its own effects taken out, the others fitted anew.
pub(crate) fn without(
    problem: &Problem,
    found: &Selection,
    from: usize,
    keep: impl Fn(&Active) -> bool,
    all: &[Active],
    thresholds: &Thresholds,
) -> Selection {
    let mut state = found.state.clone();
    let mut index = 0;
    state.active.retain(|a| {
        index += 1;
        index <= from || keep(a)
    });
    if found.bare {
        problem.fit(&mut state);
        return finish_bare(problem, state, from, all, thresholds);
    }
    let design = settle(problem, &mut state, all, thresholds);
    finish(state, design, from, thresholds)
}

/// Adds an effect, which takes the place of another form of itself and of what it does as well.
fn replace(state: &mut State, active: Active) {
    state.active.retain(|a| a.given || a.effect.name() != active.effect.name() && !does_all(&active, a));
    state.active.push(active);
}

fn placed(candidate: &Active, values: &[f64]) -> Active {
    let mut active = candidate.clone();
    for (p, v) in candidate.form.free.iter().zip(values) {
        active.values.set(&p.name, v.clamp(p.bounds[0], p.bounds[1]));
    }
    active
}

/// Refits the active effects together with everything held near zero.
fn settle(problem: &Problem, state: &mut State, all: &[Active], thresholds: &Thresholds) -> Design {
    problem.fit(state);
    let mut design = Design::new(problem, state, all, thresholds);
    for _ in 1..ROUNDS {
        let fit = design.base();
        let Some(next) = stepped(problem, &design, &fit, all, thresholds) else { break };
        *state = next.state.clone();
        design = next;
    }
    design
}

/// Decrease of the objective that is worth another linearisation. Explanations that differ by four are a tie, and what a
/// straight line promises of the last step is in the estimates anyway.
const WORTH_A_LOOK: f64 = 0.5;

/// The design after a step of the named effects, if that does better; `None` if not, or if it is too small to matter.
/// Parts of a step that does worse are not tried: margins move with the named effects, and of 50 such parts on a
/// recording far from its noise (a robot's duties and counts over a radio) 45 did worse, too.
fn stepped(
    problem: &Problem,
    design: &Design,
    step: &PenalisedFit,
    all: &[Active],
    thresholds: &Thresholds,
) -> Option<Design> {
    let standing = design.standing();
    if standing.loss + standing.penalty - step.loss - step.penalty < WORTH_A_LOOK {
        return None;
    }
    let mut largest = 0.0_f64;
    let mut trial = design.state.clone();
    for (j, owner) in design.linear.owners.iter().enumerate() {
        let Owner::Active(index, parameter) = owner else { continue };
        let p = &design.state.active[*index].form.free[*parameter];
        let now = design.state.active[*index].values.get(&p.name);
        let next = (now + step.step[j]).clamp(p.bounds[0], p.bounds[1]);
        largest = largest.max((next - now).abs() / p.scale);
        trial.active[*index].values.set(&p.name, next);
    }
    if largest < 0.02 {
        return None;
    }
    let next = Design::new(problem, &trial, all, thresholds);
    let variance = design.variance.min(next.variance);
    let objective = |b: &Design, fit: &PenalisedFit| b.linear.equations.loss_after(&fit.step) / variance + fit.penalty;
    (objective(&next, &next.standing()) < objective(design, &standing)).then_some(next)
}

/// The next effect to add, if any passes the gates.
fn next(link: Link, design: &Design, thresholds: &Thresholds, refused: &[usize]) -> Option<Trial> {
    let gates = Gates::new(link, design, thresholds);
    // What is too small to be named brings no parameter along that nothing holds.
    let loose = |t: &Trial| {
        let free = &design.candidates[t.candidate].form.free;
        !t.material && free.iter().any(|p| p.material.is_infinite())
    };
    let tried = design.trials(thresholds).into_iter().filter(|t| !refused.contains(&t.candidate)).take(8);
    tried.take_while(|t| t.gain >= thresholds.gain).find(|t| !loose(t) && gates.pass(t))
}

/// Whether the gain that a straight line promises needs no fit to be believed.
fn is_sure(trial: &Trial, thresholds: &Thresholds) -> bool {
    !trial.beyond || trial.gain > thresholds.led_out * thresholds.strong
}

/// Drops effects whose removal costs little, and replaces forms by simpler ones.
fn backward(problem: &Problem, mut best: Selection, from: usize, all: &[Active], thresholds: &Thresholds) -> Selection {
    loop {
        let mut improved = false;
        for index in (from..best.state.active.len()).rev() {
            let mut smaller = best.state.clone();
            let removed = smaller.active.remove(index);
            let mut alternatives: Vec<State> = Vec::new();
            // Far from worthwhile in the linear approximation is not worth a refit.
            if best.design.loss_without(index, &[], thresholds) < FAR {
                alternatives.push(smaller.clone());
            }
            // Simpler forms of the same effect, from the same values.
            for c in all.iter().filter(|c| c.effect.name() == removed.effect.name()) {
                if c.form.free.len() < removed.form.free.len()
                    && c.form.free.iter().all(|p| removed.values.find(&p.name).is_some())
                {
                    let values: Vec<f64> = c.form.free.iter().map(|p| removed.values.get(&p.name)).collect();
                    let keep: Vec<String> = c.form.free.iter().map(|p| p.name.clone()).collect();
                    if is_material(c, &values) && best.design.loss_without(index, &keep, thresholds) < FAR {
                        let mut s = smaller.clone();
                        s.active.push(placed(c, &values));
                        alternatives.push(s);
                    }
                }
            }
            for mut alternative in alternatives {
                let design = settle(problem, &mut alternative, all, thresholds);
                let alternative = finish(alternative, design, from, thresholds);
                if alternative.against(&best) < 0.0 {
                    best = alternative;
                    improved = true;
                    break;
                }
            }
            if improved {
                break;
            }
        }
        if !improved {
            return best;
        }
    }
}
