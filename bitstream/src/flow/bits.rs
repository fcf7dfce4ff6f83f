//! Sets the bits of a placed and routed design.

use super::FlowError;
use super::constraints::Pull as Held;
use super::netlist::{MemoryPort, Signal};
use super::nets::Part;
use super::pack::{self, Bypass, CarryData, CarryIn, Shape};
use super::place::{Design, Placement};
use super::route::{Routing, element};
use crate::configuration::Configuration;
use crate::device::{Device, PadSite};
use crate::element::{
    BlockRam, Carry0, ClockPad, Driver, FOutput, GOutput, InputBuffer, Io, PadRegister, Port, PortWidth, Pull, Slice,
};

/// The configuration of a design.
///
/// # Errors
/// An input/output standard that the device does not have.
pub fn configure(
    device: &Device,
    design: &Design<'_>,
    placement: &Placement,
    routing: &Routing,
) -> Result<Configuration, FlowError> {
    let mut configuration = Configuration::blank(device);
    let bad = |error: crate::configuration::AttributeError| FlowError::Netlist { what: error.to_string() };
    for (column, slices) in design.packed.columns.iter().enumerate() {
        for (row, content) in slices.slices.iter().enumerate() {
            let part = Part::Slice(column as u32, row as u16);
            let Some((tile, _, index)) = element(device, design, placement, part) else { continue };
            slice(content).write(device, &mut configuration, tile, index).map_err(bad)?;
        }
    }
    for (index, memory) in design.logic.memories.iter().enumerate() {
        let Some((tile, ..)) = element(device, design, placement, Part::Memory(index as u32)) else { continue };
        let contents = (0..4_096).map(|bit| memory.contents[bit / 64] >> (bit % 64) & 1 == 1).collect();
        let ports = [0, 1].map(|side| memory.ports[side].as_ref().map_or_else(Port::default, port));
        BlockRam { ports, contents }.write(device, &mut configuration, tile).map_err(bad)?;
    }
    for pad in &design.logic.pads {
        let constraint = &design.constraints.pads[&pad.port];
        match device.pad(constraint.pin).map(|pad| pad.site) {
            Some(PadSite::Clock { tile, index, .. }) => {
                ClockPad { input: InputBuffer::Cmos }.write(device, &mut configuration, tile, index).map_err(bad)?;
            }
            Some(site) => io(device, design, pad)?.write(device, &mut configuration, site).map_err(bad)?,
            None => {}
        }
    }
    for branch in routing.general.iter().chain(&routing.clocks).flat_map(|tree| &tree.branches) {
        configuration.set_pip(device, branch.pip);
    }
    Ok(configuration)
}

/// Puts a word of the user's into the configuration (USERCODE of boundary scan): the hash of the design, say.
///
/// # Errors
/// None on this device.
pub fn set_user_id(device: &Device, configuration: &mut Configuration, id: u32) -> Result<(), FlowError> {
    for (tile, _) in device.tiles_of("CNR_NW") {
        let set = configuration.set_number(device, tile, "BSCAN:USERID", id.into());
        set.map_err(|error| FlowError::Netlist { what: error.to_string() })?;
    }
    Ok(())
}

/// Whether the inverter of a pin is on; a pin with a constant floats, and a floating pin is 1.
fn inverts(signal: Signal) -> bool {
    match signal {
        Signal::Constant(value) => !value,
        Signal::Open => false,
        Signal::Wire { inverted, .. } => inverted,
    }
}

/// A packed slice as the device has it.
#[must_use]
pub fn slice(content: &pack::Slice) -> Slice {
    let [f, g] = &content.halves;
    let carries = content.carry.is_some();
    let takes = |half: usize| matches!(content.bypass[half], Bypass::Data(_));
    let bypass = |half: usize| content.bypass[half].signal().is_some_and(inverts);
    let mut slice = Slice {
        f: f.table,
        g: g.table,
        carry0: match content.data {
            CarryData::Zero => Carry0::Zero,
            CarryData::One => Carry0::One,
            CarryData::Pin => Carry0::Input,
        },
        carry_from_bx: content.carry == Some(CarryIn::Bypass),
        f_selects_carry: carries && f.selects,
        g_selects_carry: carries && g.selects,
        x_register_takes_bx: takes(0),
        y_register_takes_by: takes(1),
        x_init: f.flop.is_some_and(|flop| flop.initial),
        y_init: g.flop.is_some_and(|flop| flop.initial),
        invert_bx: bypass(0),
        invert_by: bypass(1),
        ..Slice::default()
    };
    if f.tabled {
        slice.x = match f.shape {
            Shape::Table => FOutput::F,
            Shape::Sum => FOutput::Xor,
            Shape::Wide => FOutput::F5,
        };
    }
    if g.tabled {
        slice.y = if g.shape == Shape::Sum { GOutput::Xor } else { GOutput::G };
    }
    if let Some(control) = content.control {
        slice.invert_ce = inverts(control.enable);
        slice.invert_sr = inverts(control.reset);
        slice.invert_clk = control.falling;
        slice.synchronous_reset = !control.asynchronous;
        slice.reverse = control.reverse != Signal::Constant(false);
    }
    slice
}

fn port(port: &MemoryPort) -> Port {
    Port {
        width: match port.width {
            1 => PortWidth::W1,
            2 => PortWidth::W2,
            4 => PortWidth::W4,
            8 => PortWidth::W8,
            _ => PortWidth::W16,
        },
        invert_clk: false,
        invert_en: inverts(port.enable),
        invert_we: inverts(port.write),
        invert_rst: inverts(port.reset),
    }
}

