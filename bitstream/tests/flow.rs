//! The flow on small netlists: the same bytes for a seed, legal routes, bits that mean the netlist.

use bitstream::configuration::{Configuration, StartUp};
use bitstream::container::{Bitstream, Header, PART};
use bitstream::device::{BelKind, Device};
use bitstream::element::{Carry0, FOutput, GOutput, Slice};
use bitstream::flow::constraints::Constraints;
use bitstream::flow::netlist::Netlist;
use bitstream::flow::prove::prove;
use bitstream::flow::timing::decoded::longest;
use bitstream::flow::{Built, FlowError, Progress, build};
use bitstream::netlist::{CellKind, Signal, extract};
use serde_json::{Map, Value, json};

/// A netlist of yosys under construction; nets are numbers from 2 up, as yosys has them.
#[derive(Default)]
struct Source {
    cells: Map<String, Value>,
    ports: Map<String, Value>,
    names: Map<String, Value>,
    constraints: String,
    next: u64,
}

impl Source {
    fn net(&mut self, name: &str) -> u64 {
        self.next += 1;
        let net = self.next + 1;
        self.names.insert(name.to_owned(), json!({ "bits": [net] }));
        net
    }

    fn cell(&mut self, name: &str, kind: &str, parameters: impl Into<Value>, pins: &[(&str, Value)]) {
        let parameters = parameters.into();
        let pins: Map<String, Value> = pins.iter().map(|(pin, bits)| ((*pin).to_owned(), json!([bits]))).collect();
        self.cells.insert(name.to_owned(), json!({ "type": kind, "parameters": parameters, "connections": pins }));
    }

    fn input(&mut self, port: &str, pin: u8) -> u64 {
        let (pad, net) = (self.net(&format!("{port}_pad")), self.net(port));
        self.ports.insert(port.to_owned(), json!({ "bits": [pad] }));
        self.cell(&format!("ibuf_{port}"), "IBUF", json!({}), &[("I", json!(pad)), ("O", json!(net))]);
        self.constraints += &format!("NET \"{port}\" LOC = \"P{pin}\" | IOSTANDARD = LVTTL;\n");
        net
    }

    fn output(&mut self, port: &str, pin: u8, net: u64) {
        let pad = self.net(&format!("{port}_pad"));
        self.ports.insert(port.to_owned(), json!({ "bits": [pad] }));
        self.cell(&format!("obuf_{port}"), "OBUF", json!({}), &[("I", json!(net)), ("O", json!(pad))]);
        self.constraints +=
            &format!("NET \"{port}\" LOC = \"P{pin}\" | IOSTANDARD = LVTTL | DRIVE = 24 | SLEW = SLOW;\n");
    }

    fn clock(&mut self) -> u64 {
        let (pad, clock) = (self.input("clock", 182), self.net("clock_tree"));
        self.cell("bufg", "BUFG", json!({}), &[("I", json!(pad)), ("O", json!(clock))]);
        clock
    }

    fn flop(&mut self, name: &str, clock: u64, data: Value, reset: Value, initial: &str) -> u64 {
        let output = self.net(name);
        let pins = [("C", json!(clock)), ("CE", json!("1")), ("D", data), ("R", reset), ("Q", json!(output))];
        self.cell(&format!("ff_{name}"), "FDRE", json!({ "INIT": initial }), &pins);
        output
    }

    fn json(&self) -> String {
        let module = json!({ "cells": self.cells, "ports": self.ports, "netnames": self.names });
        json!({ "modules": { "top": module } }).to_string()
    }

    fn build(&self, seed: u64) -> Result<Built, FlowError> {
        let constraints = Constraints::parse(&self.constraints).unwrap();
        build(&self.json(), "top", &constraints, seed, &mut Progress::silent())
    }
}

/// A counter of so many bits on the carry chain, its highest bit at a pin, its reset at another.
fn counter(bits: usize) -> Source {
    let mut source = Source::default();
    let (clock, reset) = (source.clock(), source.input("reset", 98));
    let mut carry = json!("1");
    let mut last = 0;
    for bit in 0..bits {
        let (sum, next) = (source.net(&format!("sum{bit}")), source.net(&format!("carry{bit}")));
        last = source.flop(&format!("q{bit}"), clock, json!(sum), json!(reset), "0");
        let pins = [("S", json!(last)), ("CI", carry.clone()), ("DI", json!("0")), ("O", json!(next))];
        source.cell(&format!("mux{bit}"), "MUXCY", json!({}), &pins);
        let pins = [("LI", json!(last)), ("CI", carry), ("O", json!(sum))];
        source.cell(&format!("xor{bit}"), "XORCY", json!({}), &pins);
        carry = json!(next);
    }
    source.output("high", 84, last);
    source
}

fn file(built: &Built) -> Vec<u8> {
    built.configuration.file(Device::xc2s200(), &Header { part: PART.into(), ..Header::default() }, StartUp::default())
}

