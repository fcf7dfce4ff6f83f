//! The columns of a run that a map names: each with its series, unit and sign.

use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::path::Path;

use serde::Deserialize;

use super::fill::Wanted;
use super::units;
use crate::columns::{Column, MOST_DUTY};
use crate::error::{InputError, nearest};

/// Which series a column is made of, and how.
#[derive(Debug, Clone)]
pub(super) enum Source {
    Name(String),
    Scaled(Scaled),
    /// The same in every row.
    Constant(f64),
}

/// As text or table, with the fault of the table, which an untagged enum would not say.
impl<'de> Deserialize<'de> for Source {
    fn deserialize<D: serde::Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        struct Either;
        impl<'de> serde::de::Visitor<'de> for Either {
            type Value = Source;

            fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
                f.write_str("the name of a series, { from = \"its name\", unit = \"mm\" }, or one number for every row")
            }

            fn visit_str<E>(self, name: &str) -> Result<Source, E> {
                Ok(Source::Name(name.to_owned()))
            }

            fn visit_f64<E>(self, value: f64) -> Result<Source, E> {
                Ok(Source::Constant(value))
            }

            fn visit_i64<E>(self, value: i64) -> Result<Source, E> {
                Ok(Source::Constant(value as f64))
            }

            fn visit_map<A: serde::de::MapAccess<'de>>(self, map: A) -> Result<Source, A::Error> {
                Scaled::deserialize(serde::de::value::MapAccessDeserializer::new(map)).map(Source::Scaled)
            }
        }
        from.deserialize_any(Either)
    }
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Scaled {
    from: String,
    #[serde(default)]
    unit: String,
    scale: Option<f64>,
    #[serde(default)]
    offset: f64,
    /// Counts a turn of an encoder whose log has angles.
    counts_per_rev: Option<f64>,
    /// The most that the log's value means, in our unit: the log holds a controller's output, and the driver after it cuts
    /// that off.
    limit: Option<f64>,
    /// Each value is what came since the row before it: of counts the column is their sum, of a pose each is seen from the pose
    /// before it.
    #[serde(default)]
    increments: bool,
    /// The value is known but for multiples of this, such as 4096 of an encoder of one turn or 65536 of a number of 16
    /// bits, in the file's unit.
    wraps: Option<f64>,
    /// A series that has the sign which the value lacks: a command, or a direction of 0 and 1.
    sign: Option<String>,
}

/// Velocities of the body that its odometry was made of: integrated, they are the odometry.
pub(super) const RATES: [&str; 3] = ["odom_vx", "odom_vy", "odom_w"];

/// What a map gives one number for, the same in every row.
pub(super) fn constants(columns: &BTreeMap<String, Source>) -> Vec<(Column, f64)> {
    let constant = |(name, source): (&String, &Source)| match source {
        Source::Constant(value) => Some((Column::from_name(name), *value)),
        Source::Name(_) | Source::Scaled(_) => None,
    };
    columns.iter().filter_map(constant).collect()
}

/// Whether somebody knows the number without a log: what was asked or given, not what was measured.
fn is_set(column: Column) -> bool {
    matches!(column, Column::Supply | Column::Duty(_) | Column::Reference(_) | Column::Command(_))
}

/// What is wrong with a number that stands for every row of a column, and what to write.
fn constant_fault(column: Column, value: f64) -> Option<(String, &'static str)> {
    if !is_set(column) {
        let hint = "give the name of a series, or { from = \"its name\", unit = \"mm\" }; a number alone is for what was \
                    set: supply_v, duty_, ref_, cmd_";
        return Some((format!("{value} is no series"), hint));
    }
    match column {
        Column::Supply if !(value.is_finite() && value > 0.0) => {
            Some((format!("{value} V is no supply"), "such as supply_v = 12"))
        }
        Column::Duty(_) if value.is_nan() || value.abs() > MOST_DUTY => {
            Some((format!("duty {value} is not within ±1"), "it is a share of the supply: 60 percent are 0.6"))
        }
        _ if !value.is_finite() => Some((format!("{value} is no number"), "give one, in the unit of the column")),
        _ => None,
    }
}

