//! The register map as documents: Markdown to read, a C header and JSON for programs.

use fixed_kin::radio::CLOCKS_PER_BIT;
use fixed_kin::registers::{
    Access, BOARDS, CHECKSUM_SEED, CONTENT_HASH, FRAME, FRAME_LINE, Field, Group, Kind, REGISTERS, RULES, Register,
    SET_POINTS, VERSION, checksum,
};
use serde_json::{Map, Value, json};
use std::fmt::Write;

fn kind(register: &Register) -> String {
    match register.kind {
        Kind::Unsigned(bits) => format!("unsigned {bits}"),
        Kind::Fixed(format) if format.fraction() == 0 => format!("signed {}", format.bits()),
        Kind::Fixed(format) => format!("signed {}, LSB 2^-{}", format.bits(), format.fraction()),
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
         W1C: a written one clears the bit. Staged: acts at the control tick after a commit. In brackets after a reset: the \
         bits that follow pins or time. Axes are numbered from 0; the word of axis i stands i words after the first.\n\n\
         | offset | words | name | access | format | reset | meaning |\n|---|---|---|---|---|---|---|\n",
        version()
    );
    for r in REGISTERS {
        let zero = if r.zero.is_empty() { String::new() } else { format!("; 0: {}", r.zero) };
        let _ = writeln!(
            text,
            "| 0x{:03x} | {} | `{}` | {} | {} | {} | {}{zero} |",
            r.offset,
            r.words,
            r.name,
            r.access.symbol(),
            kind(r),
            reset(r),
            r.text
        );
    }
    text += &rules();
    text += &configuration();
    text += &words();
    text += &radio();
    text.push_str("\n## Fields\n");
    for r in REGISTERS {
        let Kind::Fields(fields) = r.kind else { continue };
        let _ = write!(text, "\n### `{}`\n\n| bits | name | meaning |\n|---|---|---|\n", r.name);
        for f in fields {
            let top = f.bit + f.width - 1;
            let bits = if f.width == 1 { f.bit.to_string() } else { format!("{top}:{}", f.bit) };
            let block = if f.block.is_empty() { String::new() } else { format!(" (block `{}`)", f.block) };
            let _ = writeln!(text, "| {bits} | {} | {}{block} |", f.name, f.text);
        }
    }
    text
}

fn reset(register: &Register) -> String {
    match (register.access, register.live) {
        (Access::WriteOnly, _) => "-".to_owned(),
        (_, 0) => format!("0x{:x}", register.reset),
        (_, live) => format!("0x{:x} (0x{live:x})", register.reset),
    }
}

/// Set points for an example of the checksum, and their sum.
fn example() -> ([u32; SET_POINTS.words as usize], u32) {
    let words = [1, 0xFFFF_FFFF, 0x0012_3456, 0];
    let sum = words.iter().enumerate().fold(CHECKSUM_SEED, |sum, (i, word)| checksum(sum, SET_POINTS.at(i) / 4, *word));
    (words, sum)
}

fn rules() -> String {
    let mut text = String::from("\n## Rules\n\n| rule | |\n|---|---|\n");
    for rule in &RULES {
        let _ = writeln!(text, "| {} | {} |", rule.name.replace('_', " "), rule.text);
    }
    let (words, sum) = example();
    let words = words.map(|word| format!("{word:08x}")).join(", ");
    let _ = writeln!(
        text,
        "\nThe seed of the checksum is 0x{CHECKSUM_SEED:08x}; set points {words}, staged in this order, have the checksum \
         {sum:08x}."
    );
    text
}

fn configuration() -> String {
    let mut text = String::new();
    for r in REGISTERS.iter().filter(|r| !r.groups.is_empty() && r.access == Access::Staged) {
        let _ = write!(
            text,
            "\n## Words of `{}`\n\nA value is the word times 2^-fraction, signed; the word of axis i stands i words after the \
             first.\n\n| words | offset | name | bits | fraction | unit | meaning |\n|---|---|---|---|---|---|---|\n",
            r.name
        );
        for g in r.groups {
            let _ = writeln!(
                text,
                "| {}–{} | 0x{:03x} | {} | {} | {} | {} | {} |",
                g.first,
                g.first + g.words - 1,
                r.at(g.first),
                g.name,
                g.format.bits(),
                g.format.fraction(),
                g.unit,
                g.text
            );
        }
    }
    text
}

fn words() -> String {
    let mut text = String::from("\n## Words with a meaning\n\n| register | name | word | |\n|---|---|---|---|\n");
    for r in REGISTERS {
        for v in r.values {
            let _ = writeln!(text, "| `{}` | {} | 0x{:08x} | {} |", r.name, v.name, v.word, v.text);
        }
    }
    text
}

