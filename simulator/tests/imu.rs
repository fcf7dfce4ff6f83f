//! The inertial sensor in the loop that drives a real robot: every way it can be wrong is found before arming or passed
//! over while driving, and what it buys against the wheels alone. Writes `docs/measured/imu.md` and
//! `docs/measured/imu-faults.md`.

use driver::Board;
use driver::drive::{DriveError, Ending, PoseSource};
use driver::imu::ImuError;
use driver::realtime::Clock;
use fixed_kin::registers as map;
use measured::Table;
use model::camera::CameraModel;
use model::measurement::Measurement;
use model::plant::{Contact, Creep, Plant};
use model::trajectory::SetPoint;
use runs::frames::wrap_angle;
use runs::robot::{ImuMount, Layout, Robot, SensorName};
use simulator::closed_loop::{Drive, Driven, LoopError, VirtualRobot};
use simulator::fpga::{BitTrue, Fpga};
use simulator::imu::{ImuFault, VirtualImu};
use std::time::Duration;

const FAULTS: Table<'_> = Table {
    name: "imu-faults",
    title: "An inertial sensor with one fault each: what the driver says before it arms, of 5 parts each",
    command: "cargo test --release -p simulator --test imu",
    columns: &["fault", "found", "said"],
};

const TABLE: Table<'_> = Table {
    name: "imu",
    title: "The drive loop over the bit-true card, 5 s after the last frame of the overhead camera, 10 seeds each: root \
            mean square and worst",
    command: "cargo test --release -p simulator --test imu",
    columns: &[
        "robot and floor",
        "way, m",
        "heading, wheels, °",
        "heading, gyroscope, °",
        "worst, wheels, °",
        "worst, gyroscope, °",
        "place, wheels, mm",
        "place, gyroscope, mm",
    ],
};
const SEEDS: u64 = 10;
/// The camera is there for so long, then gone for so long, s.
const SEEN_S: f64 = 2.0;
const BLIND_S: f64 = 5.0;

fn sensed() -> Robot {
    let mount = ImuMount::upright(SensorName::new("icm-42688-p").expect("a name"));
    Robot { imu: Some(mount), ..Robot::racbot() }
}

fn card(seed: u64) -> BitTrue {
    BitTrue::new().with_imu(VirtualImu::new(1_000.0, seed))
}

/// Rounds of a rectangle of 4 m by 3 m at up to 3 m/s, turning one way all the time or not at all.
fn rounds(turning: bool) -> Vec<SetPoint> {
    let corners = [(4.0, 0.0), (4.0, 3.0), (0.0, 3.0), (0.0, 0.0)];
    let turn = if turning { 1.0 } else { 0.0 };
    (0..4).flat_map(|_| corners).map(|(x, y)| SetPoint::pass(x, y, 3.0, turn)).collect()
}

/// A camera that goes out.
struct Until<S>(S);

impl<S: PoseSource> PoseSource for Until<S> {
    fn arrived(&mut self, t: f64) -> Option<Measurement> {
        self.0.arrived(t).filter(|_| t < SEEN_S)
    }
}

fn drive(skew_rad: f64, contact: Contact, turning: bool, gyroscope: bool, seed: u64) -> Driven {
    let believed = if gyroscope { sensed() } else { Robot::racbot() };
    let mut drive = Drive::new(&believed, &rounds(turning));
    let sign = |k: u64| if seed >> k & 1 == 0 { 1.0 } else { -1.0 };
    drive.actual.layout = Layout::Rac { body_radius_m: 0.085, skew_rad: [0, 1, 2].map(|k| sign(k) * skew_rad) };
    drive.contact = contact;
    drive.camera = Some(CameraModel::of(&believed));
    drive.fused = true;
    drive.limit_s = SEEN_S + BLIND_S;
    drive.seed = seed + 50;
    drive.run_seen_by(card(seed + 90), Until, |_| {}).expect("the simulation runs")
}

/// Heading, °, and place, mm, off at the end, and the way without camera, m.
fn errors(driven: &Driven) -> [f64; 3] {
    let (end, truth) = driven.track.last().expect("a drive");
    assert!(*end > SEEN_S + BLIND_S - 0.1, "ended at {end} s: {:?}", driven.ending);
    let believed = driven.believed.last().expect("a drive");
    let blind: Vec<_> = driven.track.iter().filter(|(t, _)| *t >= SEEN_S).collect();
    let way = blind.windows(2).map(|pair| pair[0].1.distance(pair[1].1)).sum();
    [wrap_angle(believed.theta - truth.theta).to_degrees().abs(), 1e3 * believed.distance(*truth), way]
}

