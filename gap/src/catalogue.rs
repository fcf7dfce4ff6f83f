//! The catalogue as people read it: a line or a page an effect, from the effects' own descriptions.

#[cfg(test)]
mod picture;
mod stranger;
mod twins;

use std::fmt::Write as _;

use model::effects::Applied;
use runs::robot::{Effect as Written, EffectParameter, Robot};

use crate::units::{short, si as unit};
use links::effect::{Effect, Link};
use links::effects::{catalogue_for, exact_equation};

pub use stranger::{Stranger, strangers};

/// Effects of the links that are replayed instead of fitted.
const EXACT: [(&str, Link, &[&str]); 5] = [
    ("command-latency", Link::Command, &["latency_s"]),
    ("pi-gain", Link::Controller, &["kp_scale", "ki_scale"]),
    ("integrator-windup", Link::Controller, &["limit_duty"]),
    ("quantisation", Link::Controller, &["duty_quantum"]),
    ("sample-order", Link::Controller, &["signal", "shift_ticks"]),
];

/// What the catalogue says of an effect.
#[derive(Debug, Clone, PartialEq)]
pub struct Description {
    /// Name, kebab-case.
    pub name: String,
    /// Links in which it shows, the one in which it is fitted first.
    pub links: Vec<Link>,
    /// What it is, with its equation.
    pub equation: String,
    /// Where it is described; empty where it is everybody's.
    pub reference: String,
    /// Its parameters, for the paper's robot.
    pub parameters: Vec<Range>,
    /// A measurement without driving that settles it, and the minutes it takes.
    pub measurement: Option<(String, f64)>,
    /// Whether `racbot simulate --hidden` has it.
    pub simulated: bool,
}

/// A parameter and what it may be.
#[derive(Debug, Clone, PartialEq)]
pub struct Range {
    /// Name, ending in its unit.
    pub name: String,
    /// Its unit in words; empty for a ratio.
    pub unit: &'static str,
    /// Physical bounds, where the effect is fitted.
    pub bounds: Option<[f64; 2]>,
    /// Size from which it is worth a name; `None` where any is.
    pub material: Option<f64>,
}

/// Every effect, in the order of the links from command to camera.
pub fn descriptions() -> Vec<Description> {
    let robot = Robot::racbot();
    let mut all: Vec<Description> =
        catalogue_for(2).iter().filter(|e| !e.probe()).map(|e| describe(e.as_ref(), &robot)).collect();
    for (name, link, parameters) in EXACT {
        let range = |name: &&str| Range { name: (*name).to_owned(), unit: unit(name), bounds: None, material: None };
        let parameters: Vec<Range> = parameters.iter().map(range).collect();
        all.push(Description {
            simulated: simulated(name, &parameters, &robot),
            name: name.to_owned(),
            links: vec![link],
            equation: exact_equation(name).to_owned(),
            reference: String::new(),
            parameters,
            measurement: None,
        });
    }
    all.sort_by(|a, b| (a.links[0], &a.name).cmp(&(b.links[0], &b.name)));
    all
}

fn describe(effect: &dyn Effect, robot: &Robot) -> Description {
    let mut parameters: Vec<Range> = Vec::new();
    // Wheels have the same bounds; one of each name stands for all.
    let is_number = |part: &str| part.parse::<usize>().is_ok();
    let plain =
        |name: &str| name.split('_').map(|part| if is_number(part) { "i" } else { part }).collect::<Vec<_>>().join("_");
    let rolled = links::effects::rolled_creep();
    let second = if rolled.name() == effect.name() { rolled.forms(robot) } else { Vec::new() };
    for p in effect.forms(robot).iter().chain(&second).flat_map(|form| &form.free) {
        let numbered = p.name.split('_').any(is_number);
        let name = if numbered { plain(&p.name) } else { p.name.clone() };
        if parameters.iter().all(|known| known.name != name) {
            let material = Some(p.below.unwrap_or(p.material)).filter(|m| m.is_finite() && *m > 0.0);
            parameters.push(Range { unit: unit(&p.name), name, bounds: Some(p.bounds), material });
        }
    }
    let reference = Some(effect.reference()).filter(|r| *r != "-").unwrap_or_default();
    Description {
        name: effect.name().to_owned(),
        links: std::iter::once(effect.link()).chain(effect.also()).collect(),
        equation: effect.equation().to_owned(),
        reference: reference.to_owned(),
        measurement: effect.measurement().map(|(how, minutes)| (how.to_owned(), minutes)),
        simulated: simulated(effect.name(), &parameters, robot),
        parameters,
    }
}

