//! One FPGA against another: everything the host did and every encoder edge, played again.
//!
//! A [`Traced`] FPGA notes what goes into it and the snapshot of every control tick; [`play`] puts
//! the same into another one and compares word by word. Both see edges at the same clocks only if
//! their encoders stand still equally long after a tick: record with
//! [`crate::fpga::BitTrue::with_quiet_clocks`] for backends with pins.

use crate::error::FpgaError;
use crate::fpga::{Fpga, Kind};
use crate::imu::VirtualImu;
use driver::{BusError, Registers};
use fixed_kin::AXES;
use fixed_kin::registers::{
    self as map, SNAPSHOT_FAULTS, SNAPSHOT_SEQUENCE, SNAPSHOT_SEQUENCE_END, SNAPSHOT_STATUS, SNAPSHOT_TIME,
    SNAPSHOT_WORDS, STATUS_ARMED, TICK_PERIOD,
};
use std::fmt;

const STATUS_WORD: usize = (SNAPSHOT_STATUS.offset - SNAPSHOT_SEQUENCE.offset) as usize / 4;

/// What one control period saw.
#[derive(Clone, Debug, PartialEq)]
pub struct Period {
    /// Registers written before its end, in order.
    pub writes: Vec<(u16, u32)>,
    /// Where the encoders went.
    pub positions: [f64; AXES],
    /// The snapshot of the tick at its end.
    pub snapshot: [u32; SNAPSHOT_WORDS],
    /// Its length in clocks.
    pub clocks: u32,
}

/// Everything that went into an FPGA, and what it answered.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Trace {
    /// What went in, and the snapshot at the end of each control period.
    pub periods: Vec<Period>,
}

impl Trace {
    /// Clocks of all periods.
    #[must_use]
    pub fn clocks(&self) -> u64 {
        self.periods.iter().map(|period| u64::from(period.clocks)).sum()
    }
}

/// An FPGA that notes what goes in and out.
#[derive(Debug)]
pub struct Traced<F> {
    inner: F,
    writes: Vec<(u16, u32)>,
    trace: Trace,
}

impl<F: Fpga> Traced<F> {
    /// Wraps an FPGA just configured.
    pub fn new(inner: F) -> Self {
        Self { inner, writes: Vec::new(), trace: Trace::default() }
    }

    /// What was noted.
    pub fn into_trace(self) -> Trace {
        self.trace
    }
}

impl<F: Fpga> Registers for Traced<F> {
    fn read(&mut self, offset: u16) -> Result<u32, BusError> {
        self.inner.read(offset)
    }
    fn write(&mut self, offset: u16, data: u32) -> Result<(), BusError> {
        self.writes.push((offset, data));
        self.inner.write(offset, data)
    }
    fn read_block(&mut self, offset: u16, words: &mut [u32]) -> Result<(), BusError> {
        self.inner.read_block(offset, words)
    }
}

impl<F: Fpga> Fpga for Traced<F> {
    fn imu(&mut self) -> Option<&mut VirtualImu> {
        self.inner.imu()
    }
    fn kind(&self) -> Kind {
        self.inner.kind()
    }

    fn advance(&mut self, positions: &[f64; AXES]) -> Result<(), FpgaError> {
        let clocks = self.inner.read(TICK_PERIOD.offset)?;
        self.inner.advance(positions)?;
        let snapshot = snapshot(&mut self.inner)?;
        let writes = std::mem::take(&mut self.writes);
        self.trace.periods.push(Period { writes, positions: *positions, snapshot, clocks });
        Ok(())
    }

    fn quiet_clocks(&self) -> u32 {
        self.inner.quiet_clocks()
    }
}

fn snapshot(fpga: &mut impl Fpga) -> Result<[u32; SNAPSHOT_WORDS], BusError> {
    let mut words = [0; SNAPSHOT_WORDS];
    fpga.read_block(SNAPSHOT_SEQUENCE.offset, &mut words)?;
    Ok(words)
}

/// The first word that differs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Difference {
    /// Control period, from 0 after configuration.
    pub period: usize,
    /// Name of the register that differs.
    pub register: &'static str,
    /// Word of it, from 0.
    pub index: usize,
    /// What the trace says.
    pub expected: u32,
    /// What the other FPGA says.
    pub found: u32,
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { period, register, index, expected, found } = self;
        write!(f, "tick {period}: {register}[{index}] is {found:#010x} instead of {expected:#010x}")
    }
}

