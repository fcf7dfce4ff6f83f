//! The figures as a table and as JSON.

use std::collections::BTreeMap;
use std::fmt::Write;

use serde_json::{Value, json};

use super::{Grade, Group, Scored, upper_bound};

/// All scores of a bench.
#[derive(Debug, Clone)]
pub struct Report {
    /// Seed of the series.
    pub seed: u64,
    /// Sets that were planned; fewer are scored where time ran out.
    pub planned: usize,
    /// The sets in the order in which they were tried.
    pub scored: Vec<Scored>,
}

/// Confidence of the upper bounds.
const CONFIDENCE: f64 = 0.95;
/// From this multiple of the stated detection limit on an effect has to be named.
const WELL_ABOVE: f64 = 1.5;

impl Report {
    /// Sets of one group.
    pub fn group(&self, group: Group) -> Vec<&Scored> {
        self.scored.iter().filter(|s| s.group == group).collect()
    }

    /// Sets with this grade in one group.
    pub fn count(&self, group: Group, grade: Grade) -> usize {
        self.scored.iter().filter(|s| s.group == group && s.grade == grade).count()
    }

    /// 95 % intervals judged, and how many hold the true value.
    pub fn intervals(&self) -> [usize; 2] {
        self.scored.iter().fold([0, 0], |[n, k], s| [n + s.intervals[0], k + s.intervals[1]])
    }

    /// Median share of the gap closed by right answers to single effects.
    pub fn median_closed(&self) -> Option<f64> {
        let right = self.scored.iter().filter(|s| s.group == Group::Single && s.grade.is_good());
        let mut closed: Vec<f64> = right.filter_map(Scored::closed).collect();
        closed.sort_by(f64::total_cmp);
        closed.get(closed.len() / 2).copied()
    }

    /// Rows of the table: label and sets.
    fn rows(&self) -> Vec<(String, Vec<&Scored>)> {
        let mut rows = vec![(Group::EffectFree.name().to_owned(), self.group(Group::EffectFree))];
        let single = self.group(Group::Single);
        for size in 1..=5 {
            let sets = single.iter().filter(|s| s.size() == size).copied().collect();
            rows.push((format!("single, size {size}"), sets));
        }
        let above = single.iter().filter(|s| s.limits.is_some_and(|r| r >= WELL_ABOVE)).copied().collect();
        rows.push((format!("single, >= {WELL_ABOVE} limits"), above));
        let more =
            [Group::Outside, Group::TranslationsOnly, Group::Ablation, Group::AxisFree, Group::Axis, Group::AxisPair];
        for group in [Group::Pair].into_iter().chain(more) {
            rows.push((group.name().to_owned(), self.group(group)));
            if matches!(group, Group::Pair | Group::Axis | Group::AxisPair) {
                let above = self.group(group).into_iter().filter(|s| s.limits.is_some_and(|r| r >= WELL_ABOVE));
                rows.push((format!("{}, >= {WELL_ABOVE} limits", group.name()), above.collect()));
            }
        }
        rows.retain(|(_, sets)| !sets.is_empty());
        rows
    }

    /// What was said of every hidden effect, most often first; effects that were always right are left out.
    fn confusion(&self) -> BTreeMap<String, Vec<(String, usize)>> {
        let mut out: BTreeMap<String, BTreeMap<String, usize>> = BTreeMap::new();
        for s in self.scored.iter().filter(|s| s.grade != Grade::Right) {
            let hidden: Vec<&str> = s.hidden.iter().map(|h| h.name.as_str()).collect();
            let key = if hidden.is_empty() { Group::EffectFree.name().to_owned() } else { hidden.join(" + ") };
            let said = match &s.answer {
                Err(why) => why.clone(),
                Ok(a) if a.effects.is_empty() => format!("nothing ({})", a.verdict),
                Ok(a) => a.names().join(" + "),
            };
            let size = if s.size() > 0 { format!(" at {}", s.size()) } else { String::new() };
            *out.entry(key).or_default().entry(format!("{}{size}: {said}", s.grade.name())).or_default() += 1;
        }
        let sorted = |said: BTreeMap<String, usize>| {
            let mut said: Vec<(String, usize)> = said.into_iter().collect();
            said.sort_by_key(|(_, n)| std::cmp::Reverse(*n));
            said
        };
        out.into_iter().map(|(k, v)| (k, sorted(v))).collect()
    }

