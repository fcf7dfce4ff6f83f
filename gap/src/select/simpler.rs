//! One law, or two of the drive, in place of what is named, where they fit better by themselves.
//!
//! Beside margins for everything that is not named a bridge that is not linear, with friction of Stribeck, passes for dry
//! and viscous friction. What tells them apart is what each leaves on runs that it was not fitted to, nothing adjusted.

use estimation::parallel::each;

use super::left::Left;
use super::{Selection, finish_bare, is_material, stopped};
use crate::problem::{Owner, Problem};
use crate::state::{Active, State};
use crate::thresholds::Thresholds;
use estimation::prior::{Penalised, Role};
use links::effect::Link;
use runs::robot::Support;

/// Pairs that are fitted, of those that promise most by a straight line.
const FITTED: usize = 16;

type ByItself = fn(&Problem, &State, &Selection, &[Active], &Thresholds) -> Option<State>;

/// What is named, or in its place two laws of the drive, or one of either link, that do better by themselves.
pub(super) fn simpler(
    problem: &Problem,
    start: &State,
    found: Selection,
    all: &[Active],
    in_place: &[Active],
    thresholds: &Thresholds,
) -> Selection {
    let mut found = found;
    let tried: &[ByItself] = if problem.link() == Link::Drive { &[of_two, of_one] } else { &[of_one] };
    for by_itself in tried {
        if let Some(state) = by_itself(problem, start, &found, all, thresholds) {
            found = finish_bare(problem, state, start.active.len(), all, thresholds);
        }
    }
    let from = start.active.len();
    if let Some(state) = for_several(problem, start, &found, in_place, thresholds) {
        found = finish_bare(problem, state, from, all, thresholds);
    }
    if is_a_trifle(problem, start, &found, all) {
        return finish_bare(problem, start.clone(), from, all, thresholds);
    }
    found
}

/// Whether one law of the drive, of a size too small to matter, leaves no more than all that is named. Effects that matter, of
/// which one takes back most of the other, are then a small one by other names: more resistance and less mass do what a
/// little more friction does.
fn is_a_trifle(problem: &Problem, start: &State, found: &Selection, all: &[Active]) -> bool {
    let named = named(start, found);
    if problem.link() != Link::Drive || named.len() < 2 {
        return false;
    }
    let now = Left::fitted(problem, &bare(problem, start, named.iter().copied()));
    let small = |law: &Active| {
        let state = bare(problem, start, [law]);
        let fitted = &state.active[start.active.len()];
        !is_material(fitted, &fitted.parameters())
            && !stopped(fitted)
            && Left::fitted(problem, &state).sum() <= now.sum()
    };
    each(&laws(problem, start, all, plain), &small).contains(&true)
}

/// A law in place of two or more of those named, where with the others it leaves as little as they, or of one where it leaves
/// noise and that far more; of as many that it stands for the one that leaves least. In place of three it may leave more than
/// they, next to noise: what one number makes of three sizes is no chance, and three fit a part of what no law is exact to.
/// And what a decoder makes of counts in place of one law or none far from the noise, where it leaves no more than its law may.
fn for_several(
    problem: &Problem,
    start: &State,
    found: &Selection,
    in_place: &[Active],
    thresholds: &Thresholds,
) -> Option<State> {
    let named = named(start, found);
    if in_place.is_empty() {
        return None;
    }
    let now = Left::fitted(problem, &bare(problem, start, named.iter().copied()));
    if named.is_empty() && !now.is_far(thresholds) {
        return None;
    }
    let subsets = |size: usize| (0..1_u32 << named.len()).filter(move |set| set.count_ones() as usize == size);
    // What is adjusted beside one law alone does not show among the names.
    let most = named.len().saturating_sub(2);
    let on_floor = start.robot.support == Support::Floor;
    let stands_for = |left: &Left, law: &Active, size: usize| {
        let decoded = is_decoded(law, thresholds);
        // Else all wheels of a robot on the floor as much faster are a heavier one with more friction by another name.
        if on_floor && law.form.wheels.is_empty() && !decoded {
            return false;
        }
        match named.len() - size {
            0 | 1 => {
                now.far_above(left, thresholds)
                    && (left.is_noise(thresholds)
                        || decoded && left.excess() <= may_leave(law, now.sum() - left.sum(), thresholds))
            }
            2 => left.is_as_little(&now, thresholds),
            _ => !left.is_far(thresholds),
        }
    };
    (0..=most).find_map(|size| {
        let tried: Vec<(&Active, u32)> =
            in_place.iter().flat_map(|law| subsets(size).map(move |set| (law, set))).collect();
        let fitted = each(&tried, &|(law, set)| {
            let kept = (0..named.len()).filter(|i| set >> i & 1 == 1).map(|i| named[i]);
            let mut state = bare(problem, start, std::iter::once(*law).chain(kept));
            // To four times the counts it takes more steps than one fit has.
            problem.fit(&mut state);
            let left = Left::fitted(problem, &state);
            let as_good = stands_for(&left, &state.active[start.active.len()], size)
                && is_sound(problem, start, &state, thresholds);
            as_good.then_some((left.sum(), state))
        });
        fitted.into_iter().flatten().min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, state)| state)
    })
}

