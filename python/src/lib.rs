//! The Rust half of racbot for Python. Columns go over as bytes of doubles, which numpy wraps without a copy of its own and
//! may write to;
//! `racbot/__init__.py` is the half that people meet.

use driver::{Board, Registers, Scale};
use fixed_kin::format::Speed;
use fixed_kin::kinematics::inverse;
use model::camera::CameraModel;
use model::effects::Applied;
use model::trajectory::SetPoint;
use pyo3::create_exception;
use pyo3::exceptions::PyException;
use pyo3::prelude::*;
use pyo3::types::PyByteArray;
use runs::frames::Twist;
use runs::robot::Robot;
use runs::{DataSet, Logs, Run};
use simulator::closed_loop::{Drive, VirtualRobot, whole_tick_clock_hz};
use simulator::fpga::BitTrue;
use std::fmt::Display;
use std::path::{Path, PathBuf};
use std::time::Duration;

create_exception!(_racbot, RacbotError, PyException, "What is wrong, where, and what to do.");

fn failed(what: impl Display) -> PyErr {
    RacbotError::new_err(what.to_string())
}

type Column = (String, Py<PyByteArray>);

fn bytes(py: Python<'_>, values: impl IntoIterator<Item = f64>) -> Py<PyByteArray> {
    let data: Vec<u8> = values.into_iter().flat_map(f64::to_le_bytes).collect();
    PyByteArray::new(py, &data).unbind()
}

/// The columns of a run by their names in a CSV.
fn columns(py: Python<'_>, run: &Run) -> Vec<Column> {
    let mut out = vec![("t".to_owned(), bytes(py, run.t.iter().copied()))];
    let mut put = |name: String, values: &[f64]| out.push((name, bytes(py, values.iter().copied())));
    for (name, group) in [
        (["cmd_vx", "cmd_vy", "cmd_w"], &run.command),
        (["odom_x", "odom_y", "odom_theta"], &run.odometry),
        (["gyro_x", "gyro_y", "gyro_z"], &run.gyro),
        (["acc_x", "acc_y", "acc_z"], &run.acceleration),
    ] {
        for (name, values) in name.iter().zip(group.iter().flatten()) {
            put((*name).to_owned(), values);
        }
    }
    for (stem, wheels) in [
        ("ref", &run.reference),
        ("duty", &run.duty),
        ("meas", &run.measured),
        ("speed", &run.speed),
        ("current", &run.current),
    ] {
        for (wheel, values) in wheels.iter().enumerate() {
            put(format!("{stem}_{}", wheel + 1), values);
        }
    }
    for (name, values) in [("supply_v", &run.supply_v), ("imu_temp", &run.imu_temp)] {
        if let Some(values) = values {
            put(name.to_owned(), values);
        }
    }
    for (wheel, counts) in run.counts.iter().enumerate() {
        let mut values: Vec<f64> = counts.iter().map(|count| *count as f64).collect();
        for gap in run.count_gaps.get(wheel).into_iter().flatten() {
            values[*gap] = f64::NAN;
        }
        put(format!("enc_{}", wheel + 1), &values);
    }
    if run.has_camera {
        let mut camera = [(); 3].map(|()| vec![f64::NAN; run.len()]);
        for sample in &run.camera {
            let pose = sample.pose;
            for (column, value) in camera.iter_mut().zip([pose.x, pose.y, pose.theta]) {
                column[sample.tick] = value;
            }
        }
        for (name, values) in ["cam_x", "cam_y", "cam_theta"].into_iter().zip(&camera) {
            put(name.to_owned(), values);
        }
    }
    out
}

fn load(robot: Option<&Path>) -> PyResult<Robot> {
    robot.map_or_else(|| Ok(Robot::racbot()), |file| Robot::load(file).map_err(failed))
}

fn logs(folder: &Path, robot: Option<&Path>) -> PyResult<Logs<'static>> {
    match robot {
        None => Logs::open(folder).map_err(failed),
        Some(file) => Logs::open_as(folder, Robot::load_partial(file).map_err(failed)?).map_err(failed),
    }
}

#[pyfunction]
fn read_run(py: Python<'_>, path: PathBuf) -> PyResult<Vec<Column>> {
    let run = py.detach(|| Run::read(path)).map_err(failed)?;
    Ok(columns(py, &run))
}

