//! The real card: windows through sysfs, without a kernel module and without port instructions.

use super::map::Mapping;
use super::slot::Slot;
use super::{Bar, PciCard, PciError};
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io;
use std::os::unix::fs::FileExt;
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// A card that cannot be opened.
#[derive(Debug, thiserror::Error)]
pub enum OpenError {
    /// A file of the card.
    #[error("{}: {cause}{}", .path.display(), hint(.cause))]
    File {
        /// File of sysfs that was used.
        path: PathBuf,
        /// What the system answered.
        cause: io::Error,
    },
    /// A kernel driver holds it.
    #[error("{slot} is held by the kernel driver {driver}; echo {slot} > /sys/bus/pci/drivers/{driver}/unbind")]
    Driver {
        /// Domain, bus, device and function, as 0000:02:00.0.
        slot: String,
        /// Kernel driver that holds the card.
        driver: String,
    },
    /// Another program drives it.
    #[error("{0} is in use by another program that loads or drives it; stop that first")]
    InUse(String),
    /// Neither memory nor ports can be reached.
    #[error("{slot}: {window} can neither be mapped ({memory}) nor reached through its ports ({ports})")]
    NoWindow {
        /// Domain, bus, device and function, as 0000:02:00.0.
        slot: String,
        /// What was looked for.
        window: &'static str,
        /// Why memory failed.
        memory: String,
        /// Why ports failed.
        ports: String,
    },
}

fn hint(cause: &io::Error) -> &'static str {
    match cause.kind() {
        io::ErrorKind::PermissionDenied => "; run as root once, or install the udev rule of dist/",
        io::ErrorKind::NotFound => "; the card is gone",
        _ => "",
    }
}

/// What the card is opened for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Use {
    /// Loading and driving: one program at a time.
    Drive,
    /// Looking, beside one that drives.
    Look,
}

#[derive(Debug)]
enum Window {
    Memory(Mapping),
    Ports(File),
}

/// The card of a slot.
#[derive(Debug)]
pub struct SysfsCard {
    slot: Slot,
    windows: [Option<Window>; 6],
    begun: Instant,
    /// Held for its lock.
    _lock: File,
}

impl SysfsCard {
    /// Enables the card and opens its windows: the bridge's registers and the register window, as memory
    /// where it can be mapped and as ports where not.
    ///
    /// # Errors
    /// [`OpenError`]; nothing on the card has been touched then.
    pub fn open(slot: &Slot, purpose: Use) -> Result<Self, OpenError> {
        if let Ok(driver) = fs::read_link(slot.folder.join("driver")) {
            let driver = driver.file_name().map_or(String::new(), |name| name.to_string_lossy().into_owned());
            return Err(OpenError::Driver { slot: slot.name.clone(), driver });
        }
        let lock = Self::lock(slot, purpose)?;
        enable(slot)?;
        let mut windows = [const { None }; 6];
        for (name, memory, ports) in [
            ("the bridge (BAR 0)", Bar::Bridge, &[Bar::BridgePorts][..]),
            ("the FPGA (BAR 5)", Bar::Memory32, &[Bar::Ports16, Bar::Ports32]),
        ] {
            let failure = match map(slot, memory) {
                Ok(mapping) => {
                    windows[memory.index()] = Some(Window::Memory(mapping));
                    continue;
                }
                Err(error) => error,
            };
            for &bar in ports {
                let file = open_resource(slot, bar).map_err(|cause| OpenError::NoWindow {
                    slot: slot.name.clone(),
                    window: name,
                    memory: failure.to_string(),
                    ports: cause.to_string(),
                })?;
                windows[bar.index()] = Some(Window::Ports(file));
            }
        }
        Ok(Self { slot: slot.clone(), windows, begun: Instant::now(), _lock: lock })
    }

    fn lock(slot: &Slot, purpose: Use) -> Result<File, OpenError> {
        let path = slot.folder.join("resource5");
        let file = File::open(&path).map_err(|cause| OpenError::File { path: path.clone(), cause })?;
        if purpose == Use::Drive {
            match file.try_lock() {
                Ok(()) => {}
                Err(TryLockError::WouldBlock) => return Err(OpenError::InUse(slot.name.clone())),
                Err(TryLockError::Error(cause)) => return Err(OpenError::File { path, cause }),
            }
        }
        Ok(file)
    }

