//! The codes of answers are those of the manual.

use ssl::Code;
use std::collections::BTreeSet;

#[test]
fn the_manual_lists_every_code_and_no_other() {
    let page = include_str!("../../docs/book/src/serve.md");
    let codes = page.split("## Codes").nth(1).unwrap();
    let codes = codes.split("\n## ").next().unwrap();
    let listed: BTreeSet<&str> = codes.lines().filter_map(|line| line.strip_prefix("| `")?.split('`').next()).collect();
    let known: BTreeSet<&str> = Code::ALL.into_iter().map(Code::name).collect();
    assert_eq!(listed, known);
    assert_eq!(known.len(), Code::ALL.len());
}
