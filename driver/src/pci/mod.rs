//! The card as the PCI bus shows it: six windows, and the time that passes beside it.
//!
//! [`PciCard`] is the seam of loading, as [`crate::Registers`] is that of control. Behind it stand the
//! real card (sysfs) and virtual ones; a [`RegisterWindow`] makes the registers of the loaded FPGA from it.

mod map;
mod slot;
mod sysfs;
mod window;

pub use slot::{FindError, Ids, SYSFS_DEVICES, Slot, devices, find};
pub use sysfs::{OpenError, SysfsCard, Use};
pub use window::RegisterWindow;

use std::fmt;
use std::time::Duration;

/// A window of the card, a PCI base address register. Sizes and uses: Mesa 4I65 manual 1.4, page 8.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Bar {
    /// 0: the bridge's local configuration registers, memory, 128 bytes.
    Bridge,
    /// 1: the same registers as I/O ports.
    BridgePorts,
    /// 2: FPGA, I/O ports on a 16-bit local bus, 256 bytes.
    Ports16,
    /// 3: FPGA, I/O ports on a 32-bit local bus, 256 bytes.
    Ports32,
    /// 4: FPGA, memory on a 16-bit local bus, 64 KiB.
    Memory16,
    /// 5: FPGA, memory on a 32-bit local bus, 64 KiB: the register window.
    Memory32,
}

impl Bar {
    /// All of them, by number.
    pub const ALL: [Self; 6] =
        [Self::Bridge, Self::BridgePorts, Self::Ports16, Self::Ports32, Self::Memory16, Self::Memory32];

    /// Number of the base address register.
    #[must_use]
    pub const fn index(self) -> usize {
        self as usize
    }

    /// Length of the window, bytes.
    #[must_use]
    pub const fn size(self) -> u32 {
        match self {
            Self::Bridge | Self::BridgePorts => 128,
            Self::Ports16 | Self::Ports32 => 256,
            Self::Memory16 | Self::Memory32 => 65_536,
        }
    }

    /// Memory, not I/O ports.
    #[must_use]
    pub const fn is_memory(self) -> bool {
        matches!(self, Self::Bridge | Self::Memory16 | Self::Memory32)
    }
}

impl fmt::Display for Bar {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "BAR {}", self.index())
    }
}

/// An access to the card that failed.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{action} of {bar} at {offset:#06x} failed: {cause}")]
pub struct PciError {
    /// `read` or `write`.
    pub action: &'static str,
    /// Window that was accessed.
    pub bar: Bar,
    /// Byte offset in it.
    pub offset: u32,
    /// What the system says.
    pub cause: String,
}

impl PciError {
    /// A failed read.
    pub fn read(bar: Bar, offset: u32, cause: impl fmt::Display) -> Self {
        Self { action: "read", bar, offset, cause: cause.to_string() }
    }

    /// A failed write.
    pub fn write(bar: Bar, offset: u32, cause: impl fmt::Display) -> Self {
        Self { action: "write", bar, offset, cause: cause.to_string() }
    }
}

/// A card on the PCI bus.
///
/// 32-bit accesses are aligned; an offset beyond its window is an error, never an access. A card that
/// is gone reads all ones and swallows writes, as the bus does; that is no error here.
///
/// Time belongs to the seam because time-outs and the measured clock must hold where a simulated card
/// has a time of its own.
pub trait PciCard {
    /// Reads an aligned word.
    ///
    /// # Errors
    /// [`PciError`] where the system refuses the access.
    fn read32(&mut self, bar: Bar, offset: u32) -> Result<u32, PciError>;

    /// Writes an aligned word.
    ///
    /// # Errors
    /// [`PciError`] where the system refuses the access.
    fn write32(&mut self, bar: Bar, offset: u32, data: u32) -> Result<(), PciError>;

    /// Writes one byte: a byte of a bitstream, on lane 0 where the offset is a multiple of 4.
    ///
    /// # Errors
    /// [`PciError`] where the system refuses the access.
    fn write8(&mut self, bar: Bar, offset: u32, data: u8) -> Result<(), PciError>;

    /// Which of these windows this access path can reach.
    fn has(&self, bar: Bar) -> bool;

    /// Monotonic time beside the card, from any origin.
    fn now(&mut self) -> Duration;

    /// Lets at least this time pass.
    fn sleep(&mut self, time: Duration);

    /// What the access path knows of the card beside its windows: a simulated one, why what was loaded does not run.
    fn remark(&self) -> Option<String> {
        None
    }
}

macro_rules! forward {
    ($($card:ty),*) => {$(
        impl<C: PciCard + ?Sized> PciCard for $card {
            fn read32(&mut self, bar: Bar, offset: u32) -> Result<u32, PciError> {
                (**self).read32(bar, offset)
            }
            fn write32(&mut self, bar: Bar, offset: u32, data: u32) -> Result<(), PciError> {
                (**self).write32(bar, offset, data)
            }
            fn write8(&mut self, bar: Bar, offset: u32, data: u8) -> Result<(), PciError> {
                (**self).write8(bar, offset, data)
            }
            fn has(&self, bar: Bar) -> bool {
                (**self).has(bar)
            }
            fn now(&mut self) -> Duration {
                (**self).now()
            }
            fn sleep(&mut self, time: Duration) {
                (**self).sleep(time);
            }
            fn remark(&self) -> Option<String> {
                (**self).remark()
            }
        }
    )*};
}
forward!(&mut C, Box<C>);
