//! The same front before one real robot: the link by which a team drives it as it drives the simulated ones.

use crate::Code;
use crate::front::{Robots, State, Team};
use crate::messages::{SimulatorCommand, SimulatorError};
use crate::pilot::{Pilot, SharedPilot};
use crate::server::Sockets;
use crate::trigger::{Trigger, fastest};
use driver::drive::{DriveError, Driven, Ending, Fault, Plan, PoseSource, Session};
use driver::realtime::Clock;
use driver::recording::Recording;
use driver::{Board, BoardError, Registers, Scale};
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
}

impl Robots for CardRobot {
    fn robot(&mut self, team: Team, id: u32) -> Option<(Rc<RefCell<Pilot>>, State)> {
        let state = State { ball: self.ball, fault: None, fastest_kick: [fastest(), 0.0], dribbler: false };
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
}

/// Drives a card by what comes to the sockets, tick by tick, until somebody stops it or something is wrong. Between two
/// ticks at most a turn of datagrams is heard. Global velocities are turned by the robot's own pose.
///
/// # Errors
/// [`DriveError`] where nothing has moved yet.
pub fn drive<R: Registers, C: Clock, P: PoseSource>(
    plan: &Plan,
    (team, id): (Team, u32),
    link: Link<'_, R, C, P>,
    sockets: &mut Sockets,
    stop: &AtomicBool,
) -> Result<Driven, DriveError> {
    let Link { board, clock_hz, mut clock, mut source, mut recording } = link;
    let mut plan = plan.clone();
    plan.settings.kicker_charge_s = CHARGE_LIMIT_S;
    let scale: Scale = plan.scale(clock_hz)?;
    let pilot = Rc::new(RefCell::new(Pilot::new(&plan.believed())?));
    let mut robot = CardRobot { team, id, pilot: Rc::clone(&pilot), ball: false };
    let mut session = Session::begin(&plan, scale, SharedPilot(pilot), board, &mut clock)?;
    let mut trigger = Trigger::default();
    let ending = loop {
        session.wait(&mut clock);
        if stop.load(Ordering::Relaxed) {
            break Ending::Stopped;
        }
        sockets.serve(&mut robot, clock.now(), None);
        if let Some(ending) = session.tick(&mut clock, &mut source, recording.as_deref_mut()) {
            break ending;
        }
        robot.ball = session.seen().status.ball;
        let asked = robot.pilot.borrow().order_in_force().kick;
        if let Err(error) = trigger.tick(session.board(), asked) {
            break Ending::Fault(Fault::Board(BoardError::Bus(error)));
        }
    };
    Ok(session.end(ending))
}
