//! The paper's calibration procedure (section 5), as printed, and what is sound about it.
//!
//! Along the axle of wheel k the other two wheels drive. To first order the heading rate of such a
//! drive is proportional to αₖ − (αᵢ + αⱼ)/2: one equation, and the "neglected" wheel enters with
//! twice the weight of the others. Three such equations are linearly dependent, so that straight
//! lines along all three axles fix the *differences* of the skews and nothing else. A step has two
//! unknowns and one equation; here both skews are moved equally, and the round of three steps is
//! repeated until all lines are straight.
//!
//! The last step as printed scales all skews, "maintaining the identified ratios". A scale changes
//! the differences just found, so that the lines are no longer straight. The sound step adds one
//! angle to all skews, found from the direction in which the robot travels: that angle is the
//! common skew as the camera's marker shows it, and straight lines stay straight.

use super::drives::{DriveError, Drives, Straightness, opposite};
use runs::geometry::{Geometry, GeometryError};
use runs::robot::{Layout, Robot};

/// How to calibrate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PaperOptions {
    /// Length of a drive, m.
    pub distance_m: f64,
    /// Heading change per metre below which a line is straight, rad/m.
    pub straight: f64,
    /// Drives of one step at most.
    pub most_drives: usize,
    /// Rounds of three steps at most.
    pub most_rounds: usize,
}

impl Default for PaperOptions {
    fn default() -> Self {
        Self { distance_m: 2.0, straight: 0.15_f64.to_radians(), most_drives: 4, most_rounds: 6 }
    }
}

/// Why the procedure does not work.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PaperError {
    /// The procedure is for three wheels at 120°.
    #[error("the paper's procedure is for three wheels 120° apart with body_radius_m and skew_rad; use the estimate")]
    NotThreeWheels,
    /// The robot did not drive.
    #[error(transparent)]
    Drive(#[from] DriveError),
    /// The lines do not become straight: the robot does not do what its wheels are told.
    #[error(
        "the lines do not become straight: the skew of wheel {wheel} would have to be {degrees:.0} degrees; look at the \
         speed loops and encoders first"
    )]
    Diverged {
        /// Wheel, from 1.
        wheel: usize,
        /// Skew asked for.
        degrees: f64,
    },
    /// The skews found make no robot.
    #[error(transparent)]
    Geometry(#[from] GeometryError),
}

/// Part of the procedure a drive belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// One of the three steps, round from 1.
    Straighten(usize),
    /// Drives that show the state after the three steps, and the direction of travel.
    Straight,
    /// Drives after the magnitude step as printed.
    Scaled,
    /// Drives after the sound common step.
    Common,
}

/// One drive of the procedure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Iteration {
    /// Which part of the procedure it belongs to.
    pub stage: Stage,
    /// Wheel along whose axle it went, from 0.
    pub wheel: usize,
    /// Skews the controller believed in, rad.
    pub skew_rad: [f64; 3],
    /// What came of it.
    pub seen: Straightness,
}

/// Outcome of [`calibrate_like_the_paper`].
#[derive(Debug, Clone, PartialEq)]
pub struct PaperCalibration {
    /// Every drive, in order.
    pub iterations: Vec<Iteration>,
    /// Skews after the three steps: lines are straight, the common part is arbitrary.
    pub straight: [f64; 3],
    /// Skews after the magnitude step as printed.
    pub scaled: [f64; 3],
    /// The factor of that step.
    pub factor: f64,
    /// Skews after the sound step instead.
    pub common: [f64; 3],
    /// The angle of that step, rad.
    pub angle: f64,
}

impl PaperCalibration {
    /// Root mean square heading change (rad/m) and mean direction error (rad) of a stage's drives.
    pub fn quality(&self, stage: Stage) -> (f64, f64) {
        let drives: Vec<&Iteration> = self.iterations.iter().filter(|i| i.stage == stage).collect();
        let n = drives.len().max(1) as f64;
        let square: f64 = drives.iter().map(|d| d.seen.heading_per_m.powi(2)).sum();
        let direction: f64 = drives.iter().map(|d| d.seen.direction_error).sum();
        ((square / n).sqrt(), direction / n)
    }
}

/// The largest correction of one drive, rad: a robot that far off is not to be trusted at once.
const LARGEST_STEP: f64 = 0.1;
/// Limits of the magnitude step: where the skews' mean is close to zero, no factor helps.
const FACTORS: [f64; 2] = [0.2, 5.0];
/// Skews beyond this make no robot: the geometry comes close to singular, rad.
const LARGEST_SKEW: f64 = 0.6;

