//! What a series seems to be, by its name and its range.

use super::super::{Series, Table, units};
use super::time_unit;
use crate::columns::{Column, MOST_DUTY};

/// What a series seems to be.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Kind {
    Command,
    Camera,
    Odometry,
    Gyro,
    Acceleration,
    Counts,
    Reference,
    Speed,
    Duty,
    Current,
    Supply,
}

/// Words that tell what a series is, the telling first.
const WORDS: [(Kind, &[&str]); 10] = [
    (Kind::Supply, &["supply", "vbus", "vbat", "battery", "akku"]),
    (Kind::Duty, &["duty", "pwm"]),
    (Kind::Current, &["current", "amps", "iq"]),
    (Kind::Gyro, &["gyro", "gyroscope", "angular_velocity"]),
    (Kind::Acceleration, &["acc", "accel", "acceleration", "linear_acceleration"]),
    (Kind::Command, &["cmd", "command", "soll", "twist", "desired"]),
    (Kind::Reference, &["ref", "reference", "setpoint", "target", "set", "sp"]),
    (Kind::Counts, &["enc", "encoder", "tick", "ticks", "counts", "count", "position", "pos"]),
    (Kind::Odometry, &["odom", "odometry", "odo", "o", "dr", "reckoning"]),
    (
        Kind::Camera,
        &[
            "cam",
            "camera",
            "vision",
            "ssl",
            "mocap",
            "optitrack",
            "opti",
            "vicon",
            "qualisys",
            "tracker",
            "pose",
            "blue",
            "yellow",
            "gt",
            "groundtruth",
            "truth",
            "true",
            "real",
            "laser",
            "slam",
            "map",
            "gps",
            "aruco",
            "apriltag",
            "tag",
        ],
    ),
];

pub(super) fn supply_words() -> impl Iterator<Item = &'static str> {
    WORDS.iter().filter(|(kind, _)| *kind == Kind::Supply).flat_map(|(_, names)| names.iter().copied())
}

/// What names of axes are written with in one word, before or after: `ox`, `xgt`, `thodom`.
const AFFIXES: [&str; 11] = ["o", "odo", "odom", "dr", "gt", "true", "cam", "mocap", "vicon", "opti", "gps"];
/// Headings, the longer names first.
const HEADINGS: [&str; 7] = ["heading", "theta", "yaw", "phi", "psi", "rz", "th"];

/// Velocities of a body, along x, along y (with b: in the body's frame) and of its turn.
const BODY_SPEEDS: [&str; 8] = ["vx", "vbx", "vy", "vby", "w", "wb", "wz", "omega"];

/// Words that number wheels, in the order in which `racbot init` numbers them, twice.
const CORNERS: [&str; 8] = ["fl", "fr", "rl", "rr", "fl", "fr", "bl", "br"];

/// Words of what was asked for.
pub(super) const WANTED: [&str; 9] =
    ["goal", "target", "desired", "commanded", "ref", "reference", "setpoint", "demand", "wanted"];
/// Letters that engineers give angles of joints.
pub(super) const ANGLES: [&str; 5] = ["angle", "theta", "phi", "alpha", "q"];

/// A series and what it seems to be.
pub(super) struct Guess<'a> {
    pub(super) series: &'a Series,
    pub(super) column: Column,
    pub(super) unit: &'static str,
}

/// What the series of a log seem to be by their names, and the rest.
pub(super) fn by_names<'a>(
    table: &'a Table,
    from_zero: &[String],
    meant: fn(&Table, &Series) -> Option<String>,
) -> (Vec<Guess<'a>>, Vec<&'a Series>) {
    let mut wheels = Wheels { odometry: is_odometry(table), own: own_pose(table), ..Wheels::default() };
    // What numbers its wheel goes before what leaves it open.
    let numbered = |series: &&Series| numbered(&series.name, from_zero).is_some();
    let (first, then): (Vec<&Series>, Vec<&Series>) = table.series.iter().partition(numbered);
    let (guesses, mut rest) = recognised(first.into_iter().chain(then), |series| match meant(table, series) {
        Some(name) => guess(&Series { name, ..series.clone() }, &mut wheels, from_zero),
        None => guess(series, &mut wheels, from_zero),
    });
    rest.sort_by_key(|series| table.series.iter().position(|other| std::ptr::eq(*series, other)));
    (guesses, rest)
}

/// Names, each with what stands for its number, whose motors are counted from 0: `motor0` beside `motor1`.
pub(super) fn from_zero(table: &Table) -> Vec<String> {
    let stems = |wanted: usize| {
        let of = move |series: &Series| digits(&series.name).filter(|(_, n)| *n == wanted).map(|(stem, _)| stem);
        table.series.iter().filter_map(of)
    };
    let ones: Vec<String> = stems(1).collect();
    stems(0).filter(|stem| ones.contains(stem)).collect()
}

