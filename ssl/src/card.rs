//! The same front before one real robot: the link by which a team drives it as it drives the simulated ones.

use crate::Code;
use crate::front::{Robots, State, Team};
use crate::messages::{SimulatorCommand, SimulatorError};
use crate::pilot::{Pilot, SharedPilot};
use crate::rest::Rest;
use crate::server::Sockets;
use crate::trigger::{Trigger, fastest};
use driver::drive::{DriveError, Driven, Ending, Fault, Plan, PoseSource, Session};
use driver::realtime::Clock;
use driver::recording::Recording;
use driver::{Board, BoardError, Registers, Scale};
use fixed_kin::registers::FAULT_EMERGENCY_STOP;
use std::cell::RefCell;
use std::rc::Rc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Time for which the kicker may charge without getting full, s.
const CHARGE_LIMIT_S: f64 = 4.0;

/// A robot on a card, by its team and number.
#[derive(Debug)]
pub struct CardRobot {
    /// The port whose commands it hears.
    pub team: Team,
    /// Its number in the team, 0 to 15.
    pub id: u32,
    pilot: Rc<RefCell<Pilot>>,
    ball: bool,
    rest: Option<Rest>,
}

impl Robots for CardRobot {
    fn robot(&mut self, team: Team, id: u32) -> Option<(Rc<RefCell<Pilot>>, State)> {
        let state = State {
            ball: self.ball,
            fault: self.rest.as_ref().map(Rest::words),
            fastest_kick: [fastest(), 0.0],
            dribbler: false,
        };
        ((team, id) == (self.team, self.id)).then(|| (Rc::clone(&self.pilot), state))
    }

    fn simulator(&mut self, _: &SimulatorCommand) -> Vec<SimulatorError> {
        vec![Code::NotSimulated.says("a real robot: it is neither teleported nor configured by message")]
    }
}

/// What a card's drive needs beside the sockets.
#[derive(Debug)]
pub struct Link<'a, R, C, P> {
    /// A card that runs our design, not yet armed.
    pub board: Board<R>,
    /// Its measured clock, Hz.
    pub clock_hz: f64,
    /// The time in which it lives.
    pub clock: C,
    /// Who sees the robot from outside.
    pub source: P,
    /// Where ticks are recorded.
    pub recording: Option<&'a mut Recording>,
    /// Whether a fault ends the drive; if not, the robot rests and is armed anew.
    pub fault_ends: bool,
}

/// What came of serving a card.
#[derive(Debug)]
pub struct Served {
    /// The drive, from the first tick to the last.
    pub driven: Driven,
    /// Faults after which the robot rested, in order: when by the drive's time (s), and what.
    pub faults: Vec<(f64, String)>,
}

/// Faults that nobody but a person may take back: after an emergency stop a machine does not start by itself (ISO
/// 13850).
fn is_final(fault: &Fault) -> bool {
    match fault {
        Fault::Disarmed { faults, .. } => FAULT_EMERGENCY_STOP.is_set(*faults),
        Fault::Board(BoardError::Arm(standing)) => FAULT_EMERGENCY_STOP.is_set(standing.faults),
        _ => false,
    }
}

/// Drives a card by what comes to the sockets, tick by tick, until somebody stops it or something is wrong. Between two
/// ticks at most a turn of datagrams is heard. Global velocities are turned by the robot's own pose. After a fault the
/// outputs are off and the team hears of it; once nobody has asked for motion for half a second, the card is armed anew,
/// as often as it takes.
///
/// # Errors
/// [`DriveError`] where nothing has moved yet.
pub fn drive<R: Registers, C: Clock, P: PoseSource>(
    plan: &Plan,
    (team, id): (Team, u32),
    link: Link<'_, R, C, P>,
    sockets: &mut Sockets,
    stop: &AtomicBool,
) -> Result<Served, DriveError> {
    let Link { board, clock_hz, mut clock, mut source, mut recording, fault_ends } = link;
    let mut plan = plan.clone();
    plan.settings.kicker_charge_s = CHARGE_LIMIT_S;
    let scale: Scale = plan.scale(clock_hz)?;
    let pilot = Rc::new(RefCell::new(Pilot::new(&plan.believed())?));
    let mut robot = CardRobot { team, id, pilot: Rc::clone(&pilot), ball: false, rest: None };
    let mut session = Session::begin(&plan, scale, SharedPilot(pilot), board, &mut clock)?;
    let mut trigger = Trigger::default();
    let (begun, mut faults) = (clock.now(), Vec::new());
    let mut heard_at = begun;
    let ending = loop {
        session.wait(&mut clock);
        let now = clock.now();
        let dt = (now - std::mem::replace(&mut heard_at, now)).as_secs_f64();
        if stop.load(Ordering::Relaxed) {
            break Ending::Stopped;
        }
        sockets.serve(&mut robot, now, None);
        if let Some(rest) = &mut robot.rest {
            let seen = session.idle(&mut clock, &mut source, recording.as_deref_mut());
            if (now - begun).as_secs_f64() >= plan.limit_s {
                break Ending::TimeLimit;
            }
            if !rest.passes(&mut robot.pilot.borrow_mut(), dt) {
                continue;
            }
            match seen.and_then(|()| resume(&mut session, &mut clock)) {
                Ok(()) => robot.rest = None,
                Err(fault) if is_final(&fault) => break Ending::Fault(fault),
                Err(fault) => rest.again(fault.to_string()),
            }
            continue;
        }
        let fault = match session.tick(&mut clock, &mut source, recording.as_deref_mut()) {
            Some(Ending::Fault(fault)) => fault,
            Some(ending) => break ending,
            None => {
                robot.ball = session.seen().status.ball;
                let asked = robot.pilot.borrow().order_in_force().kick;
                match trigger.tick(session.board(), asked) {
                    Ok(_) => continue,
                    Err(error) => Fault::Board(BoardError::Bus(error)),
                }
            }
        };
        if fault_ends || is_final(&fault) {
            break Ending::Fault(fault);
        }
        // A card that does not obey now is switched off by its watchdog.
        let why = match session.rest() {
            Ok(()) => fault.to_string(),
            Err(refused) => format!("{fault}; {refused}"),
        };
        (trigger, robot.ball) = (Trigger::default(), false);
        faults.push((session.so_far().t, why.clone()));
        robot.rest = Some(Rest::after(why, false));
    };
    Ok(Served { driven: session.end(ending), faults })
}

/// Arms again, unless an emergency stop came in between.
fn resume<R: Registers, S: driver::drive::Steer>(
    session: &mut Session<R, S>,
    clock: &mut impl Clock,
) -> Result<(), Fault> {
    let faults = session.seen().faults;
    if FAULT_EMERGENCY_STOP.is_set(faults) {
        return Err(Fault::Disarmed { faults, first: faults, silence: session.so_far().silence });
    }
    session.resume(clock)
}
