//! Wheels, gyroscope and overhead camera together.

use std::collections::VecDeque;

use nalgebra::{Matrix3, Matrix3x5, Matrix5, Vector3, Vector5};

use crate::fusion::{Correction, FusionOptions, MEMORY_S};
use crate::imu::{ImuModel, Reading};
use crate::measurement::Measurement;
use crate::odometry::{Estimate, Odometer};
use runs::frames::{Pose, Twist, displacement, wrap_angle};
use runs::geometry::Geometry;

/// Ticks without a count after which the robot stands, s: the slowest drive turns a wheel by a count in this time.
const STANDING_S: f64 = 0.2;
/// Window over which wheels and sensor are compared for slip, s: half of the 50 ms within which slip is to be noticed.
const SLIP_WINDOW_S: f64 = 0.02;
/// Turn within the window that is slip, rad, beyond a share of the turn itself for skew and scale: chosen above the steps of
/// an encoder on wheels 85 mm out, and checked by `model/tests/inertial.rs`.
const SLIP_TURN: f64 = 0.004;
const SLIP_TURN_SHARE: f64 = 0.1;
/// Change of speed within the window that is slip, m/s, beyond a share of the change itself: chosen above what skew of 2°
/// and 5° of tilt (0.86 m/s² for 20 ms) make, and checked by `model/tests/inertial.rs`.
const SLIP_SPEED: f64 = 0.05;
const SLIP_SPEED_SHARE: f64 = 0.2;
/// Difference of the wheels' speed from the believed one at which they hold again, m/s.
const HOLDING_SPEED: f64 = 0.06;
/// Slip ends after this long at the latest, s: integrated acceleration is worth nothing then.
const LONGEST_SLIP_S: f64 = 0.6;
/// Variance of the wheels' displacement while they slip, m² per m: half of it may be wrong.
const SLIPPING_VARIANCE: f64 = 0.02;
/// Places in the state after the pose.
const BIAS: usize = 3;
const SCALE: usize = 4;

/// Pose, gyroscope's bias (rad/s) and relative error of its scale, with the covariance of their errors in this order.
#[derive(Debug, Clone, Copy, PartialEq)]
struct State {
    pose: Pose,
    bias: f64,
    scale: f64,
    covariance: Matrix5<f64>,
}

/// How a tick moved the robot.
#[derive(Debug, Clone, Copy)]
struct Step {
    /// Displacement in the body frame.
    moved: Twist,
    /// Whether its turn is that of the gyroscope, with bias and scale as read.
    felt: bool,
    /// Duration, s.
    dt: f64,
    /// Covariance of the displacement.
    noise: Matrix3<f64>,
}

/// Error-state Kalman filter (Solà 2017, in the plane): wheels tell the displacement, the gyroscope the heading, the
/// camera, late, the pose, and standstill the gyroscope's bias. What the camera says of turns either way parts the error of
/// the gyroscope's scale from its bias.
///
/// While wheels slip, their displacement is replaced by that of the speed before, changed by the accelerometer. As in
/// [`crate::fusion::Fusion`], a frame corrects the state at its exposure, and the ticks since are repeated.
#[derive(Debug, Clone)]
pub struct Inertial {
    options: FusionOptions,
    odometer: Odometer,
    gyro_noise: f64,
    bias_walk: f64,
    now: State,
    history: VecDeque<(f64, State, Step)>,
    window: VecDeque<Compared>,
    still: f64,
    rest: Rest,
    velocity: [f64; 2],
    slipping: Option<f64>,
    refused: u32,
    last: Option<f64>,
}

/// Sums of the accelerometer while the robot stands: its bias and the floor's tilt.
#[derive(Debug, Clone, Copy, Default)]
struct Rest {
    bias: [f64; 2],
}

/// What wheels and sensor say of one tick.
#[derive(Debug, Clone, Copy)]
struct Compared {
    wheel: Twist,
    turn: f64,
    gain: [f64; 2],
    dt: f64,
}

impl Inertial {
    /// A filter that starts from an estimate, at counts 0.
    pub fn new(
        geometry: &Geometry,
        counts_per_wheel_rad: f64,
        options: FusionOptions,
        sensor: &ImuModel,
        start: Estimate,
    ) -> Self {
        let mut covariance = Matrix5::zeros();
        covariance.fixed_view_mut::<3, 3>(0, 0).copy_from(&start.covariance);
        covariance[(BIAS, BIAS)] = (2.0 * sensor.gyro.bias).powi(2);
        covariance[(SCALE, SCALE)] = sensor.gyro.scale.powi(2);
        Self {
            options,
            odometer: Odometer::new(geometry, counts_per_wheel_rad, options.wheel_variance),
            gyro_noise: sensor.gyro.noise_density * 0.5_f64.sqrt(),
            bias_walk: sensor.gyro.bias_walk,
            now: State { pose: start.pose, bias: 0.0, scale: 0.0, covariance },
            history: VecDeque::new(),
            window: VecDeque::new(),
            still: 0.0,
            rest: Rest::default(),
            velocity: [0.0; 2],
            slipping: None,
            refused: 0,
            last: None,
        }
    }

