//! Packs tables, chains, pairs and flip-flops into slices.
//!
//! A slice has two halves, each a table, a flip-flop and one bypass pin (BX, BY); the flip-flops share
//! clock, enable, reset and reverse. A carry chain is a column of slices. A flip-flop stands where its
//! data are made if its control set allows; else its data come through the bypass.

mod fill;
mod slice;

pub use slice::{Bypass, CarryData, CarryIn, Control, Half, Shape, Slice};

use super::FlowError;
use super::logic::{Chain, Data, Logic, Table};
use super::netlist::{FlipFlop, Net, Signal};
use std::collections::BTreeMap;

/// Slices that stand in one column, lowest first: a carry chain, or a single slice.
#[derive(Clone, Debug, Default)]
pub struct Column {
    /// Neighbours in this order, for the carry runs upwards.
    pub slices: Vec<Slice>,
}

/// A packed design: its slices; memories and pads stay as they are in the logic.
#[derive(Clone, Debug, Default)]
pub struct Packed {
    /// Columns of slices.
    pub columns: Vec<Column>,
}

impl Packed {
    /// Puts the cells of a netlist into slices, pads and memories.
    ///
    /// # Errors
    /// More slices than the device has.
    pub fn of(logic: &Logic) -> Result<Self, FlowError> {
        let mut columns: Vec<Column> = logic.chains.iter().map(column).collect();
        columns.extend(logic.wides.iter().map(|wide| Column {
            slices: vec![Slice {
                halves: [
                    Half { shape: Shape::Wide, shows: Some(wide.output), ..Half::of(&wide.high, None) },
                    Half::of(&wide.low, None),
                ],
                bypass: [Bypass::Select(wide.select), Bypass::Free],
                ..Slice::default()
            }],
        }));
        let mut packer = Packer { logic, columns, left: (0..logic.flip_flops.len()).collect() };
        packer.attach();
        fill::fill(&mut packer, super::SLICES);
        let packed = Self { columns: packer.columns };
        let (used, there) = (packed.slices().count(), super::SLICES);
        if used > there {
            return Err(FlowError::Full { what: "slices", used, there });
        }
        Ok(packed)
    }

    /// Slices, column by column, each from below.
    pub fn slices(&self) -> impl Iterator<Item = &Slice> {
        self.columns.iter().flat_map(|column| &column.slices)
    }
}

/// What is packed so far.
struct Packer<'a> {
    logic: &'a Logic,
    columns: Vec<Column>,
    /// Flip-flops without a place.
    left: Vec<usize>,
}

impl Packer<'_> {
    /// Puts flip-flops where chains and pairs make their data.
    fn attach(&mut self) {
        let mut makers: BTreeMap<Net, (usize, usize, usize)> = BTreeMap::new();
        for (at, column) in self.columns.iter().enumerate() {
            for (row, slice) in column.slices.iter().enumerate() {
                for (half, content) in slice.halves.iter().enumerate() {
                    content.shows.map(|net| makers.insert(net, (at, row, half)));
                }
            }
        }
        let logic = self.logic;
        let columns = &mut self.columns;
        self.left.retain(|index| {
            let flop = &logic.flip_flops[*index];
            let Signal::Wire { net, inverted: false } = flop.data else { return true };
            let Some((at, row, half)) = makers.get(&net) else { return true };
            !columns[*at].slices[*row].add_flop(*half, *index, flop, true)
        });
    }
}

fn column(chain: &Chain) -> Column {
    let mut slices = Vec::new();
    for (row, pair) in chain.bits.chunks(2).enumerate() {
        let pin = pair.iter().any(|bit| matches!(bit.data, Data::Pin(_)));
        let one = pair.iter().any(|bit| bit.selects && bit.data == Data::One);
        let data = match (pin, one) {
            (true, _) => CarryData::Pin,
            (_, true) => CarryData::One,
            _ => CarryData::Zero,
        };
        let mut slice =
            Slice { carry: Some(if row == 0 { CarryIn::Bypass } else { CarryIn::Below }), data, ..Slice::default() };
        if row == 0 {
            slice.bypass[0] = Bypass::CarryIn(chain.carry);
        }
        for (half, bit) in slice.halves.iter_mut().zip(pair) {
            let first = match bit.data {
                Data::Pin(net) => Some(Some(net)),
                _ if pin && bit.selects => Some(None),
                _ => None,
            };
            *half = Half {
                shape: if bit.sum.is_some() { Shape::Sum } else { Shape::Table },
                shows: bit.sum.or(bit.shows),
                selects: bit.selects,
                carry: bit.carry,
                carry_out: bit.carry_out,
                ..Half::of(&bit.table, first)
            };
        }
        slices.push(slice);
    }
    Column { slices }
}

/// The control set of a flip-flop: with the reset on the pin that gives its value after configuration.
fn control(flop: &FlipFlop) -> (Control, bool) {
    let idle = Signal::Constant(false);
    let never = matches!(flop.reset, Signal::Constant(false) | Signal::Open);
    let initial = flop.initial.unwrap_or(flop.reset_value);
    let (reset, reverse) = match (never, initial == flop.reset_value) {
        (true, _) => (idle, idle),
        (_, true) => (flop.reset, idle),
        (_, false) => (idle, flop.reset),
    };
    let asynchronous = flop.asynchronous && !never;
    let enable = if flop.enable == Signal::Open { Signal::Constant(true) } else { flop.enable };
    (Control { clock: flop.clock, falling: flop.falling, enable, reset, reverse, asynchronous }, initial)
}

/// A table that stands alone, for tests and fills.
pub(crate) fn half_of(net: Net, table: &Table) -> Half {
    Half { shows: Some(net), ..Half::of(table, None) }
}
