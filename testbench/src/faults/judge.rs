//! One drive with one fault, and whether what must hold held.

use super::memory::Memory;
use super::{BusFault, FaultyBus, Rig, RigFault};
use driver::Board;
use driver::drive::{DriveError, Driven, Ending, NoSource, Plan};
use driver::recording::Recording;
use model::trajectory::SetPoint;
use runs::Layout;
use runs::frames::Pose;
use runs::robot::Robot;
use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

/// Longest time from the last valid commit to outputs off: the watchdog's, a control tick and the rig's step.
pub(super) const WATCHDOG: Duration = Duration::from_millis(52);
/// Longest time from a broken cable or clock to outputs off: full drive must first last.
pub(super) const SLOW: Duration = Duration::from_millis(1_500);
/// Control as commanded: the robot is never further from the path that it takes without a fault, m.
const OFF_TRACK_M: f64 = 0.03;

/// What breaks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Injected {
    Bus(BusFault),
    Rig(Duration, RigFault),
}

/// What was seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// The robot drove as commanded.
    Drove,
    /// It was refused or ended with an error that names the cause; the outputs were off when the host returned.
    Ended,
    /// The host could not switch off any more; the card's watchdog did.
    Watchdog,
    /// A broken cable led the robot astray by a little, and the drive was over, outputs off, in less than the
    /// stated time, before anybody could be sure.
    Unnoticed,
}

/// A judged case.
#[derive(Clone, Debug)]
pub struct Verdict {
    /// What was seen, or what should not have been.
    pub outcome: Result<Outcome, String>,
    /// From the fault to outputs off, where they went off because of it.
    pub off_after: Option<Duration>,
    /// The error, if there was one.
    pub message: Option<String>,
    /// Once the cause was gone the card could be armed again, without a reload.
    pub armed_again: bool,
}

/// The drive that all cases make.
#[derive(Clone, Debug)]
pub(super) struct Course {
    pub(super) plan: Plan,
    /// Where the robot is at each millisecond without a fault.
    pub(super) track: Vec<Pose>,
    /// Transfers of the whole drive: reads, writes.
    pub(super) transfers: (u64, u64),
    /// Transfers until the card is armed.
    pub(super) armed_after: u64,
    /// Time when the robot rests.
    pub(super) time: Duration,
}

impl Course {
    pub(super) fn new() -> Result<Self, String> {
        let robot = Robot::racbot();
        let points = [SetPoint::pass(0.15, 0.05, 0.8, 1.0), SetPoint::stop(0.2, 0.2, 0.8, 0.0)];
        let plan = Plan { fused: true, limit_s: 10.0, ..Plan::new(&robot, &points) };
        let mut course = Self { plan, track: Vec::new(), transfers: (0, 0), armed_after: 0, time: Duration::ZERO };
        // How far the preparations reach is what a drive without time costs.
        let short = Plan { limit_s: 0.0, ..course.plan.clone() };
        let run = course.run(&short, None, None)?;
        course.armed_after = run.transfers.0 + run.transfers.1;
        let run = course.run(&course.plan, None, None)?;
        match &run.result {
            Ok(driven) if matches!(driven.ending, Ending::Finished) => {}
            other => return Err(format!("the drive without a fault ends with {other:?}")),
        }
        course.transfers = run.transfers;
        course.time = run.rig.time();
        course.track = run.rig.track();
        Ok(course)
    }

    fn run(&self, plan: &Plan, fault: Option<Injected>, recording: Option<&mut Recording>) -> Result<Run, String> {
        let robot = Robot::racbot();
        let rig_fault = match fault {
            Some(Injected::Rig(at, fault)) => Some((at, fault)),
            _ => None,
        };
        let bus_fault = match fault {
            Some(Injected::Bus(fault)) => Some(fault),
            _ => None,
        };
        let clock_hz = Rig::nominal_clock_hz();
        let rig = Rig::new(&robot, clock_hz, rig_fault).map_err(|error| error.to_string())?;
        let mut bus = FaultyBus::new(rig.clone(), bus_fault);
        let mut clock = rig.clone();
        let never = AtomicBool::new(false);
        let result = if plan.fused {
            plan.drive(Board::new(&mut bus), &mut clock, clock_hz, &mut rig.clone(), recording, &never)
        } else {
            plan.drive(Board::new(&mut bus), &mut clock, clock_hz, &mut NoSource, recording, &never)
        };
        Ok(Run { result, transfers: bus.transfers(), rig })
    }

    /// Drives with a fault and judges; `share` is where the recording is cut off.
    pub(super) fn judge(&self, fault: Injected, share: f64, mcap: bool) -> Verdict {
        self.judged(fault, share, mcap).unwrap_or_else(|why| Verdict {
            outcome: Err(why),
            off_after: None,
            message: None,
            armed_again: false,
        })
    }

    /// Takes the cause away and arms the card as any command does.
    fn arm_again(&self, rig: &Rig) -> Result<(), String> {
        rig.mend();
        // A wheel that was driven still turns.
        rig.pass(Duration::from_millis(20));
        let scale = self.plan.scale(Rig::nominal_clock_hz()).map_err(|error| error.to_string())?;
        let mut board = Board::new(rig.clone());
        let armed = board.configure(&scale, &self.plan.settings).and_then(|()| {
            rig.pass(Duration::from_millis(2));
            board.arm()
        });
        armed.map_err(|error| format!("cannot be armed again once the cause is gone: {error}"))?;
        rig.pass(Duration::from_millis(5));
        if !rig.armed() {
            let first = board.first_fault().map_err(|error| error.to_string())?;
            return Err(format!("switches off again once the cause is gone: {}", driver::fault_names(first)));
        }
        board.disarm().map_err(|error| error.to_string())
    }

