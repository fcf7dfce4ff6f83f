//! Speed loops with logged set points: whether their duties answer what no model has.

use super::measure::Drive;
use super::study::Outcome;
use super::workflow::Workflow;
use crate::state::State;
use links::drive::{Answers, DriveLink};
use links::effect::Link;

impl Workflow<'_> {
    /// Whether most of what is left on the drive, before or after what was written, goes with what the loops answered; from
    /// then on it is compared beside that. What was left before does not count where what was written also explains what
    /// no answer does: a weight beside the shaft, say, which the loop has to answer, too.
    pub(super) fn is_answered(&mut self, link: &DriveLink, written: &State) -> bool {
        let Some(answers) = Answers::of(link) else { return false };
        let left = |state: &State| Some(answers.left(link, &link.residuals(&state.drive(None))?));
        let (Some(before), Some(after)) = (left(&self.start), left(written)) else { return false };
        let explains = after.beside < (1.0 - self.thresholds.explained) * before.beside;
        let most = if explains || after.share() > before.share() { after } else { before };
        if most.share() > self.thresholds.answered {
            self.answered = Some(most.answered_nm() / link.sizes.drive_nm);
            self.findings.remarks.push(format!(
                "The speed loop answers torques that the model does not have: {:.0} % of what is left on the drive goes with \
                 duties and speeds that the set points do not account for. Effects of the drive are judged by what the set \
                 points made.",
                100.0 * most.share()
            ));
        }
        self.answered.is_some()
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