/// What a law that explains so much leaves above the noise as it is not exact.
fn may_leave(law: &Active, explains: f64, thresholds: &Thresholds) -> f64 {
    (thresholds.law_sigmas * law.effect.law_uncertainty()).powi(2) * explains
}

/// Whether a law of one parameter makes counts what a decoder makes of them that takes other edges than the file says.
fn is_decoded(law: &Active, thresholds: &Thresholds) -> bool {
    let factor = 1.0 + law.parameters().first().copied().unwrap_or_default();
    model::setup::DECODED.into_iter().any(|of| (factor / of - 1.0).abs() < thresholds.decoded)
}

/// One law in place of named ones, where it leaves noise and they far more, each fitted with nothing adjusted beside it: one
/// of them, or one that comes earlier in the catalogue. And one of several where it leaves as little as they, or, far from the
/// noise, hardly more, and by no more than it may for its own law: a joint with three times its friction was a third of its
/// inertia behind motors of a third of their torque, which left 2.5 floors where the friction leaves 2.6. It may leave a small
/// part of what any of them adds to the others where it is a special case of them, to the last digit, so that how exact it is
/// decides what they leave: a supply that is 10 % higher is weaker motors of less resistance, and of an axis alone a lighter load
/// is motors of less resistance with more friction. In place of an axis's inertia any: a delay of some time constants is no
/// straight line, and an inertia three times the file's left less of it than what a delay promised.
///
/// Another may leave less by how exact the laws are: through an encoder of few counts a dead band leaves less than the dry
/// friction that is at work. Of laws between which the data do not decide that of fewest parameters, and of those the first
/// of the catalogue.
fn of_one(
    problem: &Problem,
    start: &State,
    found: &Selection,
    all: &[Active],
    thresholds: &Thresholds,
) -> Option<State> {
    let named = named(start, found);
    if named.is_empty() {
        return None;
    }
    let now = Left::fitted(problem, &bare(problem, start, named.iter().copied()));
    let parameters: usize = named.iter().map(|a| a.form.free.len()).sum();
    // Between wheels and camera a cause may have a size for each wheel.
    let sized = |a: &Active| match problem.link() {
        Link::Motion => a.form.free.len() < parameters && a.form.free.iter().all(|p| p.material.is_finite()),
        _ => a.form.free.iter().filter(|p| p.material.is_finite()).count() == 1,
    };
    let mut laws = laws(problem, start, all, sized);
    let rank = |a: &Active| all.iter().position(|c| c.effect.name() == a.effect.name());
    let one_of_them = |law: &Active| named.iter().any(|n| rank(n) == rank(law));
    let several = named.len() > 1;
    let axis = start.robot.support == Support::Blocks;
    let before = Left::fitted(problem, start);
    let adds = if several { least_added(problem, start, &named, &now) } else { 0.0 };
    let any = several || axis && named.iter().any(|n| problem.changes_inertia(start, n));
    laws.retain(|law| any || one_of_them(law) || named.iter().all(|n| rank(law) < rank(n)));
    if several && axis {
        laws.extend(others(start, all, sized).into_iter().filter(|law| problem.changes_inertia(start, law)));
        laws.sort_by_key(rank);
    }
    laws.sort_by_key(|law| law.form.free.len());
    let better = each(&laws, &|law| {
        let mut state = start.clone();
        state.active.push(law.clone());
        problem.fit(&mut state);
        let left = Left::fitted(problem, &state);
        let in_floor = || axis && now.far_above_in_floor(&left, thresholds);
        let far_better = || now.far_above(&left, thresholds) && left.is_noise(thresholds) || in_floor();
        // What a step by step search does not reach from another law: a low-pass of 50 ms looked like twice the inertia
        // and 20 ms.
        let more = left.sum() - now.sum();
        let for_its_law =
            problem.link() == Link::Drive && more <= may_leave(law, before.sum() - left.sum(), thresholds);
        let of_load = || axis && problem.changes_inertia(start, law);
        let nested = || more <= thresholds.does_both * adds && is_special(problem, start, &state, &named, thresholds);
        let for_several = || {
            left.is_as_little(&now, thresholds)
                || for_its_law && left.is_hardly_more(&now, thresholds)
                || (for_its_law || of_load()) && nested()
        };
        let better = several && for_several() || far_better();
        (better && is_sound(problem, start, &state, thresholds)).then_some((state, left))
    });
    first_of_least(better.into_iter().flatten().collect(), thresholds)
}