/// The first number within a name, and the name without it.
fn digits(name: &str) -> Option<(String, usize)> {
    let start = name.find(|c: char| c.is_ascii_digit())?;
    let length = name[start..].find(|c: char| !c.is_ascii_digit()).unwrap_or(name.len() - start);
    let number = name[start..start + length].parse().ok()?;
    Some((format!("{}#{}", &name[..start], &name[start + length..]), number))
}

/// The wheel that a name numbers, from 0.
pub(super) fn numbered(name: &str, from_zero: &[String]) -> Option<usize> {
    let counted = digits(name).filter(|(stem, _)| from_zero.contains(stem));
    counted.map(|(_, number)| number).or_else(|| number(&words(&spaced(units::without(name)).to_lowercase())))
}

/// Series of each kind so far, and whether one of them numbered its wheel.
#[derive(Default)]
struct Wheels {
    seen: [(usize, bool); Kind::Supply as usize + 1],
    /// Whether the poses are those of an odometry.
    odometry: bool,
    /// What is before the parts of the robot's own pose, as `/robot/pose.`.
    own: Option<String>,
}

/// Of poses in a bag, each a topic, the one that comes with its velocities is the robot's own: who tracks it sends none.
fn own_pose(table: &Table) -> Option<String> {
    let has = |topic: &str, field: &str| table.series.iter().any(|s| s.name.strip_prefix(topic) == Some(field));
    let topics = || table.series.iter().filter_map(|s| s.name.strip_suffix("x").filter(|topic| topic.ends_with('.')));
    let is_pose = |topic: &&str| has(topic, "y") && has(topic, "theta");
    let moves = |topic: &&str| has(topic, "vx") && has(topic, "w");
    let others = topics().filter(is_pose).any(|topic| !moves(&topic));
    topics().filter(is_pose).find(moves).filter(|_| others).map(str::to_owned)
}

/// Whether a table is of ROS's message of odometry, which has pose and velocity, each with its covariance.
fn is_odometry(table: &Table) -> bool {
    let has = |what: [&str; 2]| table.series.iter().any(|s| words(&s.name).windows(2).any(|pair| pair == what));
    has(["pose", "pose"]) && has(["twist", "twist"])
}

/// The first series that is each column, and the rest.
fn recognised<'a>(
    all: impl Iterator<Item = &'a Series>,
    mut guess: impl FnMut(&Series) -> Option<(Column, &'static str)>,
) -> (Vec<Guess<'a>>, Vec<&'a Series>) {
    let mut guesses: Vec<Guess> = Vec::new();
    let mut rest: Vec<&Series> = Vec::new();
    for series in all {
        let found = guess(series);
        match found.filter(|(column, _)| guesses.iter().all(|g| g.column != *column)) {
            Some((column, unit)) => guesses.push(Guess { series, column, unit }),
            None => rest.push(series),
        }
    }
    heading_of_odometry(&mut guesses);
    heading_of_places(&mut guesses, &mut rest);
    drop_broken_groups(&mut guesses, &mut rest);
    one_unit_in_the_plane(&mut guesses);
    guesses.sort_by_key(|g| g.column);
    (guesses, rest)
}

/// A heading without a place beside an odometry without a heading is the odometry's.
fn heading_of_odometry(guesses: &mut [Guess]) {
    let has = |column: Column| guesses.iter().any(|g| g.column == column);
    let place = |of: fn(usize) -> Column| has(of(0)) && has(of(1));
    if place(Column::Odometry) && !has(Column::Odometry(2)) && !has(Column::Camera(0)) && !has(Column::Camera(1)) {
        guesses.iter_mut().filter(|g| g.column == Column::Camera(2)).for_each(|g| g.column = Column::Odometry(2));
    }
}

/// What stood still in y was nevertheless measured as x was, and of two velocities one unit is often written once.
fn one_unit_in_the_plane(guesses: &mut [Guess]) {
    for group in [Column::Command, Column::Camera, Column::Odometry] {
        let at = |i: usize| guesses.iter().position(|g| g.column == group(i));
        let (Some(x), Some(y)) = (at(0), at(1)) else { continue };
        for (open, known) in [(x, y), (y, x)] {
            if guesses[open].unit.is_empty() && units::in_name(&guesses[open].series.name).is_none() {
                guesses[open].unit = guesses[known].unit;
            }
        }
    }
}

