//! The overhead camera is off: a robot fetches a ball and drives to given coordinates by what it has on board.
//!
//! Before it starts, the robot believes to stand some centimetres from where it does. It looks, at rest, corrects its pose
//! by the field's lines and sees the ball. From far away a pixel is worth centimetres, so that it stops before the ball and
//! looks again; then it drives to the ball and to the coordinates, by the loop that drives a real robot, whose filter joins
//! wheels, gyroscope and the camera's matches to a pose.

pub mod page;

use crate::closed_loop::{Drive, Driven, LoopError};
use crate::eye::{Eye, Fault, RidingEye, SharedEye, Shot, shared};
use crate::fpga::BitTrue;
use crate::imu::VirtualImu;
use driver::drive::{NoSource, PoseSource};
use model::plant::{Contact, Creep};
use model::trajectory::SetPoint;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use runs::frames::{Pose, Twist};
use runs::robot::{ImuMount, Layout, Robot, SensorName};
use std::collections::BTreeMap;
use std::f64::consts::{FRAC_PI_2, PI};
use vision::field::Field;
use vision::localise::Estimate;
use vision::onboard::Glance;

/// From the middle of the robot to the ball at its front, m.
const REACH: f64 = 0.1;
/// Where the robot believes to stand before it looks: standard deviations, m, m, rad.
const ASTRAY: [f64; 3] = [0.04, 0.04, 0.03];
/// Seconds between two pictures while it drives.
const PICTURE_EVERY_S: f64 = 0.2;
/// Speed, m/s.
const SPEED: f64 = 1.0;
/// Distance from which the ball's place is good enough to drive to it, m: one row of the demo's camera is worth 10 mm.
const NEAR: f64 = 0.55;
/// From the robot's middle to the ball when it looks again, m.
const STAND_OFF: f64 = 0.4;
/// How far it goes ahead where it sees no ball, m.
const AHEAD: f64 = 0.4;
/// Looks at most before it gives the ball up.
const LOOKS: usize = 5;
/// How near to the coordinates it is to come, m.
pub const REACHED: f64 = 0.05;
/// What is left and needs no drive, m.
const CLOSE: f64 = 0.015;
/// Standard deviation of the place, in the direction where it is largest, with which 19 of 20 come within [`REACHED`] at
/// least, m: what [`CLOSE`] leaves, over the 95 % quantile of a circular normal distribution.
const NEEDED: f64 = (REACHED - CLOSE) / 2.45;
/// Other looks at most, from where the lines tell more, and how fast it turns there, rad/s.
const OTHER_LOOKS: usize = 3;
const TURN_RATE: f64 = 2.0;
/// Half the field that it drives on, m: the lines of division B.
const DRIVABLE: [f64; 2] = [4.4, 2.9];

/// What the robot has on board.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Senses {
    /// Encoders only.
    Wheels,
    /// Encoders and gyroscope.
    Gyroscope,
    /// Encoders, gyroscope and camera.
    Camera,
}

/// What a start came to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outcome {
    /// Least distance of the ball from the robot's front on the way, m.
    pub ball_miss: f64,
    /// Distance from the coordinates at the end, m.
    pub miss: f64,
}

/// A start from beginning to end.
#[derive(Debug)]
pub struct Story {
    /// What it came to.
    pub outcome: Outcome,
    /// The drives, between which the robot stands and looks.
    pub legs: Vec<Driven>,
    /// What it believed at the end of each drive, before it looked, and where it was.
    pub rests: Vec<(Estimate, Pose)>,
    /// What its camera took, where pictures were kept.
    pub shots: Vec<Shot>,
    /// How often a picture gave no pose, by the reason.
    pub refused: BTreeMap<String, usize>,
}

/// One start, all drawn by its seed: pose, hidden skew, ball, coordinates.
#[derive(Clone, Debug)]
pub struct Blackout {
    seed: u64,
    truth: Pose,
    told: Pose,
    skew: [f64; 3],
    ball: [f64; 2],
    target: [f64; 2],
}

/// Where the story is.
struct Now {
    truth: Pose,
    belief: Estimate,
    t: f64,
    legs: Vec<Driven>,
    rests: Vec<(Estimate, Pose)>,
}

impl Now {
    /// Where it stands, for a picture.
    fn rest(&self) -> (Pose, Twist) {
        (self.truth, Twist::default())
    }
}