#[pyfunction]
#[pyo3(signature = (robot, set_points, hidden, limit_s, seed, camera))]
fn simulate(
    py: Python<'_>,
    robot: Option<PathBuf>,
    set_points: Option<Vec<(f64, f64, f64, f64)>>,
    hidden: Option<PathBuf>,
    limit_s: f64,
    seed: u64,
    camera: bool,
) -> PyResult<(Vec<Column>, String, Py<PyByteArray>)> {
    if !(limit_s > 0.0 && limit_s <= 3_600.0) {
        return Err(failed(format!("limit_s: {limit_s} is not more than 0 and at most 3600")));
    }
    let robot = load(robot.as_deref())?;
    let actual = hidden.map_or_else(|| Ok(robot.clone()), |file| load(Some(&file)))?;
    if actual.wheel_count() != robot.wheel_count() {
        return Err(failed("hidden: a robot with another number of wheels"));
    }
    let applied = Applied::of(&actual);
    let mut drive = Drive { believed: robot.clone(), ..Drive::fig_6() };
    if let Some(points) = set_points {
        if points.iter().any(|(x, y, v, omega)| ![x, y, v, omega].into_iter().all(|n| n.is_finite())) {
            return Err(failed("set_points: not all are numbers"));
        }
        drive.set_points = points.into_iter().map(|(x, y, v, omega)| SetPoint::pass(x, y, v, omega)).collect();
    }
    drive.actual = applied.robot.clone();
    drive.contact = applied.contact;
    drive.deviations = applied.deviations.clone();
    drive.camera = camera.then_some(CameraModel { ..applied.camera });
    (drive.limit_s, drive.seed) = (limit_s, seed);
    let driven = py.detach(|| drive.run(BitTrue::new(), |_| {})).map_err(failed)?;
    let track = driven.track.iter().flat_map(|(t, pose)| [*t, pose.x, pose.y, pose.theta]);
    Ok((columns(py, &driven.run), driven.robot.to_toml(), bytes(py, track)))
}

/// Refuses logs that are set up wrong, as the command does, unless that is to be passed over: then what is wrong with them.
fn set_up(folder: &Path, set: &Logs<'_>, despite_mistakes: bool) -> PyResult<Vec<String>> {
    let found = model::setup::mistakes(set);
    let wrong: Vec<String> = found.iter().filter(|m| !m.nameable).map(model::setup::Mistake::sentence).collect();
    if wrong.is_empty() || despite_mistakes {
        return Ok(wrong);
    }
    let (folder, what) = (folder.display(), wrong.join("; also "));
    Err(failed(format!("{folder}: set up wrong: {what} (despite_mistakes=True goes on nevertheless)")))
}

#[pyfunction(name = "gap")]
#[pyo3(signature = (folder, robot, out, despite_mistakes))]
fn find_gap(
    py: Python<'_>,
    folder: PathBuf,
    robot: Option<PathBuf>,
    out: Option<PathBuf>,
    despite_mistakes: bool,
) -> PyResult<String> {
    py.detach(|| {
        let set = logs(&folder, robot.as_deref())?;
        let mistakes = set_up(&folder, &set, despite_mistakes)?;
        let options = gap::Options { robot_file: robot, mistakes, ..gap::Options::default() };
        let analysis = gap::analyse_logs(&set, &options).map_err(failed)?;
        if let Some(out) = out {
            analysis.save(&out, runs::output::Existing::Refuse).map_err(failed)?;
        }
        Ok(analysis.to_json().to_string())
    })
}

#[pyfunction]
#[pyo3(signature = (folder, robot, despite_mistakes))]
fn calibrate(py: Python<'_>, folder: PathBuf, robot: Option<PathBuf>, despite_mistakes: bool) -> PyResult<String> {
    py.detach(|| {
        let set = match robot {
            None => DataSet::open(&folder),
            Some(file) => DataSet::open_as(&folder, Robot::load_partial(file).map_err(failed)?),
        };
        let set = set.map_err(failed)?;
        set_up(&folder, &Logs::from(&set), despite_mistakes)?;
        let estimate = model::calibration::estimate_skew(&set.as_logged(), &set.runs).map_err(failed)?;
        Ok(estimate.to_json().to_string())
    })
}

#[pyfunction]
#[pyo3(signature = (folder, robot))]
fn check(py: Python<'_>, folder: PathBuf, robot: Option<PathBuf>) -> PyResult<Vec<String>> {
    py.detach(|| {
        let set = logs(&folder, robot.as_deref())?;
        Ok(model::setup::mistakes(&set).iter().map(model::setup::Mistake::sentence).collect())
    })
}