/// The one angle beside places of a camera that has no heading is that.
fn heading_of_places<'a>(guesses: &mut Vec<Guess<'a>>, rest: &mut Vec<&'a Series>) {
    let has = |i: usize| guesses.iter().any(|g| g.column == Column::Camera(i));
    let Some(i) = rest.iter().position(|s| s.name.eq_ignore_ascii_case("angle")) else { return };
    if has(0) && has(1) && !has(2) {
        let (series, column) = (rest.remove(i), Column::Camera(2));
        guesses.push(Guess { series, column, unit: unit(column, series) });
    }
}

/// The pose in a file that has little else, whatever the tracker is called: the first series that are its x, y and
/// heading, and the rest.
pub(super) fn pose(table: &Table) -> (Vec<Guess<'_>>, Vec<&Series>) {
    // A heading that was made of a rotation goes before the parts of that.
    let (made, plain): (Vec<&Series>, Vec<&Series>) = table.series.iter().partition(|s| s.name.ends_with("/yaw"));
    recognised(made.into_iter().chain(plain), |series| {
        let column = Column::Camera(part_of_pose(&series.name)?);
        Some((column, unit(column, series)))
    })
}

/// Keys of a map for the body's velocities, and what they are called.
const VELOCITIES: [(&str, &[&str]); 3] = [
    ("odom_vx", &["v", "vx", "forward velocity", "linear velocity", "forward speed", "linear speed"]),
    ("odom_vy", &["vy", "lateral velocity", "sideways velocity"]),
    ("odom_w", &["w", "wz", "omega", "angular velocity", "rotational velocity", "angular speed", "yaw rate"]),
];

/// Velocities of the body in a log that has nothing else which moves, taken out of the rest: keys of a map, and series.
/// Beside a second file with the pose they are the robot's own odometry.
pub(super) fn velocities<'a>(
    guesses: &mut Vec<Guess<'a>>,
    rest: &mut Vec<&'a Series>,
) -> Vec<(&'static str, &'a Series)> {
    let called = |series: &Series, names: &[&str]| {
        names.contains(&&*words(&units::without(&series.name).to_lowercase()).join(" "))
    };
    // What turns beside what goes forward is no shaft, though its unit is one of shafts.
    let [forward, sideways, turn] = VELOCITIES;
    if rest.iter().any(|series| called(series, forward.1)) {
        let body = |g: &mut Guess| matches!(g.column, Column::Speed(_)) && called(g.series, turn.1);
        rest.extend(guesses.extract_if(.., body).map(|g| g.series));
    }
    let moves =
        |c: Column| matches!(c, Column::Counts(_) | Column::Speed(_) | Column::Odometry(_) | Column::Command(_));
    if guesses.iter().any(|g| moves(g.column)) {
        return Vec::new();
    }
    let of = |(key, names): (&'static str, &[&str])| Some((key, *rest.iter().find(|series| called(series, names))?));
    let found: Vec<(&str, &Series)> = [forward, sideways, turn].into_iter().filter_map(of).collect();
    let has = |key: &str| found.iter().any(|(k, _)| *k == key);
    if !(has("odom_vx") && has("odom_w")) {
        return Vec::new();
    }
    rest.retain(|series| found.iter().all(|(_, s)| s.name != series.name));
    found
}

/// Which of x, y and heading a series of a tracker is.
fn part_of_pose(name: &str) -> Option<usize> {
    let lower = spaced(units::without(name)).to_lowercase();
    let words = words(&lower);
    let has = |some: &[&str]| words.iter().any(|word| some.contains(word));
    // An angle by its unit has no parts.
    let angle = units::in_name(name).is_some_and(|unit| units::is_like(unit, "rad"));
    if angle && matches!(words[..], ["orientation" | "rotation" | "angle" | "bearing"]) {
        return Some(2);
    }
    if has(&HEADINGS) || words.iter().any(|word| word.ends_with("yaw")) {
        return Some(2);
    }
    // Velocities, and parts of a quaternion, are neither.
    if has(&[
        "v",
        "vel",
        "velocity",
        "speed",
        "twist",
        "acc",
        "rate",
        "orientation",
        "rotation",
        "quat",
        "quaternion",
        "rot",
        "ball",
    ]) {
        return None;
    }
    let axes = [["x", "tx", "posx", "pos_x"], ["y", "ty", "posy", "pos_y"]];
    axes.iter().position(|axis| has(axis))
}

/// Groups of three that are not whole are no groups.
fn drop_broken_groups<'a>(guesses: &mut Vec<Guess<'a>>, rest: &mut Vec<&'a Series>) {
    let groups: [fn(usize) -> Column; 5] =
        [Column::Command, Column::Camera, Column::Odometry, Column::Gyro, Column::Acceleration];
    for group in groups {
        let has = |i: usize| guesses.iter().any(|g| g.column == group(i));
        // A sideways command may be missing, see [`super::Map`], and a camera's headings; an odometry's are asked for.
        let whole = match group(0) {
            Column::Command(_) => has(0) && has(2),
            Column::Camera(_) | Column::Odometry(_) => has(0) && has(1),
            _ => has(0) && has(1) && has(2),
        };
        if !whole {
            let (broken, kept): (Vec<_>, Vec<_>) =
                std::mem::take(guesses).into_iter().partition(|g| (0..3).any(|i| g.column == group(i)));
            *guesses = kept;
            rest.extend(broken.into_iter().map(|g| g.series));
        }
    }
}