impl Blackout {
    /// Where the ball lies and where to drive to, m.
    #[must_use]
    pub fn places(&self) -> [[f64; 2]; 2] {
        [self.ball, self.target]
    }

    /// The start of a seed, on a field of division B.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let mut off = |half: f64| rng.random_range(-half..half);
        loop {
            let truth = Pose::new(off(3.5), off(2.2), off(PI));
            let view = truth.theta + FRAC_PI_2;
            let (way, aside) = (1.2 + off(0.6), off(0.3));
            let ball = [truth.x + way * (view + aside).cos(), truth.y + way * (view + aside).sin()];
            let target = [ball[0] + off(1.2), ball[1] + off(1.2)];
            let told = Pose::new(
                truth.x + 1.7 * off(ASTRAY[0]),
                truth.y + 1.7 * off(ASTRAY[1]),
                truth.theta + 1.7 * off(ASTRAY[2]),
            );
            let skew = [off(0.03), off(0.03), off(0.03)];
            let inside = |p: [f64; 2]| p[0].abs() < 4.2 && p[1].abs() < 2.7;
            if inside(ball) && inside(target) {
                return Self { seed, truth, told, skew, ball, target };
            }
        }
    }

    /// Drives it.
    ///
    /// # Errors
    /// [`LoopError`] where the simulation fails.
    pub fn run(&self, senses: Senses) -> Result<Outcome, LoopError> {
        Ok(self.story(senses, None, false)?.outcome)
    }

    /// Drives it and tells how, with a fault of the camera if one is given, and with all its pictures where they are to be
    /// kept.
    ///
    /// # Errors
    /// [`LoopError`] where the simulation fails.
    pub fn story(&self, senses: Senses, fault: Option<Fault>, pictures: bool) -> Result<Story, LoopError> {
        let eye = Eye::new(Eye::small(), Field::DIVISION_B, Some(self.ball), self.seed).with_fault(fault);
        let eye = shared(if pictures { eye.keeping() } else { eye });
        let belief = Estimate::new(self.told, ASTRAY);
        let mut now = Now { truth: self.truth, belief, t: 0.0, legs: Vec::new(), rests: Vec::new() };
        // Without a camera the ball's place is told as it is, in the frame of the belief.
        let ball = if senses == Senses::Camera { self.search(&mut now, &eye)? } else { Some(self.ball) };
        let view = now.belief.pose.theta + FRAC_PI_2;
        let fetch =
            ball.map(|ball| SetPoint::stop(ball[0] - REACH * view.cos(), ball[1] - REACH * view.sin(), SPEED, 0.0));
        let last = SetPoint::stop(self.target[0], self.target[1], SPEED, 0.0);
        if senses == Senses::Camera {
            if let Some(fetch) = fetch {
                self.drive(&mut now, senses, &eye, &[fetch])?;
                self.look_round(&mut now, &eye, OTHER_LOOKS)?;
            }
            self.drive(&mut now, senses, &eye, &[last])?;
            self.settle(&mut now, &eye, last)?;
        } else {
            let set_points: Vec<SetPoint> = fetch.into_iter().chain([last]).collect();
            self.drive(&mut now, senses, &eye, &set_points)?;
        }
        let front = |pose: &Pose| {
            let view = pose.theta + FRAC_PI_2;
            (pose.x + REACH * view.cos() - self.ball[0]).hypot(pose.y + REACH * view.sin() - self.ball[1])
        };
        let track = now.legs.iter().flat_map(|leg| &leg.track);
        let outcome = Outcome {
            ball_miss: track.map(|(_, pose)| front(pose)).fold(f64::INFINITY, f64::min),
            miss: (now.truth.x - self.target[0]).hypot(now.truth.y - self.target[1]),
        };
        let mut eye = eye.borrow_mut();
        Ok(Story { outcome, legs: now.legs, rests: now.rests, shots: eye.take_shots(), refused: eye.refused().clone() })
    }

    /// Looks, and drives nearer, until the ball is seen from near by.
    fn search(&self, now: &mut Now, eye: &SharedEye) -> Result<Option<[f64; 2]>, LoopError> {
        let mut last = None;
        for _ in 0..LOOKS {
            let glance = eye.borrow_mut().look(0.0, now.rest(), &now.belief);
            let Ok(glance) = glance else { return Ok(last) };
            if let Ok(found) = glance.pose {
                now.belief = found;
            }
            let (pose, view) = (now.belief.pose, now.belief.pose.theta + FRAC_PI_2);
            let seen = eye.borrow().ball(&glance, pose);
            last = seen.or(last);
            let to = match seen {
                Some(ball) if (ball[0] - pose.x).hypot(ball[1] - pose.y) <= NEAR => return Ok(seen),
                Some(ball) => [ball[0] - STAND_OFF * view.cos(), ball[1] - STAND_OFF * view.sin()],
                None => [pose.x + AHEAD * view.cos(), pose.y + AHEAD * view.sin()],
            };
            let to = [0, 1].map(|i| to[i].clamp(-DRIVABLE[i], DRIVABLE[i]));
            self.drive(now, Senses::Camera, eye, &[SetPoint::stop(to[0], to[1], SPEED, 0.0)])?;
        }
        Ok(last)
    }

    /// Looks where it stands, and drives what is left.
    fn settle(&self, now: &mut Now, eye: &SharedEye, last: SetPoint) -> Result<(), LoopError> {
        // Back at the coordinates the place is known as well as the wheels bring it there: no second way to a better look.
        for others in [OTHER_LOOKS, 0] {
            self.look_round(now, eye, others)?;
            let pose = now.belief.pose;
            if (pose.x - last.x).hypot(pose.y - last.y) < CLOSE {
                return Ok(());
            }
            self.drive(now, Senses::Camera, eye, &[last])?;
        }
        Ok(())
    }

    /// Looks, and where that leaves the place open, turns or drives to where the lines should tell it, so often at most. A
    /// look there that contradicts or shows nothing ends it: the belief is not good enough to say where to look.
    fn look_round(&self, now: &mut Now, eye: &SharedEye, most: usize) -> Result<(), LoopError> {
        for others in 0..=most {
            match eye.borrow_mut().look(0.0, now.rest(), &now.belief) {
                Ok(Glance { pose: Ok(found), .. }) => now.belief = found,
                _ if others > 0 => return Ok(()),
                _ => {}
            }
            if now.belief.place_sd() <= NEEDED || others == most {
                return Ok(());
            }
            let Some(to) = eye.borrow().vantage(&now.belief, NEEDED) else { return Ok(()) };
            self.drive(now, Senses::Camera, eye, &[SetPoint::facing(to.x, to.y, SPEED, TURN_RATE, to.theta)])?;
        }
        Ok(())
    }

    /// Drives along set points to rest.
    fn drive(&self, now: &mut Now, senses: Senses, eye: &SharedEye, set_points: &[SetPoint]) -> Result<(), LoopError> {
        let mut robot = Robot::racbot();
        let mut card = BitTrue::new();
        if senses != Senses::Wheels {
            robot.imu = SensorName::new("icm-42688-p").map(ImuMount::upright);
            card = card.with_imu(VirtualImu::new(robot.control_rate_hz, self.seed));
        }
        let mut actual = robot.clone();
        actual.layout = Layout::Rac { body_radius_m: 0.085, skew_rad: self.skew };
        // The controller starts from its belief, the plant from the truth.
        let drive = Drive {
            actual,
            contact: Contact::Friction { friction_coefficient: 0.5, creep: Creep::at_rest(0.000_5) },
            fused: senses == Senses::Camera,
            start: now.belief.pose,
            start_covariance: Some(now.belief.covariance),
            sure_m: (senses == Senses::Camera).then(|| Field::DIVISION_B.sure_m()),
            stands: Some(now.truth),
            limit_s: 20.0,
            seed: self.seed,
            ..Drive::new(&robot, set_points)
        };
        eye.borrow_mut().begin(now.t);
        let source = |ride| -> Box<dyn PoseSource> {
            match senses {
                Senses::Camera => Box::new(RidingEye::new(ride, SharedEye::clone(eye), PICTURE_EVERY_S)),
                _ => Box::new(NoSource),
            }
        };
        let driven = drive.run_seen_by(card, source, |_| {})?;
        if let Some((t, pose)) = driven.track.last() {
            (now.truth, now.t) = (*pose, now.t + t);
        }
        eye.borrow_mut().begin(now.t);
        now.belief = Estimate { pose: driven.belief.pose, covariance: driven.belief.covariance, agreeing: 1.0 };
        now.rests.push((now.belief, now.truth));
        now.legs.push(driven);
        Ok(())
    }
}

#[cfg(test)]
mod tests;
