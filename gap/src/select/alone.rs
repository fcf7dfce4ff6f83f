//! One law by itself, where nothing that was fitted may have a name.

use estimation::parallel::each;

use super::left::Left;
use super::simpler::{first_of_least, is_plain, is_sound};
use super::{Selection, finish_bare};
use crate::problem::Problem;
use crate::state::{Active, State};
use crate::thresholds::Thresholds;
use links::effect::Link;

/// The one law of the drive that leaves next to nothing by itself, nothing adjusted beside it, of what is far from the noise
/// without it; of several the first of the catalogue. A robot with a load that its file lacks gives way to a weaker motor with a
/// little of everything else, of which one part takes back what another does: that is refused, and nothing had a name.
pub(crate) fn alone(problem: &Problem, start: &State, all: &[Active], thresholds: &Thresholds) -> Option<Selection> {
    let now = Left::fitted(problem, start);
    if problem.link() != Link::Drive || !now.is_far(thresholds) {
        return None;
    }
    let mut laws: Vec<&Active> = Vec::new();
    for a in all.iter().filter(|a| !a.effect.probe() && !a.effect.nuisance() && is_plain(a)) {
        if !start.active.iter().chain(laws.iter().copied()).any(|o| o.effect.name() == a.effect.name()) {
            laws.push(a);
        }
    }
    let fitted = each(&laws, &|law| {
        let mut state = start.clone();
        state.active.push((*law).clone());
        problem.fit(&mut state);
        let left = Left::fitted(problem, &state);
        // What moves less is no explanation of what drives it.
        let lighter = problem.changes_inertia(start, law)
            && state.active.last().is_some_and(|a| a.parameters().iter().any(|v| *v < 0.0));
        let closes = now.far_above(&left, thresholds) && left.excess() < thresholds.alone * now.excess();
        (closes && !lighter && is_sound(problem, start, &state, thresholds)).then_some((state, left))
    });
    let state = first_of_least(fitted.into_iter().flatten().collect(), thresholds)?;
    Some(finish_bare(problem, state, start.active.len(), all, thresholds))
}

#[cfg(test)]
mod tests {
    use super::*;
    use links::drive::DriveLink;
    use links::effects::catalogue;
    use links::pieces::{PIECE, segments};
    use model::effects::Applied;
    use model::manoeuvre::{Manoeuvre, simulate};
    use runs::Log;
    use runs::frames::Pose;
    use runs::robot::{Effect, EffectParameter, Robot};
    use std::sync::Arc;

    /// What is named alone of a robot with a load that its file lacks.
    fn named(load: f64) -> Option<String> {
        let robot = Robot::racbot();
        let scale = EffectParameter { value: load, ..EffectParameter::default() };
        let parameters = || std::iter::once(("scale".to_owned(), scale.clone())).collect();
        let effect = |name: &str| Effect { name: name.to_owned(), parameters: parameters(), ..Effect::default() };
        let truth = Robot { effects: vec![effect("robot-mass"), effect("yaw-inertia")], ..robot.clone() };
        let run = simulate(Manoeuvre::StopAndGo, &Applied::of(&truth), &robot, Pose::default(), 1).unwrap();
        let logs = [Log::from(std::borrow::Cow::Owned(run))];
        let pieces = segments(&robot, &robot.geometry().unwrap(), &logs, PIECE);
        let state = State { robot, active: Vec::new() };
        let mut drive = DriveLink::new(&pieces, &state.drive(None)).unwrap();
        drive.noise = vec![1e-3; state.robot.wheel_count()];
        let problem = Problem::Drive(&drive);
        let effects: Vec<_> = catalogue().into_iter().map(Arc::from).collect();
        let all = problem.candidates(&state, &effects);
        let found = alone(&problem, &state, &all, &Thresholds::default())?;
        Some(found.state.active[0].effect.name().to_owned())
    }

    #[test]
    fn a_load_is_named_by_a_law_that_does_what_it_does() {
        let loaded = named(0.4).unwrap();
        assert!(["torque-constant", "winding-resistance", "robot-mass"].contains(&loaded.as_str()), "{loaded}");
        assert_eq!(named(0.0), None);
    }
}
