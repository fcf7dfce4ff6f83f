//! Pads and block RAM.

use super::extract::Extractor;
use super::routing::Output;
use super::{CellKind, FlipFlop, Memory, MemoryPort, NetId, NetlistFault, PadUse, Signal};
use crate::device::{BelKind, PadSite, TileId};
use crate::element::{BlockRam, ClockPad, InputBuffer, Io, PadRegister};

const IO: BelKind = BelKind::Io;
/// Bits of the widest port of a block RAM.
const WIDEST: usize = 16;
/// Address pins of a port.
const ADDRESS_PINS: usize = 12;

impl Extractor<'_> {
    /// Every pad that can drive, in the order of pins, then those that are not bonded.
    pub(super) fn pads(&mut self) {
        let bonded: Vec<(Option<u8>, TileId, TileId, u8)> = self
            .device
            .pads()
            .iter()
            .filter_map(|pad| match pad.site {
                PadSite::Io { tile, buffer, index } => Some((Some(pad.pin), tile, buffer, index)),
                _ => None,
            })
            .collect();
        for (pin, tile, buffer, index) in bonded {
            if let Err(fault) = self.pad(pin, tile, buffer, index) {
                self.faults.push(fault);
            }
        }
    }

    fn pad(&mut self, pin: Option<u8>, tile: TileId, buffer: TileId, index: u8) -> Result<(), NetlistFault> {
        let io = Io::read_at(self.device, self.configuration, tile, buffer, index)?;
        if !io.driver.is_on() {
            return Ok(());
        }
        let place = self.place(tile, IO, index);
        let mut data = self.input(tile, IO, index, "O", io.invert_o);
        if io.registered_output {
            data = self.pad_register(tile, index, &io, &io.output_register, ("OCE", "OQ"), data);
        }
        let mut off = self.input(tile, IO, index, "T", io.invert_t);
        if io.registered_tristate {
            off = self.pad_register(tile, index, &io, &io.tristate_register, ("TCE", "TQ"), off);
        }
        let at = self.pad_at(pin, &place, Some(io));
        self.netlist.pads[at].output = Some((data, off));
        Ok(())
    }

    fn pad_register(
        &mut self,
        tile: TileId,
        index: u8,
        io: &Io,
        register: &PadRegister,
        (enable, name): (&str, &str),
        data: Signal,
    ) -> Signal {
        let place = self.place(tile, IO, index);
        let output = self.net(format!("{place}_{name}"));
        let cell = self.pad_flip_flop(tile, index, io, register, enable, data, output);
        self.cell(&place, CellKind::FlipFlop(cell));
        Signal::Net(output)
    }

    #[expect(clippy::too_many_arguments, reason = "a register's place, setting and nets")]
    fn pad_flip_flop(
        &mut self,
        tile: TileId,
        index: u8,
        io: &Io,
        register: &PadRegister,
        enable: &str,
        data: Signal,
        output: NetId,
    ) -> FlipFlop {
        let reset = if register.reset { self.input(tile, IO, index, "SR", io.invert_sr) } else { Signal::Zero };
        FlipFlop {
            data,
            clock: self.input(tile, IO, index, "CLK", register.invert_clk),
            enable: self.input(tile, IO, index, enable, register.invert_ce),
            reset,
            reverse: Signal::Zero,
            synchronous: register.synchronous_reset,
            latch: register.latch,
            init: register.init,
            output,
        }
    }

    /// The pad's entry, made on first use.
    fn pad_at(&mut self, pin: Option<u8>, place: &str, io: Option<Io>) -> usize {
        let name = pin.map_or_else(|| place.to_owned(), |pin| format!("P{pin}"));
        if let Some(at) = self.input_pads.get(&name) {
            return *at;
        }
        let at = self.netlist.pads.len();
        self.input_pads.insert(name.clone(), at);
        self.netlist.pads.push(PadUse { pin, name, input: None, output: None, io });
        at
    }

    /// The net of what comes in at a pad.
    fn pad_input(&mut self, at: usize) -> Signal {
        if let Some(net) = self.netlist.pads[at].input {
            return Signal::Net(net);
        }
        let name = format!("{}_in", self.netlist.pads[at].name);
        let net = self.net(name);
        self.netlist.pads[at].input = Some(net);
        Signal::Net(net)
    }

    /// I or IQ of a pad.
    pub(super) fn pad_output(&mut self, output: Output, net: NetId) -> Result<(), NetlistFault> {
        let Output { tile, index, .. } = output;
        let place = self.place(tile, IO, index);
        let found = self.device.tile(tile);
        let buffer = match self.device.class(tile).name {
            "IO_W" => "IOB_W_V",
            "IO_E" => "IOB_E_V",
            "IO_S" => "IOB_S_V",
            _ => "IOB_N_V",
        };
        let unsupported = |what: &str| NetlistFault::Unsupported { element: place.clone(), what: what.to_owned() };
        let Some(buffer) = self.device.tile_at(buffer, found.column, found.row) else {
            return Err(unsupported("is no pad"));
        };
        let Ok(io) = Io::read_at(self.device, self.configuration, tile, buffer, index) else {
            return Err(unsupported("is used as an input and has no buffer"));
        };
        if io.input == InputBuffer::None {
            return Err(unsupported("is used as an input with its buffer off"));
        }
        let pin = self.device.pads().iter().find(|pad| pad.site == PadSite::Io { tile, buffer, index });
        let at = self.pad_at(pin.map(|pad| pad.pin), &place, Some(io));
        let value = self.pad_input(at);
        if self.pin_name(output) == "IQ" {
            let cell = self.pad_flip_flop(tile, index, &io, &io.input_register, "ICE", value, net);
            self.cell(&place, CellKind::FlipFlop(cell));
        } else {
            self.alias(&place, value, net);
        }
        Ok(())
    }

    pub(super) fn clock_pad_output(&mut self, output: Output, net: NetId) {
        let Output { tile, index, .. } = output;
        let pad = self
            .device
            .pads()
            .iter()
            .find(|pad| matches!(pad.site, PadSite::Clock { tile: at, index: n, .. } if (at, n) == (tile, index)));
        let place = self.place(tile, BelKind::ClockPad, index);
        if ClockPad::read(self.device, self.configuration, tile, index)
            .is_ok_and(|found| found.input == InputBuffer::None)
        {
            self.faults.push(NetlistFault::Unsupported {
                element: place.clone(),
                what: "is used as a clock with its buffer off".to_owned(),
            });
        }
        let at = self.pad_at(pad.map(|pad| pad.pin), &place, None);
        let value = self.pad_input(at);
        self.alias(&place, value, net);
    }

    /// DOA or DOB of a block RAM.
    pub(super) fn memory_output(&mut self, output: Output, net: NetId) -> Result<(), NetlistFault> {
        let tile = output.tile;
        let pin = self.pin_name(output);
        let cell = match self.memories.get(&tile) {
            Some(cell) => *cell,
            None => self.memory(tile)?,
        };
        let (port, bit) = (usize::from(pin.starts_with("DOB")), pin[3..].parse::<usize>().unwrap_or(0));
        if let CellKind::BlockRam(memory) = &mut self.netlist.cells[cell].kind {
            memory.ports[port].output[bit] = Some(net);
        }
        Ok(())
    }

    fn memory(&mut self, tile: TileId) -> Result<usize, NetlistFault> {
        const RAM: BelKind = BelKind::BlockRam;
        let setting = BlockRam::read(self.device, self.configuration, tile)?;
        let mut port = |name: char, port: &crate::element::Port| MemoryPort {
            width: port.width,
            clock: self.input(tile, RAM, 0, &format!("CLK{name}"), port.invert_clk),
            enable: self.input(tile, RAM, 0, &format!("EN{name}"), port.invert_en),
            write: self.input(tile, RAM, 0, &format!("WE{name}"), port.invert_we),
            reset: self.input(tile, RAM, 0, &format!("RST{name}"), port.invert_rst),
            address: (0..ADDRESS_PINS)
                .map(|n| {
                    let used = n >= port.width.address_shift();
                    if used { self.input(tile, RAM, 0, &format!("ADDR{name}{n}"), false) } else { Signal::Zero }
                })
                .collect(),
            data: (0..port.width.bits()).map(|n| self.input(tile, RAM, 0, &format!("DI{name}{n}"), false)).collect(),
            output: vec![None; WIDEST],
        };
        let ports = [port('A', &setting.ports[0]), port('B', &setting.ports[1])];
        let place = self.place(tile, RAM, 0);
        let cell = self.netlist.cells.len();
        self.memories.insert(tile, cell);
        self.cell(&place, CellKind::BlockRam(Box::new(Memory { ports, contents: setting.contents })));
        Ok(cell)
    }
}
