//! The fields of a line of a text table.

use std::borrow::Cow;

use super::units;

/// What begins a line that is a remark.
pub(super) const REMARKS: [&str; 4] = ["#", "%", "//", "=~=~"]; // the last is a terminal's

/// Names with the units of a line below them, bare or in brackets, where they have none; what is no unit adds nothing.
pub(super) fn with_units(names: Vec<String>, units: &[String]) -> Vec<String> {
    let none = String::new();
    let one = |(name, unit): (String, &String)| {
        let inside = unit.trim_matches(['[', ']', '(', ')']).trim();
        let with = format!("{name} [{inside}]");
        let known = units::in_name(&with).is_some() && units::in_name(&name).is_none();
        if known && !name.is_empty() { with } else { name }
    };
    names.into_iter().zip(units.iter().chain(std::iter::repeat(&none))).map(one).collect()
}

/// A line without what some writers close it with.
fn open(line: &[u8], separator: u8) -> &[u8] {
    if separator == b',' { line.strip_suffix(b";").unwrap_or(line) } else { line }
}

/// The fields of a line, apart by blanks or a separator; of a line without any there is one, which is empty.
pub(super) fn fields(line: &[u8], blanks: bool, separator: u8) -> Vec<String> {
    let text = String::from_utf8_lossy(open(line, separator));
    if blanks && !text.trim().is_empty() {
        return text.split_whitespace().map(str::to_owned).collect();
    }
    text.split(char::from(separator)).map(|field| field.trim().to_owned()).collect()
}

/// Whether a field is a number, or empty.
pub(super) fn is_number(field: &str, separator: u8) -> bool {
    let field = if separator == b',' { Cow::Borrowed(field) } else { Cow::Owned(field.replace(',', ".")) };
    field.is_empty() || field.parse::<f64>().is_ok()
}
