//! Figures of the links' physics that decide, with their units, reasons and the experiments that set them, and the gate
//! that whatever is named must pass. What a search for causes decides by stands in `gap::thresholds`.
//!
//! None is a size of one robot: lengths, masses, torques and speeds are measured in those of the log at hand, in counts
//! of its encoders, or in its noise.

/// Torque that is large, in RMS torques of the motors in the log: 0.055 Nm RMS where 0.095 Nm is all that the motors
/// have (four example sets), beside which what is material was set.
pub const PEAK_OF_RMS: f64 = 1.75;

/// Torque of a weight or a spring at most, in what the motor gives or the accelerations take by the file's inertia: a motor
/// swings a pendulum up by and by that weighs three times what it lifts, with a file that has a third of the inertia. With 2
/// the pendulum of such a recording had half its weight, and an encoder that read 28 degrees ahead.
pub const CARRIED: f64 = 6.0;

/// Grip beside which a wheel's friction is judged on the floor, as a coefficient: rollers and contacts of omni wheels
/// lose 0.005 to 0.011 of the load (rigid-body engine, robots of 1.6 to 3.8 kg), and what is named (from 3 % of the
/// grip) must lie above that.
pub const GRIP: f64 = 0.43;

/// How far from the camera's origin a robot is seen on a usual field, in distances of its wheels from its centre: 1 m where they
/// stand 8 cm from it, a field some dozens of robots wide. What matters there matters to a log that saw less of it as well.
pub const FIELD_OF_RIM: f64 = 12.65;

/// Speed of a drive in shares of its no-load speed, where no log tells: that of the simulator's manoeuvres.
pub const USUAL_SPEED: f64 = 0.06;

/// Length of a test function of the drive where nothing asks for longer ones, s.
pub const TEST_FUNCTION_S: f64 = 0.12;

/// Speed about 0 within which friction turns round, as a share of the speed of the log: 0.4 rad/s where wheels turn at
/// 17 (four example sets).
pub const TURNS_ROUND: f64 = 0.0235;
/// The same in counts within the smoothing of a speed: below that the sign of a speed is noise. Three of them, on
/// motors with 12 counts a turn, took slow turning for standing: the dry friction that the file has was then missed
/// near rest, and named as friction of Stribeck on 4 of 6 simulated controls; with one count, on none.
pub const TURNS_ROUND_COUNTS: f64 = 1.0;
/// Speed below which a wheel may stick, in units of the above: tanh(0.9) is 0.7 of the friction.
pub const STUCK: f64 = 0.9;
/// Speed of a contact over which rolling and sliding friction turn round, in the same units at the rim of the wheel.
pub const SLIDES: f64 = 0.9;
/// Slip of a rolling wheel, in the same units: creep and noise stay below. 1.5 rad/s on the simulator.
pub const ROLLING: f64 = 3.75;
/// The same of what the law of slip alone says, which has no other causes: a wheel that breaks away reaches the slip above by
/// the end of a test function at half of the acceleration that its floor gives a robot of 50 kg. Of one on a floor of 0.15 the
/// duties came 28 ms early and a winding was 22 % too large; with 0.3, 0.1 and 0.03 of it nothing was named.
pub const HELD: f64 = 0.1 * ROLLING;

/// Time constant up to which a firmware filters the speeds that it logs, s: 10 to 50 ms are usual, and a mean of
/// 100 ms is the longest that a motor controller for robots has by itself. Reasoned, from their manuals.
const FILTER_S: f64 = 0.11;
/// The same in rows of a log, whose firmware smooths once a row: of `w += 0.15 (now - w)`, the least share that examples for
/// small controllers have, the time constant is 6.2 rows. At 50 Hz a filter of 120 ms was seven times the rotor inertia.
const FILTER_ROWS: f64 = 7.0;

/// Time constant up to which a firmware filters the speeds of a log with rows `row_s` apart, s.
pub fn filter_s(row_s: f64) -> f64 {
    FILTER_S.max(FILTER_ROWS * row_s)
}

/// Torque that the noise of raw increments of the angles makes, RMS, in the torque of the limited current, from which the
/// limit is applied by smoothed speeds: it would cut off the noise on one side, and leave a mean that is off. Reasoned.
pub const NOISY_AT_LIMIT: f64 = 0.1;

/// Share of the variance of a wheel's duty, and of its speed, that set points must account for, or what its loop answers is
/// not taken off: what set points make is then all that speaks for an effect, and too little of it estimates nothing (weak
/// instruments). Reasoned.
pub const ACCOUNTED_FOR: f64 = 0.3;

/// Control periods between two rows of a log from which the duty is not taken as held in between.
pub const ROWS_APART: f64 = 1.5;
/// Distance of rows after a gap from the beat of the others, in rows, up to which rows were lost in it: what comes at any time
/// is a quarter off. Reasoned.
pub const BEAT: f64 = 0.1;
/// Share of a test function of the drive that rows may be missing of: of a step that came meanwhile it knows the size to half of
/// that share. With as much as a wheel may be stuck, of a loop whose rows were lost for up to a quarter of a second nothing was
/// named; without a limit a battery that sags was.
pub const UNLOGGED: f64 = 0.35;

/// Significance from which an effect is named: in one of twenty data sets chance gives as much.
pub const SIGNIFICANT: f64 = 0.05;
/// Distance from a bound at which a value is not one that the data chose, as a share of the distance of the bounds.
pub const AT_BOUND: f64 = 0.002;

