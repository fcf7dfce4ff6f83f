//! The gap in figures: per link, over all signals, and how it falls.

use std::sync::Arc;

use runs::robot::{Robot, Support};

use super::found::{LinkGap, Named};
use crate::exact::ExactLink;
use crate::limits::Limit;
use crate::locate::Located;
use crate::thresholds::Thresholds;
use crate::units;
use links::drive::{DriveLink, DriveResiduals};
use links::effect::{Effect, Link, Sizes};
use links::inertial::{self, Fit};
use links::motion::{MotionLink, WindowResiduals};
use links::pieces::Pieces;

pub(super) fn motion_gap([before, after]: [f64; 2], link: &MotionLink, plots: &[Vec<WindowResiduals>; 2]) -> LinkGap {
    let (noise, axes) = (link.unit(), link.axes());
    let rms = |side: usize, i: usize| {
        noise[i]
            * estimation::statistics::rms(
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
        floor: noise[..axes].to_vec(),
        rms: (0..axes).map(|i| [rms(0, i), rms(1, i)]).collect(),
        units: vec!["m", "m", "rad"][..axes].to_vec(),
        signals: axes,
    }
}

pub(super) fn inertial_gap(link: Link, before: &[Fit], after: &[Fit]) -> LinkGap {
    LinkGap {
        link,
        before: inertial::overall(before),
        after: inertial::overall(after),
        floor: after.iter().map(|f| f.floor).collect(),
        rms: before.iter().zip(after).map(|(a, b)| [a.rms, b.rms]).collect(),
        units: after.iter().map(|f| f.channel.unit()).collect(),
        signals: after.len(),
    }
}

pub(super) fn drive_gap([before, after]: [f64; 2], floor: &[f64], plots: &[DriveResiduals; 2]) -> LinkGap {
    let rms = |side: usize, i: usize| {
        let d = &plots[side];
        estimation::statistics::rms(d.torque.iter().zip(&d.weights).filter(|(_, w)| w[i] > 0.0).map(|(t, _)| t[i]))
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
        estimation::statistics::rms(
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

/// Gap of the motion link that matters, in noise floors.
pub(super) fn motion_matters(link: &MotionLink, thresholds: &Thresholds) -> f64 {
    let ([x, y, theta], [way, turn]) = (link.unit(), agreement(link, thresholds));
    let way = way / x.max(y);
    2.0_f64.max(if link.axes() == 2 { way } else { way.min(turn / theta) })
}

/// Way, m, and turn, rad, of a window up to which wheels and poses part without that it matters.
pub(super) fn agreement(link: &MotionLink, thresholds: &Thresholds) -> [f64; 2] {
    let robot = link.pieces.robot();
    let rolled = link.pieces.speed() * robot.wheel_radius_m * link.rolled_s();
    [thresholds.matters[0] * rolled, thresholds.matters[1] * rolled / Sizes::of(robot).rim_m]
}

/// Torque that no model of the drive predicts, Nm, one a wheel: the scatter, and what rolling loses or
/// the warmth of a winding takes.
pub(super) fn drive_floor(link: &DriveLink, scatter: &[f64], thresholds: &Thresholds) -> Vec<f64> {
    let lost = match link.pieces.robot().support {
        Support::Floor => thresholds.rolling_loses * link.sizes.drive_nm,
        Support::Blocks => thresholds.warmth * link.sizes.drive_nm,
    };
    scatter.iter().map(|s| s.hypot(lost)).collect()
}

/// The RMS of that floor in units of the scatter.
pub(super) fn floor_of_scatter(link: &DriveLink, scatter: &[f64], thresholds: &Thresholds) -> f64 {
    let rms = |nm: &[f64]| estimation::statistics::rms(nm.iter().copied());
    rms(&drive_floor(link, scatter, thresholds)) / rms(scatter)
}

/// What is left on a link after everything that is named.
pub(super) enum Remains {
    /// So much, and so little explained, that the link stays open.
    Open(String),
    /// Something, beside what is named.
    Beside(String),
}

/// What to say of a link of motion or drive on which more than noise is left.
pub(super) fn remains(link: &LinkGap, located: &[Located], felt: &[Fit], thresholds: &Thresholds) -> Option<Remains> {
    if !link.link.is_fitted() || link.after < thresholds.worth_saying {
        return None;
    }
    let open = |rms: f64| (rms * rms - 1.0).max(0.0);
    // The signal on which most is left.
    let worst = (0..link.rms.len()).max_by(|a, b| {
        let left = |i: &usize| link.rms[*i][1] / link.floor[*i].max(1e-300);
        left(a).total_cmp(&left(b))
    })?;
    let names = |i: usize| match link.link {
        Link::Motion => ["cam_x", "cam_y", "cam_theta"][i].to_owned(),
        Link::Gyroscope | Link::Accelerometer => felt
            .iter()
            .filter(|f| f.channel.link() == link.link)
            .nth(i)
            .map_or_else(String::new, |f| f.channel.column().to_owned()),
        _ => format!("enc_{}", i + 1),
    };
    let place =
        located.iter().find(|l| l.link == link.link && l.signal == names(worst)).map_or_else(String::new, |l| {
            l.place.rsplit_once("most in ").map_or_else(String::new, |(_, at)| format!(", most in {at}"))
        });
    let left = link.rms[worst][1];
    let milli = |unit: &str| format!("{:.2} {unit}", 1e3 * left);
    let size = match link.units[worst] {
        "m" => milli("mm"),
        "Nm" => units::torque(left),
        "rad/s" => milli("mrad/s"),
        "m/s²" => milli("mm/s²"),
        _ => milli("mrad"),
    };
    let sentence = format!(
        "{:.1} noise floors remain on the {} link ({} {size} RMS{place}), which no effect of the catalogue explains",
        link.after,
        link.link.name(),
        names(worst),
    );
    let most = if link.after < thresholds.far_open { 1.0 - thresholds.explained } else { thresholds.undecided };
    let sentence = if link.link == Link::Motion && link.after >= thresholds.far_open {
        format!("{sentence}; wheels that slip, and poses that a filter smoothed before they were logged, leave as much")
    } else {
        sentence
    };
    let explained = open(link.after) < most * open(link.before);
    Some(if link.after >= thresholds.far && !explained { Remains::Open(sentence) } else { Remains::Beside(sentence) })
}

/// Links without a moment that could show anything, and what would be needed.
pub(super) fn weightless(pieces: &Pieces, drive: Option<&DriveResiduals>) -> Vec<(Link, String)> {
    let mut out = Vec::new();
    let turned = |s: &links::segment::Segment| {
        s.angle.iter().map(|a| a.iter().fold(0.0_f64, |most, x| most.max((x - a[0]).abs()))).fold(0.0, f64::max)
    };
    let counted = pieces.iter().any(|s| !s.angle.is_empty());
    let most = pieces.iter().map(|s| turned(&s)).fold(0.0, f64::max);
    let used = drive.is_some_and(|drive| drive.weights.iter().flatten().any(|w| *w > 0.0));
    if counted && most < STILL && !used {
        let why = format!(
            "Compared nothing, for no wheel turns by more than {most:.3} rad; drive a metre, and turn once on the spot."
        );
        // What stands still follows any command and any law.
        let all = [Link::Command, Link::Controller, Link::Drive, Link::Motion, Link::Gyroscope, Link::Accelerometer];
        return all.map(|link| (link, why.clone())).to_vec();
    }
    if drive.is_some() && !used {
        let fastest = pieces.iter().flat_map(|s| s.speed.concat()).fold(0.0_f64, |a, b| a.max(b.abs()));
        out.push((
            Link::Drive,
            format!(
                "Drive: compared nothing, for no axis turns steadily (the fastest moment is {fastest:.2} rad/s at the \
                 wheel); drive each axis for seconds in both directions at several duties."
            ),
        ));
    }
    out
}

/// Whether any effect of a link has a limit from which it would be named.
pub(super) fn has_limits(link: Link, limits: &[Limit], catalogue: &[Arc<dyn Effect>]) -> bool {
    !least_limits(link, limits, catalogue).is_empty()
}

/// The least limit of every effect of a link that has one, in sizes that matter, from the least on.
fn least_limits<'a>(link: Link, limits: &'a [Limit], catalogue: &[Arc<dyn Effect>]) -> Vec<(f64, &'a Limit)> {
    let own = catalogue.iter().filter(|e| e.link() == link);
    let least = own.filter_map(|e| {
        let own = limits.iter().filter(|l| l.name == e.name() && l.material > 0.0);
        own.map(|l| (l.limit / l.material, l)).min_by(|a, b| a.0.total_cmp(&b.0))
    });
    let mut least: Vec<(f64, &Limit)> = least.collect();
    least.sort_by(|a, b| a.0.total_cmp(&b.0));
    least
}

/// Why it says nothing that no effect shows on a link: what would be named there is many times what matters.
pub(super) fn blind(
    gap: &LinkGap,
    limits: &[Limit],
    catalogue: &[Arc<dyn Effect>],
    robot: &Robot,
    thresholds: &Thresholds,
) -> Option<(Link, String)> {
    let (link, most) = (gap.link, thresholds.blind);
    let least = least_limits(link, limits, catalogue);
    let named = match least.get(least.len() / 2) {
        Some((ratio, _)) if *ratio > most => {
            format!("most effects would be named there from {ratio:.0} times what matters, or more")
        }
        Some(_) => return None,
        None => "these logs are too short for anything to be named there".to_owned(),
    };
    let mut why = format!(
        "Compared next to nothing on the {} link: {named}; log longer, more runs, and both directions at several speeds.",
        link.name()
    );
    // Behind a rotor that is a thirtieth of what turns no law shows: neither friction nor the weight of an arm.
    let rotor_alone = robot.support == Support::Blocks && robot.wheel_inertia_kg_m2 == 0.0;
    if link == Link::Drive && rotor_alone && gap.before > thresholds.far_left {
        why += " The file has the rotor alone (wheel_inertia_kg_m2 = 0): where the axis moves an arm or another load, write its \
                inertia.";
    }
    Some((link, why))
}

/// Turn of a wheel that shows nothing, rad: less than a degree.
const STILL: f64 = 0.01;

/// How a step begins that takes effects out of the file.
pub(super) const WITHOUT: &str = "without ";

/// The figures of all links as the file's effects are added one by one, in its order; nothing is fitted between.
pub(super) fn waterfall(
    links: &[LinkGap],
    steps: &[(String, Vec<(Link, f64)>)],
    named: &[Named],
) -> Vec<(String, f64)> {
    let (before, after) = overall(links);
    let mut out = vec![("nominal model".to_owned(), before)];
    let mut now: Vec<LinkGap> = links.to_vec();
    now.iter_mut().for_each(|l| l.after = l.before);
    for n in named.iter().filter(|n| !n.link.is_fitted()) {
        for (slot, l) in now.iter_mut().zip(links).filter(|(slot, _)| slot.link == n.link) {
            slot.after = l.after;
        }
        out.push((format!("+ {}", n.name), overall(&now).1));
    }
    for (name, figures) in steps {
        for (link, rms) in figures {
            now.iter_mut().filter(|l| l.link == *link).for_each(|l| l.after = *rms);
        }
        let said = if name.starts_with(WITHOUT) { name.clone() } else { format!("+ {name}") };
        out.push((said, overall(&now).1));
    }
    debug_assert!(now.iter().zip(links).all(|(a, b)| (a.after - b.after).abs() < 1e-6 * b.after.max(1.0)), "{after}");
    out.push(("noise floor".to_owned(), 1.0));
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_axis_that_shows_nothing_may_have_a_load_that_its_file_lacks() {
        let said = |before: f64, link: Link, robot: &Robot| {
            let (floor, rms) = (vec![1e-4], vec![[1e-4 * before; 2]]);
            let gap = LinkGap { link, before, after: before, floor, rms, units: vec!["Nm"], signals: 1 };
            blind(&gap, &[], &[], robot, &Thresholds::default()).unwrap().1
        };
        let axis = Robot { support: Support::Blocks, ..Robot::racbot() };
        let loaded = Robot { wheel_inertia_kg_m2: 0.3, ..axis.clone() };
        let hinted = |said: String| said.contains("wheel_inertia_kg_m2 = 0");
        assert!(hinted(said(70.9, Link::Drive, &axis)));
        for (before, link, robot) in [
            (1.2, Link::Drive, &axis),
            (70.9, Link::Motion, &axis),
            (70.9, Link::Drive, &loaded),
            (70.9, Link::Drive, &Robot::racbot()),
        ] {
            assert!(!hinted(said(before, link, robot)), "{before} {}", link.name());
        }
    }

    #[test]
    fn what_leaves_tens_of_floors_must_close_most_of_a_gap_to_explain_it() {
        let left = |before: f64, after: f64| {
            let (floor, rms) = (vec![1e-4; 2], vec![[1e-4 * before, 1e-4 * after]; 2]);
            let link = LinkGap { link: Link::Motion, before, after, floor, rms, units: vec!["m"; 2], signals: 2 };
            remains(&link, &[], &[], &Thresholds::default())
        };
        // Half of the square is enough near the noise, and not far from it.
        for (before, after, open) in [(8.0, 5.0, false), (8.0, 6.5, true), (55.0, 35.0, true), (90.0, 35.0, false)] {
            let Some(Remains::Open(said) | Remains::Beside(said)) = &left(before, after) else { panic!("{before}") };
            assert_eq!(matches!(left(before, after), Some(Remains::Open(_))), open, "{before} {after}");
            assert_eq!(said.contains("a filter smoothed"), after > 10.0, "{said}");
        }
    }
}
