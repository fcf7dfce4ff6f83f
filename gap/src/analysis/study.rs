//! One link: what is selected, what of it may be named, and how well it is known.

use std::sync::Arc;

use runs::robot::Support;

use super::found::Named;
use crate::evidence::{Evidence, Interval};
use crate::intervals::Intervals;
use crate::limits::Limit;
use crate::problem::{Owner, Problem};
use crate::select::{self, Design, Late, Selection};
use crate::state::{Active, State};
use crate::thresholds::Thresholds;
use links::effect::{Effect, Link, Parameter};
use links::thresholds::{self, Refusal};

/// A link's selection with everything that is said about it.
pub(super) struct Outcome {
    pub(super) selection: Selection,
    /// What it starts from and what is named, with the estimates that are reported.
    pub(super) written: State,
    pub(super) named: Vec<Named>,
    pub(super) sets: Vec<Vec<String>>,
    pub(super) ambiguous: bool,
    pub(super) limits: Vec<Limit>,
    pub(super) leftovers: Vec<String>,
    /// Held-out RMS of what is named, fitted without the run that is predicted, in floors.
    pub(super) held_out: f64,
    /// What was fitted and is not named, and why.
    pub(super) refused: Vec<Refused>,
}

/// What was fitted and is not named.
#[derive(Clone)]
pub(super) struct Refused {
    pub(super) name: String,
    pub(super) why: String,
    /// Whether no chance gives as much, but its size is not known.
    pub(super) of_no_size: bool,
    /// Whether it fits best at the bound of what is physical.
    pub(super) at_bound: bool,
}

impl Outcome {
    /// Takes back every name; `start` is where the study started.
    pub(super) fn forget(&mut self, start: &State) {
        self.written = start.clone();
        self.ambiguous = false;
        self.named.clear();
        self.sets.clear();
    }
}

/// Selects on one link, beginning with effects `known` from an earlier look; a gap of more than `matters` noise floors
/// is not left to adjustments.
pub(super) fn chosen(
    problem: &Problem,
    start: &State,
    known: &[Active],
    catalogue: &[Arc<dyn Effect>],
    thresholds: &Thresholds,
    matters: f64,
) -> Selection {
    let selection = select::select(problem, start, known, catalogue, thresholds);
    let from = start.active.len();
    let open = rms(problem, start);
    let adjusted = select::figures(&selection.design).1;
    let worth = selection.state.active[from..].iter().any(Active::worth);
    let selection = if worth || open <= matters || adjusted >= thresholds.adjusted * open {
        selection
    } else {
        select::single(problem, start, catalogue, thresholds).unwrap_or(selection)
    };
    // With everything adjusted and named, the prediction is still far from the noise: noise does not decide then.
    if select::figures(&selection.design).1 <= thresholds.open && !problem.is_along_ways() {
        return selection;
    }
    let all = problem.candidates(start, catalogue);
    let Some(plain) = select::plain(problem, start, &[], &all, thresholds, false) else { return selection };
    let needed = [&selection, &plain].map(|s| needed(problem, start, s));
    if is_better(needed[1], needed[0], thresholds) { plain } else { selection }
}

/// What a selection needs: the held-out sum of squares that its names alone leave, and their parameters.
pub(super) fn needed(problem: &Problem, start: &State, selection: &Selection) -> (f64, usize) {
    let from = start.active.len();
    let mut state = start.clone();
    state.active.extend(selection.state.active[from..].iter().filter(|a| a.is_named()).cloned());
    let parameters = state.active[from..].iter().map(|a| a.form.free.len()).sum();
    problem.fit(&mut state);
    (select::held_out(problem, &state).0, parameters)
}

/// Whether the first of two selections is better: with fewer parameters as good as the other, else better than it.
pub(super) fn is_better(
    (loss, parameters): (f64, usize),
    (other, others): (f64, usize),
    thresholds: &Thresholds,
) -> bool {
    loss < other * if parameters < others { 1.0 + thresholds.better } else { 1.0 - thresholds.better }
}

