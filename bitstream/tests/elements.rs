//! Every mode of a slice, a pad and a bus: set by hand, routed, extracted and run.

mod support;

use bitstream::device::{BelKind, PipId, PipKind, WireId};
use bitstream::element::{Carry0, FOutput, GOutput, RamMode, Slice, TriState};
use bitstream::netlist::{CellKind, NetlistFault};
use std::collections::BTreeMap;
use support::Design;

/// Pins on the west side, beside the logic that the tests use.
const IN: [u8; 9] = [3, 4, 5, 6, 7, 8, 9, 10, 14];
const OUT: [u8; 3] = [30, 31, 33];
const CLOCK: u8 = 24;

fn bits(value: u32, count: usize) -> Vec<bool> {
    (0..count).map(|n| value >> n & 1 == 1).collect()
}

/// Inputs routed to pins of a slice, in order.
fn feed(design: &mut Design, at: (u8, u8), index: u8, pins: &[&str]) {
    let tile = design.clb(at.0, at.1);
    for (pin, name) in IN.iter().zip(pins) {
        let from = design.input(*pin);
        let to = design.slice_pin(tile, index, name);
        design.route(from, to);
    }
}

fn slice(design: &mut Design, at: (u8, u8), index: u8, slice: Slice) {
    let tile = design.clb(at.0, at.1);
    slice.write(design.device, &mut design.configuration, tile, index).expect("a slice");
}

fn out(design: &mut Design, at: (u8, u8), index: u8, pin: &str, pad: u8) -> WireId {
    let from = design.slice_pin(design.clb(at.0, at.1), index, pin);
    design.output(pad, from);
    from
}

#[test]
fn a_table_is_addressed_by_f4_f3_f2_f1() {
    for (index, g) in [(0, false), (1, true)] {
        let names: [&str; 4] = if g { ["G1", "G2", "G3", "G4"] } else { ["F1", "F2", "F3", "F4"] };
        let mut design = Design::new();
        let table = 0x1EE7;
        slice(
            &mut design,
            (3, 20),
            index,
            Slice { f: table, g: table, x: FOutput::F, y: GOutput::G, ..Slice::default() },
        );
        feed(&mut design, (3, 20), index, &names);
        out(&mut design, (3, 20), index, if g { "Y" } else { "X" }, OUT[0]);
        let mut run = design.simulate();
        for n in 0..16 {
            for (pin, value) in IN.iter().zip(bits(n, 4)) {
                run.set(*pin, value);
            }
            assert_eq!(run.get(OUT[0]), table >> n & 1 == 1, "table at {n}");
        }
    }
}

/// The other way round: whatever pins the inputs come in by, the permuted table gives the same function.
#[test]
fn permuted_inputs_and_inverted_bits_give_the_same_function() {
    let function = |n: u32| 0x2B5Cu32 >> n & 1 == 1;
    for order in [[0usize, 1, 2, 3], [3, 2, 1, 0], [1, 3, 0, 2], [2, 0, 3, 1]] {
        let names = ["F1", "F2", "F3", "F4"];
        let mut table = 0u16;
        for address in 0..16u32 {
            let n = (0..4).fold(0, |n, input| n | (address >> order[input] & 1) << input);
            table |= u16::from(function(n)) << address;
        }
        let mut design = Design::new();
        slice(&mut design, (4, 20), 0, Slice { f: table, x: FOutput::F, ..Slice::default() });
        feed(&mut design, (4, 20), 0, &order.map(|pin| names[pin]));
        out(&mut design, (4, 20), 0, "X", OUT[0]);
        let mut run = design.simulate();
        for n in 0..16 {
            for (pin, value) in IN.iter().zip(bits(n, 4)) {
                run.set(*pin, value);
            }
            assert_eq!(run.get(OUT[0]), function(n), "{order:?} at {n}");
        }
    }
}