/// A name with a blank before each capital that follows a small letter: `leftEncoder`, `left Encoder`.
pub(super) fn spaced(name: &str) -> String {
    let mut out = String::new();
    let mut small = false;
    for c in name.chars() {
        if small && c.is_uppercase() {
            out.push(' ');
        }
        out.push(c);
        small = c.is_lowercase();
    }
    out
}

/// The words of a name; of one that is whose axis it is, both.
pub(super) fn words(name: &str) -> Vec<&str> {
    let words = name.split(|c: char| !c.is_alphanumeric()).filter(|w| !w.is_empty());
    words
        .flat_map(|word| glued(word).map_or([word, ""], |(whose, axis)| [whose, axis]))
        .filter(|w| !w.is_empty())
        .collect()
}

/// Which velocity of the body a command without an axis is of, `velocity_command` beside `rotation_command`: one alone is a
/// motor's, and goes with its broken group.
fn commanded(words: &[&str]) -> Option<usize> {
    let ([of, "command" | "cmd"] | ["command" | "cmd", of]) = words else { return None };
    match *of {
        "velocity" | "linear" | "forward" => Some(0),
        "rotation" | "rotational" | "angular" | "turn" => Some(2),
        _ => None,
    }
}

/// Whose axis a word is, and which: `oth` is `o` and `th`, `xgt` is `gt` and `x`.
fn glued(word: &str) -> Option<(&str, &str)> {
    let axes = || ["x", "y"].into_iter().chain(HEADINGS);
    let ahead = || axes().find_map(|axis| Some((word.strip_suffix(axis)?, &word[word.len() - axis.len()..])));
    let after = || axes().find_map(|axis| Some((word.strip_prefix(axis)?, &word[..axis.len()])));
    [ahead(), after()].into_iter().flatten().find(|(whose, _)| AFFIXES.contains(whose))
}