/// Root mean square of the residuals of a state in floors.
pub(super) fn rms(problem: &Problem, state: &State) -> f64 {
    let (square, n) = problem.linearise_nothing(state).plain();
    (square / n.max(1.0)).sqrt()
}

/// Judges what was selected on one link from where the study starts; from `far` noise floors on it does not agree. What
/// was selected on a sample is estimated on the `whole`.
pub(super) fn study<'a>(
    problem: &Problem,
    whole: &dyn Fn() -> Option<Problem<'a>>,
    start: &State,
    selection: Selection,
    catalogue: &[Arc<dyn Effect>],
    thresholds: &Thresholds,
    far: f64,
) -> Outcome {
    let all = problem.candidates(start, catalogue);
    let from = start.active.len();
    let is_probe = |name: &str| all.iter().any(|c| c.effect.name() == name && c.effect.probe());
    let taken_back = selection.taken_back.iter().filter(|(name, _)| !is_probe(name));
    let taken_back: Vec<Refused> =
        taken_back.map(|(name, why)| not_named(problem, name, &(*why, why.reason().to_owned()))).collect();
    let selection = above_errors(problem, selection, from, &all, thresholds);
    let (mut judged, mut refused) = sound(problem, selection, start, &all, thresholds);
    // Where laws that bend speeds stood for a load that the file lacks, each of them is taken back, and nothing is left.
    // Of a robot on the floor a rotor is a small part of what its motors move.
    if problem.link() == Link::Drive
        && start.robot.support == Support::Blocks
        && judged.rms >= thresholds.far_left
        && let Some(heavier) = select::heavier(problem, start, catalogue, thresholds)
    {
        let (again, more) = sound(problem, heavier, start, &all, thresholds);
        let named = &again.written.active[from..];
        let closes = again.rms.powi(2) < (1.0 - thresholds.explained) * judged.rms.powi(2);
        if closes && select::is_heavier(problem, start, named, thresholds) {
            // What is heavy enough hardly moves, whatever drives it: in the torque of its own inertia it must leave no more than
            // loads of the file's inertia do together.
            let loads: Vec<Active> = all.iter().filter(|c| c.effect.is_load()).cloned().collect();
            let light = several(problem, start, &judged, &loads, thresholds);
            match light.filter(|light| problem.runs_away(&again.written, &light.state, thresholds)) {
                Some(light) => {
                    let (light, more) = sound(problem, light, start, &all, thresholds);
                    if light.rms < judged.rms {
                        judged = light;
                        refused.extend(more);
                    }
                }
                None => (judged, refused) = (again, more),
            }
        }
    }
    // What laws of what is named may leave is nothing to explain by small effects.
    let design = &judged.selection.design;
    let laws = design.left_by_laws() / design.linear.equations.plain().1.max(1.0);
    if judged.rms > far
        && judged.rms.powi(2) - 1.0 > laws
        && let Some(beside) = one_beside(problem, start, &judged, &all, far / thresholds.far, thresholds)
            .or_else(|| several(problem, start, &judged, &all, thresholds))
    {
        let (again, more) = sound(problem, beside, start, &all, thresholds);
        if again.rms < judged.rms {
            judged = again;
            refused.extend(more);
        }
    }
    let Judged { selection, mut written, mut estimates, .. } = judged;
    if !estimates.is_empty()
        && let Some(whole) = whole()
    {
        let more;
        (written, estimates, more) = on_whole(&whole, start, &selection, &all, thresholds);
        refused.extend(more);
    }
    let (mut named, mut sets, mut leftovers, mut ambiguous) = (Vec::new(), Vec::new(), Vec::new(), false);
    for (index, active) in selection.state.active.iter().enumerate().skip(from) {
        if active.effect.probe() {
            if active.worth() {
                leftovers.push(active.effect.describe(&active.values));
            }
            continue;
        }
        let Some(estimate) = estimates.iter().find(|e| e.index == index) else { continue };
        let alternatives = select::alternatives(problem, &selection, index, &all, thresholds);
        let own: Vec<Vec<String>> =
            alternatives.sets.into_iter().filter(|s| !s.iter().any(|n| n.starts_with("probe"))).collect();
        ambiguous |= alternatives.ambiguous && !own.is_empty();
        sets.extend(own);
        let at = written.active.iter().position(|a| a.effect.name() == active.effect.name());
        // With nothing adjusted no margin of another law says what else would do; nor where what was fitted beside it may
        // not be named, and it does now alone what both did.
        let bare = selection.bare || !refused.is_empty();
        let open = if bare { thresholds.from_noise } else { thresholds.far_left };
        for other in at.map_or_else(Vec::new, |at| select::undecided(problem, &written, at, &all, thresholds, open)) {
            let name = at.map_or("", |at| other.active[at].effect.name());
            let pair = vec![active.effect.name().to_owned(), name.to_owned()];
            if !sets.contains(&pair) {
                sets.push(pair);
            }
            ambiguous = true;
        }
        let late = at.map_or(Late::Less, |at| select::late_in_place(problem, &written, at, &all, thresholds));
        let pair = vec![active.effect.name().to_owned(), select::LATENCY.to_owned()];
        if !matches!(late, Late::Less) && !sets.contains(&pair) {
            sets.push(pair);
            ambiguous |= matches!(late, Late::Even);
        }
        let fixed = active.form.fixed.iter().map(|(n, v)| (n.clone(), *v, Interval::Exact));
        named.push(Named {
            name: active.effect.name().to_owned(),
            equation: active.effect.equation().to_owned(),
            link: shown_on(active, problem),
            wheels: material_wheels(active),
            parameters: active.form.free.iter().zip(&estimate.parameters).map(told).chain(fixed).collect(),
            // Known when the file is written and read again.
            gain: 0.0,
            evidence: Evidence::Test { method: "signs of whole clusters flipped", p: estimate.p },
            conditional_on: alternatives.shared,
        });
    }
    refused.extend(taken_back);
    let (square, n) = select::held_out(problem, &written_to_fit(&written, from));
    still_refused(&mut refused, &named);
    Outcome {
        held_out: (square / n.max(1.0)).sqrt(),
        limits: crate::limits::limits(problem, &selection.design, from, thresholds),
        selection,
        written,
        named,
        sets,
        ambiguous,
        leftovers,
        refused,
    }
}

