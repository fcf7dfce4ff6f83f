//! Walks from the pads backwards and makes a cell of each element that something depends on.

use super::routing::{Output, Routing, Source};
use super::{Cell, CellKind, NetId, Netlist, NetlistFault, Signal};
use crate::configuration::Configuration;
use crate::device::{BelKind, Device, TileId, WireId};
use crate::element::{Dll, GlobalBuffer};
use std::collections::HashMap;

/// The circuit of a configuration.
///
/// # Errors
/// All faults that were found, in the order of tiles and then of the walk.
pub fn extract(device: &Device, configuration: &Configuration) -> Result<Netlist, Vec<NetlistFault>> {
    let mut faults = Vec::new();
    let routing = Routing::read(device, configuration, &mut faults);
    let mut extractor = Extractor {
        device,
        configuration,
        routing,
        faults,
        netlist: Netlist::default(),
        outputs: HashMap::new(),
        inner: HashMap::new(),
        todo: Vec::new(),
        slices: HashMap::new(),
        loops: HashMap::new(),
        memories: HashMap::new(),
        input_pads: HashMap::new(),
    };
    extractor.pads();
    while let Some((output, net)) = extractor.todo.pop() {
        if let Err(fault) = extractor.define(output, net) {
            extractor.faults.push(fault);
        }
    }
    extractor.finish()
}

/// A point inside a slice or on a bus that is a net of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Inner {
    Table(bool),
    F5,
    F6,
    /// Table F or G exclusive or the carry into it.
    Sum(bool),
    /// Carry into F, into G, out of G.
    Carry(u8),
    Bus(u32),
}

pub(super) struct Extractor<'a> {
    pub(super) device: &'a Device,
    pub(super) configuration: &'a Configuration,
    pub(super) routing: Routing,
    pub(super) faults: Vec<NetlistFault>,
    pub(super) netlist: Netlist,
    outputs: HashMap<Output, NetId>,
    pub(super) inner: HashMap<(TileId, u8, Inner), NetId>,
    todo: Vec<(Output, NetId)>,
    pub(super) slices: HashMap<(TileId, u8), crate::element::Slice>,
    loops: HashMap<TileId, usize>,
    pub(super) memories: HashMap<TileId, usize>,
    pub(super) input_pads: HashMap<String, usize>,
}

