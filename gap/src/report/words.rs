//! The findings in sentences.

use crate::analysis::{Analysis, LinkGap, Named, Verdict, overall};
use crate::units;
use links::effect::Link;

/// Links in the order of the signals.
const CHAIN: [Link; 7] =
    [Link::Timing, Link::Command, Link::Controller, Link::Drive, Link::Motion, Link::Gyroscope, Link::Accelerometer];
/// Noise floors up to which a link agrees.
const AGREES: f64 = 1.3;

/// A named effect: where, how much, how sure.
pub(super) fn effect(e: &Named) -> String {
    let place = match &e.wheels[..] {
        [] => String::new(),
        [one] => format!(" on wheel {one}"),
        many => format!(" on wheels {}", list(many)),
    };
    let values: Vec<String> = e
        .parameters
        .iter()
        .map(|(name, x, ci)| format!("{} {}", units::label(name), units::interval(name, *x, ci.ends())))
        .collect();
    format!(
        "{}{place}: {}. Without it {} of the {} link's squared gap come back.",
        e.name,
        values.join(", "),
        percent(e.gain),
        e.link.name()
    )
}

/// A share for people.
pub(super) fn percent(share: f64) -> String {
    if (0.0..0.01).contains(&share) { "less than 1 %".to_owned() } else { format!("{:.0} %", 100.0 * share) }
}

/// What became of effects that came from the user: each has its line, named or not.
pub(super) fn own(a: &Analysis) -> Vec<String> {
    let of_user = |name: &&String| links::effects::find(name).is_none();
    let line = |name: &String| {
        if a.effects.iter().any(|e| e.name == *name) {
            return format!("{name}, an effect of yours, is named.");
        }
        if let Some(set) = a.alternatives.iter().find(|set| set.contains(name)) {
            let named: Vec<&str> = set.iter().filter(|n| *n != name).map(String::as_str).collect();
            return format!(
                "{name}, an effect of yours, is not named: here it cannot be told from {}.",
                named.join(", ")
            );
        }
        let limits: Vec<String> = a
            .limits
            .iter()
            .filter(|l| l.name == *name)
            .map(|l| {
                let (x, sd, limit) = (units::short(l.estimate), units::short(l.sd), units::short(l.limit));
                format!("{} is {x}, standard deviation {sd}, and named from {limit}", l.parameter)
            })
            .collect();
        if limits.is_empty() {
            return format!(
                "{name}, an effect of yours, is not named: these logs do not show it, or another effect hides it."
            );
        }
        format!("{name}, an effect of yours, is not named: {}.", limits.join("; "))
    };
    a.tried.iter().filter(of_user).map(line).collect()
}

/// Which links agree as they are, and which do not.
pub(super) fn links(a: &Analysis) -> String {
    let compared = |l: &Link| a.links.iter().find(|g| g.link == *l);
    let of = |agree: bool| -> Vec<&str> {
        let wanted = CHAIN.iter().filter(|l| compared(l).is_some_and(|g| (g.before <= AGREES) == agree));
        wanted.map(|l| l.name()).collect()
    };
    // A robot may have no inertial sensor, and then it lacks no signal of one.
    let missing: Vec<&str> =
        CHAIN.iter().filter(|l| compared(l).is_none() && !l.is_inertial()).map(|l| l.name()).collect();
    let mut out = match (&of(true)[..], &of(false)[..]) {
        (good, []) if matches!(a.verdict, Verdict::NotCompared) => format!("Nothing shows in {}.", join(good)),
        (good, []) => format!("Every link that could be compared agrees: {}.", join(good)),
        ([], bad) if matches!(a.verdict, Verdict::Agrees) => {
            format!("More than noise, but less than would be named, is in {}.", join(bad))
        }
        ([], bad) => format!("No link agrees as it is: {}.", join(bad)),
        (good, bad) => format!(
            "{} in {}; {} {} within its noise.",
            if matches!(a.verdict, Verdict::Agrees) {
                "More than noise, but too little to matter, is"
            } else {
                "The disagreement is"
            },
            join(bad),
            join(good),
            if good.len() == 1 { "agrees" } else { "agree, each" }
        ),
    };
    if !missing.is_empty() {
        out += &format!(" Not compared, for want of signals: {}.", join(&missing));
    }
    out
}

/// What to say beside the names where they leave a link further from its noise than one that agrees.
pub(super) fn and_more(a: &Analysis) -> String {
    // What slides drives no body as Newton has it: the name says so already.
    let slides = a.effects.iter().any(|e| e.name == "wheel-slip");
    let open = a.links.iter().filter(|l| l.link.is_fitted() && !(slides && l.link == Link::Drive));
    let worst = open.max_by(|x, y| x.after.total_cmp(&y.after)).filter(|l| l.after >= a.thresholds.far);
    worst.map_or_else(String::new, |l| {
        format!(", and more: {:.1} noise floors remain on the {} link", l.after, l.link.name())
    })
}

/// How the gap falls, and on which replayed links it does not: an exact replay differs by thousands of its floors, and
/// would hide what the names do elsewhere.
pub(super) fn falls(links: &[LinkGap], share: f64) -> String {
    let stays = |l: &&LinkGap| !l.link.is_fitted() && l.before > AGREES && l.after > share * l.before;
    let (stay, fall): (Vec<&LinkGap>, Vec<&LinkGap>) = links.iter().partition(stays);
    let fall: Vec<LinkGap> = fall.into_iter().cloned().collect();
    let (before, after) = overall(if fall.is_empty() { links } else { &fall });
    let mut out = format!("The gap falls from {before:.2} to {after:.2} noise floors.");
    for l in stay {
        out += &format!(" That of the {} link stays {:.1}.", l.link.name(), l.after);
    }
    out
}

/// A set that cannot be told apart: a name, and one other or two that together do the same.
pub(super) fn tied(set: &[String]) -> String {
    match set {
        [name, a, b] => format!("{name}, or {a} with {b}"),
        _ => set.join(", "),
    }
}

/// What the sizes of named effects depend on.
pub(super) fn conditions(a: &Analysis) -> Vec<String> {
    let of = |e: &Named| {
        format!(
            "The sizes of {} are those without {}: a part of it does the same, and how much is whose does not show here.",
            e.name,
            e.conditional_on.join(" and ")
        )
    };
    a.effects.iter().filter(|e| !e.conditional_on.is_empty()).map(of).collect()
}

fn join(names: &[&str]) -> String {
    match names {
        [] => String::new(),
        [one] => (*one).to_owned(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}

/// Numbers of wheels, with commas.
pub(super) fn list(wheels: &[usize]) -> String {
    wheels.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_replay_that_stays_wrong_does_not_hide_what_the_names_close() {
        let link = |link: Link, [before, after]: [f64; 2]| LinkGap {
            link,
            before,
            after,
            floor: vec![1.0; 4],
            rms: vec![[before, after]; 4],
            units: vec![""; 4],
            signals: 4,
        };
        let said =
            |controller: [f64; 2]| falls(&[link(Link::Controller, controller), link(Link::Drive, [9.0, 1.0])], 0.98);
        let stays = said([5721.0, 5721.0]);
        assert_eq!(stays, "The gap falls from 9.00 to 1.00 noise floors. That of the controller link stays 5721.0.");
        assert_eq!(said([9.0, 1.0]), "The gap falls from 9.00 to 1.00 noise floors.");
        assert_eq!(said([1.0, 1.0]), "The gap falls from 6.40 to 1.00 noise floors.");
    }
}