/// A selection without structure that moves frames by less than their poses err for seconds: what lasts as long is no more
/// the robot's for showing in many of them.
fn above_errors(
    problem: &Problem,
    selection: Selection,
    from: usize,
    all: &[Active],
    thresholds: &Thresholds,
) -> Selection {
    let Problem::Motion(link) = problem else { return selection };
    let is_told = |a: &Active| {
        let mut absent = selection.state.clone();
        absent.active.retain(|b| b.effect.name() != a.effect.name());
        !a.effect.probe() || link.apart([&selection.state.motion(None), &absent.motion(None)]) >= 1.0
    };
    if !link.errs_for_seconds || selection.state.active[from..].iter().all(is_told) {
        return selection;
    }
    select::without(problem, &selection, from, is_told, all, thresholds)
}

/// A parameter as it is told: no interval of a share reaches beyond nothing and all, and none of a factor, or of what is never
/// negative, below nothing.
fn told((p, (name, value, interval)): (&Parameter, &(String, f64, Interval))) -> (String, f64, Interval) {
    let may_be = if p.name.starts_with("share") || p.bounds == [0.0, 1.0] {
        [0.0, 1.0]
    } else if p.name.starts_with("scale") {
        [-1.0, f64::INFINITY] // of 1 + scale
    } else if p.bounds[0] >= 0.0 {
        [0.0, f64::INFINITY]
    } else {
        [f64::NEG_INFINITY, f64::INFINITY]
    };
    let within = match interval {
        // An estimate scatters about its end.
        Interval::Ci95(ends) => Interval::Ci95(ends.map(|end| end.clamp(may_be[0].min(*value), may_be[1].max(*value)))),
        other => *other,
    };
    (name.clone(), *value, within)
}

