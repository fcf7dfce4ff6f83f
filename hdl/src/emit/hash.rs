//! A fingerprint of a Verilog text that the design itself can hold.
//!
//! The design has a constant named [`MARKER`]; the fingerprint is taken over the text with that
//! constant zero, and then put into it. So a card can be asked which text it was made from, and
//! anybody with the file can check the answer.
//!
//! CRC-32 as in IEEE 802.3 and zip: polynomial `EDB88320` reflected, start and final value all
//! ones. It tells versions apart; it does not protect against intent.

use super::token::{Token, tokens};

/// The name of the constant: `localparam content_hash = 32'h…;`.
pub const MARKER: &str = "content_hash";

/// Of the bytes `123456789` it is `CBF43926`.
#[must_use]
pub fn crc32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0u32, |crc, byte| {
        (0..8).fold(crc ^ u32::from(*byte), |crc, _| if crc & 1 == 1 { crc >> 1 ^ 0xEDB8_8320 } else { crc >> 1 })
    })
}

/// The fingerprint of a text, whatever value its marker has; a text without marker has one too.
#[must_use]
pub fn content_hash(verilog: &str) -> u32 {
    crc32(replace(verilog, 0).0.as_bytes())
}

/// The text with its fingerprint in the marker, or `None` if it has no marker.
#[must_use]
pub fn embed(verilog: &str) -> Option<String> {
    let (text, markers) = replace(verilog, content_hash(verilog));
    (markers > 0).then_some(text)
}

/// The value of the marker, if there is one in hexadecimal.
#[must_use]
pub fn embedded(verilog: &str) -> Option<u32> {
    let all: Vec<_> = tokens(verilog).into_iter().filter(|t| !t.is_blank()).collect();
    let value = all.windows(4).find(|w| marks(w))?[3];
    u32::from_str_radix(value.text.strip_prefix("32'h")?, 16).ok()
}

fn marks(window: &[Token]) -> bool {
    window[0].is("localparam") && window[1].is(MARKER) && window[2].is("=")
}

fn replace(verilog: &str, value: u32) -> (String, usize) {
    let all = tokens(verilog);
    let solid: Vec<_> = (0..all.len()).filter(|n| !all[*n].is_blank()).collect();
    let values: Vec<_> =
        solid.windows(4).filter(|w| marks(&w.iter().map(|n| all[*n]).collect::<Vec<_>>())).map(|w| w[3]).collect();
    let mut text = String::with_capacity(verilog.len());
    for (n, token) in all.iter().enumerate() {
        if values.contains(&n) {
            text += &format!("32'h{value:08x}");
        } else {
            text += token.text;
        }
    }
    (text, values.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_check_value_of_the_standard() {
        assert_eq!(crc32(b"123456789"), 0xCBF4_3926);
    }

    #[test]
    fn the_marker_does_not_change_the_fingerprint() {
        let text = "module a;\nlocalparam content_hash = 32'b0;\nlocalparam other = 32'h1;\nendmodule\n";
        let marked = embed(text).unwrap();
        assert_eq!(content_hash(text), content_hash(&marked));
        assert_eq!(embedded(&marked), Some(content_hash(text)));
        assert_eq!(embed(&marked).unwrap(), marked);
        assert_ne!(content_hash(text), content_hash(&text.replace("h1", "h2")));
        assert_eq!(embed("module a; endmodule"), None);
    }
}
