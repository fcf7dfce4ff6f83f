//! Effects a user describes in a file.
//!
//! ```toml
//! name = "air-drag"
//! torque = "-c * w * abs(w)"        # Nm at the wheel shaft, positive with the rotation
//! # or: velocity = "..."            # rad/s the wheel rolls less than its encoder says
//! wheels = [1, 2, 3]                # optional; all if missing
//! [parameters]
//! c = { scale = 1e-6, low = 0.0, high = 1.0, material = 2e-6 }
//! ```
//!
//! Signals: `t` (s), `w` (rad/s), `sign_w` (−1 to 1, its direction, smooth about 0 over as much speed as the log leaves
//! unknown: friction is `-c * sign_w` on any machine), `angle` (rad), `duty`, `supply` (V), `vx`, `vy` (m/s, body),
//! `omega` (rad/s), `heading` (rad), `x`, `y` (m, field).

mod expression;

use std::path::Path;

use runs::robot::Robot;

pub use expression::{Expression, ExpressionError};

use crate::GapError;
use links::drive::DriveModel;
use links::effect::{Effect, Form, Link, Parameter, Values};
use links::motion::MotionModel;
use links::segment::Segment;

const SIGNALS: [&str; 12] = ["t", "w", "sign_w", "angle", "duty", "supply", "vx", "vy", "omega", "heading", "x", "y"];

/// An effect from a file.
#[derive(Debug, Clone)]
pub struct UserEffect {
    name: String,
    text: String,
    link: Link,
    wheels: Vec<usize>,
    parameters: Vec<Parameter>,
    expression: Expression,
}

impl UserEffect {
    /// Reads an effect.
    ///
    /// # Errors
    /// [`GapError::Effect`] naming the file and, for a bad expression, showing it with a caret.
    pub fn load(path: impl AsRef<Path>) -> Result<Self, GapError> {
        let path = path.as_ref();
        let text = std::fs::read_to_string(path).map_err(|e| GapError::Effect(format!("{}: {e}", path.display())))?;
        Self::parse(&text).map_err(|e| GapError::Effect(format!("{}: {e}", path.display())))
    }

    /// Reads the text of an effect.
    ///
    /// # Errors
    /// As [`Self::load`].
    pub fn parse(text: &str) -> Result<Self, GapError> {
        let fault = |what: String| GapError::Effect(what);
        let table: toml::Table = text.parse().map_err(|e: toml::de::Error| fault(e.to_string()))?;
        for key in table.keys() {
            if !["name", "torque", "velocity", "wheels", "parameters"].contains(&key.as_str()) {
                return Err(fault(format!("{key} is not known; known are name, torque, velocity, wheels, parameters")));
            }
        }
        let string = |key: &str| table.get(key).and_then(toml::Value::as_str);
        let name = string("name").ok_or_else(|| fault("name is missing: give the effect a name".to_owned()))?;
        let kebab = !name.is_empty() && name.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-');
        if !kebab || links::effects::find(name).is_some() {
            return Err(fault(format!(
                "name: {name:?} must be in kebab-case and not that of an effect of the catalogue"
            )));
        }
        let (text, link) = match (string("torque"), string("velocity")) {
            (Some(t), None) => (t, Link::Drive),
            (None, Some(v)) => (v, Link::Motion),
            _ => return Err(fault("give either torque or velocity, as an expression in quotes".to_owned())),
        };
        let mut parameters = Vec::new();
        let none = toml::Table::new();
        for (key, value) in table.get("parameters").and_then(toml::Value::as_table).unwrap_or(&none) {
            let number = |k: &str| value.get(k).and_then(|v| v.as_float().or_else(|| v.as_integer().map(|i| i as f64)));
            let Some(scale) = number("scale").filter(|s| *s > 0.0 && s.is_finite()) else {
                return Err(fault(format!(
                    "parameters.{key}: give a scale greater than 0, a step that is small but matters"
                )));
            };
            let low = number("low").unwrap_or(-1e3 * scale);
            let high = number("high").unwrap_or(1e3 * scale);
            if SIGNALS.contains(&key.as_str()) || low >= high {
                return Err(fault(format!(
                    "parameters.{key}: must not be named as a signal, and low must be below high"
                )));
            }
            parameters.push(Parameter::new(key, scale, [low, high], number("material").unwrap_or(scale)));
        }
        if parameters.is_empty() {
            return Err(fault("parameters: give at least one, to be fitted".to_owned()));
        }
        let names: Vec<String> =
            SIGNALS.iter().map(ToString::to_string).chain(parameters.iter().map(|p| p.name.clone())).collect();
        let expression = Expression::parse(text, &names).map_err(|e| fault(e.with_caret(text)))?;
        let wheels = match table.get("wheels") {
            None => Vec::new(),
            Some(v) => v
                .as_array()
                .and_then(|a| a.iter().map(|w| w.as_integer().filter(|i| *i >= 1).map(|i| i as usize - 1)).collect())
                .ok_or_else(|| fault("wheels: give a list of wheels from 1, such as [1, 3]".to_owned()))?,
        };
        Ok(Self { name: name.to_owned(), text: text.to_owned(), link, wheels, parameters, expression })
    }