/// The link that an effect shows on.
fn shown_on(active: &Active, problem: &Problem) -> Link {
    let on_place = active.form.free.iter().all(|p| p.name.ends_with("_m") || p.name == "z_rad");
    match active.effect.link() {
        // Place and heading of a sensor are the accelerometer's to tell.
        Link::Gyroscope if on_place && active.effect.also() == Some(Link::Accelerometer) => Link::Accelerometer,
        link if link.is_inertial() => link,
        // What wheels and camera do not show, but a sensor beside them.
        Link::Drive if problem.link() == Link::Motion => {
            active.effect.also().filter(|also| also.is_inertial()).unwrap_or(Link::Motion)
        }
        _ => problem.link(),
    }
}

/// The same state, to be fitted again where it was fitted.
pub(super) fn written_to_fit(written: &State, from: usize) -> State {
    let mut state = written.clone();
    state.active[..from].iter_mut().for_each(|a| a.given = true);
    state
}

/// One more effect of the drive that matters and takes it to its floor: the search took it for a little of many others, none of
/// which matters.
fn one_beside(
    problem: &Problem,
    start: &State,
    judged: &Judged,
    all: &[Active],
    floor: f64,
    thresholds: &Thresholds,
) -> Option<Selection> {
    let from = start.active.len();
    let named: Vec<Active> = judged.written.active[from..].iter().filter(|a| a.is_named()).cloned().collect();
    let drive = problem.link() == Link::Drive && !named.is_empty();
    drive.then(|| select::one_beside(problem, start, &named, all, floor, thresholds)).flatten()
}

/// Effects each too small to matter, where together they close what matters.
fn several(
    problem: &Problem,
    start: &State,
    judged: &Judged,
    all: &[Active],
    thresholds: &Thresholds,
) -> Option<Selection> {
    let from = start.active.len();
    let mut begun = start.clone();
    begun.active.extend(judged.written.active[from..].iter().map(|a| Active { given: true, ..a.clone() }));
    let left: Vec<Active> =
        all.iter().filter(|c| !begun.active.iter().any(|a| a.effect.name() == c.effect.name())).cloned().collect();
    let mut found = select::plain(problem, &begun, &[], &left, thresholds, true)?;
    for (index, a) in found.state.active.iter_mut().enumerate().skip(from) {
        a.given = false;
        // Named for what they do together.
        a.together = index >= begun.active.len();
    }
    problem.fit(&mut found.state);
    let loss = |state: &State| select::held_out(problem, state).0;
    let (_, noise) = select::held_out(problem, &found.state);
    let mut kept = (loss(&found.state), found.state.clone());
    loop {
        let (now, state) = &kept;
        let least = (from..state.active.len()).filter(|index| state.active[*index].together).map(|index| {
            let mut without = state.clone();
            without.active.remove(index);
            problem.fit(&mut without);
            (loss(&without), without)
        });
        match least.min_by(|a, b| a.0.total_cmp(&b.0)) {
            None => return None,
            Some(without) if without.0 - now < thresholds.least_together * (without.0 - noise) => kept = without,
            Some(_) => break,
        }
    }
    let keep = |a: &Active| kept.1.active.iter().any(|k| k.effect.name() == a.effect.name());
    Some(select::without(problem, &found, from, keep, all, thresholds))
}

/// One named effect's estimates.
struct Estimate {
    index: usize,
    parameters: Vec<(String, f64, Interval)>,
    p: f64,
}

/// A selection with the estimates of what may be named.
struct Judged {
    selection: Selection,
    written: State,
    estimates: Vec<Estimate>,
    rms: f64,
}

