//! A first map for a file, guessed from the names and ranges of its series, for its owner to correct.

mod bench;
mod guess;
mod present;

use std::fmt::Write as _;
use std::path::Path;

use self::bench::guesses;
use self::guess::{Guess, pose};
use super::fill::register;
use super::time::usual_step;
use super::{Series, Table, truth, units};
use crate::columns::Column;

/// The text of a map for a file: columns that were recognised by their names, and the rest as comments with their ranges.
pub fn draft(table: &Table) -> String {
    let (guesses, rest) = guesses(table);
    log(table, &guesses, &[], &rest)
}

/// The same for a log and a second file with the pose, each with its path.
pub fn draft_two([table, poses]: [(&Table, &Path); 2]) -> String {
    let (mut guesses, mut rest) = guesses(table.0);
    let (seen, other) = pose(poses.0);
    if !seen.is_empty() {
        let camera = |g: &mut Guess| matches!(g.column, Column::Camera(_));
        rest.extend(guesses.extract_if(.., camera).map(|g| g.series));
        reckoned(table.0, &mut guesses, &mut rest);
        guess::steps(&mut guesses, &mut rest);
    }
    let own = guess::velocities(&mut guesses, &mut rest);
    let mut out = log(table.0, &guesses, &own, &rest);
    let file = quoted(&truth::pattern(table.1, poses.1));
    let _ = writeln!(
        out,
        "\n[truth] # the pose\nfile = {file} # from the log's folder; {{stem}} is the log's name, {{number}} its number\n\
         clock = \"{}\" # same: one clock; own: both files begin together; match: found by the motion",
        clock([table.0, poses.0])
    );
    let (time, timed) = time(poses.0, "truth.time");
    out += &time;
    out.push_str("\n[truth.columns]\n");
    out += &columns(&seen, "# cam_x = \"...\"\n# cam_y = \"...\"\n# cam_theta = \"...\"\n");
    out + &unused(&other, timed.as_deref())
}

/// Beside a file with the pose, the poses of a log without wheels are the robot's own odometry.
fn reckoned<'a>(table: &'a Table, guesses: &mut Vec<Guess<'a>>, rest: &mut Vec<&'a Series>) {
    if guesses.iter().any(guess::moves) {
        return;
    }
    let (own, _) = pose(table);
    rest.retain(|series| own.iter().all(|g| g.series.name != series.name));
    guesses.retain(|guess| own.iter().all(|g| g.series.name != guess.series.name));
    let odometry = |g: Guess<'a>| match g.column {
        Column::Camera(i) => Guess { column: Column::Odometry(i), ..g },
        _ => g,
    };
    guesses.extend(own.into_iter().map(odometry));
    guesses.sort_by_key(|g| g.column);
}

/// How two clocks seem to stand: the same where their times lie over each other, and not just because both count from 0.
fn clock(tables: [&Table; 2]) -> &'static str {
    let [Some(a), Some(b)] = tables.map(ends) else { return "match" };
    let shorter = (a[1] - a[0]).min(b[1] - b[0]);
    let shared = a[1].min(b[1]) - a[0].max(b[0]);
    let from_zero = a[0].abs().max(b[0].abs()) < 0.1 * shorter;
    if shared > 0.5 * shorter && !from_zero { "same" } else { "match" }
}

/// First and last time of a file, s; of one whose times have no name, those that its map takes.
fn ends(table: &Table) -> Option<[f64; 2]> {
    if table.time.is_some() || !rows_are_numbered(table) {
        return Some(table.times());
    }
    let guessed = increasing(table)?;
    let unit_s = units::of_time(time_unit(&guessed.values, 1.0))?;
    Some(guessed.range().map(|t| t * unit_s))
}

fn log(table: &Table, guesses: &[Guess], own: &[(&str, &Series)], rest: &[&Series]) -> String {
    let mut out = String::from("# Guessed from names and ranges: check every line.\n");
    for remark in &table.remarks {
        let _ = writeln!(out, "# Note: {remark}.");
    }
    let (time, timed) = time(table, "time");
    out += &time;
    if let Some(of) = &table.of {
        let _ = writeln!(out, "rows_of = {} # says whose each row is", quoted(of));
    }
    out.push_str(
        "\n[frame]\nx = \"forward\" # where x of the robot points: forward (ROS, the league) or right (ours)\n",
    );
    out.push_str("\n[columns]\n");
    out += &columns(guesses, if own.is_empty() { "# enc_1 = \"...\"\n" } else { "" });
    for (name, series) in own {
        let _ = writeln!(
            out,
            "{name} = {} # as the robot's odometry has it? Commanded: cmd_{}",
            quoted(&series.name),
            &name[5..]
        );
    }
    out + &unused(rest, timed.as_deref())
}

