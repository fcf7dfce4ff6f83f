//! The committed table of the device, read into raw lists.
//!
//! `data/xc2s200.txt` explains its own notation at its head. It is part of this crate, so a fault in it is a
//! fault of the program: reading stops with the line's number.

use std::collections::HashMap;

/// The table, as text.
const TABLE: &str = include_str!("../../data/xc2s200.txt");

/// Index of a wire's name.
pub(super) type Name = u16;

/// How a wire of a cell joins the wires of other cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Joins {
    /// It begins here.
    Root,
    /// It is a wire of the neighbour on a side, if there is one.
    Neighbour(Side),
    /// It is the clock leaf of a region.
    Leaf,
    /// One for each half row of the clock row.
    PciEnable,
    /// One for the whole device.
    Device,
}

/// Side of a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Side {
    /// Towards column 0.
    West,
    /// Towards the last column.
    East,
    /// Towards row 0.
    South,
    /// Towards the last row.
    North,
}

/// A line of a class, before names are resolved: its words, and its number for messages.
#[derive(Clone, Debug)]
pub(super) struct Line {
    /// Number in the table, from 1.
    pub(super) number: usize,
    /// What stands between its spaces.
    pub(super) words: Vec<&'static str>,
}

/// A kind of tile.
#[derive(Clone, Debug)]
pub(super) struct RawClass {
    pub(super) name: &'static str,
    /// Cells of a tile.
    pub(super) cells: usize,
    /// Names of its rectangles of bits.
    pub(super) rectangles: Vec<&'static str>,
    /// Lines of the class, in the order of the file.
    pub(super) lines: Vec<Line>,
}

/// A place of the grid as the database's JSON has it.
#[derive(Clone, Debug)]
pub(super) struct RawTile {
    /// Index of its class.
    pub(super) class: usize,
    /// Its place.
    pub(super) at: (u8, u8),
    /// Places of its cells.
    pub(super) cells: Vec<(u8, u8)>,
}

/// The whole table.
#[derive(Debug, Default)]
pub(super) struct Database {
    /// Columns and rows.
    pub(super) grid: (u8, u8),
    /// Columns of block RAM.
    pub(super) block_ram: Vec<u8>,
    /// Row of the clock's root.
    pub(super) clock_row: u8,
    /// Centre, first and end of the columns that hang on a column of clock buffers.
    pub(super) clock_columns: Vec<(u8, u8, u8)>,
    /// Pin and what is bonded to it.
    pub(super) pads: Vec<(&'static str, &'static str)>,
    /// Parameter, standard, bits.
    pub(super) standards: Vec<(&'static str, &'static str, u8)>,
    /// Names of wires and how they join.
    pub(super) wires: Vec<(&'static str, Joins)>,
    /// Index of every name.
    pub(super) names: HashMap<&'static str, Name>,
    /// For every side, the wire of the neighbour that a wire is.
    pub(super) passes: [HashMap<Name, Name>; 4],
    /// Kinds of tiles.
    pub(super) classes: Vec<RawClass>,
    /// Row by row, as the database lists them.
    pub(super) tiles: Vec<RawTile>,
}

impl Database {
    /// Reads the table.
    ///
    /// # Panics
    /// When the table that is part of this crate does not follow its own notation.
    pub(super) fn read() -> Self {
        let mut database = Self::default();
        for (at, line) in TABLE.lines().enumerate() {
            if !line.starts_with('#') && !line.is_empty() {
                let words = line.split(' ').collect();
                let line = Line { number: at + 1, words };
                assert!(database.line(&line).is_some(), "data/xc2s200.txt:{}: not in the notation", at + 1);
            }
        }
        database
    }

    fn line(&mut self, line: &Line) -> Option<()> {
        let words = &line.words;
        let word = |n: usize| words.get(n).copied();
        let number = |n: usize| word(n)?.parse::<u8>().ok();
        match words[0] {
            "grid" => self.grid = (number(1)?, number(2)?),
            "block_ram" => self.block_ram = (1..words.len()).map(number).collect::<Option<_>>()?,
            "clock_row" => self.clock_row = number(1)?,
            "clock_column" => self.clock_columns.push((number(1)?, number(2)?, number(3)?)),
            "pad" => self.pads.push((word(1)?, word(2)?)),
            "standard" => {
                let bits = u8::from_str_radix(word(3)?, 2).ok()?;
                self.standards.push((word(1)?, word(2)?, bits));
            }
            "wire" => {
                let joins = match (word(2)?, word(3)) {
                    ("mux" | "bel" | "multi_root", None) => Joins::Root,
                    ("multi_branch" | "branch", Some(side)) => Joins::Neighbour(Side::read(side)?),
                    ("regional", Some("LEAF")) => Joins::Leaf,
                    ("regional", Some("PCI_CE")) => Joins::PciEnable,
                    ("regional", Some("ROOT")) => Joins::Device,
                    _ => return None,
                };
                self.names.insert(word(1)?, Name::try_from(self.wires.len()).ok()?);
                self.wires.push((word(1)?, joins));
            }
            "pass" => {
                let (from, to) = (*self.names.get(word(2)?)?, *self.names.get(word(3)?)?);
                self.passes[Side::read(word(1)?)? as usize].insert(from, to);
            }
            "class" => self.classes.push(RawClass {
                name: word(1)?,
                cells: number(2)?.into(),
                rectangles: words[3..].to_vec(),
                lines: Vec::new(),
            }),
            "tile" => {
                let at = (number(2)?, number(3)?);
                let class = self.classes.iter().position(|class| class.name == words[1])?;
                let cells = if words.len() == 4 {
                    vec![at]
                } else {
                    let place = |word: &str| {
                        let (column, row) = word.split_once(',')?;
                        Some((column.parse().ok()?, row.parse().ok()?))
                    };
                    words[4..].iter().copied().map(place).collect::<Option<_>>()?
                };
                self.tiles.push(RawTile { class, at, cells });
            }
            _ => self.classes.last_mut()?.lines.push(line.clone()),
        }
        Some(())
    }
}

impl Side {
    fn read(word: &str) -> Option<Self> {
        Some(match word {
            "W" => Self::West,
            "E" => Self::East,
            "S" => Self::South,
            "N" => Self::North,
            _ => return None,
        })
    }
}
