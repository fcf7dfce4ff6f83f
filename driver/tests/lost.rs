//! A robot whose camera tells it nothing stops, looks round, and drives on once it knows where it is.

mod treadmill;

use driver::Board;
use driver::drive::{Control, Driven, Ending, Fault, Plan, PoseSource};
use driver::recording::Recording;
use model::measurement::Measurement;
use model::odometry::Estimate;
use model::trajectory::{Limits, SetPoint};
use runs::output::Existing;
use runs::robot::Robot;
use runs::{Layout, Run};
use std::ops::Range;
use std::sync::atomic::AtomicBool;
use treadmill::{CLOCK_HZ, Treadmill};

/// Sees what is true, but for a while; 20 pictures a second.
struct Camera {
    blind: Range<f64>,
    contradicts: Range<f64>,
    now: f64,
    due: f64,
    truth: Option<Estimate>,
}

impl Camera {
    fn new(blind: Range<f64>) -> Self {
        Self { blind, contradicts: 0.0..0.0, now: 0.0, due: 0.0, truth: None }
    }
}

impl PoseSource for Camera {
    fn arrived(&mut self, t: f64) -> Option<Measurement> {
        self.now = t;
        // The treadmill's wheels do as they are told, so that odometry is the truth.
        let truth = self.truth.filter(|_| t >= self.due && !self.blind.contains(&t))?;
        self.due = t + 0.05;
        Some(truth.pose.into())
    }

    fn believed(&mut self, _: f64, belief: &Estimate) {
        self.truth = Some(*belief);
    }

    fn contradicts(&self) -> bool {
        self.contradicts.contains(&self.now)
    }
}

fn plan() -> Plan {
    let fused = Plan::new(&Robot::racbot(), &[SetPoint::stop(4.0, 0.0, 1.0, 0.0)]);
    Plan { fused: true, sure_m: Some(0.15), ..fused }
}

fn drive(plan: &Plan, camera: &mut Camera, recording: Option<&mut Recording>) -> (Driven, Treadmill) {
    let (card, never) = (Treadmill::new(), AtomicBool::new(false));
    let mut clock = card.clone();
    let driven = plan.drive(Board::new(card.clone()), &mut clock, CLOCK_HZ, camera, recording, &never).unwrap();
    (driven, card)
}

#[test]
fn who_sees_nothing_stops_looks_round_and_gives_up_switched_off() {
    for control in [Control::Follower, Control::Paper] {
        let (driven, card) = drive(&Plan { control, ..plan() }, &mut Camera::new(0.0..99.0), None);
        let Ending::Fault(fault @ Fault::Lost { sd_m, limit_m }) = &driven.ending else {
            panic!("{:?}", driven.ending)
        };
        assert!(*sd_m > *limit_m && fault.to_string().contains("lost"), "{fault}");
        assert!(driven.switched_off.is_ok() && !card.armed() && driven.lost == 1);
        assert!(driven.belief.pose.x > 0.5 && driven.belief.pose.x < 2.5, "{:?}", driven.belief.pose);
        // The cause gone, it is armed and driven again.
        let (again, _) = drive(&Plan { control, ..plan() }, &mut Camera::new(99.0..99.0), None);
        assert!(matches!(again.ending, Ending::Finished) && again.lost == 0, "{:?}", again.ending);
    }
}

#[test]
fn who_is_blind_for_a_while_stops_within_its_limits_and_then_arrives() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.csv");
    let mut recording = Recording::start(&path, Layout::of_robot(3, true), Existing::Refuse).unwrap();
    let (driven, _) = drive(&plan(), &mut Camera::new(0.5..5.0), Some(&mut recording));
    assert!(matches!(driven.ending, Ending::Finished) && driven.lost == 1, "{:?}", driven.ending);
    assert!((driven.belief.pose.x - 4.0).hypot(driven.belief.pose.y) < 0.02, "{:?}", driven.belief.pose);
    recording.finish().unwrap();
    let run = Run::read(&path).unwrap();
    let [vx, vy, omega] = run.command.as_ref().unwrap();
    let speed = |k: usize| vx[k].hypot(vy[k]);
    let at = |t: f64| run.t.partition_point(|x| *x < t);
    assert!((at(4.0)..at(5.0)).all(|k| speed(k) < 1e-3 && omega[k] > 0.5), "it stands and turns");
    // Not at once: it brakes as hard as its wheels and its grip allow, the lead of its speed loops aside.
    let fast = (0..at(4.0)).rfind(|k| speed(*k) > 0.8).unwrap();
    let slow = (fast..at(4.0)).find(|k| speed(*k) < 0.2).unwrap();
    let braking = (speed(fast) - speed(slow)) / (run.t[slow] - run.t[fast]);
    let most = Limits::of(&Robot::racbot()).unwrap().acceleration;
    assert!(braking < 1.05 * most && braking > 0.5 * most, "{braking} of {most} m/s²");
}

#[test]
fn who_sees_another_place_than_it_believes_stops() {
    let mut camera = Camera { contradicts: 0.5..2.5, ..Camera::new(99.0..99.0) };
    let (driven, _) = drive(&plan(), &mut camera, None);
    assert!(matches!(driven.ending, Ending::Finished) && driven.lost == 1, "{:?}", driven.ending);
    let held = drive(&plan(), &mut Camera::new(99.0..99.0), None).0.t;
    assert!(driven.t > held + 1.5, "{} and {held} s", driven.t);
    // Without a limit nothing of it stops a drive.
    let mut camera = Camera { contradicts: 0.5..2.5, ..Camera::new(0.5..99.0) };
    let (driven, _) = drive(&Plan { sure_m: None, ..plan() }, &mut camera, None);
    assert!(matches!(driven.ending, Ending::Finished) && driven.lost == 0, "{:?}", driven.ending);
}
