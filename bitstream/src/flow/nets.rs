//! The packed design as nets between pins of parts: what placer and router work on.

use super::logic::Logic;
use super::netlist::{Net, Signal};
use super::pack::Packed;
use std::borrow::Cow;
use std::collections::BTreeMap;

/// A part with pins.
#[derive(Clone, Copy, Debug, Eq, Ord, PartialEq, PartialOrd)]
pub enum Part {
    /// A slice: column of the packed design, and which slice of it, lowest first.
    Slice(u32, u16),
    /// A block memory.
    Memory(u32),
    /// Index of a pad in the logic.
    Pad(u32),
    /// A clock buffer.
    Clock(u32),
}

/// An end of a net, by the part it belongs to.
#[derive(Clone, Debug, Eq, Ord, PartialEq, PartialOrd)]
pub struct Pin {
    /// Part of the packed design that it belongs to.
    pub part: Part,
    /// Its name in the device.
    pub name: Cow<'static, str>,
}

/// A net with its pins.
#[derive(Clone, Debug)]
pub struct Routed {
    /// Which net of the logic.
    pub net: Net,
    /// The one pin that drives it.
    pub source: Pin,
    /// All pins that read it.
    pub sinks: Vec<Pin>,
}

/// Every net of the design with its driver and what it leads to.
#[derive(Clone, Debug, Default)]
pub struct Nets {
    /// Nets through the general interconnect.
    pub general: Vec<Routed>,
    /// Clocks, from a buffer through the clock tree.
    pub clocks: Vec<Routed>,
}

impl Nets {
    /// Lists the nets.
    #[must_use]
    pub fn of(logic: &Logic, packed: &Packed) -> Self {
        let mut sources: BTreeMap<Net, Pin> = BTreeMap::new();
        let mut sinks: BTreeMap<Net, Vec<Pin>> = BTreeMap::new();
        let mut sink = |net: Net, part: Part, name: Cow<'static, str>| {
            sinks.entry(net).or_default().push(Pin { part, name });
        };
        for (column, slices) in packed.columns.iter().enumerate() {
            for (row, slice) in slices.slices.iter().enumerate() {
                let part = Part::Slice(column as u32, row as u16);
                for (name, net) in slice.sources() {
                    sources.insert(net, Pin { part, name: name.into() });
                }
                slice.sinks().into_iter().for_each(|(name, net)| sink(net, part, name.into()));
                if let Some(control) = slice.control {
                    sink(control.clock, part, "CLK".into());
                }
            }
        }
        for (index, memory) in logic.memories.iter().enumerate() {
            let part = Part::Memory(index as u32);
            for (port, side) in memory.ports.iter().zip(['A', 'B']) {
                let Some(port) = port else { continue };
                let mut pin = |signal: Signal, name: String| {
                    signal.net().into_iter().for_each(|net| sink(net, part, name.clone().into()));
                };
                pin(Signal::of(port.clock), format!("CLK{side}"));
                pin(port.enable, format!("EN{side}"));
                pin(port.reset, format!("RST{side}"));
                pin(port.write, format!("WE{side}"));
                let first = 12 - port.address.len();
                for (bit, signal) in port.address.iter().enumerate() {
                    pin(*signal, format!("ADDR{side}{}", bit + first));
                }
                for (bit, signal) in port.data.iter().enumerate() {
                    // What is never written needs no data.
                    if port.write != Signal::Constant(false) {
                        pin(*signal, format!("DI{side}{bit}"));
                    }
                }
                for (bit, net) in port.output.iter().enumerate() {
                    net.map(|net| sources.insert(net, Pin { part, name: format!("DO{side}{bit}").into() }));
                }
            }
        }
        for (index, pad) in logic.pads.iter().enumerate() {
            let part = Part::Pad(index as u32);
            pad.input.map(|net| sources.insert(net, Pin { part, name: "I".into() }));
            pad.output.and_then(Signal::net).into_iter().for_each(|net| sink(net, part, "O".into()));
            pad.tristate.net().into_iter().for_each(|net| sink(net, part, "T".into()));
        }
        for (index, (from, to)) in logic.clock_buffers.iter().enumerate() {
            let part = Part::Clock(index as u32);
            sink(*from, part, "IN".into());
            sources.insert(*to, Pin { part, name: "OUT".into() });
        }
        let mut nets = Self::default();
        for (net, sinks) in sinks {
            let Some(source) = sources.get(&net).cloned() else { continue };
            let clock = matches!(source.part, Part::Clock(_));
            let to = if clock { &mut nets.clocks } else { &mut nets.general };
            to.push(Routed { net, source, sinks });
        }
        nets
    }

    /// Nets that are read but that nothing drives, by name: a fault of the netlist.
    #[must_use]
    pub fn undriven(&self, logic: &Logic, packed: &Packed) -> Vec<String> {
        let driven: std::collections::BTreeSet<Net> =
            self.general.iter().chain(&self.clocks).map(|routed| routed.net).collect();
        let read = packed.slices().flat_map(super::pack::Slice::sinks).map(|(_, net)| net);
        let mut names: Vec<String> =
            read.filter(|net| !driven.contains(net)).map(|net| logic.nets[net.index()].clone()).collect();
        names.sort();
        names.dedup();
        names
    }
}