#[test]
fn a_seed_gives_the_same_bytes_and_another_seed_others() {
    // A counter alone has one best place; a row of flip-flops has many.
    let mut source = counter(16);
    let (clock, mut last) = (4, source.input("data", 99));
    for stage in 0..40 {
        last = source.flop(&format!("stage{stage}"), clock, json!(last), json!("0"), "0");
    }
    source.output("end", 86, last);
    let (one, same, other) = (source.build(3).unwrap(), source.build(3).unwrap(), source.build(4).unwrap());
    assert!(file(&one) == file(&same) && file(&one) != file(&other));
    let read = Bitstream::parse(&file(&one)).unwrap();
    let device = Device::xc2s200();
    assert_eq!(Configuration::from_packets(device, &read.packets).unwrap(), one.configuration);
}

#[test]
fn a_counter_is_a_column_of_slices() {
    let built = counter(9).build(1).unwrap();
    assert_eq!((built.resources.slices, built.resources.flip_flops, built.resources.carries), (5, 9, 9));
    let (device, first) = (Device::xc2s200(), built.placement.columns[0]);
    for row in 0..5 {
        let tile = device.tile_at("CLB", first.column, first.row + row).unwrap();
        let slice = Slice::read(device, &built.configuration, tile, first.slice).unwrap();
        assert_eq!((slice.x, slice.f_selects_carry, slice.carry0), (FOutput::Xor, true, Carry0::Zero));
        assert_eq!(slice.carry_from_bx, row == 0);
        assert!(!slice.x_register_takes_bx && slice.synchronous_reset && !slice.invert_sr && !slice.invert_bx);
        assert_eq!(slice.g_selects_carry, row < 4);
        assert_eq!(slice.f.count_ones(), 8, "a table of one input");
        if row < 4 {
            assert_eq!(slice.y, GOutput::Xor);
        }
    }
}

#[test]
fn what_the_bits_say_of_time_is_what_the_flow_says() {
    let built = counter(32).build(1).unwrap();
    let flow = built.timing.domains[0].worst[0].delay;
    let bits = longest(Device::xc2s200(), &built.configuration)[2].clone();
    assert_eq!(bits.delay, flow);
    assert_eq!(bits.flip_flops, 16, "slices with a clock");
}

#[test]
fn a_flipped_bit_is_seen_by_the_decoder_or_by_the_proof() {
    let source = counter(8);
    let built = source.build(1).unwrap();
    let netlist = Netlist::from_yosys(&source.json(), "top").unwrap();
    let constraints = Constraints::parse(&source.constraints).unwrap();
    let (device, at) = (Device::xc2s200(), built.placement.columns[0]);
    let tile = device.tile_at("CLB", at.column, at.row).unwrap();
    let differs = |attribute: &str, bit: usize| {
        let mut broken = built.configuration.clone();
        let class = device.class(tile);
        let found = &class.attributes[usize::from(class.attribute(attribute).unwrap())];
        let place = device.bit(tile, found.bits[bit]);
        broken.set_bit(place, !broken.bit(place));
        match extract(device, &broken) {
            Err(_) => true,
            Ok(decoded) => !prove(device, &netlist, &constraints, &built.drivers, &decoded).holds(),
        }
    };
    assert!(built.proof.holds());
    assert_eq!((built.proof.flip_flops, built.proof.pads, built.proof.unobservable.len()), (8, 3, 0));
    let slice = |attribute: &str| format!("SLICE[{}]:{attribute}", at.slice);
    // Pins that are not routed are 1, so a table of one input has two words that count: 14 and 15.
    for attribute in ["F", "G"] {
        assert!(differs(&slice(attribute), 14) && differs(&slice(attribute), 15) && !differs(&slice(attribute), 0));
    }
    for attribute in ["FXMUX", "GYMUX", "CY0", "CYSELF", "CYSELG", "DXMUX", "DYMUX", "INITX", "INITY"] {
        assert!(differs(&slice(attribute), 0), "{attribute}");
    }
    for attribute in ["FF_LATCH", "FF_SR_SYNC", "INV.CE", "INV.CLK", "INV.SR", "INV.BX", "RAMCONFIG"] {
        assert!(differs(&slice(attribute), 0), "{attribute}");
    }
    // YB is not used.
    assert!(!differs(&slice("YBMUX"), 0));
}

#[test]
fn a_decoded_table_that_reads_itself_is_a_loop_of_logic() {
    let source = counter(8);
    let built = source.build(1).unwrap();
    let netlist = Netlist::from_yosys(&source.json(), "top").unwrap();
    let constraints = Constraints::parse(&source.constraints).unwrap();
    let device = Device::xc2s200();
    let mut decoded = extract(device, &built.configuration).unwrap();
    let tables = decoded.cells.iter_mut().filter_map(|cell| match &mut cell.kind {
        CellKind::Lut { inputs, output, .. } => Some((inputs, *output)),
        _ => None,
    });
    let (inputs, output) = tables.into_iter().next().expect("a table");
    inputs[0] = Signal::Net(output);
    let proof = prove(device, &netlist, &constraints, &built.drivers, &decoded);
    assert!(proof.differences[0].starts_with("the decoded circuit has a loop of logic at "), "{:?}", proof.differences);
}

