//! The parts of `racbot demo`: everything once, with what is built in.

mod board;
mod page;
mod parts;

use serde_json::Value;

/// What the demo did, part by part.
#[derive(Debug, Default)]
pub(crate) struct Report {
    /// In the order in which they were done.
    pub(crate) parts: Vec<Part>,
    pictures: Vec<Picture>,
}

/// A step of the demo: what it shows and whether it held.
#[derive(Clone, Debug)]
pub(crate) struct Part {
    /// Short name.
    pub(crate) name: &'static str,
    /// What came out, line by line, at most 52 characters each.
    pub(crate) details: Vec<String>,
    /// Whether all is well.
    pub(crate) good: bool,
    /// The outcome in a line, for the failure.
    pub(crate) outcome: String,
    /// Figures for programs.
    figures: Value,
}

impl Part {
    /// For programs.
    pub(crate) fn to_json(&self) -> Value {
        let mut json = self.figures.clone();
        json["part"] = self.name.into();
        json["good"] = self.good.into();
        json
    }
}

/// A picture of the report.
#[derive(Clone, Debug)]
struct Picture {
    name: &'static str,
    caption: String,
    svg: String,
}

impl Report {
    /// All in a sentence.
    fn outcome(&self) -> String {
        match self.parts.iter().find(|part| !part.good) {
            None => format!("All {} parts came out as they should.", self.parts.len()),
            Some(part) => format!("{} is wrong: {}.", part.name, part.outcome),
        }
    }

    /// The report's files: the page with everything, and the pictures alone.
    pub(crate) fn files(&self) -> Vec<(String, String)> {
        let pictures = self.pictures.iter().map(|p| (format!("{}.svg", p.name), p.svg.clone()));
        std::iter::once(("index.html".to_owned(), page::html(self))).chain(pictures).collect()
    }
}
