//! Speeds that a firmware worked out of a counter that began again, or was misread once.

use std::borrow::Cow;

use super::fill::Wanted;
use crate::columns::Column;

/// How many times as fast a reading is as the wheel ever turns for three readings on, from which no motor made it. Reasoned: what
/// speeds a wheel up to ten times what it can hold, and down again, takes no two rows. Three recordings of others, of a motor, a
/// cleaner and a robot of three wheels, had 12 to 900 times.
const FASTER: f64 = 10.0;

/// Share of the readings that may be such: more are no mistakes but how the wheel turns, or how it is read.
const FEW: f64 = 0.01;

/// The readings of a speed that no wheel made, by their places; empty where there are none.
fn places(wanted: &Wanted, values: &[f64]) -> Vec<usize> {
    if !matches!(wanted.column, Column::Speed(_) | Column::Measured(_)) || wanted.offset != 0.0 {
        return Vec::new();
    }
    let size: Vec<(usize, f64)> =
        values.iter().enumerate().filter(|(_, v)| v.is_finite()).map(|(k, v)| (k, v.abs())).collect();
    let held = size.windows(3).map(|three| three[0].1.min(three[1].1).min(three[2].1)).fold(0.0, f64::max);
    let places: Vec<usize> = size.iter().filter(|(_, v)| held > 0.0 && *v > FASTER * held).map(|(k, _)| *k).collect();
    if places.len() as f64 > FEW * size.len() as f64 { Vec::new() } else { places }
}

/// The values without such readings.
pub(super) fn left_out<'a>(wanted: &Wanted, values: &'a [f64]) -> Cow<'a, [f64]> {
    let places = places(wanted, values);
    if places.is_empty() {
        return values.into();
    }
    let mut values = values.to_vec();
    places.iter().for_each(|k| values[*k] = f64::NAN);
    values.into()
}

/// What the owner of such speeds should know.
pub(super) fn remark(wanted: &Wanted, t: &[f64], values: &[f64]) -> Option<String> {
    let places = places(wanted, values);
    let most = *places.iter().max_by(|a, b| values[**a].abs().total_cmp(&values[**b].abs()))?;
    Some(format!(
        "{}: {} of {} readings of {:?} are more than {FASTER} times what it holds for three, as {} at {} s: a counter began \
         again or was misread; they are left out",
        wanted.column.name(),
        places.len(),
        values.len(),
        wanted.from,
        values[most],
        t[most],
    ))
}

#[cfg(test)]
mod tests {
    use std::fmt::Write;
    use std::path::Path;

    use crate::import::{Clock, Map, Table};

    /// Speeds of a log of 400 rows, and what is said of them.
    fn made(speed: impl Fn(usize) -> f64) -> (Vec<f64>, Vec<String>) {
        let mut log = "t,w\n".to_owned();
        (0..400).for_each(|k| writeln!(log, "{},{}", k as f64 / 100.0, speed(k)).unwrap());
        let table = Table::of_bytes(log.as_bytes(), Path::new("log.csv"), None, &Clock::default()).unwrap();
        let map = Map::parse("[columns]\nspeed_1 = \"w\"\n", Path::new("map.toml")).unwrap();
        (map.run(&table, Path::new("log.csv")).unwrap().speed.remove(0), map.log.remarks(&table))
    }

    #[test]
    fn a_speed_of_a_counter_that_began_again_is_left_out_and_said() {
        let turns = |k: usize| if k < 100 { 0.0 } else { 13.5 };
        let (speed, said) = made(|k| if k == 300 { -12_854.4 } else { turns(k) });
        assert!(speed[300].is_nan() && speed[299] == 13.5 && speed[50] == 0.0);
        assert!(said[0].contains("1 of 400 readings of \"w\"") && said[0].contains("-12854.4 at 3 s"), "{said:?}");
        // There and back, as of a counter that was misread once.
        let (speed, said) =
            made(|k| turns(k) + if k == 300 { 251.0 } else { 0.0 } - if k == 301 { 251.0 } else { 0.0 });
        assert!(speed[300].is_nan() && speed[301].is_nan() && said[0].contains("2 of 400"), "{said:?}");
        // Wheels that go by jerks, and coarse encoders that count now and then, are as they are.
        for speed in [
            |k: usize| if k.is_multiple_of(7) { 5.0 } else { 0.0 },
            |k: usize| if k.is_multiple_of(20) { 9.0 } else { 0.1 },
        ] {
            assert!(made(speed).1.is_empty());
        }
    }
}