/// Calibrates a robot like the paper, starting from the skews in `robot`.
///
/// # Errors
/// [`PaperError`] if the robot has not three wheels at 120° or does not drive.
pub fn calibrate_like_the_paper(
    robot: &Robot,
    drives: &mut dyn Drives,
    options: &PaperOptions,
) -> Result<PaperCalibration, PaperError> {
    let Layout::Rac { body_radius_m, skew_rad } = robot.layout else { return Err(PaperError::NotThreeWheels) };
    let mut procedure =
        Procedure { wheel_radius_m: robot.wheel_radius_m, body_radius_m, drives, options, iterations: Vec::new() };
    let straight = procedure.straighten(skew_rad)?;
    let angle = -procedure.look(Stage::Straight, straight)?;
    let mean = straight.iter().sum::<f64>() / 3.0;
    let factor = 1.0 + angle / mean;
    let largest = straight.iter().fold(0.0, |m: f64, s| m.max(s.abs()));
    let most = (LARGEST_SKEW / largest).clamp(1.0, FACTORS[1]);
    let factor = if factor.is_finite() { factor.clamp(FACTORS[0], most) } else { 1.0 };
    let scaled = straight.map(|s| s * factor);
    procedure.look(Stage::Scaled, scaled)?;
    let common = straight.map(|s| s + angle);
    procedure.look(Stage::Common, common)?;
    Ok(PaperCalibration { iterations: procedure.iterations, straight, scaled, factor, common, angle })
}

struct Procedure<'a> {
    wheel_radius_m: f64,
    body_radius_m: f64,
    drives: &'a mut dyn Drives,
    options: &'a PaperOptions,
    iterations: Vec<Iteration>,
}