    /// One control tick at time `t` (s, increasing): cumulative counts and the sensor's reading.
    pub fn predict(&mut self, t: f64, counts: &[i64], reading: &Reading) {
        let increment = self.odometer.increment(counts);
        let Some(last) = self.last.replace(t) else { return };
        let dt = t - last;
        let turn = reading.gyro[2] * dt;
        let wheel = increment.moved;
        let stands = wheel == Twist::default();
        self.still = if stands { self.still + dt } else { 0.0 };
        let force = [reading.acceleration[0] - self.rest.bias[0], reading.acceleration[1] - self.rest.bias[1]];
        let turned = self.now.turned(turn, dt);
        let omega = turned / dt;
        // In the turning body frame speed changes by acceleration and by the turn.
        let gain = [(force[0] + omega * self.velocity[1]) * dt, (force[1] - omega * self.velocity[0]) * dt];
        self.compare(Compared { wheel, turn: turned, gain, dt });
        let mut moved = Twist::new(wheel.vx, wheel.vy, turn);
        let mut noise = increment.covariance;
        if self.slipping.is_some() {
            self.velocity = [self.velocity[0] + gain[0], self.velocity[1] + gain[1]];
            moved = Twist::new(self.velocity[0] * dt, self.velocity[1] * dt, turn);
            let way = moved.speed() + wheel.speed();
            noise += Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, 0.0)) * (SLIPPING_VARIANCE * way);
        } else {
            let share = (dt / SLIP_WINDOW_S).min(1.0);
            let speed = [wheel.vx / dt, wheel.vy / dt];
            self.velocity = std::array::from_fn(|i| self.velocity[i] + gain[i] + share * (speed[i] - self.velocity[i]));
        }
        for i in 0..2 {
            noise[(i, 2)] = 0.0;
            noise[(2, i)] = 0.0;
        }
        noise[(2, 2)] = self.gyro_noise.powi(2) * dt;
        let step = Step { moved, felt: true, dt, noise };
        self.now = self.now.after(&step, self.bias_walk);
        if self.still > STANDING_S {
            self.settle(reading, dt);
        }
        self.keep(t, step);
    }

    /// One control tick of a sensor that is silent: the wheels tell the turn too.
    pub fn predict_by_wheels(&mut self, t: f64, counts: &[i64]) {
        let increment = self.odometer.increment(counts);
        let Some(last) = self.last.replace(t) else { return };
        let dt = t - last;
        let wheel = increment.moved;
        self.velocity = [wheel.vx / dt, wheel.vy / dt];
        (self.still, self.slipping) = (0.0, None);
        self.window.clear();
        let step = Step { moved: wheel, felt: false, dt, noise: increment.covariance };
        self.now = self.now.after(&step, self.bias_walk);
        self.keep(t, step);
    }

    /// Keeps a step for frames that come late.
    fn keep(&mut self, t: f64, step: Step) {
        self.history.push_back((t, self.now, step));
        let oldest = t - self.options.latency_s.max(MEMORY_S);
        while self.history.len() > 2 && self.history[1].0 < oldest - 1e-9 {
            self.history.pop_front();
        }
    }

    /// Pose and covariance now.
    pub fn estimate(&self) -> Estimate {
        Estimate { pose: self.now.pose, covariance: self.covariance() }
    }

    /// At rest the gyroscope shows its bias, the accelerometer its own and the tilt of the floor.
    fn settle(&mut self, reading: &Reading, dt: f64) {
        let share = dt / (self.still - STANDING_S + dt).min(1.0);
        for (bias, a) in self.rest.bias.iter_mut().zip(reading.acceleration) {
            *bias += share * (a - *bias);
        }
        let p = self.now.covariance;
        let variance = self.gyro_noise.powi(2) / dt;
        let gain = p.column(BIAS) / (p[(BIAS, BIAS)] + variance);
        self.now.correct(&(gain * (reading.gyro[2] - self.now.bias)));
        self.now.covariance = p - gain * p.row(BIAS);
    }

    /// Looks for slip: turn and change of speed by the wheels against those by the sensor.
    fn compare(&mut self, tick: Compared) {
        self.window.push_back(tick);
        let mut length: f64 = self.window.iter().map(|c| c.dt).sum();
        while length - self.window[0].dt > SLIP_WINDOW_S - 1e-9 {
            length -= self.window[0].dt;
            self.window.pop_front();
        }
        let turn: f64 = self.window.iter().map(|c| c.turn).sum();
        let wheels: f64 = self.window.iter().map(|c| c.wheel.omega).sum();
        let turned = (wheels - turn).abs() > SLIP_TURN + SLIP_TURN_SHARE * turn.abs().max(wheels.abs());
        // Speeds by the wheels at both ends of the window, over a quarter of it each.
        let quarter = (self.window.len() / 4).max(1);
        let mean = |from: usize| -> [f64; 2] {
            let part = || self.window.iter().skip(from).take(quarter);
            let time: f64 = part().map(|c| c.dt).sum();
            [part().map(|c| c.wheel.vx).sum::<f64>() / time, part().map(|c| c.wheel.vy).sum::<f64>() / time]
        };
        let (first, end) = (mean(0), mean(self.window.len() - quarter));
        let share = 1.0 - quarter as f64 / self.window.len() as f64;
        let felt: [f64; 2] = std::array::from_fn(|i| self.window.iter().map(|c| c.gain[i]).sum::<f64>() * share);
        let changed = [end[0] - first[0], end[1] - first[1]];
        let off = (changed[0] - felt[0]).hypot(changed[1] - felt[1]);
        let size = changed[0].hypot(changed[1]).max(felt[0].hypot(felt[1]));
        let jumped = self.window.len() >= 8 && off > SLIP_SPEED + SLIP_SPEED_SHARE * size;
        let now = if turned || jumped { Some(0.0) } else { None };
        self.slipping = match (self.slipping, now) {
            (None, found) => found,
            (Some(since), _) if since + tick.dt > LONGEST_SLIP_S => None,
            (Some(since), Some(_)) => Some(since + tick.dt),
            (Some(since), None) => {
                let holds = (end[0] - self.velocity[0]).hypot(end[1] - self.velocity[1]) < HOLDING_SPEED;
                if holds { None } else { Some(since + tick.dt) }
            }
        };
    }

    /// A frame that was delivered at time `t`, after the prediction for that tick.
    pub fn correct(&mut self, t: f64, seen: impl Into<Measurement>) -> Correction {
        let seen = seen.into();
        let exposed = seen.taken.map_or(t - self.options.latency_s, |taken| taken.min(t));
        let base = self.history.partition_point(|(at, ..)| *at <= exposed + 1e-9);
        let Some(alone) = seen.alone(self.options.camera_noise).filter(|_| base > 0) else {
            return Correction::Unusable;
        };
        let (at, from, _) = self.history[base - 1];
        let next = self.history.get(base).map(|(after, _, step)| (*step, (exposed - at) / (after - at)));
        let prior = next.map_or(from, |(step, share)| from.after(&step.part(share), self.bias_walk));
        let p = prior.pose;
        let (at, noise) = (alone.pose, alone.covariance);
        let innovation = Vector3::new(at.x - p.x, at.y - p.y, wrap_angle(at.theta - p.theta));
        let observed = Matrix3x5::<f64>::identity();
        let Some(inverse) = (prior.covariance.fixed_view::<3, 3>(0, 0) + noise).try_inverse() else {
            return Correction::Unusable;
        };
        let nis = (innovation.transpose() * inverse * innovation)[0];
        let restart = self.refused + 1 >= self.options.refusals_before_restart;
        let far = nis > self.options.gate && seen.prediction.is_none();
        let anew = seen.replaces || far && restart;
        if far && !anew {
            self.refused += 1;
            return Correction::Refused(nis);
        }
        self.refused = 0;
        let mut posterior = prior;
        let verdict = if anew {
            posterior.pose = at;
            posterior.covariance = Matrix5::zeros();
            posterior.covariance.fixed_view_mut::<3, 3>(0, 0).copy_from(&noise);
            let sensor = prior.covariance.fixed_view::<2, 2>(BIAS, BIAS).into_owned();
            posterior.covariance.fixed_view_mut::<2, 2>(BIAS, BIAS).copy_from(&sensor);
            Correction::Restarted
        } else {
            let gain = prior.covariance * observed.transpose() * inverse;
            posterior.correct(&(gain * innovation));
            let keep = Matrix5::identity() - gain * observed;
            posterior.covariance = keep * prior.covariance * keep.transpose() + gain * noise * gain.transpose();
            Correction::Accepted(nis)
        };
        let mut state = posterior;
        for (i, entry) in self.history.iter_mut().enumerate().skip(base) {
            let step = match (i == base, next) {
                (true, Some((step, share))) => step.part(1.0 - share),
                _ => entry.2,
            };
            state = state.after(&step, self.bias_walk);
            entry.1 = state;
        }
        self.now = state;
        verdict
    }

    /// Takes over a pose and covariance that this filter's own prediction is part of, of now: the match of an on-board
    /// camera. The gyroscope's bias and scale are corrected by what they have to do with the pose.
    pub fn adopt(&mut self, pose: Pose, covariance: Matrix3<f64>) {
        let before = self.now.covariance;
        let own = before.fixed_view::<3, 3>(0, 0).into_owned();
        // A pose known exactly has nothing to do with the sensor.
        let inverse = own.try_inverse().unwrap_or_else(Matrix3::zeros);
        let slope = before.fixed_view::<2, 3>(BIAS, 0) * inverse;
        let p = self.now.pose;
        let moved = Vector3::new(pose.x - p.x, pose.y - p.y, wrap_angle(pose.theta - p.theta));
        let sensor = slope * moved;
        self.now.correct(&Vector5::new(moved.x, moved.y, moved.z, sensor.x, sensor.y));
        let tied = slope * covariance;
        let known = before.fixed_view::<2, 2>(BIAS, BIAS) - slope * (own - covariance) * slope.transpose();
        let now = &mut self.now.covariance;
        now.fixed_view_mut::<3, 3>(0, 0).copy_from(&covariance);
        now.fixed_view_mut::<2, 2>(BIAS, BIAS).copy_from(&known);
        now.fixed_view_mut::<2, 3>(BIAS, 0).copy_from(&tied);
        now.fixed_view_mut::<3, 2>(0, BIAS).copy_from(&tied.transpose());
        if let Some((_, state, _)) = self.history.back_mut() {
            *state = self.now;
        }
    }

    /// Where the robot is.
    pub fn pose(&self) -> Pose {
        self.now.pose
    }

    /// Covariance of the errors of x, y and heading.
    pub fn covariance(&self) -> Matrix3<f64> {
        self.now.covariance.fixed_view::<3, 3>(0, 0).into_owned()
    }

    /// The gyroscope's bias about the vertical, rad/s.
    pub fn gyro_bias(&self) -> f64 {
        self.now.bias
    }

    /// Relative error of the gyroscope's scale, and its standard deviation.
    pub fn gyro_scale(&self) -> [f64; 2] {
        [self.now.scale, self.now.covariance[(SCALE, SCALE)].sqrt()]
    }

    /// Whether the wheels slip now.
    pub fn slipping(&self) -> bool {
        self.slipping.is_some()
    }
}

