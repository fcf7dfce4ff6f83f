//! Wires: one for each piece of metal, whatever cells it runs through.
//!
//! A cell names its wires the same as every other cell; a wire that leaves a cell has another name in its
//! neighbour. A wire of the device is the one at whose cell it begins, so `SINGLE_W[3]` of a cell is the
//! `SINGLE_E[3]` of the cell west of it.

use super::database::{Database, Joins, Name, Side};
use super::{Device, WireFamily, WireId};

/// No wire: the ends of the block RAM buses lead nowhere.
const NOWHERE: u32 = u32::MAX;
/// Not looked up yet.
const UNKNOWN: u32 = u32::MAX - 1;

/// Where a wire begins, how far it reaches and what it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Wire {
    /// Column of the cell at which it begins.
    pub column: u8,
    /// Row of the cell at which it begins.
    pub row: u8,
    pub(super) name: Name,
    /// How far it goes and how it is driven.
    pub family: WireFamily,
    /// First and last column at which it can be reached.
    pub columns: (u8, u8),
    /// First and last row at which it can be reached.
    pub rows: (u8, u8),
}

/// Looks wires up while tiles are placed.
pub(super) struct Wiring<'a> {
    database: &'a Database,
    /// For every cell and name, the wire.
    ids: Vec<u32>,
    pub(super) wires: Vec<Wire>,
    families: Vec<WireFamily>,
}

impl<'a> Wiring<'a> {
    pub(super) fn new(database: &'a Database) -> Self {
        let cells = usize::from(database.grid.0) * usize::from(database.grid.1);
        let families = database.wires.iter().map(|(name, _)| WireFamily::of(name)).collect();
        Self { database, ids: vec![UNKNOWN; cells * database.wires.len()], wires: Vec::new(), families }
    }

    /// The wire that a cell has under a name.
    pub(super) fn find(&mut self, cell: (u8, u8), name: Name) -> Option<WireId> {
        let key = self.key(cell, name);
        if self.ids[key] == UNKNOWN {
            self.ids[key] = match self.root(cell, name) {
                None => NOWHERE,
                Some((root, root_name)) => {
                    let root_key = self.key(root, root_name);
                    if self.ids[root_key] == UNKNOWN {
                        self.ids[root_key] = self.wires.len() as u32;
                        self.wires.push(Wire {
                            column: root.0,
                            row: root.1,
                            name: root_name,
                            family: self.families[usize::from(root_name)],
                            columns: (root.0, root.0),
                            rows: (root.1, root.1),
                        });
                    }
                    self.ids[root_key]
                }
            };
        }
        let id = self.ids[key];
        let wire = self.wires.get_mut(id as usize)?;
        wire.columns = (wire.columns.0.min(cell.0), wire.columns.1.max(cell.0));
        wire.rows = (wire.rows.0.min(cell.1), wire.rows.1.max(cell.1));
        Some(WireId(id))
    }

    pub(super) fn into_parts(self) -> (Vec<Wire>, Vec<u32>) {
        (self.wires, self.ids)
    }

    fn key(&self, (column, row): (u8, u8), name: Name) -> usize {
        let cell = usize::from(column) * usize::from(self.database.grid.1) + usize::from(row);
        cell * self.database.wires.len() + usize::from(name)
    }

    /// Follows a wire to the cell at which it begins.
    fn root(&self, mut cell: (u8, u8), mut name: Name) -> Option<((u8, u8), Name)> {
        let database = self.database;
        loop {
            match database.wires[usize::from(name)].1 {
                Joins::Root => break,
                Joins::Leaf => return Some((leaf(database, cell), name)),
                Joins::PciEnable => return Some(((cell.0, database.clock_row), name)),
                Joins::Device => return Some(((database.grid.0 / 2, database.clock_row), name)),
                Joins::Neighbour(side) => {
                    let passed = database.passes[side as usize].get(&name);
                    let (Some(next), Some(passed)) = (neighbour(database, cell, side), passed) else { break };
                    (cell, name) = (next, *passed);
                }
            }
        }
        // The north end of a block RAM column has no memory, so its buses end one tile below.
        let last_row = database.grid.1 - 1;
        let dead = database.block_ram.contains(&cell.0)
            && cell.1 == last_row
            && database.wires[usize::from(name)].0.starts_with("BRAM_QUAD");
        (!dead).then_some((cell, name))
    }
}

/// The next cell on a side. Rows run across the block RAM columns; those have a tile every four rows.
fn neighbour(database: &Database, (column, row): (u8, u8), side: Side) -> Option<(u8, u8)> {
    let (last_column, last_row) = (database.grid.0 - 1, database.grid.1 - 1);
    let memory = database.block_ram.contains(&column);
    Some(match side {
        Side::North | Side::South if memory => {
            let stops: Vec<u8> = (0..=last_row).filter(|row| *row == 0 || *row == last_row || row % 4 == 1).collect();
            let at = stops.iter().position(|stop| *stop == row)?;
            let next = if side == Side::North { at.checked_add(1)? } else { at.checked_sub(1)? };
            (column, *stops.get(next)?)
        }
        Side::North => (column, (row < last_row).then(|| row + 1)?),
        Side::South => (column, row.checked_sub(1)?),
        Side::West | Side::East if memory => return None,
        Side::West => ((0..column).rev().find(|column| !database.block_ram.contains(column))?, row),
        Side::East => ((column + 1..=last_column).find(|column| !database.block_ram.contains(column))?, row),
    })
}

/// The cell whose clock leaf a cell hangs on.
fn leaf(database: &Database, (column, row): (u8, u8)) -> (u8, u8) {
    let Some((centre, ..)) =
        database.clock_columns.iter().find(|(_, first, end)| (*first..*end).contains(&column)).copied()
    else {
        return (column, row);
    };
    let memory = database.block_ram.contains(&centre);
    let end_row = row == 0 || row == database.grid.1 - 1;
    if column < centre {
        (centre - 1, row)
    } else if !memory || end_row {
        (centre, row)
    } else if column > centre {
        (centre + 1, row)
    } else {
        (centre, database.clock_row)
    }
}

impl Device {
    /// The wire that a cell has under a name, if any switch or pin touches it.
    #[must_use]
    pub fn wire_at(&self, column: u8, row: u8, name: &str) -> Option<WireId> {
        let name = usize::from(*self.names.get(name)?);
        if column >= self.grid.0 || row >= self.grid.1 {
            return None;
        }
        let cell = usize::from(column) * usize::from(self.grid.1) + usize::from(row);
        let id = self.ids[cell * self.wire_names.len() + name];
        ((id as usize) < self.wires.len()).then_some(WireId(id))
    }

    /// What a number stands for.
    #[must_use]
    pub fn wire(&self, wire: WireId) -> &Wire {
        &self.wires[wire.0 as usize]
    }

    /// Name of a wire in the cell at which it begins.
    #[must_use]
    pub fn wire_name(&self, wire: WireId) -> &'static str {
        self.wire_names[usize::from(self.wire(wire).name)]
    }

    /// A wire for messages: `X12Y3.OMUX[4]`.
    #[must_use]
    pub fn describe_wire(&self, wire: WireId) -> String {
        let found = self.wire(wire);
        format!("X{}Y{}.{}", found.column, found.row, self.wire_name(wire))
    }
}