/// Whether rows stand in for times: there is no time.
fn rows_are_numbered(table: &Table) -> bool {
    table.series.iter().all(|s| s.t.iter().all(|t| t.fract() == 0.0))
}

/// The `[time]` table of a map for `table`, and the series that it takes for the time.
fn time(table: &Table, name: &str) -> (String, Option<String>) {
    if let Some((column, unit)) = &table.time {
        let longest = table.series.iter().max_by_key(|s| s.t.len()).map_or(&[][..], |s| &s.t);
        // A unit that the name says is not guessed, however far apart the rows are.
        let said = units::in_name(column).and_then(units::of_time).is_some();
        let unit = if said { unit_name(*unit) } else { time_unit(longest, *unit) };
        if let Some(stamp) = stamped(table).filter(|_| column == "time") {
            let why = "when it was measured; \"time\" is when it was received";
            let unit = time_unit(&stamp.values, 1.0);
            let text = format!("\n[{name}]\ncolumn = {} # {why}\nunit = \"{unit}\"\n", quoted(&stamp.name));
            return (text, Some(stamp.name.clone()));
        }
        return (format!("\n[{name}]\ncolumn = {}\nunit = \"{unit}\"\n", quoted(column)), Some(column.clone()));
    }
    // Rows are numbered where there is no time; some have no sample of a series.
    if !rows_are_numbered(table) {
        return (String::new(), None);
    }
    match increasing(table) {
        Some(s) => {
            let column = of_every_kind(table, &s.name);
            let unit = if is_count(s) {
                "per_second = 1000 # it counts: write how many are a second".to_owned()
            } else {
                format!("unit = \"{}\"", time_unit(&s.values, 1.0))
            };
            let text =
                format!("\n[{name}]\ncolumn = {} # is it? it increases from row to row\n{unit}\n", quoted(column));
            (text, Some(column.to_owned()))
        }
        None => {
            let text = format!(
                "\n[{name}]\ncolumn = \"?\" # which column is the time? Where there is none: rate_hz = 100, rows a second; \
             points of a characteristic, each when its speed had settled, are no log\n"
            );
            (text, None)
        }
    }
}

/// The name of a column of time: where lines begin with a word, and those of every word have their time in the same column,
/// that column's alone, for the name with a word is the time of its lines alone.
fn of_every_kind<'a>(table: &Table, name: &'a str) -> &'a str {
    let Some((_, column)) = name.split_once('/').filter(|(_, column)| !column.contains('/')) else { return name };
    let mut kinds: Vec<&str> = table.series.iter().filter_map(|s| Some(s.name.split_once('/')?.0)).collect();
    kinds.dedup();
    let rises = |s: &Series| s.values.windows(2).all(|w| w[1] >= w[0]) && s.values.first() < s.values.last();
    let timed = |kind: &&str| table.find(&format!("{kind}/{column}")).is_some_and(rises);
    if kinds.iter().all(timed) { column } else { name }
}

/// The stamp that a robot gave its messages, where it gave them one: `rostopic echo -p` has it beside the time at which
/// each was received.
fn stamped(table: &Table) -> Option<&Series> {
    let stamp = table.find("field.header.stamp")?;
    let rises = stamp.values.windows(2).filter(|w| w[1] > w[0]).count();
    (stamp.values.len() > 2 && 100 * rises >= 95 * (stamp.values.len() - 1)).then_some(stamp)
}

