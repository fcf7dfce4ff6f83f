//! A first map for a file, guessed from the names and ranges of its series, for its owner to correct.

use std::fmt::Write as _;

use super::{Series, Table, units};
use crate::columns::Column;

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
    (Kind::Reference, &["ref", "reference", "setpoint", "target", "set"]),
    (Kind::Counts, &["enc", "encoder", "tick", "ticks", "counts", "count", "position", "pos"]),
    (Kind::Odometry, &["odom", "odometry"]),
    (Kind::Camera, &["cam", "camera", "vision", "mocap", "optitrack", "vicon", "tracker", "pose", "blue", "yellow"]),
];

/// Words that number wheels, in the order in which `racbot init` numbers them.
const CORNERS: [&str; 4] = ["fl", "fr", "rl", "rr"];

/// A series and what it seems to be.
struct Guess<'a> {
    series: &'a Series,
    column: Column,
    unit: &'static str,
}

/// The text of a map for a file: columns that were recognised by their names, and the rest as comments with their ranges.
pub fn draft(table: &Table) -> String {
    let mut guesses: Vec<Guess> = Vec::new();
    let mut rest: Vec<&Series> = Vec::new();
    let mut wheels = [0; Kind::Supply as usize + 1];
    for series in &table.series {
        let found = guess(series, &mut wheels);
        match found.filter(|(column, _)| guesses.iter().all(|g| g.column != *column)) {
            Some((column, unit)) => guesses.push(Guess { series, column, unit }),
            None => rest.push(series),
        }
    }
    drop_broken_groups(&mut guesses, &mut rest);
    guesses.sort_by_key(|g| g.column);
    let mut out = String::from("# Guessed from names and ranges: check every line.\n");
    if let Some((name, unit)) = &table.time {
        let _ = writeln!(out, "\n[time]\ncolumn = {}\nunit = \"{}\"", quoted(name), time_unit(table, *unit));
    } else if table.series.iter().all(|s| s.t.iter().zip(0..).all(|(t, row)| *t == f64::from(row))) {
        match increasing(table) {
            Some(s) => {
                let rows = Series { t: s.values.clone(), ..Series::default() };
                let unit = time_unit(&Table { series: vec![rows], ..Table::default() }, 1.0);
                let _ = writeln!(
                    out,
                    "\n[time]\ncolumn = {} # is it? it increases from row to row\nunit = \"{unit}\"",
                    quoted(&s.name)
                );
            }
            None => out.push_str(
                "\n[time]\ncolumn = \"?\" # which column is the time? Where there is none: rate_hz = 100, rows a second\n",
            ),
        }
    }
    out.push_str(
        "\n[frame]\nx = \"forward\" # where x of the robot points: forward (ROS, the league) or right (ours)\n",
    );
    out.push_str("\n[columns]\n");
    for Guess { series, column, unit } in &guesses {
        let angle = matches!(column, Column::Counts(_)) && !unit.is_empty();
        let value = match *unit {
            "" => quoted(&series.name),
            unit if angle => format!(
                "{{ from = {}, unit = \"{unit}\", counts_per_rev = 65536 }} # what the encoder counts a turn",
                quoted(&series.name)
            ),
            unit => format!("{{ from = {}, unit = \"{unit}\" }}", quoted(&series.name)),
        };
        let _ = writeln!(out, "{} = {value}", column.name());
    }
    if guesses.is_empty() {
        out.push_str("# enc_1 = \"...\"\n");
    }
    if !rest.is_empty() {
        out.push_str("\n# Not used:\n");
    }
    for series in rest {
        let [low, high] = series.range();
        let _ = writeln!(out, "# {}, {low} to {high}", quoted(&series.name));
    }
    out
}

/// A TOML string on one line.
fn quoted(name: &str) -> String {
    let plain: String = name.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    format!("\"{}\"", plain.replace('\\', "\\\\").replace('"', "\\\""))
}

/// The unit of time, by its steps where its name says none: nobody logs a robot once a second.
fn time_unit(table: &Table, unit_s: f64) -> &'static str {
    let steps = |s: &Series| s.t.windows(2).map(|pair| pair[1] - pair[0]).filter(|step| *step > 0.0).collect();
    let mut steps: Vec<f64> = table.series.iter().max_by_key(|s| s.t.len()).map(steps).unwrap_or_default();
    steps.sort_by(f64::total_cmp);
    match steps.get(steps.len() / 2) {
        Some(1e6..) if unit_s == 1.0 => "ns",
        Some(1e3..) if unit_s == 1.0 => "us",
        Some(1.0..) if unit_s == 1.0 => "ms",
        _ => unit_name(unit_s),
    }
}

