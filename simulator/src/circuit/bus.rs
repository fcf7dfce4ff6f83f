//! The bridge as master of the local bus of a circuit: the cycles of [`crate::cosim::BusConfig`], pin by pin.

use super::Circuit;
use crate::cosim::Layout;
use crate::error::FpgaError;

/// Clocks that a word may wait for READY#; then the bridge gives up, and reads what the pull-ups say.
const MAX_WAIT: u32 = 256;

/// Columns of the bus.
#[derive(Clone, Debug)]
pub(super) struct Pins {
    ads: usize,
    blast: usize,
    lw_r: usize,
    lad: usize,
    drive: usize,
    ready: usize,
    lad_out: usize,
    /// Period of the bus clock, ps.
    pub(super) period: u64,
}

impl Pins {
    pub(super) fn of(layout: &Layout, period: u64) -> Result<Self, FpgaError> {
        Ok(Self {
            ads: layout.input("ads_n")?,
            blast: layout.input("blast_n")?,
            lw_r: layout.input("lw_r")?,
            lad: layout.input("lad")?,
            drive: layout.input("lad.drive")?,
            ready: layout.output("ready_n")?,
            lad_out: layout.output("lad")?,
            period,
        })
    }
}

impl Circuit {
    /// The bus at rest; it floats.
    pub(super) fn idle(&mut self) {
        let Pins { ads, blast, lw_r, lad, drive, .. } = self.bus;
        for (column, value) in [(ads, 1), (blast, 1), (lw_r, 0), (lad, u32::MAX), (drive, 0)] {
            self.put(column, value);
        }
    }

    fn address(&mut self, address: u32, write: bool) -> Result<(), FpgaError> {
        let Pins { ads, blast, lw_r, lad, drive, .. } = self.bus;
        for (column, value) in [(ads, 0), (blast, 1), (lw_r, u32::from(write)), (lad, address), (drive, 1)] {
            self.put(column, value);
        }
        self.step()?;
        self.put(ads, 1);
        Ok(())
    }

    /// A word of the data phase: what stands on the bus in the clock in which READY# is low, or none.
    fn word(&mut self, last: bool, data: Option<u32>) -> Result<Option<u32>, FpgaError> {
        let Pins { blast, lad, drive, ready, lad_out, .. } = self.bus;
        self.put(blast, u32::from(!last));
        self.put(lad, data.unwrap_or(u32::MAX));
        self.put(drive, u32::from(data.is_some()));
        for _ in 0..=MAX_WAIT {
            self.before_edge()?;
            self.look();
            let (ready, word) = (self.output(ready) & 1 == 0, self.values[lad_out]);
            self.edge()?;
            if ready {
                return Ok(Some(word));
            }
        }
        Ok(None)
    }

    /// Reads consecutive words in one burst; a design that does not answer reads as ones.
    pub(super) fn bus_read(&mut self, address: u32, words: &mut [u32]) -> Result<(), FpgaError> {
        self.address(address, false)?;
        let count = words.len();
        for (index, word) in words.iter_mut().enumerate() {
            *word = self.word(index + 1 == count, None)?.unwrap_or(u32::MAX);
        }
        self.idle();
        self.step()
    }

    pub(super) fn bus_write(&mut self, address: u32, data: u32) -> Result<(), FpgaError> {
        self.address(address, true)?;
        self.word(true, Some(data))?;
        self.idle();
        self.step()
    }
}