/// Two laws of a parameter each in place of named ones of no fewer parameters. Where those leave much above the noise:
/// fewer parameters that leave less, or as many that leave less over all clusters; elsewhere, what leaves noise where they
/// leave far more. Of pairs between which the data do not decide the first of the catalogue.
fn of_two(
    problem: &Problem,
    start: &State,
    found: &Selection,
    all: &[Active],
    thresholds: &Thresholds,
) -> Option<State> {
    let named = named(start, found);
    let parameters: usize = named.iter().map(|a| a.form.free.len()).sum();
    if parameters < 2 {
        return None;
    }
    let now = Left::of(problem, &bare(problem, start, named.iter().copied()));
    let is_far = now.is_far(thresholds);
    let laws = laws(problem, start, all, plain);
    let needed = if parameters > 2 { 0.0 } else { thresholds.held_out_t };
    let mut pairs = promising(problem, start, &laws);
    pairs.sort_unstable();
    let better = pairs
        .into_iter()
        .filter_map(|pair| {
            let mut state = start.clone();
            state.active.extend(pair.map(|i| laws[i].clone()));
            problem.fit(&mut state);
            let left = Left::of(problem, &state);
            let better = if is_far { now.above(&left) > needed } else { now.far_above(&left, thresholds) };
            (better && is_sound(problem, start, &state, thresholds)).then_some((state, left))
        })
        .collect();
    first_of_least(better, thresholds)
}

/// One law more, large enough to matter, beside what is named, that leaves no more than so many noises; of several between
/// which the data do not decide the first of the catalogue.
pub(crate) fn one_beside(
    problem: &Problem,
    start: &State,
    named: &[Active],
    all: &[Active],
    within: f64,
    thresholds: &Thresholds,
) -> Option<Selection> {
    let is_new = |a: &Active| !named.iter().any(|n| n.effect.name() == a.effect.name());
    let fitted = each(&laws(problem, start, all, |a| plain(a) && is_new(a)), &|law| {
        let state = bare(problem, start, named.iter().chain(std::iter::once(law)));
        let left = Left::of(problem, &state);
        (left.rms() <= within && is_sound(problem, start, &state, thresholds)).then_some((state, left))
    });
    let state = first_of_least(fitted.into_iter().flatten().collect(), thresholds)?;
    Some(finish_bare(problem, state, start.active.len(), all, thresholds))
}

/// What one of several laws adds to the others at least, each time fitted with nothing adjusted beside them.
fn least_added(problem: &Problem, start: &State, named: &[&Active], now: &Left) -> f64 {
    let without = |out: usize| {
        let others = named.iter().enumerate().filter(|(i, _)| *i != out).map(|(_, a)| *a);
        Left::fitted(problem, &bare(problem, start, others)).sum() - now.sum()
    };
    (0..named.len()).map(without).fold(f64::INFINITY, f64::min)
}

