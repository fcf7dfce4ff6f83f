//! What a finding rests on, as types: no figure can pass for one that it is not.

use serde_json::{Map, Value, json};

use crate::units::short;

/// Ticks that a replay compared, all wheels together.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Ticks {
    /// Those that were compared, right or wrong.
    pub all: u64,
    /// Those that differ by more than rounding.
    pub wrong: u64,
}

impl Ticks {
    /// Share of them that differ.
    pub fn wrong_share(self) -> f64 {
        self.wrong as f64 / self.all.max(1) as f64
    }
}

/// What a name rests on.
#[derive(Debug, Clone, PartialEq)]
pub enum Evidence {
    /// A statistical test against "the effect is absent".
    Test {
        /// How it was made.
        method: &'static str,
        /// Its two-sided p-value.
        p: f64,
    },
    /// Logged signals replayed tick by tick with the effect in place.
    Replay {
        /// With the nominal model.
        nominal: Ticks,
        /// With the effect, which may leave other ticks to compare: a delay has nothing to go by after a gap.
        with: Ticks,
    },
    /// A pattern that was recognised.
    Pattern {
        /// What it looks like.
        what: String,
        /// p-value of the pattern against noise, where a test was made.
        p: Option<f64>,
    },
}

impl Evidence {
    /// The p-value, where a test was made.
    pub fn p_value(&self) -> Option<f64> {
        match self {
            Self::Test { p, .. } => Some(*p),
            Self::Replay { .. } => None,
            Self::Pattern { p, .. } => *p,
        }
    }

    /// Share of the replayed ticks that are wrong with the effect, where signals were replayed.
    pub fn wrong_share(&self) -> Option<f64> {
        match self {
            Self::Replay { with, .. } => Some(with.wrong_share()),
            Self::Test { .. } | Self::Pattern { .. } => None,
        }
    }

    /// As it stands in `gap.json` and `robot.toml`.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Test { .. } => "test",
            Self::Replay { .. } => "replay",
            Self::Pattern { .. } => "pattern",
        }
    }

    /// As in `gap.json`.
    pub fn to_json(&self) -> Value {
        match self {
            Self::Test { method, p } => json!({"kind": self.kind(), "method": method, "p": p}),
            Self::Replay { nominal, with } => json!({
                "kind": self.kind(), "ticks_before": nominal.all, "wrong_before": nominal.wrong,
                "ticks": with.all, "wrong": with.wrong,
            }),
            Self::Pattern { what, p } => json!({"kind": self.kind(), "what": what, "p": p}),
        }
    }

    /// In a few words.
    pub fn words(&self) -> String {
        match self {
            Self::Test { p, .. } => format!("p = {}", short(*p)),
            Self::Replay { nominal, with } if nominal.all == with.all => {
                format!("{} of {} ticks wrong, {} without it", with.wrong, with.all, nominal.wrong)
            }
            Self::Replay { nominal, with } => {
                format!("{} of {} ticks wrong, {} of {} without it", with.wrong, with.all, nominal.wrong, nominal.all)
            }
            Self::Pattern { what, p: None } => what.clone(),
            Self::Pattern { what, p: Some(p) } => format!("{what}, p = {}", short(*p)),
        }
    }
}

/// How well a value is known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Interval {
    /// 95 % confidence interval.
    Ci95([f64; 2]),
    /// The search that found the value cannot tell values within these apart.
    Resolution([f64; 2]),
    /// The value lies between these, by an argument that gives no probability.
    Bound([f64; 2]),
    /// A whole number, or a value that is not estimated.
    Exact,
}

impl Interval {
    /// Its ends; `None` for what is not estimated.
    pub fn ends(&self) -> Option<[f64; 2]> {
        match self {
            Self::Ci95(ends) | Self::Resolution(ends) | Self::Bound(ends) => Some(*ends),
            Self::Exact => None,
        }
    }

    /// Key in `gap.json` and `robot.toml`.
    pub fn key(&self) -> Option<&'static str> {
        match self {
            Self::Ci95(_) => Some("ci95"),
            Self::Resolution(_) => Some("resolution"),
            Self::Bound(_) => Some("bound"),
            Self::Exact => None,
        }
    }

    /// In a table: what it is.
    pub fn label(&self) -> &'static str {
        match self {
            Self::Ci95(_) => "95 %",
            Self::Resolution(_) => "resolved",
            Self::Bound(_) => "between",
            Self::Exact => "",
        }
    }

    /// A value with it, as in `gap.json`.
    pub fn to_json(&self, value: f64) -> Value {
        let mut out = Map::from_iter([("value".to_owned(), json!(value))]);
        if let (Some(key), Some(ends)) = (self.key(), self.ends()) {
            out.insert(key.to_owned(), json!(ends));
        }
        Value::Object(out)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_a_confidence_interval_is_called_one_and_only_a_test_has_a_p_value() {
        assert_eq!(Interval::Ci95([1.0, 3.0]).to_json(2.0), json!({"value": 2.0, "ci95": [1.0, 3.0]}));
        assert_eq!(Interval::Resolution([1.0, 3.0]).to_json(2.0), json!({"value": 2.0, "resolution": [1.0, 3.0]}));
        assert_eq!(Interval::Bound([1.0, 3.0]).to_json(2.0), json!({"value": 2.0, "bound": [1.0, 3.0]}));
        assert_eq!(Interval::Exact.to_json(2.0), json!({"value": 2.0}));
        let [all, fewer] = [Ticks { all: 100, wrong: 40 }, Ticks { all: 90, wrong: 0 }];
        let replay = Evidence::Replay { nominal: all, with: Ticks { all: 100, wrong: 0 } };
        assert_eq!(replay.words(), "0 of 100 ticks wrong, 40 without it");
        let other = Evidence::Replay { nominal: all, with: fewer };
        assert_eq!(other.words(), "0 of 90 ticks wrong, 40 of 100 without it");
        assert_eq!((replay.p_value(), replay.kind()), (None, "replay"));
        assert_eq!(replay.to_json()["ticks"], 100);
        assert_eq!(Evidence::Pattern { what: "a line".to_owned(), p: None }.to_json()["p"], Value::Null);
    }
}
