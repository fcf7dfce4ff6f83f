//! Effects of the file that the logs have of another size: of a floor that was changed, a gear that ran in, a calibration of
//! another robot.
//!
//! Beside a size that is wrong only what undoes it could be named: of a radius 1 % too large, counts that are 1 % too few. So
//! where a link does not agree, or would agree better at another size, it is looked at without each effect that the file has
//! there, and what explains it as well by no more effects takes the place of the file's.

use super::found::Named;
use super::stale::{self, Stale};
use super::study::{self, Outcome};
use super::workflow::Workflow;
use crate::problem::Problem;
use crate::select;
use crate::state::{Active, State};
use links::effect::{Link, Parameter};

/// What a link was found to be, with the state that its study started from.
struct Side<'s> {
    start: &'s State,
    outcome: &'s Outcome,
}

/// How a link is better explained without an effect of the file.
#[derive(PartialEq)]
enum Better {
    Surely,
    /// What is named beside it leaves no more.
    Tied,
}

impl Workflow<'_> {
    /// What is found by a `look` at a link, with what the file has there or without; `parts` of it are its problem and outcome.
    pub(super) fn resized<T>(
        &mut self,
        link: Link,
        mut found: T,
        look: &dyn Fn(&mut Self) -> Option<T>,
        parts: &dyn for<'t> Fn(&'t T) -> (Problem<'t>, &'t Outcome),
    ) -> T {
        for name in self.filed_on(link) {
            let (problem, outcome) = parts(&found);
            let agrees = outcome.named.is_empty() && outcome.held_out < self.thresholds.worth_saying;
            if agrees && !self.would_be_another(&name, &problem) {
                continue;
            }
            let (kept, said) = (self.start.clone(), self.findings.remarks.len());
            let (answered, correlation) = (self.answered.take(), self.thresholds.drive_correlation);
            self.start.active.retain(|a| a.effect.name() != name);
            let other = look(self).and_then(|other| {
                let [with, without] = [&found, &other].map(|side| parts(side).1);
                let left = stale::left(&self.searched(), link, &with.written, &without.written)?;
                let sides = [Side { start: &kept, outcome: with }, Side { start: &self.start, outcome: without }];
                let better = self.is_better_without(&name, &parts(&other).0, &sides, left)?;
                Some((other, left, better))
            });
            match other {
                Some((other, left, better)) => {
                    let names: Vec<String> = parts(&found).1.named.iter().map(|n| n.name.clone()).collect();
                    if better == Better::Tied {
                        self.findings.alternatives.push([std::slice::from_ref(&name), &names].concat());
                        self.findings.ambiguous = true;
                    }
                    self.stale.push(Stale { name, link, left, names });
                    found = other;
                }
                None => {
                    self.start = kept;
                    self.findings.remarks.truncate(said);
                    (self.answered, self.thresholds.drive_correlation) = (answered, correlation);
                }
            }
        }
        found
    }

    /// Names of the effects that the file has on a link, of sizes that can be found anew.
    fn filed_on(&self, link: Link) -> Vec<String> {
        let filed = self.nominal.active.iter().map(|a| &a.effect).filter(|e| e.link() == link && !e.nuisance());
        let kept = filed.filter(|e| self.start.active.iter().any(|a| a.effect.name() == e.name()));
        kept.map(|e| e.name().to_owned()).collect()
    }

    /// Whether an effect of the file fits at another size by more than chance, and what matters.
    fn would_be_another(&self, name: &str, problem: &Problem) -> bool {
        let mut state = self.start.clone();
        let Some(at) = state.active.iter().position(|a| a.effect.name() == name) else { return false };
        let filed = state.active.remove(at);
        let same = |a: &Active| {
            let mut names = a.form.free.iter().map(|p| &p.name).chain(a.form.fixed.iter().map(|(name, _)| name));
            let parameters = a.form.free.len() + a.form.fixed.len();
            let filed = &filed.values;
            a.effect.name() == name && parameters == filed.0.len() && names.all(|name| filed.find(name).is_some())
        };
        let Some(form) = problem.candidates(&state, self.data.catalogue).into_iter().find(same) else { return false };
        let free = form.form.free.clone();
        state.active.push(Active { values: filed.values.clone(), ..form });
        let least = self.thresholds.gain + self.thresholds.cost(free.len());
        let gain = problem.loss(&state) - problem.fit(&mut state);
        let moved =
            |p: &Parameter| state.active.last().map_or(0.0, |a| a.values.get(&p.name)) - filed.values.get(&p.name);
        gain > least && free.iter().any(|p| p.is_material(moved(p)))
    }

    /// Whether it is better to do without an effect of the file, which leaves so many floors with it and without: by fewer effects
    /// that leave hardly more, or by as many of which it is one, of another size by its interval, if that leaves less. Where
    /// what is named beside the file's size leaves no more, both are tied.
    fn is_better_without(&self, name: &str, problem: &Problem, sides: &[Side; 2], left: [f64; 2]) -> Option<Better> {
        let [with, without] = sides;
        let held_out = |side: &Side| {
            let state = study::written_to_fit(&side.outcome.written, side.start.active.len());
            select::held_out(problem, &state).0
        };
        let filed = with.start.active.iter().find(|a| a.effect.name() == name)?;
        let of_it = without.outcome.named.iter().filter(|n| n.name == name).flat_map(|n| &n.parameters);
        let mut ends = of_it.filter_map(|(parameter, _, interval)| Some((parameter, interval.ends()?)));
        let is_another = ends.any(|(parameter, [low, high])| !(low..=high).contains(&filed.values.get(parameter)));
        let [more, fewer] = [with, without].map(|side| side.outcome.named.len());
        if fewer == 0 {
            return None;
        }
        let [before, after] = [with, without].map(held_out);
        let cost = |side: &Side| {
            let of = |n: &Named| self.thresholds.cost(n.parameters.len());
            side.outcome.named.iter().map(of).sum::<f64>()
        };
        let better = before + cost(with) - after - cost(without);
        let is_close = left[1] < left[0].max(1.0) * self.thresholds.as_well;
        let at_first = problem.loss(with.start);
        let tie = self.thresholds.tie(at_first - before);
        if fewer < more && is_close || is_another && self.thresholds.decided(left[0], left[1]) {
            return Some(Better::Surely);
        }
        if fewer == more && is_another && is_close && better > -tie {
            return Some(if better < tie { Better::Tied } else { Better::Surely });
        }
        let least = self.thresholds.gain.max(self.thresholds.share(problem.link()) * before);
        (fewer == more + 1 && is_another && better > least).then_some(Better::Surely)
    }
}