impl Extractor<'_> {
    pub(super) fn net(&mut self, name: String) -> NetId {
        self.netlist.nets.push(name);
        NetId(self.netlist.nets.len() as u32 - 1)
    }

    pub(super) fn cell(&mut self, place: &str, kind: CellKind) {
        self.netlist.cells.push(Cell { place: place.to_owned(), kind });
    }

    /// Name of an element's place: `X12Y3_S0`.
    pub(super) fn place(&self, tile: TileId, kind: BelKind, index: u8) -> String {
        let found = self.device.tile(tile);
        let stem = match kind {
            BelKind::Slice => format!("S{index}"),
            BelKind::Io => format!("IO{index}"),
            BelKind::BlockRam => "RAM".to_owned(),
            BelKind::Dll => "DLL".to_owned(),
            BelKind::GlobalBuffer => format!("GB{index}"),
            BelKind::ClockPad => format!("CP{index}"),
            BelKind::TriState => format!("T{index}"),
            _ => format!("{kind:?}{index}"),
        };
        format!("X{}Y{}_{stem}", found.column, found.row)
    }

    /// As the device's classes have it; empty where a class has no such element.
    pub(super) fn pin_name(&self, output: Output) -> &'static str {
        let bel = self.device.class(output.tile).bel(output.kind, output.index);
        bel.map_or("", |bel| bel.pins[usize::from(output.pin)].name)
    }

    /// What an input sees; unrouted it is 1.
    pub(super) fn input(&mut self, tile: TileId, kind: BelKind, index: u8, pin: &str, invert: bool) -> Signal {
        let Some(wire) = self.device.pin(tile, kind, index, pin) else { return Signal::One.inverted(invert) };
        let signal = match self.routing.source(wire) {
            Ok(Source::Unrouted) => Signal::One,
            Ok(Source::Wire(from)) => self.driven_by(from),
            Ok(Source::Floating) => {
                let element = self.place(tile, kind, index);
                let wire = self.device.describe_wire(wire);
                self.faults.push(NetlistFault::Floating { element, pin: pin.to_owned(), wire });
                Signal::One
            }
            Err(at) => {
                self.faults.push(NetlistFault::Loop { wire: self.device.describe_wire(at) });
                Signal::One
            }
        };
        signal.inverted(invert)
    }

    fn driven_by(&mut self, wire: WireId) -> Signal {
        let Some(output) = self.routing.output(wire) else { return Signal::One };
        if let Some(net) = self.outputs.get(&output) {
            return Signal::Net(*net);
        }
        let name = format!("{}_{}", self.place(output.tile, output.kind, output.index), self.pin_name(output));
        let net = self.net(name);
        self.outputs.insert(output, net);
        self.todo.push((output, net));
        Signal::Net(net)
    }

    /// Makes the cells behind an output.
    fn define(&mut self, output: Output, net: NetId) -> Result<(), NetlistFault> {
        match output.kind {
            BelKind::Slice => self.slice_output(output, net),
            BelKind::Io => self.pad_output(output, net),
            BelKind::ClockPad => {
                self.clock_pad_output(output, net);
                Ok(())
            }
            BelKind::TriStateBus => {
                self.bus_output(output, net);
                Ok(())
            }
            BelKind::BlockRam => self.memory_output(output, net),
            BelKind::GlobalBuffer => self.clock_buffer(output, net),
            BelKind::Dll => self.dll_output(output, net),
            _ => Err(NetlistFault::Unsupported {
                element: self.place(output.tile, output.kind, output.index),
                what: format!("drives {}", self.pin_name(output)),
            }),
        }
    }

    fn clock_buffer(&mut self, output: Output, net: NetId) -> Result<(), NetlistFault> {
        let Output { tile, kind, index, .. } = output;
        let setting = GlobalBuffer::read(self.device, self.configuration, tile, index)?;
        let input = self.input(tile, kind, index, "IN", false);
        let enable = self.input(tile, kind, index, "CE", setting.invert_ce);
        let place = self.place(tile, kind, index);
        self.cell(&place, CellKind::ClockBuffer { input, enable, idle: setting.disabled_high, output: net });
        Ok(())
    }

    fn dll_output(&mut self, output: Output, net: NetId) -> Result<(), NetlistFault> {
        let Output { tile, kind, index, .. } = output;
        let pin = self.pin_name(output);
        if let Some(at) = self.loops.get(&tile) {
            if let CellKind::Dll(found) = &mut self.netlist.cells[*at].kind {
                found.outputs.push((pin, net));
            }
            return Ok(());
        }
        let setting = Dll::read(self.device, self.configuration, tile)?;
        let clock = self.input(tile, kind, index, "CLKIN", false);
        let feedback = self.input(tile, kind, index, "CLKFB", false);
        let reset = self.input(tile, kind, index, "RST", setting.invert_rst);
        let place = self.place(tile, kind, index);
        self.loops.insert(tile, self.netlist.cells.len());
        let found = super::Loop { setting, clock, feedback, reset, outputs: vec![(pin, net)] };
        self.cell(&place, CellKind::Dll(Box::new(found)));
        Ok(())
    }

    fn finish(mut self) -> Result<Netlist, Vec<NetlistFault>> {
        self.netlist.pads.sort_by(|a, b| (a.pin, &a.name).cmp(&(b.pin, &b.name)));
        for cell in &mut self.netlist.cells {
            if let CellKind::Dll(found) = &mut cell.kind {
                found.outputs.sort_unstable();
            }
        }
        if self.faults.is_empty() { Ok(self.netlist) } else { Err(self.faults) }
    }
}
