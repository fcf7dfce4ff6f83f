//! Speed loops with logged set points: whether their duties answer what no model has.

use super::measure::Drive;
use super::workflow::Workflow;
use crate::state::State;
use links::drive::{Answers, DriveLink};

impl Workflow<'_> {
    /// Whether most of what is left on the drive, before or after what was written, goes with what the loops answered; from
    /// then on it is compared beside that.
    pub(super) fn is_answered(&mut self, link: &DriveLink, written: &State) -> bool {
        let Some(answers) = Answers::of(link) else { return false };
        let share = |state: &State| Some(answers.share(link, &link.residuals(&state.drive(None))?));
        let most = [&self.start, written].into_iter().filter_map(share).fold(0.0, f64::max);
        self.answered = most > self.thresholds.answered;
        if self.answered {
            self.findings.remarks.push(format!(
                "The speed loop answers torques that the model does not have: {:.0} % of what is left on the drive goes with \
                 duties and speeds that the set points do not account for. Effects of the drive are judged by what the set \
                 points made.",
                100.0 * most
            ));
        }
        self.answered
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