/// A selection judged, without what may not be named by the estimates that are reported, and why not.
fn sound(
    problem: &Problem,
    selection: Selection,
    start: &State,
    all: &[Active],
    thresholds: &Thresholds,
) -> (Judged, Vec<Refused>) {
    let (mut selection, mut refused) = admitted(problem, selection, start, all, thresholds);
    loop {
        let judged = judge(problem, start, selection, thresholds);
        let active = |e: &Estimate| &judged.selection.state.active[e.index];
        let faults = judged.estimates.iter().filter_map(|e| Some((e, fault(active(e), e)?)));
        let worst = faults.max_by(|a, b| a.0.p.total_cmp(&b.0.p).then(a.0.index.cmp(&b.0.index)));
        let Some((estimate, why)) = worst else { return (judged, refused) };
        let name = active(estimate).effect.name().to_owned();
        refused.push(not_named(problem, &name, &why));
        let fewer = select::without(
            problem,
            &judged.selection,
            start.active.len(),
            |a| a.effect.name() != name,
            all,
            thresholds,
        );
        let more;
        (selection, more) = admitted(problem, fewer, start, all, thresholds);
        refused.extend(more);
    }
}

/// What was selected on a sample, estimated on the whole; without what may not be named by these estimates, and why not.
fn on_whole(
    whole: &Problem,
    start: &State,
    selection: &Selection,
    all: &[Active],
    thresholds: &Thresholds,
) -> (State, Vec<Estimate>, Vec<Refused>) {
    let design = Design::new(whole, &selection.state, all, thresholds);
    let judged = judge(whole, start, selection.on(design), thresholds);
    let Judged { selection, mut written, estimates, .. } = judged;
    let mut refused = Vec::new();
    let kept = |e: &Estimate| {
        let active = &selection.state.active[e.index];
        let why = fault(active, e);
        refused.extend(why.iter().map(|why| not_named(whole, active.effect.name(), why)));
        if why.is_some() {
            written.active.retain(|a| a.given || a.effect.name() != active.effect.name());
        }
        why.is_none()
    };
    let estimates = estimates.into_iter().filter(kept).collect();
    (written, estimates, refused)
}

fn not_named(problem: &Problem, name: &str, (refusal, why): &Fault) -> Refused {
    Refused {
        name: name.to_owned(),
        why: format!("Fitted on the {} link, and not named: {name} ({why}).", problem.link().name()),
        of_no_size: *refusal == Refusal::HoldsZero,
        at_bound: *refusal == Refusal::AtBound,
    }
}

/// What was refused in one search and has its name by another, is named.
fn still_refused(refused: &mut Vec<Refused>, named: &[Named]) {
    refused.retain(|r| !named.iter().any(|n| n.name == r.name));
}

/// Takes out of a selection what may not be named, one effect after the other, and says why.
fn admitted(
    problem: &Problem,
    mut selection: Selection,
    start: &State,
    all: &[Active],
    thresholds: &Thresholds,
) -> (Selection, Vec<Refused>) {
    let from = start.active.len();
    let mut refused = Vec::new();
    loop {
        let estimates = estimates(problem, &selection, from, selection.bare);
        let cancelled = |e: &Estimate| problem.is_cancelled(&selection.state, e.index, start, thresholds);
        let why = |e: &Estimate| {
            fault(&selection.state.active[e.index], e)
                .or_else(|| cancelled(e).then(|| (Refusal::Cancelled, Refusal::Cancelled.reason().to_owned())))
        };
        let faults = estimates.iter().filter_map(|e| Some((e, why(e)?)));
        // Of two that undo each other the one later in the catalogue goes.
        let rank = |e: &Estimate| {
            let name = selection.state.active[e.index].effect.name();
            all.iter().position(|c| c.effect.name() == name)
        };
        let worst = faults.max_by(|a, b| a.0.p.total_cmp(&b.0.p).then(rank(a.0).cmp(&rank(b.0))));
        let worst = worst.map(|(e, why)| (e.index, why)).or_else(|| {
            let (index, share) = select::dwarfed(problem, &selection.state, start, thresholds)?;
            let why = format!("{}, {:.0} times as much", Refusal::Dwarfed.reason(), 1.0 / share.max(0.01));
            Some((index, (Refusal::Dwarfed, why)))
        });
        let Some((index, why)) = worst else { return (selection, refused) };
        if why.0 == Refusal::Cancelled
            && let Some(other) = select::not_undone(problem, &selection, index, start, all, thresholds)
        {
            selection = other;
            continue;
        }
        let name = selection.state.active[index].effect.name().to_owned();
        refused.push(not_named(problem, &name, &why));
        selection = select::without(problem, &selection, from, |a| a.effect.name() != name, all, thresholds);
    }
}

