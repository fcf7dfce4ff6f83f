//! Slices into tables, multiplexers, carry and flip-flops.

use super::extract::{Extractor, Inner};
use super::routing::Output;
use super::{CellKind, FlipFlop, MuxRole, NetId, NetlistFault, Signal};
use crate::device::{BelKind, TileId};
use crate::element::{Carry0, FOutput, GOutput, RamMode, Slice};

const SLICE: BelKind = BelKind::Slice;

impl Extractor<'_> {
    pub(super) fn slice(&mut self, tile: TileId, index: u8) -> Result<Slice, NetlistFault> {
        if let Some(slice) = self.slices.get(&(tile, index)) {
            return Ok(*slice);
        }
        let slice = Slice::read(self.device, self.configuration, tile, index)?;
        self.slices.insert((tile, index), slice);
        Ok(slice)
    }

    fn pin(&mut self, tile: TileId, index: u8, pin: &str, invert: bool) -> Signal {
        self.input(tile, SLICE, index, pin, invert)
    }

    /// The cells behind X, Y, XB, YB, XQ or YQ.
    pub(super) fn slice_output(&mut self, output: Output, net: NetId) -> Result<(), NetlistFault> {
        let Output { tile, index, .. } = output;
        let slice = self.slice(tile, index)?;
        let place = self.place(tile, SLICE, index);
        let pin = self.pin_name(output);
        match pin {
            "XQ" | "YQ" => {
                let x = pin == "XQ";
                let bypass = if x { slice.x_register_takes_bx } else { slice.y_register_takes_by };
                let data = match (x, bypass) {
                    (true, true) => self.pin(tile, index, "BX", slice.invert_bx),
                    (false, true) => self.pin(tile, index, "BY", slice.invert_by),
                    (true, false) => self.x(tile, index)?,
                    (false, false) => self.y(tile, index)?,
                };
                // SR of a slice with writable tables is their write enable.
                let writable = slice.ram != RamMode::Rom;
                let reset = if writable { Signal::Zero } else { self.pin(tile, index, "SR", slice.invert_sr) };
                let reverse = if slice.reverse { self.pin(tile, index, "BY", slice.invert_by) } else { Signal::Zero };
                let register = FlipFlop {
                    data,
                    clock: self.pin(tile, index, "CLK", slice.invert_clk),
                    enable: self.pin(tile, index, "CE", slice.invert_ce),
                    reset,
                    reverse,
                    synchronous: slice.synchronous_reset,
                    latch: slice.latch,
                    init: if x { slice.x_init } else { slice.y_init },
                    output: net,
                };
                self.cell(&place, CellKind::FlipFlop(register));
            }
            _ => {
                let value = match pin {
                    "X" => self.x(tile, index)?,
                    "Y" => self.y(tile, index)?,
                    "XB" => self.carry(tile, index, 1)?,
                    _ if slice.yb_is_by => self.pin(tile, index, "BY", slice.invert_by),
                    _ => self.carry(tile, index, 2)?,
                };
                self.alias(&place, value, net);
            }
        }
        Ok(())
    }

    /// A net that is another signal under the name of an output.
    pub(super) fn alias(&mut self, place: &str, input: Signal, output: NetId) {
        self.cell(place, CellKind::Alias { input, output });
    }

    /// A net inside a slice, made on first use.
    fn inner(
        &mut self,
        at: (TileId, u8, Inner),
        suffix: &str,
        make: impl FnOnce(&mut Self, NetId) -> Result<CellKind, NetlistFault>,
    ) -> Result<Signal, NetlistFault> {
        if let Some(net) = self.inner.get(&at) {
            return Ok(Signal::Net(*net));
        }
        let place = self.place(at.0, SLICE, at.1);
        let net = self.net(format!("{place}_{suffix}"));
        self.inner.insert(at, net);
        let kind = make(self, net)?;
        self.cell(&place, kind);
        Ok(Signal::Net(net))
    }

    fn x(&mut self, tile: TileId, index: u8) -> Result<Signal, NetlistFault> {
        match self.slice(tile, index)?.x {
            FOutput::F => self.table(tile, index, false),
            FOutput::F5 => self.f5(tile, index),
            FOutput::Xor => self.sum(tile, index, false),
        }
    }

    fn y(&mut self, tile: TileId, index: u8) -> Result<Signal, NetlistFault> {
        match self.slice(tile, index)?.y {
            GOutput::G => self.table(tile, index, true),
            GOutput::Xor => self.sum(tile, index, true),
            GOutput::F6 => self.inner((tile, index, Inner::F6), "F6", |this, output| {
                let slice = this.slice(tile, index)?;
                Ok(CellKind::Mux {
                    role: MuxRole::F6,
                    select: this.pin(tile, index, "BY", slice.invert_by),
                    one: this.f5(tile, index)?,
                    zero: this.f5(tile, 1 - index)?,
                    output,
                })
            }),
        }
    }

    fn f5(&mut self, tile: TileId, index: u8) -> Result<Signal, NetlistFault> {
        self.inner((tile, index, Inner::F5), "F5", |this, output| {
            let slice = this.slice(tile, index)?;
            Ok(CellKind::Mux {
                role: MuxRole::F5,
                select: this.pin(tile, index, "BX", slice.invert_bx),
                one: this.table(tile, index, false)?,
                zero: this.table(tile, index, true)?,
                output,
            })
        })
    }

    fn sum(&mut self, tile: TileId, index: u8, g: bool) -> Result<Signal, NetlistFault> {
        let table = self.table(tile, index, g)?;
        let carry = self.carry(tile, index, u8::from(g))?;
        self.inner((tile, index, Inner::Sum(g)), if g { "SG" } else { "SF" }, |_, output| {
            Ok(CellKind::Xor { inputs: [table, carry], output })
        })
    }

    /// Carry into F (0), into G (1), out of G (2).
    fn carry(&mut self, tile: TileId, index: u8, stage: u8) -> Result<Signal, NetlistFault> {
        let slice = self.slice(tile, index)?;
        if stage == 0 {
            if slice.carry_from_bx {
                return Ok(self.pin(tile, index, "BX", slice.invert_bx));
            }
            let found = self.device.tile(tile);
            let below = found.row.checked_sub(1).and_then(|row| self.device.tile_at("CLB", found.column, row));
            // Below the lowest logic block there is none: its carry in is an input that is not routed.
            return below.map_or(Ok(Signal::One), |below| self.carry(below, index, 2));
        }
        let g = stage == 2;
        if !(if g { slice.g_selects_carry } else { slice.f_selects_carry }) {
            return self.carry(tile, index, stage - 1);
        }
        let suffix = if g { "CG" } else { "CF" };
        self.inner((tile, index, Inner::Carry(stage)), suffix, |this, output| {
            let first = if g { "G1" } else { "F1" };
            let second = if g { "G2" } else { "F2" };
            let zero = match slice.carry0 {
                Carry0::Zero => Signal::Zero,
                Carry0::One => Signal::One,
                Carry0::Input => this.pin(tile, index, first, false),
                Carry0::Product => {
                    let inputs = [this.pin(tile, index, first, false), this.pin(tile, index, second, false)];
                    let place = this.place(tile, SLICE, index);
                    let product = this.net(format!("{place}_{}", if g { "PG" } else { "PF" }));
                    this.cell(&place, CellKind::And { inputs, output: product });
                    Signal::Net(product)
                }
            };
            Ok(CellKind::Mux {
                role: MuxRole::Carry,
                select: this.table(tile, index, g)?,
                one: this.carry(tile, index, stage - 1)?,
                zero,
                output,
            })
        })
    }

    fn table(&mut self, tile: TileId, index: u8, g: bool) -> Result<Signal, NetlistFault> {
        let slice = self.slice(tile, index)?;
        let table = if g { slice.g } else { slice.f };
        let rom = match slice.ram {
            RamMode::Rom => true,
            RamMode::TwoShifts | RamMode::TwoRam16 => false,
            // Which table a single RAM or shift register takes, and how two share their inputs, is known from no file.
            mode => {
                let element = self.place(tile, SLICE, index);
                return Err(NetlistFault::Unsupported { element, what: format!("is a RAM {}", mode.name()) });
            }
        };
        if rom && (table == 0 || table == u16::MAX) {
            return Ok(if table == 0 { Signal::Zero } else { Signal::One });
        }
        self.inner((tile, index, Inner::Table(g)), if g { "LG" } else { "LF" }, |this, output| {
            let mut inputs = [Signal::One; 4];
            for (n, input) in inputs.iter_mut().enumerate() {
                // An input on which the table does not depend is not followed.
                if !rom || depends(table, n) {
                    *input = this.pin(tile, index, &format!("{}{}", if g { 'G' } else { 'F' }, n + 1), false);
                }
            }
            if rom {
                return Ok(CellKind::Lut { table, inputs, output });
            }
            let data = if g {
                this.pin(tile, index, "BY", slice.invert_by)
            } else {
                this.pin(tile, index, "BX", slice.invert_bx)
            };
            let clock = this.pin(tile, index, "CLK", slice.invert_clk);
            let enable = this.pin(tile, index, "SR", slice.invert_sr);
            Ok(if slice.ram == RamMode::TwoShifts {
                CellKind::Shift { init: table, address: inputs, data, clock, enable, output }
            } else {
                let enables = [enable, Signal::One];
                CellKind::Ram { init: table, write_address: inputs, read_address: inputs, data, clock, enables, output }
            })
        })
    }
}

/// Whether input 0 to 3 changes what a table of 16 bits gives.
fn depends(table: u16, input: usize) -> bool {
    (0..16).any(|n| table >> n & 1 != table >> (n ^ 1 << input) & 1)
}
