//! The `motion` link: encoder angles to camera poses.
//!
//! Windowed output error. Each run is cut into windows of about a second; within one, the pose
//! predicted from the encoders is compared with every camera frame, and the window's start pose is
//! a nuisance that is projected out (multiple shooting with free nodes). Parameters act on the
//! prediction only.

mod floor;
mod lag;
mod track;
mod ways;
mod windows;

use std::borrow::Cow;

use runs::frames::{Pose, Walk};
use runs::geometry::{Geometry, Wheel};
use runs::robot::Robot;

use crate::inertial::Sensor;
use crate::segment::Segment;
use crate::values::Values;

pub use floor::Floor;
pub use lag::CameraFilter;
pub(crate) use track::Path;
pub use ways::{Errors, Ways};
pub use windows::{MotionLink, WINDOW_S, WindowResiduals};

/// Changes wheel angles (`[wheel][tick]`, rad) of a segment.
pub type AngleChange = Box<dyn Fn(&Segment, &mut [Vec<f64>]) + Send + Sync>;
/// What the camera makes of a pose.
pub type Observe = Box<dyn Fn(Pose) -> Pose + Send + Sync>;

/// Everything between encoder and camera; effects change it.
pub struct MotionModel {
    /// Wheels as they really are.
    pub wheels: Vec<Wheel>,
    /// Nominal radius of every wheel, m.
    pub wheel_radius_m: f64,
    /// Distance rolled per angle by the encoder, relative to nominal, one a wheel.
    pub distance_scale: Vec<f64>,
    /// Age of a camera frame at its stamp, s.
    pub latency_s: f64,
    /// The marker plate in the body frame.
    pub marker: Pose,
    /// What the wheels roll on: what they turn further than they roll comes off their angles first.
    pub floor: Floor,
    /// Changes of the wheel angles, in this order.
    pub angles: Vec<AngleChange>,
    /// What the camera does to a pose of the marker, in this order.
    pub observe: Vec<Observe>,
    /// The inertial sensor.
    pub sensor: Sensor,
    /// Slope of the floor downhill in the world, rad: an accelerometer feels it, the wheels do not.
    pub slope_rad: [f64; 2],
    /// Age of the counts at their tick, s.
    pub encoder_lag_s: f64,
    /// Time constant of the low-pass between the wheels' angles and those of the log, s; among `angles`, too.
    pub reading_filter_s: f64,
    /// A low-pass between the robot's pose and the camera's.
    pub camera_filter: CameraFilter,
    /// Drift of the camera's origin, m/s.
    pub drift: [f64; 2],
    /// Seconds by which the camera's clock runs ahead per second of a run.
    pub clock_drift: f64,
    /// Age of a frame beyond `latency_s`, s, of each run; 0 of runs beyond.
    pub clock_offset_s: Vec<f64>,
    /// Sideways (body x) motion per that by the wheels.
    pub sideways_scale: f64,
    /// Turn per body displacement (x, y) beside that by the wheels, rad/m.
    pub curl: [f64; 2],
    /// Age of a frame beyond `latency_s` per speed of the robot, s²/m.
    pub speed_delay: f64,
    /// Mass of the whole robot, kg.
    pub mass_kg: f64,
    /// Yaw inertia about the chassis centre, kg m².
    pub yaw_inertia_kg_m2: f64,
    /// Place of the centre of mass in the body frame, m.
    pub centre_of_mass_m: [f64; 2],
    /// Motor turns per wheel turn.
    pub gear_ratio: f64,
    /// What each of `angles` depends on, as far as that is known.
    origins: Vec<Origin>,
}

/// What a change of the wheel angles depends on beside the segment.
#[derive(Debug, Clone, PartialEq)]
struct Origin {
    effect: String,
    values: Values,
    wheels: Vec<Wheel>,
    /// Wheel radius, mass, yaw inertia, gear ratio.
    robot: [f64; 4],
}

