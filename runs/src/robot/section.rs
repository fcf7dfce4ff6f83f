//! Tables of a `robot.toml` with the place of every value, for complaints that say where.

use std::path::Path;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::fields::Range;
use crate::error::{InputError, line_and_column, nearest};

pub(super) type Value<'a> = Spanned<DeValue<'a>>;

/// The text and where it came from.
#[derive(Clone, Copy)]
pub(super) struct Source<'a> {
    pub(super) text: &'a str,
    pub(super) path: &'a Path,
}

impl Source<'_> {
    pub(super) fn syntax(self, e: &toml::de::Error) -> InputError {
        let (line, column) = line_and_column(self.text, e.span().map_or(0, |s| s.start));
        InputError::new(self.path, e.message().replace('\n', " "), "correct the TOML").at(line, column)
    }
}

/// One table of the file.
pub(super) struct Section<'a> {
    pub(super) source: Source<'a>,
    pub(super) name: &'a str,
    pub(super) start: usize,
    pub(super) table: &'a DeTable<'a>,
}

impl<'a> Section<'a> {
    fn path_of(&self, key: &str) -> String {
        if self.name.is_empty() { key.to_owned() } else { format!("{}.{key}", self.name) }
    }

    pub(super) fn error_at(&self, key: &str, offset: usize, what: String, hint: &str) -> InputError {
        let (line, column) = line_and_column(self.source.text, offset);
        InputError::new(self.source.path, what, hint).at(line, column).field(self.path_of(key))
    }

    pub(super) fn fault(&self, key: &str, at: &Value, what: impl Into<String>, hint: &str) -> InputError {
        self.error_at(key, at.span().start, what.into(), hint)
    }

    /// Everything that is missing, at once: key, where its table begins, what it means.
    pub(super) fn all_missing(&self, missing: &[(String, usize, &str)]) -> InputError {
        let keys: Vec<&str> = missing.iter().map(|(key, ..)| key.as_str()).collect();
        let start = missing.first().map_or(0, |(_, start, _)| *start);
        if let [(key, _, meaning)] = missing {
            return self.error_at(key, start, "is missing".to_owned(), &format!("add it: {meaning}"));
        }
        let meanings: Vec<String> = missing.iter().map(|(key, _, meaning)| format!("{key} ({meaning})")).collect();
        self.error_at(&keys.join(", "), start, "are missing".to_owned(), &format!("add {}", meanings.join(", ")))
    }

    pub(super) fn missing(&self, key: &str, meaning: &str) -> InputError {
        self.error_at(key, self.start, "is missing".to_owned(), &format!("add it: {meaning}"))
    }

    /// Refuses a key that looks like a slip of one of these, keeps others.
    pub(super) fn known(
        &self,
        keys: &[&str],
        other: &mut Vec<(String, String, toml::Value)>,
    ) -> Result<(), InputError> {
        for (name, _) in self.in_file_order() {
            let key: &str = name.get_ref();
            if keys.contains(&key) {
                continue;
            }
            if let Some(meant) = nearest(key, keys) {
                let (what, hint) = ("is not a known field".to_owned(), format!("did you mean {meant}?"));
                return Err(self.error_at(key, name.span().start, what, &hint));
            }
            let plain: toml::Table = toml::from_str(self.source.text).map_err(|e| self.source.syntax(&e))?;
            let table =
                if self.name.is_empty() { Some(&plain) } else { plain.get(self.name).and_then(|t| t.as_table()) };
            if let Some(value) = table.and_then(|t| t.get(key)) {
                other.push((self.name.to_owned(), key.to_owned(), value.clone()));
            }
        }
        Ok(())
    }

    pub(super) fn in_file_order(&self) -> Vec<(&'a Spanned<toml::de::DeString<'a>>, &'a Value<'a>)> {
        let mut entries: Vec<_> = self.table.iter().collect();
        entries.sort_by_key(|(name, _)| name.span().start);
        entries
    }

    pub(super) fn section(&self, key: &'static str) -> Result<Section<'a>, InputError> {
        let Some(value) = self.table.get(key) else {
            return Err(self.missing(key, "a table"));
        };
        self.inner(key, value)
    }

    pub(super) fn inner(&self, key: &'a str, value: &'a Value<'a>) -> Result<Section<'a>, InputError> {
        let Some(table) = value.get_ref().as_table() else {
            return Err(self.fault(key, value, "is no table", "see the example robot.toml"));
        };
        Ok(Section { source: self.source, name: key, start: value.span().start, table })
    }

    pub(super) fn number(&self, key: &str, range: Range, meaning: &str) -> Result<Option<f64>, InputError> {
        let Some(value) = self.table.get(key) else { return Ok(None) };
        let hint = if meaning.is_empty() { String::new() } else { format!("give the {meaning}") };
        let hint = hint.replace("the the ", "the ");
        let Some(x) = number(value.get_ref()) else {
            let what = format!("is {} and no number", value.get_ref().type_str());
            return Err(self.fault(key, value, what, &hint));
        };
        match range.fault(x) {
            Some(what) => Err(self.fault(key, value, what, &hint)),
            None => Ok(Some(x)),
        }
    }

    /// An array of exactly `N` numbers.
    pub(super) fn numbers<const N: usize>(&self, key: &str, range: Range) -> Result<Option<[f64; N]>, InputError> {
        let Some(value) = self.table.get(key) else { return Ok(None) };
        let hint = format!("give {N} numbers");
        let Some(list) = value.get_ref().as_array() else {
            return Err(self.fault(key, value, "is no array", &hint));
        };
        if list.len() != N {
            return Err(self.fault(key, value, format!("has {} entries", list.len()), &hint));
        }
        let mut numbers = [0.0; N];
        for (slot, item) in numbers.iter_mut().zip(list) {
            let Some(x) = number(item.get_ref()) else {
                return Err(self.fault(key, item, "holds something that is no number", &hint));
            };
            if let Some(what) = range.fault(x) {
                return Err(self.fault(key, item, what, &hint));
            }
            *slot = x;
        }
        Ok(Some(numbers))
    }
}

pub(super) fn number(value: &DeValue) -> Option<f64> {
    match value {
        DeValue::Float(x) => x.as_str().parse().ok(),
        DeValue::Integer(_) => whole(value).map(|i| i as f64),
        _ => None,
    }
}

pub(super) fn whole(value: &DeValue) -> Option<i64> {
    value.as_integer().and_then(|i| i64::from_str_radix(i.as_str(), i.radix()).ok())
}
