//! Writing a run while it is being driven, tick by tick.

use crate::output::{Existing, create_growing};
use std::io::{self, Write};
use std::path::Path;

use super::columns::Column;
use super::{McapStream, Run};
use crate::frames::Pose;

/// Which columns a run will have.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Layout {
    /// Commanded body twist.
    pub command: bool,
    /// Wheels with set points; 0 or the robot's number.
    pub references: usize,
    /// Wheels with encoders; 0 or the robot's number.
    pub counts: usize,
    /// Wheels with duties; 0 or the robot's number.
    pub duties: usize,
    /// Wheels with measured speeds; 0 or the robot's number.
    pub measured: usize,
    /// Supply voltage.
    pub supply: bool,
    /// Camera poses, on the ticks that have one.
    pub camera: bool,
    /// Wheels with speeds; 0 or the robot's number.
    pub speeds: usize,
    /// Wheels with currents; 0 or the robot's number.
    pub currents: usize,
    /// The robot's own dead reckoning.
    pub odometry: bool,
    /// Rates of turn.
    pub gyro: bool,
    /// Whether there are `acc_x`, `acc_y`, m/s².
    pub acceleration: bool,
    /// Temperature of the inertial sensors.
    pub imu_temp: bool,
}

impl Layout {
    /// Everything that a robot's own computer knows; nobody measures its supply.
    pub fn of_robot(wheels: usize, camera: bool) -> Self {
        let [references, counts, duties, measured] = [wheels; 4];
        Self { command: true, references, counts, duties, measured, camera, ..Self::default() }
    }

    /// With an inertial sensor.
    #[must_use]
    pub fn with_imu(self, there: bool) -> Self {
        Self { gyro: there, acceleration: there, imu_temp: there, ..self }
    }

    pub(super) fn columns(self) -> Vec<Column> {
        let group = |there: bool, group: fn(usize) -> Column| (0..if there { 3 } else { 0 }).map(group);
        let mut columns = vec![Column::Time];
        columns.extend(group(self.command, Column::Command));
        columns.extend((0..self.references).map(Column::Reference));
        columns.extend((0..self.counts).map(Column::Counts));
        columns.extend((0..self.duties).map(Column::Duty));
        columns.extend((0..self.measured).map(Column::Measured));
        columns.extend(self.supply.then_some(Column::Supply));
        columns.extend(group(self.camera, Column::Camera));
        columns.extend((0..self.speeds).map(Column::Speed));
        columns.extend((0..self.currents).map(Column::Current));
        columns.extend(group(self.odometry, Column::Odometry));
        columns.extend(group(self.gyro, Column::Gyro));
        columns.extend(group(self.acceleration, Column::Acceleration));
        columns.extend(self.imu_temp.then_some(Column::ImuTemperature));
        columns
    }
}

/// One tick to be written; what its [`Layout`] does not have is ignored, NaN is "no sample".
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Tick<'a> {
    /// Time, s; greater than that of the tick before.
    pub t: f64,
    /// Commanded body twist: m/s, m/s, rad/s.
    pub command: [f64; 3],
    /// Wheel speed set points, rad/s at the wheel.
    pub reference: &'a [f64],
    /// Cumulative encoder counts.
    pub counts: &'a [Option<i64>],
    /// Duties in [−1, 1].
    pub duty: &'a [f64],
    /// Wheel speeds as the loop measured them, rad/s at the wheel.
    pub measured: &'a [f64],
    /// Battery voltage at this tick, V; NaN where nobody measured it.
    pub supply_v: f64,
    /// Camera pose, where there is one at this tick.
    pub camera: Option<Pose>,
    /// Wheel speeds where there are no counts, rad/s at the wheel.
    pub speed: &'a [f64],
    /// Motor currents, A.
    pub current: &'a [f64],
    /// Dead reckoning, m, m, rad.
    pub odometry: [f64; 3],
    /// Rates of turn about the body's axes, rad/s.
    pub gyro: [f64; 3],
    /// Accelerations along the body's axes, m/s².
    pub acceleration: [f64; 3],
    /// Temperature of the inertial sensors, °C.
    pub imu_temp: f64,
}

impl Tick<'_> {
    /// The number in a column; NaN where there is no sample.
    pub(super) fn number(&self, column: Column) -> f64 {
        let of = |numbers: &[f64], i: usize| numbers.get(i).copied().unwrap_or(f64::NAN);
        match column {
            Column::Time => self.t,
            Column::Command(i) => self.command[i],
            Column::Reference(wheel) => of(self.reference, wheel),
            Column::Duty(wheel) => of(self.duty, wheel),
            Column::Measured(wheel) => of(self.measured, wheel),
            Column::Supply => self.supply_v,
            Column::Camera(i) => self.camera.map_or(f64::NAN, |p| [p.x, p.y, p.theta][i]),
            Column::Speed(wheel) => of(self.speed, wheel),
            Column::Current(wheel) => of(self.current, wheel),
            Column::Odometry(i) => self.odometry[i],
            Column::Gyro(i) => self.gyro[i],
            Column::Acceleration(i) => self.acceleration[i],
            Column::ImuTemperature => self.imu_temp,
            Column::Counts(_) | Column::Other => f64::NAN,
        }
    }

    pub(super) fn count(&self, wheel: usize) -> Option<i64> {
        self.counts.get(wheel).copied().flatten()
    }
}

