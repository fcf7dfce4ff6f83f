//! One simulated robot: the loop that drives a real one, over the bit-true FPGA, in the field's time.

use crate::contact::Hull;
use crate::meet::Body;
use crate::pilot::{Order, Pilot, SharedPilot};
use crate::rest::Rest;
use crate::trigger::Trigger;
use driver::drive::{Ending, Fault, NoSource, Plan, Session};
use driver::realtime::Clock;
use driver::{Board, Scale};
use fixed_kin::registers::FAULT_STALL;
use model::camera::CameraModel;
use model::effects::Applied;
use runs::frames::{Pose, Twist};
use runs::robot::{Robot, Support};
use simulator::closed_loop::{LoopError, VirtualRobot, whole_tick_clock_hz};
use simulator::fpga::BitTrue;
use std::cell::RefCell;
use std::fmt::Display;
use std::rc::Rc;
use std::time::Duration;

/// Time in which an empty kicker charges, s, and for which the card lets it.
const CHARGE_S: f64 = 1.0;
const CHARGE_LIMIT_S: f64 = 4.0;
/// Time after a touch in which a wheel that stands or lags was held by it, s: the watch doubts no longer.
const TOUCHED_S: f64 = 1.0;
/// Friction coefficient of rubber rollers on carpet once something else moves the robot. An assumption: it lets a strong
/// robot brake with half of gravity.
const GRIP: f64 = 0.5;

/// What kind of robot it is.
#[derive(Clone, Debug, PartialEq)]
pub struct Kind {
    /// As its own controller believes it to be; effects in it are none of its business.
    pub believed: Robot,
    /// As it is, with its effects.
    pub actual: Robot,
    /// Its outside.
    pub hull: Hull,
    /// Fastest straight and chip kick that it is allowed, m/s.
    pub fastest_kick: [f64; 2],
}

impl Kind {
    /// A robot of a file: its effects are what its controller does not know.
    #[must_use]
    pub fn of(robot: &Robot) -> Self {
        let believed = Robot { effects: Vec::new(), ..robot.clone() };
        let fastest = crate::trigger::fastest();
        Self { believed, actual: robot.clone(), hull: Hull::standard(), fastest_kick: [fastest; 2] }
    }
}

type Driving = Session<VirtualRobot<BitTrue>, SharedPilot>;

/// A robot on the field.
#[derive(Debug)]
pub struct SimulatedRobot {
    kind: Kind,
    applied: Applied,
    plan: Plan,
    scale: Scale,
    robot: VirtualRobot<BitTrue>,
    /// The field's time at which the robot's own began.
    since: Duration,
    pilot: Rc<RefCell<Pilot>>,
    session: Option<Driving>,
    rest: Option<Rest>,
    /// Since it touched a robot, the ball or a board, s.
    untouched_s: f64,
    trigger: Trigger,
    /// Energy of the kicker's capacitor as a share of the full one.
    charge: f64,
}

impl SimulatedRobot {
    /// A robot at rest, armed; its time begins at the field's time `now`.
    ///
    /// # Errors
    /// [`LoopError`] where the robot does not fit the card.
    pub fn new(kind: Kind, pose: Pose, now: Duration) -> Result<Self, LoopError> {
        let mut plan = Plan { limit_s: f64::INFINITY, start: pose, ..Plan::new(&kind.believed, &[]) };
        plan.settings.kicker_charge_s = CHARGE_LIMIT_S;
        let scale = plan.scale(whole_tick_clock_hz(kind.believed.control_rate_hz))?;
        let applied = Applied::of(&kind.actual);
        let mut new = Self {
            robot: placed(&applied, &scale, pose, Twist::default())?,
            pilot: Rc::new(RefCell::new(Pilot::new(&kind.believed)?)),
            kind,
            applied,
            plan,
            scale,
            since: now,
            session: None,
            rest: None,
            untouched_s: f64::INFINITY,
            trigger: Trigger::default(),
            charge: 1.0,
        };
        new.arm()?;
        Ok(new)
    }

    fn arm(&mut self) -> Result<(), LoopError> {
        let steer = SharedPilot(Rc::clone(&self.pilot));
        let mut clock = self.robot.clone();
        self.trigger = Trigger::default();
        let board = Board::new(self.robot.clone());
        self.session = Some(Session::begin(&self.plan, self.scale.clone(), steer, board, &mut clock)?);
        self.rest = None;
        Ok(())
    }

    /// The robot as believed and as it is, its hull, its fastest kicks.
    #[must_use]
    pub fn kind(&self) -> &Kind {
        &self.kind
    }

    /// How a camera sees it.
    #[must_use]
    pub fn camera(&self) -> CameraModel {
        self.applied.camera
    }

    /// True pose on the field.
    #[must_use]
    pub fn pose(&self) -> Pose {
        self.robot.pose()
    }

    /// True velocity in the body's frame.
    #[must_use]
    pub fn twist(&self) -> Twist {
        self.robot.twist()
    }

    /// Who steers.
    #[must_use]
    pub fn pilot(&self) -> &Rc<RefCell<Pilot>> {
        &self.pilot
    }

    /// The order in force.
    #[must_use]
    pub fn order(&self) -> Order {
        self.pilot.borrow().order_in_force()
    }

    /// Why it is switched off, if it is, and how it is had back.
    #[must_use]
    pub fn fault(&self) -> Option<String> {
        self.rest.as_ref().map(Rest::words)
    }

