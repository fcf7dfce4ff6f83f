//! Kinds of tiles: their attributes, switches and basic elements.

use super::database::{Name, RawClass};
use std::collections::HashMap;

/// A bit of a tile: rectangle, frame in it, bit in the frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct TileBit {
    /// Index among the rectangles of the tile's class.
    pub rectangle: u8,
    /// Frame of that rectangle, from its first.
    pub frame: u8,
    /// Which bit from the tile's first.
    pub bit: u8,
}

/// What the bits of an attribute mean.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Coding {
    /// A number, least significant bit first; bits of the mask are stored inverted.
    Number {
        /// For every bit, whether it is stored inverted.
        inverted: Vec<bool>,
    },
    /// One of some choices.
    Choices(Vec<Choice>),
}

/// A choice of an attribute.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Choice {
    /// Its bits, bit 0 of the pattern in the attribute's first.
    pub pattern: u32,
    /// What it is called.
    pub name: &'static str,
}

/// Something that the configuration sets in a tile.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Attribute {
    /// Name: `SLICE[0]:CY0`, or of a switch `MUX.OMUX[0]`, `DRIVE.LH[0]`, `BUFFER.TO.FROM`, `SWITCH.TO.FROM`,
    /// `GATE.ONE.OTHER`.
    pub name: String,
    /// Bits that store it, bit 0 of the number or of a choice's pattern first.
    pub bits: Vec<TileBit>,
    /// What they mean.
    pub coding: Coding,
}

impl Attribute {
    /// Index of the choice called `name` among this attribute's values.
    #[must_use]
    pub fn choice(&self, name: &str) -> Option<usize> {
        match &self.coding {
            Coding::Choices(choices) => choices.iter().position(|choice| choice.name == name),
            Coding::Number { .. } => None,
        }
    }

    /// Choices there are; none if it is a number.
    #[must_use]
    pub fn choices(&self) -> &[Choice] {
        match &self.coding {
            Coding::Choices(choices) => choices,
            Coding::Number { .. } => &[],
        }
    }

    /// Whether it belongs to the interconnect rather than to an element.
    #[must_use]
    pub fn is_routing(&self) -> bool {
        ["MUX.", "DRIVE.", "BUFFER.", "SWITCH.", "GATE."].iter().any(|prefix| self.name.starts_with(prefix))
    }
}

/// How a switch is set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PipKind {
    /// A choice of a multiplexer, which may need its driver switched on.
    Mux {
        /// Index of the attribute that sets the multiplexer.
        attribute: u16,
        /// Index into the attribute's choices.
        choice: u8,
        /// Must be 1 for the multiplexer to drive.
        drive: Option<u16>,
    },
    /// A buffer of one input, one way.
    Buffer {
        /// Attribute whose value 1 turns the buffer on.
        attribute: u16,
    },
    /// A pass transistor used one way: between a driver and a single-length wire.
    Switch {
        /// Attribute whose value 1 turns the buffer on.
        attribute: u16,
    },
    /// A pass transistor that joins two wires, both ways.
    Gate {
        /// Attribute whose value 1 turns the buffer on.
        attribute: u16,
    },
    /// Always on, no bits.
    Joined,
}

/// A switch of a kind of tile, between two wires of the tile's kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ClassPip {
    /// From this wire.
    pub from: u16,
    /// Wire that the switch drives.
    pub to: u16,
    /// How it is set.
    pub kind: PipKind,
}

/// Kind of a basic element.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum BelKind {
    /// Half a logic block: two look-up tables, carry, two flip-flops.
    Slice,
    /// A three-state driver of the buses in a row.
    TriState,
    /// The buses' connection to the interconnect.
    TriStateBus,
    /// An input/output block.
    Io,
    /// 4,096 bits of memory with two ports.
    BlockRam,
    /// A delay-locked loop.
    Dll,
    /// The input of a clock pad.
    ClockPad,
    /// A global clock buffer.
    GlobalBuffer,
    /// Start-up sequencer.
    Startup,
    /// Capture of the flip-flops for readback.
    Capture,
    /// Boundary scan's user registers.
    BoundaryScan,
    /// The fast path from PCI pins to clock enables.
    PciLogic,
}

