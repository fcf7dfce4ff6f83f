//! A drive tick by tick, for whoever keeps the time.

use super::heading::Feel;
use super::sure::Sure;
use super::watch::Watch;
use super::{Armed, DriveError, Driven, Ending, Fault, Plan, PoseSource, Steer};
use crate::realtime::{Clock, Latency, Timer};
use crate::recording::{Recording, Sample};
use crate::{Board, BoardError, Registers, Scale, Snapshot, Standing};
use fixed_kin::AXES;
use fixed_kin::registers::FAULT_COMMIT;
use model::localisation::Localiser;
use model::trajectory::Arrival;
use runs::frames::{Pose, Twist};
use std::time::Duration;

/// Time for the robot to come to rest after the last command, s.
const SETTLING_S: f64 = 0.25;
/// Control ticks that may fail to come, and the least time.
const SILENT_TICKS: u32 = 10;
const SILENT_S: f64 = 0.02;
/// A pose source that says nothing for so long is gone, s.
const SOURCE_SILENT_S: f64 = 0.5;

/// An armed card that is steered: [`Plan::drive`] tick by tick. Dropped in any way, the card is disarmed.
#[derive(Debug)]
pub struct Session<R: Registers, S> {
    armed: Armed<R>,
    scale: Scale,
    timer: Timer,
    state: State<S>,
}

impl<R: Registers, S: Steer> Session<R, S> {
    /// Identifies, configures and arms the card of a plan; `steer` takes the place of the plan's controller.
    ///
    /// # Errors
    /// [`DriveError`] where nothing has moved yet: the card is not ours, cannot be configured or armed.
    pub fn begin(
        plan: &Plan,
        scale: Scale,
        steer: S,
        mut board: Board<R>,
        clock: &mut impl Clock,
    ) -> Result<Self, DriveError> {
        let mut state = State::new(plan, steer, &scale)?;
        board.identify()?;
        board.configure(&scale, &plan.settings)?;
        let mut timer = Timer::new(Duration::from_secs_f64(scale.tick_s()), clock);
        board.configuration_in_force(&scale, || {
            timer.wait(clock);
        })?;
        if let Some(mount) = &plan.robot.imu {
            let imu = board.start_imu(mount, scale.clock_hz, clock)?;
            state.localiser = plan.localiser_with(Some(&imu))?;
            state.driven.belief = state.localiser.estimate();
            state.feel = Some(Feel::new(imu));
            state.driven.imu = Some(imu);
            timer = Timer::new(Duration::from_secs_f64(scale.tick_s()), clock);
        }
        let (mut armed, stood) = Armed::new(board)?;
        state.driven.stood = stood;
        let first = armed.snapshot()?;
        (state.before, state.first) = (first, first.sequence);
        (state.seen_at, state.committed_at) = (clock.now(), clock.now());
        Ok(Self { armed, scale, timer, state })
    }

    /// Sleeps until the next tick.
    pub fn wait(&mut self, clock: &mut impl Clock) {
        let wake = self.timer.wait(clock);
        self.state.driven.latency.add(&wake);
    }

    /// One tick: look, localise, steer, commit, record, watch. An ending where there is one; [`Session::end`] comes next.
    pub fn tick(
        &mut self,
        clock: &mut impl Clock,
        source: &mut impl PoseSource,
        recording: Option<&mut Recording>,
    ) -> Option<Ending> {
        match self.state.tick(&mut self.armed, &self.scale, clock, source, recording) {
            Ok(Step::Goes) => None,
            // The card's ticks and the timer's fall together: keep half a period away.
            Ok(Step::Beat) => {
                self.timer.shift(self.timer.period() / 2);
                None
            }
            Ok(Step::Ends(ending)) => Some(ending),
            Err(fault) => Some(Ending::Fault(fault)),
        }
    }

    /// Switches the outputs off and keeps the card, after a fault; [`Session::idle`] and [`Session::resume`] come next.
    ///
    /// # Errors
    /// [`Fault`] where the card does not obey: its watchdog then switches it off.
    pub fn rest(&mut self) -> Result<(), Fault> {
        self.state.command = Twist::default();
        Ok(self.board().disarm()?)
    }

