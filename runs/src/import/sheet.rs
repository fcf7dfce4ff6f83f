//! A text table as its writer left it: remarks before it, names of columns after a `#` or none, blanks between fields.

use std::borrow::Cow;

use super::line::{REMARKS, fields, is_number, with_units};
use crate::read::separator;

/// Rows after the first that are looked at to find out whether each begins with a word of its own.
const LOOKED_AT: usize = 64;

/// Most rows of a table that has one for each series, and how many times as many samples each must have at least: a log has
/// hundreds, and few columns.
const SERIES: usize = 32;
const LONGER: usize = 10;

/// Lines of words above a table without names at most.
const TITLES: usize = 16;

/// A table whose rows have one separator.
pub(super) struct Sheet<'a> {
    /// Names of the columns if the first record does not hold them.
    pub(super) names: Option<Vec<String>>,
    /// The rows, each on the line where it was.
    pub(super) rows: Cow<'a, [u8]>,
    /// What stands between fields.
    pub(super) separator: u8,
    /// Whether every row begins with a word that says which kind of row it is.
    pub(super) tagged: bool,
}

/// Names of columns that have none.
pub(super) fn numbered(columns: usize) -> Vec<String> {
    (1..=columns).map(|i| format!("column_{i}")).collect()
}

impl<'a> Sheet<'a> {
    pub(super) fn of(bytes: &'a [u8]) -> Self {
        let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
        if let Some(bare) = unquoted(bytes).or_else(|| printed(bytes)) {
            let Sheet { names, rows, separator, tagged } = Sheet::of(&bare);
            return Self { names, rows: Cow::Owned(rows.into_owned()), separator, tagged };
        }
        if let Some(rows) = barred(bytes) {
            return Self { names: None, rows: Cow::Owned(rows), separator: b';', tagged: false };
        }
        let own_layout = super::labelled::table(bytes).or_else(|| super::trace::table(bytes)).or_else(|| lying(bytes));
        if let Some((names, rows)) = own_layout {
            return Self { names: Some(names), rows: Cow::Owned(rows), separator: b';', tagged: false };
        }
        if let Some((names, rows)) = super::scope::table(bytes) {
            return Self { names: Some(names), rows: Cow::Owned(rows), separator: b',', tagged: false };
        }
        if let Some((names, above)) = super::titles::table(bytes) {
            let line = |(i, line): (usize, &[u8])| if i < above { b"\n".to_vec() } else { line.to_vec() };
            let rows: Vec<u8> = bytes.split_inclusive(|b| *b == b'\n').enumerate().flat_map(line).collect();
            let separator = separator(rows.trim_ascii_start());
            return Self { names: Some(names), rows: Cow::Owned(rows), separator, tagged: false };
        }
        if let Some(remarked) = titled(bytes) {
            let Sheet { names, rows, separator, tagged } = Sheet::of(&remarked);
            return Self { names, rows: Cow::Owned(rows.into_owned()), separator, tagged };
        }
        if let Some((names, rows)) = spaced(bytes) {
            return Self { names: Some(names), rows: Cow::Owned(rows), separator: b';', tagged: false };
        }
        let mut before = Vec::new();
        let mut lines = bytes.split(|b| *b == b'\n').map(<[u8]>::trim_ascii).filter(|line| !line.is_empty());
        let mut first: &[u8] = &[];
        for line in lines.by_ref() {
            match remark(line) {
                Some(remark) => before.push(remark),
                None => {
                    first = line;
                    break;
                }
            }
        }
        let mut lines = lines.filter(|line| remark(line).is_none()).take(LOOKED_AT);
        let second = lines.next();
        let mut separator = separator(first);
        let blanks = !first.contains(&separator) && first.iter().any(u8::is_ascii_whitespace);
        if blanks {
            separator = b';'; // beside which a decimal comma is one
        }
        let fields = fields(first, blanks, separator);
        let fit = |said: &Vec<String>| said.len() == fields.len() && said.len() > 1;
        let named = |line: &&[u8]| {
            let plain = super::line::fields(line, blanks, separator);
            if fit(&plain) { plain } else { loose(line).into_iter().find(fit).unwrap_or_default() }
        };
        let mut said = before.iter().rev().map(named);
        let mut said = || said.next().filter(fit);
        let texts = fields.iter().any(|field| !is_number(field, separator));
        let names = if texts {
            // Names after the mark of a remark, as of `rostopic echo -p`, above rows of numbers and texts; or none, where a
            // row has a word or a hexadecimal among its numbers.
            let timed = super::dates::seconds(&fields[0]).is_some();
            let row = timed || !fields[0].is_empty() && is_number(&fields[0], separator);
            let numbers = fields.iter().filter(|field| !field.is_empty() && is_number(field, separator)).count();
            let named = said().filter(|names| row && names.iter().all(|name| !is_number(name, separator)));
            named
                .or_else(|| super::legend::names(&before, fields.len()).filter(|_| row))
                .or_else(|| (row && 2 * numbers > fields.len()).then(|| numbered(fields.len())))
        } else {
            // Units may stand in a line of their own below the names.
            let named = said().and_then(|last| {
                if last.iter().all(|f| is_unit(f)) { said().map(|names| with_units(names, &last)) } else { Some(last) }
            });
            let named = named.or_else(|| super::legend::names(&before, fields.len()));
            Some(named.unwrap_or_else(|| numbered(fields.len())))
        };
        let rows = if blanks || !before.is_empty() { Cow::Owned(plain(bytes, blanks)) } else { Cow::Borrowed(bytes) };
        // Of one such line its word is the name of the column of time, and numbers name the others. Words may stand among
        // the numbers: `IMU;2022:06:01 13:42:57.76;Orientation;0.2;0.1`.
        let tagged = second.is_some_and(|second| {
            [&fields, &super::line::fields(second, blanks, separator)].iter().all(|fields| {
                let [word, rest @ ..] = &fields[..] else { return false };
                let is_time = |field: &String| super::dates::seconds(field).is_some();
                let numbers = rest.iter().filter(|n| is_number(n, separator) || is_time(n)).count();
                !is_number(word, separator) && !is_time(word) && rest.len() > 1 && 2 * numbers > rest.len()
            })
        });
        // A word that no other row has is the row's own name, such as that of a picture.
        let mut own = vec![&fields[0]];
        let words = second.into_iter().chain(lines).map(|line| super::line::fields(line, blanks, separator));
        let rest: Vec<Vec<String>> = if tagged { words.collect() } else { Vec::new() };
        let labelled = rest.len() > 1
            && rest.iter().all(|row| {
                let is_new = row.len() == fields.len() && !own.contains(&&row[0]);
                own.push(&row[0]);
                is_new
            });
        let above = before.last().map(named).filter(fit);
        let names = if labelled { above.or_else(|| Some(numbered(fields.len()))) } else { names };
        Self { names: names.filter(|_| !first.is_empty()), rows, separator, tagged: tagged && !labelled }
    }
}