#[test]
fn five_inputs_are_a_pair_of_tables() {
    let mut source = Source::default();
    let inputs: Vec<u64> =
        [98, 99, 101, 102, 112].iter().enumerate().map(|(at, pin)| source.input(&format!("i{at}"), *pin)).collect();
    let (low, high, out) = (source.net("low"), source.net("high"), source.net("out"));
    for (name, init, net) in [("low", "0110100110010110", low), ("high", "1000000000000001", high)] {
        let pins = [
            ("I0", json!(inputs[0])),
            ("I1", json!(inputs[1])),
            ("I2", json!(inputs[2])),
            ("I3", json!(inputs[3])),
            ("O", json!(net)),
        ];
        source.cell(name, "LUT4", json!({ "INIT": init }), &pins);
    }
    let pins = [("I0", json!(low)), ("I1", json!(high)), ("S", json!(inputs[4])), ("O", json!(out))];
    source.cell("mux", "MUXF5", json!({}), &pins);
    source.output("o", 84, out);
    let built = source.build(1).unwrap();
    let (device, at) = (Device::xc2s200(), built.placement.columns[0]);
    let slice = Slice::read(device, &built.configuration, device.tile_at("CLB", at.column, at.row).unwrap(), at.slice);
    let slice = slice.unwrap();
    // BX chooses F where it is 1.
    assert_eq!((slice.x, slice.f, slice.g, slice.invert_bx), (FOutput::F5, 0b1000_0000_0000_0001, 0x6996, false));
    assert!(device.pin(device.tile_at("CLB", at.column, at.row).unwrap(), BelKind::Slice, at.slice, "BX").is_some());
}

#[test]
fn a_small_pair_an_inverter_and_a_constant_become_one_table() {
    let mut source = Source::default();
    let (a, b, s) = (source.input("a", 98), source.input("b", 99), source.input("s", 101));
    let (not, and, out) = (source.net("not"), source.net("and"), source.net("out"));
    source.cell("inv", "INV", json!({}), &[("I", json!(a)), ("O", json!(not))]);
    let pins = [("I0", json!(not)), ("I1", json!(b)), ("O", json!(and))];
    source.cell("and", "LUT2", json!({ "INIT": "1000" }), &pins);
    let pins = [("I0", json!("1")), ("I1", json!(and)), ("S", json!(s)), ("O", json!(out))];
    source.cell("mux", "MUXF5", json!({}), &pins);
    source.output("o", 84, out);
    let built = source.build(1).unwrap();
    assert_eq!((built.resources.tables, built.resources.slices), (1, 1));
}

#[test]
fn faults_of_the_netlist_are_named() {
    let mut source = counter(2);
    source.cell("strange", "SRL16", json!({}), &[]);
    let error = source.build(1).unwrap_err().to_string();
    assert!(error.contains("strange (SRL16)"), "{error}");

    let mut source = counter(2);
    let loose = source.net("loose");
    source.output("o", 86, loose);
    let mut undriven = counter(2);
    let (nothing, clock) = (undriven.net("nothing"), 3);
    undriven.flop("q", clock, json!(nothing), json!("0"), "0");
    let error = undriven.build(1).map(|_| ()).unwrap_err().to_string();
    assert!(error.contains("nothing"), "{error}");

    let mut source = counter(2);
    source.constraints = source.constraints.replace("P98", "P1");
    let error = source.build(1).unwrap_err().to_string();
    assert!(error.contains("port reset") && error.contains("pin 1"), "{error}");
}

#[test]
fn a_memory_has_its_contents_and_its_unused_pins_float() {
    let mut source = Source::default();
    let clock = source.clock();
    let address = source.input("address", 98);
    let data: Vec<u64> = (0..16).map(|bit| source.net(&format!("data{bit}"))).collect();
    let zeros = |count: usize| json!(vec!["0"; count]);
    let mut at = vec![json!("0"); 8];
    at[0] = json!(address);
    let connections = json!({
        "CLK": [clock], "EN": ["1"], "RST": ["0"], "WE": ["0"], "ADDR": at, "DI": zeros(16), "DO": data,
    });
    let row = format!("{}1010110011110001", "0".repeat(240));
    source.cells.insert(
        "memory".into(),
        json!({ "type": "RAMB4_S16", "parameters": { "INIT_00": row }, "connections": connections }),
    );
    source.output("o", 84, data[0]);
    let built = source.build(1).unwrap();
    let device = Device::xc2s200();
    let (column, row) = bitstream::flow::place::MEMORY_SITES[built.placement.memories[0]];
    let tile = device.tile_at(if column == 1 { "BRAM_W" } else { "BRAM_E" }, column, row).unwrap();
    let memory = bitstream::element::BlockRam::read(device, &built.configuration, tile).unwrap();
    let word = (0..16).fold(0_u32, |word, bit| word | u32::from(memory.contents[bit]) << bit);
    assert_eq!(word, 0b1010_1100_1111_0001);
    assert_eq!(memory.ports[0].width.bits(), 16);
    let [a, b] = memory.ports;
    assert!(!a.invert_clk && !a.invert_en && a.invert_we && a.invert_rst && b.invert_en && b.invert_we);
}