fn guess(series: &Series, wheels: &mut Wheels, from_zero: &[String]) -> Option<(Column, &'static str)> {
    let ours = Column::from_name(&series.name);
    if !matches!(ours, Column::Other | Column::Time) {
        return Some((ours, ""));
    }
    let lower = spaced(units::without(&series.name)).to_lowercase();
    let mut words = words(&lower);
    // The league's vision has an orientation, and a ball that is no robot.
    if words.contains(&"ssl") {
        words.iter_mut().filter(|word| ["o", "orientation"].contains(word)).for_each(|word| *word = "theta");
    }
    let said = units::in_name(&series.name);
    let number = numbered(&series.name, from_zero);
    let axis = axis(&words).or_else(|| commanded(&words));
    // Where a motor should be is no column, and no encoder's.
    let any = |some: &[&str]| words.iter().any(|word| some.contains(word));
    let place = any(&["position", "pos", "counts", "ticks"])
        || any(&ANGLES)
        || said.is_some_and(|unit| units::is_like(unit, "rad"));
    if (any(&WANTED) || any(&["cmd", "command"])) && place && axis.is_none() {
        return None;
    }
    // What a loop is off by was not measured, and a torque that was asked for is no speed.
    let asked_torque = any(&WANTED) && any(&["torque", "tau", "effort", "force"]);
    if axis.is_none() && (any(&["error", "err"]) || asked_torque) {
        return None;
    }
    // Flags and bounds of a current or a duty are none.
    if any(&["over", "limit", "max", "min", "fault", "flag"]) && any(&["current", "duty", "pwm"]) {
        return None;
    }
    if any(&["ball"]) {
        return None;
    }
    // Times, and what a satellite receiver says of its own.
    if axis.is_none() && any(&["time", "timestamp", "gnss", "gps"]) {
        return None;
    }
    let has = |kind: Kind| {
        let known = WORDS.iter().find(|(k, _)| *k == kind).map_or(&[][..], |(_, names)| names);
        // `pwm1` is a `pwm`; `o1` and `dr1` say nothing.
        let bare = |word: &&str| word.len() > 3 && known.contains(&word.trim_end_matches(|c: char| c.is_ascii_digit()));
        known.iter().any(|name| words.contains(name) || name.contains('_') && lower.contains(name))
            || words.iter().any(bare)
    };
    // The height is no heading, and turns about x and y are no ways.
    let upright = ["linear", "position", "translation", "point"];
    let turning = ["angular", "rotation", "orientation"];
    let plane = match words.last() {
        Some(&"z") => !any(&upright),
        Some(&"x" | &"y") => !any(&turning),
        _ => true,
    };
    // What an odometry's message says of its own velocity was not commanded.
    let own_twist = words.windows(2).any(|pair| pair == ["twist", "twist"]);
    // A pose has axes, a wheel has none: `/pose/position/x` is no encoder.
    let mut kinds = WORDS.iter().map(|(kind, _)| *kind).filter(|kind| has(*kind));
    let kind = kinds
        .find(|kind| match kind {
            Kind::Command => axis.is_some() && plane && !own_twist,
            // A set point of a velocity of the body was commanded; of a place it is where it should go.
            Kind::Reference if axis.is_some() => any(&BODY_SPEEDS),
            // A velocity is no place.
            Kind::Camera | Kind::Odometry => axis.is_some() && plane && !own_twist && !any(&BODY_SPEEDS),
            Kind::Gyro | Kind::Acceleration => axis.is_some(),
            Kind::Supply => true,
            _ => axis.is_none(),
        })
        .or_else(|| wordless(&words, axis, series).filter(|_| plane && !own_twist))?;
    let kind = if kind == Kind::Reference && axis.is_some() { Kind::Command } else { kind };
    let rate = any(&["rate", "speed", "velocity", "vel"]);
    let kind = if kind == Kind::Counts && (rate || said.is_some_and(|unit| unit.ends_with("/s") || unit == "rpm")) {
        Kind::Speed
    } else {
        kind
    };
    // A speed that was asked for is no wheel's own.
    let kind = if kind == Kind::Speed && any(&WANTED) { Kind::Reference } else { kind };
    let is_pose = wheels.odometry && words.windows(2).any(|pair| pair == ["pose", "pose"]);
    let is_own = wheels.own.as_ref().is_some_and(|own| series.name.starts_with(own));
    let kind = if kind == Kind::Camera && (is_pose || is_own) { Kind::Odometry } else { kind };
    let (so_far, numbered) = &mut wheels.seen[kind as usize];
    // Beside wheels with numbers one without is the body's. Of several that nobody numbered one is the motor's: a
    // controller has currents of its supply and of both axes.
    let of_a_wheel = !matches!(kind, Kind::Command | Kind::Camera | Kind::Odometry | Kind::Supply) && axis.is_none();
    let one = matches!(kind, Kind::Duty | Kind::Current) && *so_far > 0;
    if of_a_wheel && number.is_none() && (*numbered || one) {
        return None;
    }
    let mut wheel = || {
        let wheel = number.unwrap_or(*so_far);
        *so_far += 1;
        *numbered |= number.is_some();
        wheel
    };
    let column = match (kind, axis) {
        (Kind::Command, Some(i)) => Column::Command(i),
        (Kind::Camera, Some(i)) => Column::Camera(i),
        (Kind::Odometry, Some(i)) => Column::Odometry(i),
        (Kind::Gyro, Some(i)) => Column::Gyro(i),
        (Kind::Acceleration, Some(i)) => Column::Acceleration(i),
        (Kind::Supply, _) => Column::Supply,
        (Kind::Counts, _) => Column::Counts(wheel()),
        (Kind::Reference, _) => Column::Reference(wheel()),
        (Kind::Speed, _) => Column::Speed(wheel()),
        (Kind::Duty, _) => Column::Duty(wheel()),
        (Kind::Current, _) => Column::Current(wheel()),
        _ => return None,
    };
    Some((column, unit(column, series)))
}

/// The unit that its name says, or its range; none where it is ours.
fn unit(column: Column, series: &Series) -> &'static str {
    let lower = spaced(&series.name).to_lowercase();
    if matches!(column, Column::Camera(0 | 1)) && words(&lower).iter().any(|w| ["px", "pixel", "pixels"].contains(w)) {
        return PIXELS;
    }
    let said = units::in_name(&series.name).filter(|unit| *unit != column.unit() && fits(column, unit));
    said.unwrap_or_else(|| by_range(column, series))
}

