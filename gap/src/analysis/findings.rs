//! What the links of a data set gave so far.

use super::found::{Leftover, Named};
use super::study::Outcome;
use crate::limits::Limit;
use crate::state::{Active, State};
use links::effect::Link;

/// What was found, link by link.
#[derive(Default)]
pub(super) struct Findings {
    pub(super) named: Vec<Named>,
    pub(super) alternatives: Vec<Vec<String>>,
    pub(super) limits: Vec<Limit>,
    pub(super) unexplained: Vec<Leftover>,
    pub(super) ambiguous: bool,
    /// What is named, with values.
    pub(super) found: Vec<Active>,
    pub(super) held_out: Vec<(Link, f64)>,
    /// What could not be compared, and why.
    pub(super) remarks: Vec<String>,
    /// What was fitted and is not named, and why.
    pub(super) refused: Vec<String>,
    /// Of these what no chance gives, but of a size that is not known, with its link.
    pub(super) of_no_size: Vec<(Link, String)>,
}

impl Findings {
    /// Structures that nothing explains.
    pub(super) fn leave(&mut self, link: Link, structures: impl IntoIterator<Item = String>) {
        self.unexplained.extend(structures.into_iter().map(|structure| Leftover { link, structure }));
    }

    /// Takes over what was found on a link from effect `from` on; the state that the next link starts from.
    pub(super) fn take(&mut self, outcome: Outcome, link: Link, from: usize) -> State {
        self.found.extend(outcome.written.active[from..].iter().cloned());
        self.named.extend(outcome.named);
        self.alternatives.extend(outcome.sets);
        for limit in outcome.limits {
            // What shows on two links is named on either.
            match self.limits.iter_mut().find(|l| l.name == limit.name && l.parameter == limit.parameter) {
                Some(known) if known.limit <= limit.limit => {}
                Some(known) => *known = limit,
                None => self.limits.push(limit),
            }
        }
        self.leave(link, outcome.leftovers);
        self.ambiguous |= outcome.ambiguous;
        for refused in outcome.refused {
            self.of_no_size.extend(refused.of_no_size.then_some((link, refused.name)));
            self.refused.push(refused.why);
        }
        self.held_out.push((link, outcome.held_out));
        outcome.written
    }

    /// Whether something on a drive was fitted by more than chance, may not be named for its size, and nothing else is: what
    /// then remains beyond noise does not agree.
    pub(super) fn shows_without_size(&self, link: Link) -> bool {
        let own = |l: &Link| *l == link && link == Link::Drive;
        let open = self.unexplained.iter().any(|u| u.link == link) || self.named.iter().any(|n| n.link == link);
        !open && self.of_no_size.iter().any(|(l, _)| own(l))
    }

    /// Takes back some names. From which size they would be named is then not known: of that which was fitted they were not.
    pub(super) fn forget(&mut self, gone: &[String]) {
        self.named.retain(|n| !gone.contains(&n.name));
        self.alternatives.retain(|set| !set.first().is_some_and(|first| gone.contains(first)));
        self.limits.retain(|limit| !gone.contains(&limit.name));
        self.ambiguous &= !self.named.is_empty();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_fitted_and_is_not_named_has_no_limit_from_which_it_would_be() {
        let limit = |name: &str, limit: f64| Limit {
            name: name.to_owned(),
            parameter: "of".to_owned(),
            estimate: 1.8,
            sd: 0.1,
            limit,
            material: 0.1,
        };
        let mut findings = Findings {
            limits: vec![limit("gear-backlash", 0.35), limit("coulomb-friction", 0.23)],
            named: vec![Named::bare("gear-backlash", Link::Drive, &[])],
            ..Findings::default()
        };
        findings.forget(&["gear-backlash".to_owned()]);
        let left: Vec<&str> = findings.limits.iter().map(|l| l.name.as_str()).collect();
        assert!(findings.named.is_empty() && left == ["coulomb-friction"], "{left:?}");
    }
}
