//! The open board's logic behind its serial line: bytes on pins, registers on top.

use driver::{BusError, Registers};
use fixed_kin::serial_host::{CLOCKS_PER_BIT, LONGEST_REPLY, Reply, read_request, reply, write_request};
use hdl::design::{COMMITTED_OPEN_BOARD, COMMITTED_VERILOG};
use hdl::emit::open_board::NAME;
use hdl::emit::ports::Ports;
use simulator::cosim::{Change, CosimError, Session, Verilated};

/// Clocks of a byte on the line.
pub const BYTE: u64 = 10 * CLOCKS_PER_BIT as u64;

/// The compiled board without its PLL: both clocks are one here.
#[derive(Debug)]
pub struct OpenBoard {
    /// The board's pins.
    pub session: Session,
    rx: usize,
}

/// A request that was not answered as it should be.
#[derive(Debug, thiserror::Error)]
enum SerialError {
    #[error(transparent)]
    Simulation(#[from] CosimError),
    #[error("the board answered {0:?}")]
    Answer(Option<Reply>),
}

/// Top, serial host and core in one text.
#[must_use]
pub fn verilog() -> String {
    [COMMITTED_OPEN_BOARD, COMMITTED_VERILOG].join("\n")
}

impl OpenBoard {
    /// Compiles the board, once per content, and powers it up with a quiet line.
    ///
    /// # Errors
    /// A missing Verilator, or a compilation that fails.
    pub fn new() -> Result<Self, CosimError> {
        let (text, top) = (verilog(), format!("{NAME}_logic"));
        let ports = Ports::parse(&text, &top, &["clock", "crystal"])?;
        let mut session = Verilated::build(NAME, &text, &top, &ports)?.start()?;
        let (rx, tx) = (session.layout().input("rx")?, session.layout().output("tx")?);
        session.set(&[(rx, 1)])?;
        session.set_port("emergency_stop", 0)?;
        session.set_port("host_select", 1)?;
        session.set_port("radio_rx", 1)?;
        session.run(2)?;
        session.record(&[tx])?;
        Ok(Self { session, rx })
    }

    /// Puts bytes on the line and gives those that come back within the time of the longest reply.
    ///
    /// # Errors
    /// If the simulation has ended.
    pub fn exchange(&mut self, bytes: &[u8]) -> Result<Vec<u8>, CosimError> {
        let bit = u64::from(CLOCKS_PER_BIT);
        let mut changes = Vec::new();
        for (index, byte) in (0..).zip(bytes) {
            let frame = u32::from(*byte) << 1 | 1 << 9;
            changes.extend((0..10).map(|n| Change {
                clock: index * BYTE + n * bit,
                port: self.rx,
                value: frame >> n & 1,
            }));
        }
        let sent = bytes.len() as u64 * BYTE;
        let answer = self.session.play(sent + (LONGEST_REPLY as u64 + 1) * BYTE, &changes)?;
        Ok(bytes_of(&answer))
    }

    fn ask(&mut self, request: &[u8]) -> Result<Option<Reply>, SerialError> {
        Ok(reply(&self.exchange(request)?))
    }
}

/// The bytes in the level changes of an idle-high line.
fn bytes_of(changes: &[Change]) -> Vec<u8> {
    let level = |clock: u64| changes.iter().rev().find(|change| change.clock <= clock).map_or(1, |change| change.value);
    let bit = u64::from(CLOCKS_PER_BIT);
    let (mut bytes, mut free) = (Vec::new(), 0);
    for start in changes.iter().filter(|change| change.value == 0) {
        if start.clock >= free {
            let middle = |n: u64| level(start.clock + n * bit + bit / 2);
            bytes.push((0..8).fold(0, |byte, n| byte | ((middle(n + 1) & 1) as u8) << n));
            free = start.clock + 9 * bit + bit / 2;
        }
    }
    bytes
}

impl Registers for OpenBoard {
    fn read(&mut self, offset: u16) -> Result<u32, BusError> {
        match self.ask(&read_request(offset)) {
            Ok(Some(Reply::Read(word))) => Ok(word),
            Ok(other) => Err(BusError::read(offset, SerialError::Answer(other))),
            Err(error) => Err(BusError::read(offset, error)),
        }
    }

    fn write(&mut self, offset: u16, data: u32) -> Result<(), BusError> {
        match self.ask(&write_request(offset, data)) {
            Ok(Some(Reply::Written)) => Ok(()),
            Ok(other) => Err(BusError::write(offset, SerialError::Answer(other))),
            Err(error) => Err(BusError::write(offset, error)),
        }
    }
}
