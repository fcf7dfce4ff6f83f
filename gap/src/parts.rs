//! A log walked through part by part, each with some ticks before and after it.

use std::ops::Range;
use std::rc::Rc;

use runs::{Columns, Log, Run};

/// Own ticks of a part.
const PART: usize = 1 << 16;
/// Ticks before them: longer than any delay that is looked for; and after them.
const BEFORE: usize = 1 << 12;
const AFTER: usize = 2;

/// Some ticks of a log.
pub(crate) struct Part {
    /// The ticks, and those before and after them.
    pub(crate) run: Run,
    /// Which of them are looked at.
    pub(crate) own: Range<usize>,
}

/// Every tick of a log's loop, once.
pub(crate) fn parts<'a>(log: &'a Log<'a>, columns: Columns) -> impl Iterator<Item = Part> + 'a {
    (0..log.len()).step_by(PART).map(move |first| {
        let end = (first + PART).min(log.len());
        let seen = first.saturating_sub(BEFORE)..(end + AFTER).min(log.len());
        let own = first - seen.start..end - seen.start;
        of_the_loop(Part { own, run: log.part(seen, columns) })
    })
}

/// Without the rows that are a camera's alone: no tick of the loop is at them, nor late by them.
fn of_the_loop(part: Part) -> Part {
    let ticks = part.run.told_of(0..part.run.wheel_count(), true);
    if ticks.is_empty() || ticks.len() == part.run.len() {
        return part;
    }
    let before = |row: usize| ticks.partition_point(|tick| *tick < row);
    Part { own: before(part.own.start)..before(part.own.end), run: part.run.of_ticks(&ticks) }
}

/// Every tick of a log, one after the other, with the part that it is in.
pub(crate) fn rows<'a>(log: &'a Log<'a>, columns: Columns) -> impl Iterator<Item = (Rc<Part>, usize)> + 'a {
    parts(log, columns).flat_map(|part| {
        let (own, part) = (part.own.clone(), Rc::new(part));
        own.map(move |row| (part.clone(), row))
    })
}
