//! Speed loops with logged set points: whether their duties answer what no model has.

use std::sync::Arc;

use super::measure::Drive;
use super::study::{self, Outcome};
use super::workflow::Workflow;
use crate::problem::Problem;
use crate::state::{Active, State};
use links::drive::{Answers, DriveLink};
use links::effect::{Effect, Link};

impl<'a> Workflow<'a> {
    /// The drive beside what its loops answered, and what is found on it, if they do. What a size alone speaks for is not
    /// taken where nothing that set points made is worth a sentence beside the noise of what was answered: that says nothing.
    pub(super) fn beside_answered(
        &mut self,
        link: &DriveLink,
        outcome: &Outcome,
        here: &[Arc<dyn Effect>],
    ) -> Option<(DriveLink<'a>, Outcome)> {
        let (correlation, said) = (self.thresholds.drive_correlation, self.findings.remarks.len());
        let by_size = self.is_answered(link, outcome)?;
        let again = self.drive_again(here)?;
        if by_size && study::rms(&Problem::Drive(&again.0), &self.start) < self.thresholds.worth_saying {
            self.answered = None;
            self.thresholds.drive_correlation = correlation;
            self.findings.remarks.truncate(said);
            return None;
        }
        Some(again)
    }

    /// Whether most of what is left on the drive, before or after what was written, goes with what the loops answered; from
    /// then on it is compared beside that. What was left before does not count where what was written also explains what
    /// no answer does: a weight beside the shaft, say, which the loop has to answer, too. A motor that was fitted to the
    /// answers leaves none of them: then its sizes are others than the set points make it. `None` if not, and whether only a
    /// size says so.
    fn is_answered(&mut self, link: &DriveLink, outcome: &Outcome) -> Option<bool> {
        let answers = Answers::of(link)?;
        let left = |state: &State| Some(answers.left(link, &link.residuals(&state.drive(None))?));
        let (before, after) = (left(&self.start)?, left(&outcome.written)?);
        let explains = after.beside < (1.0 - self.thresholds.explained) * before.beside;
        let most = if explains || after.share() > before.share() { after } else { before };
        let most_of_it = most.share() > self.thresholds.answered;
        let made = if most_of_it { None } else { self.made_by_set_points(link, outcome) };
        let taken_in = made.and_then(|state| left(&state));
        if !most_of_it && taken_in.is_none() {
            return None;
        }
        let most = taken_in.unwrap_or(most);
        self.answered = Some(most.answered_nm() / link.sizes.drive_nm);
        self.findings.remarks.push(format!(
            "The speed loop answers torques that the model does not have: {:.0} % of what is left on the drive goes with \
             duties and speeds that the set points do not account for. Effects of the drive are judged by what the set \
             points made.",
            100.0 * most.share()
        ));
        Some(!most_of_it)
    }

    /// What was written as the set points make it, where they speak against it: a size beyond its interval, and significantly
    /// less left beside the answers (two estimates that both hold where nothing is answered: Hausman, Econometrica 46, 1978).
    fn made_by_set_points(&self, link: &DriveLink, outcome: &Outcome) -> Option<State> {
        let mut beside = self.laid(self.searched(), self.seen.as_ref())?.link;
        beside.noise.clone_from(&link.noise);
        beside.mask_sticking(&outcome.written.drive(None), self.thresholds.sticks);
        let answers = Answers::of(&beside)?;
        let mut state = outcome.written.clone();
        let answered: Vec<bool> =
            state.active.iter().map(|a| self.is_itself_answered(&answers, &beside, outcome, a)).collect();
        state.active.iter_mut().zip(answered).for_each(|(a, answered)| a.given |= answered);
        beside.answer(answers);
        let problem = Problem::Drive(&beside);
        let less = problem.loss(&state) - problem.fit(&mut state);
        let of = |name: &str, parameter: &str| {
            let active = state.active.iter().find(|a| !a.given && a.effect.name() == name)?;
            active.form.free.iter().any(|p| p.name == parameter).then(|| active.values.get(parameter))
        };
        let sizes = || outcome.named.iter().flat_map(|n| n.parameters.iter().map(move |p| (n, p)));
        let beyond = sizes().any(|(n, (parameter, _, interval))| {
            of(&n.name, parameter)
                .is_some_and(|value| interval.ends().is_some_and(|[from, to]| value < from || value > to))
        });
        (beyond && less > self.thresholds.against_a_size * sizes().count() as f64).then_some(state)
    }

    /// Whether most of what something written does is what the loops answer, as a weight or a slope is: what set points make of
    /// that is next to nothing, and its size beside the answers is one that undoes pushes, which are answered as well.
    fn is_itself_answered(&self, answers: &Answers, link: &DriveLink, outcome: &Outcome, of: &Active) -> bool {
        if of.given {
            return false;
        }
        let mut without = outcome.written.clone();
        without.active.retain(|a| a.given || a.effect.name() != of.effect.name());
        let [with, without] = [&outcome.written, &without].map(|state| link.residuals(&state.drive(None)));
        let (Some(mut does), Some(without)) = (with, without) else { return false };
        for (with, without) in does.torque.iter_mut().zip(&without.torque) {
            with.iter_mut().zip(without).for_each(|(with, without)| *with -= without);
        }
        answers.left(link, &does).share() > self.thresholds.answered
    }

    /// Says of torques that the loops answered what they are where none of them has a name.
    pub(super) fn nameless(&mut self, outcome: &Outcome) {
        if let Some(share) = self.answered.filter(|share| *share > self.thresholds.no_noise && outcome.named.is_empty())
        {
            let structure = format!(
                "torques that no model has, {:.0} % of what the drive reaches, which the speed loops answer: pushes, a cable, \
                 wind, a load that comes and goes",
                100.0 * share
            );
            self.findings.leave(Link::Drive, [structure]);
        }
    }
}

/// The drive beside what its speed loops answered, above the floor that this leaves.
pub(super) fn beside_answers(mut drive: Drive) -> Drive {
    let Some(answers) = Answers::of(&drive.link) else { return drive };
    let link = &mut drive.link;
    link.answer(answers);
    (link.noise, drive.correlation) = links::drive::floor(link, &drive.residuals, link.sizes.drive_nm);
    drive
}
