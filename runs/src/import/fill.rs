//! What becomes of the values of a series in the columns of a run.

use std::borrow::Cow;
use std::path::Path;

use super::Series;
use crate::Run;
use crate::columns::Column;
use crate::error::InputError;
use crate::frames::{Pose, Twist};
use crate::geometry::Geometry;

/// One column of the run to be.
pub(super) struct Wanted<'a> {
    pub(super) column: Column,
    pub(super) from: &'a str,
    pub(super) factor: f64,
    pub(super) offset: f64,
    /// Beyond which the value is taken as this, in our unit.
    pub(super) limit: Option<f64>,
    /// Of how many of the file's units a multiple is not known.
    pub(super) wraps: Option<f64>,
    /// The file's units in a turn, of an encoder whose log has angles.
    pub(super) turn: Option<f64>,
    /// Whether each value is what came since the row before.
    pub(super) increments: bool,
    /// The series whose sign the values get.
    pub(super) sign: Option<&'a str>,
    /// Whether it is the rate of the column.
    pub(super) rate: bool,
}

/// The values of a column whose multiples of a turn were lost: counts go on from the last, others are those next to 0.
/// An encoder of one turn shows itself: angles within a turn that leap by more than half of it; and so does a full register.
pub(super) fn unwrapped<'a>(wanted: &Wanted, values: &'a [f64]) -> Cow<'a, [f64]> {
    let counted = matches!(wanted.column, Column::Counts(_));
    // Of a pose's steps [`chain`] makes a way, when all of them are known.
    if wanted.increments && !counted {
        return values.into();
    }
    if wanted.increments {
        let mut sum = 0.0;
        let add = |value: &f64| {
            sum += value;
            sum
        };
        return values.iter().map(add).collect();
    }
    if reads_nothing(wanted, values) {
        return values.iter().map(|v| if *v == 0.0 { f64::NAN } else { *v }).collect();
    }
    let Some(period) = period(wanted, values) else { return values.into() };
    if !counted {
        return values.iter().map(|v| v - period * (v / period).round()).collect();
    }
    let mut last: Option<f64> = None;
    let follow = |value: &f64| {
        let before = last.unwrap_or(*value);
        let now = value - period * ((value - before) / period).round();
        last = Some(now);
        now
    };
    values.iter().map(follow).collect()
}

/// By how much the values of a column may be off: what the map says, else what shows itself.
fn period(wanted: &Wanted, values: &[f64]) -> Option<f64> {
    let counted = matches!(wanted.column, Column::Counts(_));
    let turn = wanted.turn.filter(|turn| {
        let [low, high] = values.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], v| [l.min(*v), h.max(*v)]);
        counted && high - low <= 1.001 * turn && values.windows(2).any(|w| (w[1] - w[0]).abs() > 0.5 * turn)
    });
    let full = || if counted { register(values) } else { None };
    wanted.wraps.or(turn).or_else(full)
}

/// Falls to 0 and back of a counter at least that make it one that is not read in every row.
const FALLS: usize = 3;

/// Share of a counter's furthest reading from which on it may fall: nobody fails to read it near 0 alone.
const FAR: f64 = 0.1;

/// Whether a counter falls to 0 where nobody read it: it then goes on about where it was, and no wheel went there and back.
/// One that stands where a count begins flickers to 0 and back by that count.
pub(super) fn reads_nothing(wanted: &Wanted, values: &[f64]) -> bool {
    if !matches!(wanted.column, Column::Counts(_)) || wanted.increments || wanted.wraps.is_some() {
        return false;
    }
    let readings: Vec<usize> = (0..values.len()).filter(|k| values[*k] != 0.0 && values[*k].is_finite()).collect();
    let furthest = readings.iter().fold(0.0, |far: f64, k| far.max(values[*k].abs()));
    let falls = readings.windows(2).filter(|pair| pair[0] + 1 < pair[1]).map(|pair| [values[pair[0]], values[pair[1]]]);
    let falls = falls.filter(|[from, _]| from.abs() > FAR * furthest && (wanted.factor * from).abs() > 1.5);
    let (back, others): (Vec<_>, Vec<_>) = falls.partition(|[from, to]| 2.0 * (to - from).abs() < from.abs());
    back.len() >= FALLS && back.len() > 9 * others.len()
}

