//! The effects that can be hidden, each with five sizes from near the detection limit to gross.
//!
//! Names and parameter names are those that a workflow is expected to report. "Relative" parameters count from the nominal
//! value (0.01 = 1 % more). Sizes are the magnitude's centre: the drawn value scatters by ±13 % about it, and signs, wheels
//! and directions are drawn.

mod control;
mod drive;
mod friction;
mod motion;
mod outside;

use std::collections::BTreeMap;

use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use serde::{Deserialize, Serialize};

use crate::error::Error;
use crate::machine::Machine;
use crate::noise::named_stream;
use crate::robot::Robot;

pub(crate) use outside::draw_hits;
pub use outside::outside;

/// The link of the chain in which an effect shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Link {
    /// Time stamps of the log.
    Timing,
    /// Command to set point.
    Command,
    /// Set point and counts to duty.
    Controller,
    /// Duty to counts.
    Drive,
    /// Counts to camera pose.
    Motion,
}

/// A hidden effect with its true parameters.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Hidden {
    /// Name, as in the catalogue.
    pub name: String,
    /// Link in which it shows first.
    pub link: Link,
    /// Size level 1 to 5.
    pub size: u8,
    /// Wheels it sits on, from 1; empty = the whole robot.
    pub wheels: Vec<usize>,
    /// True values by parameter name.
    pub parameters: BTreeMap<String, f64>,
}

/// A catalogue entry.
pub struct Entry {
    /// Name, kebab-case.
    pub name: &'static str,
    /// Link in which it shows first.
    pub link: Link,
    /// Magnitudes of the five sizes.
    pub sizes: [f64; 5],
    /// Parameter and unit to which the sizes refer, and what it is.
    pub meaning: &'static str,
    /// Puts the effect into the machine.
    pub(crate) hide: fn(&mut Hand<'_>) -> Found,
}

/// Wheels (from 1) and parameters of an effect just hidden.
pub(crate) struct Found {
    wheels: Vec<usize>,
    parameters: BTreeMap<String, f64>,
}

/// What an effect needs to be hidden: its drawn magnitude, random numbers, the machine.
pub(crate) struct Hand<'a> {
    /// Drawn magnitude, in the unit of the entry's sizes.
    pub(crate) value: f64,
    /// Size level, 1 to 5.
    pub(crate) level: u8,
    pub(crate) rng: &'a mut ChaCha8Rng,
    pub(crate) machine: &'a mut Machine,
    pub(crate) robot: &'a mut Robot,
}

impl Hand<'_> {
    /// +1 or −1.
    pub(crate) fn sign(&mut self) -> f64 {
        if self.rng.random_bool(0.5) { 1.0 } else { -1.0 }
    }

    /// The magnitude with a drawn sign.
    pub(crate) fn signed(&mut self) -> f64 {
        self.sign() * self.value
    }

    /// An angle in [0, 2π).
    pub(crate) fn angle(&mut self) -> f64 {
        self.rng.random_range(0.0..std::f64::consts::TAU)
    }

    /// Index of a drawn wheel.
    pub(crate) fn wheel(&mut self) -> usize {
        self.rng.random_range(0..self.machine.wheels.len())
    }

    /// All wheels' indices.
    pub(crate) fn every_wheel(&self) -> std::ops::Range<usize> {
        0..self.machine.wheels.len()
    }

    /// One drawn wheel or all of them, at even odds.
    pub(crate) fn one_or_all(&mut self) -> Vec<usize> {
        if self.rng.random_bool(0.5) { vec![self.wheel()] } else { self.every_wheel().collect() }
    }
}

impl Found {
    /// An effect of the whole robot.
    pub(crate) fn whole<const N: usize>(parameters: [(&str, f64); N]) -> Self {
        Self::on([], parameters)
    }

    /// An effect of these wheels (indices from 0).
    pub(crate) fn on<const N: usize>(wheels: impl IntoIterator<Item = usize>, parameters: [(&str, f64); N]) -> Self {
        Self {
            wheels: wheels.into_iter().map(|i| i + 1).collect(),
            parameters: parameters.into_iter().map(|(name, value)| (name.to_owned(), value)).collect(),
        }
    }

    /// Adds a parameter.
    pub(crate) fn with(mut self, name: impl Into<String>, value: f64) -> Self {
        self.parameters.insert(name.into(), value);
        self
    }
}

/// Every effect of the catalogue.
pub fn catalogue() -> impl Iterator<Item = &'static Entry> {
    [motion::MOTION, friction::FRICTION, drive::DRIVE, control::CONTROL].into_iter().flatten()
}

/// The catalogue entry of this name.
pub fn find(name: &str) -> Result<&'static Entry, Error> {
    catalogue().find(|entry| entry.name == name).ok_or_else(|| Error::UnknownEffect(name.to_owned()))
}

/// The entry of this name outside the catalogue.
pub fn find_outside(name: &str) -> Result<&'static Entry, Error> {
    outside().find(|entry| entry.name == name).ok_or_else(|| Error::UnknownEffect(name.to_owned()))
}

/// A magnitude at size level 1 to 5: its centre, scattered.
pub(crate) fn drawn(sizes: &[f64; 5], level: u8, rng: &mut ChaCha8Rng) -> Result<f64, Error> {
    let centre = sizes.get(usize::from(level).wrapping_sub(1)).ok_or(Error::Size(level))?;
    Ok(centre * rng.random_range(-0.13_f64..0.13).exp())
}

/// Hides `entry` at size level 1 to 5 in the machine; its random numbers depend on seed and name only.
pub(crate) fn hide(
    entry: &Entry,
    level: u8,
    seed: u64,
    machine: &mut Machine,
    robot: &mut Robot,
) -> Result<Hidden, Error> {
    let mut rng = named_stream(seed, entry.name);
    let value = drawn(&entry.sizes, level, &mut rng)?;
    let found = (entry.hide)(&mut Hand { value, level, rng: &mut rng, machine, robot });
    Ok(Hidden {
        name: entry.name.to_owned(),
        link: entry.link,
        size: level,
        wheels: found.wheels,
        parameters: found.parameters,
    })
}