/// Where a run goes while it is being driven.
///
/// After [`RunStream::flush`] everything before it survives the death of the process: whatever
/// comes after is either whole or recognised as cut off by the reader.
pub trait RunStream: Send {
    /// Takes a tick; it may stay in memory until the next flush.
    ///
    /// # Errors
    /// What the medium reports.
    fn tick(&mut self, tick: &Tick<'_>) -> io::Result<()>;

    /// Puts a file into the run, such as the robot's, where the format has room for it; a CSV has none.
    ///
    /// # Errors
    /// What the medium reports.
    fn attach(&mut self, _name: &str, _text: &str) -> io::Result<()> {
        Ok(())
    }

    /// Hands all that was taken to the operating system.
    ///
    /// # Errors
    /// What the medium reports.
    fn flush(&mut self) -> io::Result<()>;

    /// Completes the file.
    ///
    /// # Errors
    /// What the medium reports.
    fn finish(&mut self) -> io::Result<()>;
}

/// A new run file that grows under its name, MCAP where that ends in `.mcap`, else CSV.
///
/// `start_ns`: time of t = 0 in nanoseconds since 1970, for MCAP's own time stamps.
///
/// # Errors
/// A file that cannot be created, or exists and is to stay.
pub fn create(path: &Path, layout: Layout, start_ns: u64, existing: Existing) -> io::Result<Box<dyn RunStream>> {
    let file = create_growing(path, existing)?;
    Ok(if is_mcap(path) {
        Box::new(McapStream::new(io::BufWriter::new(file), layout, start_ns)?)
    } else {
        Box::new(CsvStream::new(file, layout)?)
    })
}

/// Whether a file's name says MCAP.
pub(super) fn is_mcap(path: &Path) -> bool {
    path.extension().is_some_and(|e| e.eq_ignore_ascii_case("mcap"))
}

/// A CSV that grows by whole lines only.
#[derive(Debug)]
pub struct CsvStream<W> {
    writer: W,
    columns: Vec<Column>,
    lines: Vec<u8>,
}

/// Lines kept in memory before they are written without being asked.
const MOST_BYTES: usize = 1 << 16;

impl<W: Write> CsvStream<W> {
    /// Writes the header.
    ///
    /// # Errors
    /// What the writer reports.
    pub fn new(mut writer: W, layout: Layout) -> io::Result<Self> {
        let columns = layout.columns();
        let names: Vec<String> = columns.iter().map(|column| column.name()).collect();
        writer.write_all((names.join(",") + "\n").as_bytes())?;
        Ok(Self { writer, columns, lines: Vec::with_capacity(2 * MOST_BYTES) })
    }
}

impl<W: Write + Send> RunStream for CsvStream<W> {
    fn tick(&mut self, tick: &Tick<'_>) -> io::Result<()> {
        for (index, column) in self.columns.iter().enumerate() {
            if index > 0 {
                self.lines.push(b',');
            }
            match *column {
                Column::Counts(wheel) => {
                    if let Some(count) = tick.count(wheel) {
                        write!(self.lines, "{count}")?;
                    }
                }
                column => {
                    let number = tick.number(column);
                    if !number.is_nan() {
                        write!(self.lines, "{number}")?;
                    }
                }
            }
        }
        self.lines.push(b'\n');
        if self.lines.len() >= MOST_BYTES { self.flush() } else { Ok(()) }
    }

    fn flush(&mut self) -> io::Result<()> {
        // One call for whole lines: a kill leaves no half line behind.
        self.writer.write_all(&self.lines)?;
        self.lines.clear();
        self.writer.flush()
    }

    fn finish(&mut self) -> io::Result<()> {
        self.flush()
    }
}

impl Run {
    /// The columns of this run.
    pub(super) fn layout(&self) -> Layout {
        Layout {
            command: self.command.is_some(),
            references: self.reference.len(),
            counts: self.counts.len(),
            duties: self.duty.len(),
            measured: self.measured.len(),
            supply: self.supply_v.is_some(),
            camera: self.has_camera,
            speeds: self.speed.len(),
            currents: self.current.len(),
            odometry: self.odometry.is_some(),
            gyro: self.gyro.is_some(),
            acceleration: self.acceleration.is_some(),
            imu_temp: self.imu_temp.is_some(),
        }
    }

    /// Writes every tick of the run to a stream, and completes it. Columns that we do not know
    /// ([`Run::other`]) are left out.
    ///
    /// # Errors
    /// What the stream reports.
    pub fn stream_to(&self, stream: &mut dyn RunStream) -> io::Result<()> {
        let at = |columns: &[Vec<f64>], tick: usize| columns.iter().map(|c| c[tick]).collect::<Vec<_>>();
        let triple = |group: &Option<[Vec<f64>; 3]>, tick: usize| {
            group.as_ref().map_or([f64::NAN; 3], |g| [0, 1, 2].map(|i| g[i][tick]))
        };
        let mut camera = self.camera.iter().peekable();
        for index in 0..self.len() {
            let counts: Vec<Option<i64>> = self
                .counts
                .iter()
                .zip(&self.count_gaps)
                .map(|(counts, gaps)| gaps.binary_search(&index).is_err().then_some(counts[index]))
                .collect();
            stream.tick(&Tick {
                t: self.t[index],
                command: triple(&self.command, index),
                reference: &at(&self.reference, index),
                counts: &counts,
                duty: &at(&self.duty, index),
                measured: &at(&self.measured, index),
                supply_v: self.supply_v.as_ref().map_or(f64::NAN, |s| s[index]),
                camera: camera.next_if(|sample| sample.tick == index).map(|sample| sample.pose),
                speed: &at(&self.speed, index),
                current: &at(&self.current, index),
                odometry: triple(&self.odometry, index),
                gyro: triple(&self.gyro, index),
                acceleration: triple(&self.acceleration, index),
                imu_temp: self.imu_temp.as_ref().map_or(f64::NAN, |c| c[index]),
            })?;
        }
        stream.finish()
    }
}
