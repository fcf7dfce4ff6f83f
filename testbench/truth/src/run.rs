//! One run: controller, plant, encoders and camera on their own clocks.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use crate::camera::film;
use crate::controller::Control;
use crate::disturbance::Hit;
use crate::inertial::felt;
use crate::log::{Log, Row};
use crate::machine::Machine;
use crate::noise::{Coloured, Stream, normal, stream};
use crate::plant::{Plant, Shake, counts_of};
use crate::record::Track;
use crate::robot::Robot;

/// Longest integration step, s.
pub const LONGEST_STEP_S: f64 = 5.0e-5;
/// Steps between two remembered poses; ticks are divided into a multiple of it.
const STEPS_PER_SAMPLE: usize = 10;

/// What is driven in one run.
#[derive(Clone, Debug, PartialEq)]
pub struct Drive {
    /// Name of the excitation, e.g. `lines`.
    pub name: String,
    /// Body-frame commands: m/s, m/s, rad/s, one per command period.
    pub commands: Vec<[f64; 3]>,
    /// Time between two commands, s.
    pub period_s: f64,
    /// Pose at the start: x, y (m), θ (rad).
    pub start: [f64; 3],
    /// Pushes on the robot.
    pub hits: Vec<Hit>,
}

impl Drive {
    /// Duration, s.
    #[must_use]
    pub fn seconds(&self) -> f64 {
        self.commands.len() as f64 * self.period_s
    }

    /// The command in force at `time` (s), in thousandths as it is sent; rest before the start.
    #[must_use]
    pub fn command(&self, time: f64) -> [f64; 3] {
        if time < 0.0 {
            return [0.0; 3];
        }
        let index = (time / self.period_s + 1e-6) as usize;
        let command = self.commands.get(index).or(self.commands.last()).copied().unwrap_or_default();
        command.map(|v| (v * 1000.0).round() / 1000.0)
    }
}

/// A rotor beyond this angle, rad, is a simulation that diverged: at no load it takes most of an hour.
const DIVERGED_RAD: f64 = 1e6;

/// Control ticks of a run.
pub(crate) fn ticks_of(robot: &Robot, drive: &Drive) -> usize {
    (drive.seconds() * robot.control_rate_hz).round() as usize
}

/// Simulates run `number` (from 0) of the case with this seed.
///
/// The log ends early where the simulation diverges.
#[must_use]
pub fn simulate_run(robot: &Robot, machine: &Machine, drive: &Drive, seed: u64, number: u32) -> Log {
    let rate = robot.control_rate_hz;
    let ticks = ticks_of(robot, drive);
    let samples = (1.0 / (rate * LONGEST_STEP_S * STEPS_PER_SAMPLE as f64)).ceil().max(1.0) as usize;
    let steps = samples * STEPS_PER_SAMPLE;
    let step = 1.0 / (rate * steps as f64);

    let mut plant = Plant::new(machine, drive.start, step, &drive.hits);
    let mut control = Control::new(robot, &machine.controller);
    let mut ground = GroundNoise::new(machine, step * STEPS_PER_SAMPLE as f64, seed, number);
    let mut electronics = stream(seed, Stream::Electronics(number));
    let mut encoders = Encoders::new(robot, machine, &mut electronics);
    let mut track = Track::new(step * STEPS_PER_SAMPLE as f64);
    let mut shake = ground.next();
    remember(&mut track, &plant, machine);

    let late_steps = (machine.power.actuation_latency_s / step).round().max(0.0) as usize;
    let mut rows: Vec<Row> = Vec::with_capacity(ticks);
    let mut applied = vec![0.0; machine.wheels.len()];
    for tick in 0..ticks {
        if !(0..machine.wheels.len()).all(|i| plant.rotor_angle(i).abs() < DIVERGED_RAD) {
            break;
        }
        let time = tick as f64 / rate;
        let counts = encoders.read(&plant, &track, time, &mut electronics);
        let command = drive.command(time);
        let refs = control.set_points(drive.command(time - machine.controller.command_latency_s));
        let duties = control.tick(&refs, &counts);
        let supply_v = if machine.power.supply_measured {
            plant.battery_v() + machine.power.supply_noise_v * normal(&mut electronics)
        } else {
            robot.supply_v
        };
        rows.push(Row { command, refs, counts, duties, supply_v });
        for substep in 0..steps {
            let now = tick * steps + substep;
            if substep == 0 || (now >= late_steps && (now - late_steps).is_multiple_of(steps)) {
                let source = now.checked_sub(late_steps).map(|s| s / steps);
                wire(&mut applied, source.map(|s| rows[s].duties.as_slice()), &machine.controller.wheel_of_axis);
            }
            plant.advance(&applied, &shake);
            if (substep + 1).is_multiple_of(STEPS_PER_SAMPLE) {
                shake = ground.next();
                remember(&mut track, &plant, machine);
            }
        }
    }
    let inertial = if machine.blocks { Vec::new() } else { felt(machine, &track, rate, rows.len(), (seed, number)) };
    let frames = if machine.blocks {
        Vec::new()
    } else {
        film(&machine.camera, &track, rate, rows.len(), &mut stream(seed, Stream::Camera(number)))
    };
    Log { rate_hz: rate, rows, frames, inertial }
}

