//! The test's end of the line to the guest: what the guest says, and what time it is there.
//!
//! The machine's processor waits while a message is handled, so the guest's clock stands still meanwhile,
//! however long the host takes. What the registers mean: crate `testport`.

use super::config_space::Window;
use super::remote::{Device, LockedCard};
use super::running::Running;
use driver::pci::Ids;
use std::io;
use std::sync::PoisonError;
use std::time::Duration;
use testport::{DEVICE, LENGTH, SIZE, STAMP_US, TIME, VENDOR, WORD};

/// Longest message, bytes.
const LONGEST: usize = 64 << 20;
/// Resets by the firmware and the kernels of any scenario; a kernel that panics and boots for ever makes more.
const MOST_RESETS: u32 = 40;

/// Something the guest said.
#[derive(Clone, Copy, Debug)]
pub struct Message<'a> {
    /// What the guest printed, without its end.
    pub line: &'a str,
    /// The file behind it, empty where there is none.
    pub content: &'a [u8],
}

pub(super) type Control<'a> = dyn FnMut(Message<'_>, &Running) -> String + 'a;

pub(super) struct Port<'a> {
    card: LockedCard,
    running: &'a Running,
    control: &'a mut Control<'a>,
    /// The guest's time is not to exceed this, over all its boots.
    limit: Duration,
    now: Duration,
    /// Last stamp; the guest counts from zero after a reset.
    stamp: u32,
    resets: u32,
    message: Vec<u8>,
    reply: Vec<u8>,
}

impl<'a> Port<'a> {
    pub(super) const IDS: Ids =
        Ids { vendor: VENDOR, device: DEVICE, subsystem_vendor: VENDOR, subsystem_device: DEVICE };
    pub(super) const WINDOWS: [Option<Window>; 6] =
        [Some(Window { bytes: SIZE, memory: false }), None, None, None, None, None];

    pub(super) fn new(card: LockedCard, running: &'a Running, limit: Duration, control: &'a mut Control<'a>) -> Self {
        let (message, reply) = (Vec::new(), Vec::new());
        Self { card, running, control, limit, now: Duration::ZERO, stamp: 0, resets: 0, message, reply }
    }

    /// Time of the guest over all its boots, as far as it was told.
    pub(super) fn now(&self) -> Duration {
        self.now
    }

    fn tell(&mut self, stamp: u32) -> io::Result<()> {
        self.now += Duration::from_micros(stamp.wrapping_sub(self.stamp).into());
        self.stamp = stamp;
        let within = Duration::from_micros(STAMP_US.into());
        self.card.lock().unwrap_or_else(PoisonError::into_inner).tell(self.now, within);
        if self.now > self.limit {
            return Err(io::Error::other(format!("the guest did not end within {:?} of its time", self.limit)));
        }
        Ok(())
    }

    fn handle(&mut self, length: usize) {
        self.message.truncate(length);
        let message = std::mem::take(&mut self.message);
        let end = message.iter().position(|byte| *byte == b'\n').unwrap_or(message.len());
        let line = String::from_utf8_lossy(&message[..end]);
        let content = message.get(end + 1..).unwrap_or_default();
        self.reply = (self.control)(Message { line: &line, content }, self.running).into_bytes();
    }
}

impl Device for Port<'_> {
    fn read(&mut self, _: usize, offset: u32, _: u32) -> u32 {
        match offset {
            LENGTH => self.reply.len() as u32,
            WORD => {
                let mut word = [0; 4];
                for (byte, next) in word.iter_mut().zip(self.reply.drain(..self.reply.len().min(4))) {
                    *byte = next;
                }
                u32::from_le_bytes(word)
            }
            _ => 0,
        }
    }

    fn write(&mut self, _: usize, offset: u32, _: u32, data: u32) -> io::Result<()> {
        match offset {
            TIME => self.tell(data)?,
            WORD if self.message.len() < LONGEST => self.message.extend(data.to_le_bytes()),
            LENGTH => self.handle(data as usize),
            _ => {}
        }
        Ok(())
    }

    fn reset(&mut self) -> io::Result<()> {
        self.stamp = 0;
        self.message.clear();
        self.resets += 1;
        if self.resets > MOST_RESETS {
            return Err(io::Error::other(format!("the machine was reset {MOST_RESETS} times")));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use runs::robot::Robot;
    use simulator::virtual_card::VirtualCard;
    use std::sync::{Arc, Mutex};

    #[test]
    fn words_become_a_line_a_file_and_a_reply() {
        let card = Arc::new(Mutex::new(VirtualCard::new(&Robot::racbot()).unwrap().in_told_time()));
        let mut heard = Vec::new();
        let mut control = |message: Message<'_>, _: &Running| {
            heard.push((message.line.to_owned(), message.content.to_vec()));
            "done!".to_owned()
        };
        let running = Running::default();
        let mut port = Port::new(card, &running, Duration::from_secs(2), &mut control);
        for word in [b"say ", b"it\n1", b"23\0\0"] {
            port.write(0, WORD, 4, u32::from_le_bytes(*word)).unwrap();
        }
        port.write(0, LENGTH, 4, 10).unwrap();
        assert_eq!(port.read(0, LENGTH, 4), 5);
        assert_eq!(port.read(0, WORD, 4).to_le_bytes(), *b"done");
        assert_eq!(port.read(0, WORD, 4).to_le_bytes(), *b"!\0\0\0");
        drop(port);
        assert_eq!(heard, [("say it".to_owned(), b"123".to_vec())]);
    }

    #[test]
    fn the_cards_time_is_the_guests_and_goes_on_over_a_reset() {
        let card = Arc::new(Mutex::new(VirtualCard::new(&Robot::racbot()).unwrap().in_told_time()));
        let now = || driver::pci::PciCard::now(&mut *card.lock().unwrap());
        let (running, mut control) = (Running::default(), |_: Message<'_>, _: &Running| String::new());
        let mut port = Port::new(card.clone(), &running, Duration::from_secs(2), &mut control);
        port.write(0, TIME, 4, 1_000_000).unwrap();
        assert_eq!(now(), Duration::from_secs(1));
        // Accesses take time, but never reach the next stamp's.
        for _ in 0..10_000 {
            card.lock().unwrap().bus_read(driver::pci::Bar::Bridge, 0, 4);
        }
        assert_eq!(now(), Duration::from_micros(1_000_250));
        port.reset().unwrap();
        port.write(0, TIME, 4, 500_000).unwrap();
        assert_eq!((now(), port.now()), (Duration::from_millis(1_500), Duration::from_millis(1_500)));
        assert!(port.write(0, TIME, 4, 1_500_000).is_err(), "beyond its limit");
    }
}
