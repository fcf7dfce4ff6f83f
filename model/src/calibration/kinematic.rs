//! The motion link as a [`PoseModel`]: encoder counts to camera poses, with what may be wrong.

use crate::fit::PoseModel;
use runs::Run;
use runs::frames::{Pose, Twist, displacement};
use runs::geometry::{Geometry, Wheel};
use runs::robot::Robot;

/// Something between encoders and camera that may differ from its nominal value. Wheels from 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum KinematicParameter {
    /// Turns the wheel's drive direction clockwise by α, as the paper's skew; rad.
    Skew(usize),
    /// Radius of one wheel, relative to nominal.
    WheelRadius(usize),
    /// Radius of all wheels, relative to nominal.
    WheelRadiusCommon,
    /// Distance of all contact points from the centre, relative to nominal.
    BodyRadius,
    /// The marker plate is turned counter-clockwise on the robot; rad.
    MarkerHeading,
    /// The marker plate is off the centre to the right; m.
    MarkerX,
    /// The marker plate is off the centre to the front; m.
    MarkerY,
    /// The robot moves further to its right and left than its wheels say: rollers that give way; relative.
    Sideways,
    /// The camera is later than robot.toml says; s.
    CameraLatency,
    /// The camera is later in one run alone, from 0: clocks that were set by hand; s.
    CameraClock(usize),
    /// The camera's metre, relative to the true one.
    CameraScale,
}

impl KinematicParameter {
    /// Name as the effects' parameters are called, wheels from 1.
    pub fn name(self) -> String {
        match self {
            Self::Skew(i) => format!("skew_{}_rad", i + 1),
            Self::WheelRadius(i) => format!("scale_{}", i + 1),
            Self::WheelRadiusCommon => "wheel_radius_scale".to_owned(),
            Self::BodyRadius => "body_radius_scale".to_owned(),
            Self::MarkerHeading => "angle_rad".to_owned(),
            Self::MarkerX => "x_m".to_owned(),
            Self::MarkerY => "y_m".to_owned(),
            Self::Sideways => "sideways_scale".to_owned(),
            Self::CameraLatency => "latency_s".to_owned(),
            Self::CameraClock(run) => format!("offset_{}_s", run + 1),
            Self::CameraScale => "camera_scale".to_owned(),
        }
    }

    /// A step that is small but matters.
    pub(super) fn scale(self) -> f64 {
        match self {
            Self::Skew(_) | Self::MarkerHeading => 1.0_f64.to_radians(),
            Self::WheelRadius(_) | Self::WheelRadiusCommon | Self::BodyRadius | Self::CameraScale | Self::Sideways => {
                0.01
            }
            Self::MarkerX | Self::MarkerY => 0.002,
            Self::CameraLatency | Self::CameraClock(_) => 0.005,
        }
    }
}

/// Odometry with free parameters, sampled when the camera exposed.
#[derive(Debug, Clone)]
pub struct KinematicModel {
    wheels: Vec<Wheel>,
    wheel_radius_m: f64,
    counts_per_wheel_rad: f64,
    latency_s: f64,
    parameters: Vec<KinematicParameter>,
}

impl KinematicModel {
    /// The nominal robot with these parameters free, all 0 for the nominal robot.
    pub fn new(robot: &Robot, parameters: Vec<KinematicParameter>) -> Self {
        Self {
            wheels: robot.layout.wheels(),
            wheel_radius_m: robot.wheel_radius_m,
            counts_per_wheel_rad: robot.counts_per_wheel_rad(),
            latency_s: robot.camera_latency_s,
            parameters,
        }
    }

    fn sum(&self, values: &[f64], wanted: KinematicParameter) -> f64 {
        self.parameters.iter().zip(values).filter(|(p, _)| **p == wanted).map(|(_, v)| v).sum()
    }

    /// Body displacement per count, one column a wheel; `None` where the wheels cannot drive.
    fn per_count(&self, values: &[f64]) -> Option<Vec<[f64; 3]>> {
        use KinematicParameter as P;
        let body = 1.0 + self.sum(values, P::BodyRadius);
        let mut wheels = self.wheels.clone();
        for (i, wheel) in wheels.iter_mut().enumerate() {
            wheel.x_m *= body;
            wheel.y_m *= body;
            wheel.drive_rad -= self.sum(values, P::Skew(i));
        }
        let geometry = Geometry::new(wheels, self.wheel_radius_m).ok()?;
        let common = self.sum(values, P::WheelRadiusCommon);
        let sideways = 1.0 + self.sum(values, P::Sideways);
        let column = |(i, c): (usize, [f64; 3])| {
            let radius = 1.0 + common + self.sum(values, P::WheelRadius(i));
            let [x, y, theta] = c.map(|v| v * radius / self.counts_per_wheel_rad);
            [x * sideways, y, theta]
        };
        let direct = geometry.direct();
        Some(direct.column_iter().map(|c| [c[0], c[1], c[2]]).enumerate().map(column).collect())
    }
}

impl PoseModel for KinematicModel {
    fn names(&self) -> Vec<String> {
        self.parameters.iter().map(|p| p.name()).collect()
    }

    fn scales(&self) -> Vec<f64> {
        self.parameters.iter().map(|p| p.scale()).collect()
    }

    fn track(&self, values: &[f64], number: usize, run: &Run) -> Vec<Pose> {
        use KinematicParameter as P;
        let lost = || vec![Pose::new(f64::NAN, f64::NAN, f64::NAN); run.camera.len()];
        let Some(columns) = self.per_count(values) else { return lost() };
        if run.counts.len() != columns.len() {
            return lost();
        }
        let latency = self.latency_s + self.sum(values, P::CameraLatency) + self.sum(values, P::CameraClock(number));
        let (sin, cos) = self.sum(values, P::MarkerHeading).sin_cos();
        let marker = Pose::new(self.sum(values, P::MarkerX), self.sum(values, P::MarkerY), sin.atan2(cos));
        // Poses on rows of their own have no counts there.
        let counts: Vec<Vec<f64>> = (0..columns.len()).map(|wheel| run.cumulative(wheel)).collect();
        let moved = |tick: usize| moved(&columns, &counts, tick);
        let mut track = Vec::with_capacity(run.camera.len());
        let (mut pose, mut tick) = (Pose::default(), 0);
        for sample in &run.camera {
            let exposed = run.t[sample.tick] - latency;
            while tick + 1 < run.len() && run.t[tick + 1] <= exposed {
                pose = pose.compose(displacement(moved(tick)));
                tick += 1;
            }
            let mut at = pose;
            if tick + 1 < run.len() && exposed > run.t[tick] {
                let share = (exposed - run.t[tick]) / (run.t[tick + 1] - run.t[tick]);
                at = pose.compose(displacement(moved(tick).scaled(share)));
            }
            track.push(at.compose(marker));
        }
        track
    }

    fn observe(&self, values: &[f64], pose: Pose) -> Pose {
        let scale = 1.0 + self.sum(values, KinematicParameter::CameraScale);
        Pose::new(scale * pose.x, scale * pose.y, pose.theta)
    }
}

/// Body displacement from `tick` to the next.
fn moved(columns: &[[f64; 3]], counts: &[Vec<f64>], tick: usize) -> Twist {
    let mut sum = [0.0; 3];
    for (column, counts) in columns.iter().zip(counts) {
        let difference = counts[tick + 1] - counts[tick];
        if difference != 0.0 {
            for (s, c) in sum.iter_mut().zip(column) {
                *s += c * difference;
            }
        }
    }
    Twist::new(sum[0], sum[1], sum[2])
}
