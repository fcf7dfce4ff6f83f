//! The paper's calibration on the virtual robot: every drive goes through the FPGA, whose
//! coefficient registers hold the skews believed in so far.

use crate::closed_loop::{LoopError, VirtualRobot, whole_tick_clock_hz};
use crate::fpga::BitTrue;
use driver::{Board, Scale, Settings};
use model::calibration::{DriveError, Drives};
use model::camera::{Camera, CameraModel};
use model::plant::{Contact, Plant};
use plot::{Axis, Color, Figure, Panel, Series};
use runs::frames::{Pose, Twist};
use runs::geometry::Geometry;
use runs::robot::{Layout, Robot};
use std::time::Duration;

/// Speed of a calibration drive, m/s.
const SPEED: f64 = 0.6;
/// Acceleration of a calibration drive, m/s²: low enough that no speed loop saturates.
const ACCELERATION: f64 = 0.8;
/// Rest before and after a drive, s.
const REST_S: f64 = 0.3;

/// A robot on the bit-true FPGA that drives straight lines under an overhead camera.
#[derive(Debug)]
pub struct BoardRobot {
    nominal: Robot,
    actual: Robot,
    contact: Contact,
    camera: Camera,
    pose: Pose,
    time: f64,
    /// Drives so far.
    pub drives: usize,
}

impl BoardRobot {
    /// A robot that is `actual`, of which the host knows all but the skews of `nominal`.
    #[must_use]
    pub fn new(nominal: &Robot, actual: &Robot, contact: Contact, seed: u64) -> Self {
        Self {
            nominal: nominal.clone(),
            actual: actual.clone(),
            contact,
            camera: Camera::new(CameraModel::of(actual), seed),
            pose: Pose::default(),
            time: 0.0,
            drives: 0,
        }
    }

    fn drive(&mut self, believed: &Robot, direction: [f64; 2], distance_m: f64) -> Result<Vec<Pose>, LoopError> {
        let plant = Plant::new(&self.actual)?.with_contact(self.contact).at(self.pose);
        let scale = Scale::new(believed, whole_tick_clock_hz(believed.control_rate_hz))?;
        let tick = scale.tick_s();
        let robot = VirtualRobot::new(BitTrue::new(), plant, self.actual.supply_v, Duration::from_secs_f64(tick));
        let mut board = Board::new(robot.clone());
        board.configure(&scale, &Settings::default())?;
        robot.tick()?;
        board.arm()?;
        let ramp = SPEED / ACCELERATION;
        let cruise = (distance_m / SPEED - ramp).max(0.0);
        let end = 2.0 * REST_S + 2.0 * ramp + cruise;
        let mut seen = Vec::new();
        for step in 0..(end / tick).ceil() as usize {
            let t = step as f64 * tick;
            let rising = (t - REST_S) * ACCELERATION;
            let falling = (end - REST_S - t) * ACCELERATION;
            let speed = rising.min(falling).clamp(0.0, SPEED);
            board.set_twist(&scale, Twist::new(speed * direction[0], speed * direction[1], 0.0))?;
            robot.tick()?;
            seen.extend(self.camera.observe(self.time + t, robot.pose()));
        }
        self.time += end;
        self.pose = robot.pose();
        self.drives += 1;
        Ok(seen)
    }
}

impl Drives for BoardRobot {
    fn drive_straight(
        &mut self,
        believed: &Geometry,
        direction_rad: f64,
        distance_m: f64,
    ) -> Result<Vec<Pose>, DriveError> {
        let mut robot = self.nominal.clone();
        robot.layout = Layout::Wheels(believed.wheels().to_vec());
        let (sine, cosine) = direction_rad.sin_cos();
        self.drive(&robot, [cosine, sine], distance_m).map_err(|error| DriveError(error.to_string()))
    }
}