/// A fitted parameter with its interval.
#[derive(Debug, Clone, PartialEq)]
pub struct Estimate {
    /// Of the parameter, as in the catalogue.
    pub name: String,
    /// In the parameter's unit.
    pub value: f64,
    /// Where it lies with 95 % confidence.
    pub interval: [f64; 2],
    /// Physical bounds.
    pub bounds: [f64; 2],
    /// Whether it has a size that can matter; others only say where, or how fast.
    pub sized: bool,
    /// Whether the effect is absent at 0.
    pub absent_at_zero: bool,
    /// Whether at its lower bound it cannot be told from what is there anyway.
    pub blurred: bool,
    /// Whether at its upper bound it is no more what it says.
    pub closed: bool,
}

/// Why something is not named.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Refusal {
    /// Chance gives as much.
    Chance,
    /// No interval excludes 0.
    HoldsZero,
    /// A value rests at a physical bound.
    AtBound,
    /// An interval is wider than the bounds.
    SaysNothing,
    /// Others undo most of what it does.
    Cancelled,
    /// What no effect explains is far more than what it closes.
    Dwarfed,
}

impl Refusal {
    /// In words.
    pub fn reason(self) -> &'static str {
        match self {
            Self::Chance => "chance gives as much in one of twenty data sets",
            Self::HoldsZero => "its interval holds 0",
            Self::AtBound => "it fits best at the bound of what is physical",
            Self::SaysNothing => "its interval is wider than what is physical",
            Self::Cancelled => "what else was fitted would undo most of it",
            Self::Dwarfed => "no effect explains what remains beside what it closes",
        }
    }
}

/// The gate that everything named must pass, on every link.
///
/// # Errors
/// Why it must not be named.
pub fn gate(estimates: &[Estimate], p_value: Option<f64>) -> Result<(), Refusal> {
    if p_value.is_some_and(|p| p.is_nan() || p > SIGNIFICANT) {
        return Err(Refusal::Chance);
    }
    let sized = || estimates.iter().filter(|e| e.sized);
    let holds_zero = |e: &Estimate| !(e.interval[0] > 0.0 || e.interval[1] < 0.0);
    if sized().count() > 0 && sized().all(|e| e.absent_at_zero && holds_zero(e)) {
        return Err(Refusal::HoldsZero);
    }
    let near = |e: &Estimate| AT_BOUND * (e.bounds[1] - e.bounds[0]);
    let is_low = |e: &Estimate| e.value <= e.bounds[0] + near(e);
    let is_high = |e: &Estimate| e.value >= e.bounds[1] - near(e);
    let at_bound = |e: &Estimate| e.value != 0.0 && (is_low(e) || is_high(e));
    // A bound at which the effect is absent, or nearly so, is judged by materiality.
    if sized().any(|e| at_bound(e) && !(e.absent_at_zero && e.value.abs() < 0.05 * (e.bounds[1] - e.bounds[0]))) {
        return Err(Refusal::AtBound);
    }
    if estimates.iter().any(|e| e.blurred && is_low(e) || e.closed && is_high(e)) {
        return Err(Refusal::AtBound);
    }
    let says_nothing = |e: &Estimate| {
        let width = e.interval[1] - e.interval[0];
        width.is_nan() || width > e.bounds[1] - e.bounds[0]
    };
    if sized().any(says_nothing) {
        return Err(Refusal::SaysNothing);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn estimate(value: f64, half: f64) -> Estimate {
        Estimate {
            name: "scale".to_owned(),
            value,
            interval: [value - half, value + half],
            bounds: [-0.6, 2.0],
            sized: true,
            absent_at_zero: true,
            blurred: false,
            closed: false,
        }
    }

    #[test]
    fn the_gate_refuses_what_says_nothing() {
        let cases = [
            (estimate(0.2, 0.1), Some(0.001), Ok(())),
            (estimate(0.2, 0.1), None, Ok(())),
            (estimate(0.2, 0.1), Some(0.06), Err(Refusal::Chance)),
            (estimate(0.2, 0.1), Some(f64::NAN), Err(Refusal::Chance)),
            (estimate(0.2, 0.21), Some(0.001), Err(Refusal::HoldsZero)),
            (estimate(0.2, f64::NAN), Some(0.001), Err(Refusal::HoldsZero)),
            (estimate(2.0, 0.1), Some(0.001), Err(Refusal::AtBound)),
            (estimate(-0.6, 0.1), Some(0.001), Err(Refusal::AtBound)),
            (estimate(-0.62, 0.1), Some(0.001), Err(Refusal::AtBound)),
            (estimate(1.6, 1.4), Some(0.001), Err(Refusal::SaysNothing)),
        ];
        for (e, p, wanted) in cases {
            assert_eq!(gate(std::slice::from_ref(&e), p), wanted, "{e:?} {p:?}");
        }
        // One of two parts of an effect may be 0.
        assert_eq!(gate(&[estimate(0.2, 0.1), estimate(0.0, 0.1)], Some(0.001)), Ok(()));
        // Where nothing has a size, only significance counts.
        let place = Estimate { sized: false, ..estimate(2.0, 9.0) };
        let blurred = |value: f64| Estimate { sized: false, blurred: true, ..estimate(value, 0.1) };
        assert_eq!(gate(&[estimate(0.2, 0.1), blurred(-0.6)], None), Err(Refusal::AtBound));
        assert_eq!(gate(&[estimate(0.2, 0.1), blurred(0.1)], None), Ok(()));
        let closed = |value: f64| Estimate { sized: false, closed: true, ..estimate(value, 0.1) };
        assert_eq!(gate(&[estimate(0.2, 0.1), closed(2.0)], None), Err(Refusal::AtBound));
        assert_eq!(gate(&[estimate(0.2, 0.1), closed(-0.6)], None), Ok(()));
        assert_eq!(gate(&[place], Some(0.01)), Ok(()));
    }
}
