//! The on-board camera of a simulated robot: a renderer in front of `vision::onboard`, with a camera's faults.

use crate::closed_loop::VirtualRobot;
use crate::fpga::Fpga;
use crate::virtual_card::SharedCard;
use driver::drive::PoseSource;
use model::measurement::Measurement;
use model::odometry;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use runs::frames::{Pose, Twist};
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::f64::consts::FRAC_PI_2;
use std::rc::Rc;
use vision::ball;
use vision::camera::Camera;
use vision::field::Field;
use vision::localise::Estimate;
use vision::onboard::{Glance, OnBoard};
use vision::picture::{Picture, Unusable};
use vision::render::{Sensor, Shutter, World, render};

/// How long the shutter is open, s: a period of the light of lamps on 50 Hz, with which pictures do not flicker.
const EXPOSURE_S: f64 = 0.01;

/// What is wrong with the camera.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// It sends its first frame for ever.
    Frozen,
    /// Its lens is covered.
    Black,
    /// Its exposure is far too long.
    OverExposed,
    /// Its driver sends another size than the calibration's.
    Size,
    /// It was bent down by 11° after its calibration.
    Calibration,
}

impl Fault {
    /// For tests that go through every fault.
    pub const ALL: [Self; 5] = [Self::Frozen, Self::Black, Self::OverExposed, Self::Size, Self::Calibration];
}

/// A picture that was taken.
#[derive(Clone, Debug)]
pub struct Shot {
    /// When, s.
    pub t: f64,
    /// What the camera saw then.
    pub picture: Picture,
    /// What was found, or why the frame could not be used.
    pub glance: Result<Glance, Unusable>,
    /// Where the robot was.
    pub truth: Pose,
    /// Where it was believed to be.
    pub believed: Pose,
}

/// A robot's camera in a rendered hall. It looks along the body's y axis.
#[derive(Debug)]
pub struct Eye {
    onboard: OnBoard,
    world: World,
    rng: ChaCha8Rng,
    fault: Option<Fault>,
    first: Option<Picture>,
    shots: Option<Vec<Shot>>,
    /// How often a frame gave no pose, by the reason.
    refused: BTreeMap<String, usize>,
    /// When the drive that it rides on began, s.
    began: f64,
}

impl Eye {
    /// A camera of a field with this ball on it, m.
    #[must_use]
    pub fn new(camera: Camera, field: Field, ball: Option<[f64; 2]>, seed: u64) -> Self {
        let plain = World::plain(field, seed as u32);
        let world = ball.map_or_else(|| plain.clone(), |[x, y]| plain.clone().with_ball(x, y));
        Self {
            onboard: OnBoard::new(camera, field),
            world,
            rng: ChaCha8Rng::seed_from_u64(seed + 7),
            fault: None,
            first: None,
            shots: None,
            refused: BTreeMap::new(),
            began: 0.0,
        }
    }

    /// The camera of a small robot, 320 by 240 pixels.
    #[must_use]
    pub fn small() -> Camera {
        // Read out, sent over USB and decoded: a frame and a half at 30 Hz.
        Camera { distortion: [-0.08, 0.0], latency_s: 0.05, ..Camera::ideal(320, 240, 1.25, 0.15, 0.33) }
    }

    /// With a fault from now on.
    #[must_use]
    pub fn with_fault(self, fault: Option<Fault>) -> Self {
        Self { fault, ..self }
    }

    /// Keeps every picture.
    #[must_use]
    pub fn keeping(self) -> Self {
        Self { shots: Some(Vec::new()), ..self }
    }

    /// What was kept; forgotten here.
    pub fn take_shots(&mut self) -> Vec<Shot> {
        self.shots.as_mut().map(std::mem::take).unwrap_or_default()
    }

    /// How often a frame gave no pose, by the reason.
    #[must_use]
    pub fn refused(&self) -> &BTreeMap<String, usize> {
        &self.refused
    }

    /// Where a ball in the picture lies on the field, by where the robot is believed to be.
    #[must_use]
    pub fn ball(&self, glance: &Glance, believed: Pose) -> Option<[f64; 2]> {
        let [forward, left] = glance.scene.balls.first()?.place(self.onboard.camera(), ball::RADIUS)?;
        let (s, c) = (believed.theta + FRAC_PI_2).sin_cos();
        Some([believed.x + forward * c - left * s, believed.y + forward * s + left * c])
    }

    /// Whether frame after frame contradicts what is believed, as `vision::onboard::OnBoard::refuted`.
    #[must_use]
    pub fn refuted(&self) -> bool {
        self.onboard.refuted()
    }

    /// Where to stand for a look that should tell the place, as `vision::onboard::OnBoard::vantage`.
    #[must_use]
    pub fn vantage(&self, believed: &Estimate, needed: f64) -> Option<Pose> {
        self.onboard.vantage(believed, needed)
    }

    /// Counts the times of pictures from here on, s.
    pub fn begin(&mut self, t: f64) {
        self.began = t;
    }

