//! The inertial sensor behind the card: found, set up and checked before the robot is armed, read with every snapshot.
//!
//! ```text
//!  identify ─► reset ─► set up, read back ─► at rest: gravity, axes, bias ─► self-test ─► read at every tick
//! ```

mod error;
mod kinds;

pub use error::ImuError;
pub use kinds::{Channel, ICM_42605, ICM_42688_P, KINDS, Kind, kind};

use crate::realtime::Clock;
use crate::{Board, BoardError, Registers};
use fixed_kin::imu_spi::{NO_AGE, SNAPSHOT_IMU_WORDS};
use fixed_kin::registers as map;
use kinds::GRAVITY;
use model::imu::{ImuModel, Reading};
use runs::robot::ImuMount;
use std::time::Duration;

/// Words of a snapshot that are the sensor's.
pub type Words = [u16; SNAPSHOT_IMU_WORDS];

/// After reset and after the start of the gyroscope; the sheets ask for 1 ms and 30 to 45 ms.
const RESET_TIME: Duration = Duration::from_millis(10);
const START_TIME: Duration = Duration::from_millis(60);
/// Until the self-test has settled, and until it is over: as START_TIME; the maker's own code waits 200 ms.
const SELF_TEST_TIME: Duration = Duration::from_millis(200);
/// Time at rest that the bias is the mean of: noise of 0.063 °/s at 1 kHz is 0.005 °/s then.
const REST_TIME: Duration = Duration::from_millis(200);
/// Least readings of it, where the control rate is low.
const REST_READINGS: usize = 40;
/// Magnitude of gravity that is believed: bias of 0.08 g and scale of 2 %, four standard deviations of the sheet, and
/// some vibration; the next range is a factor of two away.
const GRAVITY_SHARE: f64 = 0.15;
/// Part of gravity along the body's z axis: 26° of tilt.
const UPRIGHT: f64 = 0.9;
/// Mean and scatter of a gyroscope at rest, rad/s: six standard deviations of the bias of 0.5 °/s; noise is 0.06 °/s.
const REST_TURN: f64 = 0.052;
const REST_SCATTER: f64 = 0.02;
/// Equal readings, one after the other, of a sensor that hangs. Noise is three units: chance makes 14 equal bytes
/// twice in a row less than once in 10⁴, eight times never.
pub const FROZEN_READINGS: usize = 8;
/// Counts equal readings, one after the other.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Repeats {
    last: Words,
    equal: usize,
}

impl Repeats {
    /// How often these words have come again; their age may differ.
    pub(crate) fn see(&mut self, words: &Words) -> usize {
        self.equal = if words[1..] == self.last[1..] { self.equal + 1 } else { 0 };
        self.last = *words;
        self.equal
    }
}

/// Looks at an access that should be over after 136 clocks.
const LOOKS: u32 = 1_000;

/// A sensor that was found and checked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Imu {
    kind: &'static Kind,
    mount: ImuMount,
    clock_hz: f64,
    bias: [f64; 3],
}

impl<R: Registers> Board<R> {
    /// One write or read of a register of the sensor, while it is not read at every tick; what came back.
    ///
    /// # Errors
    /// A bus that fails, or a line that stays busy.
    pub fn imu_access(&mut self, register: u8, write: Option<u8>) -> Result<u8, BoardError> {
        let command = map::IMU_READ.place(u32::from(write.is_none()))
            | map::IMU_REGISTER.place(register.into())
            | map::IMU_DATA.place(write.unwrap_or(0).into());
        self.bus.write(map::IMU_ACCESS.offset, command)?;
        let mut status = 0;
        for _ in 0..LOOKS {
            status = self.bus.read(map::IMU_STATUS.offset)?;
            if !map::IMU_BUSY.is_set(status) {
                return Ok(map::IMU_VALUE.of(status).to_le_bytes()[0]);
            }
        }
        Err(BoardError::ReadBack { register: map::IMU_STATUS.name, found: status, written: command })
    }

    /// Finds, sets up and checks the sensor of a configured and disarmed card, and starts reading at every tick.
    ///
    /// # Errors
    /// [`ImuError`]: what is wrong with it; it is not read then.
    pub fn start_imu(&mut self, mount: &ImuMount, clock_hz: f64, clock: &mut impl Clock) -> Result<Imu, ImuError> {
        let kind = kind(&mount.sensor).ok_or_else(|| ImuError::Type(mount.sensor.to_string()))?;
        if self.bus.read(map::BLOCKS.offset).map_err(BoardError::from)? & map::BLOCKS_IMU.place(1) == 0 {
            return Err(ImuError::NoReader);
        }
        let half = (0..4_u32).find(|half| clock_hz / f64::from(2 * (half + 1)) <= kind.fastest_hz.min(FASTEST_HZ));
        let control = map::IMU_MODE_3.place(kind.mode_3.into())
            | map::IMU_HALF.place(half.unwrap_or(3))
            | map::IMU_FIRST.place(kind.first.into());
        self.write_control(control)?;
        self.identify_imu(kind)?;
        let (register, value) = kind.reset;
        self.imu_access(register, Some(value))?;
        pause(clock, RESET_TIME);
        for &(register, written) in kind.settings {
            self.imu_access(register, Some(written))?;
            let found = self.imu_access(register, None)?;
            if found != written {
                return Err(ImuError::ReadBack { register, written, found });
            }
        }
        pause(clock, START_TIME);
        let imu = Imu { kind, mount: *mount, clock_hz, bias: [0.0; 3] };
        let rest = self.look_at_rest(&imu, control, clock)?;
        let rested = rest.judge(&imu)?;
        let (register, value) = kind.self_test;
        self.imu_access(register, Some(value))?;
        pause(clock, SELF_TEST_TIME);
        let tested = self.look_at_rest(&imu, control, clock)?;
        self.imu_access(register, Some(0))?;
        tested.answers(&rest, kind)?;
        pause(clock, START_TIME);
        self.write_control(control | map::IMU_ENABLE.place(1))?;
        Ok(rested)
    }

