//! The loop.

use super::watch::Watch;
use super::{Armed, Control, Controller, DriveError, Fault, PoseSource};
use crate::realtime::{Clock, Latency, Timer};
use crate::recording::{Recording, Sample};
use crate::{Board, Registers, Scale, Settings, Snapshot, Standing};
use fixed_kin::AXES;
use fixed_kin::registers::FAULT_COMMIT;
use fixed_kin::speed::SpeedMode;
use model::effects::Applied;
use model::fusion::FusionOptions;
use model::localisation::Localiser;
use model::trajectory::{Arrival, SetPoint};
use runs::frames::{Pose, Twist};
use runs::geometry::GeometryError;
use runs::robot::Robot;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// Time for the robot to come to rest after the last command, s.
const SETTLING_S: f64 = 0.25;
/// Control ticks that may fail to come, and the least time.
const SILENT_TICKS: u32 = 10;
const SILENT_S: f64 = 0.02;
/// A pose source that says nothing for so long is gone, s.
const SOURCE_SILENT_S: f64 = 0.5;

/// What to drive.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The robot; its effects are honoured where the card or the controller can: skew, angles and radii go
    /// into the coefficient registers, the camera's latency into the fusion.
    pub robot: Robot,
    /// Where to go.
    pub set_points: Vec<SetPoint>,
    /// Who steers.
    pub control: Control,
    /// Where the robot stands.
    pub start: Pose,
    /// Whether poses from outside correct the controller's; else odometry is all it has.
    pub fused: bool,
    /// Speeds and time-outs.
    pub settings: Settings,
    /// Longest drive, s.
    pub limit_s: f64,
}

impl Plan {
    /// Set points for a robot that stands at the origin.
    #[must_use]
    pub fn new(robot: &Robot, set_points: &[SetPoint]) -> Self {
        // A slow control loop commits seldom.
        let defaults = Settings::default();
        let watchdog_s = defaults.watchdog_s.max(5.0 * robot.tick_s());
        Self {
            robot: robot.clone(),
            set_points: set_points.to_vec(),
            control: Control::default(),
            start: Pose::default(),
            fused: false,
            settings: Settings { watchdog_s, speed_mode: SpeedMode::Difference, ..defaults },
            limit_s: 60.0,
        }
    }

    /// The robot as the controller believes it to be: its effects on geometry and the camera's latency are in
    /// its numbers and no longer effects, so that nothing applies them twice.
    #[must_use]
    pub fn believed(&self) -> Robot {
        let mut robot = Applied::geometry_of(&self.robot);
        let latency = robot.effect("camera-latency").and_then(|effect| effect.value("latency_s")).unwrap_or(0.0);
        robot.camera_latency_s = (robot.camera_latency_s + latency).max(0.0);
        robot.effects.retain(|effect| effect.name != "camera-latency");
        robot
    }

    /// What tells the controller where the robot is.
    ///
    /// # Errors
    /// [`GeometryError`] where the wheels do not tell how the robot moves.
    pub fn localiser(&self) -> Result<Localiser, GeometryError> {
        let robot = self.believed();
        let geometry = robot.geometry()?;
        Ok(if self.fused {
            Localiser::fused(&robot, &geometry, FusionOptions::of(&robot).uncalibrated(), self.start)
        } else {
            Localiser::odometry(&robot, &geometry, self.start)
        })
    }

    /// Conversions for this plan on a card with this clock.
    ///
    /// # Errors
    /// [`DriveError::Scale`] where the robot does not fit the card.
    pub fn scale(&self, clock_hz: f64) -> Result<Scale, DriveError> {
        Ok(Scale::new(&self.believed(), clock_hz)?)
    }

    /// Drives until the robot rests at the end, has given up, is stopped, or something is wrong.
    ///
    /// # Errors
    /// [`DriveError`] where nothing has moved yet: the card is not ours, cannot be configured or armed.
    pub fn drive<R: Registers>(
        &self,
        mut board: Board<R>,
        clock: &mut impl Clock,
        clock_hz: f64,
        source: &mut impl PoseSource,
        mut recording: Option<&mut Recording>,
        stop: &AtomicBool,
    ) -> Result<Driven, DriveError> {
        let robot = self.believed();
        let scale = Scale::new(&robot, clock_hz)?;
        let mut state = State::new(self, &robot, &scale)?;
        board.identify()?;
        board.configure(&scale, &self.settings)?;
        let period = Duration::from_secs_f64(scale.tick_s());
        let mut timer = Timer::new(period, clock);
        board.configuration_in_force(&scale, || {
            timer.wait(clock);
        })?;
        let (mut armed, stood) = Armed::new(board)?;
        state.driven.stood = stood;
        state.begin(&armed.snapshot()?, clock.now());
        let ending = loop {
            let wake = timer.wait(clock);
            state.driven.latency.add(&wake);
            if stop.load(Ordering::Relaxed) {
                break Ending::Stopped;
            }
            match state.tick(&mut armed, &scale, clock, source, recording.as_deref_mut()) {
                Ok(Step::Goes) => {}
                // The card's ticks and the timer's fall together: keep half a period away.
                Ok(Step::Beat) => timer.shift(period / 2),
                Ok(Step::Ends(ending)) => break ending,
                Err(fault) => break Ending::Fault(fault),
            }
        };
        let mut driven = state.driven;
        driven.switched_off = armed.disarm().map(drop).map_err(Fault::from);
        driven.arrivals = state.controller.arrivals().to_vec();
        driven.ending = ending;
        Ok(driven)
    }
}