/// What the owner of such a counter should know.
pub(super) fn is_not_read(wanted: &Wanted, values: &[f64]) -> Option<String> {
    let zeros = values.iter().filter(|v| **v == 0.0).count();
    let (name, share) = (wanted.column.name(), 100.0 * zeros as f64 / values.len().max(1) as f64);
    let said = || {
        format!(
            "{name}: {:?} is 0 in {share:.0} % of its rows, between its readings: those rows have none",
            wanted.from
        )
    };
    reads_nothing(wanted, values).then(said)
}

/// What the owner of an encoder should know that seems to begin again, as the angle of an actuator does after the span of its
/// protocol, and whose span neither the map nor its values tell.
pub(super) fn begins_again(wanted: &Wanted, values: &[f64]) -> Option<String> {
    let counted = matches!(wanted.column, Column::Counts(_)) && !wanted.increments;
    if !counted || period(wanted, values).is_some() || reads_nothing(wanted, values) {
        return None;
    }
    let [low, high] = values.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], v| [l.min(*v), h.max(*v)]);
    let steps: Vec<f64> = values.windows(2).map(|w| w[1] - w[0]).collect();
    let leaps = steps.iter().filter(|step| step.abs() > LEAP * (high - low)).count();
    // A counter that is set back comes from a stand; one that begins again goes on.
    let goes_on = |s: &&[f64]| s[1].abs() > LEAP * (high - low) && s[0] * s[2] > 0.0 && s[0] * s[1] < 0.0;
    let mut spans: Vec<f64> =
        steps.windows(3).filter(goes_on).map(|s| s[1].abs() + 0.5 * (s[0] + s[2]).abs()).collect();
    if 2 * spans.len() <= leaps {
        return None;
    }
    spans.sort_by(f64::total_cmp);
    let name = wanted.column.name();
    Some(format!(
        "{name}: {:?} leaps by nearly its whole range, and goes on: where it begins again, after about {:.3}, say wraps = \
         that number in the map",
        wanted.from,
        spans[spans.len() / 2]
    ))
}

/// Steps of an angle that show their size, and how well each must be a multiple of it.
const STEPS: usize = 200;
const MULTIPLE: f64 = 0.1;
/// Counts in a step, up to which rounding to whole counts makes steps uneven by a tenth and more.
const COARSE: f64 = 5.0;
/// Part of a count that a step may have beside whole ones: in the range of a joint it makes one count, or next to none.
const WHOLE: f64 = 0.02;

/// What the owner of an angle should know whose steps are a few of the map's counts and a part of one: in whole counts some are
/// longer than others, which repeats with the angle as cogs of a motor do. An actuator's protocol had 2155.87 steps a turn, and
/// in 4096 counts a ripple of 11 % of the speed, 216 times a turn.
pub(super) fn has_steps(wanted: &Wanted, values: &[f64]) -> Option<String> {
    let turn = wanted.turn.filter(|_| matches!(wanted.column, Column::Counts(_)) && !wanted.increments)?;
    let steps: Vec<f64> = values.windows(2).map(|w| (w[1] - w[0]).abs()).filter(|step| *step > 1e-9 * turn).collect();
    let least = steps.iter().copied().fold(f64::INFINITY, f64::min);
    let few: Vec<f64> = steps.into_iter().filter(|step| *step < 0.5 * least / MULTIPLE).collect();
    let whole = |step: f64, size: f64| (step / size - (step / size).round()).abs() < MULTIPLE;
    if few.len() < STEPS || !few.iter().all(|step| whole(*step, least)) {
        return None;
    }
    let multiples: f64 = few.iter().map(|step| (step / least).round()).sum();
    let size = few.iter().sum::<f64>() / multiples;
    let counts = (wanted.factor * size).abs();
    let part = (counts - counts.round()).abs();
    if !(1.0..COARSE).contains(&counts) || part < WHOLE {
        return None;
    }
    Some(format!(
        "{}: {:?} goes in steps, {:.3} counts each, which whole counts make uneven, as a ripple of the machine would: say \
         counts_per_rev = {:.1} in the map, and the same in robot.toml",
        wanted.column.name(),
        wanted.from,
        counts,
        turn / size
    ))
}

