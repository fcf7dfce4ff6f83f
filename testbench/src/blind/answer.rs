//! What the workflow says, as read from the keys of `gap.json`.

use serde::{Deserialize, Serialize};
use serde_json::Value;

/// An effect that an analysis names, with its size.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct NamedEffect {
    /// As in the catalogue of effects.
    pub name: String,
    /// Wheels from 1; empty = the whole robot.
    pub wheels: Vec<usize>,
    /// Parameters: name, value, 95 % interval (of no width where there is none).
    pub parameters: Vec<(String, f64, [f64; 2])>,
}

/// The workflow's answer.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Answer {
    /// `agrees`, `missing-effect`, `ambiguous`, `unexplained` or `not-compared`.
    pub verdict: String,
    /// What the analysis named, in its order.
    pub effects: Vec<NamedEffect>,
    /// Sets of effects that cannot be told apart.
    pub alternatives: Vec<Vec<String>>,
    /// Named effects that are only the nearest of the catalogue.
    pub nearest: Vec<String>,
    /// Unexplained structure, in words.
    pub unexplained: Vec<String>,
    /// Share of the gap that the named effects close.
    pub closed: Option<f64>,
    /// Stated detection limits: effect, parameter, limit.
    pub limits: Vec<(String, String, f64)>,
}

impl Answer {
    /// Reads it; `None` if a key of the contract is missing or of the wrong type.
    pub fn from_json(json: &Value) -> Option<Self> {
        let effects = json["effects"].as_array()?.iter().map(named).collect::<Option<Vec<_>>>()?;
        let alternatives = json["alternatives"].as_array()?.iter().map(texts).collect::<Option<Vec<_>>>()?;
        let limits = json["detection_limits"].as_array().map_or(&[][..], Vec::as_slice);
        Some(Self {
            verdict: json["verdict"].as_str()?.to_owned(),
            effects,
            alternatives,
            nearest: texts(&json["nearest"]).unwrap_or_default(),
            unexplained: json["unexplained"].as_array()?.iter().map(structure).collect::<Option<_>>()?,
            closed: json["gap"].as_object()?.get("closed")?.as_f64(),
            limits: limits
                .iter()
                .filter_map(|l| {
                    Some((l["name"].as_str()?.to_owned(), l["parameter"].as_str()?.to_owned(), l["limit"].as_f64()?))
                })
                .collect(),
        })
    }

    /// Names of the effects.
    pub fn names(&self) -> Vec<&str> {
        self.effects.iter().map(|e| e.name.as_str()).collect()
    }
}

fn structure(json: &Value) -> Option<String> {
    Some(format!("{}: {}", json["link"].as_str()?, json["structure"].as_str()?))
}

fn texts(json: &Value) -> Option<Vec<String>> {
    json.as_array()?.iter().map(|t| Some(t.as_str()?.to_owned())).collect()
}

fn named(json: &Value) -> Option<NamedEffect> {
    let wheels = json["wheels"].as_array()?.iter().map(|w| usize::try_from(w.as_u64()?).ok());
    let parameters = json["parameters"].as_object()?.iter().map(|(name, p)| {
        let value = p["value"].as_f64()?;
        // Resolutions and bounds claim no confidence: no interval.
        let ci = match p.get("ci95") {
            Some(ci) => [ci.get(0)?.as_f64()?, ci.get(1)?.as_f64()?],
            None => [value; 2],
        };
        Some((name.clone(), value, ci))
    });
    Some(NamedEffect {
        name: json["name"].as_str()?.to_owned(),
        wheels: wheels.collect::<Option<_>>()?,
        parameters: parameters.collect::<Option<_>>()?,
    })
}
