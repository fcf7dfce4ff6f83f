//! What looks like what is named, and what speaks against it: by rules and signals that no fit of the link knows.

use super::study::Outcome;

/// What else may be what is named.
#[derive(Debug, PartialEq)]
pub(super) struct LookAlike {
    /// In a sentence.
    pub(super) said: String,
    /// Names that are tied by it, the one that is named first; none where it is no effect of the catalogue.
    pub(super) names: Vec<&'static str>,
    /// Whether the logs leave it open which of them it is.
    pub(super) open: bool,
}

impl LookAlike {
    /// One that is no effect of the catalogue.
    pub(super) fn said(said: String) -> Self {
        Self { said, names: Vec::new(), open: false }
    }

    /// Effects between which the logs do not decide.
    pub(super) fn open(said: String, names: &[&'static str]) -> Self {
        Self { said, names: names.to_vec(), open: true }
    }

    /// Effects of which the named one is the likelier.
    pub(super) fn beside(said: String, names: &[&'static str]) -> Self {
        Self { said, names: names.to_vec(), open: false }
    }
}

/// What something else than the drive speaks against: what is found without these names takes the place of what was.
#[derive(Debug, PartialEq)]
pub(super) struct Against {
    pub(super) names: Vec<String>,
    /// In a sentence.
    pub(super) said: String,
}

impl Outcome {
    /// Ties effects, unless they are tied already; `open` if the logs do not decide between them.
    pub(super) fn tie(&mut self, names: &[&str], open: bool) {
        let known = |set: &Vec<String>| names.iter().all(|name| set.iter().any(|n| n == name));
        if names.len() > 1 && !self.sets.iter().any(known) {
            self.sets.push(names.iter().map(|name| (*name).to_owned()).collect());
        }
        self.ambiguous |= open;
    }

    /// Ties what look-alikes tie; what is said of them.
    pub(super) fn look_alike(&mut self, all: impl IntoIterator<Item = LookAlike>) -> Vec<String> {
        let tied = |LookAlike { said, names, open }| {
            self.tie(&names, open);
            said
        };
        all.into_iter().map(tied).collect()
    }
}
