//! A recording in memory that can be cut off anywhere, as a kill does to a file.

use runs::{CsvStream, Layout, McapStream, Run, RunStream, Tick};
use std::io::{self, Cursor, Seek, SeekFrom, Write};
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};

/// Ticks between two flushes.
const FLUSH_TICKS: u64 = 50;

#[derive(Clone, Debug, Default)]
struct Bytes(Arc<Mutex<Cursor<Vec<u8>>>>);

impl Bytes {
    fn with<T>(&self, f: impl FnOnce(&mut Cursor<Vec<u8>>) -> T) -> T {
        f(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

impl Write for Bytes {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.with(|cursor| cursor.write(bytes))
    }
    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Seek for Bytes {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.with(|cursor| cursor.seek(to))
    }
}

/// How long the bytes were when so many ticks had been flushed.
type Marks = Arc<Mutex<Vec<(usize, u64)>>>;

/// What a recording left behind.
#[derive(Clone, Debug)]
pub(super) struct Memory {
    mcap: bool,
    bytes: Bytes,
    marks: Marks,
}

struct Marked {
    stream: Box<dyn RunStream>,
    bytes: Bytes,
    marks: Marks,
    ticks: u64,
}

impl Memory {
    /// A stream, and what will be left of it.
    pub(super) fn stream(mcap: bool, layout: Layout) -> io::Result<(Box<dyn RunStream>, Self)> {
        let memory = Self { mcap, bytes: Bytes::default(), marks: Marks::default() };
        let bytes = memory.bytes.clone();
        let stream: Box<dyn RunStream> = if mcap {
            Box::new(McapStream::new(bytes.clone(), layout, 0)?)
        } else {
            Box::new(CsvStream::new(bytes.clone(), layout)?)
        };
        Ok((Box::new(Marked { stream, bytes, marks: Arc::clone(&memory.marks), ticks: 0 }), memory))
    }

    /// Reads what a kill at a share of the file would have left; says what is wrong with it.
    pub(super) fn cut(&self, share: f64) -> Result<(), String> {
        let all = self.bytes.with(|cursor| cursor.get_ref().clone());
        let marks = self.marks.lock().unwrap_or_else(PoisonError::into_inner).clone();
        let mut cut = (share.clamp(0.0, 1.0) * all.len() as f64) as usize;
        let mark = marks.iter().rev().find(|(length, _)| *length <= cut).copied();
        if !self.mcap {
            // Lines leave the process in one call per flush: a kill falls between two.
            cut = mark.map_or(0, |(length, _)| length);
        }
        let Some((_, flushed)) = mark.filter(|(_, ticks)| *ticks > 0) else { return Ok(()) };
        let name = Path::new(if self.mcap { "cut.mcap" } else { "cut.csv" });
        let run = Run::from_bytes(&all[..cut], name).map_err(|error| error.to_string())?;
        if (run.len() as u64) < flushed {
            return Err(format!("{} of {flushed} flushed ticks are readable", run.len()));
        }
        if !run.t.windows(2).all(|pair| pair[0] < pair[1]) {
            return Err("time does not increase".to_owned());
        }
        Ok(())
    }
}

impl RunStream for Marked {
    fn tick(&mut self, tick: &Tick<'_>) -> io::Result<()> {
        self.stream.tick(tick)?;
        self.ticks += 1;
        if self.ticks.is_multiple_of(FLUSH_TICKS) { self.flush() } else { Ok(()) }
    }

    fn flush(&mut self) -> io::Result<()> {
        self.stream.flush()?;
        let length = self.bytes.with(|cursor| cursor.get_ref().len());
        self.marks.lock().unwrap_or_else(PoisonError::into_inner).push((length, self.ticks));
        Ok(())
    }

    fn finish(&mut self) -> io::Result<()> {
        self.flush()?;
        self.stream.finish()
    }
}