#[test]
fn f5_is_f_when_bx_is_one_and_f6_its_own_f5_when_by_is_one() {
    for invert in [false, true] {
        let mut design = Design::new();
        let low = Slice { f: 0xAAAA, g: 0xCCCC, x: FOutput::F5, y: GOutput::F6, invert_by: invert, ..Slice::default() };
        let high = Slice { f: 0xAAAA, g: 0x5555, x: FOutput::F5, ..Slice::default() };
        slice(&mut design, (5, 20), 0, low);
        slice(&mut design, (5, 20), 1, high);
        feed(&mut design, (5, 20), 0, &["F1", "G2", "BX", "BY"]);
        let tile = design.clb(5, 20);
        for (pin, name) in IN[4..].iter().zip(["F1", "G1", "BX"]) {
            let from = design.input(*pin);
            let to = design.slice_pin(tile, 1, name);
            design.route(from, to);
        }
        out(&mut design, (5, 20), 0, "Y", OUT[0]);
        out(&mut design, (5, 20), 0, "X", OUT[1]);
        let mut run = design.simulate();
        for n in 0..128 {
            let value = bits(n, 7);
            for (pin, value) in IN.iter().zip(&value) {
                run.set(*pin, *value);
            }
            let own = if value[2] { value[0] } else { value[1] };
            let other = if value[6] { value[4] } else { !value[5] };
            assert_eq!(run.get(OUT[1]), own);
            assert_eq!(run.get(OUT[0]), if value[3] ^ invert { own } else { other }, "{n}");
        }
    }
}

/// An adder of four bits in two slices, carry in by BX: sums and carry out.
#[test]
fn carry_goes_north_and_adds() {
    let mut design = Design::new();
    let adder = Slice {
        f: 0x6666,
        g: 0x6666,
        x: FOutput::Xor,
        y: GOutput::Xor,
        carry0: Carry0::Input,
        f_selects_carry: true,
        g_selects_carry: true,
        ..Slice::default()
    };
    slice(&mut design, (6, 19), 1, Slice { carry_from_bx: true, ..adder });
    slice(&mut design, (6, 20), 1, adder);
    let names =
        [(19, "F1"), (19, "G1"), (20, "F1"), (20, "G1"), (19, "F2"), (19, "G2"), (20, "F2"), (20, "G2"), (19, "BX")];
    for (pin, (row, name)) in IN.iter().zip(names) {
        let from = design.input(*pin);
        let to = design.slice_pin(design.clb(6, row), 1, name);
        design.route(from, to);
    }
    let pads = [30, 31, 33, 34, 35];
    for (pad, (row, name)) in pads.iter().zip([(19, "X"), (19, "Y"), (20, "X"), (20, "Y"), (20, "YB")]) {
        out(&mut design, (6, row), 1, name, *pad);
    }
    let mut run = design.simulate();
    for n in 0..512u32 {
        for (pin, value) in IN.iter().zip(bits(n, 9)) {
            run.set(*pin, value);
        }
        let sum = pads.iter().enumerate().fold(0, |sum, (bit, pad)| sum | u32::from(run.get(*pad)) << bit);
        assert_eq!(sum, (n & 15) + (n >> 4 & 15) + (n >> 8), "{n:#b}");
    }
}

/// The other inputs of the carry multiplexers: 0, 1 and the product of two inputs, seen at XB.
#[test]
fn carry_takes_zero_one_or_a_product() {
    for (carry0, expected) in
        [(Carry0::Zero, [0, 0, 0, 0]), (Carry0::One, [1, 1, 1, 1]), (Carry0::Product, [0, 0, 0, 1])]
    {
        let mut design = Design::new();
        let setting = Slice { f: 0, carry0, f_selects_carry: true, carry_from_bx: true, ..Slice::default() };
        slice(&mut design, (7, 20), 0, setting);
        feed(&mut design, (7, 20), 0, &["F1", "F2"]);
        out(&mut design, (7, 20), 0, "XB", OUT[0]);
        let mut run = design.simulate();
        for (n, expected) in expected.iter().enumerate() {
            if carry0 == Carry0::Product {
                run.set(IN[0], n & 1 == 1);
                run.set(IN[1], n & 2 == 2);
            }
            assert_eq!(u32::from(run.get(OUT[0])), *expected, "{carry0:?} at {n}");
        }
    }
}