#[test]
fn the_gyroscope_keeps_the_heading_when_the_camera_is_gone() {
    let grip = Contact::Friction { friction_coefficient: 0.6, creep: Creep::at_rest(0.000_5) };
    let slippery = Contact::Friction { friction_coefficient: 0.3, creep: Creep::at_rest(0.002) };
    let mut rows = Vec::new();
    for (name, skew_deg, contact, turning) in [
        ("calibrated, grip", 0.0_f64, grip, false),
        ("calibrated, grip, turning at 1 rad/s", 0.0, grip, true),
        ("2° of skew, grip", 2.0, grip, false),
        ("calibrated, slippery", 0.0, slippery, false),
        ("2° of skew, slippery", 2.0, slippery, false),
    ] {
        let [wheels, gyro] = [false, true].map(|gyroscope| {
            let run = |seed| errors(&drive(skew_deg.to_radians(), contact, turning, gyroscope, seed));
            (0..SEEDS).map(run).collect::<Vec<_>>()
        });
        let rms = |all: &[[f64; 3]], of: usize| (all.iter().map(|e| e[of] * e[of]).sum::<f64>() / SEEDS as f64).sqrt();
        let worst = |all: &[[f64; 3]]| all.iter().fold(0.0, |most: f64, e| most.max(e[0]));
        println!("{name}: {gyro:.2?}\n{wheels:.2?}");
        assert!(rms(&gyro, 0) < if turning { 6.0 } else { 1.5 }, "{name}");
        assert!(skew_deg == 0.0 || rms(&gyro, 0) < 0.5 * rms(&wheels, 0), "{name}");
        rows.push(vec![
            name.to_owned(),
            format!("{:.1}", rms(&gyro, 2)),
            format!("{:.2}", rms(&wheels, 0)),
            format!("{:.2}", rms(&gyro, 0)),
            format!("{:.2}", worst(&wheels)),
            format!("{:.2}", worst(&gyro)),
            format!("{:.0}", rms(&wheels, 1)),
            format!("{:.0}", rms(&gyro, 1)),
        ]);
    }
    rows.iter().for_each(|row| println!("{}", row.join(" | ")));
    TABLE.check(&rows);
}

fn start(fault: Option<ImuFault>, seed: u64) -> Result<Driven, LoopError> {
    let mut fpga = card(seed);
    fpga.imu().expect("it is there").fault = fault;
    let drive = Drive { limit_s: 0.3, ..Drive::new(&sensed(), &rounds(false)) };
    drive.run(fpga, |_| {})
}

fn found(fault: ImuFault, error: &ImuError) -> bool {
    matches!(
        (fault, error),
        (ImuFault::Absent, ImuError::Absent { found: 0xFF })
            | (ImuFault::ShortedLow, ImuError::Absent { found: 0 })
            | (ImuFault::Frozen, ImuError::Frozen(_))
            | (ImuFault::Swapped, ImuError::Axes { .. })
            | (ImuFault::WrongRange, ImuError::Range { .. })
            | (ImuFault::NeverReady, ImuError::NotReady)
            | (ImuFault::OtherType, ImuError::Another { found: 0x42, is: Some("icm-42605"), .. })
            | (ImuFault::StuckBit, ImuError::ReadBack { .. })
            | (ImuFault::DeadGyro, ImuError::SelfTest { triad: "gyroscope", axis: 'z', .. })
            | (ImuFault::DeadForce, ImuError::SelfTest { triad: "accelerometer", axis: 'x', .. })
    )
}

#[test]
fn every_fault_is_found_and_named_before_arming() {
    let mut rows = Vec::new();
    for fault in ImuFault::ALL {
        let mut said = String::new();
        let count = (0..5)
            .filter(|seed| match start(Some(fault), *seed) {
                Err(LoopError::Drive(DriveError::Imu(error))) => {
                    said = error.to_string();
                    found(fault, &error)
                }
                other => panic!("{fault:?}: {other:?}"),
            })
            .count();
        rows.push(vec![format!("{fault:?}"), format!("{count} of 5"), said]);
        assert_eq!(count, 5, "{fault:?}");
    }
    FAULTS.check(&rows);
}

