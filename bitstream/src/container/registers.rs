//! Configuration registers of the device and the commands of one of them.

/// Register: CRC check.
pub const CRC: u32 = 0;
/// Register: address of the next frame.
pub const FRAME_ADDRESS: u32 = 1;
/// Register: frame data in.
pub const FRAME_DATA: u32 = 2;
/// Register CMD: takes the commands below.
pub const COMMAND: u32 = 4;
/// Register CTL: takes the bits that [`MASK`] lets through.
pub const CONTROL: u32 = 5;
/// Register: mask of the control register.
pub const MASK: u32 = 6;
/// Register: configuration options, with the order of the start-up.
pub const OPTIONS: u32 = 9;
/// Register: frame length, one less than a frame's words.
pub const FRAME_LENGTH: u32 = 11;
/// First address that is no register; a packet to it or beyond is refused.
pub(super) const REGISTERS: u32 = 12;

/// Command: write configuration.
pub const WRITE_CONFIGURATION: u32 = 1;
/// Command: the frame that follows is the last.
pub const LAST_FRAME: u32 = 3;
/// Command: start-up.
pub const START: u32 = 5;
/// Command: CRC register to zero.
pub const RESET_CRC: u32 = 7;
/// Command: take over the configuration clock's options.
pub const SWITCH_CLOCK: u32 = 9;