fn remember(track: &mut Track, plant: &Plant<'_>, machine: &Machine) {
    let angles: Vec<f64> = (0..machine.wheels.len()).map(|i| plant.rotor_angle(i)).collect();
    track.push(plant.pose(), &angles);
}

/// Duties of the axes at the wheels they are wired to.
fn wire(applied: &mut [f64], duties: Option<&[f64]>, wheel_of_axis: &[i32]) {
    for (axis, &wheel) in wheel_of_axis.iter().enumerate() {
        if let Some(slot) = applied.get_mut(index_of(wheel)) {
            *slot = duties.map_or(0.0, |d| d[axis] * f64::from(wheel.signum()));
        }
    }
}

/// Index of a wheel that is numbered from 1 and negative where inverted.
fn index_of(wheel: i32) -> usize {
    (wheel.unsigned_abs() as usize).saturating_sub(1)
}

/// Counters of all axes.
struct Encoders<'a> {
    machine: &'a Machine,
    counts_per_rad: f64,
    phase: Vec<f64>,
    raw: Vec<i64>,
    kept: Vec<i64>,
}

impl<'a> Encoders<'a> {
    fn new(robot: &Robot, machine: &'a Machine, rng: &mut ChaCha8Rng) -> Self {
        let axes = machine.wheels.len();
        Self {
            machine,
            counts_per_rad: counts_of(1.0, machine.power.gear_ratio, f64::from(robot.counts_per_rev)),
            phase: (0..axes).map(|_| rng.random::<f64>()).collect(),
            raw: vec![0; axes],
            kept: vec![0; axes],
        }
    }

    /// Counts now: whole quanta since the start, delayed and thinned where the machine says so.
    fn read(&mut self, plant: &Plant<'_>, track: &Track, time: f64, rng: &mut ChaCha8Rng) -> Vec<i64> {
        let lag = self.machine.power.encoder_lag_s;
        for (axis, &wire) in self.machine.controller.wheel_of_axis.iter().enumerate() {
            let index = index_of(wire);
            let wheel = &self.machine.wheels[index];
            let angle = if lag > 0.0 { track.angle(index, time - lag) } else { plant.rotor_angle(index) };
            let scaled = angle * f64::from(wire.signum()) * self.counts_per_rad * (1.0 + wheel.encoder_scale);
            let raw = (scaled + self.phase[axis]).floor() as i64;
            let fresh = raw - self.raw[axis];
            self.raw[axis] = raw;
            let mut seen = fresh;
            if wheel.encoder_loss > 0.0 && plant.rotor_speed(index).abs() >= wheel.loss_above_rad_s {
                let lost = (0..fresh.abs()).filter(|_| rng.random_bool(wheel.encoder_loss.min(1.0))).count();
                seen -= fresh.signum() * lost as i64;
            }
            self.kept[axis] += seen;
        }
        self.kept.clone()
    }
}

/// Ground noise of a run.
struct GroundNoise {
    force: [Coloured; 2],
    moment: Coloured,
    shafts: Vec<Coloured>,
    rng: ChaCha8Rng,
}

impl GroundNoise {
    fn new(machine: &Machine, interval: f64, seed: u64, number: u32) -> Self {
        let mut rng = stream(seed, Stream::Ground(number));
        let rough = &machine.roughness;
        let mut make = |sd: f64| Coloured::new(sd, rough.time_s, interval, &mut rng);
        let force = [make(rough.force_n), make(rough.force_n)];
        let moment = make(rough.moment_nm);
        let shafts = machine.wheels.iter().map(|_| make(rough.shaft_nm)).collect();
        Self { force, moment, shafts, rng }
    }

    fn next(&mut self) -> Shake {
        let rng = &mut self.rng;
        Shake {
            force_n: [self.force[0].next(rng), self.force[1].next(rng)],
            moment_nm: self.moment.next(rng),
            shaft_nm: self.shafts.iter_mut().map(|noise| noise.next(rng)).collect(),
        }
    }
}