/// The sign, at some times, of a series that has one: its last sample's, and where that is 0 the one before; of a series of
/// nothing but 0 and 1, a direction, 0 is backwards.
pub(super) fn signs(of: &Series, at: &[f64]) -> Vec<f64> {
    let direction = of.values.iter().all(|x| *x == 0.0 || *x == 1.0);
    let mut next = 0;
    let mut sign = 1.0;
    let mut until = |t: f64| {
        while next < of.t.len() && of.t[next] <= t {
            let value = of.values[next];
            if direction {
                sign = if value == 0.0 { -1.0 } else { 1.0 };
            } else if value != 0.0 {
                sign = value.signum();
            }
            next += 1;
        }
        sign
    };
    at.iter().map(|t| until(*t)).collect()
}

/// Share of a register's range by which a counter leaps only where it begins again: no wheel passes from one end of 65536
/// counts to the other between two rows.
const LEAP: f64 = 0.9;

/// The range of the register, of 16 or 32 bits with or without a sign, in which a counter lost its turns.
pub(super) fn register(values: &[f64]) -> Option<f64> {
    let known = || values.iter().filter(|v| v.is_finite());
    let [low, high] = known().fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], v| [l.min(*v), h.max(*v)]);
    let ranges = [16, 32].map(|bits| 2.0_f64.powi(bits));
    let range = ranges.into_iter().find(|range| {
        let holds = |least: f64| low >= least && high < least + range;
        high - low > LEAP * range && (holds(0.0) || holds(-0.5 * range))
    })?;
    let whole = known().all(|v| v.fract() == 0.0);
    let leaps = values.windows(2).any(|w| (w[1] - w[0]).abs() > LEAP * range);
    (whole && leaps).then_some(range)
}

/// Poses of velocities, from the first on; a velocity between two samples is their mean.
pub(super) fn integrate(t: &[f64], odometry: &mut [Vec<f64>; 3], sense: f64) {
    let mut pose = Pose::default();
    let mut before: Option<(f64, [f64; 3])> = None;
    for (tick, t) in t.iter().enumerate() {
        let now = [0, 1, 2].map(|i| odometry[i][tick]);
        if !now.iter().all(|v| v.is_finite()) {
            odometry.iter_mut().for_each(|c| c[tick] = f64::NAN);
            continue;
        }
        if let Some((since, last)) = before {
            let [vx, vy, w] = [0, 1, 2].map(|i| 0.5 * (last[i] + now[i]));
            pose = pose.advance(Twist::new(vx, vy, sense * w), t - since);
        }
        before = Some((*t, now));
        odometry[0][tick] = pose.x;
        odometry[1][tick] = pose.y;
        odometry[2][tick] = sense * pose.theta;
    }
}

/// Poses of steps, each seen from the pose before it. What goes along its way drives arcs; with a sideways part a step leads
/// straight to the next pose. `sense` is that of the headings in the frame of the steps.
pub(super) fn chain<'a>(steps: impl Iterator<Item = [&'a mut f64; 3]>, arcs: bool, sense: f64) {
    let mut pose = Pose::default();
    for mut step in steps {
        let [x, y, theta] = step.each_ref().map(|part| **part);
        if [x, y, theta].iter().all(|part| part.is_finite()) {
            pose = if arcs {
                pose.advance(Twist::new(x, y, sense * theta), 1.0)
            } else {
                pose.compose(Pose::new(x, y, sense * theta))
            };
            for (part, value) in step.iter_mut().zip([pose.x, pose.y, sense * pose.theta]) {
                **part = value;
            }
        } else {
            step.into_iter().for_each(|part| *part = f64::NAN);
        }
    }
}