/// A basic element of a kind of tile.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ClassBel {
    /// Name, as attributes have it before the colon: `SLICE[0]`.
    pub name: &'static str,
    /// Slice, pad, block memory or another.
    pub kind: BelKind,
    /// Which of its kind in the tile.
    pub index: u8,
    /// Where routing ends or begins.
    pub pins: Vec<Pin>,
}

/// A pin of a basic element.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pin {
    /// As the data sheet has it, such as `F1` or `XQ`.
    pub name: &'static str,
    /// It drives its wire.
    pub output: bool,
    /// Its wire, of the tile's kind.
    pub wire: u16,
}

/// A kind of tile.
#[derive(Clone, Debug)]
pub struct TileClass {
    /// As in the data sheet where it has one.
    pub name: &'static str,
    /// Wires that switches and pins touch: cell of the tile and name.
    pub(super) wires: Vec<(u8, Name)>,
    /// What the configuration sets.
    pub attributes: Vec<Attribute>,
    /// Programmable connections between its wires.
    pub pips: Vec<ClassPip>,
    /// Basic elements.
    pub bels: Vec<ClassBel>,
    /// Bits that are 1 in every file of the vendor's tools and belong to no attribute.
    pub ones: Vec<TileBit>,
    /// Names of the rectangles of bits.
    pub(super) rectangles: Vec<&'static str>,
    by_name: HashMap<String, u16>,
}

impl TileClass {
    /// Index of the attribute called `name`; `None` where this class has none.
    #[must_use]
    pub fn attribute(&self, name: &str) -> Option<u16> {
        self.by_name.get(name).copied()
    }

    /// A basic element by its kind and index.
    #[must_use]
    pub fn bel(&self, kind: BelKind, index: u8) -> Option<&ClassBel> {
        self.bels.iter().find(|bel| bel.kind == kind && bel.index == index)
    }

    pub(super) fn read(raw: &RawClass, names: &HashMap<&'static str, Name>) -> Self {
        let class = Self {
            name: raw.name,
            wires: Vec::new(),
            attributes: Vec::new(),
            pips: Vec::new(),
            bels: Vec::new(),
            ones: Vec::new(),
            rectangles: raw.rectangles.clone(),
            by_name: HashMap::new(),
        };
        let mut reader = Reader { class, names, wires: HashMap::new(), cells: raw.cells, drives: HashMap::new() };
        // Drivers first: a multiplexer's switches name the driver that they need.
        for (first, line) in raw.lines.iter().map(|line| (line.words[0] == "drive", line)).filter(|(drive, _)| *drive) {
            debug_assert!(first);
            assert!(reader.line(&line.words).is_some(), "data/xc2s200.txt:{}: not in the notation", line.number);
        }
        for line in raw.lines.iter().filter(|line| line.words[0] != "drive") {
            assert!(reader.line(&line.words).is_some(), "data/xc2s200.txt:{}: not in the notation", line.number);
        }
        let mut class = reader.class;
        class.by_name =
            class.attributes.iter().enumerate().map(|(n, attribute)| (attribute.name.clone(), n as u16)).collect();
        class
    }
}

struct Reader<'a> {
    class: TileClass,
    names: &'a HashMap<&'static str, Name>,
    wires: HashMap<(u8, Name), u16>,
    cells: usize,
    drives: HashMap<u16, u16>,
}

