//! The lines, in their order.

use super::LoadError;
use crate::pci::{Bar, PciCard, PciError};
use crate::plx9030::{Bridge, DONE, GPIO_CONTROL, INIT, LED, PROGRAM, WRITE};
use std::time::Duration;

/// PROGRAM stays low this long; 300 ns are required.
const PROGRAM_LOW: Duration = Duration::from_micros(10);
/// INIT rises within 100 µs of PROGRAM.
const INIT_TIMEOUT: Duration = Duration::from_millis(20);
/// DONE rises while the dummy words at the end are sent.
const DONE_TIMEOUT: Duration = Duration::from_millis(5);
/// Time between two looks at a line.
const LOOK: Duration = Duration::from_micros(20);
/// Bytes between two reports of progress.
const REPORT: usize = 4_096;

/// The lines, or an error where nobody answers.
fn lines<C: PciCard>(card: &mut C, when: &'static str) -> Result<u32, LoadError> {
    match Bridge::new(card).read(GPIO_CONTROL)? {
        u32::MAX => Err(LoadError::Absent { when }),
        lines => Ok(lines),
    }
}

/// Waits until a line is high; the last look counts, however late it is.
fn wait<C: PciCard>(
    card: &mut C,
    line: u32,
    limit: Duration,
    when: &'static str,
) -> Result<Option<Duration>, LoadError> {
    let begun = card.now();
    loop {
        let late = card.now().saturating_sub(begun);
        if lines(card, when)? & line != 0 {
            return Ok(None);
        }
        if late >= limit {
            return Ok(Some(late));
        }
        card.sleep(LOOK);
    }
}

/// Clears the FPGA and makes it ready for bytes; returns the spaces whose READY# was off.
pub(super) fn prepare<C: PciCard>(card: &mut C) -> Result<u32, LoadError> {
    lines(card, "before loading")?;
    let ready_enabled = Bridge::new(card).enable_ready()?;
    Bridge::new(card).set_lines(WRITE | LED, PROGRAM)?;
    card.sleep(PROGRAM_LOW);
    let cleared = lines(card, "while the FPGA is cleared")?;
    for (line, name) in [(DONE, "DONE"), (INIT, "INIT")] {
        if cleared & line != 0 {
            return Err(LoadError::NotCleared { line: name });
        }
    }
    Bridge::new(card).set_lines(PROGRAM, 0)?;
    if let Some(waited) = wait(card, INIT, INIT_TIMEOUT, "while waiting for INIT")? {
        return Err(LoadError::StuckInit { waited });
    }
    Bridge::new(card).set_lines(0, WRITE | LED)?;
    Ok(ready_enabled)
}

/// Sends every byte.
pub(super) fn send<C: PciCard>(card: &mut C, lanes: &[u8], progress: &mut impl FnMut(usize)) -> Result<(), PciError> {
    let bar = if card.has(Bar::Memory32) { Bar::Memory32 } else { Bar::Ports16 };
    for (index, chunk) in lanes.chunks(REPORT).enumerate() {
        progress(index * REPORT);
        for &byte in chunk {
            card.write8(bar, 0, byte)?;
        }
    }
    progress(lanes.len());
    Ok(())
}

/// Looks at what came of the bytes, and lets the design run.
pub(super) fn finish<C: PciCard>(card: &mut C) -> Result<(), LoadError> {
    const WHEN: &str = "after the last byte";
    if lines(card, WHEN)? & INIT == 0 {
        return Err(LoadError::Crc);
    }
    if let Some(waited) = wait(card, DONE, DONE_TIMEOUT, WHEN)? {
        // A late CRC error is one as well.
        return Err(if lines(card, WHEN)? & INIT == 0 { LoadError::Crc } else { LoadError::NotDone { waited } });
    }
    Ok(Bridge::new(card).set_lines(WRITE | LED, 0)?)
}

/// Whether the bridge answers and says that the FPGA runs a design.
pub(super) fn configured<C: PciCard>(card: &mut C) -> Result<bool, LoadError> {
    let lines = Bridge::new(card).read(GPIO_CONTROL)?;
    Ok(lines != u32::MAX && lines & DONE != 0)
}

/// Holds PROGRAM low: the FPGA stays clear and its pins float.
pub(super) fn clear<C: PciCard>(card: &mut C) -> Result<(), LoadError> {
    lines(card, "while the FPGA is cleared")?;
    Ok(Bridge::new(card).set_lines(WRITE | LED, PROGRAM)?)
}
