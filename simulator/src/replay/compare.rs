//! How closely duties agree.

use fixed_kin::format::Format;
use runs::Run;
use runs::robot::Robot;

/// Difference of two duties over many ticks.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Deviation {
    /// Largest, as duty.
    pub max: f64,
    /// Tick of the largest.
    pub at: usize,
    /// Ticks on which it is more than rounding explains.
    pub beyond: usize,
    /// Ticks compared.
    pub ticks: usize,
    squares: f64,
}

impl Deviation {
    fn add(&mut self, tick: usize, difference: f64, allowed: f64) {
        let size = difference.abs();
        if size.is_nan() {
            return;
        }
        if size > self.max {
            (self.max, self.at) = (size, tick);
        }
        self.beyond += usize::from(size > allowed);
        self.squares += size * size;
        self.ticks += 1;
    }

    /// Root mean square, as duty.
    #[must_use]
    pub fn rms(&self) -> f64 {
        (self.squares / self.ticks.max(1) as f64).sqrt()
    }

    /// The larger of both.
    #[must_use]
    pub fn worse(self, other: Self) -> Self {
        let (max, at) = if other.max > self.max { (other.max, other.at) } else { (self.max, self.at) };
        Self {
            max,
            at,
            beyond: self.beyond + other.beyond,
            ticks: self.ticks + other.ticks,
            squares: self.squares + other.squares,
        }
    }
}

/// A duty in LSB of the card, 2⁻²⁴ of full drive.
#[must_use]
pub fn lsb(duty: f64) -> f64 {
    duty / Format::DUTY.lsb()
}

/// How well one wheel agrees.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WheelAgreement {
    /// FPGA against the log.
    pub fpga: Deviation,
    /// The law in floating point against the log.
    pub law: Deviation,
    /// FPGA against the law: what the card's arithmetic adds, without the log's rounding.
    pub arithmetic: Deviation,
}

impl WheelAgreement {
    pub(super) fn add(&mut self, tick: usize, fpga: f64, law: f64, logged: f64, quantum: f64) {
        // A tie may fall either way, a hair's breadth for the decimal numbers of the log.
        let allowed = 0.5 * quantum + 1e-9;
        self.fpga.add(tick, fpga - logged, allowed);
        self.law.add(tick, law - logged, allowed);
        self.arithmetic.add(tick, fpga - law, Format::DUTY.lsb());
    }

    /// Both wheels together.
    #[must_use]
    pub fn with(self, other: Self) -> Self {
        Self {
            fpga: self.fpga.worse(other.fpga),
            law: self.law.worse(other.law),
            arithmetic: self.arithmetic.worse(other.arithmetic),
        }
    }
}

/// To what the log's duties are rounded: what the robot's file says, else the coarsest power of ten
/// that all of them are multiples of, else the card's LSB.
#[must_use]
pub fn duty_quantum(robot: &Robot, run: &Run) -> f64 {
    if let Some(quantum) = robot.duty_quantum {
        return quantum;
    }
    let fits = |quantum: f64| {
        let off = |duty: f64| (duty / quantum - (duty / quantum).round()).abs();
        run.duty.iter().flatten().all(|&duty| duty.is_nan() || off(duty) < 1e-6)
    };
    [0.1, 0.01, 0.001, 1e-4, 1e-5, 1e-6].into_iter().find(|&quantum| fits(quantum)).unwrap_or(Format::DUTY.lsb())
}