/// Why a drive ended.
#[derive(Debug)]
pub enum Ending {
    /// At rest after the last set point.
    Finished,
    /// The longest time was over.
    TimeLimit,
    /// Somebody asked.
    Stopped,
    /// Something is wrong.
    Fault(Fault),
}

/// A drive that was driven.
#[derive(Debug)]
pub struct Driven {
    /// Why it ended.
    pub ending: Ending,
    /// Whether the card said that it is off; if not, its watchdog switches it off.
    pub switched_off: Result<(), Fault>,
    /// What stood in the card's sticky registers before it was armed, and was cleared.
    pub stood: Standing,
    /// What became of each set point.
    pub arrivals: Vec<Arrival>,
    /// Time of the last tick, s.
    pub t: f64,
    /// Where the robot is believed to be.
    pub pose: Pose,
    /// Control ticks of the card that the host saw.
    pub ticks: u64,
    /// Control ticks that went by unseen: the host was late.
    pub unseen: u64,
    /// Snapshots that could not be true and were read again.
    pub reread: u64,
    /// Commits that the card refused by their checksum; each was followed by a new one.
    pub refused: u64,
    /// How late the host woke up.
    pub latency: Latency,
    /// Longest time between two commits.
    pub silence: Duration,
    /// When the pose source fell silent for good, s; it may have begun so.
    pub source_gone: Option<f64>,
    /// Poses that came.
    pub poses: u64,
}

enum Step {
    Goes,
    Beat,
    Ends(Ending),
}

/// What the loop carries from tick to tick.
struct State<'a> {
    plan: &'a Plan,
    controller: Controller,
    localiser: Localiser,
    watch: Watch,
    before: Snapshot,
    first: u32,
    total: [i64; AXES],
    wheels: usize,
    command: Twist,
    settling_s: f64,
    seen_at: Duration,
    committed_at: Duration,
    posed_at: f64,
    driven: Driven,
}

impl<'a> State<'a> {
    fn new(plan: &'a Plan, robot: &Robot, scale: &Scale) -> Result<Self, DriveError> {
        Ok(Self {
            plan,
            controller: Controller::new(plan.control, robot, &plan.set_points, plan.start)?,
            localiser: plan.localiser()?,
            watch: Watch::new(robot, scale),
            before: Snapshot::default(),
            first: 0,
            total: [0; AXES],
            wheels: scale.wheels(),
            command: Twist::default(),
            settling_s: 0.0,
            seen_at: Duration::ZERO,
            committed_at: Duration::ZERO,
            posed_at: 0.0,
            driven: Driven {
                ending: Ending::TimeLimit,
                switched_off: Ok(()),
                stood: Standing::default(),
                arrivals: Vec::new(),
                t: 0.0,
                pose: plan.start,
                ticks: 0,
                unseen: 0,
                reread: 0,
                refused: 0,
                latency: Latency::new(),
                silence: Duration::ZERO,
                source_gone: None,
                poses: 0,
            },
        })
    }

    fn begin(&mut self, first: &Snapshot, now: Duration) {
        self.before = *first;
        self.first = first.sequence;
        (self.seen_at, self.committed_at) = (now, now);
    }