fn unit_name(unit_s: f64) -> &'static str {
    ["ms", "us", "ns"].into_iter().find(|unit| units::factor(unit) == Some(unit_s)).unwrap_or("s")
}

/// Groups of three that are not whole are no groups.
fn drop_broken_groups<'a>(guesses: &mut Vec<Guess<'a>>, rest: &mut Vec<&'a Series>) {
    let groups: [fn(usize) -> Column; 5] =
        [Column::Command, Column::Camera, Column::Odometry, Column::Gyro, Column::Acceleration];
    for group in groups {
        let has = |i: usize| guesses.iter().any(|g| g.column == group(i));
        // A sideways command may be missing, see [`super::Map`].
        let whole = has(0) && has(2) && (has(1) || group(0) == Column::Command(0));
        if !whole {
            let (broken, kept): (Vec<_>, Vec<_>) =
                std::mem::take(guesses).into_iter().partition(|g| (0..3).any(|i| g.column == group(i)));
            *guesses = kept;
            rest.extend(broken.into_iter().map(|g| g.series));
        }
    }
}

/// A name with a blank before each capital that follows a small letter: `leftEncoder`, `left Encoder`.
fn spaced(name: &str) -> String {
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

/// A column that increases from row to row, not by ones, as time does; another recording may follow.
fn increasing(table: &Table) -> Option<&Series> {
    table.series.iter().find(|s| {
        let steps = s.values.windows(2).filter(|w| w[1] > w[0] && w[1] != w[0] + 1.0).count();
        s.values.len() > 2 && 100 * steps >= 95 * (s.values.len() - 1)
    })
}

fn guess(series: &Series, wheels: &mut [usize]) -> Option<(Column, &'static str)> {
    let ours = Column::from_name(&series.name);
    if !matches!(ours, Column::Other | Column::Time) {
        return Some((ours, ""));
    }
    let lower = spaced(&series.name).to_lowercase();
    let words: Vec<&str> = lower.split(|c: char| !c.is_alphanumeric()).filter(|w| !w.is_empty()).collect();
    let said = units::in_name(&series.name);
    let number = number(&words);
    let axis = axis(&words);
    let has = |kind: Kind| {
        let known = WORDS.iter().find(|(k, _)| *k == kind).map_or(&[][..], |(_, names)| names);
        known.iter().any(|name| words.contains(name) || name.contains('_') && lower.contains(name))
    };
    // A pose has axes, a wheel has none: `/pose/position/x` is no encoder.
    let mut kinds = WORDS.iter().map(|(kind, _)| *kind).filter(|kind| has(*kind));
    let kind = kinds
        .find(|kind| match kind {
            Kind::Command | Kind::Camera | Kind::Odometry | Kind::Gyro | Kind::Acceleration => axis.is_some(),
            Kind::Supply => true,
            _ => axis.is_none(),
        })
        .or_else(|| wordless(&words, axis, series))?;
    let kind = if kind == Kind::Counts && said.is_some_and(|unit| unit.ends_with("/s") || unit == "rpm") {
        Kind::Speed
    } else {
        kind
    };
    let mut wheel = || {
        let next = &mut wheels[kind as usize];
        let wheel = number.unwrap_or(*next);
        *next += 1;
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
    let plain = said.filter(|unit| *unit != column.unit()).unwrap_or("");
    Some((column, if plain.is_empty() { by_range(column, series) } else { plain }))
}

/// Series without a telling word: bare corners of a robot are its encoders, bare x, y and yaw the camera's.
fn wordless(words: &[&str], axis: Option<usize>, series: &Series) -> Option<Kind> {
    let whole = series.values.iter().all(|x| x.fract() == 0.0);
    let wheel = words.iter().any(|w| CORNERS.contains(w) || ["left", "right", "motor", "wheel", "joint"].contains(w));
    match words {
        [_] if axis.is_some() => Some(Kind::Camera),
        _ if words.contains(&"velocity") || words.contains(&"speed") || words.contains(&"rpm") => {
            wheel.then_some(Kind::Speed)
        }
        // What somebody told a motor, or its mode, is no encoder's.
        _ if words
            .iter()
            .any(|w| ["command", "cmd", "mode", "state", "error", "status", "pid", "load", "temp"].contains(w)) =>
        {
            None
        }
        _ => (wheel && whole && axis.is_none()).then_some(Kind::Counts),
    }
}

/// The wheel that a name numbers, from 0; of two wheels the right one is first, as `racbot init --track-mm` has them.
fn number(words: &[&str]) -> Option<usize> {
    let has = |word: &str| words.contains(&word);
    match (has("right") || has("r"), has("left") || has("l"), has("front"), has("rear") || has("back")) {
        (right, left, front, rear) if right != left && front != rear => {
            return Some(usize::from(right) + 2 * usize::from(rear));
        }
        (right, left, false, false) if right != left => return Some(usize::from(left)),
        _ => {}
    }
    let corner = |word: &&str| CORNERS.iter().position(|corner| corner == word);
    let digits = |word: &&str| {
        let number = word.trim_start_matches(|c: char| c.is_ascii_alphabetic());
        number.parse::<usize>().ok().filter(|n| (1..=8).contains(n)).map(|n| n - 1)
    };
    words.iter().find_map(corner).or_else(|| words.iter().find_map(digits))
}

/// Which of x, y, heading (or z) a name means.
fn axis(words: &[&str]) -> Option<usize> {
    let last = words.iter().rev();
    let named = |word: &&str| match *word {
        "x" | "vx" => Some(0),
        "y" | "vy" => Some(1),
        "z" | "w" | "theta" | "yaw" | "phi" | "heading" | "omega" => Some(2),
        _ => None,
    };
    // Of a quaternion its heading alone.
    let quaternion = words.contains(&"orientation") && !words.contains(&"yaw");
    last.clone().find_map(named).filter(|_| !quaternion)
}

/// The unit that a range gives away: no field is 50 m long, no heading beyond a few turns in a radian.
fn by_range(column: Column, series: &Series) -> &'static str {
    let [low, high] = series.range();
    let most = low.abs().max(high.abs());
    match column {
        Column::Camera(0 | 1) if most > 50.0 => "mm",
        Column::Camera(2) if most > 30.0 => "deg",
        Column::Duty(_) if most > 1.001 && most <= 100.0 => "percent",
        Column::Counts(_) if series.values.iter().filter(|x| x.fract() != 0.0).count() * 2 > series.values.len() => {
            "rad"
        }
        _ => "",
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::super::{Clock, Map};
    use super::*;

    fn drafted(header: &str, rows: [&str; 3]) -> String {
        let text = format!("{header}\n{}\n", rows.join("\n"));
        let table =
            Table::of_bytes(text.as_bytes(), Path::new("x.csv"), None, &Clock { rows: true, ..Clock::default() })
                .unwrap();
        let map = draft(&table);
        let parsed = Map::parse(&map, Path::new("map.toml")).unwrap_or_else(|e| panic!("{e}\n{map}"));
        if table.time.is_some() {
            parsed.run(&table, Path::new("x.csv")).unwrap_or_else(|e| panic!("{e}\n{map}"));
        }
        map
    }

    #[test]
    fn names_of_five_robots_are_understood() {
        let omni = drafted(
            "Zeit [ms];Motor 1 (ticks);Motor 2 (ticks);vx soll [mm/s];vy soll [mm/s];omega soll [deg/s];vision x;vision y;vision phi",
            [
                "5;0;0;0,0;0,0;0,00;301,4;-202,1;28,41",
                "10;1;2;13,3;0,0;1,43;;;",
                "15;2;4;13,3;0,0;1,43;301,4;-202,1;99,5",
            ],
        );
        for line in [
            "column = \"Zeit [ms]\"\nunit = \"ms\"",
            "enc_2 = \"Motor 2 (ticks)\"",
            "cmd_w = { from = \"omega soll [deg/s]\", unit = \"deg/s\" }",
            "cam_x = { from = \"vision x\", unit = \"mm\" }",
            "cam_theta = { from = \"vision phi\", unit = \"deg\" }",
        ] {
            assert!(omni.contains(line), "{line}\n{omni}");
        }
        let two = drafted(
            "timestamp,/cmd_vel/linear/x,/cmd_vel/angular/z,/left_wheel/ticks,/right_wheel/ticks,/mocap/pose/x,/mocap/pose/y,/mocap/pose/yaw",
            ["1.0,0.1,0.2,1,2,0.5,0.6,1.0", "1.1,0.1,0.2,3,4,,,", "1.2,0.1,0.2,5,6,0.5,0.6,1.0"],
        );
        for line in ["cmd_vx = \"/cmd_vel/linear/x\"", "cmd_w = ", "enc_2 = \"/left_wheel/ticks\"", "cam_theta = "] {
            assert!(two.contains(line), "{line}\n{two}");
        }
        let mecanum = drafted("t,fl,fr,rl,rr,x,y,yaw", ["0,0,1,2,3,0.1,0.2,0.3", "1,0,1,2,3,,,", "2,0,1,2,3,1,2,3"]);
        assert!(mecanum.contains("enc_3 = \"rl\"") && mecanum.contains("cam_theta = \"yaw\""), "{mecanum}");
        let servo = drafted(
            "time_us,pos_counts,ref_rpm,pwm_percent,vbus",
            ["0,0,60,50,24", "1000,7,60,40,24", "2000,9,60,-30,24"],
        );
        for line in ["unit = \"us\"", "enc_1 = ", "ref_1 = { from = \"ref_rpm\", unit = \"rpm\" }", "supply_v = "] {
            assert!(servo.contains(line), "{line}\n{servo}");
        }
        let joints = drafted(
            "__time,/joint_states/right_wheel/position,/joint_states/right_wheel/velocity,/pose/position/x,/pose/position/y,/pose/orientation/x,/pose/orientation/y,/pose/orientation/z,/pose/orientation/w,mode",
            ["0,0.25,1,1,2,0,0,0.6,0.8,7", "1,0.5,1,1,2,0,0,0.6,0.8,7", "2,1.75,1,1,2,0,0,0.6,0.8,7"],
        );
        for line in [
            "enc_1 = { from = \"/joint_states/right_wheel/position\", unit = \"rad\", counts_per_rev",
            "speed_1 = ",
            "cam_theta = \"/pose/orientation/yaw\"",
            "# \"mode\", 7 to 7",
        ] {
            assert!(joints.contains(line), "{line}\n{joints}");
        }
    }

    #[test]
    fn a_table_of_blanks_in_milliseconds_is_understood() {
        let rows = [
            "  1128   16.04  -30.36  1.58  -3   1",
            "  1199   16.05  -30.38  1.58  -3   1",
            "  1327   16.01  -30.38  1.58  -3   7",
        ];
        let map = drafted("n_time  pose_x  pose_y  pose_theta  tick_L  tick_R", rows);
        for line in
            ["column = \"n_time\"\nunit = \"ms\"", "enc_1 = \"tick_R\"", "enc_2 = \"tick_L\"", "cam_y = \"pose_y\""]
        {
            assert!(map.contains(line), "{line}\n{map}");
        }
        let bare = "0.00 1 2\n0.01 2 3\n0.02 3 4\n";
        let clock = Clock { column: Some("column_1"), ..Clock::default() };
        let table = Table::of_bytes(bare.as_bytes(), Path::new("x.dat"), None, &clock).unwrap();
        assert_eq!(table.find("column_3").unwrap().values, [2.0, 3.0, 4.0]);
    }

    #[test]
    fn words_run_together_and_times_without_a_name_are_understood() {
        let mouse = drafted(
            "time, targetSpeed, leftEncoder, leftCommand, rightEncoder",
            ["0,1,2,3,4", "2,1,3,3,5", "4,1,4,3,6"],
        );
        for line in
            ["ref_1 = \"targetSpeed\"", "enc_2 = \"leftEncoder\"", "enc_1 = \"rightEncoder\"", "# \"leftCommand\""]
        {
            assert!(mouse.contains(line), "{line}\n{mouse}");
        }
        let bare = drafted(
            "100; 0.0069; 0; -67305",
            ["100; 0.0129; 2; -67304", "100; 0.0191; 6; -67304", "100; 0.0248; 6; -67304"],
        );
        assert!(bare.contains("column = \"column_2\" # is it?"), "{bare}");
    }

    #[test]
    fn a_file_without_a_time_column_asks_for_it() {
        let map = drafted("a,b\"c", ["1,2", "2,3", "3,4"]);
        assert!(
            map.contains("which column is the time?")
                && map.contains("rate_hz")
                && map.contains("# \"b\\\"c\", 2 to 4"),
            "{map}"
        );
    }
}
