//! Frames: the columns of bits in which the device is configured.
//!
//! | block | columns | frames each | frames |
//! |---|---|---|---|
//! | 0 | centre, with the clock buffers | 8 | 0..8 |
//! | 0 | logic X2..X43, from the centre outwards, right then left | 48 | 8..2024 |
//! | 0 | inputs and outputs X45, then X0 | 54 | 2024..2132 |
//! | 0 | interconnect of block RAM X44, then X1 | 27 | 2132..2186 |
//! | 1 | contents of block RAM X1, then X44 | 64 | 2186..2314 |
//!
//! A frame has 540 bits, 18 a row, row 0 (south) first. Order and sizes: Xilinx application note 151 (XAPP151),
//! checked on 22 files of the vendor's tools: every bit of theirs lies where it says.

use super::Device;

/// Frames of the device.
pub const FRAMES: usize = 2_314;
/// Bits of a frame that configure something.
pub const FRAME_BITS: usize = 540;
/// Bits of a frame for one row of tiles.
pub const ROW_BITS: u16 = 18;
/// First frame of the contents of block RAM.
pub const FIRST_CONTENT_FRAME: usize = 2_186;
/// Frames of a block RAM column's contents.
pub const CONTENT_FRAMES: usize = 64;

/// Frames of the centre column.
const CENTRE_FRAMES: u16 = 8;
/// Frames of a column of logic.
const LOGIC_FRAMES: u16 = 48;
/// Frames of a column of inputs and outputs.
const SIDE_FRAMES: u16 = 54;
/// Frames of the interconnect of a block RAM column.
const INTERCONNECT_FRAMES: u16 = 27;
/// Frame of the centre column that has the clock buffers of the rows.
const CLOCK_BUFFER_FRAME: u16 = 7;

/// A place among the frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Bit {
    /// Which frame, 0..2314.
    pub frame: u16,
    /// Which bit of it, 0..540.
    pub bit: u16,
}

/// A frame's address as the register FAR has it: block in bits 26:25, major in 24:17, minor in 16:9.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct FrameAddress(pub u32);

impl FrameAddress {
    /// The address of a frame of a column.
    #[must_use]
    pub fn new(block: u32, major: u32, minor: u32) -> Self {
        Self(block << 25 | major << 17 | minor << 9)
    }
}

/// A column of the device as the frames see it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrameColumn {
    /// Block, 0 or 1.
    pub block: u8,
    /// Major address, as FAR takes it.
    pub major: u8,
    /// Column of the grid; none for the centre.
    pub column: Option<u8>,
    /// Number of its first frame, 0..2314.
    pub first: u16,
    /// Number of its frames, which differ by their minor address.
    pub frames: u16,
}

/// All columns in the order of their frames.
pub(super) fn columns(grid: (u8, u8), block_ram: &[u8]) -> Vec<FrameColumn> {
    let (centre, last) = (grid.0 / 2, grid.0 - 1);
    let mut columns: Vec<FrameColumn> = Vec::new();
    let mut push = |block, column: Option<u8>, frames| {
        let before = columns.last().copied();
        let first = before.map_or(0, |before| before.first + before.frames);
        let major = before.filter(|before| before.block == block).map_or(0, |before| before.major + 1);
        columns.push(FrameColumn { block, major, column, first, frames });
    };
    let outwards = |right_first: bool| {
        (0..centre).flat_map(move |dx| {
            let (right, left) = (centre + dx, centre - 1 - dx);
            if right_first { [right, left] } else { [left, right] }
        })
    };
    push(0, None, CENTRE_FRAMES);
    for column in outwards(true).filter(|column| !block_ram.contains(column)) {
        push(0, Some(column), if column == 0 || column == last { SIDE_FRAMES } else { LOGIC_FRAMES });
    }
    for column in outwards(true).filter(|column| block_ram.contains(column)) {
        push(0, Some(column), INTERCONNECT_FRAMES);
    }
    for column in outwards(false).filter(|column| block_ram.contains(column)) {
        push(1, Some(column), CONTENT_FRAMES as u16);
    }
    columns
}

/// Where a rectangle of bits begins, for a tile with these cells.
pub(super) fn rectangle(columns: &[FrameColumn], rectangle: &str, at: (u8, u8), cells: &[(u8, u8)]) -> Bit {
    let first = |block: u8, column: Option<u8>| {
        let found = columns.iter().find(|candidate| candidate.block == block && candidate.column == column);
        found.map_or(0, |found| found.first)
    };
    let row = |row: u8| u16::from(row) * ROW_BITS;
    let cell = |n: usize| cells.get(n).copied().unwrap_or(at);
    match rectangle {
        "DATA" => Bit { frame: first(1, Some(at.0)), bit: row(at.1) },
        "CLK[0]" => Bit { frame: first(0, None), bit: row(at.1) },
        // The second row of the centre column's ends: towards the middle.
        "CLK[1]" => Bit { frame: first(0, None), bit: row(if at.1 == 0 { 1 } else { at.1 - 1 }) },
        "CLKV" => Bit { frame: first(0, None) + CLOCK_BUFFER_FRAME, bit: row(at.1) },
        _ => {
            let n = rectangle.strip_prefix("MAIN[").and_then(|rest| rest.strip_suffix(']'));
            let place = cell(n.and_then(|n| n.parse().ok()).unwrap_or(0));
            Bit { frame: first(0, Some(place.0)), bit: row(place.1) }
        }
    }
}

impl Device {
    /// Columns in the order of their frames.
    #[must_use]
    pub fn frame_columns(&self) -> &[FrameColumn] {
        &self.columns
    }

    /// Block, major and minor as the register FAR takes them.
    #[must_use]
    pub fn frame_address(&self, frame: u16) -> Option<FrameAddress> {
        let column =
            self.columns.iter().find(|column| (column.first..column.first + column.frames).contains(&frame))?;
        Some(FrameAddress::new(column.block.into(), column.major.into(), (frame - column.first).into()))
    }

    /// Number of the frame at an address, 0..2314; `None` where the device has none.
    #[must_use]
    pub fn frame_at(&self, address: FrameAddress) -> Option<u16> {
        let column = self
            .columns
            .iter()
            .find(|column| FrameAddress::new(column.block.into(), column.major.into(), 0).0 == address.0 & !0x1_FFFF)?;
        let minor = address.0 >> 9 & 0xFF;
        (minor < column.frames.into() && address.0 & 0x1FF == 0).then(|| column.first + minor as u16)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_have_the_sizes_of_the_table() {
        let device = Device::xc2s200();
        let last = device.frame_columns().last().expect("columns");
        assert_eq!(usize::from(last.first + last.frames), FRAMES);
        let content = device.frame_columns().iter().find(|column| column.block == 1).expect("contents");
        assert_eq!((usize::from(content.first), content.column), (FIRST_CONTENT_FRAME, Some(1)));
        assert_eq!(device.frame_address(8), Some(FrameAddress::new(0, 1, 0)));
    }

    #[test]
    fn every_frame_is_found_at_its_address() {
        let device = Device::xc2s200();
        for frame in 0..FRAMES as u16 {
            let address = device.frame_address(frame).expect("an address");
            assert_eq!(device.frame_at(address), Some(frame));
        }
        assert_eq!(device.frame_at(FrameAddress(0x0600_0000)), None);
        assert_eq!(device.frame_at(FrameAddress::new(0, 0, 8)), None);
    }
}
