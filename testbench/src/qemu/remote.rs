//! The remote side of QEMU's `x-pci-proxy-dev`: a PCI device that lives in this process.
//!
//! Messages on a stream socket, in the byte order of the host: `i32` command, 4 bytes of padding, `u64`
//! size, body. Accesses carry absolute addresses, so the device decodes them with its own base addresses.
//! As in QEMU 7.2, `include/hw/remote/mpqemu-link.h`; file descriptors that ride along are dropped.

use super::config_space::{ConfigSpace, Window};
use driver::pci::{Bar, Ids};
use simulator::virtual_card::VirtualCard;
use std::io::{self, BufReader, Read, Write};
use std::os::unix::net::UnixStream;
use std::sync::{Arc, Mutex, PoisonError};

const SYNC_SYSTEM_MEMORY: i32 = 0;
const RETURN: i32 = 1;
const CONFIG_WRITE: i32 = 2;
const CONFIG_READ: i32 = 3;
const BAR_WRITE: i32 = 4;
const BAR_READ: i32 = 5;
const SET_INTERRUPT: i32 = 6;
const DEVICE_RESET: i32 = 7;
/// Longest body there is.
const LONGEST: u64 = 4_096;

/// A card that several parts of a test can touch.
pub type LockedCard = Arc<Mutex<VirtualCard>>;

/// What a PCI device does beside its configuration space.
pub trait Device {
    /// A read of 1, 2 or 4 bytes in a window.
    fn read(&mut self, window: usize, offset: u32, size: u32) -> u32;

    /// A write of 1, 2 or 4 bytes in a window.
    ///
    /// # Errors
    /// Why the machine is to be stopped.
    fn write(&mut self, window: usize, offset: u32, size: u32, data: u32) -> io::Result<()>;

    /// A PCI reset.
    ///
    /// # Errors
    /// Why the machine is to be stopped.
    fn reset(&mut self) -> io::Result<()>;
}

/// The card on the bus.
#[derive(Debug)]
pub(super) struct CardDevice(pub(super) LockedCard);

impl CardDevice {
    fn card(&self) -> std::sync::MutexGuard<'_, VirtualCard> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Device for CardDevice {
    fn read(&mut self, window: usize, offset: u32, size: u32) -> u32 {
        self.card().bus_read(Bar::ALL[window], offset, size)
    }
    fn write(&mut self, window: usize, offset: u32, size: u32, data: u32) -> io::Result<()> {
        self.card().bus_write(Bar::ALL[window], offset, size, data);
        Ok(())
    }
    fn reset(&mut self) -> io::Result<()> {
        self.card().reset();
        Ok(())
    }
}

/// Serves a device until QEMU closes the socket.
///
/// # Errors
/// A socket that fails, a message nobody knows, or what the device wants the machine stopped for.
pub fn serve(socket: UnixStream, device: &mut dyn Device, ids: Ids, windows: [Option<Window>; 6]) -> io::Result<()> {
    let mut remote = Remote { device, config: ConfigSpace::new(ids, windows) };
    let mut socket = BufReader::new(socket);
    let mut header = [0; 16];
    loop {
        match socket.read_exact(&mut header) {
            Err(error) if error.kind() == io::ErrorKind::UnexpectedEof => return Ok(()),
            other => other?,
        }
        let command = i32::from_ne_bytes(field(&header, 0));
        let size = u64::from_ne_bytes(field(&header, 8));
        if size > LONGEST {
            return Err(io::Error::other(format!("a message of {size} bytes")));
        }
        let mut body = vec![0; size as usize];
        socket.read_exact(&mut body)?;
        if let Some(value) = remote.answer(command, &body)? {
            let mut reply = [0; 24];
            reply[..4].copy_from_slice(&RETURN.to_ne_bytes());
            reply[8..16].copy_from_slice(&8u64.to_ne_bytes());
            reply[16..].copy_from_slice(&value.to_ne_bytes());
            socket.get_mut().write_all(&reply)?;
        }
    }
}

fn field<const N: usize>(bytes: &[u8], at: usize) -> [u8; N] {
    std::array::from_fn(|n| bytes.get(at + n).copied().unwrap_or(0))
}

struct Remote<'a> {
    device: &'a mut dyn Device,
    config: ConfigSpace,
}

impl Remote<'_> {
    /// What to reply, where a reply is waited for.
    fn answer(&mut self, command: i32, body: &[u8]) -> io::Result<Option<u64>> {
        Ok(Some(match command {
            SYNC_SYSTEM_MEMORY | SET_INTERRUPT => return Ok(None),
            CONFIG_READ | CONFIG_WRITE => {
                let at = u32::from_ne_bytes(field(body, 0)) as usize;
                let value = u32::from_ne_bytes(field(body, 4));
                let size = u32::from_ne_bytes(field(body, 8)) as usize;
                if command == CONFIG_WRITE {
                    self.config.write(at, size, value);
                    0
                } else {
                    self.config.read(at, size).into()
                }
            }
            BAR_READ | BAR_WRITE => {
                let address = u64::from_ne_bytes(field(body, 0));
                let value = u64::from_ne_bytes(field(body, 8));
                let size = u32::from_ne_bytes(field(body, 16));
                let memory = body.get(20).is_some_and(|flag| *flag != 0);
                let Some((window, offset)) = self.config.decode(address, memory) else {
                    return Ok(Some(u64::MAX >> 1));
                };
                // The local bus has 32 bits: longer accesses come as several.
                let parts = (0..size.div_ceil(4)).map(|n| (n * 4, (size - n * 4).min(4)));
                let mut out = 0;
                for (at, width) in parts {
                    if command == BAR_WRITE {
                        self.device.write(window, offset + at, width, (value >> (8 * at)) as u32)?;
                    } else {
                        out |= u64::from(self.device.read(window, offset + at, width)) << (8 * at);
                    }
                }
                out
            }
            DEVICE_RESET => {
                self.config.reset();
                self.device.reset()?;
                0
            }
            other => return Err(io::Error::other(format!("command {other} of QEMU is unknown"))),
        }))
    }
}
