//! What the two pin-level FPGAs share: knowing when the control tick is, and playing edges.
//!
//! ```text
//!  tick ──program──host: snapshot, set points──│────── encoders move ──────│ tick
//!  0              980                    QUIET_CLOCKS                    period
//! ```

use super::edges::{Motion, lines};
use super::{Fpga, FpgaError, Kind, check_motion};
use driver::{BusError, Registers};
use fixed_kin::AXES;
use fixed_kin::registers::{ENCODER_FILTER, MIN_TICK_PERIOD, SNAPSHOT_SEQUENCE, SNAPSHOT_WORDS, TICK_PERIOD};
use fixed_kin::speed::TIME_BITS;

/// Clocks after a control tick in which the encoders of the pin-level backends stand still: the
/// program (980), a snapshot and a commit over the bus, and some.
pub const QUIET_CLOCKS: u32 = 1_400;
/// Clocks after a tick in which the program certainly ends.
const PROGRAM_CLOCKS: u64 = 1_000;

/// Levels of all encoder lines from a clock on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Lines {
    /// First rising edge that samples them, from power-up.
    pub clock: u64,
    /// Lines A, a bit per axis.
    pub a: u32,
    /// Lines B, a bit per axis.
    pub b: u32,
}

/// A simulated chip with pins.
pub(super) trait Chip {
    /// Rising clock edges since power-up.
    fn clock(&self) -> u64;
    /// Encoder lines to play, in the order of time; bus cycles play them too.
    fn schedule(&mut self, lines: &[Lines]) -> Result<(), FpgaError>;
    /// Lets clocks pass.
    fn run(&mut self, clocks: u64) -> Result<(), FpgaError>;
    /// Reads consecutive words in one burst.
    fn read(&mut self, offset: u16, words: &mut [u32]) -> Result<(), FpgaError>;
    /// Writes a word.
    fn write(&mut self, offset: u16, data: u32) -> Result<(), FpgaError>;
}

/// A chip as an [`Fpga`].
#[derive(Debug)]
pub(super) struct PinLevel<C> {
    kind: Kind,
    chip: C,
    positions: [f64; AXES],
    levels: [u32; AXES],
    /// Clock of the last tick, period and filter; forgotten when the host sets the period.
    last_tick: Option<(u64, u32, u8)>,
}

impl<C: Chip> PinLevel<C> {
    pub(super) fn new(kind: Kind, chip: C) -> Self {
        Self { kind, chip, positions: [0.0; AXES], levels: [0; AXES], last_tick: None }
    }

    fn read_one(&mut self, offset: u16) -> Result<u32, FpgaError> {
        let mut word = [0];
        self.chip.read(offset, &mut word)?;
        Ok(word[0])
    }

    /// Waits for a tick and reads its time from the snapshot.
    fn align(&mut self) -> Result<(u64, u32, u8), FpgaError> {
        let period = self.read_one(TICK_PERIOD.offset)?.max(MIN_TICK_PERIOD);
        let filter = self.read_one(ENCODER_FILTER.offset)? as u8;
        self.chip.run(u64::from(period) + PROGRAM_CLOCKS)?;
        let mut words = [0; SNAPSHOT_WORDS];
        self.chip.read(SNAPSHOT_SEQUENCE.offset, &mut words)?;
        let age = (self.chip.clock() as u32).wrapping_sub(words[2]) & ((1 << TIME_BITS) - 1);
        let seen = self.chip.clock() - u64::from(age);
        // Go on to the next tick, so that the host finds all of a quiet time before it.
        let next = seen + u64::from(period);
        self.chip.run(next + PROGRAM_CLOCKS - self.chip.clock().min(next))?;
        Ok((next, period, filter))
    }

    fn play(&mut self, tick: u64, period: u32, positions: &[f64; AXES]) -> Result<(), FpgaError> {
        let mut changes: Vec<(u64, usize, u32)> = Vec::new();
        for (axis, (&from, &to)) in self.positions.iter().zip(positions).enumerate() {
            let motion = Motion::new(from, to, period, QUIET_CLOCKS);
            changes.extend(motion.edges().map(|edge| (tick + 1 + u64::from(edge.clock), axis, lines(edge.count))));
        }
        changes.sort_unstable();
        let mut scheduled: Vec<Lines> = Vec::with_capacity(changes.len());
        for (clock, axis, level) in changes {
            self.levels[axis] = level;
            let bit =
                |n: u32| self.levels.iter().enumerate().fold(0, |word, (i, level)| word | ((level >> n) & 1) << i);
            let now = Lines { clock, a: bit(0), b: bit(1) };
            match scheduled.last_mut() {
                Some(last) if last.clock == clock => *last = now,
                _ => scheduled.push(now),
            }
        }
        self.positions = *positions;
        self.chip.schedule(&scheduled)
    }
}

impl<C: Chip> Registers for PinLevel<C> {
    fn read(&mut self, offset: u16) -> Result<u32, BusError> {
        self.read_one(offset).map_err(|error| BusError::read(offset, error))
    }

    fn write(&mut self, offset: u16, data: u32) -> Result<(), BusError> {
        if offset == TICK_PERIOD.offset || offset == ENCODER_FILTER.offset {
            self.last_tick = None;
        }
        self.chip.write(offset, data).map_err(|error| BusError::write(offset, error))
    }

    fn read_block(&mut self, offset: u16, words: &mut [u32]) -> Result<(), BusError> {
        self.chip.read(offset, words).map_err(|error| BusError::read(offset, error))
    }
}

impl<C: Chip> Fpga for PinLevel<C> {
    fn kind(&self) -> Kind {
        self.kind
    }

    fn advance(&mut self, positions: &[f64; AXES]) -> Result<(), FpgaError> {
        let (tick, period, filter) = match self.last_tick {
            Some(known) => known,
            None => self.align()?,
        };
        let late = self.chip.clock() - tick;
        if late > u64::from(QUIET_CLOCKS) && self.positions != *positions {
            return Err(FpgaError::Late { clocks: late, quiet: QUIET_CLOCKS });
        }
        for (axis, (&from, &to)) in self.positions.iter().zip(positions).enumerate() {
            check_motion(axis, from, to, period, QUIET_CLOCKS, filter)?;
        }
        self.play(tick, period, positions)?;
        // A host that sets up a robot at rest may take several periods.
        let next = tick + late.div_ceil(u64::from(period)).max(1) * u64::from(period);
        self.chip.run(next + PROGRAM_CLOCKS - self.chip.clock())?;
        self.last_tick = Some((next, period, filter));
        Ok(())
    }

    fn quiet_clocks(&self) -> u32 {
        QUIET_CLOCKS
    }
}

/// A newtype around a [`PinLevel`] is an FPGA.
macro_rules! forward_to_pin_level {
    ($fpga:ty) => {
        impl driver::Registers for $fpga {
            fn read(&mut self, offset: u16) -> Result<u32, driver::BusError> {
                self.0.read(offset)
            }
            fn write(&mut self, offset: u16, data: u32) -> Result<(), driver::BusError> {
                self.0.write(offset, data)
            }
            fn read_block(&mut self, offset: u16, words: &mut [u32]) -> Result<(), driver::BusError> {
                self.0.read_block(offset, words)
            }
        }

        impl super::Fpga for $fpga {
            fn kind(&self) -> Kind {
                self.0.kind()
            }
            fn advance(&mut self, positions: &[f64; fixed_kin::AXES]) -> Result<(), FpgaError> {
                self.0.advance(positions)
            }
            fn quiet_clocks(&self) -> u32 {
                self.0.quiet_clocks()
            }
        }
    };
}
pub(super) use forward_to_pin_level;
