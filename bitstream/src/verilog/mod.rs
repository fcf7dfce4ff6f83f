//! A netlist as Verilog that simulates and synthesises.
//!
//! Ports are named by pins: `P12_i` is what comes in at pin 12, `P12_o` what its driver would put out, `P12_t` is 1
//! while the driver is off. What is outside the chip (the wire, a pull-up) is the reader's.

use crate::netlist::{Cell, CellKind, FlipFlop, Loop, Memory, MemoryPort, NetId, Netlist, PadUse, Signal};
use std::fmt::Write;

/// Source of the block RAM.
const BLOCK_RAM: &str = include_str!("primitives.v");
/// Source of the delay-locked loop.
const DLL: &str = include_str!("dll.v");

/// The netlist as a module of this name, with the modules it needs.
#[must_use]
pub fn emit(netlist: &Netlist, module: &str) -> String {
    let mut writer = Writer { netlist, text: String::new() };
    writer.line("// Made from the frames of a bitstream. Nets are named by their places.");
    writer.line("`timescale 1ns/1ps");
    writer.line("`default_nettype none");
    writer.ports(module);
    writer.nets();
    for cell in &netlist.cells {
        writer.cell(cell);
    }
    writer.pads();
    writer.line("endmodule");
    writer.line("`default_nettype wire");
    let mut text = writer.text;
    if netlist.cells.iter().any(|cell| matches!(cell.kind, CellKind::BlockRam(_))) {
        text.push_str(BLOCK_RAM);
    }
    if netlist.cells.iter().any(|cell| matches!(cell.kind, CellKind::Dll(_))) {
        text.push_str(DLL);
    }
    text
}

struct Writer<'a> {
    netlist: &'a Netlist,
    text: String,
}