impl State {
    /// Turn in `dt` s of one as read, rad.
    fn turned(&self, read: f64, dt: f64) -> f64 {
        (read - self.bias * dt) / (1.0 + self.scale)
    }

    fn after(mut self, step: &Step, bias_walk: f64) -> Self {
        let mut f = Matrix5::identity();
        let mut moved = step.moved;
        if step.felt {
            moved.omega = self.turned(step.moved.omega, step.dt);
            f[(2, BIAS)] = -step.dt / (1.0 + self.scale);
            f[(2, SCALE)] = -moved.omega / (1.0 + self.scale);
        }
        let pose = self.pose.compose(displacement(moved));
        let (dx, dy) = (pose.x - self.pose.x, pose.y - self.pose.y);
        f[(0, 2)] = -dy;
        f[(1, 2)] = dx;
        let (s, c) = (self.pose.theta + 0.5 * moved.omega).sin_cos();
        let turn = Matrix3::new(c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0);
        self.covariance = f * self.covariance * f.transpose();
        let noise = turn * step.noise * turn.transpose();
        let mut block = self.covariance.fixed_view_mut::<3, 3>(0, 0);
        block += noise;
        self.covariance[(BIAS, BIAS)] += bias_walk * bias_walk * step.dt;
        self.pose = pose;
        self
    }

    fn correct(&mut self, error: &Vector5<f64>) {
        let p = self.pose;
        self.pose = Pose::new(p.x + error[0], p.y + error[1], p.theta + error[2]);
        self.bias += error[BIAS];
        self.scale += error[SCALE];
    }
}

impl Step {
    fn part(&self, share: f64) -> Self {
        Self { moved: self.moved.scaled(share), dt: share * self.dt, noise: self.noise * share, ..*self }
    }
}
