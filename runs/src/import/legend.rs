//! Names of columns that a file tells in remarks above its numbers, each after the number of its column, as `% 1 time [s]` or
//! `% 2 3 wheel velocity [m/s] left, right: 0.1 0.2`.

use super::units;

/// Lines of a legend at least: one with a number in front is any remark.
const LINES: usize = 2;

/// A line of a legend: the columns that it is of, from 0, and what it says of them.
struct Line<'a> {
    columns: Vec<usize>,
    text: &'a str,
}

/// The names that such remarks give to so many columns; nothing where they are no legend of half of them.
pub(super) fn names(remarks: &[&[u8]], columns: usize) -> Option<Vec<String>> {
    let remarks: Vec<&str> = remarks.iter().filter_map(|remark| std::str::from_utf8(remark).ok()).collect();
    let mut lines: Vec<Line> = remarks.into_iter().filter_map(line).collect();
    // A range that is said to end where the next line begins ends before it.
    for i in 1..lines.len() {
        let next = lines[i].columns[0];
        let columns = &mut lines[i - 1].columns;
        if let [a, b] = columns[..]
            && b == next
            && a + 1 < b
        {
            columns[1] = b - 1;
        }
    }
    // Some count from 0.
    let from = usize::from(!lines.iter().any(|line| line.columns.contains(&0)));
    let numbers = || lines.iter().flat_map(|line| line.columns.iter().copied());
    let sorted = numbers().zip(numbers().skip(1)).all(|(a, b)| a < b);
    if lines.len() < LINES || !sorted || numbers().any(|n| n < from || n >= columns + from) {
        return None;
    }
    let first: Vec<usize> = lines.iter().map(|line| line.columns[0]).collect();
    for (i, line) in lines.iter_mut().enumerate() {
        // Two numbers with columns between them that no other line has are the first and the last.
        if let [a, b] = line.columns[..]
            && first.get(i + 1).is_none_or(|next| *next > b)
        {
            line.columns = (a..=b).collect();
        }
    }
    let mut names: Vec<Option<String>> = vec![None; columns];
    for line in &lines {
        for (column, name) in line.columns.iter().zip(parts(line.text, line.columns.len())) {
            let twice = names.iter().flatten().any(|other| *other == name);
            names[column - from] = Some(if twice { format!("{name} {column}") } else { name });
        }
    }
    let told = names.iter().flatten().count();
    let name = |(i, name): (usize, Option<String>)| name.unwrap_or_else(|| format!("column_{}", i + 1));
    (2 * told >= columns).then(|| names.into_iter().enumerate().map(name).collect())
}

/// A remark that begins with numbers of columns, perhaps with `column` before them, and goes on in words.
fn line(remark: &str) -> Option<Line<'_>> {
    let mut text = remark.trim_start();
    if let Some((word, rest)) = text.split_once(char::is_whitespace)
        && ["col", "column", "spalte", "colonne", "columna", "coluna", "colonna"].contains(&&*word.to_lowercase())
    {
        text = rest.trim_start();
    }
    let mut columns = Vec::new();
    while let Some(digits) = text.find(|c: char| !c.is_ascii_digit()).filter(|digits| *digits > 0) {
        let rest = &text[digits..];
        let ends = rest.starts_with(|c: char| c.is_whitespace() || ":)=-,".contains(c))
            || rest.strip_prefix('.').is_some_and(|rest| rest.starts_with(char::is_whitespace));
        if !ends {
            break; // a date, a measured value, `3x`
        }
        columns.push(text[..digits].parse().ok()?);
        text = rest.trim_start_matches(|c: char| c.is_whitespace() || ".:)=-,".contains(c));
    }
    let worded = text.starts_with(|c: char| c.is_alphabetic() || c == '(');
    (!columns.is_empty() && worded).then_some(Line { columns, text })
}

/// What a text says of each of so many columns: `x, y [m, m]` of two, `velocity [m/s] left, right` of two, and where examples
/// stand after a colon, a word among them that begins what is said of the rest, as `left, right: 0.1 0.2 delay 3 4` of four.
fn parts(text: &str, columns: usize) -> Vec<String> {
    let (said, examples) = text.split_once(':').unwrap_or((text, ""));
    let (said, units) = without_units(said);
    let unit = |i: usize| match &units[..] {
        [one] => Some(one.as_str()),
        many if many.len() == columns => Some(many[i].as_str()),
        _ => None,
    };
    let with_unit = |name: String, i: usize| match unit(i) {
        Some(unit) => format!("{name} [{unit}]"),
        None => name,
    };
    let pieces: Vec<String> = apart(&said).iter().map(|piece| worded(piece)).collect();
    if columns == 1 {
        return vec![with_unit(pieces.into_iter().next().unwrap_or_default(), 0)];
    }
    let (stem, own) = match pieces[0].rsplit_once(' ') {
        Some((stem, own)) if pieces.len() > 1 => (format!("{stem} "), own.to_owned()),
        _ => (String::new(), pieces[0].clone()),
    };
    let items: Vec<String> = std::iter::once(own).chain(pieces[1..].iter().cloned()).collect();
    if items.len() == columns {
        return items.iter().enumerate().map(|(i, item)| with_unit(format!("{stem}{item}"), i)).collect();
    }
    // Of several values a pair, say, each group after a word of its own.
    let words: Vec<&str> = examples.split_whitespace().filter(|w| w.starts_with(char::is_alphabetic)).collect();
    if items.len() > 1 && columns == items.len() * (words.len() + 1) {
        let group = |(g, word): (usize, &str)| -> Vec<String> {
            let name = |item: &String| format!("{stem}{word}{item}");
            items.iter().map(|item| if g == 0 { with_unit(name(item), 0) } else { name(item) }).collect()
        };
        let words: Vec<String> =
            std::iter::once(String::new()).chain(words.iter().map(|word| format!("{word} "))).collect();
        return words.iter().enumerate().flat_map(|(g, word)| group((g, word))).collect();
    }
    let whole = worded(&said);
    (0..columns).map(|i| with_unit(format!("{whole} {}", i + 1), i)).collect()
}