/// Counts of a wheel; ticks without one hold the last.
pub(super) fn counts(run: &mut Run, wheel: usize, column: &[f64]) {
    let mut held = column.iter().copied().find(|x| x.is_finite()).unwrap_or(0.0).round() as i64;
    for (tick, x) in column.iter().enumerate() {
        if x.is_finite() {
            held = x.round() as i64;
        } else {
            run.count_gaps[wheel].push(tick);
        }
        run.counts[wheel].push(held);
    }
}

/// Wheel speeds as commanded, where none were logged.
pub(super) fn speeds_of_commands(run: &mut Run, geometry: &Geometry, path: &Path) -> Result<(), InputError> {
    let refuse = |what: &str, hint: &str| Err(InputError::new(path, what, hint).field("derive.speeds"));
    if !run.speed.is_empty() || !run.counts.is_empty() {
        return refuse("the wheels are logged", "leave [derive] speeds out of the map");
    }
    let Some([vx, vy, w]) = &run.command else {
        return refuse("speeds are derived from commands, and none are mapped", "map cmd_vx, cmd_vy and cmd_w");
    };
    let twists = vx.iter().zip(vy).zip(w).map(|((vx, vy), w)| Twist::new(*vx, *vy, *w));
    let speeds: Vec<Vec<f64>> = twists.map(|twist| geometry.wheel_speeds(twist)).collect();
    run.speed = (0..geometry.wheel_count()).map(|wheel| speeds.iter().map(|tick| tick[wheel]).collect()).collect();
    Ok(())
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, PI};

    use super::super::{Clock, Map, Table};
    use super::*;

    fn made(map: &str, text: &str) -> Result<Run, String> {
        let table = Table::of_bytes(text.as_bytes(), Path::new("in"), None, &Clock::default()).unwrap();
        Map::parse(map, Path::new("map.toml")).and_then(|m| m.run(&table, Path::new("in"))).map_err(|e| e.to_string())
    }

    #[test]
    fn an_encoder_of_one_turn_goes_on_counting() {
        let angles =
            "t,deg,raw,pwm\n0,350,4090,65535\n1,10,5,1\n2,170,2000,65534\n3,200,2100,32767\n4,340,3900,0\n5,20,100,0\n";
        let of = |column: &str| made(&format!("[columns]\n{column}\n"), angles);
        let turns = of("enc_1 = { from = \"deg\", unit = \"deg\", counts_per_rev = 360, scale = -1 }").unwrap();
        assert_eq!(turns.counts[0], [-350, -370, -530, -560, -700, -740]);
        let raw = of("enc_1 = { from = \"raw\", wraps = 4096 }").unwrap();
        assert_eq!(raw.counts[0], [4090, 4101, 6096, 6196, 7996, 8292]);
        let signed = of("duty_1 = { from = \"pwm\", wraps = 65536, scale = 1e-5 }").unwrap();
        assert_eq!(signed.duty[0][..3], [-1e-5, 1e-5, -2e-5]);
        assert!(of("enc_1 = { from = \"raw\", wraps = 0 }").unwrap_err().contains("wraps = 0 is no period"));
        let error = of("enc_1 = { from = \"raw\", wrap = 4096 }").unwrap_err();
        assert!(error.starts_with("map.toml:2:") && error.contains("unknown field `wrap`, expected one of"), "{error}");
        let error = of("enc_1 = 4096").unwrap_err();
        assert!(error.contains("give the name of a series, or { from ="), "{error}");
        // A full register shows itself, whole: one bit less, or a slow way through it, is no leap.
        for (rows, wanted) in [
            (
                "0,4294967290\n1,4294967295\n2,4\n3,4294967294",
                [4_294_967_290, 4_294_967_295, 4_294_967_300, 4_294_967_294],
            ),
            ("0,32760\n1,32767\n2,-32760\n3,-32700", [32760, 32767, 32776, 32836]),
            ("0,65530\n1,2\n2,9\n3,65529", [65530, 65538, 65545, 65529]),
            ("0,0\n1,20000\n2,41000\n3,65000", [0, 20000, 41000, 65000]),
            ("0,0\n1,70000\n2,9\n3,70000", [0, 70000, 9, 70000]),
        ] {
            let run = made("[columns]\nenc_1 = \"n\"\n", &format!("t,n\n{rows}\n")).unwrap();
            assert_eq!(run.counts[0], wanted, "{rows}");
        }
        // A motor that turned more than once in its angle did not lose its turns.
        let far = made(
            "[columns]\nenc_1 = { from = \"rad\", unit = \"rad\", counts_per_rev = 100 }\n",
            "t,rad\n0,0\n1,4\n2,8\n",
        );
        assert_eq!(far.unwrap().counts[0], [0, 64, 127]);
    }

    #[test]
    fn a_counter_that_is_0_where_nobody_read_it_has_no_sample_there() {
        let map = "[columns]\nenc_1 = \"a\"\nduty_1 = \"b\"";
        let table = |a: [i64; 8]| {
            let row = |(k, a): (usize, i64)| format!("0.0{k},{a},1\n");
            format!("t,a,b\n{}", a.into_iter().enumerate().map(row).collect::<String>())
        };
        let run = made(map, &table([900, 0, 0, 905, 0, 909, 0, 912])).unwrap();
        assert_eq!(
            run.counts[0],
            made(map, "t,a,b\n0.00,900,1\n0.01,,1\n0.02,,1\n0.03,905,1\n0.04,,1\n0.05,909,1\n0.06,,1\n0.07,912,1\n")
                .unwrap()
                .counts[0]
        );
        // One that passes through 0, one that was set back, and two that stand at the edge of a count, of which one then drives.
        for kept in [
            [-3, -1, 0, 2, 0, -2, 0, 1],
            [900, 0, 0, 3, 5, 0, -2, -4],
            [-1, 0, -1, 0, 0, -1, 0, -1],
            [2, 0, 2, 0, 2, 0, 2, 90],
        ] {
            assert_eq!(made(map, &table(kept)).unwrap().counts[0], kept);
        }
    }

    #[test]
    fn an_angle_whose_steps_are_no_whole_counts_is_told() {
        let told = |counts_per_rev: f64, steps_per_rev: f64| {
            let angle = |k: f64| std::f64::consts::TAU / steps_per_rev * (300.0 * (0.01 * k).sin()).round();
            let rows: String = (0..2000).map(|k| format!("{k},{:.6}\n", angle(f64::from(k)))).collect();
            let folder = tempfile::tempdir().unwrap();
            let [map, log] = ["map.toml", "log.csv"].map(|name| folder.path().join(name));
            let column = format!("{{ from = \"p\", unit = \"rad\", counts_per_rev = {counts_per_rev} }}");
            std::fs::write(&map, format!("[columns]\nenc_1 = {column}\n")).unwrap();
            std::fs::write(&log, format!("t,p\n{rows}")).unwrap();
            Map::load(&map).unwrap().import(&log, None).unwrap().remarks
        };
        // Positions of 16 bits over 191 rad.
        let steps = std::f64::consts::TAU * 65535.0 / 191.0;
        let [said] = &told(4096.0, steps)[..] else { panic!("no remark, or several") };
        assert!(said.contains("1.900 counts each") && said.contains("counts_per_rev = 2155.9"), "{said}");
        // Counts as they are, twice and a hundred times as many, and fewer.
        for (counts, steps) in
            [(4096.0, 4096.0), (2155.87, steps), (8192.0, 4096.0), (215_587.0, steps), (1000.0, 4096.0)]
        {
            assert_eq!(told(counts, steps), Vec::<String>::new(), "{counts} {steps}");
        }
    }

    #[test]
    fn an_angle_that_begins_again_after_a_span_of_its_own_is_told() {
        let told = |column: &str, rows: &str| {
            let folder = tempfile::tempdir().unwrap();
            let [map, log] = ["map.toml", "log.csv"].map(|name| folder.path().join(name));
            std::fs::write(
                &map,
                format!("[columns]\nenc_1 = {{ from = \"p\", unit = \"rad\", counts_per_rev = 100{column} }}\n"),
            )
            .unwrap();
            std::fs::write(&log, format!("t,p\n{rows}")).unwrap();
            Map::load(&map).unwrap().import(&log, None).unwrap().remarks
        };
        // An actuator from -12.5 to 12.5 rad, at 0.4 rad a row; and one whose counter was set back at a stand.
        let turned: String =
            (0..200).map(|k| format!("{k},{:.3}\n", (0.4 * f64::from(k) + 12.5).rem_euclid(25.0) - 12.5)).collect();
        let [said] = &told("", &turned)[..] else { panic!("no remark, or several") };
        assert!(said.contains("after about 25.0"), "{said}");
        assert_eq!(told(", wraps = 25", &turned), Vec::<String>::new());
        let set_back = |k: i32| if k < 60 { 0.4 * f64::from(k.min(50)) } else { 0.4 * f64::from(k - 60) };
        let set_back: String = (0..110).map(|k| format!("{k},{:.3}\n", set_back(k))).collect();
        assert_eq!(told("", &set_back), Vec::<String>::new());
    }

    #[test]
    fn increments_are_summed_and_counts_a_second_are_speeds() {
        let text = "t,d,v,w\n0,3,0,0\n0.1,4,1320,1.5\n0.2,-9,2640,0\n";
        let of = |column: &str| made(&format!("[columns]\n{column}\n"), text);
        assert_eq!(of("enc_1 = { from = \"d\", increments = true }").unwrap().counts[0], [3, 7, -2]);
        assert_eq!(of("enc_1 = { from = \"d\", increments = true, scale = -1 }").unwrap().counts[0], [-3, -7, 2]);
        let turned = "enc_1 = { from = \"w\", unit = \"rev\", counts_per_rev = 100, increments = true }";
        assert_eq!(of(turned).unwrap().counts[0], [0, 150, 150]);
        let speed =
            of("speed_1 = { from = \"v\", unit = \"counts/s\", counts_per_rev = 1320 }").unwrap().speed[0].clone();
        assert!((speed[1] - 2.0 * PI).abs() < 1e-9 && (speed[2] - 4.0 * PI).abs() < 1e-9, "{speed:?}");
        for (column, message) in [
            ("odom_x = { from = \"w\", increments = true }", "odom_y: no such column"),
            ("duty_1 = { from = \"w\", increments = true }", "increments = true has no meaning here"),
            ("enc_1 = { from = \"d\", increments = true, wraps = 4096 }", "increments = true has no meaning here"),
            ("speed_1 = { from = \"v\", unit = \"counts/s\" }", "counts_per_rev = 1440"),
            ("duty_1 = { from = \"w\", counts_per_rev = 10 }", "counts_per_rev = 10 has no meaning here"),
            ("enc_1 = { from = \"w\", unit = \"m\" }", "scale = 1 / radius in metres"),
        ] {
            let error = of(column).unwrap_err();
            assert!(error.contains(message), "{error}");
        }
    }

    #[test]
    fn velocities_are_integrated_to_odometry() {
        // A quarter turn to the left about a centre 1 m away, x forward.
        let rows: Vec<String> = (0..=1000).map(|i| format!("{},{},{}", i, PI / 2.0, PI / 2.0)).collect();
        let text = format!("time_ms,v,omega\n{}\n", rows.join("\n"));
        let columns = "[columns]\nodom_vx = \"v\"\nodom_w = \"omega\"\n";
        let run = made(&format!("[frame]\nx = \"forward\"\n{columns}"), &text).unwrap();
        let [x, y, theta] = run.odometry.as_ref().unwrap().clone().map(|c| c[1000]);
        assert!((x - 1.0).abs() < 1e-6 && (y - 1.0).abs() < 1e-6, "{x} {y}");
        // Its forward axis looks along y, so that its x axis, to the right, looks along x.
        assert!(theta.abs() < 1e-9, "{theta}");
        let clockwise = made(&format!("[frame]\nx = \"forward\"\nheadings = \"clockwise\"\n{columns}"), &text).unwrap();
        let [x, y, theta] = clockwise.odometry.as_ref().unwrap().clone().map(|c| c[1000]);
        assert!((x - 1.0).abs() < 1e-6 && (y + 1.0).abs() < 1e-6, "{x} {y}");
        assert!((theta.abs() - 2.0 * FRAC_PI_2).abs() < 1e-9, "{theta}");
        let half = made("[frame]\nx = \"forward\"\n[columns]\nodom_vx = \"v\"\n", &text).unwrap_err();
        assert!(half.contains("odom_w: no such column in the map; map odom_vx and odom_w"), "{half}");
        let both = made("[columns]\nodom_vx = \"v\"\nodom_w = \"omega\"\nodom_x = \"v\"\n", &text).unwrap_err();
        assert!(both.contains("a pose, or its velocities"), "{both}");
    }

    #[test]
    fn steps_of_poses_are_a_way() {
        // A quarter turn to the left about a centre 1 m away, in steps, by what turned and what went along; and its chords.
        let n = 500;
        let turn = FRAC_PI_2 / f64::from(n);
        let row = |i: i32| format!("{i},{turn},{turn},{},{}", turn.sin(), 1.0 - turn.cos());
        let text = format!("t,ds,dth,dx,dy\n{}\n", (0..n).map(row).collect::<Vec<_>>().join("\n"));
        let of = |frame: &str, columns: &[(&str, &str)]| {
            let line =
                |(column, from): &(&str, &str)| format!("{column} = {{ from = \"{from}\", increments = true }}\n");
            let columns: String = columns.iter().map(line).collect();
            made(&format!("[frame]\nx = \"forward\"\n{frame}[columns]\n{columns}"), &text)
        };
        let arcs = [("odom_x", "ds"), ("odom_theta", "dth")];
        let chords = [("odom_x", "dx"), ("odom_y", "dy"), ("odom_theta", "dth")];
        let ends = |run: &Run| run.odometry.as_ref().unwrap().clone().map(|c| c[c.len() - 1]);
        for columns in [&arcs[..], &chords] {
            let [x, y, theta] = ends(&of("", columns).unwrap());
            assert!((x - 1.0).abs() < 1e-6 && (y - 1.0).abs() < 1e-6 && theta.abs() < 1e-9, "{x} {y} {theta}");
        }
        let [x, y, _] = ends(&of("headings = \"clockwise\"\n", &arcs).unwrap());
        assert!((x - 1.0).abs() < 1e-6 && (y + 1.0).abs() < 1e-6, "{x} {y}");
        // Of a camera, and in an image, where what turns to the left turns the other way than its y.
        let seen = chords.map(|(column, from)| (column.replace("odom", "cam"), from));
        let seen = seen.each_ref().map(|(column, from)| (column.as_str(), *from));
        let pose = |frame: &str| of(frame, &seen).unwrap().camera.last().unwrap().pose;
        let plain = pose("");
        assert!((plain.x - 1.0).abs() < 1e-6 && (plain.y - 1.0).abs() < 1e-6 && plain.theta.abs() < 1e-9, "{plain:?}");
        let image = pose("y = \"down\"\nheadings = \"clockwise\"\n");
        assert!((image.x - 1.0).abs() < 1e-6 && (image.y + 1.0).abs() < 1e-6, "{image:?}");
        // Steps without a heading lead nowhere, and a whole pose is no step.
        let error = of("", &seen[..2]).unwrap_err();
        assert!(error.contains("cam_theta: no such column"), "{error}");
        let mixed = "[columns]\nodom_x = { from = \"dx\", increments = true }\nodom_y = \"dy\"\nodom_theta = \"dth\"\n";
        let error = made(mixed, &text).unwrap_err();
        assert!(error.contains("a pose is logged in increments as a whole, or not"), "{error}");
    }
}
