//! What a map says of the time of a file.

use std::path::Path;

use serde::Deserialize;

use super::{Clock, units};
use crate::error::InputError;

/// The table `[time]`.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Time {
    column: Option<String>,
    unit: Option<String>,
    /// In place of a unit: so many of the column are a second.
    per_second: Option<f64>,
    /// The column is a counter that begins again after so many of its own unit.
    wraps: Option<f64>,
    /// Rows a second, of a file without a column of time.
    rate_hz: Option<f64>,
    /// The column that says whose each row is.
    rows_of: Option<String>,
    /// Which recording of a file with several, from 1.
    pub(super) recording: Option<usize>,
    /// Keep the file's time instead of beginning at 0.
    #[serde(default)]
    pub(super) keep: bool,
}

/// A time to the nanosecond: what is stamped alike is one tick.
pub(super) fn nanoseconds(t: f64) -> i64 {
    (t * 1e9).round() as i64
}

/// The median of the steps of some times, s; of those that go back, none.
pub(super) fn usual_step(t: &[f64]) -> Option<f64> {
    let mut steps: Vec<f64> = t.windows(2).map(|pair| pair[1] - pair[0]).filter(|step| *step > 0.0).collect();
    let middle = steps.len() / 2;
    (!steps.is_empty()).then(|| *steps.select_nth_unstable_by(middle, f64::total_cmp).1)
}

impl Time {
    /// For the reader of the file.
    pub(super) fn clock(&self) -> Result<Clock<'_>, InputError> {
        Ok(Clock {
            column: self.column.as_deref(),
            unit_s: self.unit_s()?,
            rate_hz: self.rate_hz,
            wraps: self.wraps,
            recording: self.recording,
            of: self.rows_of.as_deref(),
            rows: false,
        })
    }

    fn unit_s(&self) -> Result<Option<f64>, InputError> {
        if let Some(n) = self.wraps.filter(|n| !(n.is_finite() && *n > 0.0) || self.column.is_none()) {
            let hint = "such as column = \"packet\" and wraps = 256";
            return Err(InputError::new(Path::new(""), format!("{n} is no end of a counter in a column"), hint)
                .field("time.wraps"));
        }
        if let Some(rate) = self.rate_hz {
            let fail = |what: String, hint: &str| Err(InputError::new(Path::new(""), what, hint).field("time.rate_hz"));
            if !(rate.is_finite() && rate > 0.0) {
                return fail(format!("{rate} rows a second are none"), "such as rate_hz = 100");
            }
            if self.column.is_some() || self.unit.is_some() {
                return fail("there is a column of time, or none".to_owned(), "give column and unit, or rate_hz");
            }
        }
        if let Some(ticks) = self.per_second {
            let fail =
                |what: String, hint: &str| Err(InputError::new(Path::new(""), what, hint).field("time.per_second"));
            if !(ticks.is_finite() && ticks > 0.0) {
                return fail(format!("{ticks} of them are no second"), "such as per_second = 8000");
            }
            if self.unit.is_some() || self.rate_hz.is_some() {
                return fail("is beside a unit or rate_hz".to_owned(), "give one of them");
            }
            return Ok(Some(ticks.recip()));
        }
        let Some(unit) = self.unit.as_deref() else { return Ok(None) };
        units::of_time(unit).map(Some).ok_or_else(|| {
            InputError::new(Path::new(""), format!("{unit:?} is no unit of time"), "give s, ms, us or ns")
                .field("time.unit")
        })
    }
}
