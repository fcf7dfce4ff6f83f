//! `[[effect]]`: what was found to be missing in the nominal model.

/// One effect with its fitted parameters and whatever evidence stands beside it.
///
/// The model does not interpret it here; keys it does not know are kept and written back.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Effect {
    /// Name in kebab-case, such as `wheel-skew`.
    pub name: String,
    /// Wheels it acts on, from 1; empty for the whole robot.
    pub wheels: Vec<usize>,
    /// Parameters by name; names end in their unit.
    pub parameters: Vec<(String, EffectParameter)>,
    /// Everything else in the table: evidence, look-alikes, runs.
    pub other: toml::Table,
}

impl Effect {
    /// The value of a parameter.
    pub fn value(&self, name: &str) -> Option<f64> {
        self.parameters.iter().find(|(n, _)| n == name).map(|(_, p)| p.value)
    }
}

/// One fitted number.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct EffectParameter {
    /// As it was fitted, in the unit of the effect's description.
    pub value: f64,
    /// 95 % confidence interval, low and high.
    pub ci95: Option<[f64; 2]>,
    /// Everything else in the table.
    pub other: toml::Table,
}