/// Flip-flops in every mode against a few lines that say what each mode means.
#[test]
fn flip_flops_follow_their_modes() {
    let mut design = Design::new();
    feed(&mut design, (8, 20), 0, &["BX", "CE", "SR", "BY"]);
    let clock = design.input(CLOCK);
    let to = design.slice_pin(design.clb(8, 20), 0, "CLK");
    design.route(clock, to);
    out(&mut design, (8, 20), 0, "XQ", OUT[0]);
    for mode in 0..256u32 {
        let flag = |n: u32| mode >> n & 1 == 1;
        let setting = Slice {
            x_register_takes_bx: true,
            x_init: flag(0),
            synchronous_reset: flag(1),
            reverse: flag(2),
            invert_bx: flag(3),
            invert_by: flag(4),
            invert_ce: flag(5),
            invert_clk: flag(6),
            invert_sr: flag(7),
            ..Slice::default()
        };
        slice(&mut design, (8, 20), 0, setting);
        let mut run = design.simulate();
        // Quiet inputs: nothing forces the register.
        run.set(CLOCK, setting.invert_clk);
        let mut value = vec![false; 4];
        for (pin, value) in IN.iter().zip(&value) {
            run.set(*pin, *value);
        }
        let mut state = run.get(OUT[0]);
        let mut noise = mode.wrapping_mul(2_654_435_761) | 1;
        for step in 0..25 {
            noise = noise.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            let force = |value: &[bool], state: &mut bool| {
                let reset = value[2] ^ setting.invert_sr;
                let reverse = setting.reverse && value[3] ^ setting.invert_by;
                if reset || reverse {
                    *state = if reset { setting.x_init } else { !setting.x_init };
                }
                reset || reverse
            };
            for (n, new) in bits(noise >> 27, 4).into_iter().enumerate() {
                value[n] = new;
                run.set(IN[n], new);
                if !setting.synchronous_reset {
                    force(&value, &mut state);
                }
            }
            assert_eq!(run.get(OUT[0]), state, "mode {mode:#b}, step {step}, before the edge");
            run.set(CLOCK, !setting.invert_clk);
            if !force(&value, &mut state) && value[1] ^ setting.invert_ce {
                state = value[0] ^ setting.invert_bx;
            }
            assert_eq!(run.get(OUT[0]), state, "mode {mode:#b}, step {step}");
            run.set(CLOCK, setting.invert_clk);
        }
    }
}

#[test]
fn shift_registers_take_bx_and_by_while_sr_is_one() {
    let mut design = Design::new();
    let setting = Slice {
        f: 0x0F0F,
        g: 0,
        ram: RamMode::TwoShifts,
        x: FOutput::F,
        y: GOutput::G,
        invert_sr: false,
        ..Slice::default()
    };
    slice(&mut design, (9, 20), 0, setting);
    feed(&mut design, (9, 20), 0, &["BX", "SR", "F1", "F2", "F3", "F4", "BY"]);
    let clock = design.input(CLOCK);
    let to = design.slice_pin(design.clb(9, 20), 0, "CLK");
    design.route(clock, to);
    out(&mut design, (9, 20), 0, "X", OUT[0]);
    out(&mut design, (9, 20), 0, "Y", OUT[1]);
    let mut run = design.simulate();
    let (mut f, mut noise) = (0x0F0Fu16, 7u32);
    for step in 0..200 {
        noise = noise.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        let value = bits(noise >> 24, 7);
        for (pin, value) in IN.iter().zip(&value) {
            run.set(*pin, *value);
        }
        let address = (0..4).fold(0, |address, n| address | u32::from(value[2 + n]) << n);
        assert_eq!(run.get(OUT[0]), f >> address & 1 == 1, "step {step}");
        run.set(CLOCK, true);
        if value[1] {
            f = f << 1 | u16::from(value[0]);
        }
        run.set(CLOCK, false);
    }
    // G has its address unrouted: all ones, the sixteenth bit back.
    assert!(run.netlist.cells.iter().filter(|cell| matches!(cell.kind, CellKind::Shift { .. })).count() == 2);
}