    fn write_control(&mut self, control: u32) -> Result<(), BoardError> {
        self.bus.write(map::IMU_CONTROL.offset, control)?;
        let found = self.bus.read(map::IMU_CONTROL.offset)?;
        if found == control {
            return Ok(());
        }
        Err(BoardError::ReadBack { register: map::IMU_CONTROL.name, found, written: control })
    }

    fn identify_imu(&mut self, kind: &'static Kind) -> Result<(), ImuError> {
        let (register, value) = kind.who_am_i;
        // The first access wakes some sensors' serial port; a second tells a line that hangs from a lucky bit.
        self.imu_access(register, None)?;
        let found = self.imu_access(register, None)?;
        match found {
            found if found == value => Ok(()),
            0 | 0xFF => Err(ImuError::Absent { found }),
            found => {
                let is = KINDS.into_iter().find(|kind| kind.who_am_i == (register, found)).map(|kind| kind.name);
                Err(ImuError::Another { expected: kind.name, found, is })
            }
        }
    }

    /// Looks at the sensor for a while, the robot standing; it is not read before and after.
    fn look_at_rest(&mut self, imu: &Imu, control: u32, clock: &mut impl Clock) -> Result<Rest, ImuError> {
        self.write_control(control | map::IMU_ENABLE.place(1))?;
        let rest = self.sum_at_rest(imu, clock);
        self.write_control(control)?;
        rest
    }

    fn sum_at_rest(&mut self, imu: &Imu, clock: &mut impl Clock) -> Result<Rest, ImuError> {
        let period = Duration::from_secs_f64(
            f64::from(self.bus.read(map::TICK_PERIOD.offset).map_err(BoardError::from)?) / imu.clock_hz,
        );
        // The first snapshots may be from before.
        (0..3).for_each(|_| pause(clock, period));
        let whole = REST_TIME.as_nanos() / period.as_nanos().max(1);
        let count = usize::try_from(whole).unwrap_or(usize::MAX).max(REST_READINGS);
        let mut rest = Rest::default();
        for _ in 0..count {
            pause(clock, period);
            let words = self.snapshot_with_imu()?.1;
            rest.add(&words, imu.reading(&words).as_ref())?;
        }
        Ok(rest)
    }
}

/// Sums at rest.
#[derive(Default)]
struct Rest {
    readings: usize,
    gyro: [[f64; 2]; 3],
    acceleration: [f64; 3],
    repeats: Repeats,
    silent: usize,
}

impl Rest {
    fn add(&mut self, words: &Words, reading: Option<&Reading>) -> Result<(), ImuError> {
        let Some(reading) = reading else {
            self.silent += 1;
            return if self.silent > FROZEN_READINGS { Err(ImuError::NotReady) } else { Ok(()) };
        };
        let equal = self.repeats.see(words);
        if equal >= FROZEN_READINGS {
            return Err(ImuError::Frozen(equal));
        }
        self.readings += 1;
        for (axis, sums) in self.gyro.iter_mut().enumerate() {
            let rate = reading.gyro[axis];
            *sums = [sums[0] + rate, sums[1] + rate * rate];
            self.acceleration[axis] += reading.acceleration[axis];
        }
        Ok(())
    }

    /// Mean rate of turn and force, in the body's axes.
    fn means(&self) -> [[f64; 3]; 2] {
        let n = self.readings.max(1) as f64;
        [self.gyro.map(|[sum, _]| sum / n), self.acceleration.map(|sum| sum / n)]
    }

    /// Whether every axis moved by what the self-test should move it, against the sensor at rest.
    fn answers(&self, rest: &Self, kind: &Kind) -> Result<(), ImuError> {
        let ([gyro, force], [gyro_at_rest, force_at_rest]) = (self.means(), rest.means());
        let (turn, [least, most]) = kind.answers;
        for (index, axis) in ['x', 'y', 'z'].into_iter().enumerate() {
            let answer = (gyro[index] - gyro_at_rest[index]).abs();
            if answer < turn {
                let most = (kind.gyro * f64::from(i16::MAX)).to_degrees();
                let (answer, least) = (answer.to_degrees(), turn.to_degrees());
                return Err(ImuError::SelfTest { triad: "gyroscope", axis, answer, least, most, unit: "°/s" });
            }
            let answer = (force[index] - force_at_rest[index]).abs();
            if !(least..=most).contains(&answer) {
                return Err(ImuError::SelfTest { triad: "accelerometer", axis, answer, least, most, unit: "m/s²" });
            }
        }
        Ok(())
    }

