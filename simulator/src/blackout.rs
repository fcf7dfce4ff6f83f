//! The overhead camera is off: a robot fetches a ball and drives to given coordinates by what it has on board.
//!
//! Before it starts, the robot believes to stand some centimetres from where it does. It looks once, at rest, corrects
//! its pose by the field's lines and sees the ball; it drives to the ball and then to the coordinates, by the loop that
//! drives a real robot. On the way [`OnBoard`] joins wheels, gyroscope and the camera's matches to a pose.

use crate::closed_loop::{Drive, LoopError, VirtualRobot};
use crate::fpga::{BitTrue, Fpga};
use driver::drive::PoseSource;
use model::camera::CameraModel;
use model::fusion::FusionOptions;
use model::imu::{Imu, ImuModel, Motion};
use model::inertial::Inertial;
use model::plant::Contact;
use model::trajectory::SetPoint;
use nalgebra::{Matrix3, Vector3};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use runs::frames::{Pose, Twist, wrap_angle};
use runs::robot::{Layout, Robot};
use std::f64::consts::{FRAC_PI_2, PI};
use vision::ball::DEFAULT_SCORE;
use vision::camera::Camera;
use vision::field::Field;
use vision::localise::{Estimate, Map, track};
use vision::render::{BALL_RADIUS, Sensor, Shutter, World, render};
use vision::{Scene, detect};

/// From the middle of the robot to the ball at its front, m.
const REACH: f64 = 0.1;
/// Ticks between two pictures: ten a second.
const PICTURE_EVERY: u64 = 100;
/// Ticks between two poses for the control loop.
const POSE_EVERY: u64 = 16;
/// Where the robot believes to stand before it looks: standard deviations, m, m, rad.
const ASTRAY: [f64; 3] = [0.04, 0.04, 0.03];
/// Standard deviations of the poses that the control loop gets.
const POSE_SD: [f64; 3] = [0.01, 0.01, 0.01];
/// Speed, m/s.
const SPEED: f64 = 1.0;
/// A match is believed where its standard deviations stay below these (m, rad): it never drives on a guess.
const SURE: [f64; 2] = [0.08, 0.08];

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

/// The camera of the demo, 240 by 180 pixels.
#[must_use]
pub fn camera() -> Camera {
    Camera { distortion: [-0.08, 0.0], ..Camera::ideal(240, 180, 1.25, 0.15, 0.33) }
}

fn sd(covariance: &Matrix3<f64>) -> [f64; 2] {
    [covariance[(0, 0)].max(covariance[(1, 1)]).sqrt(), covariance[(2, 2)].sqrt()]
}

fn diagonal(sd: [f64; 3]) -> Matrix3<f64> {
    Matrix3::from_diagonal(&Vector3::from(sd.map(|s| s * s)))
}

impl Blackout {
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
        let mut eye = Eye::new(
            self.seed,
            World::plain(Field::DIVISION_B, self.seed as u32).with_ball(self.ball[0], self.ball[1]),
        );
        let scene = eye.look(self.truth);
        let mut belief = Estimate { pose: self.told, covariance: diagonal(ASTRAY), agreeing: 1.0 };
        if senses == Senses::Camera {
            belief = eye.correct(&scene, &belief).unwrap_or(belief);
        }
        // Without a camera the ball's place is told as it is, in the frame of the belief.
        let view = belief.pose.theta + FRAC_PI_2;
        let seen = scene.balls.first().and_then(|ball| ball.place(&eye.camera, BALL_RADIUS));
        let ball = match (senses, seen) {
            (Senses::Camera, Some([forward, left])) => [
                belief.pose.x + forward * view.cos() - left * view.sin(),
                belief.pose.y + forward * view.sin() + left * view.cos(),
            ],
            (Senses::Camera, None) => return Ok(Outcome { ball_miss: f64::INFINITY, miss: f64::INFINITY }),
            _ => self.ball,
        };
        let at = [ball[0] - REACH * view.cos(), ball[1] - REACH * view.sin()];
        let set_points =
            [SetPoint::stop(at[0], at[1], SPEED, 0.0), SetPoint::stop(self.target[0], self.target[1], SPEED, 0.0)];
        let mut robot = Robot::racbot();
        robot.camera_latency_s = 0.0;
        robot.camera_noise = Some(POSE_SD);
        let mut actual = robot.clone();
        actual.layout = Layout::Rac { body_radius_m: 0.085, skew_rad: self.skew };
        // The controller starts from its belief, the plant from the truth.
        let drive = Drive {
            actual,
            contact: Contact::Friction { friction_coefficient: 0.5, creep_s_per_kg: 0.000_5 },
            camera: Some(CameraModel::of(&robot)),
            fused: senses != Senses::Wheels,
            start: belief.pose,
            stands: Some(self.truth),
            limit_s: 20.0,
            seed: self.seed,
            ..Drive::new(&robot, &set_points)
        };
        let driven =
            drive.run_seen_by(BitTrue::new(), |ride| OnBoard::new(ride, &robot, belief, senses, eye), |_| {})?;
        let last = driven.track.last().map_or(self.truth, |(_, pose)| *pose);
        let front = |pose: &Pose| {
            let view = pose.theta + FRAC_PI_2;
            (pose.x + REACH * view.cos() - self.ball[0]).hypot(pose.y + REACH * view.sin() - self.ball[1])
        };
        Ok(Outcome {
            ball_miss: driven.track.iter().map(|(_, pose)| front(pose)).fold(f64::INFINITY, f64::min),
            miss: (last.x - self.target[0]).hypot(last.y - self.target[1]),
        })
    }
}

