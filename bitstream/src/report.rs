//! What a bitstream uses, and how its pads are set.

use crate::configuration::{Attributes, Configuration, FrameError};
use crate::container::packets::{CONTROL, OPTIONS};
use crate::container::{Bitstream, Order};
use crate::device::{Device, PadSite};
use crate::element::{InputBuffer, Io, Pull};
use crate::netlist::{CellKind, MuxRole, Netlist, extract};
use serde::Serialize;
use std::collections::HashSet;

/// Resources of the device (DS001, table 1).
const SLICES: usize = 2_352;
/// Tables and flip-flops.
const TABLES: usize = 4_704;
/// Memories of 4,096 bits.
const BLOCK_RAMS: usize = 14;
/// Three-state buffers of the logic blocks.
const TRI_STATES: usize = 2_352;

/// All that is known of a bitstream.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Report {
    /// What the file says of itself: design, part, date, time.
    pub header: Option<[String; 4]>,
    /// The file has its bits reversed, as PROM programmers want it.
    pub prom_order: bool,
    /// Bytes of the bitstream.
    pub bytes: usize,
    /// Packets with a header of their own.
    pub packets: usize,
    /// CRC words, all right.
    pub crc_checks: usize,
    /// Register COR.
    pub options: u32,
    /// Register CTL.
    pub control: u32,
    /// Bits of the frames that are 1.
    pub ones: usize,
    /// Bits that are 1 and that no attribute explains.
    pub unexplained: usize,
    /// Bits that every file of the vendor's tools has set and this one has not.
    pub absent: usize,
    /// Attributes whose bits stand for nothing, and faults of the circuit.
    pub faults: Vec<String>,
    /// What is used: name, how many, of how many (0 if it has no limit of its own).
    pub used: Vec<(&'static str, usize, usize)>,
    /// Pads that are used.
    pub pads: Vec<PadReport>,
}

/// A pad in use and how it is set.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct PadReport {
    /// Pin of the package.
    pub pin: u8,
    /// `in`, `out`, `in/out` or `clock`.
    pub direction: &'static str,
    /// Output standard with its drive in mA; of inputs what makes a bit of the voltage.
    pub standard: String,
    /// `fast` or `slow`; empty for inputs.
    pub slew: &'static str,
    /// What holds the pad.
    pub pull: &'static str,
    /// Flip-flops in the pad: i(nput), o(utput), t(ri-state); d if the input's has a delay before it.
    pub registers: String,
}

/// A bitstream decoded: its configuration, its circuit if it is one, and the report.
#[derive(Clone, Debug)]
pub struct Decoded {
    /// Every bit.
    pub configuration: Configuration,
    /// The circuit; none if there are faults.
    pub netlist: Option<Netlist>,
    /// What the file uses.
    pub report: Report,
}

impl Decoded {
    /// Decodes a file that was read.
    ///
    /// # Errors
    /// When its frames are not those of the device. Faults of the circuit are in the report.
    pub fn new(device: &Device, file: &Bitstream) -> Result<Self, FrameError> {
        let configuration = Configuration::from_packets(device, &file.packets)?;
        let (unexplained, absent, mut faults) = match Attributes::read(device, &configuration) {
            Ok(attributes) => (attributes.unexplained.len(), attributes.absent.len(), Vec::new()),
            Err(errors) => (0, 0, errors.iter().map(ToString::to_string).collect()),
        };
        let netlist = match extract(device, &configuration) {
            Ok(netlist) => Some(netlist),
            Err(found) => {
                faults.extend(found.iter().map(ToString::to_string));
                None
            }
        };
        let mut seen = HashSet::new();
        faults.retain(|fault: &String| seen.insert(fault.clone()));
        let header = file.header.as_ref();
        let report = Report {
            header: header.map(|h| [h.design.clone(), h.part.clone(), h.date.clone(), h.time.clone()]),
            prom_order: file.order == Order::Prom,
            bytes: file.lanes().len(),
            packets: file.summary.packets,
            crc_checks: file.summary.crc_checks,
            options: file.packets.last(OPTIONS).unwrap_or_default(),
            control: file.packets.last(CONTROL).unwrap_or_default(),
            ones: configuration.ones(),
            unexplained,
            absent,
            faults,
            used: netlist.as_ref().map_or_else(Vec::new, used),
            pads: netlist.as_ref().map_or_else(Vec::new, |netlist| pads(device, netlist)),
        };
        Ok(Self { configuration, netlist, report })
    }
}