/// A text without its units in brackets, and these.
fn without_units(text: &str) -> (String, Vec<String>) {
    let brackets = text.find('[').and_then(|open| Some((open, open + text[open..].find(']')?)));
    let Some((open, close)) = brackets else { return (text.to_owned(), Vec::new()) };
    let units: Vec<String> = text[open + 1..close].split(',').map(|unit| unit.trim().to_owned()).collect();
    let known = units.iter().any(|unit| units::in_name(&format!("x [{unit}]")).is_some());
    let bare = format!("{}{}", &text[..open], &text[close + 1..]);
    if known { (bare, units) } else { (text.to_owned(), Vec::new()) }
}

/// What commas part, where they are not in parentheses.
fn apart(text: &str) -> Vec<&str> {
    let mut depth = 0_usize;
    text.split(|c| {
        match c {
            '(' => depth += 1,
            ')' => depth = depth.saturating_sub(1),
            _ => {}
        }
        c == ',' && depth == 0
    })
    .collect()
}

/// The words of a piece up to its first value: `time 3.04 sec` is `time`; all of them where it begins with one.
fn worded(piece: &str) -> String {
    let words = piece.split_whitespace().map(|word| word.trim_matches(|c: char| "(),;".contains(c)));
    let is_value = |word: &&str| word.starts_with(|c: char| c.is_ascii_digit() || c == '-');
    let before: Vec<&str> = words.take_while(|word| !is_value(word)).filter(|word| !word.is_empty()).collect();
    before.join(" ")
}

#[cfg(test)]
mod tests {
    use super::names;

    fn of(text: &str, columns: usize) -> Option<Vec<String>> {
        names(&text.lines().map(str::as_bytes).collect::<Vec<_>>(), columns)
    }

    #[test]
    fn a_line_for_each_column_or_for_several() {
        let plain = of("made by hand\n1 time [s]\n2 left speed [m/s]\n3 right speed [m/s]", 3).unwrap();
        assert_eq!(plain, ["time [s]", "left speed [m/s]", "right speed [m/s]"]);
        assert_eq!(of("col 0: t\ncol 1: enc", 2).unwrap(), ["t", "enc"]);
        assert_eq!(of("1) t\n2) enc\n4) u", 4).unwrap(), ["t", "enc", "column_3", "u"]);
        let log = " 1    time 3.04 sec, of robot (8)\n 2  3   (mission 0), state 8\n 4  5 motor voltage [V] left, right: 1.2 1.3\n \
                   6 9 wheel velocity [m/s] left, right: 0.07 0.09 delay 0.005 0.004 (sec)\n\
                   10 11 12 pose x,y,h [m,m,rad]: 0.8 -3e-5 0";
        let names = [
            "time",
            "mission",
            "state",
            "motor voltage left [V]",
            "motor voltage right [V]",
            "wheel velocity left [m/s]",
            "wheel velocity right [m/s]",
            "wheel velocity delay left",
            "wheel velocity delay right",
            "pose x [m]",
            "pose y [m]",
            "pose h [rad]",
        ];
        assert_eq!(of(log, 12).unwrap(), names);
    }

    #[test]
    fn a_range_may_end_where_the_next_line_begins() {
        let log = "1 time 0.1 sec\n2 3 motor voltage [V] left, right: 2 2\n4 .. 9 line sensor: left 0, right 0\n9 battery voltage [V]: 12";
        let named = of(log, 9).unwrap();
        assert_eq!((&*named[0], &*named[2], &*named[8]), ("time", "motor voltage right [V]", "battery voltage [V]"));
    }

    #[test]
    fn other_remarks_are_no_legend() {
        assert_eq!(of("1 robot, 2 wheels", 3), None);
        assert_eq!(of("2019-04-03 in the hall\n12 volts", 3), None);
        assert_eq!(of("5 runs\n2 drives each", 6), None, "no order");
        assert_eq!(of("1 t\n2 u\n9 w", 3), None, "more than there are");
        assert_eq!(of("1 t\n2 u", 5), None, "of too few");
        assert_eq!(of("3.5 V\n4.5 V", 3), None);
    }
}
