//! Tables of plain text.

/// A table; the first columns are text, to the left, the others numbers, to the right.
#[derive(Clone, Debug)]
pub(crate) struct Table {
    rows: Vec<Vec<String>>,
    text_columns: usize,
}

impl Table {
    /// Without rows; so many of the first columns are text.
    pub(crate) fn new(text_columns: usize, headings: &[&str]) -> Self {
        Self { rows: vec![headings.iter().map(|&heading| heading.to_owned()).collect()], text_columns }
    }

    /// Adds a row.
    pub(crate) fn row(&mut self, cells: impl IntoIterator<Item = String>) {
        self.rows.push(cells.into_iter().collect());
    }

    /// The table, two spaces between columns, a line under the headings.
    pub(crate) fn render(&self) -> String {
        let columns = self.rows.iter().map(Vec::len).max().unwrap_or(0);
        let width = |cell: &String| cell.chars().count();
        let widths: Vec<usize> =
            (0..columns).map(|c| self.rows.iter().filter_map(|row| row.get(c)).map(width).max().unwrap_or(0)).collect();
        let line = |row: &Vec<String>| {
            let cells = row.iter().zip(&widths).enumerate().map(|(c, (cell, &width))| {
                if c < self.text_columns { format!("{cell:<width$}") } else { format!("{cell:>width$}") }
            });
            format!("{}\n", cells.collect::<Vec<_>>().join("  ").trim_end())
        };
        let rule = format!("{}\n", "-".repeat(widths.iter().sum::<usize>() + 2 * columns.saturating_sub(1)));
        let mut rows = self.rows.iter();
        let head = rows.next().map(line).unwrap_or_default();
        format!("{head}{rule}{}", rows.map(line).collect::<String>())
    }
}

/// Widest line of a text.
const COLUMNS: usize = 80;

/// A sentence in lines that fit the terminal, all but the first indented.
pub(crate) fn wrapped(sentence: &str, indent: usize) -> String {
    let (mut out, mut column) = (String::new(), 0);
    for word in sentence.split_whitespace() {
        let width = word.chars().count();
        if column > 0 && column + 1 + width > COLUMNS {
            out.push('\n');
            out.push_str(&" ".repeat(indent));
            column = indent;
        } else if column > 0 {
            out.push(' ');
            column += 1;
        }
        out.push_str(word);
        column += width;
    }
    out.push('\n');
    out
}

/// A sentence after its label, the lines below it under its first word.
pub(crate) fn entry(label: &str, sentence: &str) -> String {
    // Padding that is no white space to `wrapped`, and is taken off again.
    let padded = format!("{label:-<8} {sentence}");
    format!("{label:<8}{}", &wrapped(&padded, 9)[8..])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_to_the_left_numbers_to_the_right() {
        let mut table = Table::new(1, &["name", "°"]);
        table.row(["a".to_owned(), "12".to_owned()]);
        assert_eq!(table.render(), "name   °\n--------\na     12\n");
    }

    #[test]
    fn entries_stand_under_each_other() {
        let text = entry("clock", &"word ".repeat(20));
        assert!(text.starts_with("clock    word word"));
        assert!(text.lines().all(|line| line.len() <= COLUMNS));
        assert!(text.lines().nth(1).unwrap().starts_with("         word"));
    }

    #[test]
    fn sentences_fit_the_terminal() {
        let text = wrapped(&"word ".repeat(40), 3);
        assert!(text.lines().all(|line| line.len() <= COLUMNS && line.len() > 40));
        assert!(text.lines().skip(1).all(|line| line.starts_with("   word")));
    }
}
