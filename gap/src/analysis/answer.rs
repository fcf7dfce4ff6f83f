//! What an analysis answers: the verdict and everything that is shown with it.

use super::differing;
use super::driven::Driven;
use super::found::{Analysis, Leftover, LinkGap, Named, Verdict};
use super::gaps::{self, Remains};
use super::measure::{Measured, MeasuredDrive};
use super::robot_file::completed;
use super::workflow::Workflow;
use super::writing::Written;
use crate::GapError;
use crate::exact::ExactLink;
use crate::locate::{self, Located};
use crate::problem::Problem;
use crate::state::Active;
use links::effect::{Effect, Link, Sizes};
use links::inertial::Fit;
use links::motion::{MotionLink, WindowResiduals};

/// Whole runs that a report shows.
const SHOWN: usize = 4;

impl Workflow<'_> {
    /// Everything found out; `replayed` are the gaps of the exact links.
    pub(super) fn answer(
        mut self,
        written: Written<'_>,
        exact: Vec<ExactLink>,
        replayed: Vec<LinkGap>,
    ) -> Result<Analysis, GapError> {
        let located = self.located(&written, &exact);
        let Written { robot, text, measured, odd_clock } = written;
        let Measured { mut links, motion, drive, mut driven, steps, felt, .. } = measured;
        let mut weightless = gaps::weightless(self.data.pieces, drive.as_ref().map(|d| &d.plots[1]));
        links.extend(replayed);
        if links.is_empty() && weightless.is_empty() {
            return Err(GapError::NothingToCompare);
        }
        if self.data.has_camera() {
            driven.seen = Driven::seen(self.data.pieces, SHOWN);
        }
        if !odd_clock {
            self.contradicted();
            self.differ(&links, drive.as_ref());
        }
        let remains = if odd_clock { Vec::new() } else { self.remains(&links, &located, &felt) };
        if self.findings.named.is_empty() {
            let (limits, robot) = (&self.findings.limits, &self.question.robot);
            let blind = |l: &LinkGap| gaps::blind(l, limits, self.data.catalogue, robot, &self.thresholds);
            weightless.extend(links.iter().filter(|l| l.link.is_fitted()).filter_map(blind));
        }
        let counts = |l: &&LinkGap| !weightless.iter().any(|w| w.0 == l.link) && l.link != Link::Timing;
        let weight = if odd_clock { 0 } else { links.iter().filter(counts).count() };
        let mut why: Vec<String> = weightless.iter().map(|w| w.1.clone()).collect();
        why.dedup();
        self.findings.remarks.extend(why);
        let nearest = self.nearest();
        let verdict = self.verdict(&nearest, weight);
        let drive_noise = drive.as_ref().map_or(&[][..], |d| &d.link.noise);
        let known = crate::experiment::Findings {
            robot: &self.question.robot,
            found: &completed(&robot, self.data.logs),
            active: &self.findings.found,
            pieces: self.searched().pieces,
            noise: (self.question.noise, drive_noise),
            window_s: self.question.window_s,
            thresholds: &self.thresholds,
            catalogue: self.data.catalogue,
        };
        let next_experiment = match verdict {
            Verdict::Ambiguous | Verdict::MissingEffect => {
                crate::experiment::propose(&known, &self.findings.alternatives)
            }
            _ => None,
        };
        let folder = self.question.set.folder.file_name();
        Ok(Analysis {
            verdict,
            located,
            nearest,
            next_experiment,
            tried: self.tried(),
            whole: self.whole(&robot),
            waterfall: gaps::waterfall(&links, &steps, &self.findings.named),
            links,
            robot_text: text,
            robot,
            name: folder.map(|n| n.to_string_lossy().into_owned()).unwrap_or_default(),
            runs: self.runs(),
            window_s: self.data.motion.window_s,
            ways: self.data.motion.ways,
            remains,
            motion,
            drive: drive.map(|d| d.plots),
            driven,
            exact,
            thresholds: self.thresholds,
            effects: self.findings.named,
            alternatives: self.findings.alternatives,
            unexplained: self.findings.unexplained,
            limits: self.findings.limits,
            held_out: self.findings.held_out,
            remarks: self.findings.remarks,
            mistakes: self.question.options.mistakes.clone(),
        })
    }

    /// Where the model and the data part, worst first.
    fn located(&self, written: &Written<'_>, exact: &[ExactLink]) -> Vec<Located> {
        let measured = &written.measured;
        let mut located = locate::inertial(&measured.felt);
        if let Some(plots) = &measured.motion {
            located.extend(locate::motion(self.data.motion, &plots[0]));
        }
        if let Some(MeasuredDrive { link, plots }) = &measured.drive {
            let sizes = Sizes::of(&self.question.robot);
            let unit = match self.question.currents {
                true => (sizes.stall_nm / sizes.stall_a, "A", "current"),
                false => (sizes.stall_nm, "", "duty"),
            };
            located.extend(locate::drive(link, &plots[0], &link.noise, unit));
        }
        located.extend(exact.iter().flat_map(locate::exact));
        located.sort_by(|a: &Located, b| b.excess.total_cmp(&a.excess));
        located
    }

    /// What remains on the links, in sentences; where it is too much, it stays unexplained, but for logs too short for any
    /// name: there the floor is no better known than the gap.
    fn remains(&mut self, links: &[LinkGap], located: &[Located], felt: &[Fit]) -> Vec<String> {
        let findings = &mut self.findings;
        // What slides drives no body as Newton has it: the name says so already.
        let slides = findings.named.iter().any(|n| n.name == "wheel-slip");
        let mut sentences = Vec::new();
        for link in links.iter().filter(|l| !(slides && l.link == Link::Drive)) {
            match gaps::remains(link, located, felt, &self.thresholds) {
                Some(Remains::Open(structure))
                    if !findings.unexplained.iter().any(|u| u.link == link.link)
                        && gaps::has_limits(link.link, &findings.limits, self.data.catalogue) =>
                {
                    findings.unexplained.push(Leftover { link: link.link, structure });
                }
                Some(Remains::Beside(sentence)) if findings.shows_without_size(link.link) => {
                    let near: Vec<&str> = findings.of_no_size.iter().map(|(_, name)| name.as_str()).collect();
                    let structure = format!(
                        "{}; {} closes a part of it by more than chance, and these logs do not tell of which size",
                        sentence.trim_end_matches(", which no effect of the catalogue explains"),
                        near.join(" or ")
                    );
                    findings.unexplained.push(Leftover { link: link.link, structure });
                }
                Some(Remains::Open(sentence) | Remains::Beside(sentence)) => sentences.push(sentence),
                None => {}
            }
        }
        sentences
    }

    /// Says what of the file the logs contradict; where nothing else is named on the link, that is the answer there.
    fn contradicted(&mut self) {
        for stale in &self.stale {
            let named = |is: &dyn Fn(&Named) -> bool| self.findings.named.iter().any(is);
            if named(&|n| n.link == stale.link) {
                self.findings.remarks.push(stale.said(named(&|n| n.name == stale.name)));
            } else {
                self.findings.leave(stale.link, [stale.said(false)]);
            }
        }
    }

    /// Says in what the runs differ, where that is a good part of what is left on a link: then no one robot explains them.
    fn differ(&mut self, links: &[LinkGap], drive: Option<&MeasuredDrive>) {
        let mut state = self.nominal.clone();
        state.active.retain(|a| !self.stale.iter().any(|s| s.name == a.effect.name()));
        state.active.extend(self.findings.found.iter().map(|a| Active { given: false, ..a.clone() }));
        let runs = self.runs();
        let of = |link: &LinkGap| {
            let problem = match link.link {
                Link::Motion if self.data.has_camera() => Problem::Motion(self.data.motion),
                Link::Drive => Problem::Drive(&drive?.link),
                _ => return None,
            };
            let levels = || differing::Levels::of(self.data.pieces, runs.len(), &self.thresholds);
            let levels = (link.link == Link::Drive).then_some(&levels as &dyn Fn() -> differing::Levels);
            let structure = differing::said(&problem, &state, self.data.catalogue, &runs, levels, &self.thresholds)?;
            Some(Leftover { link: link.link, structure })
        };
        let differ: Vec<Leftover> = links.iter().filter_map(of).collect();
        self.findings.unexplained.splice(0..0, differ);
    }

    /// Named effects on links that stay unexplained; of the drive, too, where what the camera saw does not follow from the
    /// wheels: what slips moves no body as Newton has it, and a wheel that hardly carries any looked like a motor of a third
    /// of its resistance.
    fn nearest(&self) -> Vec<String> {
        let open = |link: Link| self.findings.unexplained.iter().any(|u| u.link == link);
        let driven = self.findings.named.iter().any(|n| n.link == Link::Drive);
        let astray = |m: &model::setup::Mistake| ["wheels-slip", "robot-file"].contains(&m.kind);
        let slips = driven && open(Link::Motion) && model::setup::mistakes(self.question.set).iter().any(astray);
        let near = |n: &&Named| open(n.link) || slips && n.link == Link::Drive;
        self.findings.named.iter().filter(near).map(|n| n.name.clone()).collect()
    }

    /// What it comes to, where some names are merely the nearest and so many links had weight.
    fn verdict(&self, nearest: &[String], weight: usize) -> Verdict {
        let findings = &self.findings;
        if !findings.unexplained.is_empty() && findings.named.iter().all(|n| nearest.contains(&n.name)) {
            Verdict::Unexplained
        } else if findings.named.is_empty() {
            if weight == 0 { Verdict::NotCompared } else { Verdict::Agrees }
        } else if findings.ambiguous {
            Verdict::Ambiguous
        } else {
            Verdict::MissingEffect
        }
    }

    /// Names of the effects that were tried. Without a sensor nobody asked for its effects.
    fn tried(&self) -> Vec<String> {
        let sensor = self.data.motion.inertial.as_ref();
        let shows = |e: &dyn Effect| !e.link().is_inertial() || sensor.is_some_and(|sensor| sensor.shows(e));
        let tried = self.data.catalogue.iter().filter(|e| !e.probe() && shows(e.as_ref()));
        tried.map(|e| e.name().to_owned()).collect()
    }

    /// The first runs as one window each, before and after.
    fn whole(&self, written: &runs::robot::Robot) -> Option<[Vec<WindowResiduals>; 2]> {
        self.data.has_camera().then(|| {
            let uncut = MotionLink::new(self.data.pieces, self.question.noise, f64::INFINITY).first(SHOWN);
            [&self.nominal, &self.data.state(written)].map(|state| uncut.residuals(&state.motion(None)))
        })
    }
}
