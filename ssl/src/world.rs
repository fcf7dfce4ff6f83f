//! The field with robots and a ball: a state machine of simulated time, which no clock and no socket is part of.

mod config;
mod contacts;
mod vision;

use crate::ball::Ball;
use crate::field::Field;
use crate::front::{Robots, State, Team};
use crate::messages::{SimulatorCommand, SimulatorError};
use crate::pilot::Pilot;
use crate::robot::{Kind, SimulatedRobot};
use model::camera::Camera;
use runs::frames::Pose;
use runs::vision::WrapperPacket;
use simulator::closed_loop::LoopError;
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::rc::Rc;
use std::time::Duration;

/// Step of the ball, of contacts and of the field's time; robots tick by their own control rate.
pub const STEP: Duration = Duration::from_millis(1);
/// Distance between robots of a team when they line up, and of the line from the halfway line, m.
const SPACING: f64 = 0.4;
const LINE: f64 = 1.0;

/// What there is at first.
#[derive(Clone, Debug)]
pub struct Options {
    /// Its size and lines.
    pub field: Field,
    /// Robots: team, number, kind.
    pub robots: Vec<(Team, u32, Kind)>,
    /// The kind of robots that a teleport puts on the field.
    pub newcomer: Kind,
    /// Frames of vision a second.
    pub vision_hz: f64,
    /// Time of the Unix epoch at which simulated time begins, s.
    pub epoch_s: f64,
    /// Seed of the cameras' noise.
    pub seed: u64,
}

/// A field in simulated time.
#[derive(Debug)]
pub struct World {
    field: Field,
    robots: BTreeMap<(Team, u32), SimulatedRobot>,
    newcomer: Kind,
    ball: Ball,
    time: Duration,
    /// Simulated seconds a second.
    speed: f64,
    vision_hz: f64,
    epoch_s: f64,
    seed: u64,
    cameras: BTreeMap<Option<(Team, u32)>, Camera>,
    frames: u64,
    vision_port: Option<u16>,
}

impl World {
    /// A field with its robots lined up and armed, and the ball in the middle.
    ///
    /// # Errors
    /// [`LoopError`] where a robot does not fit the card.
    pub fn new(options: Options) -> Result<Self, LoopError> {
        let mut world = Self {
            field: options.field,
            robots: BTreeMap::new(),
            newcomer: options.newcomer,
            ball: Ball::default(),
            time: Duration::ZERO,
            speed: 1.0,
            vision_hz: options.vision_hz,
            epoch_s: options.epoch_s,
            seed: options.seed,
            cameras: BTreeMap::new(),
            frames: 0,
            vision_port: None,
        };
        for team in [Team::Blue, Team::Yellow] {
            let of_team: Vec<_> = options.robots.iter().filter(|robot| robot.0 == team).collect();
            for (place, (_, id, kind)) in of_team.iter().enumerate() {
                let y = SPACING * (place as f64 - 0.5 * (of_team.len() as f64 - 1.0));
                // Each side looks at the other: yellow from the left.
                let (x, orientation) = if team == Team::Yellow { (-LINE, 0.0) } else { (LINE, PI) };
                world.robots.insert(
                    (team, *id),
                    SimulatedRobot::new(kind.clone(), Pose::from_league(x, y, orientation), Duration::ZERO)?,
                );
            }
        }
        Ok(world)
    }

    /// Lets [`STEP`] pass. A frame of vision where one is due.
    pub fn step(&mut self) -> Option<WrapperPacket> {
        self.time += STEP;
        let dt = STEP.as_secs_f64();
        self.ball.step(dt, self.field.half());
        for robot in self.robots.values_mut() {
            let hull = robot.kind().hull;
            let kicked = robot.advance(self.time, hull.sees(robot.pose(), &self.ball));
            let (pose, twist) = (robot.pose(), robot.twist());
            if let Some([speed, angle]) = kicked {
                hull.kick(pose, twist, speed, angle, &mut self.ball);
            }
            hull.dribble(pose, twist, robot.order().dribbler_rpm, &mut self.ball, dt);
        }
        self.meet();
        self.frame_due().then(|| self.see())
    }

    /// Steps to the next frame of vision.
    pub fn next_frame(&mut self) -> WrapperPacket {
        loop {
            if let Some(packet) = self.step() {
                return packet;
            }
        }
    }

    /// Simulated time.
    #[must_use]
    pub fn time(&self) -> Duration {
        self.time
    }

    /// Simulated seconds a second; 0 is a pause.
    #[must_use]
    pub fn speed(&self) -> f64 {
        self.speed
    }

    /// Where it is and how it moves.
    #[must_use]
    pub fn ball(&self) -> &Ball {
        &self.ball
    }

    /// A robot on the field.
    #[must_use]
    pub fn robot_of(&self, team: Team, id: u32) -> Option<&SimulatedRobot> {
        self.robots.get(&(team, id))
    }

    /// Robots on the field.
    #[must_use]
    pub fn robot_count(&self) -> usize {
        self.robots.len()
    }

    /// The port that vision is to be sent to from now on, if somebody asked since the last call.
    pub fn take_vision_port(&mut self) -> Option<u16> {
        self.vision_port.take()
    }
}

impl Robots for World {
    fn robot(&mut self, team: Team, id: u32) -> Option<(Rc<RefCell<Pilot>>, State)> {
        let robot = self.robots.get(&(team, id))?;
        let state = State {
            ball: robot.has_ball(),
            fault: robot.fault(),
            fastest_kick: robot.kind().fastest_kick,
            dribbler: true,
        };
        Some((Rc::clone(robot.pilot()), state))
    }

    fn simulator(&mut self, command: &SimulatorCommand) -> Vec<SimulatorError> {
        let mut errors = Vec::new();
        if let Some(config) = &command.config {
            self.configure(config, &mut errors);
        }
        if let Some(control) = &command.control {
            self.control(control, &mut errors);
        }
        errors
    }
}