/// A line a column.
fn columns(guesses: &[Guess], none: &str) -> String {
    let mut out = String::new();
    // All motors have one supply and one full duty.
    let duties = guesses.iter().filter(|g| matches!(g.column, Column::Duty(_))).flat_map(|g| g.series.range());
    let most = duties.fold(0.0_f64, |most, x| most.max(x.abs()));
    let in_pixels = guesses.iter().any(|g| g.unit == guess::PIXELS);
    let headed = guesses.iter().any(|g| g.column == Column::Odometry(2));
    let drives = |column: &Column| matches!(column, Column::Duty(_) | Column::Current(_));
    let idle = guesses.iter().filter(|g| drives(&g.column)).all(|g| g.series.range() == [0.0; 2]);
    for Guess { series, column, unit } in guesses {
        let angle = matches!(column, Column::Counts(_)) && !unit.is_empty();
        // What only the owner knows is no guess.
        let open = match *unit {
            _ if matches!(column, Column::Odometry(0 | 1)) && !headed => {
                Some(("", "the robot's own odometry needs its heading, too: odom_theta"))
            }
            unit if in_pixels && unit != guess::PIXELS && matches!(column, Column::Camera(_)) => {
                Some(("", "of the pose in pixels"))
            }
            _ if idle && drives(column) => Some(("", "nothing but 0, as of all motors: it seems not to be logged")),
            guess::PIXELS => {
                Some(("scale = ...", "pixels: scale is metres a pixel; in an image y is mostly down, see [frame]"))
            }
            unit if angle && units::is_like(unit, "m") => Some((
                "unit = \"rad\", scale = ..., counts_per_rev = 65536",
                "the wheel's way: scale is 1 / its radius in its unit",
            )),
            "counts/s" => Some(("unit = \"counts/s\", counts_per_rev = ...", "counts a turn of the wheel")),
            unit if rates(column) && units::is_like(unit, "m/s") => {
                Some(("scale = ...", "at the rim: scale is 1 / wheel radius in the same unit"))
            }
            _ => None,
        };
        if let Some((what, why)) = open {
            let from = quoted(&series.name);
            let value = if what.is_empty() { from } else { format!("{{ from = {from}, {what} }}") };
            let _ = writeln!(out, "# {} = {value} # {why}", column.name());
            continue;
        }
        let value = match *unit {
            "" if rates(column) && Column::from_name(&series.name) == Column::Other => {
                format!("{} # in rad/s at the wheel? Else {{ from = {0}, unit = \"rpm\" }}", quoted(&series.name))
            }
            unit if matches!((column, unit), (Column::Counts(_), "") | (Column::Odometry(_), _))
                && guess::is_step(series) =>
            {
                let unit = if unit.is_empty() { String::new() } else { format!(", unit = \"{unit}\"") };
                let from = quoted(&series.name);
                format!("{{ from = {from}{unit}, increments = true }} # what came since the row before?")
            }
            "" => quoted(&series.name),
            bench::TORQUE if let Some(share) = rated(series) => format!(
                "{{ from = {}, scale = {share} }} # write {share} times the rated torque, Nm, at the output shaft: a current \
                 beside torque_constant = 1 and gear_ratio = 1",
                quoted(&series.name)
            ),
            bench::TORQUE => format!(
                "{} # Nm at the output shaft: a current beside torque_constant = 1 and gear_ratio = 1",
                quoted(&series.name)
            ),
            unit if angle => format!(
                "{{ from = {}, unit = \"{unit}\", counts_per_rev = 65536 }} # what the encoder counts a turn",
                quoted(&series.name)
            ),
            "V" if matches!(column, Column::Duty(_)) => {
                let share = if most > 0.0 { format!("{:.4}", 1.0 / most) } else { "1".to_owned() };
                format!(
                    "{{ from = {}, scale = {share} }} # of {most} V, the most in this file: write 1 / supply_v",
                    quoted(&series.name)
                )
            }
            unit if unit == guess::STEPS || matches!(column, Column::Duty(_)) && unit == "percent" && most > 100.0 => {
                let full = guess::full_duty(most);
                format!(
                    "{{ from = {}, scale = {:.6} }} # of {full}: is that the full duty? The most in this file is {most}",
                    quoted(&series.name),
                    1.0 / full
                )
            }
            unit if rates(column) && guess::is_of_a_motor(series) => {
                format!(
                    "{{ from = {}, unit = \"{unit}\" }} # at the wheel? At the motor with scale = 1 / gear_ratio",
                    quoted(&series.name)
                )
            }
            unit => format!("{{ from = {}, unit = \"{unit}\" }}", quoted(&series.name)),
        };
        let _ = writeln!(out, "{} = {value}", column.name());
    }
    let in_volts = guesses.iter().any(|g| matches!(g.column, Column::Duty(_)) && g.unit == "V");
    if in_volts && !guesses.iter().any(|g| g.column == Column::Supply) {
        let _ =
            writeln!(out, "# supply_v = {most} # and here supply_v: volts that are known, whatever the battery has");
    }
    if guesses.is_empty() { none.to_owned() } else { out }
}

/// Whether a column is a speed of a wheel.
fn rates(column: &Column) -> bool {
    matches!(column, Column::Speed(_) | Column::Reference(_))
}