/// Whether a column can have a unit: `current_in` is in no inches.
fn fits(column: Column, unit: &str) -> bool {
    let kinds: &[&str] = match column {
        Column::Counts(_) => &["counts", "rad", "m"],
        Column::Duty(_) => &["V", "1"],
        Column::Speed(_) | Column::Reference(_) | Column::Measured(_) | Column::Gyro(_) => &["rad/s", "m/s"],
        Column::Command(_) => &["m/s", "rad/s"],
        Column::Camera(0 | 1) | Column::Odometry(0 | 1) => &["m"],
        Column::Camera(_) | Column::Odometry(_) => &["rad"],
        Column::Current(_) => &["A"],
        Column::Supply => &["V"],
        Column::Acceleration(_) => &["m/s2"],
        Column::Time | Column::ImuTemperature | Column::Other => &[],
    };
    kinds.iter().any(|ours| units::is_like(unit, ours))
}

/// Series without a telling word: bare corners of a robot are its encoders, bare x, y and yaw the camera's.
fn wordless(words: &[&str], axis: Option<usize>, series: &Series) -> Option<Kind> {
    let [low, high] = series.range();
    let whole = series.values.iter().all(|x| x.fract() == 0.0);
    // What is a share or a force by its unit was not counted.
    let counted = units::in_name(&series.name).is_none_or(|unit| fits(Column::Counts(0), unit));
    let share = low < high && low >= -MOST_DUTY && high <= MOST_DUTY;
    let has = |some: &[&str]| words.iter().any(|w| some.contains(w));
    let wheel = has(&CORNERS) || has(&["left", "right", "motor", "wheel", "joint"]);
    // `motor1_speed` is a motor's; of a bare `motor1` nobody knows what.
    let of_one =
        wheel || words.len() > 1 && ["motor", "wheel"].iter().any(|name| words.iter().any(|w| numbers(w, name)));
    match words {
        // A velocity is no place.
        [_] | [_, "position" | "pos"] | ["position" | "pos", _] if axis.is_some() && !has(&BODY_SPEEDS) => {
            Some(Kind::Camera)
        }
        // A share that reaches all of it drives; a speed or a way does not end there.
        [_] if has(&CORNERS) && share && !whole && low.abs().max(high.abs()) > 0.99 => Some(Kind::Duty),
        // A body has a velocity, too, but turns no revolutions a minute.
        _ if words.contains(&"rpm") => Some(Kind::Speed),
        _ if words.contains(&"velocity") || words.contains(&"speed") => {
            let of_shafts = ["rad/s", "rev/s", "rpm", "counts/s"];
            let turns = units::in_name(&series.name).is_some_and(|unit| of_shafts.contains(&unit));
            (of_one || turns && axis.is_none()).then_some(Kind::Speed)
        }
        // A motor on the left has no supply of its own.
        _ if has(&["voltage", "volts", "volt"]) => {
            let of_a_motor = has(&["left", "right"]) || has(&CORNERS);
            volts(series).map(|kind| if of_a_motor { Kind::Duty } else { kind })
        }
        // What turns by its unit is a shaft, where it is no body.
        _ if units::in_name(&series.name).is_some_and(|unit| units::is_like(unit, "rad/s")) => {
            (axis.is_none() && !has(&["gyro", "imu", "body", "robot", "base", "rate"])).then_some(Kind::Speed)
        }
        // A share that a motor was told; in no other unit is that known.
        _ if has(&["command", "cmd", "power", "output", "throttle"]) => (of_one && share).then_some(Kind::Duty),
        // Control engineers call the speed of a wheel w, and what they put into a motor u.
        _ if wheel && has(&["w", "omega"]) => Some(Kind::Speed),
        _ if wheel && has(&["u"]) => share.then_some(Kind::Duty),
        _ if has(&[
            "mode", "state", "error", "status", "pid", "load", "temp", "effort", "torque", "tau", "force", "id",
        ]) =>
        {
            None
        }
        _ if units::in_name(&series.name) == Some("A") && axis.is_none() => Some(Kind::Current),
        [word] if ["w", "omega"].iter().any(|name| numbers(word, name)) => Some(Kind::Speed),
        [word] if *word == "u" || numbers(word, "u") => share.then_some(Kind::Duty),
        _ => (wheel && whole && counted && axis.is_none()).then_some(Kind::Counts),
    }
}

/// Whether a word is a name with a number after it: `w1`.
fn numbers(word: &str, name: &str) -> bool {
    word.strip_prefix(name).is_some_and(|rest| !rest.is_empty() && rest.bytes().all(|b| b.is_ascii_digit()))
}

