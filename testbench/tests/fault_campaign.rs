//! The fault campaign: `RACBOT_CAMPAIGN=5` makes it 22 000 drives long, `--nocapture` prints the table.

use testbench::faults::Outcome;
use testbench::faults::campaign::{run, table};

#[test]
fn after_every_fault_the_robot_obeys_or_is_off() {
    let size = std::env::var("RACBOT_CAMPAIGN").ok().and_then(|text| text.parse().ok()).unwrap_or(0.5);
    let lines = run(2005, size).unwrap();
    println!("{}", table(&lines));
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
}
