//! Units of other tools.

use std::f64::consts::{PI, TAU};

/// Unit, and how many of ours it is.
const UNITS: [(&str, f64); 33] = [
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
    ("counts/s", 1.0),
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

/// The unit that a column's name says: in brackets, or as its last word.
pub(super) fn in_name(name: &str) -> Option<&'static str> {
    let inside = |open, close| name.split_once(open).and_then(|(_, rest)| rest.split_once(close)).map(|(unit, _)| unit);
    // What is written for a stroke: `speed_rad_s`, `rate_deg_per_s`.
    let lower = name.to_ascii_lowercase();
    let after = [("rad_s", "rad/s"), ("rad_per_s", "rad/s"), ("deg_s", "deg/s"), ("deg_per_s", "deg/s")];
    let is_last = |ending: &str| {
        lower.strip_suffix(ending).is_some_and(|rest| rest.is_empty() || rest.ends_with(['_', ' ', '/', '.', '-']))
    };
    if let Some((_, unit)) = after.into_iter().find(|(ending, _)| is_last(ending)) {
        return Some(unit);
    }
    let last = || name.rsplit(['_', ' ', '/', '.', '-']).next().filter(|word| word.len() < name.len());
    let said = inside('[', ']').or_else(|| inside('(', ')')).or_else(last)?;
    let plain = match said.trim() {
        "sec" | "secs" | "seconds" => "s",
        "usec" | "µs" | "μs" | "micros" => "us",
        "msec" | "millis" => "ms",
        "nsec" | "nanos" => "ns",
        "°" | "degree" | "degrees" | "grad" => "deg",
        "radian" | "radians" => "rad",
        "°/s" | "dps" | "deg/sec" | "degrees/s" | "degrees/sec" => "deg/s",
        "rad/sec" | "radians/s" | "radians/sec" => "rad/s",
        "m/sec" | "meters/s" | "metres/s" => "m/s",
        "ticks" | "steps" => "counts",
        "ticks/s" | "steps/s" | "pulses/s" => "counts/s",
        "turns" | "revs" | "revolutions" => "rev",
        "turns/s" | "rps" => "rev/s",
        "pct" => "percent",
        "meter" | "meters" | "metre" | "metres" => "m",
        "millimeters" | "millimetres" => "mm",
        "volt" | "volts" => "V",
        "amps" | "ampere" | "amperes" => "A",
        other => other,
    };
    let same = |(unit, _): &&(&'static str, f64)| !matches!(*unit, "" | "1") && unit.eq_ignore_ascii_case(plain);
    // A bare letter at the end is rather a name's: `pos_m`, but `motor_A`.
    let sure = |unit: &&'static str| unit.len() > 1 || plain == *unit;
    UNITS.iter().find(same).map(|(unit, _)| *unit).filter(sure)
}

/// A name without the unit that stands in brackets after it, or without brackets in which none stands.
pub(super) fn without(name: &str) -> &str {
    let ends = [('(', ')'), ('[', ']')].into_iter().find_map(|(open, close)| {
        let (bare, rest) = name.split_once(open)?;
        let inside = rest.trim_end().strip_suffix(close)?;
        (inside.trim().is_empty() || in_name(name).is_some()).then_some(bare.trim_end())
    });
    ends.filter(|bare| !bare.is_empty()).unwrap_or(name)
}

/// Whether a unit can be one of what `ours` is a unit of: seconds of milliseconds, no inches of amperes.
pub(super) fn is_like(unit: &str, ours: &str) -> bool {
    const KINDS: [&[&str]; 10] = [
        &["s", "ms", "us", "ns"],
        &["m", "cm", "mm", "in"],
        &["rad", "deg", "rev"],
        &["m/s", "mm/s", "cm/s"],
        &["rad/s", "deg/s", "rpm", "rev/s", "counts/s"],
        &["m/s2", "g"],
        &["V", "mV"],
        &["A", "mA"],
        &["1", "percent", "%", "permille", ""],
        &["counts", "lines"],
    ];
    KINDS.iter().any(|kind| kind.contains(&unit) && kind.contains(&ours))
}

/// How many seconds a unit of time is.
pub(super) fn of_time(unit: &str) -> Option<f64> {
    factor(unit).filter(|_| ["s", "ms", "us", "ns"].contains(&unit))
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
    fn units_stand_in_names() {
        for (name, unit) in [
            ("Zeit [ms]", "ms"),
            ("time_us", "us"),
            ("vx (mm/s)", "mm/s"),
            ("pwm_percent", "percent"),
            ("phi [°]", "deg"),
            ("pos_m", "m"),
            ("encoderLeft (meters)", "m"),
            ("Speed (steps/s)", "counts/s"),
            ("feedback_deg_s", "deg/s"),
            ("omega_rad_per_s", "rad/s"),
            ("position_value (degree)", "deg"),
            ("angular velocity[rad/sec]", "rad/s"),
        ] {
            assert_eq!(in_name(name), Some(unit), "{name}");
        }
        for name in ["t", "ms", "left wheel", "motor_a", "x"] {
            assert_eq!(in_name(name), None, "{name}");
        }
    }

    #[test]
    fn a_unit_in_brackets_is_no_part_of_a_name() {
        for (name, bare) in [
            ("x (cm)", "x"),
            ("v[m/s]", "v"),
            ("left velocity ()", "left velocity"),
            ("a (left)", "a (left)"),
            ("(m)", "(m)"),
        ] {
            assert_eq!(without(name), bare);
        }
    }

    #[test]
    fn a_thousandth_is_written_as_one() {
        assert_eq!(times(30.0, 1e-3).to_string(), "0.03");
        assert_eq!(times(-350.0, -1e-3), 0.35);
        assert_eq!((times(2.0, 1.0), times(3.0, -1.0), times(2.0, 0.0254)), (2.0, -3.0, 0.0508));
    }
}
