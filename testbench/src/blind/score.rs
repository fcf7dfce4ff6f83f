//! How an answer compares with what was hidden.

use serde::{Deserialize, Serialize};
use truth::{Hidden, Truth};

use super::{Answer, Group, NamedEffect, Task};

/// How good an answer is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Grade {
    /// Exactly what is hidden, nothing else.
    Right,
    /// What is hidden stands in a set of look-alikes with what is named, and nothing else is named.
    Within,
    /// Right or within, and more besides; with nothing hidden, that something is missing, without a name.
    Extra,
    /// Several are hidden, some are found, nothing else is named.
    Partial,
    /// Nothing named.
    Nothing,
    /// Something else is named, or the right effect on the wrong wheel.
    Wrong,
    /// The workflow gave up.
    Failed,
}

impl Grade {
    /// In the order of the table.
    pub const ALL: [Self; 7] =
        [Self::Right, Self::Within, Self::Extra, Self::Partial, Self::Nothing, Self::Wrong, Self::Failed];

    /// As in the table.
    pub fn name(self) -> &'static str {
        match self {
            Self::Right => "right",
            Self::Within => "within",
            Self::Extra => "extra",
            Self::Partial => "partial",
            Self::Nothing => "nothing",
            Self::Wrong => "wrong",
            Self::Failed => "failed",
        }
    }

    /// Right, or within the stated set.
    pub fn is_good(self) -> bool {
        matches!(self, Self::Right | Self::Within)
    }
}

const SLIP: &str = "wheel-slip";

/// Whether an effect was found by name, only as a look-alike, or not.
fn found(hidden: &Hidden, answer: &Answer) -> Option<Grade> {
    let named = answer.effects.iter().find(|e| e.name == hidden.name);
    if let Some(named) = named {
        let apart = !hidden.wheels.is_empty()
            && !named.wheels.is_empty()
            && !hidden.wheels.iter().any(|w| named.wheels.contains(w));
        return (!apart).then_some(Grade::Right);
    }
    answer.effects.iter().any(|e| look_alikes(&e.name, &hidden.name, answer)).then_some(Grade::Within)
}

/// Whether a stated set holds both names.
fn look_alikes(a: &str, b: &str, answer: &Answer) -> bool {
    answer.alternatives.iter().any(|set| [a, b].iter().all(|name| set.iter().any(|n| n == name)))
}

/// Whether every named effect stands for a hidden one of its own.
fn each_stands(named: &[NamedEffect], hidden: &[&Hidden], answer: &Answer) -> bool {
    let Some((first, rest)) = named.split_first() else { return true };
    (0..hidden.len()).any(|i| {
        let mut others = hidden.to_vec();
        let own = others.swap_remove(i);
        (first.name == own.name || look_alikes(&first.name, &own.name, answer)) && each_stands(rest, &others, answer)
    })
}

/// Grades an answer against what is hidden. With nothing hidden, `Right` is to name nothing and to see nothing.
pub fn grade(hidden: &[Hidden], answer: &Answer) -> Grade {
    if hidden.is_empty() {
        return match answer.effects.is_empty() {
            true if answer.verdict == "unexplained" => Grade::Extra,
            true => Grade::Right,
            false => Grade::Wrong,
        };
    }
    if answer.effects.is_empty() {
        return Grade::Nothing;
    }
    let hits: Vec<Grade> = hidden.iter().filter_map(|h| found(h, answer)).collect();
    let more = !each_stands(&answer.effects, &hidden.iter().collect::<Vec<_>>(), answer);
    match (hits.len(), more) {
        (0, _) => Grade::Wrong,
        (n, true) if n == hidden.len() => Grade::Extra,
        (_, true) => Grade::Wrong,
        (n, false) if n < hidden.len() => Grade::Partial,
        _ if hits.contains(&Grade::Within) => Grade::Within,
        _ => Grade::Right,
    }
}

/// One set and its score.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Scored {
    /// Where it is counted.
    pub group: Group,
    /// Seed of the set.
    pub seed: u64,
    /// Hidden effects, those of the catalogue and others.
    pub hidden: Vec<Hidden>,
    /// Grade; for an effect outside the catalogue, `Right` is to say "none of these".
    pub grade: Grade,
    /// The answer, or why there is none.
    pub answer: Result<Answer, String>,
    /// 95 % intervals of parameters that truth and answer share: how many, and how many hold the true value.
    pub intervals: [usize; 2],
    /// True size in units of the stated detection limit, where one is stated; of several effects the smallest.
    pub limits: Option<f64>,
    /// Seconds of the analysis.
    pub seconds: f64,
}

