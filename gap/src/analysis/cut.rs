//! The logs of a data set in pieces.

use links::pieces::{Driving, Pieces};

/// Logs in pieces, and a sample of long ones.
pub(super) struct Cut<'a> {
    pub(super) whole: Pieces<'a>,
    pub(super) sample: Option<Pieces<'a>>,
}

impl<'a> Cut<'a> {
    /// What causes are looked for in.
    pub(super) fn searched(&self) -> &Pieces<'a> {
        self.sample.as_ref().unwrap_or(&self.whole)
    }

    /// The same, looked at in another way.
    pub(super) fn driven(&self, driving: Driving) -> Self {
        Self { whole: self.whole.driven(driving), sample: self.sample.as_ref().map(|s| s.driven(driving)) }
    }

    /// Whether that is not all.
    pub(super) fn is_sampled(&self) -> bool {
        self.sample.is_some()
    }
}
