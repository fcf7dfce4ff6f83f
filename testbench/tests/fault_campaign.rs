//! The fault campaign: `RACBOT_CAMPAIGN=10` makes it ten times as long, `--nocapture` prints the table.

use measured::Table;
use testbench::faults::Outcome;
use testbench::faults::campaign::{COLUMNS, rows, run};

/// Half of the cases that each fault is worth: a minute of two cores.
const SIZE: f64 = 0.5;

const TABLE: Table<'_> = Table {
    name: "fault-campaign",
    title: "Drives in simulated time with one fault each, seeded",
    command: "cargo test --release -p testbench --test fault_campaign",
    columns: &COLUMNS,
};

#[test]
fn after_every_fault_the_robot_obeys_or_is_off() {
    let longer = std::env::var("RACBOT_CAMPAIGN").ok().and_then(|text| text.parse().ok()).unwrap_or(1.0);
    let lines = run(2005, SIZE * longer).unwrap();
    let rows = rows(&lines);
    println!("{}", rows.iter().map(|row| row.join(" | ")).collect::<Vec<_>>().join("\n"));
    let violations: Vec<&str> = lines.iter().flat_map(testbench::faults::campaign::Line::violations).collect();
    assert!(
        violations.is_empty(),
        "{} violations, the first:\n{}",
        violations.len(),
        violations[..violations.len().min(20)].join("\n")
    );
    for line in &lines {
        assert_eq!(
            line.armed_again(),
            line.cases.len(),
            "{}: not always armed again once the cause was gone",
            line.fault
        );
    }
    // A campaign whose faults do nothing would pass too.
    let all = |outcome| lines.iter().map(|line| line.count(outcome)).sum::<usize>();
    let cases: usize = lines.iter().map(|line| line.cases.len()).sum();
    assert!(all(Outcome::Unnoticed) <= cases / 200);
    assert!(all(Outcome::Ended) > cases / 10 && all(Outcome::Watchdog) > cases / 40);
    if longer == 1.0 {
        TABLE.check(&rows);
    }
}
