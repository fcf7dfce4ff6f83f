//! Every figure of the drive link that decides, with its unit, its reason and the experiment that set it, and the gate
//! that whatever is named must pass.
//!
//! None is a size of one robot: lengths, masses, torques and speeds are measured in those of the log at hand, in counts
//! of its encoders, or in its noise.

/// Torque that is large, in RMS torques of the motors in the log: 0.055 Nm RMS where 0.095 Nm is all that the motors
/// have (four example sets), beside which what is material was set.
pub const PEAK_OF_RMS: f64 = 1.75;

/// Grip beside which a wheel's friction is judged on the floor, as a coefficient: rollers and contacts of omni wheels
/// lose 0.005 to 0.011 of the load (rigid-body engine, robots of 1.6 to 3.8 kg), and what is named (from 3 % of the
/// grip) must lie above that.
pub const GRIP: f64 = 0.43;

/// Share of the drive's torque that wheels lose as they roll, which no file of a robot gives and no name is due to:
/// rollers and contacts of omni wheels lose 0.005 to 0.011 of the load, one to three hundredths of [`GRIP`] (the same
/// engine); on the simulator, whose truth has both, 2.4 % of it remain on the example set once its skews are named.
pub const ROLLING_LOSES: f64 = 0.02;

/// Share of the drive's torque that a winding loses within 2 K, which no file of a motor gives: copper's resistance grows by
/// 0.39 % a kelvin. The floor of an axis on blocks, where nothing rolls.
pub const WARMTH: f64 = 0.008;

/// Speed of a drive in shares of its no-load speed, where no log tells: that of the simulator's manoeuvres.
pub const USUAL_SPEED: f64 = 0.06;

/// Speed about 0 within which friction turns round, as a share of the speed of the log: 0.4 rad/s where wheels turn at
/// 17 (four example sets).
pub const TURNS_ROUND: f64 = 0.0235;
/// The same in counts within the smoothing of a speed: below that the sign of a speed is noise. Three of them, on
/// motors with 12 counts a turn, took slow turning for standing: the dry friction that the file has was then missed
/// near rest, and named as friction of Stribeck on 4 of 6 simulated controls; with one count, on none.
pub const TURNS_ROUND_COUNTS: f64 = 1.0;
/// Speed below which a wheel may stick, in units of the above: tanh(0.9) is 0.7 of the friction.
pub const STUCK: f64 = 0.9;
/// Torque of static friction that may have acted in a test function, as its share of the test function in which the
/// wheel may have stuck times its size, from which the test function says nothing of the wheel: one standard deviation
/// of the noise.
pub const STICKS: f64 = 1.0;
/// Share of the test functions that must go for that before what is named is looked at again without them.
pub const STICKS_OFTEN: f64 = 0.02;
/// Speed of a contact over which rolling and sliding friction turn round, in the same units at the rim of the wheel.
pub const SLIDES: f64 = 0.9;
/// Slip of a rolling wheel, in the same units: creep and noise stay below. 1.5 rad/s on the simulator.
pub const ROLLING: f64 = 3.75;

/// Standard deviations by which a free simulation must get worse to speak against an effect: as many as 2.3 % of noise.
pub const RUNAWAY: f64 = 2.0;

/// Control periods between two rows of a log from which the duty is not taken as held in between.
pub const ROWS_APART: f64 = 1.5;

/// Noise floors left on the drive from which it is searched again with next to no margin for what is not named. On
/// simulated robots 1.0 to 1.3 are left; on a real one whose friction nobody had told (four wheels, 60 Hz) 4.4.
pub const FAR_LEFT: f64 = 3.0;
/// Residuals up to which the outcome of that is as good.
pub const AS_WELL: f64 = 1.15;
/// Share of what a law leaves above the noise, beyond that many floors, within which another law is as good: on the
/// same robot friction leaves 8 % more than a bridge that is not linear, and neither half of the gap.
pub const UNDECIDED: f64 = 0.3;