/// What was not recognised, as remarks; the time is used.
fn unused(rest: &[&Series], timed: Option<&str>) -> String {
    let is_time = |series: &Series| {
        timed.is_some_and(|time| {
            series.name.strip_suffix(time).is_some_and(|kind| kind.is_empty() || kind.ends_with('/'))
        })
    };
    let rest: Vec<&Series> = rest.iter().copied().filter(|series| !is_time(series)).collect();
    let mut out = String::from(if rest.is_empty() { "" } else { "\n# Not used:\n" });
    for series in &rest {
        // A signed number that was read without its sign jumps between both ends, as a counter does that begins again.
        let hint = register(&series.values).map_or_else(String::new, |range| {
            format!("; {} bits read without their sign? wraps = {range}", range.log2())
        });
        let hint = if hint.is_empty() { guess::maybe(series, &rest) } else { hint };
        let [low, high] = series.range().map(readable);
        let _ = writeln!(out, "# {}, {low} to {high}{hint}", quoted(&series.name));
    }
    out
}

/// A number in a remark; some logs hold 2.4e-311 where nothing was measured.
fn readable(x: f64) -> String {
    if x == 0.0 || (1e-6..1e15).contains(&x.abs()) { x.to_string() } else { format!("{x:e}") }
}

/// A TOML string on one line.
fn quoted(name: &str) -> String {
    let plain: String = name.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    format!("\"{}\"", plain.replace('\\', "\\\\").replace('"', "\\\""))
}

/// The unit of time, by its steps where its name says none: nobody logs a robot once a second.
fn time_unit(t: &[f64], unit_s: f64) -> &'static str {
    // Since 1970 1e9 s have passed, and 2.2e9 will have in 2039.
    let since = |unit: f64| t.iter().all(|t| (1e9..2.2e9).contains(&(t * unit)));
    if unit_s == 1.0
        && !t.is_empty()
        && let Some((_, name)) =
            [(1.0, "s"), (1e-3, "ms"), (1e-6, "us"), (1e-9, "ns")].into_iter().find(|(u, _)| since(*u))
    {
        return name;
    }
    match usual_step(t) {
        Some(1e6..) if unit_s == 1.0 => "ns",
        Some(1e3..) if unit_s == 1.0 => "us",
        Some(1.0..) if unit_s == 1.0 => "ms",
        _ => unit_name(unit_s),
    }
}

fn unit_name(unit_s: f64) -> &'static str {
    ["ms", "us", "ns"].into_iter().find(|unit| units::factor(unit) == Some(unit_s)).unwrap_or("s")
}

/// Share of the rows, in hundredths, at which a time increases where it never falls.
const RISES: usize = 70;

/// A column that increases from row to row, not by ones, as time does; another recording may follow. Of several tables in
/// a file, of different lengths, a ramp in one is no time of the others.
fn increasing(table: &Table) -> Option<&Series> {
    let longest = table.series.iter().map(|s| s.values.len()).max()?;
    let share = |s: &Series| {
        let steps = s.values.windows(2).filter(|w| w[1] > w[0] && w[1] != w[0] + 1.0).count();
        if s.values.len() > 2 { 100 * steps / (s.values.len() - 1) } else { 0 }
    };
    // Some write a row twice, and never one before another.
    let rises = |s: &Series| share(s) >= RISES && s.values.windows(2).all(|w| w[1] >= w[0]);
    let whole = || table.series.iter().filter(|s| s.values.len() == longest);
    whole().find(|s| share(s) >= 95).or_else(|| whole().find(|s| rises(s)))
}

/// What a clock that counts is called, at the end of its name.
const COUNTED: [&str; 11] =
    ["timestep", "step", "steps", "tick", "ticks", "loop", "cycle", "cycles", "sample", "samples", "index"];

/// Whether a series that stands for the time counts turns of a loop, of which no range of numbers tells the length.
fn is_count(series: &Series) -> bool {
    let name = series.name.split(['(', '[']).next().unwrap_or_default().trim().to_ascii_lowercase();
    let last = name.rsplit(|c: char| !c.is_ascii_alphanumeric()).next().unwrap_or_default();
    COUNTED.contains(&last)
        && units::in_name(&series.name).and_then(units::of_time).is_none()
        && series.values.iter().all(|v| v.fract() == 0.0)
}

/// What the unit of a drive's torque is of its rated one, where it is a share.
fn rated(series: &Series) -> Option<f64> {
    units::in_name(&series.name).filter(|unit| units::is_like(unit, "1")).and_then(units::factor)
}

#[cfg(test)]
mod tests;