    /// Whether the card's ball sensor saw the ball at the last tick.
    #[must_use]
    pub fn has_ball(&self) -> bool {
        self.session.as_ref().is_some_and(|session| session.seen().status.ball)
    }

    /// Puts it somewhere else.
    pub fn place(&mut self, pose: Pose, twist: Twist) {
        self.robot.place(pose, twist);
        self.pilot.borrow_mut().begin(twist);
    }

    /// How others meet it.
    #[must_use]
    pub fn body(&self) -> Body {
        let (pose, twist, robot) = (self.pose(), self.twist(), &self.applied.robot);
        let inverse_mass = if robot.support == Support::Floor { 1.0 / robot.mass_kg } else { 0.0 };
        Body { place: [pose.x, pose.y], velocity: pose.rotate_to_world([twist.vx, twist.vy]), inverse_mass }
    }

    /// Something hit it: its place (m) and velocity (m/s) change by so much, along the field's axes.
    pub fn strike(&mut self, moved: [f64; 2], changed: [f64; 2]) {
        self.robot.strike(moved, changed, GRIP);
        self.untouched_s = 0.0;
    }

    /// Lets time pass until the field's time `until`, with the ball before the sensor or not. The speed and elevation of
    /// a kick that happened.
    pub fn advance(&mut self, until: Duration, ball: bool) -> Option<[f64; 2]> {
        let mut kicked = None;
        let period = Duration::from_secs_f64(self.scale.tick_s());
        let full = self.charge >= 1.0;
        self.robot.fpga(|fpga| (fpga.pins.ball, fpga.pins.kicker_full) = (ball, full));
        let mut clock = self.robot.clone();
        while self.since + clock.now() + period <= until {
            self.pilot.borrow_mut().heading = Some(self.robot.pose().theta);
            self.untouched_s += period.as_secs_f64();
            match self.session.as_mut() {
                Some(session) => {
                    session.wait(&mut clock);
                    let ending = session.tick(&mut clock, &mut NoSource, None);
                    let asked = self.pilot.borrow().order_in_force().kick;
                    match (ending, self.trigger.tick(session.board(), asked)) {
                        (None, Ok(kick)) => kicked = kicked.or(kick.map(|kick| self.shot(kick.speed, kick.angle))),
                        (Some(Ending::Fault(fault)), _) => self.switch_off(&fault, self.is_held(&fault)),
                        (_, Err(error)) => self.switch_off(&error, false),
                        (Some(_), Ok(_)) => self.switch_off(&"the drive ended", false),
                    }
                }
                None => self.rest(&mut clock, period),
            }
            if self.trigger.charges() {
                self.charge = (self.charge + period.as_secs_f64() / CHARGE_S).min(1.0);
            }
            // Nobody reads it.
            drop(self.robot.take_history());
            if let Some(failure) = self.robot.take_failure() {
                self.begin_anew(&failure.to_string(), until);
                return kicked;
            }
        }
        kicked
    }

    /// The speed of a kick by what the capacitor held, which is then empty.
    fn shot(&mut self, speed: f64, angle: f64) -> [f64; 2] {
        let speed = speed * self.charge.sqrt();
        self.charge = 0.0;
        [speed, angle]
    }

    /// Whether a fault came of wheels that were held from outside.
    fn is_held(&self, fault: &Fault) -> bool {
        let held = match fault {
            Fault::StandsStill { .. } | Fault::Backwards { .. } | Fault::DoesNotFollow { .. } => true,
            Fault::Disarmed { faults, .. } => FAULT_STALL.is_set(*faults),
            _ => false,
        };
        held && self.untouched_s < TOUCHED_S
    }

    fn switch_off(&mut self, why: &dyn Display, stalled: bool) {
        // Dropped, the session disarms.
        self.session = None;
        self.trigger = Trigger::default();
        self.rest = Some(Rest::after(why.to_string(), stalled));
    }

    /// Switched off: once nobody asks for motion any more, it is armed anew; after a stall, motors that cooled so long may
    /// try again.
    fn rest(&mut self, clock: &mut VirtualRobot<BitTrue>, period: Duration) {
        let at = clock.now() + period;
        clock.sleep_until(at);
        let passed =
            self.rest.as_mut().is_none_or(|rest| rest.passes(&mut self.pilot.borrow_mut(), period.as_secs_f64()));
        if passed
            && let Err(error) = self.arm()
            && let Some(rest) = &mut self.rest
        {
            rest.again(error.to_string());
        }
    }

    /// The FPGA's simulation cannot go on: another one in its place, at rest.
    fn begin_anew(&mut self, why: &str, now: Duration) {
        if let Ok(robot) = placed(&self.applied, &self.scale, self.robot.pose(), Twist::default()) {
            self.session = None;
            self.robot = robot;
            self.since = now;
        }
        self.switch_off(&why, false);
    }
}

/// The robot with its effects behind a new card.
fn placed(
    applied: &Applied,
    scale: &Scale,
    pose: Pose,
    twist: Twist,
) -> Result<VirtualRobot<BitTrue>, runs::geometry::GeometryError> {
    let plant = applied.plant()?.at(pose).moving(twist);
    let period = Duration::from_secs_f64(scale.tick_s());
    Ok(VirtualRobot::new(BitTrue::new(), plant, applied.robot.supply_v, period))
}
