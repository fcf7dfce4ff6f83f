//! Cells of yosys, one by one.

use super::{CarryMux, CarryXor, FlipFlop, Lut, Memory, MemoryPort, Names, Net, Netlist, Pad, Signal, WideMux};
use crate::flow::FlowError;
use serde_json::Value;
use std::collections::BTreeMap;

/// One cell in the JSON.
struct Cell<'a> {
    name: &'a str,
    kind: &'a str,
    json: &'a Value,
    names: &'a mut Names,
}

pub(super) fn read(module: &Value, top: &str, mut names: Names) -> Result<Netlist, FlowError> {
    let mut netlist = Netlist { top: top.to_owned(), ..Netlist::default() };
    let ports = ports(module, &mut names);
    for (name, json) in module["cells"].as_object().into_iter().flatten() {
        let kind = json["type"].as_str().unwrap_or("");
        Cell { name, kind, json, names: &mut names }.read(&mut netlist, &ports)?;
    }
    netlist.nets = names.names;
    Ok(netlist)
}

/// Ports of the design by the net of their pad.
fn ports(module: &Value, names: &mut Names) -> BTreeMap<Net, String> {
    let mut ports = BTreeMap::new();
    for (name, port) in module["ports"].as_object().into_iter().flatten() {
        let bits: Vec<_> = port["bits"].as_array().into_iter().flatten().collect();
        for (index, bit) in bits.iter().enumerate() {
            let Some(bit) = bit.as_u64() else { continue };
            let full = if bits.len() == 1 { name.clone() } else { format!("{name}[{index}]") };
            ports.insert(names.net(bit), full);
        }
    }
    ports
}

