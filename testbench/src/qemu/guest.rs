//! A virtual machine with the card on its bus, watched from outside.
//!
//! All its time is one virtual clock: QEMU counts instructions (`-icount`), an idle processor skips to its next
//! timer, and while a device of ours works the clock stands. The card has its time from the guest, by the
//! test port. So nothing in the machine depends on how fast the host is, or whether it pauses.

use super::config_space::Window;
use super::port::{Message, Port};
use super::remote::{CardDevice, LockedCard, serve};
use super::running::Running;
use super::tools::Tools;
use driver::pci::Ids;
use std::fs;
use std::io::{self, Read};
use std::os::fd::OwnedFd;
use std::os::unix::net::UnixStream;
use std::path::Path;
use std::process::{Child, Stdio};
use std::time::{Duration, Instant};

/// Nanoseconds of the guest an instruction takes, as a power of two: 125 million a second.
const INSTRUCTION_SHIFT: u32 = 3;
/// Without any sign of life for so long, the machine is taken for dead. Its clock tells the time thousands of
/// times in a second of a quick host; a host would have to be slower by a factor of a million.
const DEAD: Duration = Duration::from_secs(900);

/// What the machine has.
#[derive(Debug)]
pub struct Options<'a> {
    /// QEMU and kernel.
    pub tools: &'a Tools,
    /// The initial RAM file system.
    pub initramfs: &'a [u8],
    /// The card, in told time.
    pub card: LockedCard,
    /// The numbers that it shows.
    pub ids: Ids,
    /// Scratch folder.
    pub folder: &'a Path,
    /// The machine is stopped after this time of its own, over all its boots.
    pub limit: Duration,
}

/// What came of it.
#[derive(Debug)]
pub struct Outcome {
    /// Everything on the first serial line.
    pub console: String,
    /// What QEMU itself and the devices' side had to say.
    pub qemu: String,
    /// It was not stopped by us.
    pub ended: bool,
    /// Time that it took in the guest.
    pub guest_time: Duration,
    /// Time that it took here.
    pub elapsed: Duration,
}

/// Kills QEMU whatever happens.
struct Qemu(Child);

impl Drop for Qemu {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// Runs a machine until it powers off. `control` answers what the guest says; the guest waits for it.
///
/// # Errors
/// QEMU that does not start, or files that cannot be written.
pub fn run<'a>(
    options: &'a Options<'_>,
    mut control: impl FnMut(Message<'_>, &Running) -> String + 'a,
) -> io::Result<Outcome> {
    let begun = Instant::now();
    let file = |name: &str| options.folder.join(name);
    let (initramfs, console) = (file("initramfs"), file("console"));
    let running = Running { monitor: file("monitor") };
    fs::write(&initramfs, options.initramfs)?;

    let mut command = options.tools.qemu();
    command.args("-nodefaults -no-user-config -display none -accel tcg -smp 1 -m 192M -monitor none".split(' '));
    command.args(["-icount", &format!("shift={INSTRUCTION_SHIFT},sleep=off")]);
    command.args(["-rtc", "base=2005-07-13,clock=vm"]);
    command.args(["-object", "memory-backend-memfd,id=ram,size=192M,share=on", "-machine", "pc,memory-backend=ram"]);
    command.arg("-kernel").arg(&options.tools.kernel).arg("-initrd").arg(&initramfs);
    command.args(["-append", "console=ttyS0 panic=-1 quiet cryptomgr.notests tsc=reliable"]);
    command.args(["-serial", &format!("file:{}", console.display())]);
    command.args(["-qmp", &format!("unix:{},server=on,wait=off", running.monitor.display())]);
    // Two ends of sockets that only QEMU shall hold: they go where its standard input and output would be.
    let ((card, cards_end), (port, ports_end)) = (UnixStream::pair()?, UnixStream::pair()?);
    command.stdin(Stdio::from(OwnedFd::from(cards_end))).stdout(Stdio::from(OwnedFd::from(ports_end)));
    command.args(["-device", "x-pci-proxy-dev,id=mesa,addr=05.0,fd=0"]);
    command.args(["-device", "x-pci-proxy-dev,id=port,addr=06.0,fd=1"]);
    port.set_read_timeout(Some(DEAD))?;

    let mut device = CardDevice(options.card.clone());
    let ids = options.ids;
    let server = std::thread::spawn(move || serve(card, &mut device, ids, Window::mesa_4i65()));
    let mut qemu = Qemu(command.stderr(Stdio::piped()).spawn()?);
    // The command holds the devices' ends of the sockets; only QEMU may.
    drop(command);
    let messages = collect(qemu.0.stderr.take());
    let mut test_port = Port::new(options.card.clone(), &running, options.limit, &mut control);
    let served = serve(port, &mut test_port, Port::IDS, Port::WINDOWS);
    let guest_time = test_port.now();
    if served.is_ok() {
        // The socket closes while QEMU ends.
        qemu.0.wait()?;
    }
    drop(qemu);
    let console = String::from_utf8_lossy(&fs::read(&console)?).replace('\r', "");
    let mut qemu = String::from_utf8_lossy(&messages.join().unwrap_or_default()).into_owned();
    let ended = served.is_ok();
    for (name, served) in [("the test port", Some(served)), ("the card", server.join().ok())] {
        match served {
            Some(Ok(())) => {}
            Some(Err(error)) => qemu += &format!("{name}: {error}\n"),
            None => qemu += &format!("{name}: panicked\n"),
        }
    }
    Ok(Outcome { console, qemu, ended, guest_time, elapsed: begun.elapsed() })
}

fn collect(stream: Option<impl Read + Send + 'static>) -> std::thread::JoinHandle<Vec<u8>> {
    std::thread::spawn(move || {
        let mut bytes = Vec::new();
        if let Some(mut stream) = stream {
            let _ = stream.read_to_end(&mut bytes);
        }
        bytes
    })
}
