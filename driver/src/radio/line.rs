//! Where frames go: a serial port with a radio module behind it, or a text file.

use fixed_kin::radio::GAP_BYTES;
use rustix::termios::{OptionalActions, tcdrain, tcgetattr, tcsetattr};
use std::fs::{File, OpenOptions};
use std::io::{self, Write};
use std::path::Path;
use std::thread::sleep;
use std::time::Duration;

/// The baud rate of the robots.
const BAUD: u32 = 115_200;

/// Time of some bytes on the line: ten bits each.
#[must_use]
pub(super) fn time_of(bytes: usize) -> Duration {
    Duration::from_secs_f64(bytes as f64 * 10.0 / f64::from(BAUD))
}

/// Takes frames.
pub trait Line {
    /// Sends a frame, and the silence after it without which it does not act; `at` is its time.
    ///
    /// # Errors
    /// What the system says.
    fn send(&mut self, at: Duration, frame: &[u8]) -> io::Result<()>;
}

/// A serial port: 115,200 baud, 8 bits, no parity, one stop bit, no flow control.
#[derive(Debug)]
pub struct SerialLine(File);

impl SerialLine {
    /// Opens and sets up a port such as `/dev/ttyUSB0`.
    ///
    /// # Errors
    /// No such port, no right to it, or no serial port at all.
    pub fn open(path: &Path) -> io::Result<Self> {
        let port = OpenOptions::new().read(true).write(true).open(path)?;
        let mut mode = tcgetattr(&port).map_err(|error| {
            io::Error::new(io::Error::from(error).kind(), format!("is no serial port ({error}); a file takes --out"))
        })?;
        mode.make_raw();
        mode.set_speed(BAUD)?;
        tcsetattr(&port, OptionalActions::Flush, &mode)?;
        Ok(Self(port))
    }
}

impl Line for SerialLine {
    fn send(&mut self, _: Duration, frame: &[u8]) -> io::Result<()> {
        self.0.write_all(frame)?;
        tcdrain(&self.0)?;
        // A converter on USB may still hold what the system calls sent.
        sleep(time_of(GAP_BYTES as usize + 2) + Duration::from_millis(1));
        Ok(())
    }
}

/// Text: a line a frame, its time in seconds and its bytes in hexadecimal.
#[derive(Debug)]
pub struct HexLine<W>(pub W);

impl<W: Write> Line for HexLine<W> {
    fn send(&mut self, at: Duration, frame: &[u8]) -> io::Result<()> {
        write!(self.0, "{:.6}", at.as_secs_f64())?;
        for byte in frame {
            write!(self.0, " {byte:02x}")?;
        }
        writeln!(self.0)
    }
}