/// A table that has a row for each series, as of `numpy.savetxt("x.csv", [t, x, y])`, set upright; a row may begin with the
/// name of its series.
fn lying(bytes: &[u8]) -> Option<(Vec<String>, Vec<u8>)> {
    let mut lines = bytes.split(|b| *b == b'\n').map(<[u8]>::trim_ascii).filter(|line| !line.is_empty());
    let first = lines.next()?;
    let lines: Vec<&[u8]> = std::iter::once(first).chain(lines.take(SERIES)).collect();
    let separator = separator(first);
    let blanks = !first.contains(&separator);
    let rows: Vec<Vec<String>> = lines.iter().map(|line| super::line::fields(line, blanks, separator)).collect();
    let width = rows[0].len();
    let named = rows.iter().all(|row| !is_number(&row[0], separator));
    let numbers = |row: &Vec<String>| row[usize::from(named)..].iter().all(|field| is_number(field, separator));
    if !(2..=SERIES).contains(&rows.len()) || width < LONGER * rows.len().max(SERIES / 2) {
        return None;
    }
    if !rows.iter().all(|row| row.len() == width && numbers(row)) {
        return None;
    }
    let name = |(i, row): (usize, &Vec<String>)| if named { row[0].clone() } else { format!("row_{}", i + 1) };
    let names = rows.iter().enumerate().map(name).collect();
    let sample = |k: usize| rows.iter().map(|row| row[k].as_str()).collect::<Vec<_>>().join(";");
    let upright = (usize::from(named)..width).map(|k| sample(k) + "\n").collect::<String>();
    Some((names, upright.into_bytes()))
}