fn used(netlist: &Netlist) -> Vec<(&'static str, usize, usize)> {
    let count = |which: &dyn Fn(&CellKind) -> bool| netlist.cells.iter().filter(|cell| which(&cell.kind)).count();
    let slices: HashSet<&str> = netlist
        .cells
        .iter()
        .map(|cell| cell.place.as_str())
        .filter(|place| place.ends_with("_S0") || place.ends_with("_S1"))
        .collect();
    let in_slice = |register: bool| {
        let cells = netlist.cells.iter().filter(|cell| matches!(cell.kind, CellKind::FlipFlop(_)));
        cells.filter(|cell| slices.contains(cell.place.as_str()) == register).count()
    };
    let latches = count(&|kind| matches!(kind, CellKind::FlipFlop(flip_flop) if flip_flop.latch));
    let role = |wanted: MuxRole| count(&|kind| matches!(kind, CellKind::Mux { role, .. } if *role == wanted));
    let buffers = netlist.cells.iter().map(|cell| match &cell.kind {
        CellKind::Bus { drivers, .. } => drivers.len(),
        _ => 0,
    });
    vec![
        ("slices", slices.len(), SLICES),
        ("look-up tables", count(&|kind| matches!(kind, CellKind::Lut { .. })), TABLES),
        ("flip-flops", in_slice(true), TABLES),
        ("of these latches", latches, 0),
        ("flip-flops in pads", in_slice(false), 0),
        ("carry multiplexers", role(MuxRole::Carry), TABLES),
        ("F5 multiplexers", role(MuxRole::F5), SLICES),
        ("F6 multiplexers", role(MuxRole::F6), SLICES / 2),
        ("shift registers", count(&|kind| matches!(kind, CellKind::Shift { .. })), TABLES),
        ("RAMs of 16 bits", count(&|kind| matches!(kind, CellKind::Ram { .. })), TABLES),
        ("three-state buffers", buffers.sum(), TRI_STATES),
        ("block RAMs", count(&|kind| matches!(kind, CellKind::BlockRam(_))), BLOCK_RAMS),
        ("delay-locked loops", count(&|kind| matches!(kind, CellKind::Dll(_))), 4),
        ("global clocks", count(&|kind| matches!(kind, CellKind::ClockBuffer { .. })), 4),
        ("pads", netlist.pads.len(), device_pads()),
    ]
}

fn device_pads() -> usize {
    Device::xc2s200().pads().iter().filter(|pad| !matches!(pad.site, PadSite::Fixed(_))).count()
}

fn pads(device: &Device, netlist: &Netlist) -> Vec<PadReport> {
    let report = |pad: &crate::netlist::PadUse| {
        let direction = match (pad.io, pad.input, pad.output) {
            (None, ..) => "clock",
            (_, Some(_), Some(_)) => "in/out",
            (_, None, Some(_)) => "out",
            _ => "in",
        };
        let standard = |io: &Io| match io.driver.standard(device) {
            Some((standard, _)) if pad.output.is_some() => standard.name.to_owned(),
            None if pad.output.is_some() => format!("{:?}", io.driver),
            _ if io.input == InputBuffer::Cmos => "CMOS".to_owned(),
            _ => "VREF".to_owned(),
        };
        let slew = |io: &Io| match io.driver.standard(device) {
            Some((_, fast)) if pad.output.is_some() => {
                if fast {
                    "fast"
                } else {
                    "slow"
                }
            }
            _ => "",
        };
        let registers = |io: &Io| {
            let place = |name: &str| netlist.nets.iter().any(|net| net == name);
            let mut text = String::new();
            let stem = site_name(device, pad.pin);
            if place(&format!("{stem}_IQ")) {
                text.push_str(if io.delay_register { "id" } else { "i" });
            }
            text.push_str(if io.registered_output && pad.output.is_some() { "o" } else { "" });
            text.push_str(if io.registered_tristate && pad.output.is_some() { "t" } else { "" });
            text
        };
        Some(PadReport {
            pin: pad.pin?,
            direction,
            standard: pad.io.as_ref().map_or_else(|| "CMOS".to_owned(), standard),
            slew: pad.io.as_ref().map_or("", slew),
            pull: pad.io.map_or("", |io| match io.pull {
                Pull::None => "",
                Pull::Up => "up",
                Pull::Down => "down",
                Pull::Keeper => "keeper",
            }),
            registers: pad.io.as_ref().map_or_else(String::new, registers),
        })
    };
    netlist.pads.iter().filter_map(report).collect()
}

/// The name that a pad's nets begin with: `X45Y12_IO2`.
fn site_name(device: &Device, pin: Option<u8>) -> String {
    match pin.and_then(|pin| device.pad(pin)).map(|pad| pad.site) {
        Some(PadSite::Io { tile, index, .. }) => {
            let tile = device.tile(tile);
            format!("X{}Y{}_IO{index}", tile.column, tile.row)
        }
        _ => String::new(),
    }
}
