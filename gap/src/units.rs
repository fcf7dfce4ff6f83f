//! Numbers and parameters as people read them.

/// A number with three significant digits.
pub(crate) fn short(x: f64) -> String {
    if x == 0.0 || !x.is_finite() {
        return format!("{x}");
    }
    let digits = (2 - x.abs().log10().floor() as i32).clamp(0, 9) as usize;
    format!("{x:.digits$}")
}

/// A unit that a parameter's name ends in.
struct Unit {
    end: &'static str,
    /// As in formulas and tables.
    si: &'static str,
    /// Factor and unit for people.
    shown: (f64, &'static str),
}

/// Longer ends first, of those that end alike.
const UNITS: [Unit; 19] = {
    const fn unit(end: &'static str, si: &'static str, factor: f64, shown: &'static str) -> Unit {
        Unit { end, si, shown: (factor, shown) }
    }
    [
        unit("_nm_per_rad", "N m/rad", 1e3, " mNm/rad"),
        unit("_rad_per_m", "rad/m", 1e3, " mrad/m"),
        unit("_rad_s", "rad/s", 1.0, " rad/s"),
        unit("_rad", "rad", 180.0 / std::f64::consts::PI, "°"),
        unit("_nms2", "N m s²", 1e6, " µNm s²"),
        unit("_nms", "N m s", 1e6, " µNm s"),
        unit("_nm", "N m", 1e3, " mNm"),
        unit("_v_per_s", "V/s", 60.0, " V/min"),
        unit("_s_per_kg", "s/kg", 1e3, " mm/s/N"),
        unit("_kg", "kg", 1.0, " kg"),
        unit("_per_n", "1/N", 100.0, " %/N"),
        unit("_n", "N", 1.0, " N"),
        unit("_ohm", "Ω", 1.0, " Ω"),
        unit("_v", "V", 1.0, " V"),
        unit("_a", "A", 1.0, " A"),
        unit("_per_m2", "1/m²", 1.0, " /m²"),
        unit("_m", "m", 1e3, " mm"),
        unit("_s", "s", 1e3, " ms"),
        unit("_ticks", "ticks", 1.0, " ticks"),
    ]
};

fn ending(name: &str) -> Option<&'static Unit> {
    UNITS.iter().find(|unit| name.ends_with(unit.end))
}

/// Factor and unit for people of what a parameter measures.
fn unit(name: &str) -> (f64, &'static str) {
    let stem = name.trim_end_matches(|c: char| c.is_ascii_digit()).trim_end_matches('_');
    let share = || stem.ends_with("scale") || ["loss", "rise", "cos", "sin", "dropped"].contains(&stem);
    ending(name).map_or_else(|| if share() { (100.0, " %") } else { (1.0, "") }, |unit| unit.shown)
}

/// The same for a value: without a prefix of the unit where it would have five digits before its point.
fn unit_of(name: &str, x: f64) -> (f64, String) {
    let (factor, unit) = unit(name);
    let plain =
        unit.strip_prefix(" m").or(unit.strip_prefix(" µ")).filter(|_| factor > 1.0 && (factor * x).abs() >= 1e4);
    plain.map_or((factor, unit.to_owned()), |plain| (1.0, format!(" {plain}")))
}

/// The SI unit that a parameter's name ends in; empty for a ratio.
pub(crate) fn si(name: &str) -> &'static str {
    ending(name).map_or("", |unit| unit.si)
}

/// The name without its unit, such as `skew 1`.
pub(crate) fn label(name: &str) -> String {
    ending(name).and_then(|unit| name.strip_suffix(unit.end)).unwrap_or(name).replace('_', " ")
}

/// A value with its unit, such as `3.98°` or `+2.1 %`.
pub(crate) fn value(name: &str, x: f64) -> String {
    let (factor, unit) = unit_of(name, x);
    let sign = if unit == " %" && x > 0.0 { "+" } else { "" };
    format!("{sign}{}{unit}", short(factor * x))
}

/// A torque, Nm, such as `20.8 mNm` of a servo, `0.0271 mNm` of a small motor and `32.6 Nm` of an arm.
pub(crate) fn torque(x: f64) -> String {
    value("torque_nm", x)
}

/// A value with its interval, such as `3.98° (3.79 to 4.16)`; the interval only if it has a width.
pub(crate) fn interval(name: &str, x: f64, ends: Option<[f64; 2]>) -> String {
    let (factor, _) = unit_of(name, x);
    let Some([low, high]) = ends.filter(|[low, high]| low < high) else { return value(name, x) };
    format!("{} ({} to {})", value(name, x), short(factor * low), short(factor * high))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn people_read_degrees_percent_and_milliseconds() {
        let table = [
            ("skew_1_rad", 0.07, "4.01°"),
            ("scale_2", 0.021, "+2.10 %"),
            ("scale", -0.15, "-15.0 %"),
            ("torque_3_nm", 0.0208, "20.8 mNm"),
            ("latency_s", 0.0704, "70.4 ms"),
            ("torque_nm", -25.93, "-25.9 Nm"),
            ("coefficient_nms", 1519.0, "1519 Nm s"),
            ("coefficient_1_nms2", 4.3e-6, "4.30 µNm s²"),
            ("stiffness_1_nm_per_rad", 0.05, "50.0 mNm/rad"),
            ("x_m", 0.0101, "10.1 mm"),
            ("x_rad", 0.02, "1.15°"),
            ("threshold_rad_s", 14.0, "14.0 rad/s"),
            ("friction_coefficient", 0.2, "0.200"),
            ("creep_s_per_kg", 0.004, "4.00 mm/s/N"),
            ("creep_per_n", 0.004, "0.400 %/N"),
            ("limit_a", 3.71, "3.71 A"),
            ("shift_ticks", 2.0, "2.00 ticks"),
            ("torque_nm", 2.71e-5, "0.0271 mNm"),
        ];
        for (name, x, shown) in table {
            assert_eq!(value(name, x), shown, "{name}");
        }
    }
}