/// The lines without their quotes, where each is in quotes as a whole: a table that was written as one column of texts.
fn unquoted(bytes: &[u8]) -> Option<Vec<u8>> {
    let bare = |line: &'_ [u8]| -> Option<std::ops::Range<usize>> {
        let inside = line.trim_ascii().strip_prefix(b"\"")?.strip_suffix(b"\"")?;
        let plain = !inside.contains(&b'"') && inside.iter().any(|b| b",;\t".contains(b));
        let from = line.iter().position(|b| *b == b'"')? + 1;
        plain.then_some(from..from + inside.len())
    };
    let filled = || bytes.split(|b| *b == b'\n').filter(|line| !line.trim_ascii().is_empty());
    if filled().next().is_none() || !filled().all(|line| bare(line).is_some()) {
        return None;
    }
    let line = |line: &[u8]| [bare(line).map_or(&[][..], |inside| &line[inside]), b"\n"].concat();
    Some(bytes.split_inclusive(|b| *b == b'\n').flat_map(line).collect())
}

/// The text of lines that were written as Python shows bytes, such as those of a serial port that nobody decoded:
/// `b'5460,12,13\r\n'`, alone or after a time of arrival. Names may stand above.
fn printed(bytes: &[u8]) -> Option<Vec<u8>> {
    let text = |line: &[u8]| -> Option<Vec<u8>> {
        let begins = |at: usize| at == 0 || b",;\t ".contains(&line[at - 1]);
        let at = (0..line.len().saturating_sub(1))
            .find(|at| begins(*at) && line[*at] == b'b' && [b'\'', b'"'].contains(&line[at + 1]))?;
        let inside = &line[at + 2..];
        // An escape ends what the port sent of a line, or the quote does; a line may also be cut off there.
        let ends = inside.iter().position(|b| *b == b'\\' || *b == line[at + 1]);
        Some([&line[..at], &inside[..ends.unwrap_or(inside.len())]].concat())
    };
    let lines = || bytes.split(|b| *b == b'\n').map(<[u8]>::trim_ascii);
    // Most tables are none by their second line.
    let mut below = lines().filter(|line| !line.is_empty()).skip(1).peekable();
    if below.peek().is_none() || !below.all(|line| text(line).is_some()) {
        return None;
    }
    Some(lines().map(|line| text(line).unwrap_or_else(|| line.to_vec())).collect::<Vec<_>>().join(&b'\n'))
}

/// The lines with titles as remarks, where lines of words stand above rows of numbers that are apart as no word of these is:
/// `Console - port 0` above `0.01,0,1.5`. Words as many as columns are their names.
fn titled(bytes: &[u8]) -> Option<Vec<u8>> {
    let filled = || bytes.split(|b| *b == b'\n').map(<[u8]>::trim_ascii).filter(|line| !line.is_empty());
    let marked = |line: &[u8]| remark(line).is_some() || line.iter().any(|b| b",;\t|".contains(b));
    let titles = filled().take(TITLES + 1).take_while(|line| !marked(line)).count();
    let first = filled().nth(titles).filter(|_| (1..=TITLES).contains(&titles))?;
    let separator = separator(first);
    let rows: Vec<Vec<String>> =
        filled().skip(titles).take(LOOKED_AT).map(|line| super::line::fields(line, false, separator)).collect();
    let width = rows[0].len();
    // A comma between two whole numbers may be that of a decimal.
    let parted = separator != b',' || width > 2 || rows.iter().flatten().any(|field| field.contains('.'));
    let numbers = |row: &Vec<String>| row.len() == width && row.iter().all(|field| is_number(field, separator));
    let worded = |line: &[u8]| line.iter().any(u8::is_ascii_alphabetic);
    if width < 2 || rows.len() < 2 || !parted || !rows.iter().all(numbers) || !filled().take(titles).all(worded) {
        return None;
    }
    let mut left = titles;
    let line = |line: &[u8]| {
        if left == 0 || line.trim_ascii().is_empty() {
            return line.to_vec();
        }
        left -= 1;
        let words: Vec<&[u8]> = line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty()).collect();
        let names = words.len() == width && words.iter().all(|word| word[0].is_ascii_alphabetic());
        let text = if names { words.join(&separator) } else { line.trim_ascii().to_vec() };
        [b"# ", &text[..], b"\n"].concat()
    };
    Some(bytes.split_inclusive(|b| *b == b'\n').flat_map(line).collect())
}

