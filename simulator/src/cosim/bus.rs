//! The PLX PCI 9030 as master of the card's local bus, beside the design in the same process.
//!
//! ```text
//! clock    _/~\_/~\_/~\_/~\_/~\_      single write: address, then data until READY#
//! ADS#     ~\___/~~~~~~~~~~~~~~~      a burst keeps BLAST# high until its last word
//! LAD      -<adr>< data        >-     the value the design samples is the one before the edge
//! BLAST#   ~~~~~\_____________/~~
//! READY#   ~~~~~~~~~~~~~~\___/~~~     looked at on every edge of the data phase
//! ```

use super::CosimError;
use super::bus_config::BusConfig;
use super::layout::Layout;
use super::session::{Session, command, whole, word};

/// One operation of the bus master. Addresses are byte addresses, multiples of 4.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum BusOperation {
    /// Writes these words to consecutive addresses, as one burst.
    Write {
        /// Address of the first.
        address: u32,
        /// The words, at least one.
        data: Vec<u32>,
    },
    /// Reads words from consecutive addresses, as one burst.
    Read {
        /// Address of the first.
        address: u32,
        /// How many, at least one.
        count: u32,
    },
    /// Lets the design run.
    Wait {
        /// Main clocks.
        clocks: u32,
    },
}

impl Layout {
    /// The harness's words for a bus, or the name that is missing.
    fn bus_words(&self, bus: &BusConfig) -> Result<[u32; 10], CosimError> {
        let input = |name: &str| self.input(name).map(word);
        let output = |name: &str| self.output(name).map(word);
        let lad = |suffix: &str| format!("{}{suffix}", bus.lad);
        let (lad, drive, out, fpga) = if let Ok(port) = input(&bus.lad) {
            (port, input(&lad(".drive"))?, output(&bus.lad)?, u32::MAX)
        } else {
            let fpga = output(&lad("_drive")).unwrap_or(u32::MAX);
            (input(&lad("_in"))?, u32::MAX, output(&lad("_out"))?, fpga)
        };
        let (ads, blast, lw_r) = (input(&bus.ads_n)?, input(&bus.blast_n)?, input(&bus.lw_r)?);
        let ready = output(&bus.ready_n)?;
        Ok([ads, blast, lw_r, lad, drive, ready, out, fpga, bus.max_wait, bus.gap])
    }
}

impl Session {
    /// Tells the bus master which ports to use and lets the bus idle. A design with the card's own
    /// port names has this done at power-up, with the default configuration.
    ///
    /// # Errors
    /// If a port is missing or the process has ended.
    pub fn attach_bus(&mut self, bus: &BusConfig) -> Result<(), CosimError> {
        let words = self.layout().bus_words(bus)?;
        self.send(&[command::BUS_PORTS])?;
        self.send(&words)?;
        self.bus_attached = true;
        Ok(())
    }

    /// Runs bus operations one after the other, in one exchange with the process, and gives the
    /// words read, in order.
    ///
    /// # Errors
    /// If no bus is attached, READY# does not come in time, the design drives LAD when it must not
    /// or does not when it must, or the process has ended.
    pub fn bus(&mut self, operations: &[BusOperation]) -> Result<Vec<u32>, CosimError> {
        if !self.bus_attached {
            self.attach_bus(&BusConfig::default())?;
        }
        let mut message = vec![command::BUS, word(operations.len())];
        for operation in operations {
            match operation {
                BusOperation::Write { address, data } => {
                    message.extend([0, *address, word(data.len())]);
                    message.extend(data);
                }
                BusOperation::Read { address, count } => message.extend([1, *address, *count]),
                BusOperation::Wait { clocks } => message.extend([2, 0, *clocks]),
            }
        }
        self.send(&message)?;
        let head = self.receive(5)?;
        let data = self.receive(head[4] as usize)?;
        let clock = whole(head[2], head[3]);
        self.set_clock(clock);
        let reason = match head[0] {
            0 => return Ok(data),
            1 => "READY# did not come within the bound",
            2 => "READY# came but the design does not drive LAD",
            _ => "the design drives LAD against the bus master",
        };
        let index = (head[1] as usize).saturating_sub(1);
        let operation = operations.get(index).map_or_else(String::new, |o| match o {
            BusOperation::Write { address, data } => format!("write of {} at {address:#06x}", data.len()),
            BusOperation::Read { address, count } => format!("read of {count} at {address:#06x}"),
            BusOperation::Wait { clocks } => format!("wait of {clocks}"),
        });
        Err(CosimError::Bus { index, operation, reason, clock })
    }

    /// Writes one word.
    ///
    /// # Errors
    /// As [`Self::bus`].
    pub fn bus_write(&mut self, address: u32, data: u32) -> Result<(), CosimError> {
        self.bus(&[BusOperation::Write { address, data: vec![data] }]).map(|_| ())
    }

    /// Reads one word.
    ///
    /// # Errors
    /// As [`Self::bus`].
    pub fn bus_read(&mut self, address: u32) -> Result<u32, CosimError> {
        Ok(self.bus(&[BusOperation::Read { address, count: 1 }])?[0])
    }

    /// Reads consecutive words as one burst.
    ///
    /// # Errors
    /// As [`Self::bus`].
    pub fn bus_burst_read(&mut self, address: u32, count: u32) -> Result<Vec<u32>, CosimError> {
        self.bus(&[BusOperation::Read { address, count }])
    }
}
