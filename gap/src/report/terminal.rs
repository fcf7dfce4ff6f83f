//! The summary for a terminal.

use std::fmt::Write as _;

use super::{firmware, words};
use crate::analysis::{Analysis, BEGINS, Verdict, overall};
use crate::units::{self, short};

/// Columns of a terminal.
const WIDTH: usize = 80;

pub(super) fn summary(a: &Analysis) -> String {
    let mut out = String::new();
    wrap(&mut out, "", &sentence(a));
    wrap(&mut out, "", &words::links(a));
    if !a.located.is_empty() {
        out.push_str("\nWhere\n");
        for l in a.located.iter().take(8) {
            wrap(&mut out, "  ", &format!("{} ({}): {:.1} x floor; {}", l.signal, l.link.name(), l.excess, l.place));
        }
    }
    if !a.effects.is_empty() {
        out.push_str("\nWhat\n");
        for e in &a.effects {
            let on = if e.wheels.is_empty() { String::new() } else { format!(" on wheel {}", words::list(&e.wheels)) };
            wrap(
                &mut out,
                "  ",
                &format!(
                    "{}{on}: closes {} of the link's squared gap, {}",
                    e.name,
                    words::percent(e.gain),
                    e.evidence.words()
                ),
            );
            for (name, v, known) in &e.parameters {
                let people = units::value(name, *v);
                let known = known
                    .ends()
                    .map_or_else(String::new, |[lo, hi]| format!("{} {} to {}", known.label(), short(lo), short(hi)));
                let line = format!("    {name:<22} {:>9}  {known}  {people}", short(*v));
                let _ = writeln!(out, "{}", line.chars().take(WIDTH).collect::<String>().trim_end());
            }
        }
    }
    for line in words::own(a) {
        wrap(&mut out, "  ", &line);
    }
    for set in &a.alternatives {
        wrap(&mut out, "  ", &format!("cannot be told apart: {}", words::tied(set)));
    }
    for line in words::conditions(a) {
        wrap(&mut out, "  ", &line);
    }
    for u in &a.unexplained {
        wrap(&mut out, "  ", &format!("unexplained ({}): {}", u.link.name(), u.structure));
    }
    if let Some(e) = &a.next_experiment {
        let times = if e.times > 1 { format!(", {} times", e.times) } else { String::new() };
        wrap(&mut out, "  ", &format!("next: {} ({}{times}, {:.0} s): {}", e.what, e.kind, e.seconds, e.why));
    }
    let (before, after) = overall(&a.links);
    let _ = writeln!(out, "\nGap (RMS in noise floors, as written)  before {before:8.2}   after {after:8.2}");
    for l in &a.links {
        let _ = writeln!(
            out,
            "  {:<12}                        before {:8.2}   after {:8.2}",
            l.link.name(),
            l.before,
            l.after
        );
    }
    for r in a.remains.iter().map(|r| format!("{r}.")).collect::<Vec<_>>().iter().chain(&a.remarks) {
        wrap(&mut out, "  ", r);
    }
    if let Some(found) = firmware::of(a) {
        out.push_str("\nInto your firmware, as found\n");
        out.push_str(&found.c_arrays());
    }
    if a.verdict == Verdict::Agrees {
        out.push_str("\nWould be named, nine times of ten, from\n");
        for l in &a.limits {
            let _ = writeln!(out, "  {:<22} {:<20} {:>10}", l.name, l.parameter, short(l.limit));
        }
    }
    out
}

/// The verdict in one sentence.
pub(super) fn sentence(a: &Analysis) -> String {
    let names: Vec<String> = a
        .effects
        .iter()
        .map(|e| {
            if e.wheels.is_empty() { e.name.clone() } else { format!("{} (wheel {})", e.name, words::list(&e.wheels)) }
        })
        .collect();
    match a.verdict {
        Verdict::Agrees if !a.remains.is_empty() => {
            let (_, after) = overall(&a.links);
            format!("Model and data agree to {after:.1} noise floors: what is left has no name.")
        }
        Verdict::Agrees if !a.links.iter().any(|l| l.link.is_fitted()) => {
            "What could be compared agrees, and that is no motor and no way of the robot.".to_owned()
        }
        Verdict::Agrees => "Model and data agree: nothing material is missing.".to_owned(),
        Verdict::NotCompared => "Nothing could be compared: nothing in these logs has any weight.".to_owned(),
        Verdict::MissingEffect => {
            format!(
                "Missing in the model: {}{}. {}",
                names.join(", "),
                words::and_more(a),
                words::falls(&a.links, a.thresholds.falls)
            )
        }
        Verdict::Ambiguous => format!(
            "Something is missing: {}, or what cannot be told from it here{}. {}",
            names.join(", "),
            words::and_more(a),
            words::falls(&a.links, a.thresholds.falls)
        ),
        Verdict::Unexplained => {
            let first = a.unexplained.first().map_or(String::new(), |u| format!(": {}", u.structure));
            let near = if a.nearest.is_empty() {
                String::new()
            } else {
                format!(" Nearest in the catalogue: {}.", a.nearest.join(", "))
            };
            // A structure may be a small part of what is left.
            let more = if first.contains("floors remain") { String::new() } else { words::and_more(a) };
            let stop = if more.is_empty() && first.ends_with('?') { "" } else { "." };
            // One effect of several sizes is one of the catalogue.
            let and = if first.starts_with(&format!(": {BEGINS}")) {
                ""
            } else {
                ", and no effect of the catalogue explains it"
            };
            format!("Model and data disagree{and}{first}{more}{stop}{near}")
        }
    }
}

fn wrap(out: &mut String, indent: &str, text: &str) {
    let mut line = indent.to_owned();
    for word in text.split_whitespace() {
        if line.trim_end().chars().count() + 1 + word.chars().count() > WIDTH && line.trim() != "" {
            out.push_str(line.trim_end());
            out.push('\n');
            line = format!("{indent}  ");
        }
        line.push_str(word);
        line.push(' ');
    }
    out.push_str(line.trim_end());
    out.push('\n');
}