/// The columns that a map makes of series.
pub(super) fn wanted(columns: &BTreeMap<String, Source>) -> Result<Vec<Wanted<'_>>, InputError> {
    let mut wanted = Vec::new();
    for (name, source) in columns {
        let field = format!("columns.{name}");
        let fail = |what: String, hint: String| InputError::new(Path::new(""), what, hint).field(field.clone());
        let rate = RATES.iter().position(|rate| rate == name);
        let column = rate.map_or_else(|| Column::from_name(name), Column::Odometry);
        if matches!(column, Column::Other | Column::Time) {
            let known: Vec<String> = Column::all(4).into_iter().map(Column::name).collect();
            let known: Vec<&str> = known.iter().map(String::as_str).collect();
            let hint = nearest(name, &known).map_or_else(
                || "the columns are those of docs/book/src/log-format.md; time has a table [time]".to_owned(),
                |near| format!("did you mean {near}?"),
            );
            return Err(fail("is no column of a run".to_owned(), hint));
        }
        let (from, name, scale, offset, limit, per_rev, wraps, increments, sign) = match source {
            Source::Constant(value) => match constant_fault(column, *value) {
                Some((what, hint)) => return Err(fail(what, hint.to_owned())),
                None => continue,
            },
            Source::Name(from) => (from, "", 1.0, 0.0, None, None, None, false, None),
            Source::Scaled(s) => (
                &s.from,
                s.unit.as_str(),
                s.scale.unwrap_or(1.0),
                s.offset,
                s.limit,
                s.counts_per_rev,
                s.wraps,
                s.increments,
                s.sign.as_deref(),
            ),
        };
        if let Some(n) = wraps.filter(|n| !(n.is_finite() && *n > 0.0)) {
            return Err(fail(format!("wraps = {n} is no period"), "such as wraps = 4096".to_owned()));
        }
        if let Some(n) = limit.filter(|n| !(n.is_finite() && *n > 0.0)) {
            return Err(fail(format!("limit = {n} is no limit"), "such as limit = 1 of a duty".to_owned()));
        }
        let sized = matches!(
            column,
            Column::Duty(_) | Column::Current(_) | Column::Speed(_) | Column::Measured(_) | Column::Reference(_)
        );
        if sign.is_some() && !sized {
            let hint = "it is for what drives a wheel or how fast it turns: duty_, current_, speed_, meas_, ref_";
            return Err(fail("sign has no meaning here".to_owned(), hint.to_owned()));
        }
        let angle = ["rad", "deg", "rev"].contains(&name);
        let counted = matches!(column, Column::Counts(_));
        let posed = matches!(column, Column::Odometry(_) | Column::Camera(_)) && rate.is_none();
        if increments && !((counted || posed) && wraps.is_none()) {
            let hint = "it is for enc_ columns and the poses of odom_ and cam_, and without wraps";
            return Err(fail("increments = true has no meaning here".to_owned(), hint.to_owned()));
        }
        if counted && units::is_like(name, "m") {
            let hint = "metres of the wheel's way are an angle by its radius: unit = \"rad\", scale = 1 / radius in metres, \
                        counts_per_rev = 65536, and encoder_counts_per_wheel_rev = 65536 in robot.toml";
            return Err(fail(format!("counts cannot be in {name:?}"), hint.to_owned()));
        }
        if name == "counts/s" && per_rev.is_none() {
            let hint = "say how many counts are a turn of the wheel: counts_per_rev = 1440";
            return Err(fail("counts a second are no angle a second".to_owned(), hint.to_owned()));
        }
        if counted && units::factor(name).is_some() && !matches!(name, "" | "counts" | "lines") && per_rev.is_none() {
            let hint = "say what the encoder counts: counts_per_rev = 1440 beside unit = \"rad\", and \
                            encoder_counts_per_wheel_rev = 1440 in robot.toml; any fine number, as 65536, where nobody knows";
            return Err(fail(format!("counts cannot be in {name:?}"), hint.to_owned()));
        }
        let turns =
            matches!(column, Column::Speed(_) | Column::Measured(_) | Column::Reference(_)) && name == "counts/s";
        if let Some(n) = per_rev.filter(|n| !((counted && angle || turns) && n.is_finite() && *n > 0.0)) {
            let hint =
                "it is a positive number, for an enc_ column whose unit is rad, deg or rev, or speeds in counts/s";
            return Err(fail(format!("counts_per_rev = {n} has no meaning here"), hint.to_owned()));
        }
        let Some(unit) = units::factor(name) else {
            return Err(fail(
                format!("{name:?} is no unit that is known"),
                format!("give one of {}, or a scale", units::names()),
            ));
        };
        if !(scale.is_finite() && scale != 0.0 && offset.is_finite()) {
            return Err(fail("its scale or offset is no number".to_owned(), "such as scale = -1".to_owned()));
        }
        let factor = unit * scale * per_rev.map_or(1.0, |n| if turns { TAU / n } else { n / TAU });
        wanted.push(Wanted {
            column,
            from,
            factor,
            offset,
            limit,
            wraps,
            turn: per_rev.filter(|_| !turns && !increments).map(|_| TAU / unit),
            increments,
            sign,
            rate: rate.is_some(),
        });
    }
    Ok(wanted)
}

