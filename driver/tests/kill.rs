//! A recording survives `kill -9`: a child process records in real time until it is killed.

use driver::realtime::{Clock, MonotonicClock, Timer};
use driver::recording::{Recording, Sample};
use fixed_kin::AXES;
use runs::output::Existing;
use runs::{Layout, Run};
use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

const FILE: &str = "RACBOT_TEST_RECORDS_TO";

/// Not a test of its own: what the child runs, forever.
fn record_until_killed(path: &Path) -> ! {
    let mut recording = Recording::start(path, Layout::of_robot(3, true), Existing::Refuse).unwrap();
    // However long this machine lets the other thread wait.
    recording.wait_where_full();
    let mut clock = MonotonicClock;
    let mut timer = Timer::new(Duration::from_micros(500), &mut clock);
    let begun = clock.now();
    let mut out = std::io::stdout();
    for tick in 0_i64.. {
        let wake = timer.wait(&mut clock);
        let t = (wake.at.saturating_sub(begun)).as_secs_f64();
        recording.push(Sample { t, counts: [tick; AXES], ..Sample::default() });
        if tick % 20 == 0 && (writeln!(out, "flushed {}", recording.flushed()).is_err() || out.flush().is_err()) {
            break;
        }
    }
    std::process::exit(1)
}

#[test]
fn what_was_flushed_before_kill_9_is_read_back() {
    if let Some(path) = std::env::var_os(FILE) {
        record_until_killed(Path::new(&path));
    }
    let folder = tempfile::tempdir().unwrap();
    for (name, enough) in [("run.csv", 150), ("run.mcap", 150), ("long.mcap", 900)] {
        let path = folder.path().join(name);
        let mut child = Command::new(std::env::current_exe().unwrap())
            .args(["what_was_flushed_before_kill_9_is_read_back", "--exact", "--nocapture", "--test-threads=1"])
            .env(FILE, &path)
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let mut flushed = 0;
        for line in BufReader::new(child.stdout.take().unwrap()).lines() {
            // The test harness writes to the same pipe.
            let line = line.unwrap();
            if let Some(count) = line.rsplit("flushed ").next().and_then(|n| n.parse::<usize>().ok()) {
                flushed = count;
            }
            if flushed >= enough {
                break;
            }
        }
        child.kill().unwrap();
        child.wait().unwrap();
        assert!(flushed >= enough, "the child died too early");
        let run = Run::read(&path).unwrap();
        assert!(run.len() >= flushed, "{name}: {} of {flushed} flushed ticks are left", run.len());
        assert!(run.counts[0].iter().enumerate().all(|(tick, count)| *count == tick as i64));
    }
}