    /// One tick with the outputs off: counts and poses are followed, so that the robot knows where it was pushed to.
    ///
    /// # Errors
    /// [`Fault`] where the card gives no proper answer.
    pub fn idle(
        &mut self,
        clock: &mut impl Clock,
        source: &mut impl PoseSource,
        recording: Option<&mut Recording>,
    ) -> Result<(), Fault> {
        self.state.idle(&mut self.armed, &self.scale, clock.now(), source, recording)
    }

    /// Arms the card again, after [`Session::rest`]. What stood in its sticky registers is cleared.
    ///
    /// # Errors
    /// [`Fault`] while a cause stands, and where the card no longer runs our design; the outputs stay off.
    pub fn resume(&mut self, clock: &mut impl Clock) -> Result<(), Fault> {
        let board: &mut Board<R> = &mut self.armed;
        board.identify()?;
        self.state.driven.stood = board.arm()?;
        let before = self.state.before;
        self.state.before = board.snapshot()?;
        if self.state.before.sequence.wrapping_sub(before.sequence) > u32::MAX / 2 {
            board.disarm()?;
            return Err(Fault::NoTick { silence: Duration::ZERO });
        }
        self.state.count(&before);
        (self.state.seen_at, self.state.committed_at) = (clock.now(), clock.now());
        self.state.watch = self.state.watch.anew();
        self.timer = Timer::new(self.timer.period(), clock);
        Ok(())
    }

    /// Disarms; what happened.
    pub fn end(self, ending: Ending) -> Driven {
        let mut driven = self.state.driven;
        driven.switched_off = self.armed.disarm().map(drop).map_err(Fault::from);
        driven.arrivals = self.state.steer.arrivals().to_vec();
        driven.ending = ending;
        driven
    }

    /// Who steers.
    pub fn steer(&mut self) -> &mut S {
        &mut self.state.steer
    }

    /// The card, for what is beside the wheels: kicker, LEDs.
    pub fn board(&mut self) -> &mut Board<R> {
        &mut self.armed
    }

    /// What the card said at the last tick.
    #[must_use]
    pub fn seen(&self) -> &Snapshot {
        &self.state.before
    }

    /// What happened so far.
    #[must_use]
    pub fn so_far(&self) -> &Driven {
        &self.state.driven
    }
}

/// What a tick showed.
struct Seen {
    t: f64,
    pose: Pose,
    camera: Option<Pose>,
}

enum Step {
    Goes,
    Beat,
    Ends(Ending),
}

/// What the loop carries from tick to tick.
#[derive(Debug)]
struct State<S> {
    fused: bool,
    limit_s: f64,
    steer: S,
    localiser: Localiser,
    feel: Option<Feel>,
    watch: Watch,
    sure: Option<Sure>,
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

impl<S: Steer> State<S> {
    fn new(plan: &Plan, steer: S, scale: &Scale) -> Result<Self, DriveError> {
        let localiser = plan.localiser()?;
        Ok(Self {
            fused: plan.fused,
            limit_s: plan.limit_s,
            steer,
            feel: None,
            watch: Watch::new(&plan.believed(), scale),
            sure: plan.sure_m.map(Sure::to),
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
                belief: localiser.estimate(),
                ticks: 0,
                unseen: 0,
                reread: 0,
                refused: 0,
                latency: Latency::new(),
                silence: Duration::ZERO,
                source_gone: None,
                imu: None,
                imu_gone: None,
                slips: 0,
                lost: 0,
                poses: 0,
            },
            localiser,
        })
    }

    fn read<R: Registers>(&mut self, armed: &mut Armed<R>) -> Result<Snapshot, BoardError> {
        let Some(feel) = &mut self.feel else { return armed.snapshot() };
        let (now, words) = armed.snapshot_with_imu()?;
        feel.see(&words, now.sequence);
        Ok(now)
    }

