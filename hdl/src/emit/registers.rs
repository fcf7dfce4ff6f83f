//! The register map as documents: Markdown to read, a C header and JSON for programs.

use fixed_kin::registers::{Access, Kind, REGISTERS, Register, VERSION};
use serde_json::{Value, json};
use std::fmt::Write;

fn kind(register: &Register) -> String {
    match register.kind {
        Kind::Unsigned(bits) => format!("unsigned {bits}"),
        Kind::Fixed(format) if format.fraction == 0 => format!("signed {}", format.bits),
        Kind::Fixed(format) => format!("signed {}, LSB 2^-{}", format.bits, format.fraction),
        Kind::Text => "4 characters".to_owned(),
        Kind::Fields(_) => "fields".to_owned(),
    }
}

fn version() -> String {
    format!("{}.{}", VERSION >> 16, VERSION & 0xFFFF)
}

/// `registers.md`.
#[must_use]
pub fn markdown() -> String {
    let mut text = format!(
        "# Registers of rac4i65, map version {}\n\n\
         Byte offsets in BAR 5, 32-bit words, aligned. Reserved offsets read zero and ignore writes.\n\
         W1C: a written one clears the bit. Staged: acts at the control tick after a commit.\n\n\
         | offset | words | name | access | format | reset | meaning |\n|---|---|---|---|---|---|---|\n",
        version()
    );
    for r in REGISTERS {
        let reset = if r.access == Access::WriteOnly { "-".to_owned() } else { format!("0x{:x}", r.reset) };
        let _ = writeln!(
            text,
            "| 0x{:03x} | {} | `{}` | {} | {} | {reset} | {} |",
            r.offset,
            r.words,
            r.name,
            r.access.symbol(),
            kind(r),
            r.text
        );
    }
    text.push_str("\n## Fields\n");
    for r in REGISTERS {
        let Kind::Fields(fields) = r.kind else { continue };
        let _ = write!(text, "\n### `{}`\n\n| bits | name | meaning |\n|---|---|---|\n", r.name);
        for f in fields {
            let top = f.bit + f.width - 1;
            let bits = if f.width == 1 { f.bit.to_string() } else { format!("{top}:{}", f.bit) };
            let _ = writeln!(text, "| {bits} | {} | {} |", f.name, f.text);
        }
    }
    text
}

/// `registers.h`.
#[must_use]
pub fn c_header() -> String {
    let mut text = format!(
        "/* Registers of rac4i65, map version {}: byte offsets in BAR 5. Do not edit; see registers.md. */\n\
         #ifndef RAC4I65_REGISTERS_H\n#define RAC4I65_REGISTERS_H\n\n\
         #define RAC4I65_MAP_VERSION 0x{VERSION:08x}u\n\n",
        version()
    );
    for r in REGISTERS {
        let name = r.name.to_uppercase();
        let _ = writeln!(text, "#define RAC4I65_{name} 0x{:03x}u /* {} */", r.offset, r.text.replace("*/", "* /"));
        if r.words > 1 {
            let _ = writeln!(text, "#define RAC4I65_{name}_WORDS {}u", r.words);
        }
        if let Kind::Fields(fields) = r.kind {
            for f in fields {
                let field = f.name.to_uppercase().replace('-', "_");
                let mask = f.place(u32::MAX);
                let _ = writeln!(text, "#define RAC4I65_{name}_{field} 0x{mask:08x}u /* {} */", f.text);
            }
        }
    }
    text.push_str("\n#endif\n");
    text
}

/// `registers.json`.
#[must_use]
pub fn json(content_hash: u32) -> String {
    let registers: Vec<Value> = REGISTERS
        .iter()
        .map(|r| {
            let mut value = json!({
                "name": r.name,
                "offset": r.offset,
                "words": r.words,
                "access": r.access.symbol(),
                "format": kind(r),
                "reset": r.reset,
                "text": r.text,
            });
            match r.kind {
                Kind::Fixed(format) => {
                    value["bits"] = json!(format.bits);
                    value["fraction_bits"] = json!(format.fraction);
                }
                Kind::Unsigned(bits) => value["bits"] = json!(bits),
                Kind::Fields(fields) => {
                    value["fields"] = fields
                        .iter()
                        .map(|f| json!({ "name": f.name, "bit": f.bit, "width": f.width, "text": f.text }))
                        .collect();
                }
                Kind::Text => {}
            }
            value
        })
        .collect();
    let map = json!({
        "design": "rac4i65",
        "map_version": version(),
        "content_hash": format!("{content_hash:08x}"),
        "registers": registers,
    });
    format!("{map:#}\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_register_is_in_every_document() {
        let (markdown, header, json) = (markdown(), c_header(), json(7));
        let parsed: Value = serde_json::from_str(&json).unwrap();
        assert_eq!(parsed["registers"].as_array().unwrap().len(), REGISTERS.len());
        for r in REGISTERS {
            assert!(markdown.contains(&format!("`{}`", r.name)), "{}", r.name);
            assert!(header.contains(&format!("RAC4I65_{} ", r.name.to_uppercase())), "{}", r.name);
        }
    }
}