/// The lines with semicolons in place of the bars between their fields, `| t | x |` and `t | x |`; titles above and rules below
/// the names are emptied. Names may have a bar too many, as between tables that were put side by side.
fn barred<'a>(bytes: &'a [u8]) -> Option<Vec<u8>> {
    let lines: Vec<&[u8]> = bytes.split(|b| *b == b'\n').map(<[u8]>::trim_ascii).collect();
    let first = lines.iter().position(|line| line.contains(&b'|'))?;
    let drawn = |line: &[u8]| line.iter().all(|b| b"-=+:| ".contains(b));
    let titles = lines[..first].iter().all(|line| line.is_empty() || drawn(line) || !line.contains(&b','));
    if !titles || lines[first..].iter().any(|line| !drawn(line) && !line.contains(&b'|')) {
        return None;
    }
    let inside = |line: &'a [u8]| line.strip_prefix(b"|").unwrap_or(line);
    let inside = |line: &'a [u8]| inside(line).strip_suffix(b"|").unwrap_or(inside(line));
    let fields =
        |line: &'a [u8]| -> Vec<&'a [u8]> { inside(line).split(|b| *b == b'|').map(<[u8]>::trim_ascii).collect() };
    let mut rows = lines[first..].iter().copied().filter(|line| !drawn(line)).map(fields);
    let (names, row) = (rows.next()?, rows.next()?);
    let filled = || names.iter().copied().filter(|name| !name.is_empty());
    let names = if filled().count() == row.len() { filled().collect() } else { names };
    let line = |(i, line): (usize, &&'a [u8])| match i {
        i if i == first => names.join(&b';'),
        i if i < first || drawn(line) => Vec::new(),
        _ => fields(line).join(&b';'),
    };
    Some(lines.iter().enumerate().map(line).collect::<Vec<_>>().join(&b'\n'))
}

/// What a line says after the mark of a remark.
fn remark(line: &[u8]) -> Option<&[u8]> {
    REMARKS.iter().find_map(|mark| line.strip_prefix(mark.as_bytes())).map(<[u8]>::trim_ascii)
}

/// The names of a remark in the ways in which they may be apart, where rows are apart in another: by commas, semicolons,
/// or more blanks than one, `Time [s]    forward velocity [m/s]`.
fn loose(line: &[u8]) -> Vec<Vec<String>> {
    let text = String::from_utf8_lossy(line);
    let clean = |parts: Vec<&str>| -> Vec<String> { parts.into_iter().map(|part| part.trim().to_owned()).collect() };
    let mut ways = vec![clean(text.split(',').collect()), clean(text.split(';').collect())];
    ways.push(clean(
        text.split("  ").flat_map(|part| part.split('\t')).filter(|part| !part.trim().is_empty()).collect(),
    ));
    ways.retain(|names| names.iter().all(|name| name.starts_with(char::is_alphabetic)));
    ways
}

/// Names of several words apart by more blanks than one, above rows of as many numbers, which may stand in brackets as a matrix of
/// MATLAB does: `Time   Encoder 1 Pos   Control Effort`.
fn spaced(bytes: &[u8]) -> Option<(Vec<String>, Vec<u8>)> {
    let numbers = |line: &[u8]| -> Vec<String> {
        let text = String::from_utf8_lossy(line);
        let inside = text.trim_matches(|c: char| c.is_whitespace() || "[];".contains(c));
        inside.split_whitespace().map(str::to_owned).collect()
    };
    let mut lines = bytes.split_inclusive(|b| *b == b'\n').skip_while(|line| line.trim_ascii().is_empty());
    let head = lines.next()?.trim_ascii();
    if head.iter().any(|b| b",;|\t".contains(b)) {
        return None;
    }
    let names = loose(head).pop()?;
    if names.len() < 2 || !names.iter().any(|name| name.contains(' ')) {
        return None;
    }
    let rows: Vec<Vec<String>> = lines.map(numbers).collect();
    let fits = |row: &&Vec<String>| row.len() == names.len() && row.iter().all(|field| is_number(field, b';'));
    let mut looked_at = rows.iter().filter(|row| !row.is_empty()).take(LOOKED_AT).peekable();
    looked_at.peek()?;
    if !looked_at.all(|row| fits(&row)) {
        return None;
    }
    // Every line stays where it was.
    let above = bytes.split(|b| *b == b'\n').position(|line| !line.trim_ascii().is_empty())?;
    let mut out = vec![b'\n'; above + 1];
    for row in rows {
        out.extend_from_slice(row.join(";").as_bytes());
        out.push(b'\n');
    }
    Some((names, out))
}

