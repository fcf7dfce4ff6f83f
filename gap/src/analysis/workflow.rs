//! An analysis under way: link after link, each from what the one before left.

use super::counts::{self, Wrong};
use super::findings::Findings;
use super::found::{LinkGap, Named};
use super::gaps;
use super::measure::Data;
use super::order::{TWO_SIDED, order_named};
use super::question::Question;
use super::stale::{self, Stale};
use crate::exact::{ExactLink, Finding};
use crate::state::{Active, State};
use crate::thresholds::Thresholds;
use crate::timing;
use links::effect::Link;
use links::effects;
use links::motion::{MotionLink, WindowResiduals};
use model::setup::Winding;

/// An analysis under way.
pub(super) struct Workflow<'a> {
    pub(super) question: &'a Question<'a>,
    /// Pieces of the runs, links, logs and the thresholds that decide.
    pub(super) data: Data<'a>,
    /// What of them causes are looked for in; `None` for all.
    sample: Option<Data<'a>>,
    /// What the file says.
    pub(super) nominal: State,
    /// What of it the logs contradict.
    pub(super) stale: Vec<Stale>,
    /// What the next link starts from.
    pub(super) start: State,
    pub(super) thresholds: Thresholds,
    pub(super) findings: Findings,
    /// Residuals of the motion that was searched, with what is named there.
    pub(super) seen: Option<Vec<WindowResiduals>>,
    /// What currents beside the duties say of the motors.
    pub(super) winding: Option<Winding>,
    /// Torque that its speed loops answered, in that of the drive, where this is compared beside it.
    pub(super) answered: Option<f64>,
}

impl<'a> Workflow<'a> {
    /// `crossed` are cables that are not where the file has them, and their share of the squared gap.
    pub(super) fn new(
        question: &'a Question<'a>,
        motion: &'a MotionLink<'a>,
        sample: Option<&'a MotionLink<'a>>,
        crossed: Option<(Active, f64)>,
        mut remarks: Vec<String>,
    ) -> Self {
        let data = Data::new(question, motion);
        let sample = sample.map(|motion| Data::new(question, motion));
        let pieces = data.pieces;
        remarks.extend(sample.map(|sample| {
            let [part, all] = [sample.pieces, pieces].map(|pieces| pieces.seconds() / 60.0);
            format!(
                "Causes were looked for in {part:.1} of {all:.1} minutes, spread over all runs; estimates and gaps are of all."
            )
        }));
        let nominal = data.state(&question.set.robot);
        let mut start = nominal.clone();
        let stale = stale::taken_out(&sample.unwrap_or(data), &mut start);
        let mut findings = Findings { remarks, ..Findings::default() };
        if let Some((active, gain)) = crossed {
            findings.named.push(order_named(&active, gain));
            findings.found.push(active.clone());
            start.active.push(active);
        }
        findings.unexplained.extend(crate::leftover::frozen(pieces, &question.options.thresholds));
        findings.unexplained.extend(crate::leftover::torn(
            pieces,
            [motion.noise[0], motion.noise[1]],
            &question.options.thresholds,
        ));
        let thresholds = question.options.thresholds.clone();
        Self {
            question,
            data,
            sample,
            nominal,
            stale,
            start,
            thresholds,
            findings,
            seen: None,
            winding: None,
            answered: None,
        }
    }

    /// The data that causes are looked for in.
    pub(super) fn searched(&self) -> Data<'a> {
        self.sample.unwrap_or(self.data)
    }

    /// All data, where causes are looked for in a part of them.
    pub(super) fn beyond(&self) -> Option<Data<'a>> {
        self.sample.map(|_| self.data)
    }

    /// Counts a wheel turn that the controller reckons with, if they are not the file's.
    pub(super) fn counts(&mut self, links: &[ExactLink]) {
        let told = |link: &'_ ExactLink| {
            Some((exact_named(link.finding.as_ref()?, link), counts::of_loop(link.finding.as_ref()?)?))
        };
        let Some((named, scale)) = links.iter().find_map(told) else { return };
        let robot = &self.question.robot;
        let wrong = counts::whose(scale, &self.searched(), &self.start, &self.thresholds);
        let turn = std::f64::consts::TAU * robot.counts_per_wheel_rad();
        self.findings.remarks.push(counts::said(&wrong, scale, turn, self.data.has_motion));
        if let Wrong::File(active) = wrong {
            self.findings.named.push(counts::both_sides(named));
            self.findings.found.push(active.clone());
            self.start.active.push(active);
        }
    }

    /// Takes back what stamps alone said of the camera where the poses do not say so.
    pub(super) fn judge_stamps(&mut self, links: &mut [ExactLink]) {
        let question = self.question;
        let (seen, noise) = (self.seen.as_deref().unwrap_or(&[]), self.searched().motion.noise);
        let logs = (&question.robot, self.data.logs);
        for link in links.iter_mut().filter(|l| l.link == Link::Timing && l.finding.is_some()) {
            self.findings.remarks.extend(timing::uneven(link, logs, noise, seen, &self.thresholds));
        }
    }

    /// Takes over what the replayed links gave; their gaps.
    pub(super) fn exact(&mut self, links: &[ExactLink]) -> Vec<LinkGap> {
        self.findings.remarks.extend(counts::geared(&self.findings.named, self.question.robot.gear_ratio));
        for link in links {
            let findings = &mut self.findings;
            // Of an effect with two sides the other one may have its name.
            let is_same = |n: &Named, f: &Finding| {
                let side = |n: &Named| f.parameters.iter().all(|(p, ..)| n.parameters.iter().any(|(own, ..)| own == p));
                n.name == f.name && (!TWO_SIDED.contains(&f.name) || side(n))
            };
            let is_new = |f: &&Finding| !findings.named.iter().any(|n| is_same(n, f));
            if let Some(f) = link.finding.as_ref().filter(is_new) {
                findings.named.push(exact_named(f, link));
            } else if link.unexplained {
                let told = link.replay.as_ref().and_then(|r| r.structure.clone());
                let structure = told.unwrap_or_else(|| {
                    format!(
                        "differs at {:.1} % of the ticks, and no hypothesis of the catalogue replays it",
                        100.0 * link.wrong_share
                    )
                });
                findings.leave(link.link, [structure]);
            }
            findings.remarks.extend(link.replay.as_ref().map(|r| r.remark.clone()).filter(|said| !said.is_empty()));
        }
        links.iter().map(gaps::exact_gap).collect()
    }
}

fn exact_named(f: &Finding, link: &ExactLink) -> Named {
    let square = |e: &[f64]| e.iter().map(|x| x * x).sum::<f64>();
    let gain = 1.0 - square(&link.after) / square(&link.before).max(1e-300);
    Named {
        name: f.name.to_owned(),
        equation: effects::exact_equation(f.name).to_owned(),
        link: f.link,
        wheels: f.wheels.iter().map(|w| w + 1).collect(),
        parameters: f.parameters.clone(),
        gain: gain.clamp(0.0, 1.0),
        evidence: f.evidence.clone(),
        conditional_on: Vec::new(),
    }
}