/// Why something may not be named, and in words.
type Fault = (Refusal, String);

/// What forbids to name an effect.
fn fault(active: &Active, estimate: &Estimate) -> Option<Fault> {
    let known = |(p, (name, value, interval)): (&Parameter, &(String, f64, Interval))| {
        let no_angle = active.effect.period(name).is_none();
        thresholds::Estimate {
            name: name.clone(),
            value: *value,
            interval: interval.ends().unwrap_or([f64::NEG_INFINITY, f64::INFINITY]),
            bounds: p.bounds,
            sized: p.material.is_finite() && no_angle,
            // What is switched on is not absent at 0, unless it may be 0 and was only begun elsewhere.
            absent_at_zero: p.below.is_none() && (p.start.is_none() || p.bounds[0] <= 0.0),
            blurred: p.blurred,
            closed: p.closed,
        }
    };
    let known: Vec<thresholds::Estimate> = active.form.free.iter().zip(&estimate.parameters).map(known).collect();
    let refusal = thresholds::gate(&known, Some(estimate.p)).err()?;
    Some((refusal, format!("{}; p = {}", refusal.reason(), crate::units::short(estimate.p))))
}

/// Estimates of all effects that are worth a name, with their intervals and p-values.
fn estimates(problem: &Problem, selection: &Selection, from: usize, bare: bool) -> Vec<Estimate> {
    let design = &selection.design;
    let roles = design.judged(&[], bare);
    let fit = design.fit_roles(&roles);
    // On the floor a little of everything is there, and what two of them do together is no size of a cause.
    let beside =
        if design.state.robot.support == Support::Blocks { design.without_twins() } else { design.estimating() };
    let beside = design.covariance(&beside, &design.fit_roles(&beside));
    let intervals = Intervals::new(problem, design, &roles, &beside);
    let mut out = Vec::new();
    for index in from..selection.state.active.len() {
        let active = &selection.state.active[index];
        if !active.is_named() {
            continue;
        }
        let parameters = active.form.free.iter().enumerate().map(|(j, p)| {
            let column = design.linear.owners.iter().position(|o| *o == Owner::Active(index, j));
            let v = active.values.get(&p.name) + column.map_or(0.0, |c| fit.step[c]).clamp(-p.scale, p.scale);
            let v =
                active.effect.period(&p.name).map_or(v.clamp(p.bounds[0], p.bounds[1]), |period| v.rem_euclid(period));
            let half = column.map_or(0.0, |c| intervals.half(c, active, p));
            // The effect's own law is not known to better than that.
            let half = half.hypot(2.0 * active.effect.law_uncertainty() * v);
            (p.name.clone(), v, Interval::Ci95([v - half, v + half]))
        });
        out.push(Estimate { index, parameters: parameters.collect(), p: p_value(problem, &selection.state, index) });
    }
    out
}

/// Two-sided p-value of one effect of a state, by flipping the signs of clusters without it.
fn p_value(problem: &Problem, state: &State, index: usize) -> f64 {
    let mut without = state.clone();
    let own = without.active.remove(index);
    let mut absent = own.clone();
    for p in &own.form.free {
        if p.start.is_none() {
            absent.values.set(&p.name, 0.0);
        }
    }
    select::sign_flip(&problem.linearise(&without, &[absent]), 0)
}