impl Cell<'_> {
    fn error(&self, what: &str) -> FlowError {
        FlowError::Netlist { what: format!("cell {} ({}): {what}", self.name, self.kind) }
    }

    fn bits(&mut self, pin: &str) -> Result<Vec<Signal>, FlowError> {
        let Some(bits) = self.json["connections"][pin].as_array() else {
            return Err(self.error(&format!("no pin {pin}")));
        };
        let mut signals = Vec::with_capacity(bits.len());
        for bit in bits {
            signals.push(match (bit.as_u64(), bit.as_str()) {
                (Some(bit), _) => Signal::of(self.names.net(bit)),
                (_, Some("0")) => Signal::Constant(false),
                (_, Some("1")) => Signal::Constant(true),
                _ => Signal::Open,
            });
        }
        Ok(signals)
    }

    fn signal(&mut self, pin: &str) -> Result<Signal, FlowError> {
        let bits = self.bits(pin)?;
        if let [bit] = bits[..] { Ok(bit) } else { Err(self.error(&format!("pin {pin} is not one bit"))) }
    }

    fn net(&mut self, pin: &str) -> Result<Net, FlowError> {
        let signal = self.signal(pin)?;
        signal.net().ok_or_else(|| self.error(&format!("pin {pin} is joined to no net")))
    }

    fn parameter(&self, name: &str) -> Option<&str> {
        self.json["parameters"][name].as_str()
    }

    fn read(mut self, to: &mut Netlist, ports: &BTreeMap<Net, String>) -> Result<(), FlowError> {
        match self.kind {
            "INV" => to.luts.push(Lut { inputs: vec![self.signal("I")?], table: 1, output: self.net("O")? }),
            "LUT1" | "LUT2" | "LUT3" | "LUT4" => to.luts.push(self.lut()?),
            "MUXCY" => to.carry_muxes.push(CarryMux {
                select: self.signal("S")?,
                carry: self.signal("CI")?,
                data: self.signal("DI")?,
                output: self.net("O")?,
            }),
            "XORCY" => to.carry_xors.push(CarryXor {
                input: self.signal("LI")?,
                carry: self.signal("CI")?,
                output: self.net("O")?,
            }),
            "MUXF5" | "MUXF6" => to.wide_muxes.push(WideMux {
                select: self.signal("S")?,
                low: self.signal("I0")?,
                high: self.signal("I1")?,
                output: self.net("O")?,
                second: self.kind == "MUXF6",
            }),
            "FDRE" | "FDSE" | "FDCE" | "FDPE" | "FDRE_1" | "FDSE_1" | "FDCE_1" | "FDPE_1" => {
                to.flip_flops.push(self.flip_flop()?);
            }
            "BUFG" => to.clock_buffers.push((self.net("I")?, self.net("O")?)),
            "IBUF" | "OBUF" | "OBUFT" | "IOBUF" => to.pads.push(self.pad(ports)?),
            kind if kind.starts_with("RAMB4_S") => to.memories.push(self.memory()?),
            _ => return Err(self.error("the flow does not know such a cell")),
        }
        Ok(())
    }

    fn lut(&mut self) -> Result<Lut, FlowError> {
        let size = usize::from(self.kind.as_bytes()[3] - b'0');
        let inputs: Result<Vec<_>, _> = (0..size).map(|index| self.signal(&format!("I{index}"))).collect();
        let table = self.parameter("INIT").and_then(|text| u16::from_str_radix(text, 2).ok());
        let table = table.ok_or_else(|| self.error("INIT is no binary word of at most 16 bits"))?;
        Ok(Lut { inputs: inputs?, table, output: self.net("O")? })
    }

    fn flip_flop(&mut self) -> Result<FlipFlop, FlowError> {
        let (pin, reset_value, asynchronous) = match &self.kind[..4] {
            "FDRE" => ("R", false, false),
            "FDSE" => ("S", true, false),
            "FDCE" => ("CLR", false, true),
            _ => ("PRE", true, true),
        };
        let initial = match self.parameter("INIT") {
            Some("0") => Some(false),
            Some("1") => Some(true),
            _ => None,
        };
        Ok(FlipFlop {
            name: self.name.to_owned(),
            clock: self.net("C")?,
            falling: self.kind.ends_with("_1"),
            enable: self.signal("CE")?,
            data: self.signal("D")?,
            reset: self.signal(pin)?,
            reset_value,
            asynchronous,
            initial,
            output: self.net("Q")?,
        })
    }

    fn pad(&mut self, ports: &BTreeMap<Net, String>) -> Result<Pad, FlowError> {
        let pin = match self.kind {
            "IBUF" => "I",
            "IOBUF" => "IO",
            _ => "O",
        };
        let net = self.net(pin)?;
        let port = ports.get(&net).cloned().ok_or_else(|| self.error("a buffer of no port of the design"))?;
        let input = if matches!(self.kind, "IBUF" | "IOBUF") { Some(self.net("O")?) } else { None };
        let output = if self.kind == "IBUF" { None } else { Some(self.signal("I")?) };
        let off = matches!(self.kind, "OBUFT" | "IOBUF");
        let tristate = if off { self.signal("T")? } else { Signal::Constant(false) };
        Ok(Pad { port, input, output, tristate })
    }

    fn memory(&mut self) -> Result<Memory, FlowError> {
        let widths: Result<Vec<usize>, _> = self.kind["RAMB4_S".len()..].split("_S").map(str::parse).collect();
        let widths = widths.map_err(|_| self.error("no width"))?;
        if widths.len() > 2 || widths.iter().any(|width| ![1, 2, 4, 8, 16].contains(width)) {
            return Err(self.error("no block memory of these widths"));
        }
        let mut ports = [None, None];
        for (index, width) in widths.iter().enumerate() {
            let suffix = if widths.len() == 1 { "" } else { ["A", "B"][index] };
            ports[index] = Some(self.memory_port(*width, suffix)?);
        }
        let mut contents = [0; 64];
        for row in 0..16 {
            let bits = self.parameter(&format!("INIT_{row:02X}")).unwrap_or("");
            for (index, bit) in bits.bytes().rev().enumerate().take(256) {
                contents[4 * row + index / 64] |= u64::from(bit == b'1') << (index % 64);
            }
        }
        Ok(Memory { name: self.name.to_owned(), ports, contents })
    }

    fn memory_port(&mut self, width: usize, suffix: &str) -> Result<MemoryPort, FlowError> {
        let pin = |name: &str| format!("{name}{suffix}");
        let port = MemoryPort {
            width,
            clock: self.net(&pin("CLK"))?,
            enable: self.signal(&pin("EN"))?,
            reset: self.signal(&pin("RST"))?,
            write: self.signal(&pin("WE"))?,
            address: self.bits(&pin("ADDR"))?,
            data: self.bits(&pin("DI"))?,
            output: self.bits(&pin("DO"))?.into_iter().map(Signal::net).collect(),
        };
        if port.address.len() != 12 - width.ilog2() as usize || port.data.len() != width || port.output.len() != width {
            return Err(self.error("pins of another width"));
        }
        Ok(port)
    }
}
