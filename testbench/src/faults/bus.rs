//! A bus that fails at a chosen transfer.

use driver::{BusError, Registers};

/// What happens to a transfer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Trouble {
    /// A bit changes on the way.
    Flip(u32),
    /// A write never arrives; a read is answered with zero.
    Drop,
    /// It happens twice.
    Repeat,
    /// A write arrives after the next one; a read is answered with the word of the read before.
    Delay,
}

/// What happens to which transfers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BusFault {
    /// At the read of this number, from 0.
    Read(u64, Trouble),
    /// At the write of this number, from 0.
    Write(u64, Trouble),
    /// At every read from this number on.
    ReadsFrom(u64, Trouble),
    /// At every write from this number on.
    WritesFrom(u64, Trouble),
    /// So many transfers from this one on fail, and the host is told so; then the bus works again.
    ErrorsFrom(u64, u64),
    /// From this transfer on nothing reaches the card, and the host is told so.
    GoneFrom(u64),
    /// From this transfer on there is no host: the process was killed.
    KilledFrom(u64),
}

/// Registers behind a bus that fails.
#[derive(Debug)]
pub struct FaultyBus<R> {
    /// What is behind it.
    pub inner: R,
    fault: Option<BusFault>,
    reads: u64,
    writes: u64,
    last: u32,
    late: Option<(u16, u32)>,
    failed: u64,
}

impl<R: Registers> FaultyBus<R> {
    /// Wraps a bus; `None` is a good one.
    pub fn new(inner: R, fault: Option<BusFault>) -> Self {
        Self { inner, fault, reads: 0, writes: 0, last: 0, late: None, failed: 0 }
    }

    /// Reads and writes so far.
    #[must_use]
    pub fn transfers(&self) -> (u64, u64) {
        (self.reads, self.writes)
    }

    /// Why this transfer fails.
    fn gone(&mut self) -> Option<&'static str> {
        let done = self.reads + self.writes;
        match self.fault {
            Some(BusFault::GoneFrom(from)) if done >= from => {
                Some("it reads all ones: the card is gone or has lost its design")
            }
            Some(BusFault::KilledFrom(from)) if done >= from => Some("the process was killed"),
            Some(BusFault::ErrorsFrom(from, count)) if done >= from && self.failed < count => {
                self.failed += 1;
                Some("the bus did not answer")
            }
            _ => None,
        }
    }

    fn trouble_at(&self, read: bool) -> Option<Trouble> {
        match self.fault? {
            BusFault::Read(at, trouble) if read && at == self.reads => Some(trouble),
            BusFault::Write(at, trouble) if !read && at == self.writes => Some(trouble),
            BusFault::ReadsFrom(from, trouble) if read && self.reads >= from => Some(trouble),
            BusFault::WritesFrom(from, trouble) if !read && self.writes >= from => Some(trouble),
            _ => None,
        }
    }
}

impl<R: Registers> Registers for FaultyBus<R> {
    fn read(&mut self, offset: u16) -> Result<u32, BusError> {
        if let Some(why) = self.gone() {
            return Err(BusError::read(offset, why));
        }
        let trouble = self.trouble_at(true);
        self.reads += 1;
        let before = self.last;
        let mut word = self.inner.read(offset)?;
        if trouble == Some(Trouble::Repeat) {
            word = self.inner.read(offset)?;
        }
        self.last = word;
        Ok(match trouble {
            Some(Trouble::Flip(bit)) => word ^ 1 << (bit % 32),
            Some(Trouble::Drop) => 0,
            Some(Trouble::Delay) => before,
            Some(Trouble::Repeat) | None => word,
        })
    }

    fn write(&mut self, offset: u16, data: u32) -> Result<(), BusError> {
        if let Some(why) = self.gone() {
            return Err(BusError::write(offset, why));
        }
        let trouble = self.trouble_at(false);
        self.writes += 1;
        match trouble {
            Some(Trouble::Drop) => return Ok(()),
            Some(Trouble::Delay) if self.late.is_none() => {
                self.late = Some((offset, data));
                return Ok(());
            }
            Some(Trouble::Flip(bit)) => self.inner.write(offset, data ^ 1 << (bit % 32))?,
            Some(Trouble::Repeat) => {
                self.inner.write(offset, data)?;
                self.inner.write(offset, data)?;
            }
            Some(Trouble::Delay) | None => self.inner.write(offset, data)?,
        }
        match self.late.take() {
            Some((offset, data)) => self.inner.write(offset, data),
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use driver::{Recorder, Transfer};
    use fixed_kin::card::Card;
    use fixed_kin::registers::{LEDS, TICK_PERIOD};

    fn played(fault: BusFault) -> (Vec<u32>, Vec<(u16, u32)>) {
        let mut bus = FaultyBus::new(Recorder::new(Card::new(0)), Some(fault));
        let reads = [TICK_PERIOD.offset, LEDS.offset].map(|offset| bus.read(offset).unwrap_or(u32::MAX));
        for data in [1, 2] {
            let _ = bus.write(LEDS.offset, data);
        }
        let writes = bus.inner.transfers.into_iter().filter_map(|transfer| match transfer {
            Transfer::Write(offset, data) => Some((offset, data)),
            Transfer::Read(..) => None,
        });
        (reads.to_vec(), writes.collect())
    }

    #[test]
    fn every_trouble_does_what_its_name_says() {
        let leds = LEDS.offset;
        let good = (vec![33_333, 0], vec![(leds, 1), (leds, 2)]);
        assert_eq!(played(BusFault::Read(9, Trouble::Drop)), good);
        assert_eq!(played(BusFault::Read(0, Trouble::Flip(0))).0, [33_332, 0]);
        assert_eq!(played(BusFault::Read(0, Trouble::Drop)).0, [0, 0]);
        assert_eq!(played(BusFault::Read(1, Trouble::Delay)).0, [33_333, 33_333]);
        assert_eq!(played(BusFault::Read(1, Trouble::Repeat)), good);
        assert_eq!(played(BusFault::Write(0, Trouble::Flip(3))).1, [(leds, 9), (leds, 2)]);
        assert_eq!(played(BusFault::Write(0, Trouble::Drop)).1, [(leds, 2)]);
        assert_eq!(played(BusFault::Write(0, Trouble::Delay)).1, [(leds, 2), (leds, 1)]);
        assert_eq!(played(BusFault::Write(1, Trouble::Repeat)).1, [(leds, 1), (leds, 2), (leds, 2)]);
        assert_eq!(played(BusFault::WritesFrom(1, Trouble::Drop)).1, [(leds, 1)]);
        assert_eq!(played(BusFault::ErrorsFrom(1, 2)), (vec![33_333, u32::MAX], vec![(leds, 2)]));
        assert_eq!(played(BusFault::KilledFrom(1)), (vec![33_333, u32::MAX], vec![]));
    }
}