impl Scored {
    pub(super) fn new(task: &Task, sealed: &Truth, answer: Result<Answer, String>, seconds: f64) -> Self {
        let hidden: Vec<Hidden> = sealed.effects.iter().chain(&sealed.outside).cloned().collect();
        let mut out = Self {
            group: task.group,
            seed: task.seed,
            hidden,
            grade: Grade::Failed,
            answer,
            intervals: [0, 0],
            limits: None,
            seconds,
        };
        if let Ok(answer) = &out.answer {
            let answer = &beside_its_floor(sealed, answer);
            out.grade = if sealed.outside.is_empty() { grade(&sealed.effects, answer) } else { outside(answer) };
            out.intervals = intervals(&sealed.effects, answer);
            out.limits = in_limits(&sealed.effects, answer);
        }
        out
    }

    /// Largest size level hidden; 0 if nothing is.
    pub fn size(&self) -> u8 {
        self.hidden.iter().map(|h| h.size).max().unwrap_or(0)
    }

    /// Share of the gap closed, where something is named.
    pub fn closed(&self) -> Option<f64> {
        self.answer.as_ref().ok().and_then(|a| a.closed)
    }
}

/// The answer without wheels that slip on the floor that the set is drawn on: true, and not what is hidden. Sliding friction is
/// drawn as a share of the static one.
fn beside_its_floor(sealed: &Truth, answer: &Answer) -> Answer {
    let hidden = sealed.effects.iter().any(|h| h.name == SLIP);
    let Some(nuisance) = sealed.nuisance.as_ref().filter(|_| !hidden) else { return answer.clone() };
    let [least, most] = truth::SLIDING.map(|share| share * nuisance.friction_coefficient);
    let is_the_floor = |e: &NamedEffect| {
        let holds = |(name, _, [low, high]): &(String, f64, [f64; 2])| {
            name == "friction_coefficient" && *low <= most && least <= *high
        };
        e.name == SLIP && e.parameters.iter().any(holds)
    };
    let mut out = answer.clone();
    out.effects.retain(|e| !is_the_floor(e));
    out
}

/// "None of these" is right; what is named must at least be called the nearest.
fn outside(answer: &Answer) -> Grade {
    let demoted = answer.effects.iter().all(|e| answer.nearest.contains(&e.name));
    match () {
        () if answer.verdict == "unexplained" && demoted => Grade::Right,
        () if answer.effects.is_empty() => Grade::Nothing,
        () if !answer.unexplained.is_empty() => Grade::Extra,
        () => Grade::Wrong,
    }
}

fn intervals(hidden: &[Hidden], answer: &Answer) -> [usize; 2] {
    let mut out = [0, 0];
    // Two hidden effects that the answer says cannot be told apart have one size between them, that of neither.
    let merged = |h: &Hidden| {
        let with = |set: &Vec<String>| {
            set.len() == 2
                && set.contains(&h.name)
                && hidden.iter().any(|other| other.name != h.name && set.contains(&other.name))
        };
        answer.alternatives.iter().any(with)
    };
    for h in hidden.iter().filter(|h| !merged(h)) {
        for e in answer.effects.iter().filter(|e| e.name == h.name) {
            for (name, _, [low, high]) in &e.parameters {
                // A parameter that is known exactly has no interval to judge.
                if let Some(x) = h.parameters.get(name).filter(|_| high > low) {
                    out[0] += 1;
                    // A direction to and fro is the same after half a turn.
                    let turn = if name == "azimuth_rad" { std::f64::consts::PI } else { 0.0 };
                    out[1] += usize::from([0.0, turn, -turn].iter().any(|by| (*low..=*high).contains(&(x + by))));
                }
            }
        }
    }
    out
}

