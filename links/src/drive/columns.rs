//! What the drive's models leave unexplained, and derivatives that stay what they are while nothing but loads is added to a
//! model: each is worked out once.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::DriveModel;

/// Numbers that are kept at most, 128 MB: the loads of an hour at 1 kHz. Beyond, nothing more is kept.
const ROOM: usize = 1 << 24;

/// A direction in which the drive is differentiated.
pub struct Side {
    /// Model at the low end; `None` for the model itself.
    pub low: Option<DriveModel>,
    /// Model at the high end.
    pub high: DriveModel,
    /// Step between them.
    pub step: f64,
    /// Whether it changes inertias alone.
    pub inertia_alone: bool,
    /// What the derivative depends on, where it is the same for every model with other loads.
    pub key: Option<String>,
}

/// The derivative along a side, or what a model leaves unexplained; one number a test function and wheel.
pub(super) type Column = Arc<Vec<f64>>;

/// Columns by the first test function of their segment and their key.
#[derive(Default)]
pub(super) struct Columns(Mutex<Kept>);

#[derive(Default)]
struct Kept {
    numbers: usize,
    /// Linearisations so far.
    round: u64,
    /// With the last round in which they were asked for.
    columns: HashMap<(usize, String), (Column, u64)>,
}

impl Kept {
    /// Forgets what no linearisation asked for lately.
    fn forget(&mut self) {
        let round = self.round;
        self.columns.retain(|_, (_, asked)| *asked + LATELY >= round);
        self.numbers = self.columns.values().map(|(column, _)| column.len()).sum();
    }
}

impl Columns {
    fn kept(&self) -> MutexGuard<'_, Kept> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Another linearisation begins.
    pub(super) fn begin(&self) {
        let mut kept = self.kept();
        kept.round += 1;
        if kept.round.is_multiple_of(LATELY) {
            kept.forget();
        }
    }

    /// A column that is known already.
    pub(super) fn find(&self, first: usize, key: &str) -> Option<Column> {
        let key = (first, key.to_owned());
        let mut kept = self.kept();
        let round = kept.round;
        let (column, asked) = kept.columns.get_mut(&key)?;
        *asked = round;
        Some(column.clone())
    }

    /// A column that is known already, or made now and kept.
    pub(super) fn once(&self, first: usize, key: String, make: impl FnOnce() -> Option<Vec<f64>>) -> Option<Column> {
        if let Some(known) = self.find(first, &key) {
            return Some(known);
        }
        let made = Arc::new(make()?);
        self.keep(first, key, &made);
        Some(made)
    }

    /// Keeps a column if there is room.
    pub(super) fn keep(&self, first: usize, key: String, column: &Column) {
        let mut kept = self.kept();
        if kept.numbers + column.len() > ROOM {
            kept.forget();
        }
        let Kept { numbers, round, columns } = &mut *kept;
        if *numbers + column.len() <= ROOM && columns.insert((first, key), (column.clone(), *round)).is_none() {
            *numbers += column.len();
        }
    }
}

/// Linearisations after which a column that none of them asked for goes: fits between two of them ask for a few only.
const LATELY: u64 = 24;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_asked_for_makes_room() {
        let columns = Columns::default();
        let half: Column = Arc::new(vec![0.0; ROOM / 2]);
        columns.begin();
        columns.keep(0, "old".to_owned(), &half);
        columns.keep(0, "used".to_owned(), &half);
        for _ in 0..=LATELY {
            columns.begin();
            assert!(columns.find(0, "used").is_some());
        }
        columns.keep(0, "new".to_owned(), &half);
        let known = |key: &str| columns.find(0, key).is_some();
        assert!(known("new") && known("used") && !known("old"));
        // All of it is in use: nothing goes, and nothing more is kept.
        columns.keep(0, "more".to_owned(), &half);
        assert!(known("new") && known("used") && !known("more"));
    }
}
