//! A running simulation: set pins, advance clocks, play and record pin changes, use the bus.
//!
//! One process a session, state from power-up on. Nothing crosses the pipe per clock: commands say
//! how far to run, pin changes are scheduled ahead, and the bus master runs beside the design.

use super::bus_config::BusConfig;
use super::layout::{Clocks, Layout};
use super::{CosimError, folder};
use std::io::{BufReader, BufWriter, Read, Write};
use std::ops::ControlFlow;
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::sync_channel;

/// Words in a chunk of a batch; enough that the pipe's cost vanishes, small enough for the cache.
const CHUNK: usize = 1 << 15;

pub(crate) mod command {
    //! The first word of a command, as in `harness.cpp`.
    pub(crate) const BATCH: u32 = 1;
    pub(crate) const SET: u32 = 2;
    pub(crate) const GET: u32 = 3;
    pub(crate) const RUN: u32 = 4;
    pub(crate) const STEPS: u32 = 5;
    pub(crate) const SCHEDULE: u32 = 6;
    pub(crate) const RECORD: u32 = 7;
    pub(crate) const TAKE: u32 = 8;
    pub(crate) const PATTERN: u32 = 9;
    pub(crate) const BUS_PORTS: u32 = 10;
    pub(crate) const BUS: u32 = 11;
}

/// A change of a pin.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Change {
    /// Rising edges of the main clock before it. An input that changes at clock n is first sampled
    /// by edge n; an output that changes at clock n changed because of edge n.
    pub clock: u64,
    /// Column of the input or output in the [`Layout`].
    pub port: usize,
    /// The new value.
    pub value: u32,
}

/// A design under simulation. Dropping it ends the process.
#[derive(Debug)]
pub struct Session {
    name: String,
    layout: Layout,
    child: Child,
    input: BufWriter<ChildStdin>,
    output: BufReader<ChildStdout>,
    clock: u64,
    per_step: bool,
    pub(crate) bus_attached: bool,
}

impl Drop for Session {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

impl Session {
    pub(crate) fn start(name: &str, program: &Path, layout: Layout) -> Result<Self, CosimError> {
        let mut command = Command::new(program);
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().map_err(|e| folder::not_started("simulation", program, e))?;
        let (Some(input), Some(output)) = (child.stdin.take(), child.stdout.take()) else {
            unreachable!("both streams were asked for as pipes");
        };
        let input = BufWriter::with_capacity(1 << 17, input);
        let output = BufReader::with_capacity(1 << 17, output);
        let mut session =
            Self { name: name.into(), layout, child, input, output, clock: 0, per_step: false, bus_attached: false };
        // The bus must idle from the first clock on.
        match session.attach_bus(&BusConfig::default()) {
            Ok(()) | Err(CosimError::NoPort { .. }) => Ok(session),
            Err(error) => Err(error),
        }
    }

    /// The columns of inputs and outputs.
    #[must_use]
    pub fn layout(&self) -> &Layout {
        &self.layout
    }

    /// Rising edges of the main clock (the first of the layout's clocks) since power-up, as of the
    /// last call that ran the design.
    #[must_use]
    pub fn clock(&self) -> u64 {
        self.clock
    }

    /// How the clocks run from now on.
    ///
    /// # Errors
    /// If the process has ended.
    pub fn set_clocks(&mut self, clocks: &Clocks) -> Result<(), CosimError> {
        self.per_step = *clocks == Clocks::PerStep;
        let pattern = match clocks {
            Clocks::Repeat(levels) if !levels.is_empty() => levels.iter().map(|l| l.word()).collect(),
            _ => vec![(1u32 << self.layout.clocks.len()) - 1],
        };
        self.send(&[command::PATTERN])?;
        self.send_list(&pattern)
    }

    /// Sets inputs by column; they hold until set again and count from the next edge on.
    ///
    /// # Errors
    /// If the process has ended.
    pub fn set(&mut self, inputs: &[(usize, u32)]) -> Result<(), CosimError> {
        let pairs = inputs.iter().flat_map(|(port, value)| [word(*port), *value]);
        let message: Vec<_> = [command::SET, word(inputs.len())].into_iter().chain(pairs).collect();
        self.send(&message)
    }

    /// Sets one input by name.
    ///
    /// # Errors
    /// If there is no such input or the process has ended.
    pub fn set_port(&mut self, name: &str, value: u32) -> Result<(), CosimError> {
        let port = self.layout.input(name)?;
        self.set(&[(port, value)])
    }

    /// Reads outputs by column.
    ///
    /// # Errors
    /// If the process has ended.
    pub fn get(&mut self, outputs: &[usize]) -> Result<Vec<u32>, CosimError> {
        let columns: Vec<_> = outputs.iter().map(|port| word(*port)).collect();
        self.send(&[command::GET])?;
        self.send_list(&columns)?;
        self.receive(outputs.len())
    }