    fn judge(&self, imu: &Imu) -> Result<Imu, ImuError> {
        let [bias, force] = self.means();
        let magnitude = force.iter().map(|a| a * a).sum::<f64>().sqrt();
        if (magnitude / GRAVITY - 1.0).abs() > GRAVITY_SHARE {
            return Err(ImuError::Range { measured: magnitude });
        }
        if force[2] < UPRIGHT * magnitude {
            return Err(ImuError::Axes { expected: imu.mount.axes[2].to_string(), found: imu.upwards(force) });
        }
        let n = self.readings.max(1) as f64;
        let scatter = self.gyro.map(|[sum, squares]| (squares / n - (sum / n).powi(2)).max(0.0).sqrt());
        let largest = |values: [f64; 3]| values.into_iter().fold(0.0, |most: f64, value| most.max(value.abs()));
        if largest(bias) > REST_TURN || largest(scatter) > REST_SCATTER {
            let (mean_deg_s, scatter_deg_s) = (largest(bias).to_degrees(), largest(scatter).to_degrees());
            return Err(ImuError::Moving { mean_deg_s, scatter_deg_s });
        }
        Ok(Imu { bias, ..*imu })
    }
}

/// What is left of the bias after rest, rad/s, one standard deviation: 0.005 °/s of noise, and, which a filter without a
/// state for it takes for bias, an error of scale of 0.5 % at a turn of 1 rad/s.
const BIAS_LEFT: f64 = 0.3 * std::f64::consts::PI / 180.0;
/// Fastest clock of the line that is used by itself: a cable of some centimetres to another board.
const FASTEST_HZ: f64 = 9e6;

fn pause(clock: &mut impl Clock, time: Duration) {
    let until = clock.now() + time;
    clock.sleep_until(until);
}

impl Imu {
    /// What the words of a snapshot say, in the body's axes, bias included; `None` where the sensor did not answer.
    #[must_use]
    pub fn reading(&self, words: &Words) -> Option<Reading> {
        if words[0] == NO_AGE {
            return None;
        }
        let (mut gyro, mut force, mut celsius) = ([0.0; 3], [0.0; 3], 0.0);
        let mut saturated = false;
        for (channel, word) in self.kind.order.iter().zip(&words[1..]) {
            let word = if self.kind.low_first { word.swap_bytes() } else { *word }.cast_signed();
            let value = f64::from(word);
            match *channel {
                Channel::Temperature => celsius = value * self.kind.temperature[0] + self.kind.temperature[1],
                Channel::Gyro(axis) => {
                    gyro[axis] = value * self.kind.gyro;
                    saturated |= word == i16::MAX || word == i16::MIN;
                }
                Channel::Acceleration(axis) => {
                    force[axis] = value * self.kind.acceleration;
                    saturated |= word == i16::MAX || word == i16::MIN;
                }
            }
        }
        let body = |chip: [f64; 3]| self.mount.axes.map(|axis| axis.of(chip));
        Some(Reading { gyro: body(gyro), acceleration: body(force), temperature_c: celsius, saturated })
    }

    /// Age of the words of a snapshot at its tick, s.
    #[must_use]
    pub fn age_s(&self, words: &Words) -> Option<f64> {
        (words[0] != NO_AGE).then(|| f64::from(words[0]) / self.clock_hz)
    }

    /// Mean rate of turn at rest, rad/s, in the body's axes.
    #[must_use]
    pub fn bias(&self) -> [f64; 3] {
        self.bias
    }

    /// Whether the heading follows it.
    #[must_use]
    pub fn steers(&self) -> bool {
        self.mount.heading
    }

    /// Part number and register table that the sensor answered with.
    #[must_use]
    pub fn kind(&self) -> &'static Kind {
        self.kind
    }

    /// What a filter should believe of it.
    #[must_use]
    pub fn model(&self, rate_hz: f64) -> ImuModel {
        let mut model = ImuModel { place: self.mount.place_m, ..ImuModel::icm_42688_p(rate_hz) };
        model.gyro.noise_density = self.kind.gyro_noise;
        // What is left of it after the mean at rest.
        model.gyro.bias = BIAS_LEFT;
        model
    }

    /// The chip's axis that is nearest to upwards, by the force at rest in the body's axes.
    fn upwards(&self, force: [f64; 3]) -> String {
        let most = (0..3).max_by(|a, b| force[*a].abs().total_cmp(&force[*b].abs())).unwrap_or(2);
        let axis = self.mount.axes[most];
        if force[most] < 0.0 { axis.opposite() } else { axis }.to_string()
    }
}

#[cfg(test)]
mod tests;
