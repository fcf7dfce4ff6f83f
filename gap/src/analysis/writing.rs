//! The file that an analysis writes, and what it gives when it is read again.

use runs::Log;
use runs::robot::Robot;

use super::found::{LinkGap, Named};
use super::measure::Measured;
use super::robot_file::{robot_text, undo, with_effects};
use super::workflow::Workflow;
use crate::GapError;
use crate::evidence::Evidence;
use crate::options::Stage;
use crate::thresholds::Thresholds;
use crate::units::short;
use links::effect::Link;
use links::effects;

/// A robot with what was named, its file, and the figures of that file.
pub(super) struct Written<'a> {
    pub(super) robot: Robot,
    pub(super) text: String,
    pub(super) measured: Measured<'a>,
    /// Whether the times of the logs cannot be seconds: what was found by such a clock is nothing.
    pub(super) odd_clock: bool,
}

impl<'a> Workflow<'a> {
    /// Names of the runs.
    pub(super) fn runs(&self) -> Vec<String> {
        self.data.logs.iter().map(|r| r.name.clone()).collect()
    }

    /// Writes what is named and measures that file. What is reported is what the file, read again, gives; where that
    /// does not fall, nothing is named.
    pub(super) fn written(&mut self) -> Result<Written<'a>, GapError> {
        let refused = std::mem::take(&mut self.findings.refused);
        self.findings.remarks.extend(refused);
        let odd = odd_clock(&self.question.robot, self.data.logs, &self.thresholds);
        let odd_clock = odd.is_some();
        if let Some(remark) = odd {
            self.findings.remarks.push(remark);
            self.findings.named.clear();
            self.findings.alternatives.clear();
            self.findings.unexplained.clear();
        }
        let (robot, text, measured) = loop {
            let (robot, text, measured) = self.measured()?;
            let why = |n: &Named| {
                if is_idle(n, &measured.links, &self.thresholds) || measured.idle.contains(&n.name) {
                    Some("as written it does not lower the gap".to_owned())
                } else if is_noise(n, &measured.links, &self.thresholds) {
                    Some("what an encoder's noise makes a wheel that coasts takes away as well".to_owned())
                } else {
                    let p = by_chance(n, &measured.links, &self.thresholds)?;
                    Some(format!("one of so many does as much by chance (p = {})", short(p)))
                }
            };
            let gone: Vec<(String, String)> =
                self.findings.named.iter().filter_map(|n| Some((n.name.clone(), why(n)?))).collect();
            if gone.is_empty() {
                break (robot, text, measured);
            }
            let said = gone.iter().map(|(name, why)| format!("Fitted, and not named: {name}; {why}."));
            self.findings.remarks.extend(said);
            let gone: Vec<String> = gone.into_iter().map(|(name, _)| name).collect();
            self.findings.forget(&gone);
        };
        self.question.options.reached(Stage::Measured);
        for n in &mut self.findings.named {
            let tested = matches!(n.evidence, Evidence::Test { .. });
            if let Some((_, gain)) = measured.gains.iter().find(|g| tested && g.0 == n.name) {
                n.gain = *gain;
            }
        }
        self.findings.named.sort_by(|a, b| b.gain.total_cmp(&a.gain));
        Ok(Written { robot, text, measured, odd_clock })
    }

    /// The file as it would be, and its figures.
    fn measured(&self) -> Result<(Robot, String, Measured<'a>), GapError> {
        let (set, options) = (self.question.set, self.question.options);
        let kept = self.stale.iter().fold(set.robot.clone(), |robot, s| undo(&robot, &s.name).unwrap_or(robot));
        let robot = with_effects(&kept, &self.findings.named, &self.findings.alternatives, &self.runs());
        let text = robot_text(set, options, &robot);
        let path = options.robot_file.clone().unwrap_or_else(|| set.folder.join("robot.toml"));
        let reread = Robot::parse_partial(&text, &path).map_err(|e| GapError::Robot(e.to_string()))?;
        // On blocks a log may speak of some of the axes only.
        let reread = reread.first_axes(self.question.robot.wheel_count());
        let new: Vec<&str> = self.findings.named.iter().map(|n| n.name.as_str()).collect();
        let measured = self.data.measure(&set.robot, &reread, &new);
        Ok((robot, text, measured))
    }
}