    /// Where on the bus the card is.
    #[must_use]
    pub fn slot(&self) -> &Slot {
        &self.slot
    }

    fn window(&self, bar: Bar) -> Result<&Window, String> {
        self.windows[bar.index()].as_ref().ok_or_else(|| format!("{bar} is not open"))
    }
}

/// Switches decoding on, where nobody has yet.
fn enable(slot: &Slot) -> Result<(), OpenError> {
    let path = slot.folder.join("enable");
    let failed = |cause| OpenError::File { path: path.clone(), cause };
    if fs::read_to_string(&path).map_err(failed)?.trim() == "0" {
        fs::write(&path, "1").map_err(failed)?;
    }
    Ok(())
}

fn open_resource(slot: &Slot, bar: Bar) -> io::Result<File> {
    OpenOptions::new().read(true).write(true).open(slot.folder.join(format!("resource{}", bar.index())))
}

fn map(slot: &Slot, bar: Bar) -> io::Result<Mapping> {
    let table = fs::read_to_string(slot.folder.join("resource"))?;
    let line = table.lines().nth(bar.index()).unwrap_or_default();
    let mut numbers = line.split_whitespace().map(|n| u64::from_str_radix(n.trim_start_matches("0x"), 16));
    let (Some(Ok(start)), Some(Ok(end))) = (numbers.next(), numbers.next()) else {
        return Err(io::Error::other(format!("{bar} is not in the card's table of resources")));
    };
    let size = end.saturating_sub(start).saturating_add(u64::from(end != 0));
    if size < u64::from(bar.size()) {
        return Err(io::Error::other(format!("{bar} has {size} bytes instead of {}", bar.size())));
    }
    // Below a page, the kernel maps the page that the window lies in.
    Mapping::new(&open_resource(slot, bar)?, (start & 0xFFF) as usize, bar.size() as usize)
}

impl PciCard for SysfsCard {
    fn read32(&mut self, bar: Bar, offset: u32) -> Result<u32, PciError> {
        let fail = |cause: String| PciError::read(bar, offset, cause);
        match self.window(bar).map_err(fail)? {
            Window::Memory(mapping) => mapping.read32(offset).map_err(|cause| fail(cause.to_owned())),
            Window::Ports(file) => {
                check_port(bar, offset, 4).map_err(|cause| fail(cause.to_owned()))?;
                let mut bytes = [0; 4];
                file.read_exact_at(&mut bytes, offset.into()).map_err(|error| fail(error.to_string()))?;
                Ok(u32::from_le_bytes(bytes))
            }
        }
    }

    fn write32(&mut self, bar: Bar, offset: u32, data: u32) -> Result<(), PciError> {
        let fail = |cause: String| PciError::write(bar, offset, cause);
        match self.window(bar).map_err(fail)? {
            Window::Memory(mapping) => mapping.write32(offset, data).map_err(|cause| fail(cause.to_owned())),
            Window::Ports(file) => {
                check_port(bar, offset, 4).map_err(|cause| fail(cause.to_owned()))?;
                file.write_all_at(&data.to_le_bytes(), offset.into()).map_err(|error| fail(error.to_string()))
            }
        }
    }

    fn write8(&mut self, bar: Bar, offset: u32, data: u8) -> Result<(), PciError> {
        let fail = |cause: String| PciError::write(bar, offset, cause);
        match self.window(bar).map_err(fail)? {
            Window::Memory(mapping) => mapping.write8(offset, data).map_err(|cause| fail(cause.to_owned())),
            Window::Ports(file) => {
                check_port(bar, offset, 1).map_err(|cause| fail(cause.to_owned()))?;
                file.write_all_at(&[data], offset.into()).map_err(|error| fail(error.to_string()))
            }
        }
    }

    fn has(&self, bar: Bar) -> bool {
        self.windows[bar.index()].is_some()
    }

    fn now(&mut self) -> Duration {
        self.begun.elapsed()
    }

    fn sleep(&mut self, time: Duration) {
        std::thread::sleep(time);
    }
}

/// An unaligned port access may be dropped on its way without any error.
fn check_port(bar: Bar, offset: u32, width: u32) -> Result<(), &'static str> {
    if !offset.is_multiple_of(width) {
        return Err("the offset is not aligned");
    }
    if offset + width > bar.size() {
        return Err("the offset is beyond the window; ports reach only its first bytes");
    }
    Ok(())
}

#[cfg(test)]
mod tests;
