//! Rows of several motors, sensors or robots under each other, of which a column says whose each is: `time,motor,speed` with
//! `M1` and `M2` in turn. They are a table each: `M1/speed`.

use super::dates;

/// Rows that are looked at to find such a column.
const LOOKED_AT: usize = 4096;
/// Most that share a file; words of more kinds are remarks.
const MOST: usize = 16;
/// Rows of each at least, and by how many times those of one may be more than those of another: sensors have rates of their own.
const LEAST: usize = 3;
const UNEVEN: usize = 20;
/// Share of the rows at which another's follows, in hundredths, from which a word is no state: a state lasts.
const IN_TURN: usize = 50;

/// What a column is called that says whose a row is.
const OWNERS: [&str; 12] =
    ["motor", "wheel", "joint", "axis", "servo", "actuator", "sensor", "robot", "side", "device", "node", "topic"];
/// What else it is called, and what it is where it holds numbers.
const NAMES: [&str; 2] = ["name", "label"];
const NUMBERS: [&str; 7] = ["id", "index", "idx", "number", "no", "num", "nr"];
/// Those whose rows are of what drives a machine, by name or by number.
const DRIVES: [&str; 9] = ["motor", "wheel", "joint", "axis", "servo", "actuator", "side", "id", "idx"];

/// A key as names have it: a whole number without its fraction.
pub(super) fn key(field: &[u8]) -> String {
    let text = String::from_utf8_lossy(field).trim().to_owned();
    match text.parse::<f64>() {
        Ok(number) if number.fract() == 0.0 => format!("{number:.0}"),
        _ => text,
    }
}

/// Whether what a column of such a name tells apart are motors.
pub(super) fn is_of_motors(name: &str) -> bool {
    let lower = name.to_lowercase();
    lower.split(|c: char| !c.is_alphanumeric()).any(|word| DRIVES.contains(&word))
}

/// The column whose fields say whose each row is, and what they are.
pub(super) fn find(names: &[String], rows: &[u8], separator: u8) -> Option<(usize, Vec<String>)> {
    let reader = ::csv::ReaderBuilder::new().delimiter(separator).flexible(true).has_headers(false).from_reader(rows);
    let records: Vec<::csv::ByteRecord> =
        reader.into_byte_records().take(LOOKED_AT).filter_map(Result::ok).filter(|r| r.len() > 1).collect();
    (0..names.len()).find_map(|at| Some((at, keys(&names[at], records.iter().filter_map(|r| r.get(at)))?)))
}