/// Whether the simulator knows an effect of this name.
fn simulated(name: &str, parameters: &[Range], robot: &Robot) -> bool {
    let value = |p: &Range| EffectParameter { value: p.material.unwrap_or(0.01), ..EffectParameter::default() };
    let parameters = parameters.iter().map(|p| (p.name.replace("_i", "_1"), value(p))).collect();
    let written = Written { name: name.to_owned(), parameters, ..Written::default() };
    Applied::of(&Robot { effects: vec![written], ..robot.clone() }).unsupported.is_empty()
}

impl Description {
    /// The part of the equation before its first semicolon or colon: a line of a list.
    pub fn short(&self) -> &str {
        self.equation.split([';', ':']).next().unwrap_or(&self.equation)
    }

    /// Effects that cannot be told from it: by any drive, and besides by one without turns.
    #[must_use]
    pub fn twins(&self) -> [&'static [&'static str]; 2] {
        twins::of(&self.name)
    }

    /// `racbot gap --list NAME`, and the same as a page of the book.
    pub fn markdown(&self) -> String {
        let links: Vec<&str> = self.links.iter().map(|link| link.name()).collect();
        let mut out = format!("# {}\n\n{}.\n\n", self.name, capital(&self.equation).trim_end_matches('.'));
        let shown = if links.len() > 1 { format!("; shows in {} too", links[1..].join(", ")) } else { String::new() };
        let how = if self.parameters.iter().any(|p| p.bounds.is_some()) { "fitted" } else { "replayed" };
        let _ = writeln!(out, "Link: {how} in {}{shown}.\n", links[0]);
        if !self.parameters.is_empty() {
            out.push_str("| parameter | unit | within | worth a name from |\n|---|---|---|---|\n");
            for p in &self.parameters {
                let unit = if p.unit.is_empty() { "1" } else { p.unit };
                let within = p.bounds.map_or("–".to_owned(), |[lo, hi]| format!("{} to {}", short(lo), short(hi)));
                let material = p.material.map_or("–".to_owned(), short);
                let _ = writeln!(out, "| `{}` | {unit} | {within} | {material} |", p.name);
            }
            out.push_str("\nBounds and sizes are those of the paper's robot; `i` is a wheel's number.\n\n");
        }
        let [always, square] = self.twins().map(|names| names.join(", "));
        if !always.is_empty() {
            let _ = writeln!(
                out,
                "Twins, which do the same in a square, a star, a chirp and hard stops together: {always}.\n"
            );
        }
        if !square.is_empty() {
            let _ = writeln!(out, "Twins in a square without turns alone: {square}.\n");
        }
        if let Some((how, minutes)) = &self.measurement {
            let unit = if *minutes == 1.0 { "minute" } else { "minutes" };
            let _ = writeln!(out, "To measure it without driving: {how} ({minutes} {unit}).\n");
        }
        if !self.reference.is_empty() {
            let _ = writeln!(out, "Source: {}.\n", self.reference);
        }
        let seen = if self.simulated {
            "`racbot simulate --hidden` hides it in a simulated robot."
        } else {
            "It is an effect of logs; the simulator does not have it."
        };
        let _ = writeln!(out, "{seen}");
        out
    }
}

