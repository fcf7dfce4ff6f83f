//! A curve as an oscilloscope saves it: the settings in the first columns of the first rows, samples beside them in all rows.

/// Rows at most that have settings, and rows without any from which the columns of these are none of samples.
const SETTINGS: usize = 40;
const FEWEST: usize = 40;

/// Names of the columns of samples, and their rows alone, each on the line where it was; apart by commas.
pub(super) fn table(bytes: &[u8]) -> Option<(Vec<String>, Vec<u8>)> {
    let text = String::from_utf8_lossy(bytes);
    let fields = |line| -> Vec<&str> { str::split(line, ',').map(str::trim).collect() };
    let (mut with, mut without, mut beside) = (0_usize, 0_usize, usize::MAX);
    // Most tables are none by their second line.
    for row in text.lines().map(fields).filter(|row| row.iter().any(|field| !field.is_empty())) {
        let empty = row.iter().take_while(|field| field.is_empty()).count();
        if row.first().is_some_and(|name| name.starts_with(|c: char| c.is_alphabetic())) && without < SETTINGS {
            with += 1;
        } else if empty > 1 {
            (without, beside) = (without + 1, beside.min(empty));
        } else {
            return None;
        }
    }
    let rows: Vec<Vec<&str>> = text.lines().map(fields).collect();
    let samples = |row: &[&str]| row.get(beside..).unwrap_or(&[]).iter().map(|s| (*s).to_owned()).collect::<Vec<_>>();
    let ended = |row: &[String]| row.iter().rposition(|field| !field.is_empty()).map_or(0, |last| last + 1);
    let width = rows.iter().map(|row| ended(&samples(row))).max()?;
    let numbers = |row: &Vec<&str>| {
        let own = samples(row);
        row.iter().all(|field| field.is_empty())
            || ended(&own) == width && own[..width].iter().all(|field| field.parse::<f64>().is_ok())
    };
    if !(2..=SETTINGS).contains(&with) || without < FEWEST || width < 2 || !rows.iter().all(numbers) {
        return None;
    }
    let setting = |name: &str| {
        let row = rows.iter().find(|row| row[0].eq_ignore_ascii_case(name))?;
        row.get(1).filter(|value| !value.is_empty() && beside > 1).map(|value| (*value).to_owned())
    };
    let unit = |name: &str| setting(name).map_or_else(String::new, |unit| format!(" [{unit}]"));
    let source = setting("Source").unwrap_or_else(|| "samples".to_owned());
    let mut names = vec![format!("Time{}", unit("Horizontal Units")), format!("{source}{}", unit("Vertical Units"))];
    names.extend((2..width).map(|i| format!("{source}_{}", i + 1)));
    let lines: Vec<String> = rows.iter().map(|row| samples(row)[..ended(&samples(row))].join(",")).collect();
    Some((names, lines.join("\n").into_bytes()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(settings: &[(&str, &str)], rows: usize) -> String {
        let row = |k: usize| {
            let (name, value) = settings.get(k).copied().unwrap_or_default();
            format!("{name},{value},,{:.4},  {:.2},\r\n", 1e-4 * k as f64 - 0.01, 10.0 - 0.01 * k as f64)
        };
        (0..rows).map(row).collect()
    }

    #[test]
    fn samples_beside_settings_are_a_table_with_their_units() {
        let settings = [
            ("Record Length", "2.5e3"),
            ("Trigger Point", "130"),
            ("", ""),
            ("Source", "CH1"),
            ("Vertical Units", "A"),
            ("Horizontal Units", "s"),
        ];
        let (names, rows) = table(file(&settings, 100).as_bytes()).unwrap();
        assert_eq!(names, ["Time [s]", "CH1 [A]"]);
        let text = String::from_utf8(rows).unwrap();
        assert!(text.starts_with("-0.0100,10.00\n-0.0099,9.99\n") && text.lines().count() == 100, "{text}");
        // Rows that begin with a word, or with an empty field now and then, are none.
        assert!(table(file(&settings, 8).as_bytes()).is_none());
        let words: String = (0..100).map(|k| format!("ODOM,{k},1\n")).collect();
        let empty: String =
            (0..100).map(|k| if k % 9 == 0 { format!(",{k},1\n") } else { format!("{k},{k},1\n") }).collect();
        for other in [words, format!("t,a,b\n{empty}"), format!("t,a,b\n{}", ",,1\n".repeat(90))] {
            assert!(table(other.as_bytes()).is_none(), "{other}");
        }
    }
}