    /// Reads one output by name.
    ///
    /// # Errors
    /// If there is no such output or the process has ended.
    pub fn get_port(&mut self, name: &str) -> Result<u32, CosimError> {
        let port = self.layout.output(name)?;
        Ok(self.get(&[port])?[0])
    }

    /// Runs this many rising edges of the main clock; none if the clocks' pattern never raises it.
    ///
    /// # Errors
    /// If the process has ended.
    pub fn run(&mut self, clocks: u64) -> Result<(), CosimError> {
        self.advance(command::RUN, clocks)
    }

    /// Runs this many steps of the clocks' pattern, whatever the main clock does in them.
    ///
    /// # Errors
    /// If the process has ended.
    pub fn run_steps(&mut self, steps: u64) -> Result<(), CosimError> {
        self.advance(command::STEPS, steps)
    }

    fn advance(&mut self, command: u32, count: u64) -> Result<(), CosimError> {
        let [low, high] = halves(count);
        self.send(&[command, low, high])?;
        let now = self.receive(2)?;
        self.clock = whole(now[0], now[1]);
        Ok(())
    }

    /// Schedules input changes at absolute clock numbers, in any order; whatever runs the design
    /// (bus cycles too) plays them when they are due.
    ///
    /// # Errors
    /// If the process has ended.
    pub fn schedule(&mut self, changes: &[Change]) -> Result<(), CosimError> {
        let mut message = vec![command::SCHEDULE, word(changes.len())];
        for change in changes {
            let [low, high] = halves(change.clock);
            message.extend([low, high, word(change.port), change.value]);
        }
        self.send(&message)
    }

    /// Records changes of these outputs from now on; an empty list stops it.
    ///
    /// # Errors
    /// If the process has ended.
    pub fn record(&mut self, outputs: &[usize]) -> Result<(), CosimError> {
        let columns: Vec<_> = outputs.iter().map(|port| word(*port)).collect();
        self.send(&[command::RECORD])?;
        self.send_list(&columns)
    }

    /// The changes recorded since the last call, in order of time.
    ///
    /// # Errors
    /// If the process has ended.
    pub fn take_recorded(&mut self) -> Result<Vec<Change>, CosimError> {
        self.send(&[command::TAKE])?;
        let count = self.receive(1)?[0] as usize;
        let words = self.receive(count * 4)?;
        let change = |w: &[u32]| Change { clock: whole(w[0], w[1]), port: w[2] as usize, value: w[3] };
        Ok(words.chunks_exact(4).map(change).collect())
    }

    /// Runs `clocks` while playing input changes, whose clocks count from now, and gives the
    /// changes of the recorded outputs, counted likewise.
    ///
    /// # Errors
    /// If the process has ended.
    pub fn play(&mut self, clocks: u64, changes: &[Change]) -> Result<Vec<Change>, CosimError> {
        let start = self.clock;
        let absolute: Vec<_> = changes.iter().map(|c| Change { clock: c.clock.saturating_add(start), ..*c }).collect();
        self.schedule(&absolute)?;
        self.run(clocks)?;
        let mut recorded = self.take_recorded()?;
        for change in &mut recorded {
            change.clock = change.clock.saturating_sub(start);
        }
        Ok(recorded)
    }

    /// Goes on from the present state over a stimulus, one row a step, and gives one row of outputs
    /// a step.
    ///
    /// # Errors
    /// If the stimulus does not divide into rows or the process has ended.
    pub fn run_batch(&mut self, stimulus: &[u32]) -> Result<Vec<u32>, CosimError> {
        let columns = self.columns();
        let rows = self.layout.rows(stimulus.len(), columns)?;
        let mut response = Vec::with_capacity(rows * self.layout.outputs.len());
        let fill = |row: u64, words: &mut [u32]| {
            let at = usize::try_from(row).unwrap_or(usize::MAX) * columns;
            words.copy_from_slice(&stimulus[at..at + columns]);
        };
        self.stream(rows as u64, fill, |_, _, outputs| {
            response.extend_from_slice(outputs);
            ControlFlow::Continue(())
        })?;
        Ok(response)
    }