impl Procedure<'_> {
    fn geometry(&self, skew: [f64; 3]) -> Result<Geometry, GeometryError> {
        Geometry::rac(self.wheel_radius_m, self.body_radius_m, skew)
    }

    /// Direction of the axle of a wheel without skew: the direction of its mount.
    fn axle(wheel: usize) -> f64 {
        (90.0 + 120.0 * wheel as f64).to_radians()
    }

    fn drive(&mut self, stage: Stage, wheel: usize, skew_rad: [f64; 3]) -> Result<Straightness, PaperError> {
        // To and fro, so that the robot stays under the camera.
        let back = self.iterations.len() % 2 == 1;
        let direction = if back { opposite(Self::axle(wheel)) } else { Self::axle(wheel) };
        let believed = self.geometry(skew_rad)?;
        let poses = self.drives.drive_straight(&believed, direction, self.options.distance_m)?;
        let mut seen = Straightness::of(&poses, direction)?;
        if back {
            // Skew turns the robot one way forwards and the other way backwards.
            seen.heading_per_m = -seen.heading_per_m;
        }
        self.iterations.push(Iteration { stage, wheel, skew_rad, seen });
        Ok(seen)
    }

    /// The three steps, round after round until nothing had to be changed.
    fn straighten(&mut self, start: [f64; 3]) -> Result<[f64; 3], PaperError> {
        let mut skew = start;
        for round in 1..=self.options.most_rounds {
            let mut changed = false;
            for wheel in 0..3 {
                for _ in 0..self.options.most_drives {
                    let seen = self.drive(Stage::Straighten(round), wheel, skew)?;
                    if seen.heading_per_m.abs() <= self.options.straight {
                        break;
                    }
                    let step = -seen.heading_per_m / self.effect_of_others(wheel, skew)?;
                    for other in (0..3).filter(|other| *other != wheel) {
                        skew[other] += step.clamp(-LARGEST_STEP, LARGEST_STEP);
                        if skew[other].abs() > LARGEST_SKEW {
                            let degrees = skew[other].to_degrees();
                            return Err(PaperError::Diverged { wheel: other + 1, degrees });
                        }
                    }
                    changed = true;
                }
            }
            if !changed {
                break;
            }
        }
        Ok(skew)
    }

    /// Heading change per metre along a wheel's axle, per angle by which the controller's skews of
    /// both other wheels are raised.
    fn effect_of_others(&self, wheel: usize, skew: [f64; 3]) -> Result<f64, PaperError> {
        let small = 1e-3;
        let mut raised = skew;
        for other in (0..3).filter(|other| *other != wheel) {
            raised[other] += small;
        }
        let (s, c) = Self::axle(wheel).sin_cos();
        let wheel_speeds = self.geometry(raised)?.wheel_speeds(runs::frames::Twist::new(c, s, 0.0));
        Ok(self.geometry(skew)?.twist(&wheel_speeds).omega / small)
    }

    /// One drive along every axle; their mean direction error.
    fn look(&mut self, stage: Stage, skew: [f64; 3]) -> Result<f64, PaperError> {
        let mut sum = 0.0;
        for wheel in 0..3 {
            sum += self.drive(stage, wheel, skew)?.direction_error;
        }
        Ok(sum / 3.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::CameraModel;
    use crate::plant::Contact;
    use crate::simulation::VirtualRobot;
    use runs::frames::Pose;

    fn calibrate(deg: [f64; 3], noise: f64) -> PaperCalibration {
        let layout = Layout::Rac { body_radius_m: 0.085, skew_rad: deg.map(f64::to_radians) };
        let actual = Robot { layout, ..Robot::racbot() };
        let camera = CameraModel { noise: [0.0015 * noise, 0.0015 * noise, 0.009 * noise], ..CameraModel::of(&actual) };
        let mut v = VirtualRobot::new(&actual, Contact::Rolling, camera, Pose::default(), 6).unwrap();
        calibrate_like_the_paper(&Robot::racbot(), &mut v, &PaperOptions::default()).unwrap()
    }

    fn degrees(skew: [f64; 3]) -> [f64; 3] {
        skew.map(f64::to_degrees)
    }

    #[test]
    fn straight_lines_fix_the_differences_and_not_the_common_part() {
        let c = calibrate([4.0, -3.0, 2.0], 0.0);
        let [a, b, d] = degrees(c.straight);
        assert!((a - b - 7.0).abs() < 0.1 && (a - d - 2.0).abs() < 0.1, "{:?}", degrees(c.straight));
        assert!(((a + b + d) / 3.0 - 1.0).abs() > 0.3, "the common part is arbitrary: {:?}", degrees(c.straight));
    }

    #[test]
    fn the_printed_last_step_bends_the_lines_and_the_sound_one_does_not() {
        let c = calibrate([4.0, -3.0, 2.0], 0.0);
        let (straight, scaled, common) =
            (c.quality(Stage::Straight), c.quality(Stage::Scaled), c.quality(Stage::Common));
        assert!(straight.0.to_degrees() < 0.3, "{straight:?}");
        assert!(scaled.0 > 5.0 * straight.0, "{scaled:?} after a factor of {}", c.factor);
        assert!(common.0 < 2.0 * straight.0 && common.1.abs().to_degrees() < 0.1, "{common:?}");
        for (got, truth) in degrees(c.common).iter().zip([4.0, -3.0, 2.0]) {
            assert!((got - truth).abs() < 0.15, "{:?}", degrees(c.common));
        }
    }

    #[test]
    fn the_neglected_wheel_moves_the_heading_most() {
        let rate = |wheel: usize| {
            let mut skew = [0.0; 3];
            skew[wheel] = 0.01;
            let actual = Geometry::rac(0.0275, 0.085, skew).unwrap();
            let speeds =
                Geometry::rac(0.0275, 0.085, [0.0; 3]).unwrap().wheel_speeds(runs::frames::Twist::new(0.0, 1.0, 0.0));
            actual.twist(&speeds).omega
        };
        let [front, left, right] = [rate(0), rate(1), rate(2)];
        assert!((left - right).abs() < 0.02 * front.abs());
        assert!((front + left + right).abs() < 0.03 * front.abs(), "to first order only differences count");
        assert!((front / left + 2.0).abs() < 0.03, "{front} {left}");
    }

    #[test]
    fn noise_of_the_camera_is_survived() {
        let c = calibrate([-5.0, 6.0, 1.0], 1.0);
        for (got, truth) in degrees(c.common).iter().zip([-5.0, 6.0, 1.0]) {
            assert!((got - truth).abs() < 0.4, "{:?}", degrees(c.common));
        }
        assert!(c.iterations.len() < 60, "{}", c.iterations.len());
    }

    #[test]
    fn robots_the_procedure_cannot_work_with_are_refused() {
        let mut robot = Robot::racbot();
        robot.layout = Layout::Wheels(robot.layout.wheels());
        let mut v = VirtualRobot::new(&robot, Contact::Rolling, CameraModel::of(&robot), Pose::default(), 1).unwrap();
        let options = PaperOptions::default();
        assert_eq!(calibrate_like_the_paper(&robot, &mut v, &options).unwrap_err(), PaperError::NotThreeWheels);
        // A speed quantum of 26 rad/s: the loops bang from stop to stop and the robot goes where it likes.
        let coarse = Robot { encoder_counts_per_motor_rev: 64.0, ..Robot::racbot() };
        let layout = Layout::Rac { body_radius_m: 0.085, skew_rad: [0.07, -0.05, 0.03] };
        let actual = Robot { layout, ..coarse.clone() };
        let camera = CameraModel::of(&coarse);
        let mut v = VirtualRobot::new(&actual, Contact::Rolling, camera, Pose::default(), 6).unwrap();
        let e = calibrate_like_the_paper(&coarse, &mut v, &options).unwrap_err();
        assert!(matches!(e, PaperError::Diverged { .. }), "{e}");
        let mut stuck = Robot::racbot();
        stuck.motor.friction_torque = 1.0;
        let mut v = VirtualRobot::new(&stuck, Contact::Rolling, CameraModel::of(&stuck), Pose::default(), 1).unwrap();
        let e = calibrate_like_the_paper(&Robot::racbot(), &mut v, &options).unwrap_err();
        assert!(e.to_string().contains("only moved by"), "{e}");
    }
}
