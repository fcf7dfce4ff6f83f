//! Mistakes in setting a data set up, found before anything is fitted: units, axes, signs, orders, the wrong file.
//!
//! Poses of the camera, commands and set points are compared with what the counts say by `robot.toml`. Every comparison
//! is a ratio or a turn, fitted over all logs; a mistake is a ratio of 1000, 57.3, 9.55, 4, 2 or a quarter turn, far from
//! what a robot that differs from its drawing can show.

mod aside;
mod axes;
mod camera;
mod counts;
mod drive;
mod foreign;
mod held;
mod inertia;
mod inertial;
mod loops;
mod motors;
mod orders;
mod reckoned;
mod samples;
mod signals;
mod slips;
mod speeds;
mod stands;
mod supply;
mod time;
mod turns;
mod winding;
mod work;

use runs::robot::Robot;
use runs::{Logs, is_dead_reckoning, is_from_speeds};

pub use counts::DECODED;
pub use orders::orders;
pub use time::is_tick;
pub use winding::Winding;

/// Something set up wrongly, with what shows it and what mends it.
#[derive(Debug, Clone, PartialEq)]
pub struct Mistake {
    /// What kind, kebab-case, stable.
    pub kind: &'static str,
    /// Column of the logs, or key of `robot.toml`, that it is seen in.
    pub column: String,
    /// What is wrong, with the figure that tells.
    pub what: String,
    /// What to write instead.
    pub remedy: String,
    /// Whether an analysis may go on: it has an effect of this name and says more.
    pub nameable: bool,
}

impl Mistake {
    /// Whether what drives this axis (from 0), or its set points, go against its counts.
    fn is_reversed(&self, axis: usize) -> bool {
        let number = self.column.rsplit('_').next().and_then(|n| n.parse::<usize>().ok());
        self.kind == "drive-reversed" && number == Some(axis + 1)
    }

    fn new(kind: &'static str, column: &str, what: String, remedy: String) -> Self {
        Self { kind, column: column.to_owned(), what, remedy, nameable: false }
    }

    /// What, where and the remedy, for a terminal.
    pub fn sentence(&self) -> String {
        format!("{}: {}; {}", self.column, self.what, self.remedy)
    }
}

/// Ratio to nominal that a robot may truly have: a radius, a lever or a camera's scale wrong by two fifths is no drawing
/// error any more, and the nearest mistake (a diameter for a radius) is a factor of 2.
pub const TRUE_RATIO: f64 = 1.45;
/// Relative width about a ratio by which a mistake is recognised.
pub(crate) const NEAR: f64 = 0.22;

/// The kind of mistake of wheels that all turn the other way.
pub(crate) const OTHER_SENSE_KIND: &str = "wheels-reversed";
/// Where it stands, what it is and what mends it where positive speed turns every wheel the other way.
pub(crate) const OTHER_SENSE: [&str; 3] = [
    "[[wheel]]",
    "positive speeds drive every wheel the other way than robot.toml says",
    "add pi to drive_rad of every [[wheel]] (`racbot init --turns` says which way they turn the robot), or change the signs of all \
     encoders or speeds",
];

/// Whether a ratio is within [`NEAR`] of `of`, what a mistake makes of it.
pub(crate) fn near(ratio: f64, of: f64) -> bool {
    (ratio / of - 1.0).abs() < NEAR
}

/// Whether a ratio may be the robot's own.
pub(crate) fn is_true(ratio: f64) -> bool {
    (1.0 / TRUE_RATIO..=TRUE_RATIO).contains(&ratio)
}

/// All mistakes of a data set, those first that others follow from.
pub fn mistakes(set: &Logs) -> Vec<Mistake> {
    let robot = set.as_logged();
    let found = time::mistakes(&set.robot, &robot, &set.logs);
    if !found.is_empty() {
        // Every speed would be wrong.
        return found;
    }
    let found = foreign::mistakes(&robot, &set.logs);
    if !found.is_empty() {
        return found;
    }
    let found = held::mistakes(&robot, &set.logs);
    if !found.is_empty() {
        return found;
    }
    let found = stands::mistakes(&robot, &set.logs);
    if !found.is_empty() {
        return found;
    }
    let mut found = drive::mistakes(&robot, &set.logs);
    if let Some(reckoned) = reckoned::mistakes(&robot, &set.logs) {
        // What such poses say of the wheels is what the counts say.
        found.push(reckoned);
        return found;
    }
    found.extend(camera::mistakes(&robot, &set.logs, &found));
    let reversed = turns::mistakes(&robot, &set.logs, &found);
    if !reversed.is_empty() {
        found.retain(|m| !turns::OF_HEADINGS.contains(&m.kind));
        found.extend(reversed);
    }
    if found.iter().any(|m| m.kind == "encoder-order") {
        // It says which of the two is the wrong way round.
        found.retain(|m| m.kind != "drive-reversed");
    }
    found.extend(aside::mistakes(&set.robot, &robot, &set.logs));
    found.extend(inertial::mistakes(&robot, &set.logs, &found));
    if found.is_empty() {
        found.extend(speeds::mistakes(&robot, &set.logs));
    }
    if found.is_empty() {
        // Speeds that are wrong would be too fast for any motor.
        found.extend(motors::mistakes(&robot, &set.logs));
    }
    if found.is_empty() {
        found.extend(inertia::mistakes(&robot, &set.logs));
    }
    if found.is_empty() {
        found.extend(winding::mistakes(&robot, &set.logs));
    }
    found
}