/// Whether several laws do together what one does, from where it was fitted on.
fn is_special(problem: &Problem, start: &State, one: &State, several: &[&Active], thresholds: &Thresholds) -> bool {
    let laws: Vec<Active> = several.iter().map(|a| (*a).clone()).collect();
    let linear = problem.linearise(one, &laws);
    let own = linear.of_active(start.active.len());
    let others: Vec<usize> = (0..laws.len()).flat_map(|c| linear.of_candidate(c)).collect();
    let jj = linear.equations.information();
    let a = jj.select_rows(&others).select_columns(&others);
    own.iter().all(|j| {
        let b = jj.column(*j).select_rows(&others);
        b.dot(&estimation::normal_equations::solve(&a, &b)) > (1.0 - thresholds.special) * jj[(*j, *j)]
    })
}

/// Whether a law has one parameter, grows from 0 and may matter.
fn plain(a: &Active) -> bool {
    a.form.free.len() == 1 && a.form.free[0].material.is_finite() && !a.switched()
}

fn named<'a>(start: &State, found: &'a Selection) -> Vec<&'a Active> {
    found.state.active[start.active.len()..].iter().filter(|a| a.is_named()).collect()
}

/// Named effects fitted with nothing adjusted beside them.
pub(super) fn bare<'a>(problem: &Problem, start: &State, named: impl IntoIterator<Item = &'a Active>) -> State {
    let mut state = start.clone();
    state.active.extend(named.into_iter().cloned());
    problem.fit(&mut state);
    state
}

/// Whether laws that were fitted alone may have a name: each material, within its bounds, and cancelled by no other.
pub(super) fn is_sound(problem: &Problem, start: &State, state: &State, thresholds: &Thresholds) -> bool {
    let from = start.active.len();
    let whole = |a: &Active| is_material(a, &a.parameters()) && !stopped(a);
    state.active[from..].iter().all(whole)
        && !problem.runs_away(state, start, thresholds)
        && !(from..state.active.len()).any(|i| problem.is_cancelled(state, i, start, thresholds))
}

/// The first of those between which the data do not decide: no more than noise is left, or hardly more than the least.
pub(super) fn first_of_least(better: Vec<(State, Left)>, thresholds: &Thresholds) -> Option<State> {
    let least = better.iter().map(|(_, left)| left.excess()).fold(f64::INFINITY, f64::min);
    let as_good =
        |left: &Left| !left.is_far(thresholds) || left.excess() <= (1.0 + thresholds.undecided) * least.max(0.0);
    better.into_iter().find(|(_, left)| as_good(left)).map(|(state, _)| state)
}

/// Laws of a kind that change no inertia of a drive, in the order of the catalogue: what moves less is no explanation of what drives
/// it. Of each effect one law.
pub(super) fn laws(problem: &Problem, start: &State, all: &[Active], kind: impl Fn(&Active) -> bool) -> Vec<Active> {
    let may = |a: &Active| kind(a) && (problem.link() == Link::Motion || !problem.changes_inertia(start, a));
    others(start, all, may)
}

/// Laws of a kind that the file does not have, of each effect one.
fn others(start: &State, all: &[Active], kind: impl Fn(&Active) -> bool) -> Vec<Active> {
    let mut laws: Vec<Active> = Vec::new();
    for a in all.iter().filter(|a| !a.effect.probe() && !a.effect.nuisance() && kind(a)) {
        if !start.active.iter().chain(&laws).any(|o| o.effect.name() == a.effect.name()) {
            laws.push(a.clone());
        }
    }
    laws
}

/// Pairs of laws that leave least of held-out runs by a straight line.
fn promising(problem: &Problem, start: &State, laws: &[Active]) -> Vec<[usize; 2]> {
    let linear = problem.linearise(start, laws);
    let penalised = Penalised::new(&linear.equations, 1.0);
    let told = |c: &usize| linear.of_candidate(*c).iter().all(|j| penalised.information(*j) > 0.0);
    let told: Vec<usize> = (0..laws.len()).filter(told).collect();
    let pairs = told.iter().enumerate().flat_map(|(i, a)| told[i + 1..].iter().map(|b| [*a, *b]));
    let rate = |pair: &[usize; 2]| {
        let role = |owner: &Owner| match owner {
            Owner::Active(..) => Role::Free,
            Owner::Candidate(c, _) if pair.contains(c) => Role::Free,
            _ => Role::Out,
        };
        let roles: Vec<Role> = linear.owners.iter().map(role).collect();
        (penalised.held_out(&roles).iter().sum::<f64>(), *pair)
    };
    let mut rated: Vec<(f64, [usize; 2])> = each(&pairs.collect::<Vec<_>>(), &rate);
    rated.retain(|(left, _)| left.is_finite());
    rated.sort_by(|a, b| a.0.total_cmp(&b.0));
    rated.into_iter().take(FITTED).map(|(_, pair)| pair).collect()
}

