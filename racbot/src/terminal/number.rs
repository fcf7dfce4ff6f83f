//! Numbers of the command line that have a range.

use super::Failure;

/// Refuses what is not more than 0 and at most `most`.
pub(crate) fn positive(option: &str, value: f64, most: f64) -> Result<(), Failure> {
    if value > 0.0 && value <= most {
        return Ok(());
    }
    // Hundreds of digits tell nobody anything.
    let short = value == 0.0 || !value.is_finite() || (1e-4..1e7).contains(&value.abs());
    let value = if short { format!("{value}") } else { format!("{value:e}") };
    Err(Failure::usage(format!("{option}: {value} is not more than 0 and at most {most}")))
}
