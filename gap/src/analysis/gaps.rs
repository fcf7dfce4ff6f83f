//! The gap in figures: per link, over all signals, and how it falls.

use super::{Leftover, Located};
use crate::drive::DriveResiduals;
use crate::effect::Link;
use crate::exact::ExactLink;
use crate::motion::WindowResiduals;

/// Gap figures of one link.
#[derive(Debug, Clone, PartialEq)]
pub struct LinkGap {
    /// Link.
    pub link: Link,
    /// Held-out RMS in units of the noise floor, nominal.
    pub before: f64,
    /// With the named effects.
    pub after: f64,
    /// Physical floor per signal.
    pub floor: Vec<f64>,
    /// Physical RMS per signal, nominal and after.
    pub rms: Vec<[f64; 2]>,
    /// Unit of each signal.
    pub units: Vec<&'static str>,
    /// Number of signals.
    pub signals: usize,
}

pub(super) fn motion_gap([before, after]: [f64; 2], noise: [f64; 3], plots: &[Vec<WindowResiduals>; 2]) -> LinkGap {
    let rms = |side: usize, i: usize| {
        noise[i]
            * crate::statistics::rms(
                plots[side]
                    .iter()
                    .flat_map(|w| w.residuals.iter().zip(&w.weights))
                    .filter(|(_, w)| **w > 0.0)
                    .map(|(r, _)| r[i]),
            )
    };
    LinkGap {
        link: Link::Motion,
        before,
        after,
        floor: noise.to_vec(),
        rms: (0..3).map(|i| [rms(0, i), rms(1, i)]).collect(),
        units: vec!["m", "m", "rad"],
        signals: 3,
    }
}

pub(super) fn drive_gap([before, after]: [f64; 2], floor: &[f64], plots: &[DriveResiduals; 2]) -> LinkGap {
    let rms = |side: usize, i: usize| {
        let d = &plots[side];
        crate::statistics::rms(d.torque.iter().zip(&d.weights).filter(|(_, w)| w[i] > 0.0).map(|(t, _)| t[i]))
    };
    LinkGap {
        link: Link::Drive,
        before,
        after,
        floor: floor.to_vec(),
        rms: (0..floor.len()).map(|i| [rms(0, i), rms(1, i)]).collect(),
        units: vec!["Nm"; floor.len()],
        signals: floor.len(),
    }
}

pub(super) fn exact_gap(link: &ExactLink) -> LinkGap {
    let figure = |e: &[f64]| {
        crate::statistics::rms(
            e.iter().map(|x| if link.link == Link::Timing { x / link.floor } else { 1.0 + x / link.floor }),
        )
    };
    LinkGap {
        link: link.link,
        before: figure(&link.before),
        after: figure(&link.after),
        floor: vec![link.floor; link.before.len()],
        rms: link.before.iter().zip(&link.after).map(|(a, b)| [*a, *b]).collect(),
        units: vec![link.unit; link.before.len()],
        signals: link.before.len(),
    }
}

/// Gap over all signals: (before, after), in units of the floor.
pub fn overall(links: &[LinkGap]) -> (f64, f64) {
    let signals: f64 = links.iter().map(|l| l.signals as f64).sum();
    let mean = |f: &dyn Fn(&LinkGap) -> f64| {
        (links.iter().map(|l| l.signals as f64 * f(l).powi(2)).sum::<f64>() / signals.max(1.0)).sqrt()
    };
    (mean(&|l| l.before), mean(&|l| l.after))
}

/// What matters within a second of motion, m and rad.
const MATTERS: [f64; 2] = [0.004, 0.02];
/// Share of the drive's torque that matters: twice what rollers and contacts cost every omni drive.
const DRIVE_MATTERS: f64 = 0.06;

/// Gap of the motion link that matters, in noise floors.
pub(super) fn motion_matters(noise: [f64; 3]) -> f64 {
    let [x, y, theta] = noise;
    2.0_f64.max((MATTERS[0] / x.max(y).max(1e-9)).min(MATTERS[1] / theta.max(1e-9)))
}

/// Gap of the drive link that matters, in noise floors (Nm, one a wheel).
pub(super) fn drive_matters(floor: &[f64], drive_nm: f64) -> f64 {
    DRIVE_MATTERS * drive_nm / crate::statistics::rms(floor.iter().copied()).max(1e-9)
}

/// What to say of a link of motion or drive on which much is left and little was explained.
pub(super) fn stays_open(link: &LinkGap, located: &[Located], drive_nm: f64) -> Option<Leftover> {
    /// Noise floors, and the share of the squared gap that may be left.
    const FAR: [f64; 2] = [3.0, 0.1];
    let open = |rms: f64| (rms * rms - 1.0).max(0.0);
    let material = link.rms.iter().zip(&link.units).any(|([_, after], unit)| match *unit {
        "m" => *after >= MATTERS[0],
        "rad" => *after >= MATTERS[1],
        _ => *after >= DRIVE_MATTERS * drive_nm,
    });
    let counts = matches!(link.link, Link::Motion | Link::Drive) && material;
    if !counts || link.after < FAR[0] || open(link.after) < FAR[1] * open(link.before) {
        return None;
    }
    let worst = located.iter().filter(|l| l.link == link.link).max_by(|a, b| a.excess.total_cmp(&b.excess));
    let place = worst.map_or_else(|| "the link disagrees".to_owned(), |l| l.place.clone());
    let structure =
        format!("{place}; {:.1} noise floors are left, which nothing in the catalogue explains", link.after);
    Some(Leftover { link: link.link, structure })
}

pub(super) fn waterfall(links: &[LinkGap], parts: &[(String, Link, f64)]) -> Vec<(String, f64)> {
    let (before, after) = overall(links);
    let mut out = vec![("nominal model".to_owned(), before)];
    // The squares of the links fall by each effect's share.
    let mut now: Vec<(Link, f64, f64)> = links.iter().map(|l| (l.link, l.before, l.signals as f64)).collect();
    for (name, link, gain) in parts {
        if let (Some(slot), Some(l)) = (now.iter_mut().find(|n| n.0 == *link), links.iter().find(|l| l.link == *link)) {
            slot.1 = (slot.1.powi(2) - gain * l.before.powi(2)).max(l.after.powi(2)).sqrt();
        }
        let signals: f64 = now.iter().map(|n| n.2).sum();
        let rms = (now.iter().map(|n| n.2 * n.1 * n.1).sum::<f64>() / signals.max(1.0)).sqrt();
        out.push((format!("+ {name}"), rms));
    }
    out.push(("after, what is immaterial adjusted".to_owned(), after));
    out.push(("noise floor".to_owned(), 1.0));
    out
}
