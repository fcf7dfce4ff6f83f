//! One frame for every page that a command leaves: a file that needs no other, light, dark and printed, on a phone and on
//! a desk. Wide tables become cards on narrow screens.

use std::fmt::{Display, Write as _};

use crate::Color;
use crate::svg::escape;

const STYLE: &str = include_str!("page.css");

/// A page that grows from top to bottom.
#[derive(Debug, Clone)]
pub struct Page {
    title: String,
    body: String,
}

impl Page {
    /// A page with its title as first heading.
    pub fn new(title: &str) -> Self {
        Self { title: escape(title), body: format!("<h1>{}</h1>\n", escape(title)) }
    }

    /// Links to other files, as (address, text).
    pub fn links<'a>(&mut self, links: impl IntoIterator<Item = (&'a str, &'a str)>) {
        let links: Vec<String> =
            links.into_iter().map(|(to, text)| format!("<a href=\"{}\">{}</a>", escape(to), escape(text))).collect();
        let _ = writeln!(self.body, "<nav>{}</nav>", links.join(" · "));
    }

    /// The outcome in a sentence.
    pub fn verdict(&mut self, text: &str) {
        let _ = writeln!(self.body, "<p class=\"verdict\">{}</p>", escape(text));
    }

    /// A line of the second level, escaped.
    pub fn heading(&mut self, text: &str) {
        let _ = writeln!(self.body, "<h2>{}</h2>", escape(text));
    }

    /// A place in the page that [`Page::links`] may lead to, as `#name`.
    pub fn anchor(&mut self, name: &str) {
        let _ = writeln!(self.body, "<a id=\"{}\"></a>", escape(name));
    }

    /// A paragraph.
    pub fn text(&mut self, text: &str) {
        let _ = writeln!(self.body, "<p>{}</p>", escape(text));
    }

    /// A paragraph that explains what stands beside it.
    pub fn small(&mut self, text: &str) {
        let _ = writeln!(self.body, "<p class=\"small\">{}</p>", escape(text));
    }

    /// Text as it is, such as source or what a terminal shows.
    pub fn verbatim(&mut self, text: &str) {
        let _ = writeln!(self.body, "<pre>{}</pre>", escape(text.trim_end()));
    }

    /// Points, each escaped.
    pub fn list<T: AsRef<str>>(&mut self, items: impl IntoIterator<Item = T>) {
        let items: String = items.into_iter().map(|item| format!("<li>{}</li>", escape(item.as_ref()))).collect();
        let _ = writeln!(self.body, "<ul>{items}</ul>");
    }

    /// Scrolls sideways where the screen is narrow.
    pub fn table(&mut self, table: &Table) {
        self.body.push_str(&table.html());
    }

    /// A picture (SVG) with what is to see in it.
    pub fn figure(&mut self, svg: &str, caption: &str) {
        let caption =
            if caption.is_empty() { String::new() } else { format!("<figcaption>{}</figcaption>", escape(caption)) };
        let _ = writeln!(self.body, "<figure>\n{svg}{caption}\n</figure>");
    }

    /// Pictures beside each other where there is room.
    pub fn figures(&mut self, svgs: &[String]) {
        let _ = writeln!(self.body, "<div class=\"figures\">{}</div>", svgs.concat());
    }

    /// Bars with labels and values, drawn to a common scale.
    pub fn bars(&mut self, bars: &[(String, f64, Color)]) {
        let top = bars.iter().map(|bar| bar.1).filter(|x| x.is_finite()).fold(f64::MIN_POSITIVE, f64::max);
        self.body.push_str("<div class=\"bars\">");
        for (label, value, color) in bars {
            // A fifth of the width is the figure's.
            let width = if value.is_finite() { 80.0 * (value / top).clamp(0.0, 1.0) } else { 0.0 };
            let _ = write!(
                self.body,
                "<b>{}</b><span><i style=\"width:{width:.1}%;background:{}\"></i>{value:.2}</span>",
                escape(label),
                color.hex()
            );
        }
        self.body.push_str("</div>\n");
    }

    /// What to do next; parts between backquotes are commands.
    pub fn note(&mut self, text: &str) {
        let _ = writeln!(self.body, "<p class=\"note\">{}</p>", with_code(text));
    }

    /// The page as text of a file.
    pub fn finish(self) -> String {
        let Self { title, body } = self;
        format!(
            "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\
             <meta name=\"viewport\" content=\"width=device-width,initial-scale=1\"><title>{title}</title>\
             <style>{STYLE}</style></head>\n<body>\n{body}</body></html>\n"
        )
    }
}

