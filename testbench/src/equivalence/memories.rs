//! Which block memories are a memory of the text, and whether they hold it.
//!
//! A block (data sheet DS001-2, "Block RAM"): 4,096 bits; word `a` of a port of `w` bits is bits `a·w` .. `a·w + w`, and bit
//! `i` of the data pins is bit `a·w + i`. At a rising clock with EN: with WE it stores DI, and its own output shows DI; else the
//! output takes the word; with RST the output becomes 0. After configuration contents are INIT and the outputs 0. What a
//! port reads of bits that the other port writes at the same edge is not defined.
//!
//! Here is decided what the pins of these blocks must be joined to ([`Lane`]) and, for every address and bit by itself, that
//! with such pins the blocks are the memory. That they are joined so, the proof of all functions shows.

use super::json::Cell;
use bitstream::flow::netlist::{Memory, MemoryPort, Net, Netlist, Signal};
use std::collections::BTreeSet;
use std::ops::Range;

/// Bits of a block.
const BITS: usize = 4_096;

/// A memory of the text: words, width, start value.
pub(super) struct Wanted {
    pub(super) words: usize,
    pub(super) width: usize,
    pub(super) address: usize,
    pub(super) writes: bool,
    /// Bits, the lowest word first; `None` where the text says none.
    start: Vec<Option<bool>>,
}

/// A block that holds some bits of every word.
pub(super) struct Lane<'a> {
    pub(super) memory: &'a Memory,
    pub(super) bits: Range<usize>,
    pub(super) reader: &'a MemoryPort,
    /// None for a memory that is only read.
    pub(super) writer: Option<&'a MemoryPort>,
}

fn binary(text: &str) -> Option<usize> {
    usize::from_str_radix(text, 2).ok()
}

impl Wanted {
    /// Reads a `$mem_v2` of one synchronous read port without enable or reset, and at most one write port.
    pub(super) fn of(cell: &Cell) -> Result<Self, String> {
        let parameter = |name: &str| cell.parameters.get(name).map_or("", String::as_str);
        let number = |name: &str| binary(parameter(name)).ok_or_else(|| format!("no {name}"));
        let pin = |name: &str| cell.connections.get(name).map_or(&[][..], Vec::as_slice);
        let constant = |name: &str, value: &str| {
            pin(name).iter().all(|bit| matches!(bit, super::json::Bit::Constant(text) if text == value))
        };
        let (words, width, writers) = (number("SIZE")?, number("WIDTH")?, number("WR_PORTS")?);
        let plain = number("RD_PORTS")? == 1 && writers <= 1 && number("OFFSET")? == 0;
        let clocked = number("RD_CLK_ENABLE")? == 1 && number("RD_CLK_POLARITY")? == 1;
        let clocked = clocked && (writers == 0 || number("WR_CLK_ENABLE")? == 1 && number("WR_CLK_POLARITY")? == 1);
        let free = constant("RD_EN", "1") && constant("RD_SRST", "0") && constant("RD_ARST", "0");
        if !(plain && clocked && free && number("RD_TRANSPARENCY_MASK")? == 0) {
            return Err("this proof knows one read port with a clock and no more, and one write port".into());
        }
        // The output of a block begins at 0.
        if parameter("RD_INIT_VALUE").contains('1') {
            return Err("an output that does not begin at 0".into());
        }
        let start = parameter("INIT").bytes().rev();
        let mut start: Vec<_> = start.map(|bit| (bit != b'x').then_some(bit == b'1')).collect();
        start.resize(words * width, None);
        Ok(Self { words, width, address: number("ABITS")?, writes: writers == 1, start })
    }