/// The written state of a selection, by whichever estimates leave less where they differ much.
fn judge(problem: &Problem, start: &State, selection: Selection, thresholds: &Thresholds) -> Judged {
    let from = start.active.len();
    let written = |estimates: &[Estimate]| {
        let mut state = start.clone();
        for e in estimates {
            let mut active = selection.state.active[e.index].clone();
            e.parameters.iter().for_each(|(n, v, _)| active.values.set(n, *v));
            state.active.push(active);
        }
        state
    };
    let careful = estimates(problem, &selection, from, selection.bare);
    let state = written(&careful);
    let now = rms(problem, &state);
    if selection.bare || careful.is_empty() {
        return Judged { rms: now, written: state, estimates: careful, selection };
    }
    // Adjustments that were stretched beyond their margins are no nuisance: what is named does without them.
    let mut bare_state = state.clone();
    problem.fit(&mut bare_state);
    let bare = rms(problem, &bare_state);
    let excess = |r: f64| (r * r - 1.0).max(0.0);
    if excess(bare) < (1.0 - thresholds.worse) * excess(now) && now > thresholds.open {
        let mut fitted = selection.stripped();
        for (k, e) in careful.iter().enumerate() {
            fitted.state.active[e.index].values = bare_state.active[from + k].values.clone();
        }
        let mut estimates = estimates(problem, &fitted, from, true);
        for e in &mut estimates {
            // The design stands at the careful estimates; the fit has gone on from there.
            let active = &fitted.state.active[e.index];
            for (name, v, interval) in &mut e.parameters {
                let new = active.values.get(name);
                if let Interval::Ci95([low, high]) = interval {
                    let half = 0.5 * (*high - *low);
                    *interval = Interval::Ci95([new - half, new + half]);
                }
                *v = new;
            }
        }
        return Judged { rms: bare, written: bare_state, estimates, selection: fitted };
    }
    Judged { rms: now, written: state, estimates: careful, selection }
}

pub(super) fn material_wheels(active: &Active) -> Vec<usize> {
    let per_wheel = active.form.wheels.len() > 1 && active.form.free.len() >= active.form.wheels.len();
    if !per_wheel {
        return active.form.wheels.iter().map(|w| w + 1).collect();
    }
    let each = active.form.free.len() / active.form.wheels.len();
    active
        .form
        .wheels
        .iter()
        .enumerate()
        .filter(|(k, _)| {
            (k * each..(k + 1) * each)
                .any(|j| active.form.free[j].is_material(active.values.get(&active.form.free[j].name)))
        })
        .map(|(_, w)| w + 1)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_has_a_name_in_the_end_is_not_said_to_have_none() {
        let refused =
            |name: &str| Refused { name: name.to_owned(), why: String::new(), of_no_size: true, at_bound: false };
        let mut all = vec![refused("camera-latency"), refused("wheel-radius")];
        still_refused(&mut all, &[Named::bare("camera-latency", Link::Motion, &[])]);
        assert_eq!(all.iter().map(|r| r.name.as_str()).collect::<Vec<_>>(), ["wheel-radius"]);
    }

    #[test]
    fn a_share_is_told_between_nothing_and_all() {
        let share = Parameter::new("share", 0.02, [0.0, 1.0], 0.12);
        let known = ("share".to_owned(), 0.96, Interval::Ci95([0.9, 1.02]));
        assert_eq!(told((&share, &known)).2, Interval::Ci95([0.9, 1.0]));
        // The bounds of a search are none of what may be.
        let scale = Parameter::new("scale", 0.01, [-0.6, 0.6], 0.004);
        let known = ("scale".to_owned(), 0.55, Interval::Ci95([0.45, 0.65]));
        assert_eq!(told((&scale, &known)).2, known.2);
        // A motor with less than no torque constant is none.
        let known = ("scale".to_owned(), -0.58, Interval::Ci95([-1.09, -0.07]));
        assert_eq!(told((&scale, &known)).2, Interval::Ci95([-1.0, -0.07]));
        // Nor does a current have less than no limit.
        let limit = Parameter::new("limit_a", 0.1, [0.05, 20.0], 0.3);
        let known = ("limit_a".to_owned(), 0.19, Interval::Ci95([-0.11, 0.48]));
        assert_eq!(told((&limit, &known)).2, Interval::Ci95([0.0, 0.48]));
        let bridge = Parameter::new("share", 0.02, [0.0, 1.3], 0.12);
        let known = ("share".to_owned(), 1.01, Interval::Ci95([0.9, 1.1]));
        assert_eq!(told((&bridge, &known)).2, Interval::Ci95([0.9, 1.01]));
    }
}
