//! A virtual machine with the card on its bus, watched from outside.

use super::remote::{LockedCard, serve};
use super::tools::Tools;
use driver::pci::Ids;
use std::fs;
use std::io::{self, BufRead, BufReader, Read, Write};
use std::os::fd::OwnedFd;
use std::os::unix::net::{UnixListener, UnixStream};
use std::path::{Path, PathBuf};
use std::process::{Child, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

/// What the machine has.
#[derive(Debug)]
pub struct Options<'a> {
    /// QEMU and kernel.
    pub tools: &'a Tools,
    /// The initial RAM file system.
    pub initramfs: &'a [u8],
    /// The card and the numbers it shows; none for an empty slot.
    pub card: Option<(LockedCard, Ids)>,
    /// Bytes of an NVMe disk, through which files leave the guest.
    pub disk_bytes: u64,
    /// Scratch folder.
    pub folder: &'a Path,
    /// The machine is stopped after this time.
    pub limit: Duration,
}

/// What came of it.
#[derive(Debug)]
pub struct Outcome {
    /// Everything on the first serial line.
    pub console: String,
    /// What QEMU itself had to say.
    pub qemu: String,
    /// The disk's image.
    pub disk: PathBuf,
    /// Whether it ended by itself in time.
    pub in_time: bool,
    /// Time it took.
    pub elapsed: Duration,
}

/// What can be done to a running machine.
#[derive(Debug)]
pub struct Running {
    monitor: PathBuf,
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

/// Kills QEMU whatever happens.
struct Qemu(Child);

impl Drop for Qemu {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// Runs a machine until it powers off. `control` answers the lines that the guest writes to its second
/// serial line, one reply each.
///
/// # Errors
/// QEMU that does not start, or files that cannot be written.
pub fn run(options: &Options<'_>, mut control: impl FnMut(&str, &Running) -> String) -> io::Result<Outcome> {
    let begun = Instant::now();
    let file = |name: &str| options.folder.join(name);
    let (initramfs, disk, socket) = (file("initramfs"), file("disk"), file("control"));
    let running = Running { monitor: file("monitor") };
    fs::write(&initramfs, options.initramfs)?;
    fs::File::create(&disk)?.set_len(options.disk_bytes)?;
    let listener = UnixListener::bind(&socket)?;

    let mut command = options.tools.qemu();
    command.args("-nodefaults -no-user-config -display none -accel tcg -smp 1 -m 192M -monitor none".split(' '));
    command.args(["-object", "memory-backend-memfd,id=ram,size=192M,share=on", "-machine", "pc,memory-backend=ram"]);
    command.arg("-kernel").arg(&options.tools.kernel).arg("-initrd").arg(&initramfs);
    command.args(["-append", "console=ttyS0 panic=-1 quiet cryptomgr.notests tsc=unstable"]);
    command.args(["-serial", "file:/dev/stdout"]);
    command.args(["-chardev", &format!("socket,id=control,path={}", socket.display()), "-serial", "chardev:control"]);
    command.args(["-drive", &format!("if=none,id=disk,format=raw,file={}", disk.display())]);
    command.args(["-device", "nvme,drive=disk,serial=run"]);
    command.args(["-qmp", &format!("unix:{},server=on,wait=off", running.monitor.display())]);
    let mut server = None;
    if let Some((card, ids)) = &options.card {
        let (ours, theirs) = UnixStream::pair()?;
        command.stdin(Stdio::from(OwnedFd::from(theirs)));
        command.args(["-device", "x-pci-proxy-dev,id=mesa,addr=05.0,fd=0"]);
        let (card, ids) = (card.clone(), *ids);
        server = Some(std::thread::spawn(move || serve(ours, &card, ids)));
    } else {
        command.stdin(Stdio::null());
    }
    let mut qemu = Qemu(command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn()?);
    // The command holds the device's end of the socket; only QEMU may.
    drop(command);
    let (console, messages) = (collect(qemu.0.stdout.take()), collect(qemu.0.stderr.take()));
    let (lines, mut replies) = control_line(listener);

    let mut in_time = true;
    loop {
        if let Ok(line) = lines.recv_timeout(Duration::from_millis(20)) {
            let reply = control(line.trim(), &running);
            if let Some(stream) = replies.get() {
                let _ = stream.write_all(format!("{reply}\n").as_bytes());
            }
        } else if qemu.0.try_wait()?.is_some() {
            break;
        }
        if begun.elapsed() > options.limit {
            in_time = false;
            break;
        }
    }
    drop(qemu);
    let text = |thread: std::thread::JoinHandle<Vec<u8>>| {
        String::from_utf8_lossy(&thread.join().unwrap_or_default()).replace('\r', "")
    };
    let (console, mut qemu) = (text(console), text(messages));
    if let Some(Ok(Err(error))) = server.map(std::thread::JoinHandle::join) {
        qemu += &format!("the card's side: {error}\n");
    }
    Ok(Outcome { console, qemu, disk, in_time, elapsed: begun.elapsed() })
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

/// The stream to reply on, once QEMU has connected.
struct Replies(Receiver<UnixStream>, Option<UnixStream>);

impl Replies {
    fn get(&mut self) -> Option<&mut UnixStream> {
        if self.1.is_none() {
            self.1 = self.0.try_recv().ok();
        }
        self.1.as_mut()
    }
}

fn control_line(listener: UnixListener) -> (Receiver<String>, Replies) {
    let (lines, received) = channel();
    let (streams, stream) = channel();
    std::thread::spawn(move || {
        let Ok((socket, _)) = listener.accept() else { return };
        let Ok(writer) = socket.try_clone() else { return };
        if streams.send(writer).is_err() {
            return;
        }
        for line in BufReader::new(socket).lines() {
            let Ok(line) = line else { return };
            if lines.send(line).is_err() {
                return;
            }
        }
    });
    (received, Replies(stream, None))
}