fn radio() -> String {
    let mut text = String::from("\n## Frame of the radio\n\n| byte | bytes | name | |\n|---|---|---|---|\n");
    for part in &FRAME {
        let value = part.value.map_or_else(String::new, |value| format!("0x{value:02x}: "));
        let _ = writeln!(text, "| {} | {} | {} | {value}{} |", part.at, part.bytes, part.name, part.text);
    }
    let _ = writeln!(text, "\nOn the line: {FRAME_LINE}.");
    text
}

/// `registers.h`.
#[must_use]
pub fn c_header() -> String {
    let mut text = format!(
        "/* Registers of rac4i65, map version {}: byte offsets in BAR 5. Do not edit; see registers.md. */\n\
         #ifndef RAC4I65_REGISTERS_H\n#define RAC4I65_REGISTERS_H\n\n\
         #define RAC4I65_THIS_MAP_VERSION 0x{VERSION:08x}u /* what RAC4I65_MAP_VERSION reads */\n\
         #define RAC4I65_CHECKSUM_SEED 0x{CHECKSUM_SEED:08x}u /* sum = rotl(sum, 1) ^ data ^ offset / 4, in the order of \
         the writes */\n\
         #define RAC4I65_RADIO_HEAD 0x{:02x}u /* first byte of a frame */\n\n",
        version(),
        fixed_kin::radio::HEAD
    );
    for r in REGISTERS {
        let name = r.name.to_uppercase();
        let _ = writeln!(text, "#define RAC4I65_{name} 0x{:03x}u /* {} */", r.offset, r.text.replace("*/", "* /"));
        for v in r.values {
            let _ = writeln!(
                text,
                "#define RAC4I65_{name}_VALUE_{} 0x{:08x}u /* {} */",
                v.name.to_uppercase().replace('-', "_"),
                v.word,
                v.text
            );
        }
        for g in r.groups {
            let _ = writeln!(
                text,
                "#define RAC4I65_{name}_{} 0x{:03x}u /* Q{}.{}: {}; {} */",
                g.name.to_uppercase(),
                r.at(g.first),
                g.format.bits().saturating_sub(g.format.fraction()),
                g.format.fraction(),
                g.unit,
                g.text
            );
        }
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
                "reset": if r.offset == CONTENT_HASH.offset { content_hash } else { r.reset },
                "live": r.live,
                "text": r.text,
            });
            if !r.zero.is_empty() {
                value["zero"] = json!(r.zero);
            }
            if !r.values.is_empty() {
                value["values"] =
                    r.values.iter().map(|v| (v.name.to_owned(), json!({ "word": v.word, "text": v.text }))).collect();
            }
            if !r.groups.is_empty() {
                value["groups"] = r.groups.iter().map(group).collect();
            }
            match r.kind {
                Kind::Fixed(format) => {
                    value["bits"] = json!(format.bits());
                    value["fraction_bits"] = json!(format.fraction());
                }
                Kind::Unsigned(bits) => value["bits"] = json!(bits),
                Kind::Fields(fields) => {
                    value["fields"] = fields.iter().map(field).collect();
                }
                Kind::Text => {}
            }
            value
        })
        .collect();
    let (words, sum) = example();
    let rules: Map<String, Value> = RULES.iter().map(|rule| (rule.name.to_owned(), json!(rule.text))).collect();
    let boards: Vec<Value> = BOARDS
        .iter()
        .map(|b| json!({ "board": b.word, "name": text_of(b.word), "clock_hz": b.clock_hz, "text": b.text }))
        .collect();
    let frame: Vec<Value> = FRAME
        .iter()
        .map(|p| json!({ "name": p.name, "at": p.at, "bytes": p.bytes, "value": p.value, "text": p.text }))
        .collect();
    let map = json!({
        "design": "rac4i65",
        "map_version": version(),
        "content_hash": format!("{content_hash:08x}"),
        "boards": boards,
        "rules": rules,
        "checksum": { "seed": CHECKSUM_SEED, "example": { "set_points": words, "checksum": sum } },
        "commits": [
            { "words": "set_points", "commit": "commit_set_points" },
            { "words": "configuration", "commit": "commit_configuration" },
        ],
        "radio": { "frame": frame, "clocks_per_bit": CLOCKS_PER_BIT, "line": FRAME_LINE },
        "registers": registers,
    });
    format!("{map:#}\n")
}

/// Four characters, the first in the highest byte.
fn text_of(word: u32) -> String {
    word.to_be_bytes().map(char::from).iter().collect()
}

fn field(field: &Field) -> Value {
    let mut value = json!({ "name": field.name, "bit": field.bit, "width": field.width, "text": field.text });
    if !field.block.is_empty() {
        value["block"] = json!(field.block);
    }
    value
}

fn group(group: &Group) -> Value {
    json!({
        "name": group.name, "first": group.first, "words": group.words, "bits": group.format.bits(),
        "fraction_bits": group.format.fraction(), "unit": group.unit, "text": group.text,
    })
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
