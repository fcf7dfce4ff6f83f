//! Pins of placed parts as wires of the device.

use crate::device::{BelKind, Device, PadSite, TileId, WireId};
use crate::flow::FlowError;
use crate::flow::nets::{Part, Pin, Routed};
use crate::flow::place::{Design, MEMORY_SITES, Placement};

/// Source and sinks of a net.
#[derive(Clone, Debug)]
pub struct Ends {
    /// The wire of the driver.
    pub source: WireId,
    /// The wires of the readers, in the order of the net's sinks.
    pub sinks: Vec<WireId>,
}

/// Ends of all nets.
#[derive(Clone, Debug)]
pub struct Terminals {
    /// Of general nets.
    pub general: Vec<Ends>,
    /// Nets that a global buffer drives, which have wires of their own.
    pub clocks: Vec<Ends>,
}

impl Terminals {
    /// Finds the wires of all pins.
    ///
    /// # Errors
    /// A pin that the device does not have where its part was placed.
    pub fn of(device: &Device, design: &Design<'_>, placement: &Placement) -> Result<Self, FlowError> {
        let ends = |routed: &Routed| {
            let wire = |pin: &Pin| wire(device, design, placement, pin);
            let sinks: Result<Vec<_>, _> = routed.sinks.iter().map(wire).collect();
            Ok::<_, FlowError>(Ends { source: wire(&routed.source)?, sinks: sinks? })
        };
        Ok(Self {
            general: design.nets.general.iter().map(ends).collect::<Result<_, _>>()?,
            clocks: design.nets.clocks.iter().map(ends).collect::<Result<_, _>>()?,
        })
    }
}

/// The tile and element of a part.
pub(crate) fn element(
    device: &Device,
    design: &Design<'_>,
    placement: &Placement,
    part: Part,
) -> Option<(TileId, BelKind, u8)> {
    Some(match part {
        Part::Slice(column, row) => {
            let site = placement.columns[column as usize];
            (device.tile_at("CLB", site.column, site.row + row as u8)?, BelKind::Slice, site.slice)
        }
        Part::Memory(index) => {
            let (column, row) = MEMORY_SITES[placement.memories[index as usize]];
            let class = if column == 1 { "BRAM_W" } else { "BRAM_E" };
            (device.tile_at(class, column, row)?, BelKind::BlockRam, 0)
        }
        Part::Pad(index) => {
            let port = &design.logic.pads[index as usize].port;
            match device.pad(design.constraints.pads.get(port)?.pin)?.site {
                PadSite::Io { tile, index, .. } => (tile, BelKind::Io, index),
                PadSite::Clock { tile, index, .. } => (tile, BelKind::ClockPad, index),
                PadSite::Fixed(_) => return None,
            }
        }
        Part::Clock(index) => {
            // A clock's buffer is the one beside its pad.
            let from = design.logic.clock_buffers[index as usize].0;
            let pad = design.logic.pads.iter().position(|pad| pad.input == Some(from))?;
            let (tile, kind, index) = element(device, design, placement, Part::Pad(pad as u32))?;
            (kind == BelKind::ClockPad).then_some((tile, BelKind::GlobalBuffer, index))?
        }
    })
}

fn wire(device: &Device, design: &Design<'_>, placement: &Placement, pin: &Pin) -> Result<WireId, FlowError> {
    let found = element(device, design, placement, pin.part).and_then(|(tile, kind, index)| {
        let name = if kind == BelKind::ClockPad { "GCLKOUT" } else { &pin.name };
        device.pin(tile, kind, index, name)
    });
    found.ok_or_else(|| match pin.part {
        Part::Pad(index) => FlowError::Pad {
            port: design.logic.pads[index as usize].port.clone(),
            what: format!("needs {} of its pad, which its pin does not have", pin.name),
        },
        Part::Clock(index) => FlowError::Pad {
            port: design.logic.nets[design.logic.clock_buffers[index as usize].0.index()].clone(),
            what: "is a clock, and not at one of the clock pins 77, 80, 182 and 185".into(),
        },
        _ => FlowError::Netlist { what: format!("no pin {} at {:?}", pin.name, pin.part) },
    })
}