/// The camera with the world in front of it.
#[derive(Debug)]
struct Eye {
    camera: Camera,
    world: World,
    map: Map,
    rng: ChaCha8Rng,
}

impl Eye {
    fn new(seed: u64, world: World) -> Self {
        Self { camera: camera(), world, map: Map::new(Field::DIVISION_B), rng: ChaCha8Rng::seed_from_u64(seed + 7) }
    }

    fn look(&mut self, truth: Pose) -> Scene {
        let shutter = Shutter { pose: [truth.x, truth.y, truth.theta + FRAC_PI_2], ..Shutter::default() };
        let rendered = render(&self.world, &self.camera, shutter, &Sensor::GOOD, 1, &mut self.rng);
        detect(&rendered.picture, DEFAULT_SCORE)
    }

    /// The belief corrected by the lines seen; `None` where they tell nothing or too little.
    fn correct(&self, scene: &Scene, belief: &Estimate) -> Option<Estimate> {
        let found = track(&self.map, &self.camera, &scene.lines, belief).ok()?;
        let [place, heading] = sd(&found.covariance);
        (place < SURE[0] && heading < SURE[1]).then_some(found)
    }
}

/// Wheels, gyroscope and camera of a robot as one source of poses.
#[derive(Debug)]
pub struct OnBoard<F> {
    robot: VirtualRobot<F>,
    filter: Inertial,
    imu: Imu,
    before: Twist,
    tick: u64,
    period: f64,
    eye: Option<Eye>,
    senses: Senses,
}

impl<F: Fpga> OnBoard<F> {
    fn new(robot: VirtualRobot<F>, model: &Robot, belief: Estimate, senses: Senses, eye: Eye) -> Self {
        let sensor = ImuModel::icm_42688_p(model.control_rate_hz);
        let geometry = model.geometry().expect("the robot drives by this geometry");
        let [place, heading] = sd(&belief.covariance);
        let options = FusionOptions::of(model).uncalibrated();
        let start_sd = [place, place, heading];
        let mut filter =
            Inertial::new(&geometry, model.counts_per_wheel_rad(), options, &sensor, belief.pose, start_sd);
        let mut imu = Imu::new(sensor, 3);
        // A second of rest before the start shows the gyroscope's bias.
        let period = 1.0 / model.control_rate_hz;
        let counts = robot.with_plant(model::plant::Plant::counts);
        for k in 0..1000 {
            filter.predict((f64::from(k) - 1000.0) * period, &counts, &imu.read(&Motion::default()));
        }
        let eye = (senses == Senses::Camera).then_some(eye);
        Self { robot, filter, imu, before: Twist::default(), tick: 0, period, eye, senses }
    }

    fn motion(&mut self) -> (Motion, Vec<i64>, Pose) {
        let (now, counts, pose, speeds) = self.robot.with_plant(|plant| {
            let speeds = plant.wheel_speeds().map(f64::abs).sum::<f64>() / plant.wheel_speeds().count().max(1) as f64;
            (plant.twist(), plant.counts(), plant.pose(), speeds)
        });
        let rate = |a: f64, b: f64| (a - b) / self.period;
        let motion = Motion {
            omega: [0.0, 0.0, now.omega],
            omega_rate: [0.0, 0.0, rate(now.omega, self.before.omega)],
            acceleration: [
                rate(now.vx, self.before.vx) - now.omega * now.vy,
                rate(now.vy, self.before.vy) + now.omega * now.vx,
                0.0,
            ],
            wheel_speed: speeds,
        };
        self.before = now;
        (motion, counts, pose)
    }
}

impl<F: Fpga> PoseSource for OnBoard<F> {
    fn arrived(&mut self, t: f64) -> Option<Pose> {
        let (motion, counts, truth) = self.motion();
        let reading = self.imu.read(&motion);
        self.filter.predict(t, &counts, &reading);
        self.tick += 1;
        if self.tick.is_multiple_of(PICTURE_EVERY)
            && let Some(eye) = &mut self.eye
        {
            let scene = eye.look(truth);
            let covariance = self.filter.covariance();
            let belief = Estimate { pose: self.filter.pose(), covariance, agreeing: 1.0 };
            // The match holds the prediction already: the filter takes it over as it is.
            if let Some(found) = eye.correct(&scene, &belief) {
                self.filter.adopt(found.pose, found.covariance);
            }
        }
        let pose = self.filter.pose();
        let due = self.senses != Senses::Wheels && self.tick.is_multiple_of(POSE_EVERY);
        due.then(|| Pose::new(pose.x, pose.y, wrap_angle(pose.theta)))
    }
}