/// What stands in the file under the name of a common ratio of all distances, if it explains it.
pub(crate) fn common_ratio(robot: &Robot, ratio: f64) -> Option<Mistake> {
    if is_dead_reckoning(robot) {
        return None;
    }
    let diameter = (0.5, {
        let what =
            format!("all distances by the counts are {:.2} times too long: it looks like a diameter", 1.0 / ratio);
        let radius = format!("write wheel_radius_m = {}", short(robot.wheel_radius_m / 2.0));
        let counts = short(2.0 * robot.encoder_counts_per_motor_rev);
        let remedy = if is_from_speeds(robot) {
            radius
        } else {
            format!(
                "{radius}; if it is the radius, a turn has twice the counts: encoder_counts_per_motor_rev = {counts}"
            )
        };
        Mistake::new("wheel-diameter", "wheel_radius_m", what, remedy)
    });
    let mut kinds = vec![diameter];
    kinds.extend(if is_from_speeds(robot) { of_speeds(robot, ratio) } else { of_counts(robot, ratio) });
    let off = |of: f64| (ratio / of).ln().abs();
    kinds.into_iter().filter(|(of, _)| near(ratio, *of)).min_by(|a, b| off(a.0).total_cmp(&off(b.0))).map(|(_, m)| m)
}

/// Speeds of another shaft or in another unit, which encoder and gear have no part in.
fn of_speeds(robot: &Robot, ratio: f64) -> Vec<(f64, Mistake)> {
    let gear = robot.gear_ratio;
    let kind = |of: f64, looks: &str, remedy: String| {
        let what = format!("the wheels' speeds are {} times what they drive: {looks}", short(1.0 / ratio));
        (of, Mistake::new("speed-unit", "speed_1", what, remedy))
    };
    let mut kinds = vec![kind(
        std::f64::consts::TAU / 60.0,
        "turns per minute",
        "write rad/s at the wheel (divide by 9.5493), or name the unit to `racbot convert`".to_owned(),
    )];
    if gear.ln().abs() > 0.5 {
        let remedy = format!("divide them by gear_ratio, {}: they are rad/s at the wheel", short(gear));
        kinds.push(kind(1.0 / gear, "speeds of the motors", remedy));
    }
    kinds
}

/// Counts of another number for a turn of the wheel.
fn of_counts(robot: &Robot, ratio: f64) -> Vec<(f64, Mistake)> {
    let gear = robot.gear_ratio;
    let mut kinds: Vec<(f64, Mistake)> = vec![(0.25, {
        let what = format!(
            "all distances by the counts are {:.2} times too long: counts without their x4 decoding",
            1.0 / ratio
        );
        let remedy = format!(
            "write encoder_counts_per_motor_rev = {}, four for every line of the encoder",
            short(4.0 * robot.encoder_counts_per_motor_rev)
        );
        Mistake::new("encoder-counts", "encoder_counts_per_motor_rev", what, remedy)
    })];
    if (gear * gear).ln().abs() > 0.5 {
        let what = format!(
            "all distances by the counts are {:.2} times too long, the square of the gear ratio: it is upside down",
            1.0 / ratio
        );
        let remedy = format!("write gear_ratio = {}, motor turns per wheel turn", short(1.0 / gear));
        kinds.push((gear * gear, Mistake::new("gear-ratio", "gear_ratio", what, remedy)));
    }
    kinds
}

/// Four digits.
pub(crate) fn short(x: f64) -> String {
    if x == 0.0 || !x.is_finite() {
        return format!("{x}");
    }
    let digits = (3 - x.abs().log10().floor() as i32).max(0) as usize;
    let text = format!("{x:.digits$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}
