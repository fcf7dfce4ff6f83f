//! A trace of CODESYS, and of controllers that are programmed by it: keys and values, and one variable after the other with
//! its samples below its settings.

use std::collections::BTreeMap;

/// Its first line.
const BEGINS: &str = "[key]; [value]";

/// Names of the columns, and rows of all variables by their times; apart by semicolons.
pub(super) fn table(bytes: &[u8]) -> Option<(Vec<String>, Vec<u8>)> {
    let begins = bytes.trim_ascii_start().get(..BEGINS.len())?;
    if !begins.eq_ignore_ascii_case(BEGINS.as_bytes()) {
        return None;
    }
    let text = String::from_utf8_lossy(bytes);
    // Stamps of a task are milliseconds.
    let mut names = vec!["Time [ms]".to_owned()];
    let mut rows: BTreeMap<u64, Vec<&str>> = BTreeMap::new();
    for line in text.lines().skip(1) {
        let fields: Vec<&str> = line.split(';').map(str::trim).collect();
        match fields[..] {
            ["", t, value, ..] if names.len() > 1 => {
                let row = rows.entry(t.parse().ok()?).or_default();
                row.resize(names.len() - 2, "");
                row.push(value);
            }
            [key, name, ..] if key.ends_with(".Variable") => names.push(name.to_owned()),
            _ => {}
        }
    }
    let width = names.len() - 1;
    let line = |(t, mut row): (u64, Vec<&str>)| {
        row.resize(width, "");
        format!("{t};{}\n", row.join(";"))
    };
    (width > 0 && !rows.is_empty()).then(|| (names, rows.into_iter().map(line).collect::<String>().into_bytes()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn variables_one_after_the_other_are_columns() {
        let variable = |i: usize, name: &str, from: usize| {
            let samples: String = (from..4).map(|k| format!("; {}; {}\r\n", 2 + 20 * k, 10 * i + k)).collect();
            format!("{i}.Variable; {name}\r\n{i}.Class; 14\r\n{i}.YAxis; 0\r\n{i}.Data; \r\n{samples}")
        };
        let [asked, is] = [variable(0, "Main.Asked", 0), variable(1, "Main.Speed", 1)];
        let file = format!("[key]; [value]\r\nVersion; 0x03050000\r\nEveryNCycles; 1\r\n{asked}{is}");
        let (names, rows) = table(file.as_bytes()).unwrap();
        assert_eq!(names, ["Time [ms]", "Main.Asked", "Main.Speed"]);
        assert_eq!(String::from_utf8(rows).unwrap(), "2;0;\n22;1;11\n42;2;12\n62;3;13\n");
        assert!(table(b"t;a\n0;1\n").is_none() && table(b"[key]; [value]\nVersion; 3\n").is_none());
    }
}