    /// Takes a picture of where the robot is, blurred by how it moves, and looks at it.
    ///
    /// # Errors
    /// [`Unusable`], as `vision::onboard::OnBoard::glance`.
    pub fn look(&mut self, t: f64, (truth, twist): (Pose, Twist), predicted: &Estimate) -> Result<Glance, Unusable> {
        let picture = self.take(truth, twist);
        let glance = self.onboard.glance(&picture, predicted);
        let why = match &glance {
            Ok(Glance { pose: Ok(_), .. }) => None,
            Ok(Glance { pose: Err(refused), .. }) => Some(refused.kind().to_owned()),
            Err(unusable) => Some(unusable.to_string()),
        };
        if let Some(why) = why {
            *self.refused.entry(why).or_default() += 1;
        }
        if let Some(shots) = &mut self.shots {
            shots.push(Shot { t: self.began + t, picture, glance: glance.clone(), truth, believed: predicted.pose });
        }
        glance
    }

    fn take(&mut self, truth: Pose, twist: Twist) -> Picture {
        let [vx, vy, omega] = truth.world_velocity(twist);
        let shutter = Shutter {
            pose: [truth.x, truth.y, truth.theta + FRAC_PI_2],
            moved: [EXPOSURE_S * vx, EXPOSURE_S * vy],
            turn: EXPOSURE_S * omega,
            ..Shutter::default()
        };
        let mut camera = *self.onboard.camera();
        let mut sensor = Sensor::GOOD;
        match self.fault {
            Some(Fault::Frozen) => {
                if let Some(first) = &self.first {
                    return first.clone();
                }
            }
            Some(Fault::Black) => sensor.exposure = 0.0,
            Some(Fault::OverExposed) => sensor.exposure = 100.0,
            Some(Fault::Size) => camera = Camera { width: camera.width / 2, height: camera.height / 2, ..camera },
            Some(Fault::Calibration) => camera.tilt += 0.19,
            None => {}
        }
        let picture = render(&self.world, &camera, shutter, &sensor, 1, &mut self.rng).picture;
        self.first.get_or_insert_with(|| picture.clone());
        picture
    }
}

/// A camera that a pose source and whoever asks it afterwards share.
pub type SharedEye = Rc<RefCell<Eye>>;

/// Shares a camera.
#[must_use]
pub fn shared(eye: Eye) -> SharedEye {
    Rc::new(RefCell::new(eye))
}

/// A simulated robot that carries a camera.
pub trait Carrier {
    /// Where it is, and how it moves.
    fn motion(&self) -> (Pose, Twist);
}

impl Carrier for SharedCard {
    fn motion(&self) -> (Pose, Twist) {
        Self::motion(self)
    }
}

impl<F: Fpga> Carrier for VirtualRobot<F> {
    fn motion(&self) -> (Pose, Twist) {
        (self.pose(), self.twist())
    }
}

/// A camera on a simulated robot, as the source of its poses.
#[derive(Debug)]
pub struct RidingEye<C> {
    carrier: C,
    eye: SharedEye,
    /// Seconds between two pictures, and when the next one is due.
    every: f64,
    due: f64,
    believed: Option<odometry::Estimate>,
    /// What the last picture told, and when it is delivered.
    waiting: Option<Measurement>,
    delivered: f64,
    latency_s: f64,
}

impl<C: Carrier> RidingEye<C> {
    /// A camera that takes a picture every so many seconds, which is less often than it delivers them late.
    #[must_use]
    pub fn new(carrier: C, eye: SharedEye, every: f64) -> Self {
        let latency_s = eye.borrow().onboard.camera().latency_s.min(every);
        Self { carrier, eye, every, due: 0.0, believed: None, waiting: None, delivered: 0.0, latency_s }
    }

    /// Takes a picture, as the robot stands and moves, and looks at it.
    fn look(&self, t: f64, believed: odometry::Estimate) -> Option<Measurement> {
        let predicted = Estimate { pose: believed.pose, covariance: believed.covariance, agreeing: 1.0 };
        let glance = self.eye.borrow_mut().look(t, self.carrier.motion(), &predicted).ok()?;
        let plain = |found: Estimate| odometry::Estimate { pose: found.pose, covariance: found.covariance };
        match glance.instead {
            Some(found) => Some(Measurement::instead(plain(found), t)),
            None => Some(Measurement::posterior(plain(glance.pose.ok()?), believed, t)),
        }
    }
}

impl<C: Carrier> PoseSource for RidingEye<C> {
    fn arrived(&mut self, t: f64) -> Option<Measurement> {
        if let Some(believed) = self.believed.filter(|_| t >= self.due) {
            self.due = t + self.every;
            self.delivered = t + self.latency_s;
            self.waiting = self.look(t, believed);
        }
        self.waiting.take_if(|_| t >= self.delivered)
    }

    fn contradicts(&self) -> bool {
        self.eye.borrow().refuted()
    }

    fn believed(&mut self, _: f64, belief: &odometry::Estimate) {
        self.believed = Some(*belief);
    }
}