/// The smallest of the hidden effects in its stated limits; `None` where one of them has none. What is replayed tick by
/// tick needs none: it shows whatever its size.
fn in_limits(hidden: &[Hidden], answer: &Answer) -> Option<f64> {
    let of = |h: &Hidden| {
        if matches!(h.link, truth::Link::Timing | truth::Link::Command | truth::Link::Controller) {
            return Some(f64::MAX);
        }
        let own = answer.limits.iter().filter(|(name, _, limit)| *name == h.name && *limit > 0.0);
        own.filter_map(|(_, parameter, limit)| Some(h.parameters.get(parameter)?.abs() / limit)).max_by(f64::total_cmp)
    };
    let ratios: Option<Vec<f64>> = hidden.iter().map(of).collect();
    ratios?.into_iter().min_by(f64::total_cmp)
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;
    use crate::blind::NamedEffect;

    fn hide(name: &str, wheels: &[usize]) -> Hidden {
        Hidden {
            name: name.to_owned(),
            link: truth::Link::Motion,
            size: 3,
            wheels: wheels.to_vec(),
            parameters: BTreeMap::from([("scale_1".to_owned(), 0.01)]),
        }
    }

    fn say(names: &[(&str, &[usize])], alternatives: &[&[&str]]) -> Answer {
        let effect = |(name, wheels): &(&str, &[usize])| NamedEffect {
            name: (*name).to_owned(),
            wheels: wheels.to_vec(),
            parameters: vec![("scale_1".to_owned(), 0.011, [0.0095, 0.0125])],
        };
        Answer {
            verdict: if names.is_empty() { "agrees" } else { "missing-effect" }.to_owned(),
            effects: names.iter().map(effect).collect(),
            alternatives: alternatives.iter().map(|a| a.iter().map(|n| (*n).to_owned()).collect()).collect(),
            nearest: Vec::new(),
            unexplained: Vec::new(),
            closed: None,
            limits: vec![("wheel-radius".to_owned(), "scale_1".to_owned(), 0.004)],
        }
    }

    #[test]
    fn an_answer_gets_the_grade_it_deserves() {
        let radius = [hide("wheel-radius", &[1])];
        let graded = |names: &[(&str, &[usize])], sets: &[&[&str]]| grade(&radius, &say(names, sets));
        assert_eq!(graded(&[("wheel-radius", &[1])], &[]), Grade::Right);
        assert_eq!(graded(&[("wheel-radius", &[2])], &[]), Grade::Wrong);
        assert_eq!(graded(&[("encoder-scale", &[1])], &[&["encoder-scale", "wheel-radius"]]), Grade::Within);
        assert_eq!(graded(&[("encoder-scale", &[1])], &[]), Grade::Wrong);
        assert_eq!(graded(&[("encoder-scale", &[1])], &[&["body-radius", "wheel-radius"]]), Grade::Wrong);
        assert_eq!(graded(&[("wheel-radius", &[1]), ("floor-tilt", &[])], &[]), Grade::Extra);
        assert_eq!(graded(&[], &[]), Grade::Nothing);
        assert_eq!(grade(&[], &say(&[], &[])), Grade::Right);
        let sees = Answer { verdict: "unexplained".to_owned(), ..say(&[], &[]) };
        assert_eq!(grade(&[], &sees), Grade::Extra);
        assert_eq!(grade(&[], &say(&[("floor-tilt", &[])], &[])), Grade::Wrong);
        let both = [hide("wheel-radius", &[1]), hide("floor-tilt", &[])];
        assert_eq!(grade(&both, &say(&[("floor-tilt", &[])], &[])), Grade::Partial);
        assert_eq!(grade(&both, &say(&[("floor-tilt", &[]), ("wheel-radius", &[1])], &[])), Grade::Right);
        // Every name stands for one hidden effect: its own, or one that a set puts beside it.
        let sets: &[&[&str]] = &[&["wheel-radius", "encoder-scale"], &["carpet-grain", "floor-tilt"]];
        assert_eq!(grade(&both, &say(&[("wheel-radius", &[1]), ("carpet-grain", &[])], sets)), Grade::Within);
        assert_eq!(graded(&[("wheel-radius", &[1]), ("encoder-scale", &[1])], sets), Grade::Extra);
    }

    #[test]
    fn intervals_and_limits_are_counted_by_parameter_name() {
        let answer = say(&[("wheel-radius", &[1])], &[]);
        assert_eq!(intervals(&[hide("wheel-radius", &[1])], &answer), [1, 1]);
        assert_eq!(intervals(&[hide("body-radius", &[])], &answer), [0, 0]);
        let mut tied = answer.clone();
        tied.alternatives = vec![vec!["wheel-radius".to_owned(), "encoder-scale".to_owned()]];
        let both = [hide("wheel-radius", &[1]), hide("encoder-scale", &[1])];
        assert_eq!((intervals(&both, &tied), intervals(&both[..1], &tied)), ([0, 0], [1, 1]));
        let azimuth = |x: f64| {
            let parameters = BTreeMap::from([("azimuth_rad".to_owned(), x)]);
            let mut answer = answer.clone();
            answer.effects[0].parameters = vec![("azimuth_rad".to_owned(), 3.1, [3.0, 3.2])];
            intervals(&[Hidden { parameters, ..hide("wheel-radius", &[1]) }], &answer)
        };
        assert_eq!((azimuth(3.15), azimuth(0.02), azimuth(1.5)), ([1, 1], [1, 1], [1, 0]));
        let ratio = in_limits(&[hide("wheel-radius", &[1])], &answer);
        assert!(ratio.is_some_and(|r| (r - 2.5).abs() < 1e-12));
        let mut two = answer.clone();
        two.limits.push(("encoder-scale".to_owned(), "scale_1".to_owned(), 0.02));
        let pair = [hide("wheel-radius", &[1]), hide("encoder-scale", &[1])];
        assert!(in_limits(&pair, &two).is_some_and(|r| (r - 0.5).abs() < 1e-12) && in_limits(&pair, &answer).is_none());
    }

    #[test]
    fn outside_the_catalogue_only_none_of_these_is_right() {
        let mut answer = say(&[("floor-tilt", &[])], &[]);
        assert_eq!(outside(&answer), Grade::Wrong);
        answer.unexplained = vec!["drive: a burst".to_owned()];
        assert_eq!(outside(&answer), Grade::Extra);
        answer.verdict = "unexplained".to_owned();
        answer.nearest = vec!["floor-tilt".to_owned()];
        assert_eq!(outside(&answer), Grade::Right);
        assert_eq!(outside(&say(&[], &[])), Grade::Nothing);
    }
}