    /// Runs `steps` rows without holding them: `fill` writes the row of a step (on a thread of its
    /// own, in order), `check` sees step, inputs and outputs, and may stop the run; up to two
    /// chunks of steps may then already have run.
    ///
    /// # Errors
    /// If the process has ended.
    pub fn stream(
        &mut self,
        steps: u64,
        mut fill: impl FnMut(u64, &mut [u32]) + Send,
        mut check: impl FnMut(u64, &[u32], &[u32]) -> ControlFlow<()>,
    ) -> Result<(), CosimError> {
        let (columns, answers) = (self.columns(), self.layout.outputs.len());
        let rows = (CHUNK / (columns + answers).max(1)).max(1) as u64;
        let per_step = u32::from(self.per_step);
        let stop = AtomicBool::new(false);
        // Writer and reader run apart: a pipe that is full in both directions never moves again.
        let (sender, chunks) = sync_channel::<(usize, Vec<u32>)>(2);
        let result = std::thread::scope(|scope| {
            let guard = KillOnPanic(&mut self.child);
            let input = &mut self.input;
            let writer = scope.spawn({
                let stop = &stop;
                move || -> std::io::Result<()> {
                    let mut step = 0;
                    while step < steps && !stop.load(Ordering::Relaxed) {
                        let count = rows.min(steps - step);
                        let length = usize::try_from(count).unwrap_or(CHUNK);
                        let mut chunk = vec![0; length * columns];
                        for n in 0..length {
                            fill(step + n as u64, &mut chunk[n * columns..(n + 1) * columns]);
                        }
                        write_words(input, &[command::BATCH, word(length), per_step])?;
                        write_words(input, &chunk)?;
                        input.flush()?;
                        step += count;
                        if sender.send((length, chunk)).is_err() {
                            break;
                        }
                    }
                    Ok(())
                }
            });
            let mut step = 0;
            let mut outcome = Ok(());
            for (count, chunk) in &chunks {
                match read_words(&mut self.output, count * answers) {
                    Err(error) => {
                        outcome = Err(error);
                        break;
                    }
                    Ok(response) => {
                        for n in 0..count {
                            if stop.load(Ordering::Relaxed) {
                                break;
                            }
                            let row = &chunk[n * columns..(n + 1) * columns];
                            let answer = &response[n * answers..(n + 1) * answers];
                            if check(step + n as u64, row, answer).is_break() {
                                stop.store(true, Ordering::Relaxed);
                            }
                        }
                        step += count as u64;
                    }
                }
            }
            drop(chunks);
            drop(guard);
            let written = writer.join().unwrap_or(Ok(()));
            outcome.and(written)
        });
        result.map_err(|source| self.ended(source))
    }

    fn columns(&self) -> usize {
        self.layout.inputs.len() + usize::from(self.per_step)
    }

    pub(crate) fn set_clock(&mut self, clock: u64) {
        self.clock = clock;
    }

    pub(crate) fn send(&mut self, words: &[u32]) -> Result<(), CosimError> {
        write_words(&mut self.input, words).map_err(|source| self.ended(source))
    }

    fn send_list(&mut self, words: &[u32]) -> Result<(), CosimError> {
        self.send(&[word(words.len())])?;
        self.send(words)
    }

    pub(crate) fn receive(&mut self, count: usize) -> Result<Vec<u32>, CosimError> {
        let flushed = self.input.flush();
        flushed.and_then(|()| read_words(&mut self.output, count)).map_err(|source| self.ended(source))
    }

    fn ended(&mut self, source: std::io::Error) -> CosimError {
        let _ = self.child.kill();
        let mut output = String::new();
        if let Some(stream) = &mut self.child.stderr {
            let _ = stream.read_to_string(&mut output);
        }
        CosimError::Ended { name: self.name.clone(), source, output }
    }
}

/// A check that panics must not leave the writer waiting for a process that nobody reads.
struct KillOnPanic<'a>(&'a mut Child);

impl Drop for KillOnPanic<'_> {
    fn drop(&mut self) {
        if std::thread::panicking() {
            let _ = self.0.kill();
        }
    }
}

fn write_words(to: &mut impl Write, words: &[u32]) -> std::io::Result<()> {
    let mut bytes = [0; 4096];
    for part in words.chunks(bytes.len() / 4) {
        for (to, from) in bytes.chunks_exact_mut(4).zip(part) {
            to.copy_from_slice(&from.to_le_bytes());
        }
        to.write_all(&bytes[..part.len() * 4])?;
    }
    Ok(())
}

fn read_words(from: &mut impl Read, count: usize) -> std::io::Result<Vec<u32>> {
    let mut bytes = vec![0; count * 4];
    from.read_exact(&mut bytes)?;
    Ok(bytes.chunks_exact(4).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect())
}

/// A count or column as a protocol word.
pub(crate) fn word(value: usize) -> u32 {
    u32::try_from(value).unwrap_or(u32::MAX)
}

fn halves(value: u64) -> [u32; 2] {
    let bytes = value.to_le_bytes();
    [0, 4].map(|at| u32::from_le_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]]))
}

pub(crate) fn whole(low: u32, high: u32) -> u64 {
    u64::from(low) | u64::from(high) << 32
}