    fn judged(&self, fault: Injected, share: f64, mcap: bool) -> Result<Verdict, String> {
        let wheels = self.plan.robot.wheel_count();
        let layout = Layout::of_robot(wheels, true);
        let (stream, memory) = Memory::stream(mcap, layout).map_err(|error| error.to_string())?;
        let mut recording = Recording::onto(stream, Path::new("memory"), wheels).map_err(|error| error.to_string())?;
        recording.wait_where_full();
        let run = self.run(&self.plan, Some(fault), Some(&mut recording))?;
        let recorded = recording.finish().map_err(|error| error.to_string())?;
        if let Some(why) = run.rig.failure() {
            return Err(format!("the simulation failed: {why}"));
        }
        let returned = run.rig.time();
        let off_at_return = !run.rig.armed();
        run.rig.pass(WATCHDOG);
        if run.rig.armed() {
            return Err(format!("still armed {WATCHDOG:?} after the host returned: {:?}", run.result));
        }
        let (finished, message) = match &run.result {
            Ok(Driven { ending: Ending::Finished, .. }) => (true, None),
            Ok(Driven { ending: Ending::Fault(fault), .. }) => (false, Some(fault.to_string())),
            Ok(driven) => return Err(format!("ends with {:?}", driven.ending)),
            Err(error) => (false, Some(error.to_string())),
        };
        if let Ok(driven) = &run.result
            && recorded.ticks + recorded.lost != driven.ticks
            && finished
        {
            return Err(format!("{} ticks seen, {} recorded", driven.ticks, recorded.ticks));
        }
        memory.cut(share).map_err(|why| format!("the recording: {why}"))?;
        if let Some(message) = &message {
            names_the_cause(fault, message)?;
        }
        let onset = match fault {
            Injected::Rig(at, _) => Some(at),
            Injected::Bus(_) => None,
        };
        let off_after = onset.zip(run.rig.last_armed()).map(|(on, off)| off.saturating_sub(on));
        if finished && let Err(astray) = self.on_track(&run.rig) {
            let cable = matches!(fault, Injected::Rig(_, RigFault::Cable(..)));
            if !cable || off_after.is_none_or(|after| after > SLOW) {
                return Err(astray);
            }
            self.arm_again(&run.rig)?;
            return Ok(Verdict { outcome: Ok(Outcome::Unnoticed), off_after: None, message: None, armed_again: true });
        }
        let off_after = off_after.filter(|_| !finished);
        if let Some(after) = off_after.filter(|after| *after > SLOW) {
            return Err(format!("off only {after:?} after the fault: {message:?}"));
        }
        let by_watchdog = run.rig.last_armed().is_some_and(|at| at > returned);
        let outcome = match (finished, off_at_return || !by_watchdog) {
            (true, _) => Outcome::Drove,
            (false, true) => Outcome::Ended,
            (false, false) => Outcome::Watchdog,
        };
        self.arm_again(&run.rig)?;
        Ok(Verdict { outcome: Ok(outcome), off_after, message, armed_again: true })
    }

    /// Whether the robot kept to the path it takes without a fault and came to its end; a host that slept may
    /// have made it later.
    fn on_track(&self, rig: &Rig) -> Result<(), String> {
        for pose in rig.track().iter().step_by(10) {
            let off = |at: &Pose| (at.x - pose.x).hypot(at.y - pose.y);
            let nearest = self.track.iter().step_by(5).map(off).fold(f64::INFINITY, f64::min);
            if nearest > OFF_TRACK_M {
                return Err(format!("{:.0} mm off the path that was commanded", 1e3 * nearest));
            }
        }
        let (end, wanted) = (rig.track().last().copied().unwrap_or_default(), self.track[self.track.len() - 1]);
        let off = (end.x - wanted.x).hypot(end.y - wanted.y);
        if off > OFF_TRACK_M { Err(format!("ends {:.0} mm off", 1e3 * off)) } else { Ok(()) }
    }
}

struct Run {
    result: Result<Driven, DriveError>,
    transfers: (u64, u64),
    rig: Rig,
}

/// Words of which an error after a fault must hold one.
fn names_the_cause(fault: Injected, message: &str) -> Result<(), String> {
    let expected: &[&str] = match fault {
        Injected::Bus(BusFault::KilledFrom(_)) => &["killed"],
        Injected::Bus(BusFault::ErrorsFrom(..)) => &["the bus did not answer"],
        Injected::Bus(BusFault::GoneFrom(_)) => &["the card is gone"],
        // A register by its name, the bus, or what the card itself reports of it.
        Injected::Bus(BusFault::Write(..) | BusFault::WritesFrom(..)) => {
            &["bus", "checksum", " reads ", "refused to arm", "stayed armed", "tick", "switched off"]
        }
        Injected::Bus(BusFault::Read(..) | BusFault::ReadsFrom(..)) => {
            &["bus", "checksum", " reads ", "refused", "stayed armed", "tick", "switched off", "jumps", "clock"]
        }
        Injected::Rig(_, RigFault::Cable(..)) => &["encoder", "stall"],
        Injected::Rig(_, RigFault::Clock(_)) => &["clock"],
        Injected::Rig(_, RigFault::Stall(_)) => &["watchdog"],
        Injected::Rig(_, RigFault::EmergencyStop) => &["emergency-stop"],
        Injected::Rig(_, RigFault::CameraGone) => &[],
    };
    if expected.iter().any(|word| message.contains(word)) {
        return Ok(());
    }
    Err(format!("the error does not name the cause: {message}"))
}