fn io(device: &Device, design: &Design<'_>, pad: &super::netlist::Pad) -> Result<Io, FlowError> {
    let constraint = &design.constraints.pads[&pad.port];
    let fault = |what: String| FlowError::Pad { port: pad.port.clone(), what };
    let with_drive = format!("{}.{}", constraint.standard, constraint.drive);
    let standard = device.standard(&with_drive).or_else(|| device.standard(&constraint.standard));
    let standard = standard.ok_or_else(|| fault(format!("has the standard {with_drive}, which the device has not")))?;
    // Used pads of real files: the registers of output and output enable begin with 0.
    let register = PadRegister { init: false, ..Io::default().output_register };
    let mut io = Io {
        output_register: register,
        tristate_register: register,
        input: if pad.input.is_some() { InputBuffer::Cmos } else { InputBuffer::None },
        pull: match constraint.pull {
            Held::None => Pull::None,
            Held::Up => Pull::Up,
            Held::Down => Pull::Down,
            Held::Keeper => Pull::Keeper,
        },
        ..Io::default()
    };
    if let Some(output) = pad.output {
        io.driver = Driver::of(standard, constraint.fast);
        io.invert_o = inverts(output);
        io.invert_t = inverts(pad.tristate);
    }
    Ok(io)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flow::logic::Table;
    use crate::flow::netlist::{FlipFlop, Net};
    use crate::flow::pack::Half;

    fn flop(reset: Signal, reset_value: bool, initial: Option<bool>) -> FlipFlop {
        FlipFlop {
            name: "q".into(),
            clock: Net(9),
            falling: false,
            enable: Signal::of(Net(8)).inverse(),
            data: Signal::of(Net(5)),
            reset,
            reset_value,
            asynchronous: false,
            initial,
            output: Net(6),
        }
    }

    #[test]
    fn an_unused_slice_is_that_of_the_vendor() {
        assert_eq!(slice(&pack::Slice::default()), Slice::default());
    }

    #[test]
    fn a_reset_to_the_other_value_goes_through_the_reverse() {
        let mut packed = pack::Slice::default();
        assert!(packed.add_flop(0, 0, &flop(Signal::of(Net(7)), false, Some(true)), false));
        let made = slice(&packed);
        assert!(made.reverse && made.x_init && made.invert_sr && made.invert_ce && made.synchronous_reset);
        assert_eq!(packed.bypass[1], Bypass::Reverse(Signal::of(Net(7))));
        // BY is taken: no second bypass, no other control set.
        assert!(!packed.add_flop(1, 1, &flop(Signal::of(Net(7)), false, Some(true)), false));
        assert!(packed.add_flop(1, 1, &flop(Signal::of(Net(7)), false, Some(true)), true));
    }

    #[test]
    fn a_reset_to_the_initial_value_goes_to_sr() {
        let mut packed = pack::Slice::default();
        assert!(packed.add_flop(1, 0, &flop(Signal::of(Net(7)).inverse(), true, None), false));
        let made = slice(&packed);
        assert!(!made.reverse && made.y_init && made.invert_sr && made.y_register_takes_by);
        let names: Vec<_> = packed.sinks().into_iter().map(|(name, _)| name).collect();
        assert_eq!(names, ["BY", "CE", "SR"]);
    }

    #[test]
    fn constants_at_pins_float() {
        assert_eq!([Signal::Constant(true), Signal::Constant(false), Signal::Open].map(inverts), [false, true, false]);
    }

    #[test]
    fn a_pair_shows_at_x() {
        let table = Table { inputs: vec![Net(1), Net(2)], table: 0x8888 };
        let packed = pack::Slice {
            halves: [
                Half { shape: Shape::Wide, shows: Some(Net(4)), ..Half::of(&table, None) },
                Half::of(&table, None),
            ],
            bypass: [Bypass::Select(Signal::of(Net(3)).inverse()), Bypass::Free],
            ..pack::Slice::default()
        };
        let made = slice(&packed);
        assert_eq!((made.x, made.f, made.g, made.invert_bx), (FOutput::F5, 0x8888, 0x8888, true));
    }

    #[test]
    fn a_generate_pin_is_the_first_of_its_table() {
        let table = Table { inputs: vec![Net(1), Net(2)], table: 0x6666 };
        let half = Half { selects: true, ..Half::of(&table, Some(Some(Net(2)))) };
        assert_eq!(half.pins, [Some(Net(2)), Some(Net(1)), None, None]);
        assert_eq!(half.table, 0x6666);
        let free = Half::of(&Table { inputs: vec![Net(1)], table: 0xAAAA }, Some(None));
        assert_eq!((free.pins, free.table), ([None, Some(Net(1)), None, None], 0xCCCC));
        let packed = pack::Slice {
            halves: [half, Half::default()],
            carry: Some(CarryIn::Bypass),
            data: CarryData::Pin,
            bypass: [Bypass::CarryIn(Signal::Constant(false)), Bypass::Free],
            ..pack::Slice::default()
        };
        let made = slice(&packed);
        assert!(made.f_selects_carry && !made.g_selects_carry && made.carry_from_bx && made.invert_bx);
        assert_eq!(made.carry0, Carry0::Input);
    }
}