/// Whether a fitted effect, as written, leaves its link where it was. Without a camera what moves the body shows on the
/// other links alone.
fn is_idle(n: &Named, links: &[LinkGap], thresholds: &Thresholds) -> bool {
    // Of poses with much noise an effect may close all there is to close and still be a small share: no more is asked of
    // the file than of the fit, and of the limit that is printed.
    let falls = match n.link {
        Link::Motion => (1.0 - thresholds.share(Link::Motion)).sqrt(),
        _ => thresholds.falls,
    };
    let is_seen = links.iter().any(|l| l.link == n.link);
    let mut shown = links.iter().filter(|l| l.link == n.link || !is_seen && l.link.is_fitted()).peekable();
    matches!(n.evidence, Evidence::Test { .. })
        && n.link.is_fitted()
        && shown.peek().is_some()
        && shown.all(|l| l.after >= falls * l.before)
}

/// The p of an effect on a link that agrees without it, where one of as many that are tried has that by chance.
fn by_chance(n: &Named, links: &[LinkGap], thresholds: &Thresholds) -> Option<f64> {
    let Evidence::Test { p, .. } = n.evidence else { return None };
    let agrees = links.iter().any(|l| l.link == n.link && l.before < 1.0);
    (agrees && p > thresholds.surely).then_some(p)
}

/// Whether an effect that takes away noise as well is named on a link that is not worth a sentence without it, and closes little
/// of that.
fn is_noise(n: &Named, links: &[LinkGap], thresholds: &Thresholds) -> bool {
    let takes_noise = effects::find(&n.name).is_some_and(|effect| effect.takes_noise());
    let closes = |l: &LinkGap| l.after.powi(2) < (1.0 - thresholds.play_closes) * l.before.powi(2);
    let worth = links.iter().any(|l| l.link == n.link && (l.before >= thresholds.worth_saying || closes(l)));
    takes_noise && matches!(n.evidence, Evidence::Test { .. }) && !worth
}

/// What to say of logs whose times cannot be seconds.
fn odd_clock(robot: &Robot, logs: &[Log], thresholds: &Thresholds) -> Option<String> {
    let periods = logs.iter().filter_map(|log| Some((&log.name, log.tick_s()? * robot.control_rate_hz)));
    periods.filter(|(_, p)| *p > 0.0).find(|(_, p)| p.max(1.0 / p) > thresholds.odd_rows).map(|(log, odd)| {
        format!(
            "Compared nothing: the rows of {log} are {odd:.3} control periods apart by the column t and control_rate_hz; t is in \
             seconds (are these milliseconds?)."
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn gap(link: Link, before: f64, after: f64) -> LinkGap {
        LinkGap { link, before, after, floor: Vec::new(), rms: Vec::new(), units: Vec::new(), signals: 1 }
    }

    #[test]
    fn where_a_link_agrees_evidence_is_strong() {
        let drag = |p: f64| Named {
            evidence: Evidence::Test { method: "signs of whole clusters flipped", p },
            ..Named::bare("body-drag", Link::Drive, &[])
        };
        let chance = |p: f64, before: f64| {
            let links = [gap(Link::Motion, 0.5, 0.5), gap(Link::Drive, before, 0.1)];
            by_chance(&drag(p), &links, &Thresholds::default())
        };
        assert_eq!(chance(0.003, 0.4), Some(0.003));
        assert!(chance(0.0002, 0.4).is_none() && chance(0.008, 16.0).is_none());
    }

    #[test]
    fn play_is_named_where_a_link_is_worth_a_sentence_without_it() {
        let is_noise = |name: &str, before: f64, after: f64| {
            let evidence = Evidence::Test { method: "signs of whole clusters flipped", p: 0.0002 };
            let named = Named { evidence, ..Named::bare(name, Link::Drive, &[]) };
            is_noise(&named, &[gap(Link::Motion, 4.0, 0.5), gap(Link::Drive, before, after)], &Thresholds::default())
        };
        assert!(is_noise("gear-backlash", 1.1, 1.05) && !is_noise("viscous-friction", 1.1, 1.05));
        assert!(!is_noise("gear-backlash", 2.5, 2.3));
        // Below that what closes a good part of it.
        assert!(!is_noise("gear-backlash", 1.21, 0.97));
    }

    #[test]
    fn without_a_camera_an_effect_must_serve_another_link() {
        let idle =
            |links: &[LinkGap]| is_idle(&Named::bare("wheel-creep", Link::Motion, &[]), links, &Thresholds::default());
        let [gyro, drive] = [Link::Gyroscope, Link::Drive];
        assert!(idle(&[gap(gyro, 0.8, 1.1), gap(drive, 0.5, 0.9)]));
        assert!(!idle(&[gap(gyro, 3.0, 0.9), gap(drive, 0.5, 0.9)]));
        assert!(!idle(&[gap(gyro, 0.8, 0.8), gap(drive, 3.0, 0.9)]));
        // With one it is the camera's word.
        assert!(idle(&[gap(Link::Motion, 1.0, 1.1), gap(drive, 3.0, 0.9)]));
        assert!(!idle(&[]));
    }
}
