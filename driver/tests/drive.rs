//! The control loop over a bit-true card: what it costs, and how it ends.

mod treadmill;

use driver::Board;
use driver::drive::{Driven, Ending, Fault, NoSource, Plan, PoseSource};
use driver::recording::Recording;
use model::measurement::Measurement;
use model::trajectory::{Arrival, SetPoint};
use runs::frames::Pose;
use runs::output::Existing;
use runs::robot::Robot;
use runs::{Layout, Run};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;
use treadmill::{CLOCK_HZ, Treadmill};

fn plan(seconds: f64) -> Plan {
    Plan { limit_s: seconds, ..Plan::new(&Robot::racbot(), &[SetPoint::stop(0.6, 0.4, 0.5, 0.3)]) }
}

fn drive(plan: &Plan, card: &Treadmill, recording: Option<&mut Recording>) -> Driven {
    let never = AtomicBool::new(false);
    let mut clock = card.clone();
    plan.drive(Board::new(card.clone()), &mut clock, CLOCK_HZ, &mut NoSource, recording, &never).unwrap()
}

#[test]
fn a_set_point_is_reached_recorded_and_left_switched_off() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.csv");
    let mut recording = Recording::start(&path, Layout::of_robot(3, false), Existing::Refuse).unwrap();
    let card = Treadmill::new();
    let driven = drive(&plan(60.0), &card, Some(&mut recording));
    assert!(matches!(driven.ending, Ending::Finished), "{:?}", driven.ending);
    assert!(matches!(driven.arrivals[..], [Arrival::Reached { .. }]) && driven.switched_off.is_ok());
    assert!((driven.belief.pose.x - 0.6).hypot(driven.belief.pose.y - 0.4) < 0.02 && !card.armed());
    assert_eq!((driven.unseen, driven.reread, driven.refused), (0, 0, 0));
    let recorded = recording.finish().unwrap();
    assert_eq!((recorded.ticks, recorded.lost), (driven.ticks, 0));
    let run = Run::read(&path).unwrap();
    assert!((run.duration_s() - driven.t).abs() < 2e-3 && run.supply_v.is_none());
    run.check(&Robot::racbot(), &path).unwrap();
}

/// The card's ring, clock and registers are left out of the count; the loop is all that is in it.
#[test]
fn the_loop_allocates_nothing_recording_and_camera_included() {
    struct Camera(u32);
    impl PoseSource for Camera {
        fn arrived(&mut self, _: f64) -> Option<Measurement> {
            self.0 += 1;
            self.0.is_multiple_of(16).then(|| Pose::default().into())
        }
    }
    let allocations = |seconds: f64| {
        let folder = tempfile::tempdir().unwrap();
        let mut recording =
            Recording::start(&folder.path().join("run.csv"), Layout::of_robot(3, true), Existing::Refuse).unwrap();
        let robot = Robot { camera_latency_s: 0.05, ..Robot::racbot() };
        let plan = Plan { fused: true, limit_s: seconds, ..Plan::new(&robot, &[SetPoint::pass(90.0, 0.0, 1.0, 0.0)]) };
        let (card, never) = (Treadmill::new(), AtomicBool::new(false));
        let mut ticks = 0;
        let info = allocation_counter::measure(|| {
            let mut clock = card.clone();
            let board = Board::new(card.clone());
            let driven = plan.drive(board, &mut clock, CLOCK_HZ, &mut Camera(0), Some(&mut recording), &never).unwrap();
            assert!(matches!(driven.ending, Ending::TimeLimit), "{:?}", driven.ending);
            ticks = driven.ticks;
        });
        (info.count_total, ticks)
    };
    let ((short, few), (long, many)) = (allocations(0.5), allocations(3.0));
    assert!(few >= 499 && many >= 2_999);
    assert_eq!(short, long, "{} allocations in {} ticks more", long - short, many - few);
}

#[test]
fn a_tick_takes_24_words_read_and_5_written() {
    let transfers = |seconds| {
        let card = Treadmill::new();
        let driven = drive(&plan(seconds), &card, None);
        let (reads, writes) = card.transfers();
        (driven.ticks, reads, writes)
    };
    let (short, long) = (transfers(0.2), transfers(0.7));
    let ticks = long.0 - short.0;
    assert_eq!((long.1 - short.1, long.2 - short.2), (24 * ticks, 5 * ticks));
}

#[test]
fn a_host_that_oversleeps_a_little_goes_on_and_counts_what_it_missed() {
    let card = Treadmill::new();
    card.oversleep(100, Duration::from_millis(7));
    let driven = drive(&plan(60.0), &card, None);
    assert!(matches!(driven.ending, Ending::Finished), "{:?}", driven.ending);
    assert_eq!((driven.latency.missed, driven.unseen), (7, 7));
    assert!(driven.silence >= Duration::from_millis(8));
}

#[test]
fn a_host_that_oversleeps_the_watchdog_is_switched_off_and_told_so() {
    let card = Treadmill::new();
    card.oversleep(200, Duration::from_millis(120));
    let driven = drive(&plan(60.0), &card, None);
    let Ending::Fault(fault @ Fault::Disarmed { .. }) = &driven.ending else { panic!("{:?}", driven.ending) };
    assert!(fault.to_string().contains("watchdog") && !card.armed(), "{fault}");
}

#[test]
fn a_request_and_the_emergency_stop_end_the_drive_at_once() {
    struct Stops<'a>(&'a AtomicBool);
    impl PoseSource for Stops<'_> {
        fn arrived(&mut self, t: f64) -> Option<Measurement> {
            self.0.store(t > 0.1, Ordering::Relaxed);
            None
        }
    }
    let (card, stop) = (Treadmill::new(), AtomicBool::new(false));
    let mut clock = card.clone();
    let board = Board::new(card.clone());
    let driven = plan(60.0).drive(board, &mut clock, CLOCK_HZ, &mut Stops(&stop), None, &stop).unwrap();
    assert!(matches!(driven.ending, Ending::Stopped) && (0.1..0.103).contains(&driven.t) && !card.armed());

    struct Presses(Treadmill);
    impl PoseSource for Presses {
        fn arrived(&mut self, t: f64) -> Option<Measurement> {
            if t > 0.1 {
                self.0.press_emergency_stop();
            }
            None
        }
    }
    let (card, never) = (Treadmill::new(), AtomicBool::new(false));
    let (mut clock, board) = (card.clone(), Board::new(card.clone()));
    let driven = plan(60.0).drive(board, &mut clock, CLOCK_HZ, &mut Presses(card.clone()), None, &never).unwrap();
    let Ending::Fault(fault) = driven.ending else { panic!("{:?}", driven.ending) };
    assert!(fault.to_string().contains("emergency-stop") && !card.armed(), "{fault}");
}
