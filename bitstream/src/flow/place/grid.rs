//! Sites, and what stands on them.

use crate::flow::FlowError;
use crate::flow::pack::Packed;

/// Columns of logic.
pub(super) const COLUMNS: std::ops::RangeInclusive<u8> = 2..=43;
/// Rows of logic.
pub(super) const ROWS: u8 = 28;

/// Tiles of block memories: column and lowest row, those in the middle first.
pub const MEMORY_SITES: [(u8, u8); 14] = [
    (44, 13),
    (1, 13),
    (44, 17),
    (1, 17),
    (44, 9),
    (1, 9),
    (44, 21),
    (1, 21),
    (44, 5),
    (1, 5),
    (44, 25),
    (1, 25),
    (44, 1),
    (1, 1),
];

/// A slice of the device.
#[derive(Clone, Copy, Debug, Default, Eq, Ord, PartialEq, PartialOrd)]
pub struct Site {
    /// Column, 2 to 43.
    pub column: u8,
    /// Which slice of the block, 0 or 1.
    pub slice: u8,
    /// Row, 1 to 28.
    pub row: u8,
}

impl Site {
    fn index(self) -> usize {
        (usize::from(self.column - 2) * 2 + usize::from(self.slice)) * usize::from(ROWS) + usize::from(self.row - 1)
    }
}

/// Who stands where.
#[derive(Clone, Debug)]
pub(super) struct Grid {
    tenants: Vec<u32>,
}

/// Mark of a site without a part.
pub(super) const FREE: u32 = u32::MAX;

impl Grid {
    pub(super) fn new() -> Self {
        Self { tenants: vec![FREE; super::super::SLICES] }
    }

    pub(super) fn tenant(&self, site: Site) -> u32 {
        self.tenants[site.index()]
    }

    pub(super) fn set(&mut self, site: Site, tenant: u32) {
        let index = site.index();
        self.tenants[index] = tenant;
    }

    /// Sites from one up.
    pub(super) fn run(site: Site, height: usize) -> impl Iterator<Item = Site> {
        (0..height as u8).map(move |up| Site { row: site.row + up, ..site })
    }
}

/// A first placement: tall columns first, from the middle outwards; then single slices.
pub(super) fn first(packed: &Packed) -> Result<Vec<Site>, FlowError> {
    let mut order: Vec<usize> = (0..packed.columns.len()).collect();
    order.sort_by_key(|column| (std::cmp::Reverse(packed.columns[*column].slices.len()), *column));
    let mut grid = Grid::new();
    let mut sites = vec![Site::default(); packed.columns.len()];
    let mut ground: Vec<Site> =
        COLUMNS.flat_map(|column| (0..2).map(move |slice| Site { column, slice, row: 1 })).collect();
    ground.sort_by_key(|site| (site.column.abs_diff(22), *site));
    let starts: Vec<Site> = ground.iter().flat_map(|site| (1..=ROWS).map(move |row| Site { row, ..*site })).collect();
    for column in order {
        let height = packed.columns[column].slices.len();
        let fits = |site: &Site| {
            usize::from(site.row) + height <= usize::from(ROWS) + 1
                && Grid::run(*site, height).all(|site| grid.tenant(site) == FREE)
        };
        let Some(site) = starts.iter().copied().find(fits) else {
            let (used, there) = (packed.slices().count(), super::super::SLICES);
            return Err(FlowError::Full { what: "slices in columns", used, there });
        };
        Grid::run(site, height).for_each(|site| grid.set(site, column as u32));
        sites[column] = site;
    }
    Ok(sites)
}