/// The paper's Fig. 9: where a robot goes that means to drive along the axle of wheel 1, for skews
/// of the two wheels that drive then, from −`largest_rad` to it.
///
/// Constant wheel speeds give a constant body velocity, so the curves are exact arcs.
#[must_use]
pub fn skew_fan(nominal: &Robot, largest_rad: f64) -> Option<String> {
    let Layout::Rac { body_radius_m, .. } = nominal.layout else { return None };
    let geometry = |skew| Geometry::rac(nominal.wheel_radius_m, body_radius_m, skew).ok();
    let speeds = geometry([0.0; 3])?.wheel_speeds(Twist::new(0.0, SPEED, 0.0));
    let mut map = Panel::new(Axis::new("x", "m"), Axis::new("y", "m")).equal_aspect();
    let colors = [Color::Blue, Color::Green, Color::Black, Color::Orange, Color::Red];
    for (step, color) in (-2_i32..=2).zip(colors) {
        let skew = largest_rad * f64::from(step) / 2.0;
        let twist = geometry([0.0, skew, skew])?.twist(&speeds);
        let at = |t: f64| Pose::default().advance(twist, t);
        let line = (0..=100).map(|i| at(0.04 * f64::from(i))).map(|p| [p.x, p.y]).collect();
        let arrows = (0..=8).map(|i| at(0.5 * f64::from(i))).map(|p| [p.x, p.y, p.theta]).collect();
        let label = format!("α₂ = α₃ = {:+.0}°", skew.to_degrees());
        map = map.with(Series::line(label, line).color(color).headings(arrows));
    }
    Some(Figure::new("Along the axle of wheel 1, the other wheels skewed").with(map).to_svg())
}

#[cfg(test)]
mod tests {
    use super::*;
    use model::calibration::{PaperOptions, Stage, calibrate_like_the_paper, estimate_skew};
    use runs::DataSet;
    use std::path::Path;

    const TABLE: measured::Table<'_> = measured::Table {
        name: "calibration",
        title: "Skews of 4°, −3°, 2° as found: from the shipped log, and by the paper's procedure on the virtual robot",
        command: "cargo test --release -p simulator --lib calibration",
        columns: &[
            "by",
            "wheel 1, °",
            "wheel 2, °",
            "wheel 3, °",
            "half of the 95 % interval, °",
            "lines turn by, °/m",
        ],
    };

    fn row(by: &str, skews: &[f64], half: &str, turn: &str) -> Vec<String> {
        let skews = skews.iter().map(|skew| format!("{:.2}", skew.to_degrees()));
        [by.to_owned()].into_iter().chain(skews).chain([half.to_owned(), turn.to_owned()]).collect()
    }

    #[test]
    fn a_log_tells_all_skews() {
        let set = DataSet::open(Path::new(env!("CARGO_MANIFEST_DIR")).join("../data/runs/wheel-skew")).unwrap();
        let found = estimate_skew(&set.robot, &set.runs).unwrap();
        let widest = found.ci95.iter().map(|[low, high]| 0.5 * (high - low)).fold(0.0, f64::max);
        TABLE.check_row(&row("estimate", &found.skew_rad, &format!("{:.2}", widest.to_degrees()), ""));
        for (skew, truth) in found.skew_rad.iter().zip([4.0_f64, -3.0, 2.0]) {
            assert!((skew - truth.to_radians()).abs() < widest, "{:.3}° for {truth}°", skew.to_degrees());
        }
    }

    #[test]
    fn the_paper_procedure_is_measured_as_the_command_prints_it() {
        let nominal = Robot::racbot();
        let mut actual = nominal.clone();
        actual.layout = Layout::Rac { body_radius_m: 0.085, skew_rad: [4.0_f64, -3.0, 2.0].map(f64::to_radians) };
        let mut robot = BoardRobot::new(&nominal, &actual, Contact::default(), 1);
        let found = calibrate_like_the_paper(&nominal, &mut robot, &PaperOptions::default()).unwrap();
        for (by, skew, stage) in [
            ("paper, straight", found.straight, Stage::Straight),
            ("paper, scaled as printed", found.scaled, Stage::Scaled),
            ("paper, one angle added", found.common, Stage::Common),
        ] {
            TABLE.check_row(&row(by, &skew, "", &format!("{:.2}", found.quality(stage).0.to_degrees())));
        }
    }

    #[test]
    fn the_paper_procedure_over_the_fpga_finds_the_differences() {
        let nominal = Robot::racbot();
        let truth = [4.0_f64, -3.0, 2.0].map(f64::to_radians);
        let mut actual = nominal.clone();
        actual.layout = Layout::Rac { body_radius_m: 0.085, skew_rad: truth };
        let mut robot = BoardRobot::new(&nominal, &actual, Contact::default(), 3);
        let found = calibrate_like_the_paper(&nominal, &mut robot, &PaperOptions::default()).unwrap();
        for (i, j) in [(0, 1), (1, 2), (2, 0)] {
            let error = (found.common[i] - found.common[j]) - (truth[i] - truth[j]);
            assert!(error.to_degrees().abs() < 0.3, "{i} - {j}: {:.2}°", error.to_degrees());
        }
        assert!(robot.drives > 6);
    }
}
