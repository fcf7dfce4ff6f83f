//! The report as one page that needs no other file.

use super::Report;
use plot::page::{Page, Table};

/// The report as one file of HTML, with the pictures inside.
pub(super) fn html(report: &Report) -> String {
    let mut page = Page::new("racbot demo");
    page.links([
        ("board/gap/report.html", "the gap report of the drives over the card"),
        ("board/gap/robot.toml", "robot.toml with what it named"),
        ("board/runs/robot.toml", "the data set: board/runs"),
    ]);
    page.verdict(&report.outcome());
    let mut table = Table::new(&["part", "result", ""]);
    for part in &report.parts {
        let mark = if part.good { "ok" } else { "wrong" };
        table.row([part.name.to_owned(), part.details.join("\n"), mark.to_owned()]);
    }
    page.table(&table);
    page.note(NEXT);
    for picture in &report.pictures {
        page.figure(&picture.svg, &picture.caption);
    }
    page.finish()
}

/// What a reader does with the rest of his evening.
const NEXT: &str = "Next, your own logs: `racbot convert --draft LOG map.toml` guesses which column is what, \
`racbot convert map.toml LOG my/run_01.csv` makes a run of it, `racbot init my/robot.toml --log my` asks for what it needs, \
`racbot check my` finds mistakes, `racbot gap my` says what your model leaves out.";