    /// Whether blocks with such pins are this memory; bits of start values compared, or what is wrong.
    fn held(&self, lanes: &[Lane<'_>]) -> Result<usize, String> {
        let mut said = 0;
        for lane in lanes {
            let mut taken: BTreeSet<usize> = BTreeSet::new();
            for word in 0..self.words {
                for (pin, bit) in lane.bits.clone().enumerate() {
                    let place = |port: &MemoryPort| word * port.width + pin;
                    let read = place(lane.reader);
                    if lane.writer.is_some_and(|writer| place(writer) != read) {
                        return Err(format!("word {word} bit {bit} is written elsewhere than it is read"));
                    }
                    if read >= BITS || !taken.insert(read) {
                        return Err(format!("word {word} bit {bit} has no place of its own"));
                    }
                    let holds = lane.memory.contents[read / 64] >> (read % 64) & 1 == 1;
                    match self.start[word * self.width + bit] {
                        Some(start) if start != holds => {
                            return Err(format!("word {word} bit {bit} begins as {}", u8::from(holds)));
                        }
                        start => said += usize::from(start.is_some()),
                    }
                }
            }
        }
        Ok(said)
    }
}

/// The blocks of a memory, by the names that synthesis gives them (`name.0.lane`), with what their pins must be, and how
/// many bits of start values are the same.
pub(super) fn lanes<'a>(name: &str, wanted: &Wanted, netlist: &'a Netlist) -> Result<(Vec<Lane<'a>>, usize), String> {
    let mut named: Vec<(usize, &Memory)> = netlist
        .memories
        .iter()
        .filter_map(|memory| Some((memory.name.strip_prefix(name)?.strip_prefix(".0.")?.parse().ok()?, memory)))
        .collect();
    named.sort_by_key(|(lane, _)| *lane);
    let mut next = 0;
    let mut lanes = Vec::new();
    for (_, memory) in named {
        let lane = lane(memory, next, wanted).map_err(|what| format!("{}: {what}", memory.name))?;
        next = lane.bits.end;
        lanes.push(lane);
    }
    if next != wanted.width {
        return Err(format!("{name}: blocks for {next} of {} bits", wanted.width));
    }
    let said = wanted.held(&lanes).map_err(|what| format!("{name}: {what}"))?;
    Ok((lanes, said))
}

fn lane<'a>(memory: &'a Memory, first: usize, wanted: &Wanted) -> Result<Lane<'a>, String> {
    let ports: Vec<&MemoryPort> = memory.ports.iter().flatten().collect();
    if ports.iter().any(|port| port.enable != Signal::Constant(true) || port.reset != Signal::Constant(false)) {
        return Err("a port that is not always enabled, or has a reset".into());
    }
    let never = |port: &MemoryPort| port.write == Signal::Constant(false);
    let (reader, writer) = match ports[..] {
        [port] => (port, wanted.writes.then_some(port)),
        // The writing port's own output shows what it writes: it must not be the one that is read.
        [one, other] if wanted.writes => match (never(one), never(other)) {
            (true, false) => (one, Some(other)),
            (false, true) => (other, Some(one)),
            _ => return Err("no port that only reads beside one that writes".into()),
        },
        _ => return Err("two ports for a memory that is only read".into()),
    };
    if writer.is_some_and(|writer| writer.clock != reader.clock) {
        return Err("two clocks".into());
    }
    if !wanted.writes && !never(reader) {
        return Err("a memory that is only read is written".into());
    }
    for port in ports {
        let beyond = |pin: &Signal| *pin != Signal::Constant(false);
        if port.address.len() < wanted.address || port.address.iter().skip(wanted.address).any(beyond) {
            return Err("address pins that the memory does not have are not 0".into());
        }
    }
    // A block may be wider than what is left. Its other outputs are any value to the circuit.
    let bits = first..wanted.width.min(first + reader.width);
    if bits.is_empty() {
        return Err("nothing is left of the memory".into());
    }
    Ok(Lane { memory, bits, reader, writer })
}

impl Lane<'_> {
    /// The nets of its output that are bits of the memory, lowest bit first.
    pub(super) fn outputs(&self) -> impl Iterator<Item = Option<Net>> {
        self.reader.output.iter().copied().take(self.bits.len())
    }
}
