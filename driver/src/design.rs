//! What the committed gateware says of itself.

use serde_json::Value;

/// The register document that is emitted with the gateware; a test of `hdl` proves it current.
const REGISTERS: &str = include_str!("../../generated/registers.json");

/// Hash of the committed `generated/rac4i65.v`: what a card with that design answers.
///
/// # Panics
/// If the committed document has no hash: a broken build, never input.
#[must_use]
pub fn content_hash() -> u32 {
    let document: Value = serde_json::from_str(REGISTERS).expect("generated/registers.json is JSON");
    let hash = document["content_hash"].as_str().and_then(|text| u32::from_str_radix(text, 16).ok());
    hash.expect("generated/registers.json has a content hash")
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_hash_stands_in_the_verilog() {
        let verilog = include_str!("../../generated/rac4i65.v");
        assert!(verilog.contains(&format!("content_hash = 32'h{:08x}", super::content_hash())));
    }
}
