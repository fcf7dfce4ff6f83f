//! A slice and what its parts are set to.

use super::control;
use crate::flow::logic::Table;
use crate::flow::netlist::{FlipFlop, Net, Signal};

/// What a half's output (X, Y) shows.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub enum Shape {
    /// What the table says.
    #[default]
    Table,
    /// Its table, exclusive or its carry in.
    Sum,
    /// The pair of tables (X only).
    Wide,
}

/// Half a slice.
#[derive(Clone, Debug, Default, Eq, PartialEq)]
pub struct Half {
    /// Whether its table is in use.
    pub tabled: bool,
    /// Bits of the table, for its pins as joined.
    pub table: u16,
    /// Nets at the table's pins 1 to 4.
    pub pins: [Option<Net>; 4],
    /// What the output shows.
    pub shape: Shape,
    /// The net on the output.
    pub shows: Option<Net>,
    /// Whether the carry listens to the table.
    pub selects: bool,
    /// The net of the carry out of this half, wherever it is read.
    pub carry: Option<Net>,
    /// The net on the carry output (XB, YB), if something beside the chain reads it.
    pub carry_out: Option<Net>,
    /// The flip-flop: index, output net, value after configuration, and whether its data come from the output.
    pub flop: Option<Flop>,
}

/// A flip-flop in its place.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct Flop {
    /// Index in the logic's flip-flops.
    pub index: usize,
    /// Net that Q drives.
    pub output: Net,
    /// Value after configuration and on reset.
    pub initial: bool,
    /// Data come from the half's output; else through the bypass.
    pub through: bool,
}

impl Half {
    /// A half with this table. `first` keeps pin 1 for a net, or free (`Some(None)`).
    #[must_use]
    pub fn of(table: &Table, first: Option<Option<Net>>) -> Self {
        let mut pins = [None; 4];
        let mut places = Vec::with_capacity(table.inputs.len());
        let mut next = usize::from(first.is_some());
        if let Some(net) = first {
            pins[0] = net;
        }
        for net in &table.inputs {
            if first == Some(Some(*net)) {
                places.push(0);
                continue;
            }
            pins[next] = Some(*net);
            places.push(next);
            next += 1;
        }
        Self { tabled: true, table: table.permuted(&places), pins, ..Self::default() }
    }

    /// Whether nothing uses it.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        !self.tabled && self.flop.is_none()
    }
}

/// What the bypass pin is used for.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub enum Bypass {
    /// The input is not used.
    #[default]
    Free,
    /// Data of the half's flip-flop.
    Data(Signal),
    /// Carry into the slice (BX).
    CarryIn(Signal),
    /// Select of the pair (BX).
    Select(Signal),
    /// Forces the opposite of the flip-flops' initial values (BY).
    Reverse(Signal),
}

impl Bypass {
    /// The signal at the pin; what is free may be anything.
    #[must_use]
    pub fn signal(self) -> Option<Signal> {
        match self {
            Self::Free => None,
            Self::Data(signal) | Self::CarryIn(signal) | Self::Select(signal) | Self::Reverse(signal) => Some(signal),
        }
    }
}

/// Where the carry comes from.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum CarryIn {
    /// The pin BX.
    Bypass,
    /// The slice below.
    Below,
}

/// What the carry multiplexers of a slice generate.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub enum CarryData {
    /// Ground.
    #[default]
    Zero,
    /// Supply.
    One,
    /// Pin 1 of each table.
    Pin,
}

/// What the flip-flops of a slice share.
#[derive(Clone, Copy, Debug, Eq, Ord, PartialEq, PartialOrd)]
pub struct Control {
    /// Net that clocks both flip-flops.
    pub clock: Net,
    /// Counts falling edges.
    pub falling: bool,
    /// Clock enable.
    pub enable: Signal,
    /// Forces the initial value.
    pub reset: Signal,
    /// Forces the opposite.
    pub reverse: Signal,
    /// Whether the last two act without a clock.
    pub asynchronous: bool,
}

/// What one slice of a CLB holds.
#[derive(Clone, Debug, Default, Eq, PartialEq)]
pub struct Slice {
    /// F with X, then G with Y.
    pub halves: [Half; 2],
    /// What BX and BY are used for.
    pub bypass: [Bypass; 2],
    /// What the flip-flops share, if there are any.
    pub control: Option<Control>,
    /// Where the carry comes from, if it is used.
    pub carry: Option<CarryIn>,
    /// What the carry multiplexers generate.
    pub data: CarryData,
}

impl Slice {
    /// Puts a flip-flop into a half if it fits.
    pub fn add_flop(&mut self, half: usize, index: usize, flop: &FlipFlop, through: bool) -> bool {
        let (control, initial) = control(flop);
        let reversed = control.reverse != Signal::Constant(false);
        let mut bypass = self.bypass;
        if reversed && self.control.is_none() {
            if bypass[1] != Bypass::Free {
                return false;
            }
            bypass[1] = Bypass::Reverse(control.reverse);
        }
        if !through {
            if bypass[half] != Bypass::Free {
                return false;
            }
            bypass[half] = Bypass::Data(flop.data);
        }
        if self.halves[half].flop.is_some() || self.control.is_some_and(|own| own != control) {
            return false;
        }
        self.bypass = bypass;
        self.control = Some(control);
        self.halves[half].flop = Some(Flop { index, output: flop.output, initial, through });
        true
    }

    /// Pins that nets drive.
    #[must_use]
    pub fn sinks(&self) -> Vec<(&'static str, Net)> {
        const TABLES: [[&str; 4]; 2] = [["F1", "F2", "F3", "F4"], ["G1", "G2", "G3", "G4"]];
        let mut sinks = Vec::new();
        for (half, names) in self.halves.iter().zip(TABLES) {
            sinks.extend(half.pins.iter().zip(names).filter_map(|(net, name)| Some((name, (*net)?))));
        }
        let mut pin = |name: &'static str, signal: Option<Signal>| {
            sinks.extend(signal.and_then(Signal::net).map(|net| (name, net)));
        };
        pin("BX", self.bypass[0].signal());
        pin("BY", self.bypass[1].signal());
        pin("CE", self.control.map(|control| control.enable));
        pin("SR", self.control.map(|control| control.reset));
        sinks
    }

    /// Pins that drive nets.
    #[must_use]
    pub fn sources(&self) -> Vec<(&'static str, Net)> {
        let mut sources = Vec::new();
        for (half, [shows, stores, carries]) in self.halves.iter().zip([["X", "XQ", "XB"], ["Y", "YQ", "YB"]]) {
            sources.extend(half.shows.map(|net| (shows, net)));
            sources.extend(half.flop.map(|flop| (stores, flop.output)));
            sources.extend(half.carry_out.map(|net| (carries, net)));
        }
        sources
    }
}