/// Whose volts they are: a supply neither stands at 0 nor turns round, and at half of its voltage a battery is empty. What
/// below a millivolt throughout was not measured.
fn volts(series: &Series) -> Option<Kind> {
    let [low, high] = series.range();
    if low.abs().max(high.abs()) < 1e-3 {
        return None;
    }
    Some(if low > 0.5 * high { Kind::Supply } else { Kind::Duty })
}

/// The wheel that a name numbers, from 0; of two wheels the right one is first, as `racbot init --track-mm` has them.
fn number(words: &[&str]) -> Option<usize> {
    let has = |word: &str| words.contains(&word);
    // `Velocity [r/s] left` is not of the right one.
    let spelled = has("right") || has("left");
    let [right, left] = [("right", "r"), ("left", "l")].map(|(word, letter)| has(word) || !spelled && has(letter));
    match (right, left, has("front"), has("rear") || has("back")) {
        (right, left, front, rear) if right != left && front != rear => {
            return Some(usize::from(right) + 2 * usize::from(rear));
        }
        (right, left, false, false) if right != left => return Some(usize::from(left)),
        _ => {}
    }
    let corner = |word: &&str| CORNERS.iter().position(|corner| corner == word).map(|i| i % 4);
    let digits = |word: &&str| {
        let ordinal = word.starts_with(|c: char| c.is_ascii_digit())
            && ["st", "nd", "rd", "th"].iter().any(|end| word.ends_with(end));
        let word = if ordinal { &word[..word.len() - 2] } else { word };
        let number = word.trim_start_matches(|c: char| c.is_ascii_alphabetic());
        number.parse::<usize>().ok().filter(|n| (1..=8).contains(n)).map(|n| n - 1)
    };
    words.iter().find_map(corner).or_else(|| words.iter().find_map(digits))
}

/// Which of x, y, heading (or z) a name means.
fn axis(words: &[&str]) -> Option<usize> {
    let last = words.iter().rev();
    let named = |word: &&str| match *word {
        "x" | "vx" | "vbx" => Some(0),
        "y" | "vy" | "vby" => Some(1),
        "z" | "w" | "wb" | "wz" | "omega" => Some(2),
        word => HEADINGS.contains(&word).then_some(2),
    };
    // Of a quaternion its heading alone.
    let quaternion = words.contains(&"orientation") && !words.contains(&"yaw");
    last.clone().find_map(named).filter(|_| !quaternion)
}

/// Whether lengths in metres would be the way of a robot: at all but a twentieth of its moments slower than 10 m/s, and no
/// creep of 2 cm/s, at which a field of 50 m were not crossed within an hour.
fn drives_in_metres(series: &Series) -> bool {
    let unit_s = time_unit_s(&series.t);
    let between = series.t.windows(2).zip(series.values.windows(2));
    let mut speeds: Vec<f64> =
        between.filter(|(t, _)| t[1] > t[0]).map(|(t, x)| (x[1] - x[0]).abs() / ((t[1] - t[0]) * unit_s)).collect();
    speeds.sort_by(f64::total_cmp);
    speeds.get(speeds.len() * 19 / 20).is_some_and(|fast| (0.02..10.0).contains(fast))
}

/// Seconds in the unit of times, by their steps.
fn time_unit_s(t: &[f64]) -> f64 {
    units::of_time(time_unit(t, 1.0)).unwrap_or(1.0)
}

/// Whether a series is by its name what came since the row before.
pub(super) fn is_step(series: &Series) -> bool {
    let lower = spaced(units::without(&series.name)).to_lowercase();
    words(&lower).iter().any(|w| ["delta", "diff", "increment", "increments", "dticks", "dcounts", "dtick"].contains(w))
}

/// Whether a speed is by its name that of a motor, which a gear may part from the wheel: `M1 rpm`.
pub(super) fn is_of_a_motor(series: &Series) -> bool {
    let lower = spaced(units::without(&series.name)).to_lowercase();
    words(&lower).iter().any(|word| *word == "motor" || numbers(word, "motor") || numbers(word, "m"))
}

/// Whether a guess is of wheels or of an odometry.
pub(super) fn moves(guess: &Guess) -> bool {
    matches!(guess.column, Column::Counts(_) | Column::Speed(_) | Column::Odometry(_))
}

