//! Units of other tools.

use std::f64::consts::{PI, TAU};

/// Unit, and how many of ours it is.
const UNITS: [(&str, f64); 32] = [
    ("s", 1.0),
    ("ms", 1e-3),
    ("us", 1e-6),
    ("ns", 1e-9),
    ("m", 1.0),
    ("cm", 1e-2),
    ("mm", 1e-3),
    ("in", 0.0254),
    ("rad", 1.0),
    ("deg", PI / 180.0),
    ("rev", TAU),
    ("m/s", 1.0),
    ("mm/s", 1e-3),
    ("cm/s", 1e-2),
    ("rad/s", 1.0),
    ("deg/s", PI / 180.0),
    ("rpm", TAU / 60.0),
    ("rev/s", TAU),
    ("m/s2", 1.0),
    ("g", 9.806_65),
    ("V", 1.0),
    ("mV", 1e-3),
    ("A", 1.0),
    ("mA", 1e-3),
    ("1", 1.0),
    ("percent", 1e-2),
    ("%", 1e-2),
    ("permille", 1e-3),
    ("counts", 1.0),
    ("lines", 4.0),
    ("degC", 1.0),
    ("", 1.0),
];

/// How many of ours a unit is.
pub(super) fn factor(unit: &str) -> Option<f64> {
    UNITS.iter().find(|(name, _)| *name == unit).map(|(_, factor)| *factor)
}

/// A value times a factor; by division where that is what the factor means, so that 30 ms are 0.03 s and not
/// 0.030000000000000002.
pub(super) fn times(value: f64, factor: f64) -> f64 {
    let parts = (1.0 / factor).round();
    if parts.abs() > 1.0 && parts.recip() == factor { value / parts } else { value * factor }
}

/// All of them, for a message.
pub(super) fn names() -> String {
    let names: Vec<&str> = UNITS.iter().map(|(name, _)| *name).filter(|n| !n.is_empty()).collect();
    names.join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_thousandth_is_written_as_one() {
        assert_eq!(times(30.0, 1e-3).to_string(), "0.03");
        assert_eq!(times(-350.0, -1e-3), 0.35);
        assert_eq!((times(2.0, 1.0), times(3.0, -1.0), times(2.0, 0.0254)), (2.0, -3.0, 0.0508));
    }
}