#[test]
fn a_good_sensor_of_any_part_is_taken_and_logged() {
    for seed in 0..10 {
        let driven = start(None, seed).unwrap_or_else(|error| panic!("part {seed}: {error}"));
        assert!(matches!(driven.ending, Ending::TimeLimit), "{:?}", driven.ending);
        let (gyro, force) = (driven.run.gyro.expect("gyro"), driven.run.acceleration.expect("acceleration"));
        assert!(gyro[2].iter().all(|v| v.is_finite()) && force[2].iter().all(|v| (v - 9.8).abs() < 3.0));
        assert!(driven.run.imu_temp.expect("temperature").iter().all(|v| (20.0..40.0).contains(v)));
    }
}

/// The words of a snapshot are of one tick, also while the robot drives.
#[test]
fn a_sensor_that_dies_while_driving_is_noticed_and_the_drive_goes_on() {
    let robot = VirtualRobot::new(card(3), Plant::new(&sensed()).expect("a robot"), 7.2, Duration::from_millis(1));
    let plan = driver::drive::Plan { limit_s: 1.0, ..driver::drive::Plan::new(&sensed(), &rounds(false)) };
    let clock_hz = simulator::closed_loop::whole_tick_clock_hz(1_000.0);
    let scale = plan.scale(clock_hz).expect("it fits");
    let steer =
        driver::drive::Controller::new(plan.control, &plan.believed(), &plan.set_points, plan.start).expect("wheels");
    let mut clock = robot.clone();
    let mut session =
        driver::drive::Session::begin(&plan, scale, steer, Board::new(robot.clone()), &mut clock).expect("starts");
    let mut ending = None;
    while ending.is_none() {
        session.wait(&mut clock);
        if session.so_far().t > 0.5 {
            robot.fpga(|fpga| fpga.imu().expect("it is there").fault = Some(ImuFault::Absent));
        }
        ending = session.tick(&mut clock, &mut driver::drive::NoSource, None);
    }
    let driven = session.end(ending.expect("it ended"));
    assert!(matches!(driven.ending, Ending::TimeLimit), "{:?}", driven.ending);
    let gone = driven.imu_gone.expect("noticed");
    assert!((0.5..0.54).contains(&gone), "{gone}");
    assert!(robot.pose().x > 0.3, "{:?}", robot.pose());
}

/// A sensor is not touched where the robot has none, and a card is not armed with a bad one.
#[test]
fn a_robot_without_a_section_leaves_the_sensor_alone() {
    let mut fpga = card(1);
    fpga.imu().expect("it is there").fault = Some(ImuFault::Absent);
    let drive = Drive { limit_s: 0.2, ..Drive::new(&Robot::racbot(), &rounds(false)) };
    let driven = drive.run(fpga, |_| {}).expect("drives");
    assert!(driven.run.gyro.is_none());
    let robot = VirtualRobot::new(card(1), Plant::new(&sensed()).expect("a robot"), 7.2, Duration::from_millis(1));
    robot.fpga(|fpga| fpga.imu().expect("it is there").fault = Some(ImuFault::Swapped));
    let plan = driver::drive::Plan::new(&sensed(), &rounds(false));
    let scale = plan.scale(simulator::closed_loop::whole_tick_clock_hz(1_000.0)).expect("it fits");
    let steer =
        driver::drive::Controller::new(plan.control, &plan.believed(), &plan.set_points, plan.start).expect("wheels");
    let mut clock = robot.clone();
    assert!(driver::drive::Session::begin(&plan, scale, steer, Board::new(robot.clone()), &mut clock).is_err());
    let status = robot.fpga(|fpga| driver::Registers::read(fpga, map::STATUS.offset).expect("reads"));
    assert!(!map::STATUS_ARMED.is_set(status));
    clock.sleep_until(Duration::from_secs(1));
    let control = robot.fpga(|fpga| driver::Registers::read(fpga, map::IMU_CONTROL.offset).expect("reads"));
    assert!(!map::IMU_ENABLE.is_set(control), "nobody reads a sensor that is not believed");
}