#[pyfunction]
#[pyo3(signature = (robot, twists))]
fn wheel_words(robot: Option<PathBuf>, twists: Vec<(f64, f64, f64)>) -> PyResult<Vec<Vec<i32>>> {
    if twists.iter().any(|(vx, vy, omega)| ![vx, vy, omega].into_iter().all(|n| n.is_finite())) {
        return Err(failed("twists: not all are numbers"));
    }
    let scale = scale(&load(robot.as_deref())?)?;
    let rows = &scale.configuration().inverse[..scale.wheels()];
    let words = |(vx, vy, omega)| {
        let twist = scale.twist_words(Twist::new(vx, vy, omega));
        rows.iter().map(|row| inverse(row, &twist).to_bits()).collect()
    };
    Ok(twists.into_iter().map(words).collect())
}

fn scale(robot: &Robot) -> PyResult<Scale> {
    Scale::new(robot, whole_tick_clock_hz(robot.control_rate_hz)).map_err(failed)
}

/// A robot on the bit-true FPGA, in simulated time.
#[pyclass(subclass, unsendable)]
struct BitTrueRobot {
    robot: VirtualRobot<BitTrue>,
    board: Board<VirtualRobot<BitTrue>>,
    scale: Scale,
}

#[pymethods]
impl BitTrueRobot {
    #[new]
    #[pyo3(signature = (robot=None))]
    fn new(robot: Option<PathBuf>) -> PyResult<Self> {
        let file = load(robot.as_deref())?;
        let applied = Applied::of(&file);
        let believed = Robot { effects: Vec::new(), ..file };
        let scale = scale(&believed)?;
        let plant = applied.plant().map_err(failed)?;
        let period = Duration::from_secs_f64(scale.tick_s());
        let robot = VirtualRobot::new(BitTrue::new(), plant, applied.robot.supply_v, period);
        let mut board = Board::new(robot.clone());
        board.configure(&scale, &driver::Settings::default()).map_err(failed)?;
        robot.tick().map_err(failed)?;
        board.arm().map_err(failed)?;
        Ok(Self { robot, board, scale })
    }

    /// Commands a body velocity (m/s to the right, m/s forward, rad/s) and lets so many control ticks pass.
    fn step(&mut self, vx: f64, vy: f64, omega: f64, ticks: u32) -> PyResult<()> {
        if ![vx, vy, omega].into_iter().all(f64::is_finite) {
            return Err(failed("a velocity is no number"));
        }
        for _ in 0..ticks {
            self.board.set_twist(&self.scale, Twist::new(vx, vy, omega)).map_err(failed)?;
            self.robot.tick().map_err(failed)?;
            drop(self.robot.take_history());
        }
        if self.board.status().map_err(failed)?.armed {
            return Ok(());
        }
        let faults = self.board.first_fault().map_err(failed)?;
        Err(failed(format!("the card switched off: {}", driver::fault_names(faults))))
    }

    /// Length of a control tick, s.
    #[getter]
    fn tick_s(&self) -> f64 {
        self.scale.tick_s()
    }

    /// Where it really is: m, m, rad.
    #[getter]
    fn pose(&self) -> (f64, f64, f64) {
        let pose = self.robot.pose();
        (pose.x, pose.y, pose.theta)
    }

    /// How it really moves, in its body frame: m/s, m/s, rad/s.
    #[getter]
    fn twist(&self) -> (f64, f64, f64) {
        let twist = self.robot.twist();
        (twist.vx, twist.vy, twist.omega)
    }

    /// What the card said at the last tick, as words: `(counts, set points, measured speeds, duties)`, a number an axis.
    fn words(&mut self) -> PyResult<(Vec<i32>, Vec<i32>, Vec<i32>, Vec<i32>)> {
        let seen = self.board.snapshot().map_err(failed)?;
        let wheels = self.scale.wheels();
        let speeds = |words: &[Speed]| words[..wheels].iter().map(|word| word.to_bits()).collect();
        let duties = seen.duties[..wheels].iter().map(|word| word.to_bits()).collect();
        Ok((seen.counts[..wheels].to_vec(), speeds(&seen.references), speeds(&seen.speeds), duties))
    }

    /// A register of the card.
    fn read(&mut self, offset: u16) -> PyResult<u32> {
        self.board.bus.read(offset).map_err(failed)
    }
}

#[pymodule]
fn _racbot(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("RacbotError", module.py().get_type::<RacbotError>())?;
    module.add_class::<BitTrueRobot>()?;
    module.add_function(wrap_pyfunction!(read_run, module)?)?;
    module.add_function(wrap_pyfunction!(simulate, module)?)?;
    module.add_function(wrap_pyfunction!(find_gap, module)?)?;
    module.add_function(wrap_pyfunction!(calibrate, module)?)?;
    module.add_function(wrap_pyfunction!(check, module)?)?;
    module.add_function(wrap_pyfunction!(wheel_words, module)?)
}
