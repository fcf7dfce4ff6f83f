//! What is to be hidden, under which conditions, and the case that comes of it.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

use crate::ablation::Ablation;
use crate::axis;
use crate::effects::{self, Hidden};
use crate::error::Error;
use crate::log::Columns;
use crate::machine::Machine;
use crate::robot::Robot;
use crate::run::Drive;

/// What a case hides.
///
/// As text: `effect-free`, `single[:EFFECT[:SIZE]]`, `pair[:EFFECT+EFFECT[:SIZE]]`, `look-alike[:SIZE]`,
/// `outside[:NAME[:SIZE]]`, `ablation[:NAME]`, `mixed`, `axis[:EFFECT[+EFFECT][:SIZE]]`. What is left out is drawn; an `axis`
/// without a name hides nothing.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Nothing but the nuisances that every set has.
    EffectFree,
    /// One effect of the catalogue.
    Single {
        /// Its name; none = drawn.
        effect: Option<String>,
        /// 1 to 5; none = drawn.
        size: Option<u8>,
    },
    /// Two effects of the catalogue.
    Pair {
        /// Their names; none = drawn.
        effects: Option<[String; 2]>,
        /// 1 to 5 for both; none = each drawn, 2 to 5.
        size: Option<u8>,
    },
    /// Two effects that look alike or nearly cancel.
    LookAlike {
        /// 1 to 5; none = drawn, 2 to 5.
        size: Option<u8>,
    },
    /// An effect that no catalogue lists.
    Outside {
        /// Its name; none = drawn.
        name: Option<String>,
        /// 1 to 5; none = drawn, 2 to 5.
        size: Option<u8>,
    },
    /// Data or truth spoiled on purpose: scoring must fail.
    Ablation(Option<Ablation>),
    /// Any of the above, drawn.
    Mixed,
    /// A single motor or a drive train of any size, in place of a robot.
    Axis {
        /// Names of what it hides.
        effects: Vec<String>,
        /// 1 to 5 for all; none = each drawn, 2 to 5.
        size: Option<u8>,
    },
}

impl FromStr for Kind {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self, Error> {
        let unknown = || Error::UnknownKind(text.to_owned());
        let mut parts = text.split(':');
        let head = parts.next().unwrap_or_default();
        let rest: Vec<&str> = parts.collect();
        let size = |part: Option<&&str>| -> Result<Option<u8>, Error> {
            let Some(part) = part else { return Ok(None) };
            let size: u8 = part.parse().map_err(|_| unknown())?;
            if (1..=5).contains(&size) { Ok(Some(size)) } else { Err(Error::Size(size)) }
        };
        let most = |n: usize| if rest.len() <= n { Ok(()) } else { Err(unknown()) };
        match head {
            "effect-free" => most(0).map(|()| Self::EffectFree),
            "mixed" => most(0).map(|()| Self::Mixed),
            "single" => {
                most(2)?;
                let effect = rest.first().map(|name| effects::find(name).map(|e| e.name.to_owned())).transpose()?;
                Ok(Self::Single { effect, size: size(rest.get(1))? })
            }
            "pair" => {
                most(2)?;
                let effects = match rest.first() {
                    None => None,
                    Some(names) => {
                        let (a, b) = names.split_once('+').ok_or_else(unknown)?;
                        Some([effects::find(a)?.name.to_owned(), effects::find(b)?.name.to_owned()])
                    }
                };
                Ok(Self::Pair { effects, size: size(rest.get(1))? })
            }
            "look-alike" => {
                most(1)?;
                Ok(Self::LookAlike { size: size(rest.first())? })
            }
            "outside" => {
                most(2)?;
                let name =
                    rest.first().map(|name| effects::find_outside(name).map(|e| e.name.to_owned())).transpose()?;
                Ok(Self::Outside { name, size: size(rest.get(1))? })
            }
            "axis" => {
                most(2)?;
                let names = rest.first().map_or(Vec::new(), |names| names.split('+').map(str::to_owned).collect());
                match names.iter().find(|name| !axis::names().any(|known| known == name.as_str())) {
                    Some(name) => Err(Error::UnknownEffect(name.clone())),
                    None => Ok(Self::Axis { effects: names, size: size(rest.get(1))? }),
                }
            }
            "ablation" => {
                most(1)?;
                Ok(Self::Ablation(rest.first().map(|name| name.parse()).transpose()?))
            }
            _ => Err(unknown()),
        }
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::EffectFree => "effect-free",
            Self::Single { .. } => "single",
            Self::Pair { .. } => "pair",
            Self::LookAlike { .. } => "look-alike",
            Self::Outside { .. } => "outside",
            Self::Ablation(_) => "ablation",
            Self::Mixed => "mixed",
            Self::Axis { .. } => "axis",
        })
    }
}