/// Floors left in the window in the middle, on the link of camera and wheels, from which nothing has a name that closes less than [`UNDECIDED`] of what
/// is left above the noise. On squares of a real robot with four mecanum wheels 4.0 were left, and skews of 1 to 2 degrees
/// closed 0.14 of them, one factor of its sideways motion as much; simulated slip that grows with the speed left 2.7, and the
/// angles of two wheels closed 0.19. On circles of the same robot 1.8 were left, and what closed a tenth was an expert's, too.
pub const DWARFS: f64 = 2.0;

/// Floors from which a law that leaves them is far from the noise beside one that does not: a motor of 12 counts a turn
/// whose torque constant was 13 % off left 2.0 by viscous friction and 1.1 by the torque constant.
pub const FROM_NOISE: f64 = 1.5;

/// Standard deviations by which one law of the drive must leave more than another that leaves hardly more than noise, each
/// fitted with nothing adjusted beside it, for that to speak against it: five, beyond what a bias of the fit makes of noise.
/// On ten simulated flywheels with dry and viscous friction the laws that were not at work left 5 to 330 more. A dead band
/// for dry friction leaves 5 to 14 less there, by how exact the two laws are near rest: twins are not told by this.
pub const TOLD: f64 = 5.0;

/// Share of what is more than noise without it that an effect too small to matter alone must close to be named beside
/// others. A servo's viscous friction, a tenth of its dry friction, closed all that this left; on wheels that stick
/// between moves viscous friction that is not there closes a part of it, estimated at a quarter and not measured.
pub const LEAST_TOGETHER: f64 = 0.5;

/// Squared gap that one effect may open by itself, in those of the link before anything was named, beyond which it only
/// takes back what others named beside it do. On a short log of the example set a motor 130 K warm and 73 % stronger,
/// which gap opened 20 times as far without either, passed for a few per cent of rolling loss.
pub const CANCELS: f64 = 4.0;

/// Time constant up to which a firmware filters the speeds that it logs, s: 10 to 50 ms are usual, and a mean of 100 ms is the
/// longest that a motor controller for robots has by itself. Reasoned, from their manuals.
pub const FILTER_S: f64 = 0.11;
/// Share of the torque that the motors reach in the logs beyond which scatter is no noise of a drive.
pub const NO_NOISE: f64 = 0.15;
/// Share of what a duty varies that its wheel's motion accounts for, from which it is this drive's, however much
/// scatters: less, and most of it has nothing to do with the wheel. Reasoned, and tried on two: a motor's
/// log with foreign duties, and one whose amplifier wanders by a tenth.
pub const FOREIGN: f64 = 0.5;

/// Limits of detection, in sizes that matter, at the middle of all effects of a link, from which that nothing shows there
/// says nothing. On the effect-free example set it is 1.2; three steps of 0.4 s on a lifted wheel with 48 counts a turn had
/// 38, and were called agreement though a rotor of twice the inertia would not have shown.
pub const BLIND: f64 = 10.0;
/// Limit of detection, in sizes that matter, up to which the camera decides on what both links show.
pub const SEEN: f64 = 2.0;
/// Share of the information on a small effect that the floor must have hidden for another look above a lower one.
pub const HIDDEN: f64 = 0.2;
/// Share of the explained gap that the inexactness of a law may leave as structure.
pub const LAW_LEAVES: f64 = 0.05;
/// Share of a link's gap that must be left at most once its effects stand in the file; on the motion link what the fit
/// must close held out decides.
pub const FALLS: f64 = 0.98;
/// Control periods between two rows of a log beyond which its times are in another unit.
pub const ODD_ROWS: f64 = 300.0;

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
    let at_bound = |e: &Estimate| {
        let near = AT_BOUND * (e.bounds[1] - e.bounds[0]);
        e.value != 0.0 && (e.value <= e.bounds[0] + near || e.value >= e.bounds[1] - near)
    };
    // A bound at which the effect is absent, or nearly so, is judged by materiality.
    if sized().any(|e| at_bound(e) && !(e.absent_at_zero && e.value.abs() < 0.05 * (e.bounds[1] - e.bounds[0]))) {
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
        assert_eq!(gate(&[place], Some(0.01)), Ok(()));
    }
}