    /// A snapshot that can be true. A word that was misread is read again; what stays is a fault.
    fn look<R: Registers>(&mut self, armed: &mut Armed<R>, scale: &Scale) -> Result<(Snapshot, u32), Fault> {
        let mut doubt = None;
        for _ in 0..2 {
            let now = armed.snapshot()?;
            let ticks = now.sequence.wrapping_sub(self.before.sequence);
            // The snapshot of a tick before arming shows a card at rest.
            let fine = if !now.status.armed && ticks > 0 {
                Err(None)
            } else if ticks > u32::MAX / 2 {
                // Backwards: the design was loaded anew, or the word was misread.
                Err(Some(Fault::NoTick { silence: Duration::ZERO }))
            } else {
                self.watch.plausible(&self.before, &now, scale, ticks).map_err(Some)
            };
            match fine {
                Ok(()) => return Ok((now, ticks)),
                Err(why) => doubt = Some((now, why)),
            }
            self.driven.reread += 1;
        }
        let Some((now, why)) = doubt else { unreachable!("the loop above ran") };
        if let Some(fault) = why {
            return Err(fault);
        }
        // A card that was pulled out may read as zeros.
        armed.identify()?;
        Err(Fault::Disarmed { faults: now.faults, first: armed.first_fault()?, silence: self.driven.silence })
    }

    fn tick<R: Registers>(
        &mut self,
        armed: &mut Armed<R>,
        scale: &Scale,
        clock: &mut impl Clock,
        source: &mut impl PoseSource,
        recording: Option<&mut Recording>,
    ) -> Result<Step, Fault> {
        let (now, ticks) = self.look(armed, scale)?;
        let host = clock.now();
        if ticks == 0 {
            return self.wait_for_tick(armed, scale, host);
        }
        self.seen_at = host;
        for (total, (new, old)) in self.total.iter_mut().zip(now.counts.iter().zip(&self.before.counts)) {
            *total += i64::from(new.wrapping_sub(*old));
        }
        self.before = now;
        let t = f64::from(now.sequence.wrapping_sub(self.first)) * scale.tick_s();
        (self.driven.t, self.driven.ticks) = (t, self.driven.ticks + 1);
        self.driven.unseen += u64::from(ticks - 1);

        let seen = source.arrived(t);
        self.note_source(t, seen);
        let pose = self.localiser.tick(t, &self.total[..self.wheels], seen);
        self.driven.pose = pose;
        let in_force = self.command;
        let elapsed = scale.tick_s() * f64::from(ticks.min(SILENT_TICKS));
        let wanted = self.controller.command(pose, elapsed);
        self.command = wanted.unwrap_or_default();
        self.commit(armed, scale, host, now.faults)?;
        if let Some(recording) = recording {
            recording.push(Sample::of(t, in_force, &now, self.total, scale, f64::NAN).with_camera(seen));
        }
        self.watch.look(&now, &self.total, scale, ticks, host)?;

        self.settling_s = if wanted.is_none() { self.settling_s + elapsed } else { 0.0 };
        Ok(match () {
            () if self.settling_s > SETTLING_S => Step::Ends(self.arrived()),
            () if t >= self.plan.limit_s => Step::Ends(Ending::TimeLimit),
            // Two ticks although the timer missed none: the beat of two clocks.
            () if ticks == 2 => Step::Beat,
            () => Step::Goes,
        })
    }

    /// At rest: there, or given up.
    fn arrived(&self) -> Ending {
        let stuck = self.controller.arrivals().iter().enumerate().find_map(|(index, arrival)| match arrival {
            Arrival::Stuck { distance_m, .. } => Some(Fault::GaveUp { point: index + 1, distance_m: *distance_m }),
            _ => None,
        });
        stuck.map_or(Ending::Finished, Ending::Fault)
    }

    /// No new tick: the host was early, or the card stands.
    fn wait_for_tick<R: Registers>(
        &mut self,
        armed: &mut Armed<R>,
        scale: &Scale,
        host: Duration,
    ) -> Result<Step, Fault> {
        let silence = host.saturating_sub(self.seen_at);
        if silence.as_secs_f64() > SILENT_S.max(scale.tick_s() * f64::from(SILENT_TICKS)) {
            return Err(Fault::NoTick { silence });
        }
        self.commit(armed, scale, host, 0)?;
        Ok(Step::Beat)
    }

    fn commit<R: Registers>(
        &mut self,
        armed: &mut Armed<R>,
        scale: &Scale,
        host: Duration,
        faults: u32,
    ) -> Result<(), Fault> {
        if FAULT_COMMIT.is_set(faults) {
            self.driven.refused += 1;
            armed.clear_faults()?;
        }
        armed.set_twist(scale, self.command)?;
        self.driven.silence = self.driven.silence.max(host.saturating_sub(self.committed_at));
        self.committed_at = host;
        Ok(())
    }

    fn note_source(&mut self, t: f64, seen: Option<Pose>) {
        if seen.is_some() {
            self.posed_at = t;
            self.driven.poses += 1;
            self.driven.source_gone = None;
        } else if self.plan.fused && t - self.posed_at > SOURCE_SILENT_S {
            self.driven.source_gone = Some(self.posed_at);
        }
    }
}
