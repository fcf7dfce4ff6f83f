//! The line between a virtual machine's guest and the test outside: a PCI device with one window of I/O ports.
//!
//! Every access is served while the machine's processor waits, so none of it takes time in the guest. The
//! ports are 32 bits wide, little-endian:
//!
//! | offset | write | read |
//! |---|---|---|
//! | [`TIME`] | µs since the guest's start, low 32 bits | 0 |
//! | [`WORD`] | the next four bytes of a message | the next four bytes of the reply |
//! | [`LENGTH`] | bytes of the message, which is then handled | bytes of the reply |
//!
//! A message is a line of text, and after its newline the content of a file where it carries one.

/// PCI vendor, one that QEMU's own test devices use.
pub const VENDOR: u16 = 0x1234;
/// PCI device.
pub const DEVICE: u16 = 0x7E57;
/// Bytes of the window, BAR 0.
pub const SIZE: u32 = 16;
/// Guest time.
pub const TIME: u32 = 0;
/// Four bytes of a message or reply.
pub const WORD: u32 = 4;
/// Length of a message or reply.
pub const LENGTH: u32 = 8;
/// How often the guest tells its time, µs: a quarter of the fastest control period that a test drives.
pub const STAMP_US: u32 = 250;
