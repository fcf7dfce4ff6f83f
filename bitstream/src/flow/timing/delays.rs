//! Delays in ps, of the slower speed grade −5.
//!
//! Logic: Xilinx data sheet DS001-3 v2.8, table "CLB Switching Characteristics". Its tables of carry, block
//! memory and pads are not quoted here; for these stand bounds that are longer than what the family's
//! data sheets print, marked *bound*.
//!
//! No delay of a wire or switch was ever published. [`wire`] gives each family a bound, from the input of the
//! switch that drives it to its far end.

use crate::device::WireFamily;

/// Table inputs to X or Y (T_ILO).
pub const TABLE: u32 = 700;
/// Inputs of a pair of tables, or its select, to X (T_IF5X).
pub const WIDE: u32 = 1_100;
/// Clock to XQ or YQ (T_CKO).
pub const CLOCK_TO_OUTPUT: u32 = 1_300;
/// Table inputs to the flip-flop of their half (T_ICK).
pub const TABLE_SETUP: u32 = 1_400;
/// Inputs of a pair to the flip-flop (T_IF5CK).
pub const WIDE_SETUP: u32 = 1_800;
/// Bypass to its flip-flop (T_DICK).
pub const BYPASS_SETUP: u32 = 800;
/// Enable (T_CECK).
pub const ENABLE_SETUP: u32 = 900;
/// Synchronous reset (T_RCK).
pub const RESET_SETUP: u32 = 800;
/// Table inputs to the carry out of their half: *bound*.
pub const TABLE_TO_CARRY: u32 = 1_700;
/// BX to the carry into the slice: *bound*.
pub const BYPASS_TO_CARRY: u32 = 1_200;
/// Carry through a half: *bound*.
pub const CARRY: u32 = 150;
/// Carry to X, Y, XB or YB: *bound*.
pub const CARRY_TO_OUTPUT: u32 = 1_200;
/// Table inputs through the sum to X or Y: *bound*.
pub const TABLE_TO_SUM: u32 = 1_200;
/// What a flip-flop adds after X or Y (T_ICK − T_ILO).
pub const OUTPUT_SETUP: u32 = TABLE_SETUP - TABLE;
/// Clock to data out of a block memory: *bound*.
pub const MEMORY_TO_OUTPUT: u32 = 4_500;
/// Address and data of a block memory before its clock: *bound*.
pub const MEMORY_SETUP: u32 = 1_600;
/// Enable, reset and write of a block memory: *bound*.
pub const MEMORY_CONTROL_SETUP: u32 = 3_500;
/// Pad to I: *bound*.
pub const PAD_IN: u32 = 1_600;
/// O or T to the pad, fast: *bound*, with 35 pF.
pub const PAD_OUT_FAST: u32 = 6_000;
/// O or T to the pad, slow: *bound*.
pub const PAD_OUT_SLOW: u32 = 9_000;
/// From a clock's pad to the flip-flops, at most: *bound*.
pub const CLOCK_INSERTION: u32 = 3_000;
/// Between the leaves of a clock: *bound*.
pub const CLOCK_SKEW: u32 = 400;

/// A wire with the switch that drives it.
///
/// Shape: a single-length wire with its gate is one unit of load, a hex wire two, a long wire four; an
/// input or output multiplexer is less than one, a buffer half of that.
///
/// Size: files of the card's maker run a domain at 100 MHz and one at 33 MHz, so no path in them takes longer
/// than 10 and 30 ns. [`super::decoded`] finds their longest paths; with these figures the 100 MHz domains of 19 files
/// come to 10.8 to 16.0 ns and the 33 MHz domains of 22 files to 17.1 to 29.1 ns (example `envelope`): the model
/// takes every 100 MHz domain for too slow, though they run. So wires are, on such
/// paths, faster than this. What it cannot bound is one kind of wire alone, or a chip slower than the
/// slowest speed grade sold.
#[must_use]
pub fn wire(family: WireFamily) -> u32 {
    match family {
        WireFamily::Single => 320,
        WireFamily::Hex | WireFamily::HexOneWay => 680,
        WireFamily::LongHorizontal | WireFamily::LongVertical => 1_360,
        WireFamily::BlockRamBus => 460,
        WireFamily::OutputMux | WireFamily::Input => 280,
        WireFamily::SingleBuffer | WireFamily::HexBuffer => 140,
        WireFamily::Output | WireFamily::Other | WireFamily::ClockRoot | WireFamily::ClockLeaf => 0,
    }
}