impl Reader<'_> {
    fn line(&mut self, words: &[&'static str]) -> Option<()> {
        match words[0] {
            "ones" => self.class.ones = bits(&words[1..])?,
            "bel" => {
                let (kind, index) = bel_kind(words[1])?;
                self.class.bels.push(ClassBel { name: words[1], kind, index, pins: Vec::new() });
            }
            "in" | "out" => {
                let pin = Pin { name: words[1], output: words[0] == "out", wire: self.wire(words[2])? };
                self.class.bels.last_mut()?.pins.push(pin);
            }
            "value" => {
                self.number(words[1].to_owned(), words[2], &words[3..])?;
            }
            "choice" => {
                self.choices(words[1].to_owned(), &words[2..])?;
            }
            "drive" => {
                let to = self.wire(words[1])?;
                let attribute = self.number(format!("DRIVE.{}", words[1]), words[2], &words[3..])?;
                self.drives.insert(to, attribute);
            }
            "mux" => {
                let to = self.wire(words[1])?;
                let attribute = self.choices(format!("MUX.{}", words[1]), &words[2..])?;
                let drive = self.drives.get(&to).copied();
                let choices: Vec<&'static str> =
                    self.class.attributes[usize::from(attribute)].choices().iter().map(|choice| choice.name).collect();
                for (choice, name) in choices.into_iter().enumerate().filter(|(_, name)| *name != "NONE") {
                    let kind = PipKind::Mux { attribute, choice: u8::try_from(choice).ok()?, drive };
                    let from = self.wire(name)?;
                    self.class.pips.push(ClassPip { from, to, kind });
                }
            }
            "buffer" | "switch" | "gate" => {
                let (to, from) = (self.wire(words[1])?, self.wire(words[2])?);
                let name = format!("{}.{}.{}", words[0].to_uppercase(), words[1], words[2]);
                let attribute = self.number(name, words[3], &words[4..])?;
                let kind = match words[0] {
                    "buffer" => PipKind::Buffer { attribute },
                    "switch" => PipKind::Switch { attribute },
                    _ => PipKind::Gate { attribute },
                };
                self.class.pips.push(ClassPip { from, to, kind });
            }
            "joined" => {
                let (to, from) = (self.wire(words[1])?, self.wire(words[2])?);
                self.class.pips.push(ClassPip { from, to, kind: PipKind::Joined });
            }
            _ => return None,
        }
        Some(())
    }

    fn wire(&mut self, word: &str) -> Option<u16> {
        let (cell, name) = if self.cells > 1 {
            let (cell, name) = word.split_once('.')?;
            (cell.parse().ok()?, name)
        } else {
            (0, word)
        };
        let key = (cell, *self.names.get(name)?);
        let next = self.class.wires.len() as u16;
        let wire = *self.wires.entry(key).or_insert(next);
        if wire == next {
            self.class.wires.push(key);
        }
        Some(wire)
    }

    fn push(&mut self, name: String, bits: Vec<TileBit>, coding: Coding) -> u16 {
        self.class.attributes.push(Attribute { name, bits, coding });
        (self.class.attributes.len() - 1) as u16
    }

    fn number(&mut self, name: String, inverted: &str, words: &[&str]) -> Option<u16> {
        let inverted: Vec<bool> = inverted.bytes().map(|byte| byte == b'1').collect();
        let bits = bits(words)?;
        (inverted.len() == bits.len()).then(|| self.push(name, bits, Coding::Number { inverted }))
    }

    fn choices(&mut self, name: String, words: &[&'static str]) -> Option<u16> {
        let colon = words.iter().position(|word| *word == ":")?;
        let bits = bits(&words[..colon])?;
        let choice = |word: &&'static str| {
            let (pattern, name) = word.split_once('=')?;
            let value = pattern.bytes().enumerate().fold(0, |value, (n, bit)| value | u32::from(bit == b'1') << n);
            (pattern.len() == bits.len()).then_some(Choice { pattern: value, name })
        };
        let choices = words[colon + 1..].iter().map(choice).collect::<Option<Vec<_>>>()?;
        Some(self.push(name, bits, Coding::Choices(choices)))
    }
}

fn bits(words: &[&str]) -> Option<Vec<TileBit>> {
    let bit = |word: &&str| {
        let mut parts = word.split('.').map(|part| part.parse::<u8>().ok());
        Some(TileBit { rectangle: parts.next()??, frame: parts.next()??, bit: parts.next()?? })
    };
    words.iter().map(bit).collect()
}

fn bel_kind(name: &str) -> Option<(BelKind, u8)> {
    let (stem, index) = match name.split_once('[') {
        Some((stem, index)) => (stem, index.strip_suffix(']')?.parse().ok()?),
        None => (name, 0),
    };
    let kind = match stem {
        "SLICE" => BelKind::Slice,
        "TBUF" => BelKind::TriState,
        "TBUS" => BelKind::TriStateBus,
        "IO" => BelKind::Io,
        "BRAM" => BelKind::BlockRam,
        "DLL" => BelKind::Dll,
        "GCLK_IO" => BelKind::ClockPad,
        "BUFG" => BelKind::GlobalBuffer,
        "STARTUP" => BelKind::Startup,
        "CAPTURE" => BelKind::Capture,
        "BSCAN" => BelKind::BoundaryScan,
        "PCILOGIC" => BelKind::PciLogic,
        _ => return None,
    };
    Some((kind, index))
}