/// What came out of a comparison.
#[derive(Clone, Debug, PartialEq)]
pub struct CrossCheck {
    /// The FPGA that was compared with the trace.
    pub kind: Kind,
    /// Control ticks compared.
    pub ticks: usize,
    /// Clock cycles simulated for them.
    pub clocks: u64,
    /// Words compared.
    pub words: usize,
    /// Words that change from tick to tick, so that the comparison is known not to be empty.
    pub live_words: usize,
    /// Where they differ first, if they do.
    pub difference: Option<Difference>,
}

/// Plays a trace into another FPGA, just configured, until the first difference; `progress` hears
/// the periods done.
///
/// Sequence numbers and time are not compared, for FPGAs with pins need some ticks to find the
/// first; and faults only once the card is armed, for what stands at power-up depends on the clock
/// at which one looks.
///
/// # Errors
/// [`FpgaError`] where the other FPGA fails.
pub fn play<F: Fpga>(trace: &Trace, mut other: F, mut progress: impl FnMut(usize)) -> Result<CrossCheck, FpgaError> {
    let mut check = CrossCheck { kind: other.kind(), ticks: 0, clocks: 0, words: 0, live_words: 0, difference: None };
    let mut before: Option<&Period> = None;
    for (number, period) in trace.periods.iter().enumerate() {
        for &(offset, data) in &period.writes {
            other.write(offset, data)?;
        }
        other.advance(&period.positions)?;
        let found = snapshot(&mut other)?;
        let armed = STATUS_ARMED.is_set(period.snapshot[STATUS_WORD]);
        check.ticks += 1;
        check.clocks += u64::from(period.clocks);
        for (word, (&expected, &found)) in period.snapshot.iter().zip(&found).enumerate() {
            let offset = SNAPSHOT_SEQUENCE.offset + 4 * word as u16;
            let apart = [SNAPSHOT_SEQUENCE.offset, SNAPSHOT_TIME.offset, SNAPSHOT_SEQUENCE_END.offset];
            if apart.contains(&offset) || (!armed && offset == SNAPSHOT_FAULTS.offset) {
                continue;
            }
            check.words += 1;
            check.live_words += usize::from(before.is_some_and(|before| before.snapshot[word] != expected));
            if expected != found {
                let (register, index) = map::lookup(offset).map_or(("snapshot", word), |(r, index)| (r.name, index));
                check.difference = Some(Difference { period: number, register, index, expected, found });
                return Ok(check);
            }
        }
        before = Some(period);
        progress(number + 1);
    }
    Ok(check)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::closed_loop::Drive;
    use crate::fpga::{BitTrue, QUIET_CLOCKS, RustHdl};
    use fixed_kin::speed::SpeedMode;
    use runs::frames::Twist;

    fn quiet() -> BitTrue {
        BitTrue::new().with_quiet_clocks(QUIET_CLOCKS)
    }

    fn trace(seconds: f64, rate_hz: f64) -> Trace {
        let mut drive = Drive { speed_mode: SpeedMode::CountAndTime, limit_s: seconds, ..Drive::fig_6() };
        drive.moving = Twist::new(0.6, 0.5, 0.5);
        drive.believed.control_rate_hz = rate_hz;
        let mut traced = Traced::new(quiet());
        drive.run(&mut traced, |_| {}).unwrap();
        traced.into_trace()
    }

    #[test]
    fn the_same_fpga_agrees_with_itself() {
        let trace = trace(0.3, 1_000.0);
        let check = play(&trace, quiet(), |_| {}).unwrap();
        assert_eq!((check.difference, check.ticks), (None, 301));
        assert_eq!(check.words, 301 * 21 - 1);
        assert!(check.live_words > 301 * 12, "{check:?}");
    }

    #[test]
    fn rust_hdl_agrees_with_a_robot_in_motion() {
        let trace = trace(if cfg!(debug_assertions) { 0.000_6 } else { 0.004 }, 8_000.0);
        let check = play(&trace, RustHdl::new(), |_| {}).unwrap();
        assert_eq!(check.difference, None);
    }

    #[test]
    fn one_flipped_bit_is_found_and_named() {
        let mut trace = trace(0.05, 1_000.0);
        let duty = usize::from(map::SNAPSHOT_DUTY.offset - SNAPSHOT_SEQUENCE.offset) / 4;
        trace.periods[30].snapshot[duty + 2] ^= 1;
        let difference = play(&trace, quiet(), |_| {}).unwrap().difference.unwrap();
        assert_eq!((difference.period, difference.register, difference.index), (30, "snapshot_duty", 2));
        assert!(difference.to_string().starts_with("tick 30: snapshot_duty[2] is 0x"), "{difference}");
    }
}