/// The keys in a column, if that is what it holds.
fn keys<'a>(name: &str, fields: impl Iterator<Item = &'a [u8]>) -> Option<Vec<String>> {
    let mut seen: Vec<(String, usize)> = Vec::new();
    let (mut rows, mut turns, mut last) = (0, 0, usize::MAX);
    for key in fields.map(key).filter(|key| !key.is_empty() && key != name) {
        let at = seen.iter().position(|(known, _)| *known == key).unwrap_or_else(|| {
            seen.push((key.clone(), 0));
            seen.len() - 1
        });
        if seen.len() > MOST {
            return None;
        }
        seen[at].1 += 1;
        rows += 1;
        turns += usize::from(last != at);
        last = at;
    }
    let counts = || seen.iter().map(|(_, count)| *count);
    let (least, most) = (counts().min()?, counts().max()?);
    if seen.len() < 2 || least < LEAST || most > UNEVEN * least {
        return None;
    }
    let lower = name.to_lowercase();
    let words: Vec<&str> = lower.split(|c: char| !c.is_alphanumeric()).filter(|w| !w.is_empty()).collect();
    let owner = words.last().is_some_and(|word| OWNERS.contains(word) || NAMES.contains(word));
    let numbers = seen.iter().filter(|(key, _)| key.parse::<f64>().is_ok()).count();
    let is_key = if numbers == 0 {
        let times = seen.iter().any(|(key, _)| dates::seconds(key).is_some());
        // Of a motor that is named the rows may follow each other as blocks.
        !times && (owner || 100 * turns >= IN_TURN * rows)
    } else {
        let whole = numbers == seen.len() && seen.iter().all(|(key, _)| key.bytes().all(|b| b.is_ascii_digit()));
        let numbered = words.last().is_some_and(|word| NUMBERS.contains(word) || OWNERS.contains(word));
        whole && numbered && 100 * turns >= IN_TURN * rows
    };
    is_key.then(|| seen.into_iter().map(|(key, _)| key).collect())
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::super::{Clock, Map, Table, draft};

    fn read(text: &str, clock: &Clock) -> Table {
        Table::of_bytes(text.as_bytes(), Path::new("x.csv"), None, clock).unwrap()
    }

    /// Two motors that turn at other speeds, in turn; one is stamped a little later.
    fn stacked(first: &str, second: &str, name: &str) -> String {
        let row =
            |k: u32| format!("{}.0,{first},{},{}.5\n{}.2,{second},{},-{}\n", k * 10, k % 7, k, k * 10, k % 5, k * 2);
        format!("time_ms,{name},pwm,speed\n{}", (0..30).map(row).collect::<String>())
    }

    #[test]
    fn rows_of_two_motors_are_two_tables() {
        let looking = Clock { rows: true, ..Clock::default() };
        for (first, second, name) in
            [("M1", "M2", "motor"), ("left", "right", "side"), ("1", "2", "motor_id"), ("0.0", "1.0", "ID")]
        {
            let text = stacked(first, second, name);
            let map = draft(&read(&text, &looking));
            let (wheel, one) = if first == "left" { (2, "left") } else { (1, first.trim_end_matches(".0")) };
            for line in [format!("rows_of = \"{name}\""), format!("speed_{wheel} = \"{one}/speed\"")] {
                assert!(map.contains(&line), "{line}\n{map}");
            }
            let map = Map::parse(&map, Path::new("map.toml")).unwrap();
            let table = read(&text, &map.time().unwrap());
            let speed = table.find(&format!("{one}/speed")).unwrap();
            assert_eq!((speed.values[3], speed.t[3]), (3.5, 0.03));
            // Without the line the owner is told.
            let mixed = read(&text, &Clock::default());
            let said = format!("column \"{name}\" says whose each row is");
            assert!(mixed.remarks.iter().any(|r| r.starts_with(&said)) && mixed.find("speed").is_some(), "{mixed:?}");
        }
        // Each motor's rows as a block, with the time from 0 again.
        let block = |motor: &str| (0..9).map(|k| format!("{k},{motor},{}\n", k * 2)).collect::<String>();
        let text = format!("t,motor,speed\n{}{}", block("M1"), block("M2"));
        let clock = Clock { of: Some("motor"), ..Clock::default() };
        let table = read(&text, &clock);
        assert!(table.restart.is_none() && table.find("M2/speed").unwrap().t[8] == 8.0, "{table:?}");
    }

    #[test]
    fn numbers_without_a_name_are_keys_where_the_map_says_so() {
        let text = "0,0.1,0.5,10\n2,0.2,0.6,10\n0,0.3,0.7,30\n2,0.4,0.8,31\n";
        let clock = Clock { column: Some("column_4"), of: Some("column_1"), ..Clock::default() };
        let table = read(text, &clock);
        assert_eq!(table.find("2/column_2").unwrap().t, [10.0, 31.0]);
        let error = Table::of_bytes(text.as_bytes(), Path::new("x.csv"), None, &Clock { of: Some("motor"), ..clock });
        assert!(error.unwrap_err().to_string().contains("rows_of: has no column \"motor\""));
    }

    #[test]
    fn other_files_than_tables_have_no_such_column() {
        let clock = Clock { of: Some("motor"), ..Clock::default() };
        let error = Table::of_bytes(b"[{\"t\": 0, \"x\": 1}]", Path::new("x.json"), None, &clock).unwrap_err();
        assert!(error.to_string().contains("rows_of: is no table of text"), "{error}");
    }

    #[test]
    fn states_and_numbers_are_no_owners() {
        let rows = |of: &dyn Fn(u32) -> String| (0..40).map(|k| format!("{k},{},{k}.5\n", of(k))).collect::<String>();
        let state = |k: u32| if k < 20 { "RUN".to_owned() } else { "STOP".to_owned() };
        for (name, of) in [
            ("state", &state as &dyn Fn(u32) -> String),
            ("motor_state", &|k| state(k / 4 % 2 * 30)),
            ("speed", &|k| (k % 3).to_string()),
            ("note", &|k| format!("at {k}")),
        ] {
            let table = read(&format!("t,{name},x\n{}", rows(of)), &Clock { rows: true, ..Clock::default() });
            assert!(table.find("x").is_some() && table.remarks.is_empty(), "{name}: {:?}", table.remarks);
        }
    }
}