fn capital(text: &str) -> String {
    let mut letters = text.chars();
    // Symbols stay what they are: `w` is no `W`.
    let word = text.split_whitespace().next().unwrap_or_default();
    if word.len() < 3 || !word.chars().all(char::is_alphabetic) {
        return text.to_owned();
    }
    letters.next().into_iter().flat_map(char::to_uppercase).chain(letters).collect()
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use estimation::parallel::each;

    use super::*;

    /// The page of an effect, with its picture before the rest where there is one.
    fn page(d: &Description, picture: bool) -> String {
        let (head, rest) = d.markdown().split_once("\n\nLink:").map(|(a, b)| (a.to_owned(), b.to_owned())).unwrap();
        let image =
            if picture { format!("\n\n![With and without it, simulated]({}.svg)", d.name) } else { String::new() };
        format!("{head}{image}\n\nLink:{rest}")
    }

    fn pages() -> Vec<(String, String)> {
        let all = descriptions();
        let mut list = String::from(
            "# The catalogue of effects\n\nGenerated from the effects' own descriptions, as `racbot gap --list` prints them.\n\n\
             | effect | link | what |\n|---|---|---|\n",
        );
        for d in &all {
            let what = d.short().replace('|', "\\|");
            let _ = writeln!(list, "| [{0}](effects/{0}.md) | {1} | {what} |", d.name, d.links[0].name());
        }
        let mut pages = vec![("effects.md".to_owned(), list)];
        let drawn: Vec<(&Description, Option<String>)> = all
            .iter()
            .zip(each(&all, &|d| picture::picture(&d.name, d.links[0], links::effects::find(&d.name).as_deref())))
            .collect();
        for (d, picture) in drawn {
            pages.push((format!("effects/{}.md", d.name), page(d, picture.is_some())));
            pages.extend(picture.map(|svg| (format!("effects/{}.svg", d.name), svg)));
        }
        pages
    }

    /// `RACBOT_MEASURED=write cargo test -p gap --lib catalogue` writes them.
    #[test]
    fn the_books_pages_are_what_the_effects_say() {
        let book = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/book/src");
        let write = std::env::var("RACBOT_MEASURED").as_deref() == Ok("write");
        let pages = pages();
        for (name, text) in &pages {
            let path = book.join(name);
            if write {
                std::fs::create_dir_all(path.parent().unwrap()).unwrap();
                std::fs::write(&path, text).unwrap();
            }
            let found = std::fs::read_to_string(&path).unwrap_or_default();
            assert_eq!(&found, text, "docs/book/src/{name} is not current: RACBOT_MEASURED=write");
        }
        let summary = std::fs::read_to_string(book.join("SUMMARY.md")).unwrap();
        for (name, _) in pages.iter().filter(|(name, _)| name.ends_with(".md")) {
            assert!(summary.contains(&format!("({name})")), "{name} is in no chapter list");
        }
        let kept = std::fs::read_dir(book.join("effects")).unwrap().count();
        assert_eq!(kept, pages.len() - 1, "a page or picture of an effect that is none");
        let pictures: Vec<usize> =
            pages.iter().filter(|(name, _)| name.ends_with(".svg")).map(|(_, svg)| svg.len()).collect();
        assert!(pictures.len() > 40 && pictures.iter().all(|bytes| *bytes < 12_000), "{pictures:?}");
    }

    #[test]
    fn every_effect_says_what_it_is() {
        let all = descriptions();
        assert!(all.len() > 40 && all.windows(2).all(|w| w[0].name != w[1].name));
        for d in &all {
            assert!(d.equation.len() > 20, "{d:?}");
            assert!(d.parameters.iter().all(|p| p.bounds.is_none_or(|[low, high]| low < high)), "{d:?}");
        }
        let skew = all.iter().find(|d| d.name == "wheel-skew").unwrap();
        assert!(skew.simulated && skew.parameters[0].name == "skew_i_rad" && skew.parameters[0].unit == "rad");
    }
}
