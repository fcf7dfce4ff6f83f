//! SIGINT and SIGTERM end a drive in order: a child process drives until it is asked to stop.

mod treadmill;

use driver::Board;
use driver::drive::{Ending, NoSource, Plan};
use driver::realtime::{Clock, MonotonicClock, stop_on_signals};
use model::trajectory::SetPoint;
use runs::robot::Robot;
use rustix::process::{Pid, Signal, kill_process};
use std::io::{BufRead, BufReader};
use std::process::{Command, Stdio};
use std::time::Duration;
use treadmill::{CLOCK_HZ, Treadmill};

const DRIVES: &str = "RACBOT_TEST_DRIVES";

/// The card's time, as slow as the host's.
#[derive(Clone)]
struct Slow(Treadmill);

impl Clock for Slow {
    fn now(&mut self) -> Duration {
        self.0.now()
    }
    fn sleep_until(&mut self, at: Duration) {
        let wait = at.saturating_sub(self.0.now());
        let mut host = MonotonicClock;
        let until = host.now() + wait;
        host.sleep_until(until);
        self.0.sleep_until(at);
    }
}

/// Not a test of its own: what the child runs.
fn drive_until_asked() {
    let stop = stop_on_signals().unwrap();
    let card = Treadmill::new();
    let plan = Plan { limit_s: 3_600.0, ..Plan::new(&Robot::racbot(), &[SetPoint::pass(9_000.0, 0.0, 1.0, 0.0)]) };
    println!("begins");
    let mut clock = Slow(card.clone());
    let driven = plan.drive(Board::new(card.clone()), &mut clock, CLOCK_HZ, &mut NoSource, None, &stop).unwrap();
    println!("ended {} armed {}", matches!(driven.ending, Ending::Stopped), card.armed());
}

#[test]
fn a_signal_ends_the_drive_with_the_outputs_off() {
    if std::env::var_os(DRIVES).is_some() {
        return drive_until_asked();
    }
    // Some who pass a signal on send it twice at once: that is one request.
    for (signal, times) in [(Signal::INT, 1), (Signal::TERM, 1), (Signal::TERM, 4)] {
        let mut child = Command::new(std::env::current_exe().unwrap())
            .args(["a_signal_ends_the_drive_with_the_outputs_off", "--exact", "--nocapture", "--test-threads=1"])
            .env(DRIVES, "1")
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let mut lines = BufReader::new(child.stdout.take().unwrap()).lines().map_while(Result::ok);
        assert!(lines.any(|line| line.contains("begins")));
        std::thread::sleep(Duration::from_millis(150));
        for _ in 0..times {
            kill_process(Pid::from_child(&child), signal).unwrap();
            std::thread::sleep(Duration::from_micros(200));
        }
        let last = lines.find(|line| line.contains("ended"));
        assert_eq!(last.as_deref().map(|line| line.trim_start_matches("begins")), Some("ended true armed false"));
        assert!(child.wait().unwrap().success());
    }
}
