//! The tables in the README are those of the code.

use std::fmt::Write as _;
use std::path::Path;

fn table<'a>(entries: impl Iterator<Item = &'a truth::Entry>) -> String {
    let mut text =
        String::from("| effect | link | 1 | 2 | 3 | 4 | 5 | parameter |\n|---|---|---|---|---|---|---|---|\n");
    for entry in entries {
        let link = format!("{:?}", entry.link).to_lowercase();
        let sizes = entry.sizes.map(|size| size.to_string()).join(" | ");
        let _ = writeln!(text, "| `{}` | {link} | {sizes} | {} |", entry.name, entry.meaning.replace('|', "\\|"));
    }
    text
}

#[test]
fn the_readme_lists_every_effect_with_its_sizes() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("README.md");
    let readme = std::fs::read_to_string(path).expect("README.md can be read");
    for table in [table(truth::catalogue()), table(truth::outside())] {
        assert!(readme.contains(&table), "README.md should contain:\n{table}");
    }
}
