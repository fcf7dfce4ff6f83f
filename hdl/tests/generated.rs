//! `generated/` is what the sources emit, and what it says of itself is true.

use hdl::design::{COMMITTED_VERILOG, content_hash, files};
use hdl::emit::hash;
use std::path::Path;

#[test]
fn generated_is_current() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../generated");
    for file in files().unwrap() {
        let committed = std::fs::read_to_string(folder.join(&file.name)).unwrap_or_default();
        assert!(committed == file.text, "generated/{} is stale: run `cargo run -p hdl`", file.name);
    }
}

#[test]
fn emission_is_deterministic() {
    assert!(files().unwrap() == files().unwrap());
}

#[test]
fn the_chip_carries_the_hash_of_its_own_text() {
    assert_eq!(hash::embedded(COMMITTED_VERILOG), Some(hash::content_hash(COMMITTED_VERILOG)));
    assert_ne!(content_hash(), 0);
    let changed = COMMITTED_VERILOG.replacen("4'hf", "4'he", 1);
    assert_ne!(hash::content_hash(&changed), content_hash(), "the hash does not see a changed constant");
}