#[cfg(test)]
mod tests {
    use std::borrow::Cow;
    use std::sync::Arc;

    use links::drive::DriveLink;
    use links::effect::Effect;
    use links::effects::catalogue;
    use links::pieces::{PIECE, segments};
    use model::effects::Applied;
    use model::manoeuvre::{Manoeuvre, simulate};
    use runs::Log;
    use runs::frames::Pose;
    use runs::robot::{Effect as Stated, EffectParameter, Robot};

    use super::*;

    /// What is asked of the drive of a robot in which these effects hide, with the laws that there are.
    fn ask<T>(hidden: &[(&str, &str, f64)], ask: impl FnOnce(&Problem, &State, &[Active]) -> T) -> T {
        let robot = Robot::racbot();
        let stated = |(name, parameter, value): &(&str, &str, f64)| Stated {
            name: (*name).to_owned(),
            parameters: vec![(
                (*parameter).to_owned(),
                EffectParameter { value: *value, ..EffectParameter::default() },
            )],
            ..Stated::default()
        };
        let truth = Robot { effects: hidden.iter().map(stated).collect(), ..robot.clone() };
        let log = |m: Manoeuvre| {
            let mut run = simulate(m, &Applied::of(&truth), &robot, Pose::new(0.4, -0.3, 0.5), 1).unwrap();
            // What is measured of the supply is no question.
            run.supply_v = None;
            Log::from(Cow::Owned(run))
        };
        let logs = [Manoeuvre::StopAndGo, Manoeuvre::Chirp].map(log);
        let pieces = segments(&robot, &robot.geometry().unwrap(), &logs, PIECE);
        let state = State { robot: robot.clone(), active: Vec::new() };
        let mut drive = DriveLink::new(&pieces, &state.drive(None)).unwrap();
        drive.noise = vec![1e-3; robot.wheel_count()];
        let problem = Problem::Drive(&drive);
        let effects: Vec<Arc<dyn Effect>> = catalogue().into_iter().map(Arc::from).collect();
        ask(&problem, &state, &problem.candidates(&state, &effects))
    }

    fn law<'a>(all: &'a [Active], name: &str) -> &'a Active {
        let whole = |a: &&Active| a.effect.name() == name && a.form.free.len() == 1 && a.form.wheels.is_empty();
        all.iter().find(whole).unwrap()
    }

    #[test]
    fn a_supply_is_a_special_case_of_a_motor_and_a_drop_merely_looks_like_one() {
        let special = |one: &str, several: [&str; 2], hidden: (&str, &str, f64)| {
            ask(&[hidden], |problem, start, all| {
                let one = bare(problem, start, [law(all, one)]);
                is_special(problem, start, &one, &several.map(|name| law(all, name)), &Thresholds::default())
            })
        };
        let motor = ["torque-constant", "winding-resistance"];
        assert!(special("supply-voltage", motor, ("supply-voltage", "scale", 0.15)));
        assert!(!special("bridge-drop", ["torque-constant", "viscous-friction"], ("bridge-drop", "drop_v", 1.0)));
    }

    #[test]
    fn a_little_friction_is_no_resistance_that_a_lighter_robot_takes_back() {
        let trifle = |hidden: &[(&str, &str, f64)]| {
            ask(hidden, |problem, start, all| {
                let mut state = start.clone();
                for (name, value) in [("winding-resistance", 0.1), ("robot-mass", -0.15)] {
                    let mut named = law(all, name).clone();
                    let parameter = named.form.free[0].name.clone();
                    named.values.set(&parameter, value);
                    state.active.push(named);
                }
                let found = finish_bare(problem, state, 0, all, &Thresholds::default());
                is_a_trifle(problem, start, &found, all)
            })
        };
        let little = ask(&[], |_, _, all| 0.5 * law(all, "coulomb-friction").form.free[0].material);
        assert!(trifle(&[("coulomb-friction", "torque_nm", little)]));
        assert!(!trifle(&[("winding-resistance", "scale", 0.2), ("robot-mass", "scale", -0.2)]));
    }
}