impl MotionModel {
    /// The nominal robot.
    pub fn new(robot: &Robot) -> Self {
        let wheels = robot.layout.wheels();
        Self {
            distance_scale: vec![1.0; wheels.len()],
            wheels,
            wheel_radius_m: robot.wheel_radius_m,
            latency_s: robot.camera_latency_s,
            marker: Pose::default(),
            floor: Floor::default(),
            angles: Vec::new(),
            observe: Vec::new(),
            sensor: Sensor::of(robot),
            slope_rad: [0.0; 2],
            encoder_lag_s: 0.0,
            reading_filter_s: 0.0,
            camera_filter: CameraFilter::default(),
            drift: [0.0; 2],
            clock_drift: 0.0,
            clock_offset_s: Vec::new(),
            sideways_scale: 1.0,
            curl: [0.0; 2],
            speed_delay: 0.0,
            mass_kg: robot.mass_kg,
            yaw_inertia_kg_m2: robot.yaw_inertia_kg_m2,
            centre_of_mass_m: [0.0; 2],
            gear_ratio: robot.gear_ratio,
            origins: Vec::new(),
        }
    }

    /// Body displacement per wheel angle, one column a wheel (m, m, rad per rad); `None` where the
    /// wheels cannot drive the robot.
    pub fn columns(&self) -> Option<Vec<[f64; 3]>> {
        let geometry = Geometry::new(self.wheels.clone(), self.wheel_radius_m).ok()?;
        let columns = geometry.direct().column_iter().zip(&self.distance_scale);
        let moved = columns.map(|(c, s)| {
            let [x, y] = [c[0] * s * self.sideways_scale, c[1] * s];
            [x, y, c[2] * s + self.curl[0] * x + self.curl[1] * y]
        });
        Some(moved.collect())
    }

    /// The floor as it is known so far under the robot as it is known so far, to be changed.
    pub fn floor_beneath(&mut self) -> &mut Floor {
        self.floor.wheels.clone_from(&self.wheels);
        self.floor.wheel_radius_m = self.wheel_radius_m;
        self.floor.masses = [self.mass_kg, self.yaw_inertia_kg_m2];
        [self.floor.centre_m[0], self.floor.centre_m[1]] = self.centre_of_mass_m;
        &mut self.floor
    }

    /// Whether wheels turn otherwise than they are read.
    pub fn changes_angles(&self) -> bool {
        self.floor.gives_way() || !self.angles.is_empty()
    }

    /// The wheel angles of a segment with all changes; borrowed if there are none.
    pub fn angles<'a>(&self, segment: &'a Segment) -> Cow<'a, [Vec<f64>]> {
        if !self.changes_angles() {
            return Cow::Borrowed(&segment.angle);
        }
        let mut angles = segment.angle.clone();
        if let Some(lost) = self.floor.lost(segment) {
            let turned = angles.iter_mut().flatten();
            turned.zip(lost.iter().flatten()).for_each(|(angle, lost)| *angle -= lost);
        }
        for change in &self.angles {
            change(segment, &mut angles);
        }
        Cow::Owned(angles)
    }

    /// Writes down what the angles that were added last depend on beside the segment: an effect's name and values, and
    /// what is known of the robot by now.
    pub fn angles_are_of(&mut self, effect: &str, values: &Values) {
        let (wheels, robot) =
            (self.wheels.clone(), [self.wheel_radius_m, self.mass_kg, self.yaw_inertia_kg_m2, self.gear_ratio]);
        let origin = Origin { effect: effect.to_owned(), values: values.clone(), wheels, robot };
        self.origins.resize(self.angles.len(), origin);
    }

    /// What the camera sees of a chassis pose.
    #[inline]
    pub fn seen(&self, chassis: &Walk) -> Pose {
        let mut pose =
            if self.marker == Pose::default() { chassis.pose() } else { chassis.then(&Walk::from(self.marker)).pose() };
        for observe in &self.observe {
            pose = observe(pose);
        }
        pose
    }
}