/// A table with a header row.
#[derive(Debug, Clone)]
pub struct Table {
    headers: Vec<String>,
    rows: String,
    class: &'static str,
}

impl Table {
    /// An empty one.
    pub fn new(headers: &[&str]) -> Self {
        Self { headers: headers.iter().map(|h| escape(h)).collect(), rows: String::new(), class: "flow" }
    }

    /// Of centred figures whose cells may have colours.
    #[must_use]
    pub fn heat(mut self) -> Self {
        self.class = "heat flow";
        self
    }

    /// Adds a row of texts.
    pub fn row<T: Display>(&mut self, cells: impl IntoIterator<Item = T>) {
        self.coloured(cells.into_iter().map(|cell| (cell, None)));
    }

    /// Adds a row of texts, each on a colour of its own if it has one.
    pub fn coloured<T: Display>(&mut self, cells: impl IntoIterator<Item = (T, Option<String>)>) {
        self.rows.push_str("<tr>");
        for ((cell, color), of) in cells.into_iter().zip(&self.headers) {
            let style = color.map_or_else(String::new, |color| format!(" style=\"background:{color}\""));
            let cell = with_code(&cell.to_string()).replace('\n', "<br>");
            // A cell that is empty stays so: on a phone it then takes no room.
            let _ = write!(self.rows, "<td data-of=\"{of}\"{style}>{cell}</td>");
        }
        self.rows.push_str("</tr>\n");
    }

    fn html(&self) -> String {
        let head: String = self.headers.iter().map(|h| format!("<th>{h}</th>")).collect();
        format!(
            "<table class=\"{}\"><thead><tr>{head}</tr></thead><tbody>\n{}</tbody></table>\n",
            self.class, self.rows
        )
    }
}

/// Text with its parts between backquotes as code, broken only where they have spaces: not between the hyphens of an
/// option.
fn with_code(text: &str) -> String {
    let code = |part: &str| {
        let words: Vec<String> = part.split(' ').map(|word| format!("<span>{}</span>", escape(word))).collect();
        format!("<code>{}</code>", words.join(" "))
    };
    let parts = text.split('`').zip(0_u32..);
    parts.map(|(part, i)| if i % 2 == 0 { escape(part) } else { code(part) }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whatever_a_log_is_called_is_text() {
        let mut page = Page::new("a <b>");
        page.text("<script>");
        page.note("run `racbot \"x\"`");
        let mut table = Table::new(&["one", "two"]);
        table.row(["<td>", "2 & 3"]);
        page.table(&table);
        let html = page.finish();
        assert!(!html.contains("<script>") && !html.contains("<b>"), "{html}");
        for part in [
            "run <code><span>racbot</span> <span>&quot;x&quot;</span></code>",
            "<td data-of=\"two\">2 &amp; 3</td>",
            "<title>a &lt;b&gt;",
        ] {
            assert!(html.contains(part), "{part}\n{html}");
        }
    }

    #[test]
    fn bars_share_a_scale() {
        let mut page = Page::new("");
        page.bars(&[("all".to_owned(), 2.0, Color::Red), ("half".to_owned(), 1.0, Color::Green)]);
        let html = page.finish();
        assert!(html.contains("width:80.0%") && html.contains("width:40.0%"), "{html}");
        let mut page = Page::new("");
        page.bars(&[("huge".to_owned(), f64::MAX, Color::Red), ("less".to_owned(), -1.0, Color::Green)]);
        let html = page.finish();
        assert!(html.contains("width:80.0%") && html.contains("width:0.0%"), "{html}");
    }
}