/// Under which conditions the runs are made.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Conditions {
    /// Control and log rate, Hz, 100 to 2000.
    pub rate_hz: f64,
    /// No rotation in any run.
    pub translations_only: bool,
    /// Wheels off the floor: every axis alone, no camera.
    pub blocks: bool,
    /// 3, or 4: a square robot with omni or (at random) mecanum wheels.
    pub wheels: usize,
    /// The camera's columns are in the log.
    pub camera: bool,
    /// The duty columns are in the log.
    pub duty: bool,
    /// The command columns are in the log.
    pub commands: bool,
    /// Always the robot of the example sets; otherwise three of ten sets have another.
    pub standard_robot: bool,
    /// An inertial sensor's columns are in the log.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub inertial: bool,
}

impl Default for Conditions {
    fn default() -> Self {
        Self {
            rate_hz: 1000.0,
            translations_only: false,
            blocks: false,
            wheels: 3,
            camera: true,
            duty: true,
            commands: true,
            standard_robot: false,
            inertial: false,
        }
    }
}

impl Conditions {
    /// Says why they do not go together, if they do not.
    pub fn check(&self) -> Result<(), Error> {
        let wrong = |why: &str| Err(Error::Conditions(why.to_owned()));
        if !(100.0..=2000.0).contains(&self.rate_hz) {
            return wrong("the rate must be between 100 and 2000 Hz");
        }
        if !matches!(self.wheels, 3 | 4) {
            return wrong("the robot has 3 or 4 wheels");
        }
        if !self.duty && (!self.camera || self.blocks) {
            return wrong("without duty and camera nothing can be compared");
        }
        Ok(())
    }
}

/// A drawn case: everything needed to make its data, and what is hidden in them.
#[derive(Clone, Debug, PartialEq)]
pub struct Case {
    /// The seed it was drawn with.
    pub seed: u64,
    /// What kind it is; never `Mixed`.
    pub kind: Kind,
    /// Under which conditions.
    pub conditions: Conditions,
    /// What the designers know: `robot.toml`.
    pub robot: Robot,
    /// What is true.
    pub machine: Machine,
    /// One log each.
    pub drives: Vec<Drive>,
    /// Columns in the log.
    pub columns: Columns,
    /// Hidden effects of the catalogue.
    pub effects: Vec<Hidden>,
    /// Hidden effects outside it.
    pub outside: Vec<Hidden>,
    /// What was spoiled on purpose.
    pub ablation: Option<Ablation>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kinds_are_read_from_text() {
        let kind: Kind = "single:wheel-skew:3".parse().unwrap();
        assert_eq!(kind, Kind::Single { effect: Some("wheel-skew".into()), size: Some(3) });
        let kind: Kind = "pair:robot-mass+torque-constant".parse().unwrap();
        assert_eq!(kind.to_string(), "pair");
        assert_eq!("ablation:absent-truth".parse::<Kind>().unwrap(), Kind::Ablation(Some(Ablation::AbsentTruth)));
        for wrong in
            ["singel", "single:nothing", "single:wheel-skew:6", "pair:a", "effect-free:1", "outside:x", "ablation:x"]
        {
            assert!(wrong.parse::<Kind>().is_err(), "{wrong}");
        }
    }

    #[test]
    fn contradicting_conditions_are_refused() {
        assert!(Conditions::default().check().is_ok());
        for wrong in [
            Conditions { rate_hz: 20.0, ..Conditions::default() },
            Conditions { wheels: 5, ..Conditions::default() },
            Conditions { duty: false, blocks: true, ..Conditions::default() },
        ] {
            assert!(wrong.check().is_err());
        }
    }
}