impl Writer<'_> {
    fn line(&mut self, line: &str) {
        self.text.push_str(line);
        self.text.push('\n');
    }

    fn name(&self, net: NetId) -> &str {
        &self.netlist.nets[net.0 as usize]
    }

    fn signal(&self, signal: Signal) -> String {
        match signal {
            Signal::Zero => "1'b0".to_owned(),
            Signal::One => "1'b1".to_owned(),
            Signal::Net(net) => self.name(net).to_owned(),
            Signal::Not(net) => format!("~{}", self.name(net)),
        }
    }

    /// Signals as a vector, the first lowest.
    fn vector(&self, signals: impl DoubleEndedIterator<Item = Signal>) -> String {
        let signals: Vec<String> = signals.rev().map(|signal| self.signal(signal)).collect();
        format!("{{{}}}", signals.join(", "))
    }

    fn ports(&mut self, module: &str) {
        let mut ports = Vec::new();
        for PadUse { name, input, output, .. } in &self.netlist.pads {
            if input.is_some() {
                ports.push(format!("    input wire {name}_i"));
            }
            if output.is_some() {
                ports.push(format!("    output wire {name}_o,\n    output wire {name}_t"));
            }
        }
        let _ = writeln!(self.text, "module {module} (\n{}\n);", ports.join(",\n"));
    }

    fn nets(&mut self) {
        let mut stored = vec![None; self.netlist.nets.len()];
        for cell in &self.netlist.cells {
            if let CellKind::FlipFlop(FlipFlop { output, init, .. }) = &cell.kind {
                stored[output.0 as usize] = Some(*init);
            }
        }
        for (net, init) in self.netlist.nets.iter().zip(stored) {
            let _ = match init {
                Some(init) => writeln!(self.text, "    reg {net} = 1'b{};", u8::from(init)),
                None => writeln!(self.text, "    wire {net};"),
            };
        }
    }

    fn cell(&mut self, cell: &Cell) {
        let assign = |output: NetId, value: String| format!("    assign {} = {value};", self.name(output));
        let line = match &cell.kind {
            CellKind::Lut { table, inputs, output } => assign(*output, self.table(*table, inputs)),
            CellKind::Alias { input, output } => assign(*output, self.signal(*input)),
            CellKind::Mux { select, one, zero, output, .. } => {
                assign(*output, format!("{} ? {} : {}", self.signal(*select), self.signal(*one), self.signal(*zero)))
            }
            CellKind::Xor { inputs, output } => {
                assign(*output, format!("{} ^ {}", self.signal(inputs[0]), self.signal(inputs[1])))
            }
            CellKind::And { inputs, output } => {
                assign(*output, format!("{} & {}", self.signal(inputs[0]), self.signal(inputs[1])))
            }
            CellKind::Bus { drivers, output } => {
                // Off it adds 1, and a bus that nobody drives is 1.
                let drivers = drivers.iter();
                let terms: Vec<_> =
                    drivers.map(|(data, off)| format!("({} | {})", self.signal(*off), self.signal(*data))).collect();
                assign(*output, if terms.is_empty() { "1'b1".to_owned() } else { terms.join(" & ") })
            }
            CellKind::ClockBuffer { input, enable, idle, output } => assign(
                *output,
                match (enable, idle) {
                    (Signal::One, _) => self.signal(*input),
                    (enable, false) => format!("{} & {}", self.signal(*input), self.signal(*enable)),
                    (enable, true) => format!("{} | ~{}", self.signal(*input), self.signal(*enable)),
                },
            ),
            CellKind::FlipFlop(flip_flop) => self.flip_flop(flip_flop),
            CellKind::Shift { init, address, data, clock, enable, output } => {
                let register = format!("{}_bits", self.name(*output));
                let shift = format!("{register} <= {{{register}[14:0], {}}}", self.signal(*data));
                format!(
                    "    reg [15:0] {register} = 16'h{init:04x};\n    {}\n{}",
                    self.clocked(*clock, &format!("if ({}) {shift};", self.signal(*enable))),
                    assign(*output, format!("{register}[{}]", self.vector(address.iter().copied())))
                )
            }
            CellKind::Ram { init, write_address, read_address, data, clock, enables, output } => {
                let register = format!("{}_bits", self.name(*output));
                let at = self.vector(write_address.iter().copied());
                let enable = format!("{} & {}", self.signal(enables[0]), self.signal(enables[1]));
                let write = format!("if ({enable}) {register}[{at}] <= {};", self.signal(*data));
                format!(
                    "    reg [15:0] {register} = 16'h{init:04x};\n    {}\n{}",
                    self.clocked(*clock, &write),
                    assign(*output, format!("{register}[{}]", self.vector(read_address.iter().copied())))
                )
            }
            CellKind::BlockRam(memory) => self.memory(&cell.place, memory),
            CellKind::Dll(found) => self.dll(&cell.place, found),
        };
        self.line(&line);
    }

    fn table(&self, table: u16, inputs: &[Signal; 4]) -> String {
        format!("16'h{table:04x} >> {}", self.vector(inputs.iter().copied()))
    }

    /// A statement at the rising edge of a signal.
    fn clocked(&self, clock: Signal, statement: &str) -> String {
        match clock {
            Signal::Net(net) => format!("always @(posedge {}) {statement}", self.name(net)),
            Signal::Not(net) => format!("always @(negedge {}) {statement}", self.name(net)),
            _ => "// Its clock never moves.".to_owned(),
        }
    }

    fn flip_flop(&self, flip_flop: &FlipFlop) -> String {
        let FlipFlop { data, clock, enable, reset, reverse, synchronous, latch, init, output } = *flip_flop;
        let q = self.name(output);
        let mut statement = String::new();
        let mut edges = String::new();
        for (condition, value) in [(reset, init), (reverse, !init)] {
            if condition == Signal::Zero {
                continue;
            }
            let _ = write!(statement, "if ({}) {q} <= 1'b{}; else ", self.signal(condition), u8::from(value));
            match condition {
                Signal::Net(net) if !synchronous => {
                    let _ = write!(edges, " or posedge {}", self.name(net));
                }
                Signal::Not(net) if !synchronous => {
                    let _ = write!(edges, " or negedge {}", self.name(net));
                }
                _ => {}
            }
        }
        if enable != Signal::One {
            let _ = write!(statement, "if ({}) ", self.signal(enable));
        }
        let _ = write!(statement, "{q} <= {};", self.signal(data));
        if latch {
            // Open while the clock is 1; set and reset act through it.
            let open = self.latch_opens(clock, reset, reverse, synchronous);
            return format!("    always @* if ({open}) begin {} end", statement.replace("<=", "="));
        }
        match clock {
            Signal::Net(net) => format!("    always @(posedge {}{edges}) {statement}", self.name(net)),
            Signal::Not(net) => format!("    always @(negedge {}{edges}) {statement}", self.name(net)),
            _ if edges.is_empty() => format!("    // {q}: its clock never moves."),
            _ => format!(
                "    always @({}) {}",
                &edges[" or ".len()..],
                statement.rsplit_once(" else ").map_or("", |(statement, _)| statement)
            ),
        }
    }

    fn latch_opens(&self, clock: Signal, reset: Signal, reverse: Signal, synchronous: bool) -> String {
        let mut terms = vec![self.signal(clock)];
        if !synchronous {
            terms.extend([reset, reverse].iter().filter(|term| **term != Signal::Zero).map(|term| self.signal(*term)));
        }
        terms.join(" | ")
    }

    fn memory(&self, place: &str, memory: &Memory) -> String {
        let hex: String = memory
            .contents
            .chunks(4)
            .rev()
            .map(|bits| {
                let digit = bits.iter().enumerate().fold(0, |digit, (n, bit)| digit | u32::from(*bit) << n);
                char::from_digit(digit, 16).unwrap_or('0')
            })
            .collect();
        let mut text = String::new();
        let mut connections = Vec::new();
        for (suffix, port) in ["a", "b"].into_iter().zip(&memory.ports) {
            let MemoryPort { clock, enable, write, reset, address, data, output, .. } = port;
            let _ = writeln!(text, "    wire [15:0] {place}_{suffix};");
            for (name, signal) in [("clk", clock), ("en", enable), ("we", write), ("rst", reset)] {
                connections.push(format!(".{name}_{suffix}({})", self.signal(*signal)));
            }
            connections.push(format!(".addr_{suffix}({})", self.vector(address.iter().copied())));
            let padded = data.iter().copied().chain(std::iter::repeat(Signal::Zero)).take(16).collect::<Vec<_>>();
            connections.push(format!(".di_{suffix}({})", self.vector(padded.into_iter())));
            connections.push(format!(".do_{suffix}({place}_{suffix})"));
            for (bit, net) in output.iter().enumerate() {
                if let Some(net) = net {
                    let _ = writeln!(text, "    assign {} = {place}_{suffix}[{bit}];", self.name(*net));
                }
            }
        }
        let widths = memory.ports.each_ref().map(|port| port.width.bits());
        let parameters = format!(".WIDTH_A({}), .WIDTH_B({}), .CONTENTS(4096'h{hex})", widths[0], widths[1]);
        let _ = write!(text, "    xc2s200_block_ram #({parameters}) {place} ({});", connections.join(", "));
        text
    }

    fn dll(&self, place: &str, found: &Loop) -> String {
        let mut connections = vec![
            format!(".clkin({})", self.signal(found.clock)),
            format!(".clkfb({})", self.signal(found.feedback)),
            format!(".rst({})", self.signal(found.reset)),
        ];
        for (pin, net) in &found.outputs {
            connections.push(format!(".{}({})", pin.to_lowercase(), self.name(*net)));
        }
        let divide = u32::from(found.setting.divide_count) + 1;
        format!("    xc2s200_dll #(.DIVIDE({divide})) {place} ({});", connections.join(", "))
    }

    fn pads(&mut self) {
        for pad in &self.netlist.pads {
            if let Some(net) = pad.input {
                let _ = writeln!(self.text, "    assign {} = {}_i;", self.netlist.nets[net.0 as usize], pad.name);
            }
            if let Some((data, off)) = pad.output {
                let (data, off) = (self.signal(data), self.signal(off));
                let _ = writeln!(self.text, "    assign {0}_o = {data};\n    assign {0}_t = {off};", pad.name);
            }
        }
    }
}
