//! Numbers and parameters as people read them.

/// A number with three significant digits.
pub(crate) fn short(x: f64) -> String {
    if x == 0.0 || !x.is_finite() {
        return format!("{x}");
    }
    let digits = (2 - x.abs().log10().floor() as i32).clamp(0, 9) as usize;
    format!("{x:.digits$}")
}

/// What a parameter measures, by the end of its name: factor and unit for people.
fn unit(name: &str) -> (f64, &'static str) {
    let stem = name.trim_end_matches(|c: char| c.is_ascii_digit()).trim_end_matches('_');
    match stem {
        _ if name.ends_with("_nm_per_rad") => (1e3, " mNm/rad"),
        _ if name.ends_with("_rad_per_m") => (1e3, " mrad/m"),
        _ if name.ends_with("_rad_s") => (1.0, " rad/s"),
        _ if name.ends_with("_rad") => (180.0 / std::f64::consts::PI, "°"),
        _ if name.ends_with("_nms2") => (1e6, " µNm s²"),
        _ if name.ends_with("_nms") => (1e6, " µNm s"),
        _ if name.ends_with("_nm") => (1e3, " mNm"),
        _ if name.ends_with("_per_kg") => (1e3, " mm/s/N"),
        _ if name.ends_with("_n") => (1.0, " N"),
        _ if name.ends_with("_ohm") => (1.0, " Ω"),
        _ if name.ends_with("_v") => (1.0, " V"),
        _ if name.ends_with("_per_m2") => (1.0, " /m²"),
        _ if name.ends_with("_m") => (1e3, " mm"),
        _ if name.ends_with("_s") => (1e3, " ms"),
        _ if stem.ends_with("scale") || ["loss", "rise", "cos", "sin", "dropped"].contains(&stem) => (100.0, " %"),
        _ => (1.0, ""),
    }
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
    const UNITS: [(&str, &str); 18] = [
        ("_nm_per_rad", "N m/rad"),
        ("_rad_per_m", "rad/m"),
        ("_rad_s", "rad/s"),
        ("_rad_m", "rad m"),
        ("_rad", "rad"),
        ("_nms2", "N m s²"),
        ("_nms", "N m s"),
        ("_nm", "N m"),
        ("_s_per_kg", "s/kg"),
        ("_per_m2", "1/m²"),
        ("_n", "N"),
        ("_ohm", "Ω"),
        ("_v", "V"),
        ("_a", "A"),
        ("_m", "m"),
        ("_s", "s"),
        ("_kg", "kg"),
        ("_ticks", "ticks"),
    ];
    UNITS.iter().find(|(end, _)| name.ends_with(end)).map_or("", |(_, unit)| unit)
}

/// The name without its unit, such as `skew 1`.
pub(crate) fn label(name: &str) -> String {
    let units = [
        "_nm_per_rad",
        "_rad_s",
        "_rad",
        "_nms2",
        "_nms",
        "_nm",
        "_s_per_kg",
        "_n",
        "_ohm",
        "_v",
        "_per_m2",
        "_m",
        "_s",
    ];
    let stem = units.iter().find_map(|u| name.strip_suffix(u)).unwrap_or(name);
    stem.replace('_', " ")
}

/// A value with its unit, such as `3.98°` or `+2.1 %`.
pub(crate) fn value(name: &str, x: f64) -> String {
    let (factor, unit) = unit_of(name, x);
    let sign = if unit == " %" && x > 0.0 { "+" } else { "" };
    format!("{sign}{}{unit}", short(factor * x))
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
        ];
        for (name, x, shown) in table {
            assert_eq!(value(name, x), shown, "{name}");
        }
    }
}
