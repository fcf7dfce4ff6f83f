//! A machine that runs.

use std::io::{self, BufRead, BufReader, Write};
use std::os::unix::net::UnixStream;
use std::path::PathBuf;

/// What can be done to a running machine.
#[derive(Debug, Default)]
pub struct Running {
    /// Socket of QEMU's monitor.
    pub(super) monitor: PathBuf,
}

impl Running {
    /// Pulls the card out of its slot.
    ///
    /// # Errors
    /// A monitor that does not answer, or refuses.
    pub fn unplug(&self) -> io::Result<()> {
        let mut monitor = BufReader::new(UnixStream::connect(&self.monitor)?);
        let mut line = String::new();
        monitor.read_line(&mut line)?;
        for command in
            [r#"{"execute": "qmp_capabilities"}"#, r#"{"execute": "device_del", "arguments": {"id": "mesa"}}"#]
        {
            monitor.get_mut().write_all(command.as_bytes())?;
            line.clear();
            monitor.read_line(&mut line)?;
            if line.contains("\"error\"") {
                return Err(io::Error::other(line));
            }
        }
        Ok(())
    }
}
