//! The rust-hdl core as an FPGA: simulated clock by clock, with a bus master on its pins.

use super::pin_level::{Chip, Lines, PinLevel, forward_to_pin_level};
use super::{FpgaError, Kind};
use driver::BusError;
use hdl::blocks::core::Core;
use hdl::sim::cycle;
use rust_hdl::prelude::*;
use std::collections::VecDeque;

/// Clocks a word may wait for READY#.
const MAX_WAIT: u32 = 256;

/// `hdl::blocks::core::Core` behind its pins.
pub struct RustHdl(PinLevel<Simulated>);

struct Simulated {
    core: Box<Core>,
    clock: u64,
    scheduled: VecDeque<Lines>,
}

impl Default for RustHdl {
    fn default() -> Self {
        Self::new()
    }
}

impl RustHdl {
    /// A core just configured.
    #[must_use]
    pub fn new() -> Self {
        let mut core = Box::new(hdl::design::core());
        core.ads_n.next = true;
        core.blast_n.next = true;
        core.emergency_stop.next = false;
        core.host_select.next = true;
        core.radio_rx.next = true;
        core.imu_miso.next = true;
        core.imu_ready.next = true;
        Self(PinLevel::new(Kind::RustHdl, Simulated { core, clock: 0, scheduled: VecDeque::new() }))
    }
}

impl Simulated {
    /// One clock; both clocks of the chip rise together.
    fn step(&mut self) {
        while let Some(lines) = self.scheduled.front().filter(|lines| lines.clock <= self.clock) {
            self.core.encoder_a.next = u64::from(lines.a).to_bits();
            self.core.encoder_b.next = u64::from(lines.b).to_bits();
            self.scheduled.pop_front();
        }
        cycle(&mut *self.core, |core, level| {
            core.lclk.next = level.into();
            core.synclk.next = level.into();
        });
        self.clock += 1;
    }

    fn address(&mut self, offset: u16, write: bool) {
        self.core.ads_n.next = false;
        self.core.lw_r.next = write;
        self.core.lad_in.next = u64::from(offset).to_bits();
        self.step();
        self.core.ads_n.next = true;
    }

    /// One word of the data phase: what the core drives in the clock in which READY# is low.
    fn word(&mut self, last: bool) -> Result<u32, FpgaError> {
        self.core.blast_n.next = !last;
        for _ in 0..MAX_WAIT {
            let (ready, data) = (!self.core.ready_n.val(), self.core.lad_out.val().index() as u32);
            self.step();
            if ready {
                self.core.blast_n.next = true;
                return Ok(data);
            }
        }
        Err(FpgaError::Bus(BusError::read(0, format!("READY# did not come in {MAX_WAIT} clocks"))))
    }
}

impl Chip for Simulated {
    fn clock(&self) -> u64 {
        self.clock
    }

    fn schedule(&mut self, lines: &[Lines]) -> Result<(), FpgaError> {
        self.scheduled.extend(lines);
        Ok(())
    }

    fn run(&mut self, clocks: u64) -> Result<(), FpgaError> {
        for _ in 0..clocks {
            self.step();
        }
        Ok(())
    }

    fn read(&mut self, offset: u16, words: &mut [u32]) -> Result<(), FpgaError> {
        self.address(offset, false);
        let count = words.len();
        for (index, word) in words.iter_mut().enumerate() {
            *word = self.word(index + 1 == count)?;
        }
        self.step();
        Ok(())
    }

    fn write(&mut self, offset: u16, data: u32) -> Result<(), FpgaError> {
        self.address(offset, true);
        self.core.lad_in.next = u64::from(data).to_bits();
        self.word(true)?;
        self.step();
        Ok(())
    }
}

forward_to_pin_level!(RustHdl);