/// Beside a file with the pose the steps of a robot's own odometry, way and turn, of a log that has nothing else which moves.
pub(super) fn steps<'a>(guesses: &mut Vec<Guess<'a>>, rest: &mut Vec<&'a Series>) {
    // Of x, y and heading each has been recognised.
    if guesses.iter().any(moves) {
        return;
    }
    let step = |names: &[&str]| {
        let named = |s: &&&Series| {
            let lower = spaced(units::without(&s.name)).to_lowercase();
            words(&lower).iter().any(|word| names.contains(word))
        };
        rest.iter().copied().filter(|s| is_step(s)).find(|s| named(&s))
    };
    let (way, turn) = (step(&["dist", "distance", "way", "travel", "translation"]), step(&HEADINGS));
    let (Some(way), Some(turn)) = (way, turn) else { return };
    for (series, i) in [(way, 0), (turn, 2)] {
        let column = Column::Odometry(i);
        let said = unit(column, series);
        guesses.push(Guess { series, column, unit: said });
        rest.retain(|other| !std::ptr::eq(*other, series));
    }
    guesses.sort_by_key(|g| g.column);
}

/// What a series may be that was not recognised, for its owner to decide, in a remark after it.
pub(super) fn maybe(series: &Series, rest: &[&Series]) -> String {
    let lower = spaced(units::without(&series.name)).to_lowercase();
    let words = words(&lower);
    let beside = |name: &str| rest.iter().any(|s| s.name.eq_ignore_ascii_case(name));
    let [low, high] = series.range();
    let most = low.abs().max(high.abs());
    let from = super::quoted(&series.name);
    let wheel = number(&words).map_or(1, |wheel| wheel + 1);
    match words[..] {
        _ if words.contains(&"u") && most > MOST_DUTY => {
            format!("; what drives it? duty_{wheel} = {{ from = {from}, scale = ... }}, 1 / the most that it can be")
        }
        // What a recorder calls its channels, without a unit.
        ["input" | "in"] if units::in_name(&series.name).is_none() && most > MOST_DUTY => {
            format!(
                "; what drives it? duty_1 = {{ from = {from}, scale = ... }}, 1 / the most that it can be, as of volts"
            )
        }
        ["speed" | "velocity" | "velo" | "vel" | "omega"] if units::in_name(&series.name).is_none() => {
            format!("; of a shaft? speed_1 = {from}, in rad/s, else {{ from = {from}, unit = \"rpm\" }}")
        }
        ["torque" | "tau" | "moment"] => {
            format!("; Nm of a drive? current_1 = {from}, beside torque_constant = 1 and its gear_ratio")
        }
        ["y"] if beside("u") => format!(
            "; what it measures? speed_1 = {{ from = {from}, unit = \"deg/s\" }}, or an angle: enc_1 = {{ from = {from}, unit = \
             \"deg\", counts_per_rev = 65536 }}"
        ),
        ["r"] if beside("u") => format!("; set points? ref_1 = {{ from = {from}, unit = ... }}, of a speed"),
        _ if most > MOST_DUTY
            && units::in_name(&series.name).is_none()
            && words.iter().any(|w| ["command", "cmd", "output", "power", "throttle"].contains(w)) =>
        {
            let full = full_duty(most);
            format!(
                "; steps of a PWM? duty_{wheel} with scale = {:.6}, 1 / {full}; a set point? ref_{wheel}",
                1.0 / full
            )
        }
        _ => String::new(),
    }
}

/// What is measured in an image; how many metres that is only its owner knows.
pub(super) const PIXELS: &str = "px";

/// The unit of a duty in steps of its PWM.
pub(super) const STEPS: &str = "steps";

/// The full duty of a PWM in steps: of the usual ones the next that holds the most in the file.
pub(super) fn full_duty(most: f64) -> f64 {
    let usual = [255.0, 400.0, 500.0, 1000.0, 1023.0, 1024.0, 2047.0, 4095.0, 8191.0, 16383.0, 32767.0, 65535.0];
    usual.into_iter().find(|full| *full >= most).unwrap_or(most)
}

/// The unit that a range gives away: few fields are 50 m long, no heading goes beyond a few turns in a radian.
fn by_range(column: Column, series: &Series) -> &'static str {
    let [low, high] = series.range();
    let most = low.abs().max(high.abs());
    match column {
        Column::Camera(0 | 1) if most > 50.0 && !drives_in_metres(series) => "mm",
        Column::Camera(2) if most > 30.0 => "deg",
        Column::Duty(_) if spaced(&series.name).to_lowercase().contains("volt") => "V",
        Column::Speed(_) if words(&spaced(&series.name).to_lowercase()).contains(&"rpm") => "rpm",
        Column::Duty(_) if most > MOST_DUTY && most <= 100.0 => "percent",
        Column::Duty(_) if most > 100.0 => STEPS,
        Column::Supply if most > 1000.0 => "mV",
        Column::Counts(_) if series.values.iter().filter(|x| x.fract() != 0.0).count() * 2 > series.values.len() => {
            "rad"
        }
        _ => "",
    }
}
