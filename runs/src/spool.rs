//! Ticks of long logs in an unnamed file, column after column, so that any ticks of any column are read again at once.

use std::fs::File;
use std::io;
use std::ops::Range;
use std::os::unix::fs::FileExt;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use super::{Columns, Run};

/// The file that all logs of a data set share; gone when nobody holds it any more.
#[derive(Debug)]
pub(super) struct Spool {
    file: File,
    end: AtomicU64,
}

/// Where some ticks of a log lie.
#[derive(Debug)]
struct Part {
    offset: u64,
    ticks: Range<usize>,
    /// Number of ticks without a sample, one a wheel.
    gaps: Vec<usize>,
}

/// The ticks of one log, without its camera.
#[derive(Debug)]
pub(super) struct Spooled {
    spool: Arc<Spool>,
    /// Which columns there are; no ticks.
    layout: Run,
    parts: Vec<Part>,
}

/// Bytes of a number.
const WIDTH: usize = 8;

impl Spool {
    pub(super) fn new() -> io::Result<Arc<Self>> {
        Ok(Arc::new(Self { file: tempfile::tempfile()?, end: AtomicU64::new(0) }))
    }

    fn read(&self, numbers: usize, offset: u64) -> io::Result<impl Iterator<Item = [u8; WIDTH]>> {
        let mut bytes = vec![0; WIDTH * numbers];
        self.file.read_exact_at(&mut bytes, offset)?;
        Ok((0..numbers).map(move |k| std::array::from_fn(|b| bytes[WIDTH * k + b])))
    }
}

impl Spooled {
    /// Nothing yet, of a log with the columns of `like`.
    pub(super) fn new(spool: Arc<Spool>, like: &Run) -> Self {
        Self { spool, layout: like.emptied(Columns::ALL), parts: Vec::new() }
    }

    /// Number of ticks.
    pub(super) fn len(&self) -> usize {
        self.parts.last().map_or(0, |p| p.ticks.end)
    }

    /// Adds the ticks that follow.
    pub(super) fn push(&mut self, run: &Run) -> io::Result<()> {
        let gaps: usize = run.count_gaps.iter().map(Vec::len).sum();
        let numbers = run.len() * (run.reals().len() + run.counts.len()) + gaps;
        let offset = self.spool.end.fetch_add((WIDTH * numbers) as u64, Ordering::Relaxed);
        let mut end = offset;
        let mut write = |bytes: Vec<u8>| {
            end += bytes.len() as u64;
            self.spool.file.write_all_at(&bytes, end - bytes.len() as u64)
        };
        for column in run.reals() {
            write(column.iter().flat_map(|x| x.to_le_bytes()).collect())?;
        }
        for counts in &run.counts {
            write(counts.iter().flat_map(|x| x.to_le_bytes()).collect())?;
        }
        for gaps in &run.count_gaps {
            write(gaps.iter().flat_map(|x| (*x as u64).to_le_bytes()).collect())?;
        }
        let ticks = self.len()..self.len() + run.len();
        self.layout.note(&run.notes);
        self.parts.push(Part { offset, ticks, gaps: run.count_gaps.iter().map(Vec::len).collect() });
        Ok(())
    }

    /// Some ticks of some columns, as [`Run::part`] has them.
    pub(super) fn part(&self, ticks: Range<usize>, columns: Columns) -> io::Result<Run> {
        let mut out = self.layout.emptied(columns);
        out.other.clear();
        let wanted = self.layout.wanted(columns);
        let reals = wanted.len();
        let from = self.parts.partition_point(|p| p.ticks.end <= ticks.start);
        for part in self.parts[from..].iter().take_while(|p| p.ticks.start < ticks.end) {
            let all = part.ticks.len();
            let a = ticks.start.max(part.ticks.start) - part.ticks.start;
            let b = ticks.end.min(part.ticks.end) - part.ticks.start;
            let column = |index: usize| self.spool.read(b - a, part.offset + (WIDTH * (index * all + a)) as u64);
            let indices = (0..reals).filter(|i| wanted[*i]);
            for (slot, index) in out.reals_mut().into_iter().zip(indices) {
                slot.extend(column(index)?.map(f64::from_le_bytes));
            }
            let mut offset = part.offset + (WIDTH * (reals + part.gaps.len()) * all) as u64;
            for (wheel, number) in part.gaps.iter().enumerate().filter(|_| columns.counts) {
                let before = out.counts[wheel].len();
                out.counts[wheel].extend(column(reals + wheel)?.map(i64::from_le_bytes));
                let gaps = self.spool.read(*number, offset)?.map(|g| u64::from_le_bytes(g) as usize);
                out.count_gaps[wheel].extend(gaps.filter(|g| (a..b).contains(g)).map(|g| before + g - a));
                offset += (WIDTH * number) as u64;
            }
        }
        Ok(out)
    }
}
