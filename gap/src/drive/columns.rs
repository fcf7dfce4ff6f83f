//! Derivatives of the drive that stay what they are while nothing but loads is added to a model: worked out once.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

use super::DriveModel;

/// Numbers that are kept at most, 32 MB; beyond, all are forgotten.
const ROOM: usize = 1 << 22;

/// A direction in which the drive is differentiated.
pub struct Side {
    /// Model at the low end; `None` for the model itself.
    pub low: Option<DriveModel>,
    /// Model at the high end.
    pub high: DriveModel,
    /// Step between them.
    pub step: f64,
    /// What the derivative depends on, where it is the same for every model with other loads.
    pub key: Option<String>,
}

/// The derivative along a side, one number a bump and wheel.
pub(super) type Column = Arc<Vec<f64>>;

/// Derivatives by the first bump of their segment and their key.
#[derive(Default)]
pub(super) struct Columns(Mutex<Kept>);

#[derive(Default)]
struct Kept {
    numbers: usize,
    columns: HashMap<(usize, String), Column>,
}

impl Columns {
    /// A derivative that is known already.
    pub(super) fn find(&self, first: usize, side: &Side) -> Option<Column> {
        let key = (first, side.key.clone()?);
        self.0.lock().unwrap_or_else(PoisonError::into_inner).columns.get(&key).cloned()
    }

    /// Keeps a derivative if it may be needed again.
    pub(super) fn keep(&self, first: usize, side: &Side, column: &Column) {
        let Some(key) = side.key.clone() else { return };
        let mut kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if kept.numbers + column.len() > ROOM {
            *kept = Kept::default();
        }
        if column.len() <= ROOM && kept.columns.insert((first, key), column.clone()).is_none() {
            kept.numbers += column.len();
        }
    }
}