/// Whether a field is a unit alone: `[V]`, `(turns/s)`.
fn is_unit(field: &str) -> bool {
    field.starts_with('[') && field.ends_with(']') || field.starts_with('(') && field.ends_with(')')
}

/// The same lines with remarks emptied and, if asked, semicolons in place of blanks.
fn plain(bytes: &[u8], blanks: bool) -> Vec<u8> {
    let mut out = Vec::with_capacity(bytes.len());
    for line in bytes.split_inclusive(|b| *b == b'\n') {
        let own = line.trim_ascii();
        if remark(own).is_none() {
            if blanks {
                let words = own.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
                words.enumerate().for_each(|(i, word)| {
                    out.extend((i > 0).then_some(b';'));
                    out.extend_from_slice(word);
                });
            } else {
                out.extend_from_slice(own);
            }
        }
        out.extend(line.ends_with(b"\n").then_some(b'\n'));
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sheet(text: &str) -> (Option<Vec<String>>, String, char) {
        let sheet = Sheet::of(text.as_bytes());
        (sheet.names, String::from_utf8(sheet.rows.into_owned()).unwrap(), sheet.separator.into())
    }

    /// As the software of a laboratory's servo trainer writes it: six names were ten, and four columns had the names of others.
    #[test]
    fn names_of_several_words_stand_above_blanks() {
        let names = |of: &[&str]| Some(of.iter().map(|n| (*n).to_owned()).collect::<Vec<_>>());
        let text = " Sample   Time     Encoder 1 Pos   Control Effort\n\n[    0    0.000    0   0.1000;\n     1    0.022    -7   0.0000];\n";
        let (found, rows, separator) = sheet(text);
        assert_eq!(found, names(&["Sample", "Time", "Encoder 1 Pos", "Control Effort"]));
        assert_eq!((rows.as_str(), separator), ("\n\n0;0.000;0;0.1000\n1;0.022;-7;0.0000\n", ';'));
        // Names of one word, and rows of as many fields as there are words.
        assert_eq!(sheet("t   a\n0   1\n").0, None);
        assert_eq!(sheet("t  a b\n0  1 2\n").0, None);
    }

    #[test]
    fn blanks_remarks_and_missing_names_make_one_table() {
        let names = |of: &[&str]| Some(of.iter().map(|n| (*n).to_owned()).collect::<Vec<_>>());
        assert_eq!(sheet("t,a\n0,1\n"), (None, "t,a\n0,1\n".into(), ','));
        let quoted = (names(&["column_1", "column_2"]), "10, 7.6e-05\n\n10, 0.02\n".into(), ',');
        assert_eq!(sheet("\"10, 7.6e-05\"\r\n\n\"10, 0.02\""), quoted);
        assert_eq!(sheet("\"t, s\",a\n\"0\",1\n").1, "\"t, s\",a\n\"0\",1\n");
        assert_eq!(sheet("  t   a\n  0   1,5\n"), (None, "t;a\n0;1,5\n".into(), ';'));
        assert_eq!(sheet("# by me\n# t a\n0 1\n"), (names(&["t", "a"]), "\n\n0;1\n".into(), ';'));
        assert_eq!(sheet("0.0 1.5\r\n0.1 2\r\n"), (names(&["column_1", "column_2"]), "0.0;1.5\n0.1;2\n".into(), ';'));
        assert_eq!(sheet("0\t1\n"), (names(&["column_1", "column_2"]), "0\t1\n".into(), '\t'));
        assert_eq!(sheet("% made 2019, for us\nt;a\n0;1,5\n"), (None, "\nt;a\n0;1,5\n".into(), ';'));
        assert_eq!(sheet("# t,a\n0,1\n# pause\n1,2\n"), (names(&["t", "a"]), "\n0,1\n\n1,2\n".into(), ','));
        assert_eq!(
            sheet("%time,frame,enc\n5,odom,1\n6,odom,2\n"),
            (names(&["time", "frame", "enc"]), "\n5,odom,1\n6,odom,2\n".into(), ',')
        );
        assert_eq!(sheet("# a,b,c\ntime,u,1\n0,5,6\n").0, None);
        // Bars between the fields, a title above, a rule below, and a bar too many among the names.
        for (text, rows) in [
            ("Made by me\n t | x | \n0 | 1 |\n1 | 2 |\n", "\nt;x\n0;1\n1;2\n"),
            ("| t | x |\n|---|---|\n| 0 | 1,5 |\n| 1 | |\n", "t;x\n\n0;1,5\n1;\n"),
            ("t |\t| x\n0 | 1 |\n1 | 2 |\n", "t;x\n0;1\n1;2\n"),
        ] {
            assert_eq!(sheet(text), (None, rows.into(), ';'), "{text}");
        }
        assert_eq!(sheet("t,a|b\n0,1\n").2, ',');
        // As Python shows bytes: whole, cut off, below names, after a time, with names before the numbers.
        let serial = (names(&["column_1", "column_2"]), "5,0\n6,-2\n".into(), ',');
        for lines in [["b'5,0\\r\\n'", "b'6,-2\\r\\n'"], ["b'5,0\\r\\", "b'6,-2\\r\\"], ["5,b\"0\\n\"", "6,b\"-2\\n\""]]
        {
            assert_eq!(sheet(&(lines.join("\n") + "\n")), serial, "{lines:?}");
        }
        assert_eq!(sheet("t,a\nb'5,0\\r\\n'\n").1, "t,a\n5,0\n");
        assert_eq!(sheet("b't:5 a:0\\r\\n'\nb't:6 a:1\\r\\n'\n").0, names(&["t", "a"]));
        assert_eq!(sheet("t,b'\n0,1\n1,2\n").1, "t,b'\n0,1\n1,2\n");
        // A row for each series.
        let row = |name: &str, step: f64| {
            let samples = (0..200).map(|k| (step * f64::from(k)).to_string()).collect::<Vec<_>>();
            format!("{name}{}\n", samples.join(","))
        };
        let lying = sheet(&(row("", 0.5) + &row("", -2.0)));
        assert_eq!((lying.0, lying.2), (names(&["row_1", "row_2"]), ';'));
        assert!(lying.1.starts_with("0;-0\n0.5;-2\n") && lying.1.lines().count() == 200, "{}", lying.1);
        assert_eq!(sheet(&(row("t,", 0.5) + &row("x,", -2.0))).0, names(&["t", "x"]));
        // Names apart otherwise than the numbers.
        let two = names(&["Time [s]", "forward velocity [m/s]"]);
        for head in [
            "# Time [s]    forward velocity [m/s]",
            "# Time [s]\tforward velocity [m/s]",
            "# Time [s], forward velocity [m/s]",
        ] {
            assert_eq!(sheet(&format!("# by me, in 2009\n{head}\n0.1 \t 2\n0.2 \t 3\n")).0, two, "{head}");
        }
        assert_eq!(sheet("% by me\n% t,u\n% [#],[V]\nnan,nan;\n0,1;\n").0, names(&["t", "u [V]"]));
        // A row with a text among its numbers holds no names.
        let row = "% 1 time, 2 flags, 3 speed\n0.1 0x0 1.5\n0.2 0x1 2\n";
        assert_eq!(
            sheet(row),
            (names(&["column_1", "column_2", "column_3"]), "\n0.1;0x0;1.5\n0.2;0x1;2\n".into(), ';')
        );
        assert_eq!(sheet("0.1,on,1.5\n0.2,off,2\n").0, names(&["column_1", "column_2", "column_3"]));
        // Titles without a mark of a remark, above rows without names.
        let title = "Console - port: 0\n.01,0,0\n0.02,1,2\n";
        assert_eq!(sheet(title), (names(&["column_1", "column_2", "column_3"]), "\n.01,0,0\n0.02,1,2\n".into(), ','));
        assert_eq!(sheet("by me\n\nt u w\n0;1;2\n1;1;2\n").0, names(&["t", "u", "w"]));
        assert_eq!(sheet("speed\n0,5\n0,6\n"), (None, "speed\n0,5\n0,6\n".into(), ','));
        assert_eq!(sheet("").0, None);
    }
}