    fn acts_on(&self, wheel: usize) -> bool {
        self.wheels.is_empty() || self.wheels.contains(&wheel)
    }

    /// Names' values at one tick; parameters follow the signals.
    fn inputs(s: &Segment, wheel: usize, k: usize, parameters: &[f64], out: &mut Vec<f64>) {
        out.clear();
        let duty = s.duty.get(wheel).map_or(0.0, |d| d[k]);
        let twist = s.twist[k];
        out.extend([s.t[k] - s.stretch[0], s.speed[wheel][k], s.sign[wheel][k], s.angle[wheel][k], duty, s.supply[k]]);
        out.extend([twist.vx, twist.vy, twist.omega, s.heading[k], s.position[k][0], s.position[k][1]]);
        out.extend_from_slice(parameters);
    }

    fn values(&self, values: &Values) -> Vec<f64> {
        self.parameters.iter().map(|p| values.get(&p.name)).collect()
    }
}

impl Effect for UserEffect {
    fn name(&self) -> &str {
        &self.name
    }

    fn equation(&self) -> &str {
        &self.text
    }

    fn reference(&self) -> &str {
        "described by the user"
    }

    fn link(&self) -> Link {
        self.link
    }

    fn forms(&self, _robot: &Robot) -> Vec<Form> {
        vec![Form { wheels: self.wheels.clone(), free: self.parameters.clone(), fixed: Vec::new() }]
    }

    fn motion(&self, values: &Values, model: &mut MotionModel) {
        if self.link != Link::Motion {
            return;
        }
        let (own, parameters) = (self.clone(), self.values(values));
        model.angles.push(Box::new(move |s, angles| {
            let mut inputs = Vec::new();
            for wheel in (0..angles.len()).filter(|w| own.acts_on(*w)) {
                let mut sum = 0.0;
                for k in 1..s.t.len() {
                    Self::inputs(s, wheel, k, &parameters, &mut inputs);
                    sum += own.expression.value(&inputs) * (s.t[k] - s.t[k - 1]);
                    angles[wheel][k] -= sum;
                }
            }
        }));
    }

    fn drive(&self, values: &Values, model: &mut DriveModel) {
        if self.link != Link::Drive {
            return;
        }
        let (own, parameters) = (self.clone(), self.values(values));
        model.loads.push(Box::new(move |now, loads| {
            let mut inputs = Vec::new();
            for wheel in (0..loads.wheel.len()).filter(|w| own.acts_on(*w)) {
                Self::inputs(now.segment, wheel, now.tick, &parameters, &mut inputs);
                loads.wheel[wheel] += own.expression.value(&inputs);
            }
        }));
    }
}
