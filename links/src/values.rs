//! Values of parameters by name.

/// Parameter values by name; what is not there is 0.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Values(pub Vec<(String, f64)>);

impl Values {
    /// A value, if it is there.
    pub fn find(&self, name: &str) -> Option<f64> {
        self.0.iter().find(|(n, _)| n == name).map(|(_, v)| *v)
    }

    /// A value, 0 if it is not there.
    pub fn get(&self, name: &str) -> f64 {
        self.find(name).unwrap_or(0.0)
    }

    /// What goes with sine and cosine of each wheel's angle.
    pub fn with_angle(&self, wheels: usize, unit: &str) -> Vec<[f64; 2]> {
        (0..wheels).map(|i| ["sin", "cos"].map(|stem| self.wheel(stem, i, unit))).collect()
    }

    /// The value of wheel `i` (from 0): `stem_i+1_unit`, plus the common `stem_unit`.
    pub fn wheel(&self, stem: &str, i: usize, unit: &str) -> f64 {
        self.get(&wheel_name(stem, i, unit)) + self.get(&join(stem, unit))
    }

    /// Sets the value called `name`, or adds it at the end.
    pub fn set(&mut self, name: &str, value: f64) {
        match self.0.iter_mut().find(|(n, _)| n == name) {
            Some(slot) => slot.1 = value,
            None => self.0.push((name.to_owned(), value)),
        }
    }
}

/// `stem_2_unit` for wheel 1 (from 0).
pub fn wheel_name(stem: &str, wheel: usize, unit: &str) -> String {
    join(&format!("{stem}_{}", wheel + 1), unit)
}

fn join(stem: &str, unit: &str) -> String {
    if unit.is_empty() { stem.to_owned() } else { format!("{stem}_{unit}") }
}
