//! The virtual card on the PCI bus of a virtual machine with a real Linux kernel.
//!
//! QEMU's `x-pci-proxy-dev` forwards every access to configuration space and windows over a socket; the
//! card stays in this process, where tests watch the robot behind it.

mod config_space;
mod guest;
mod initramfs;
mod port;
mod remote;
mod running;
mod tools;

pub use config_space::{ConfigSpace, Window};
pub use guest::{Options, Outcome, run};
pub use initramfs::Initramfs;
pub use port::Message;
pub use remote::{Device, LockedCard, serve};
pub use running::Running;
pub use tools::{MissingTool, Tools};
