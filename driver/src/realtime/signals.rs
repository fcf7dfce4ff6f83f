//! SIGINT and SIGTERM as a request to stop in order.

use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
use std::io::{self, Read};
use std::os::unix::net::UnixStream;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// Time in which further signals are the same request: `timeout` and others that pass signals on send one to the process and
/// one to its group at once, and a drive that the second ended would leave its outputs to the watchdog and its recording as it
/// is. A hand takes longer.
const SAME_REQUEST: Duration = Duration::from_millis(300);

/// A flag that the first of these signals sets; one that comes later than `SAME_REQUEST` ends the process, after which the
/// card's watchdog switches off.
///
/// # Errors
/// A system that refuses handlers, or a thread.
pub fn stop_on_signals() -> io::Result<Arc<AtomicBool>> {
    let (stop, impatient) = (Arc::new(AtomicBool::new(false)), Arc::new(AtomicBool::new(false)));
    let (mut woken, wakes) = UnixStream::pair()?;
    for signal in [SIGINT, SIGTERM, SIGHUP] {
        signal_hook::flag::register_conditional_shutdown(signal, 128 + signal, Arc::clone(&impatient))?;
        signal_hook::flag::register(signal, Arc::clone(&stop))?;
        signal_hook::low_level::pipe::register(signal, wakes.try_clone()?)?;
    }
    std::thread::Builder::new().name("signals".into()).spawn(move || {
        // Sleeps until the first signal.
        if woken.read_exact(&mut [0]).is_ok() {
            std::thread::sleep(SAME_REQUEST);
            impatient.store(true, Ordering::SeqCst);
        }
    })?;
    Ok(stop)
}