    /// A snapshot that can be true. A word that was misread is read again; what stays is a fault.
    fn look<R: Registers>(&mut self, armed: &mut Armed<R>, scale: &Scale) -> Result<(Snapshot, u32), Fault> {
        let mut doubt = None;
        for _ in 0..2 {
            let now = self.read(armed)?;
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

    /// Adds what the wheels turned since another snapshot.
    fn count(&mut self, before: &Snapshot) {
        for (total, (new, old)) in self.total.iter_mut().zip(self.before.counts.iter().zip(&before.counts)) {
            *total += i64::from(new.wrapping_sub(*old));
        }
    }

    /// Takes a new snapshot, the poses that came and the inertial sensor into the robot's own pose.
    fn follow(
        &mut self,
        now: Snapshot,
        ticks: u32,
        scale: &Scale,
        host: Duration,
        source: &mut impl PoseSource,
    ) -> Seen {
        self.seen_at = host;
        let before = std::mem::replace(&mut self.before, now);
        self.count(&before);
        let t = f64::from(now.sequence.wrapping_sub(self.first)) * scale.tick_s();
        (self.driven.t, self.driven.ticks) = (t, self.driven.ticks + 1);
        self.driven.unseen += u64::from(ticks - 1);
        let seen = source.arrived(t);
        self.note_source(t, seen.is_some());
        if let Some(feel) = &mut self.feel {
            self.localiser.feel(feel.corrected());
            self.driven.imu_gone = feel.gone(t);
        }
        let slipped = self.localiser.slips();
        let pose = self.localiser.tick(t, &self.total[..self.wheels], seen);
        self.driven.slips += u64::from(self.localiser.slips() && !slipped);
        self.driven.belief = self.localiser.estimate();
        source.believed(t, &self.driven.belief);
        Seen { t, pose, camera: seen.map(|seen| seen.pose) }
    }

    fn record(&self, recording: Option<&mut Recording>, t: f64, in_force: Twist, scale: &Scale, camera: Option<Pose>) {
        if let Some(recording) = recording {
            let felt = self.feel.as_ref().and_then(Feel::reading);
            let sample = Sample::of(t, in_force, &self.before, self.total, scale, f64::NAN);
            recording.push(sample.with_camera(camera).with_imu(felt.as_ref()));
        }
    }

    fn idle<R: Registers>(
        &mut self,
        armed: &mut Armed<R>,
        scale: &Scale,
        host: Duration,
        source: &mut impl PoseSource,
        recording: Option<&mut Recording>,
    ) -> Result<(), Fault> {
        let now = self.read(armed)?;
        let ticks = now.sequence.wrapping_sub(self.before.sequence);
        if ticks == 0 || ticks > u32::MAX / 2 {
            return Ok(());
        }
        self.watch.plausible(&self.before, &now, scale, ticks)?;
        let Seen { t, camera, .. } = self.follow(now, ticks, scale, host, source);
        self.record(recording, t, Twist::default(), scale, camera);
        Ok(())
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
        let Seen { t, pose, camera } = self.follow(now, ticks, scale, host, source);
        let elapsed = scale.tick_s() * f64::from(ticks.min(SILENT_TICKS));
        let in_force = self.command;
        let wanted = match self.looks(t, camera.is_some(), source.contradicts())? {
            Some(rate) => Some(self.steer.hold(pose, rate, elapsed)),
            None => self.steer.command(pose, elapsed),
        };
        self.command = wanted.unwrap_or_default();
        if let Some(feel) = &mut self.feel {
            self.command.omega = feel.steer(wanted, elapsed);
        }
        self.commit(armed, scale, host, now.faults)?;
        self.record(recording, t, in_force, scale, camera);
        self.watch.look(&now, &self.total, scale, ticks, host)?;

        self.settling_s = if wanted.is_none() { self.settling_s + elapsed } else { 0.0 };
        Ok(match () {
            () if self.settling_s > SETTLING_S => Step::Ends(self.arrived()),
            () if t >= self.limit_s => Step::Ends(Ending::TimeLimit),
            // Two ticks although the timer missed none: the beat of two clocks.
            () if ticks == 2 => Step::Beat,
            () => Step::Goes,
        })
    }

    /// Rate at which a robot that does not know where it is looks round, rad/s.
    fn looks(&mut self, t: f64, posed: bool, contradicted: bool) -> Result<Option<f64>, Fault> {
        let Some(sure) = &mut self.sure else { return Ok(None) };
        let looks = sure.judge(t, &self.driven.belief, posed, contradicted);
        self.driven.lost = sure.times();
        looks
    }

    /// At rest: there, or given up.
    fn arrived(&self) -> Ending {
        let stuck = self.steer.arrivals().iter().enumerate().find_map(|(index, arrival)| match arrival {
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

    fn note_source(&mut self, t: f64, seen: bool) {
        if seen {
            self.posed_at = t;
            self.driven.poses += 1;
            self.driven.source_gone = None;
        } else if self.fused && t - self.posed_at > SOURCE_SILENT_S {
            self.driven.source_gone = Some(self.posed_at);
        }
    }
}
