//! Changes the effects in the text of a `robot.toml` and leaves everything else, comments included.

use std::path::Path;

use toml_edit::{ArrayOfTables, DocumentMut, Item};

use super::{Effect, Robot, write};
use crate::error::InputError;

/// The text with exactly these effects: tables of effects that are the same stay as they are.
pub(super) fn effects(text: &str, effects: &[Effect], path: &Path) -> Result<String, InputError> {
    let fault = |e: &dyn std::fmt::Display| InputError::new(path, e.to_string(), "correct the file");
    // What the file says now, and how it was written.
    let before = Robot::parse_partial(text, path)?.effects;
    let mut document: DocumentMut = text.parse().map_err(|e: toml_edit::TomlError| fault(&e))?;
    let empty = ArrayOfTables::new();
    let written = document.get("effect").and_then(Item::as_array_of_tables).unwrap_or(&empty);
    let mut kept = ArrayOfTables::new();
    let mut new: Vec<&Effect> = Vec::new();
    for effect in effects {
        match before.iter().position(|b| b == effect).and_then(|i| written.get(i)) {
            Some(table) => kept.push(table.clone()),
            None => new.push(effect),
        }
    }
    if kept.is_empty() {
        // What stood above the first effect was the end of the file before there were any.
        let above = written.get(0).and_then(|t| t.decor().prefix()).and_then(|p| p.as_str()).unwrap_or("").to_owned();
        document.remove("effect");
        let end = document.trailing().as_str().unwrap_or("").to_owned();
        document.set_trailing(above + &end);
    } else {
        document.insert("effect", Item::ArrayOfTables(kept));
    }
    let mut out = document.to_string();
    for effect in new {
        write::effect(&mut out, effect);
    }
    // Whoever reads it must find what was meant.
    let again = Robot::parse_partial(&out, path)?;
    let same = again.effects.len() == effects.len() && effects.iter().all(|e| again.effects.contains(e));
    if same { Ok(out) } else { Err(fault(&"its effects cannot be changed in place")) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::robot::EffectParameter;

    fn effect(name: &str) -> Effect {
        let parameter = EffectParameter { value: 0.5, ci95: Some([0.25, 0.75]), ..Default::default() };
        Effect {
            name: name.to_owned(),
            wheels: vec![2],
            parameters: vec![("scale_2".to_owned(), parameter)],
            ..Default::default()
        }
    }

    #[test]
    fn effects_come_and_go_and_comments_stay() {
        let path = Path::new("robot.toml");
        let original = format!(
            "# Our third robot.\n{}# The end.\n",
            Robot::racbot().to_toml().replace("mass_kg = 2.4", "mass_kg = 2.4 # weighed")
        );
        let one = effects(&original, &[effect("wheel-radius")], path).unwrap();
        assert!(
            one.starts_with("# Our third robot.") && one.contains("# weighed") && one.contains("# The end."),
            "{one}"
        );
        let noted = one.replace("[[effect]]", "# Found on Monday.\n[[effect]]");
        let two = effects(&noted, &[effect("wheel-radius"), effect("encoder-scale")], path).unwrap();
        assert!(two.contains("# Found on Monday."), "{two}");
        assert_eq!(Robot::parse(&two, path).unwrap().effects.len(), 2);
        let left = effects(&two, &[effect("encoder-scale")], path).unwrap();
        assert!(!left.contains("wheel-radius") && left.contains("# weighed"), "{left}");
        let none = effects(&one, &[], path).unwrap();
        assert_eq!(none.trim_end(), original.trim_end());
    }
}
