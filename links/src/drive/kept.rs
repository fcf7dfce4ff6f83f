//! Means over test functions that stay what they are for many models: each is worked out once.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Numbers that are kept at most, 128 MB. Beyond, nothing more is kept.
const ROOM: usize = 1 << 24;

/// Rows of torques and forces that are not 0 throughout, one number a test function.
pub(super) type Rows = Vec<(usize, Vec<f64>)>;

/// What rows depend on.
pub(super) type Key = (u64, Option<u64>);

/// Rows by the first test function of their segment and their key.
#[derive(Default)]
pub(super) struct KeptRows(Mutex<Kept>);

#[derive(Default)]
struct Kept {
    numbers: usize,
    /// Linearisations so far.
    round: u64,
    /// With the last round in which they were asked for.
    rows: HashMap<(usize, Key), (Arc<Rows>, u64)>,
}

fn numbers(rows: &Rows) -> usize {
    rows.iter().map(|(_, row)| row.len()).sum()
}

impl Kept {
    /// Forgets what no linearisation asked for lately.
    fn forget(&mut self) {
        let round = self.round;
        self.rows.retain(|_, (_, asked)| *asked + LATELY >= round);
        self.numbers = self.rows.values().map(|(rows, _)| numbers(rows)).sum();
    }
}

impl KeptRows {
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

    /// Rows that are known already, or made now and kept.
    pub(super) fn once(&self, first: usize, key: Key, make: impl FnOnce() -> Rows) -> Arc<Rows> {
        if let Some(known) = self.find(first, key) {
            return known;
        }
        let made = Arc::new(make());
        self.keep(first, key, &made);
        made
    }

    fn find(&self, first: usize, key: Key) -> Option<Arc<Rows>> {
        let mut kept = self.kept();
        let round = kept.round;
        let (rows, asked) = kept.rows.get_mut(&(first, key))?;
        *asked = round;
        Some(rows.clone())
    }

    /// Keeps rows if there is room.
    fn keep(&self, first: usize, key: Key, rows: &Arc<Rows>) {
        let mut kept = self.kept();
        if kept.numbers + numbers(rows) > ROOM {
            kept.forget();
        }
        let Kept { numbers: all, round, rows: known } = &mut *kept;
        if *all + numbers(rows) <= ROOM && known.insert((first, key), (rows.clone(), *round)).is_none() {
            *all += numbers(rows);
        }
    }
}

/// Linearisations after which rows that none of them asked for go: fits between two of them ask for a few only.
const LATELY: u64 = 24;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_asked_for_makes_room() {
        let kept = KeptRows::default();
        let half = Arc::new(vec![(0, vec![0.0; ROOM / 2])]);
        let [old, used, new, more] = [0, 1, 2, 3].map(|key| (key, None));
        kept.begin();
        kept.keep(0, old, &half);
        kept.keep(0, used, &half);
        for _ in 0..=LATELY {
            kept.begin();
            assert!(kept.find(0, used).is_some());
        }
        kept.keep(0, new, &half);
        let known = |key| kept.find(0, key).is_some();
        assert!(known(new) && known(used) && !known(old));
        // All of it is in use: nothing goes, and nothing more is kept.
        kept.keep(0, more, &half);
        assert!(known(new) && known(used) && !known(more));
    }
}
