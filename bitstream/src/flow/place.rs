//! Places slices and block memories by simulated annealing on wire length and time.
//!
//! All sums are whole numbers and the random numbers come from one seeded generator, so that a seed gives
//! the same placement on every machine.

mod anneal;
mod grid;

pub use grid::{MEMORY_SITES, Site};

use super::FlowError;
use super::constraints::Constraints;
use super::logic::Logic;
use super::nets::{Nets, Part};
use super::pack::Packed;
use super::reach::Reach;
use super::timing::Graph;
use super::{Progress, Stage};
use crate::device::{Device, PadSite};

/// Where everything stands.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct Placement {
    /// Lowest slice of every column of the packed design.
    pub columns: Vec<Site>,
    /// Index into [`MEMORY_SITES`] of every block memory.
    pub memories: Vec<usize>,
    /// Column and row of every pad.
    pub pads: Vec<(u8, u8)>,
}

impl Placement {
    /// Places a packed design.
    ///
    /// # Errors
    /// A design that does not fit, or a pad that the package does not have.
    pub fn of(device: &Device, design: &Design<'_>, seed: u64, progress: &mut Progress<'_>) -> Result<Self, FlowError> {
        let pads = pads(device, design.logic, design.constraints)?;
        if design.logic.memories.len() > MEMORY_SITES.len() {
            let (used, there) = (design.logic.memories.len(), MEMORY_SITES.len());
            return Err(FlowError::Full { what: "block memories", used, there });
        }
        let first = grid::first(design.packed)?;
        let memories = (0..design.logic.memories.len()).collect();
        let mut placement = Self { columns: first, memories, pads };
        anneal::anneal(design, &mut placement, &Reach::of(device), seed, progress);
        Ok(placement)
    }

    /// Column and row of a part.
    #[must_use]
    pub fn at(&self, part: Part) -> (u8, u8) {
        match part {
            Part::Slice(column, row) => {
                let site = self.columns[column as usize];
                (site.column, site.row + row as u8)
            }
            Part::Memory(index) => {
                let (column, row) = MEMORY_SITES[self.memories[index as usize]];
                (column, row + 1)
            }
            Part::Pad(index) => self.pads[index as usize],
            Part::Clock(_) => (23, 29),
        }
    }

    /// Wire delays from distances, for every connection.
    #[must_use]
    pub fn estimate(&self, nets: &Nets, reach: &Reach) -> Vec<u32> {
        let mut wires = Vec::new();
        for routed in &nets.general {
            let from = self.at(routed.source.part);
            wires.extend(routed.sinks.iter().map(|sink| reach.delay(from, self.at(sink.part))));
        }
        wires
    }
}

/// Everything that is known of a design before it is placed.
pub struct Design<'a> {
    /// What was mapped: tables, chains, flip-flops.
    pub logic: &'a Logic,
    /// Its slices.
    pub packed: &'a Packed,
    /// Which pins each net joins.
    pub nets: &'a Nets,
    /// Its timing graph.
    pub graph: &'a Graph,
    /// Places of the pads, periods of the clocks, and when pads are due.
    pub constraints: &'a Constraints,
}

/// Weights of connections, 0 to 255: a power of each share of the period, against that of the largest.
pub(super) fn weights(shares: &[u16], power: u32) -> Vec<u16> {
    let worst = u64::from(shares.iter().copied().max().unwrap_or(1).max(1));
    let weight = |share: u16| (0..power).fold(255 << 16, |weight: u64, _| weight * u64::from(share) / worst) >> 16;
    shares.iter().map(|share| weight(*share) as u16).collect()
}

fn pads(device: &Device, logic: &Logic, constraints: &Constraints) -> Result<Vec<(u8, u8)>, FlowError> {
    let place = |port: &str| {
        let constraint = constraints
            .pads
            .get(port)
            .ok_or_else(|| FlowError::Pad { port: port.to_owned(), what: "has no pin in the constraints".into() })?;
        match device.pad(constraint.pin).map(|pad| pad.site) {
            Some(PadSite::Io { tile, .. } | PadSite::Clock { tile, .. }) => {
                let tile = device.tile(tile);
                Ok((tile.column, tile.row))
            }
            _ => Err(FlowError::Pad {
                port: port.to_owned(),
                what: format!("is bound to pin {}, which is none for users", constraint.pin),
            }),
        }
    };
    logic.pads.iter().map(|pad| place(&pad.port)).collect()
}

/// The stage that the placer reports.
pub(super) const STAGE: Stage = Stage::Place;
