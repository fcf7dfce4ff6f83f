//! The guest's end of the line.
//!
//! ```text
//! testport now          tells the time once
//! testport clock        tells the time every 250 µs, for ever
//! testport say WORDS    says something, prints the reply
//! testport send NAME    sends standard input as a file
//! ```

use rustix::thread::clock_nanosleep_absolute;
use rustix::time::{ClockId, Timespec, clock_gettime};
use std::fs::{self, File, OpenOptions};
use std::io::{self, Read, Write};
use std::os::unix::fs::FileExt;
use testport::{DEVICE, LENGTH, STAMP_US, TIME, VENDOR, WORD};
use thread_priority::unix::{
    RealtimeThreadSchedulePolicy, ThreadSchedulePolicy, set_thread_priority_and_policy, thread_native_id,
};
use thread_priority::{ThreadPriority, ThreadPriorityValue};

const USAGE: &str = "usage: testport now | clock | say WORDS | send NAME < FILE";

fn main() -> io::Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let port = Port::find()?;
    match arguments.split_first().map(|(verb, rest)| (verb.as_str(), rest)) {
        Some(("now", [])) => port.tell().map(drop),
        Some(("clock", [])) => port.tell_time(),
        Some(("say", words)) => {
            let reply = port.exchange(format!("{}\n", words.join(" ")).as_bytes())?;
            io::stdout().write_all(&reply)
        }
        Some(("send", [name])) => {
            let mut message = format!("file {name}\n").into_bytes();
            io::stdin().read_to_end(&mut message)?;
            port.exchange(&message).map(drop)
        }
        _ => Err(io::Error::other(USAGE)),
    }
}

/// The device's ports, through sysfs.
struct Port(File);

impl Port {
    fn find() -> io::Result<Self> {
        for entry in fs::read_dir("/sys/bus/pci/devices")? {
            let folder = entry?.path();
            let number = |name: &str| -> io::Result<u16> {
                let text = fs::read_to_string(folder.join(name))?;
                u16::from_str_radix(text.trim().trim_start_matches("0x"), 16).map_err(io::Error::other)
            };
            if (number("vendor")?, number("device")?) == (VENDOR, DEVICE) {
                // What the firmware has enabled need not be enabled again, which takes time.
                if fs::read_to_string(folder.join("enable"))?.trim() == "0" {
                    fs::write(folder.join("enable"), "1")?;
                }
                return Ok(Self(OpenOptions::new().read(true).write(true).open(folder.join("resource0"))?));
            }
        }
        Err(io::Error::other("no test port on the PCI bus"))
    }

    fn write(&self, offset: u32, word: u32) -> io::Result<()> {
        self.0.write_all_at(&word.to_le_bytes(), offset.into())
    }

    fn read(&self, offset: u32) -> io::Result<u32> {
        let mut bytes = [0; 4];
        self.0.read_exact_at(&mut bytes, offset.into())?;
        Ok(u32::from_le_bytes(bytes))
    }

    fn exchange(&self, message: &[u8]) -> io::Result<Vec<u8>> {
        for chunk in message.chunks(4) {
            let mut word = [0; 4];
            word[..chunk.len()].copy_from_slice(chunk);
            self.write(WORD, u32::from_le_bytes(word))?;
        }
        self.write(LENGTH, u32::try_from(message.len()).map_err(io::Error::other)?)?;
        let length = self.read(LENGTH)? as usize;
        let mut reply = Vec::with_capacity(length + 3);
        while reply.len() < length {
            reply.extend(self.read(WORD)?.to_le_bytes());
        }
        reply.truncate(length);
        Ok(reply)
    }

    /// Writes the time, µs since the start of the machine; returns it.
    fn tell(&self) -> io::Result<u64> {
        let now = clock_gettime(ClockId::Monotonic);
        let microseconds = now.tv_sec as u64 * 1_000_000 + now.tv_nsec as u64 / 1_000;
        self.write(TIME, microseconds as u32)?;
        Ok(microseconds)
    }

    /// Writes the time on a grid of [`STAMP_US`], before everything else that wants to run; ticks that were slept
    /// through are left out.
    fn tell_time(&self) -> io::Result<()> {
        let highest = ThreadPriority::Crossplatform(ThreadPriorityValue::try_from(99).map_err(io::Error::other)?);
        let policy = ThreadSchedulePolicy::Realtime(RealtimeThreadSchedulePolicy::Fifo);
        set_thread_priority_and_policy(thread_native_id(), highest, policy)
            .map_err(|error| io::Error::other(format!("SCHED_FIFO: {error}")))?;
        loop {
            let microseconds = self.tell()?;
            let next = (microseconds / u64::from(STAMP_US) + 1) * u64::from(STAMP_US);
            let next = Timespec { tv_sec: (next / 1_000_000) as i64, tv_nsec: (next % 1_000_000 * 1_000) as i64 };
            while clock_nanosleep_absolute(rustix::thread::ClockId::Monotonic, &next) == Err(rustix::io::Errno::INTR) {}
        }
    }
}