/// A bus of one row with two drivers in different columns: the tap between them sees whichever is on.
#[test]
fn a_bus_carries_whichever_buffer_is_on() {
    let mut design = Design::new();
    let row = 20;
    // Bus 2 of column 6 is bus 1 of column 5 and bus 0 of column 4: buffer 1 of X5 low, buffer 0 of X4 low.
    for (column, index) in [(4, 0), (5, 1)] {
        let tile = design.clb(column, row);
        let buffer = TriState { drives_low_bus: true, ..TriState::default() };
        buffer.write(design.device, &mut design.configuration, tile, index).expect("a buffer");
        for (n, pin) in ["I", "T"].into_iter().enumerate() {
            let from = design.input(IN[usize::from(index) * 2 + n]);
            let to = design.device.pin(tile, BelKind::TriState, index, pin).expect("a pin");
            design.route(from, to);
        }
    }
    // A buffer of the same number two columns on is on another bus.
    let other = TriState { drives_low_bus: true, invert_t: true, invert_i: true, ..TriState::default() };
    let tile = design.clb(6, row);
    other.write(design.device, &mut design.configuration, tile, 0).expect("a buffer");
    let tap = design.device.pin(design.clb(6, row), BelKind::TriStateBus, 0, "OUT").expect("a pin");
    design.output(OUT[0], tap);
    let mut run = design.simulate();
    for n in 0..16 {
        let value = bits(n, 4);
        for (pin, value) in IN.iter().zip(&value) {
            run.set(*pin, *value);
        }
        let (one, other) = (value[1] || value[0], value[3] || value[2]);
        assert_eq!(run.get(OUT[0]), one && other, "{n:#b}");
    }
}

#[test]
fn faults_name_the_place() {
    // Two inputs onto one wire.
    let mut design = Design::new();
    slice(&mut design, (3, 20), 0, Slice { f: 0xAAAA, x: FOutput::F, ..Slice::default() });
    feed(&mut design, (3, 20), 0, &["F1"]);
    out(&mut design, (3, 20), 0, "X", OUT[0]);
    let device = design.device;
    assert!(design.netlist().is_ok());
    let mut onto: BTreeMap<WireId, Vec<PipId>> = BTreeMap::new();
    for n in 0..device.class(design.clb(3, 20)).pips.len() as u32 {
        let pip = device.tile_pip(design.clb(3, 20), n).expect("a switch");
        if matches!(pip.kind, PipKind::Switch { .. }) {
            onto.entry(pip.to).or_default().push(device.pip_id(design.clb(3, 20), n));
        }
    }
    let pair = onto.values().find(|pips| pips.len() > 1).expect("a wire with two switches");
    let mut broken = Design::new();
    for pip in pair.iter().take(2) {
        broken.configuration.set_pip(device, *pip);
    }
    let faults = broken.netlist().expect_err("two drivers");
    assert!(faults.iter().any(|fault| matches!(fault, NetlistFault::TwoDrivers { .. })), "{faults:?}");
    let text = faults[0].to_string();
    assert!(text.contains("X3Y20.") && text.contains("SINGLE"), "{text}");

    // An input whose multiplexer chooses a wire that nobody drives.
    let mut design = Design::new();
    slice(&mut design, (3, 20), 0, Slice { f: 0xAAAA, x: FOutput::F, ..Slice::default() });
    out(&mut design, (3, 20), 0, "X", OUT[0]);
    let mux = "MUX.IMUX_CLB_F1[0]";
    let tile = design.clb(3, 20);
    let class = device.class(tile);
    let attribute = &class.attributes[usize::from(class.attribute(mux).expect("a multiplexer"))];
    let single = attribute.choices().iter().find(|choice| choice.name.starts_with("SINGLE")).expect("a wire");
    design.configuration.set_choice(device, tile, mux, single.name).expect("a choice");
    let faults = design.netlist().expect_err("nobody drives");
    assert_eq!(faults.len(), 1, "{faults:?}");
    assert!(faults[0].to_string().starts_with("input F1 of X3Y20_S0 hangs on X3Y20.IMUX_CLB_F1[0]"), "{}", faults[0]);

    // Bits that stand for nothing.
    design.configuration.set_pattern(device, tile, attribute, 0x1FF);
    let faults = design.netlist().expect_err("an unknown pattern");
    assert!(faults.iter().any(|fault| fault.to_string().contains("MUX.IMUX_CLB_F1[0] of CLB X3Y20")), "{faults:?}");
}