#[cfg(test)]
mod tests {
    use crate::Run;
    use crate::import::{Clock, Map, Table};
    use std::path::Path;

    fn made(columns: &str) -> Result<Run, String> {
        let log = b"t,volts,speed\n0,6,0\n0.1,12,4\n0.2,-12,9\n";
        let table = Table::of_bytes(log, Path::new("log.csv"), None, &Clock::default()).unwrap();
        let map = format!("[columns]\nspeed_1 = \"speed\"\n{columns}");
        Map::parse(&map, Path::new("map.toml"))
            .and_then(|m| m.run(&table, Path::new("log.csv")))
            .map_err(|e| e.to_string())
    }

    #[test]
    fn a_number_is_what_was_set_in_every_row_and_nothing_that_is_measured() {
        let volts = "duty_1 = { from = \"volts\", scale = 0.0833333333 }\n";
        assert_eq!(made(volts).unwrap().supply_v, None);
        assert_eq!(made(&format!("{volts}supply_v = 12")).unwrap().supply_v, Some(vec![12.0; 3]));
        let error = made(&format!("{volts}supply_v = -12.5")).unwrap_err();
        assert!(error.contains("columns.supply_v") && error.contains("-12.5 V is no supply"), "{error}");
        // A step of one duty, of which the log has the speed alone; set points and commands likewise.
        let step = made("duty_1 = 0.6\nsupply_v = 12").unwrap();
        assert_eq!((step.duty, step.supply_v), (vec![vec![0.6; 3]], Some(vec![12.0; 3])));
        assert_eq!(made("ref_1 = -4").unwrap().reference, [[-4.0; 3]]);
        let told = "cmd_vx = 0.5\ncmd_w = 0\n[frame]\nx = \"forward\"\nheadings = \"clockwise\"";
        assert_eq!(made(told).unwrap().command, Some([vec![0.0; 3], vec![0.5; 3], vec![0.0; 3]]));
        for (wrong, says) in [
            ("duty_1 = 60", "duty 60 is not within ±1"),
            ("duty_1 = nan", "duty NaN is not within ±1"),
            ("ref_1 = inf", "inf is no number"),
            ("current_1 = 1", "1 is no series"),
            ("enc_1 = 0", "0 is no series"),
        ] {
            let error = made(wrong).unwrap_err();
            assert!(error.contains(&format!("columns.{}", &wrong[..4])) && error.contains(says), "{error}");
        }
        // Of a map without a series there is nothing to set it beside.
        let table = Table::of_bytes(b"t,v\n0,1\n1,2\n", Path::new("log.csv"), None, &Clock::default()).unwrap();
        let map = Map::parse("[columns]\nduty_1 = 0.6\n", Path::new("map.toml")).unwrap();
        let error = map.run(&table, Path::new("log.csv")).unwrap_err().to_string();
        assert!(error.contains("none of its series is a column of ours"), "{error}");
    }
}