    /// The tables, at most 80 columns wide.
    pub fn table(&self) -> String {
        let mut out = format!("blind bench, seed {}, {} of {} sets\n\n", self.seed, self.scored.len(), self.planned);
        let mut head = format!("{:<22}{:>5}", "hidden", "sets");
        for g in Grade::ALL {
            let _ = write!(head, "{:>7}", g.name().chars().take(6).collect::<String>());
        }
        let _ = writeln!(out, "{}", head.trim_end());
        for (label, sets) in self.rows() {
            let n = sets.len();
            let mut counts = format!("{label:<22}{n:>5}");
            let mut rates = format!("{:<22}{:>5}", "", "%");
            for g in Grade::ALL {
                let k = sets.iter().filter(|s| s.grade == g).count();
                let _ = write!(counts, "{k:>7}");
                let _ = write!(rates, "{:>7.1}", 100.0 * k as f64 / n as f64);
            }
            let _ = writeln!(out, "{counts}\n{rates}");
        }
        let _ = writeln!(out, "\nrates with the exact upper bound at {:.0} % confidence", 100.0 * CONFIDENCE);
        for (label, sets) in self.rows() {
            let n = sets.len();
            let k = sets.iter().filter(|s| s.grade == Grade::Wrong).count();
            let what = match sets[0].group {
                Group::EffectFree | Group::AxisFree => "a false name",
                Group::Outside => "misnamed",
                _ => "a wrong name",
            };
            let (rate, bound) = (100.0 * k as f64 / n as f64, 100.0 * upper_bound(k, n, CONFIDENCE));
            let _ = writeln!(out, "  {label:<22}{what:<14}{k:>4} of {n:<5}{rate:>6.1} %  <= {bound:>5.1} %");
        }
        let [n, k] = self.intervals();
        if n > 0 {
            let rate = 100.0 * k as f64 / n as f64;
            let _ = writeln!(out, "\n95 % intervals that hold the true value   {k} of {n} ({rate:.1} %)");
        }
        if let Some(closed) = self.median_closed() {
            let _ = writeln!(out, "gap closed by right answers, median        {:.1} %", 100.0 * closed);
        }
        let seconds: f64 = self.scored.iter().map(|s| s.seconds).sum();
        let longest = self.scored.iter().map(|s| s.seconds).fold(0.0, f64::max);
        let mean = seconds / self.scored.len().max(1) as f64;
        let _ = writeln!(out, "analysis of a set                         {mean:.1} s, longest {longest:.1} s");
        let confusion = self.confusion();
        if !confusion.is_empty() {
            out.push_str("\nwhat was said where it was not right\n");
        }
        for (hidden, said) in confusion {
            let _ = writeln!(out, "  {}", cut(&hidden, 78));
            for (what, n) in said {
                let _ = writeln!(out, "    {n:>3} {}", cut(&what, 72));
            }
        }
        out
    }

    /// Writes docs/measured/blind.md; `arguments` are those that the bench was run with.
    pub fn measured(&self, arguments: &str) {
        let mut columns = vec!["hidden", "sets"];
        columns.extend(Grade::ALL.iter().map(|g| g.name()));
        columns.push("95 % intervals");
        columns.push("of them hold");
        let row = |(label, sets): (String, Vec<&Scored>)| {
            let mut row = vec![label, sets.len().to_string()];
            row.extend(Grade::ALL.iter().map(|g| sets.iter().filter(|s| s.grade == *g).count().to_string()));
            row.extend([0, 1].map(|i| sets.iter().map(|s| s.intervals[i]).sum::<usize>().to_string()));
            row
        };
        let axes = |s: &Scored| matches!(s.group, Group::AxisFree | Group::Axis | Group::AxisPair);
        let (name, title) = if self.scored.iter().all(axes) {
            (
                "blind-axes",
                "Effects hidden in motors and drive trains of any size, and what the gap workflow made of them",
            )
        } else {
            ("blind", "Effects hidden by another simulator, and what the gap workflow made of them")
        };
        let table = measured::Table {
            name,
            title,
            command: &format!("cargo run --release -p testbench --bin blind -- {arguments}"),
            columns: &columns,
        };
        table.write(&self.rows().into_iter().map(row).collect::<Vec<_>>());
    }

    /// Everything, set by set.
    pub fn to_json(&self) -> Value {
        let rows: Vec<Value> = self
            .rows()
            .into_iter()
            .map(|(label, sets)| {
                let counts: serde_json::Map<String, Value> = Grade::ALL
                    .iter()
                    .map(|g| (g.name().to_owned(), json!(sets.iter().filter(|s| s.grade == *g).count())))
                    .collect();
                let wrong = sets.iter().filter(|s| s.grade == Grade::Wrong).count();
                let bound = upper_bound(wrong, sets.len(), CONFIDENCE);
                json!({"hidden": label, "sets": sets.len(), "grades": counts, "wrong_upper_bound": bound})
            })
            .collect();
        let sets: Vec<Value> = self
            .scored
            .iter()
            .map(|s| {
                json!({
                    "group": s.group.name(),
                    "seed": s.seed,
                    "hidden": s.hidden.iter().map(|h| json!({
                        "name": h.name, "size": h.size, "wheels": h.wheels, "parameters": h.parameters,
                    })).collect::<Vec<_>>(),
                    "grade": s.grade.name(),
                    "verdict": s.answer.as_ref().ok().map(|a| a.verdict.clone()),
                    "failure": s.answer.as_ref().err(),
                    "named": s.answer.as_ref().ok().map(|a| a.effects.iter().map(|e| json!({
                        "name": e.name, "wheels": e.wheels,
                        "parameters": e.parameters.iter().map(|(name, value, ci)| json!({
                            "name": name, "value": value, "ci95": ci,
                        })).collect::<Vec<_>>(),
                    })).collect::<Vec<_>>()),
                    "alternatives": s.answer.as_ref().ok().map(|a| a.alternatives.clone()),
                    "intervals": s.intervals[0],
                    "intervals_that_hold": s.intervals[1],
                    "size_in_limits": s.limits,
                    "closed": s.closed(),
                    "seconds": s.seconds,
                })
            })
            .collect();
        let [n, k] = self.intervals();
        json!({
            "seed": self.seed,
            "planned": self.planned,
            "confidence": CONFIDENCE,
            "rows": rows,
            "intervals": n,
            "intervals_that_hold": k,
            "median_closed": self.median_closed(),
            "sets": sets,
        })
    }
}

/// The beginning of a text that is too long.
fn cut(text: &str, width: usize) -> String {
    if text.chars().count() <= width {
        return text.to_owned();
    }
    text.chars().take(width - 3).chain("...".chars()).collect()
}
