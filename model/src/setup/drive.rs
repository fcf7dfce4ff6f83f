//! Set points, commands, duties and supply against the counts.

use estimation::statistics::median;
use runs::robot::{Robot, Support};
use runs::{DutySource, Log, drive_lacks};

use super::samples::{BOTH_WAYS, FEWEST, HELD, SETTLED_S, correlation};
use super::signals::{Signals, signals};
use super::{Mistake, OTHER_SENSE, OTHER_SENSE_KIND, axes, common_ratio, is_true, loops, near, short, supply, work};

/// Correlation from which a signal follows the wheels at all.
const FOLLOWS: f64 = 0.8;
/// Correlation with the angle of its axis from which a set point that does not follow the speed is a position: speeds have
/// 0.64 at most (the example sets, their runs one by one, the library's manoeuvres), a servo whose lag was found 1.00.
const PLACED: f64 = 0.95;
/// How many times as fast as its set point a wheel turns from which that is said: load and lag make it slower, and on the
/// example sets it is 1.0; robots of others had 1.3 to 1.9. From [`TRUE_RATIO`](super::TRUE_RATIO) on it is another unit.
const FASTER: f64 = 1.25;
/// Correlation with the size of the speed from which a column follows it.
const SIZE: f64 = 0.3;
/// Share of a duty by which it is at one level.
const LEVEL: f64 = 0.05;
/// Spans by which commands may run ahead.
const LAGS: usize = 6;
/// Time for which an axis must have stood undriven so that it starts from rest, s: it stops within some tenths.
const REST_S: f64 = 0.5;
/// Starts each way from which they tell.
const STARTS: usize = 2;
/// Ratio of supplies up to which duties and speeds speak of the motors of the file, so that what these cannot follow is a
/// limit: counts of half the lines would make it 0.5.
const ITS_MOTORS: f64 = 1.5;
pub(super) fn mistakes(robot: &Robot, logs: &[Log]) -> Vec<Mistake> {
    let mut found = Vec::new();
    let signals: Vec<Signals> = logs.iter().filter_map(|log| signals(robot, log)).collect();
    let currents = logs.first().is_some_and(|log| log.layout().source.duties == DutySource::Currents);
    let stem = if currents { "current" } else { "duty" };
    found.extend(unsigned(robot, &signals, stem));
    found.extend(axes::against(robot, &signals, stem));
    let gained = work::gained(robot, &signals, stem, &found);
    found.extend(gained);
    match positions(&signals) {
        Some(mistake) => found.push(mistake),
        None => {
            found.extend(axes::still(robot, &signals));
            let unasked = axes::unasked(robot, &signals, &found);
            found.extend(unasked);
            found.extend(references(robot, logs, &signals));
        }
    }
    found.extend(commands(robot, &signals));
    found.extend(supply::against(robot, &signals));
    found
}

/// Slope of y over x through the origin.
fn slope(pairs: &[(f64, f64)]) -> f64 {
    let (xx, xy) = pairs.iter().fold((0.0, 0.0), |(xx, xy), (x, y)| (xx + x * x, xy + x * y));
    xy / xx
}

/// Samples of one axis in all logs: duty, speed, acceleration.
fn driven(signals: &[Signals], axis: usize) -> Vec<[f64; 3]> {
    let logs = signals.iter().filter(|s| axis < s.duty.len());
    let rows = logs.flat_map(|s| s.duty[axis].iter().zip(&s.speed[axis]).zip(&s.acceleration[axis]));
    let rows = rows.map(|((duty, speed), acceleration)| [*duty, *speed, *acceleration]);
    rows.filter(|[duty, speed, _]| duty.is_finite() && speed.abs() > 1e-6).collect()
}

/// Whether an axis turns steadily both ways, as fast backwards as forwards, at the level at which it is driven most: what
/// holds a load drives it one way, and what swings does not turn steadily.
fn both_ways_at_a_level(rows: &[[f64; 3]]) -> bool {
    let mut driven: Vec<f64> = rows.iter().map(|row| row[0]).filter(|duty| *duty > 0.0).collect();
    let level = median(&mut driven);
    let near: Vec<&[f64; 3]> = rows.iter().filter(|row| (row[0] - level).abs() <= LEVEL * level).collect();
    let steady: Vec<f64> =
        near.iter().filter(|row| row[2].abs() * SETTLED_S <= row[1].abs()).map(|row| row[1]).collect();
    let (mut forwards, mut back): (Vec<f64>, Vec<f64>) = steady.iter().partition(|speed| **speed > 0.0);
    let fewer = forwards.len().min(back.len());
    let [forwards, back] = [&mut forwards, &mut back].map(|speeds| median(speeds).abs());
    2 * steady.len() >= near.len()
        && fewer as f64 >= BOTH_WAYS * steady.len() as f64
        && fewer >= FEWEST / 2
        && near.len() * 2 >= rows.len()
        && (0.5..=2.0).contains(&(forwards / back))
}

/// Whether an axis that stood undriven turns back under what drives it as readily as forwards. A load that pulls it back
/// against the drive would have pulled it sooner while nothing drove it.
fn both_ways_from_rest(signals: &[Signals], axis: usize) -> bool {
    let mut starts: [Vec<f64>; 2] = Default::default();
    for s in signals.iter().filter(|s| axis < s.duty.len().min(s.speed.len())) {
        let most = |of: &[f64]| LEVEL * of.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        let (idle, still) = (most(&s.duty[axis]), most(&s.speed[axis]));
        let (mut rested, mut driven) = (0.0, [0.0; 2]);
        for (duty, speed) in s.duty[axis].iter().zip(&s.speed[axis]) {
            if *duty > idle {
                driven = [driven[0] + duty, driven[1] + speed];
                continue;
            }
            if driven[0] > 0.0 && rested >= REST_S {
                starts[usize::from(driven[1] < 0.0)].push(driven[1].abs() / driven[0]);
            }
            rested = if driven[0] == 0.0 && speed.abs() <= still { rested + s.span_s } else { 0.0 };
            driven = [0.0; 2];
        }
    }
    let [forwards, back] = &mut starts;
    forwards.len().min(back.len()) >= STARTS && (0.5..=2.0).contains(&(median(forwards) / median(back)))
}

/// What drives an axis without its sign: never negative though the axis turns both ways. On an axis alone a load that pulls
/// one way holds it positive as well; there it must be as large backwards as forwards, too, or drive both ways at one level
/// or from rest.
fn unsigned(robot: &Robot, signals: &[Signals], stem: &str) -> Option<Mistake> {
    let axes = signals.iter().map(|s| s.duty.len().min(s.speed.len())).max()?;
    let lost = |i: &usize| {
        let rows = driven(signals, *i);
        let pairs: Vec<(f64, f64)> = rows.iter().map(|[duty, speed, _]| (*duty, *speed)).collect();
        let back = pairs.iter().filter(|(_, speed)| *speed < 0.0).count();
        let both = back.min(pairs.len() - back) as f64 >= BOTH_WAYS * pairs.len() as f64;
        let size = correlation(pairs.iter().map(|(duty, speed)| (*duty, speed.abs())));
        let sense = correlation(pairs.iter().copied());
        let positive = pairs.iter().all(|(duty, _)| *duty >= 0.0);
        let no_load = robot.support == Support::Floor
            || size > SIZE && size > 2.0 * sense.abs()
            || both_ways_at_a_level(&rows)
            || both_ways_from_rest(signals, *i);
        pairs.len() >= FEWEST && both && positive && no_load && pairs.iter().any(|(duty, _)| *duty > 0.0)
    };
    let wheel = (0..axes).find(lost)?;
    let what = "it is never negative though the axis turns both ways: its sign is lost".to_owned();
    let remedy = "log it with its sign; where only its size is measured, give it that of the command, the set point or the motor's \
         voltage: sign = \"...\" beside from = in the map";
    Some(Mistake::new("drive-unsigned", &format!("{stem}_{}", wheel + 1), what, remedy.to_owned()))
}

/// Set points that are positions, as those of servos.
fn positions(signals: &[Signals]) -> Option<Mistake> {
    let of = |s: &Signals, lag: usize| -> [f64; 2] {
        let axes = || s.speed.iter().zip(&s.reference);
        // The angle is the sum of the speeds; every axis by itself, for each has its own zero.
        let angle = |w: &[f64]| -> Vec<f64> {
            let add = |sum: &mut f64, w: &f64| {
                *sum += if w.is_finite() { *w } else { 0.0 };
                Some(*sum)
            };
            w.iter().scan(0.0, add).collect()
        };
        let least = |x: &dyn Fn(&[f64]) -> Vec<f64>| {
            let follows = |(w, r): (&Vec<f64>, &Vec<f64>)| {
                let pairs = x(w).into_iter().skip(lag).zip(r.iter().copied());
                correlation(pairs.filter(|(x, r)| x.is_finite() && r.is_finite()))
            };
            axes().map(follows).fold(f64::INFINITY, f64::min)
        };
        [least(&angle), least(&<[f64]>::to_vec)]
    };
    let long = |s: &&Signals| s.reference.first().is_some_and(|r| r.len() >= FEWEST);
    let best = |s: &Signals| (0..=LAGS).map(|lag| of(s, lag)).max_by(|a, b| a[0].total_cmp(&b[0]));
    let all: Vec<[f64; 2]> = signals.iter().filter(long).filter_map(best).collect();
    if all.is_empty() || !all.iter().all(|[angle, speed]| *angle >= PLACED && *speed < SIZE) {
        return None;
    }
    let what = "set points are where the axes go, not how fast: they follow the angles of the wheels, not their speeds";
    let remedy = "ref_ are speeds: leave these out (the drive is compared without them)";
    Some(Mistake::new("reference-position", "ref_1", what.to_owned(), remedy.to_owned()))
}

/// Duty of each axis from which its firmware holds it back; all there is where they do not speak of the motors of the file, so
/// that the speeds may be wrong.
fn limits(robot: &Robot, signals: &[Signals]) -> Vec<f64> {
    let axes = signals.iter().map(|s| s.duty.len()).min().unwrap_or(0);
    let largest = |i: usize| signals.iter().flat_map(|s| &s.duty[i]).fold(0.0, |most: f64, duty| most.max(duty.abs()));
    let own = are_its_motors(robot, signals);
    (0..axes).map(|i| if own { HELD * largest(i) } else { supply::WITHIN }).collect()
}

/// Whether duties and speeds speak of the motors of the file.
fn are_its_motors(robot: &Robot, signals: &[Signals]) -> bool {
    drive_lacks(robot).is_empty()
        && supply::by_duties(robot, signals, &|_| true)
            .is_some_and(|volts| (1.0 / ITS_MOTORS..ITS_MOTORS).contains(&(volts / robot.supply_v)))
}

/// Set points in another unit, or speeds that are wrong beside them.
fn references(robot: &Robot, logs: &[Log], signals: &[Signals]) -> Option<Mistake> {
    // Wheels follow their set points: the lag at which they do so best, log by log. One that asks for what no motor can
    // do says nothing, and does not drown the others; nor does a wheel that is still on its way.
    let limits = limits(robot, signals);
    let of = |s: &Signals, lag: usize| -> Vec<(f64, f64)> {
        let held = |i: usize, k: usize| limits.get(i).is_some_and(|limit| s.duty[i][k].abs() >= *limit);
        let axes = s.speed.iter().zip(&s.acceleration).zip(&s.reference).enumerate();
        let rows = axes.flat_map(|(i, ((w, a), r))| {
            let late = (lag..).zip(w.iter().zip(a).skip(lag)).zip(r);
            late.filter(move |((k, _), _)| !held(i, *k)).map(|((_, (w, a)), r)| (w, a, r))
        });
        let arrived = rows.filter(|(w, a, _)| a.abs() * SETTLED_S <= w.abs()).map(|(w, _, r)| (*w, *r));
        arrived.filter(|(w, r)| w.is_finite() && r.is_finite()).collect()
    };
    let follows = |pairs: &[(f64, f64)]| correlation(pairs.iter().copied());
    let best = |s| (0..=LAGS).map(|lag| of(s, lag)).max_by(|a, b| follows(a).total_cmp(&follows(b)));
    let pairs: Vec<(f64, f64)> =
        signals.iter().filter_map(best).filter(|pairs| follows(pairs) >= FOLLOWS).flatten().collect();
    if pairs.len() < FEWEST {
        return None;
    }
    let ratio = slope(&pairs);
    if is_true(ratio) {
        // Duties would tell what became of a set point.
        let open = ratio < 1.0 / FASTER && signals.iter().all(|s| s.duty.is_empty());
        return open.then(|| {
            let what = format!("wheels turn {} times as fast as their set points, once they follow them", short(1.0 / ratio));
            let remedy = "set points may count with another gear ratio, wheel or encoder than robot.toml; where the speeds are \
                          right, the controller has one of these wrong";
            Mistake { nameable: true, ..Mistake::new("reference-ratio", "ref_1", what, remedy.to_owned()) }
        });
    }
    let what = format!("set points are {} times the speeds of the wheels", short(ratio));
    let taken_for_speeds = ratio > 1.0 && loops::per_speed(robot, logs).is_some_and(is_true);
    let rpm = 60.0 / std::f64::consts::TAU;
    if near(ratio, rpm) && !taken_for_speeds {
        let what = format!("{what}: turns per minute");
        let remedy = "write rad/s at the wheel (divide by 9.5493), or name the unit to `racbot convert`".to_owned();
        return Some(Mistake::new("reference-unit", "ref_1", what, remedy));
    }
    if let Some(mistake) = common_ratio(robot, ratio).filter(|m| m.kind != "wheel-diameter" && !taken_for_speeds) {
        return Some(mistake);
    }
    // Where duties say that motors, gear and counts are the file's, or that the loop takes set points and speeds for one, it
    // may as well not get that far.
    let its_motors = || ratio > 1.0 && !near(ratio, robot.gear_ratio) && are_its_motors(robot, signals);
    if taken_for_speeds || its_motors() {
        let what = format!("{what}, which is no unit that is known");
        let remedy = "a loop that does not keep up with them leaves as much; else write rad/s at the wheel".to_owned();
        return Some(Mistake { nameable: true, ..Mistake::new("reference-unit", "ref_1", what, remedy) });
    }
    let shaft = if near(ratio, robot.gear_ratio) { " (these look like speeds of the motor shaft)" } else { "" };
    let [counts, gear] = [robot.encoder_counts_per_motor_rev, robot.gear_ratio].map(|x| short(x / ratio));
    let remedy = format!(
        "write rad/s at the wheel{shaft}, or check gear_ratio and encoder_counts_per_motor_rev: with {gear} or {counts} in \
         place of what stands there the wheels do what is asked of them"
    );
    Some(Mistake::new("reference-unit", "ref_1", what, remedy))
}

/// Commands in another frame.
fn commands(robot: &Robot, signals: &[Signals]) -> Option<Mistake> {
    let geometry = robot.geometry().ok()?;
    // Commands run ahead of the wheels, in every log by its own lag. Sums of what the wheels drove, of what was asked
    // for, of both along and across each other, and their number; only of logs whose wheels follow.
    let of = |s: &Signals, lag: usize| {
        let mut sums = [0.0; 7];
        for (k, c) in s.command.iter().enumerate().filter(|(_, c)| c.iter().all(|x| x.is_finite())) {
            let w: Vec<f64> = s.speed.iter().filter_map(|w| w.get(k + lag).copied()).collect();
            if w.len() == s.speed.len() {
                let p = geometry.twist(&w);
                let (driven, asked) = (p.vx * p.vx + p.vy * p.vy, c[0] * c[0] + c[1] * c[1]);
                let (along, across) = (c[0] * p.vx + c[1] * p.vy, c[1] * p.vx - c[0] * p.vy);
                let turns = [c[2] * p.omega, (c[2] * p.omega).abs()];
                let all = [driven, asked, along, across, 1.0, turns[0], turns[1]];
                sums.iter_mut().zip(all).for_each(|(sum, x)| *sum += x);
            }
        }
        sums
    };
    let follows = |[driven, asked, along, across, ..]: [f64; 7]| {
        f64::hypot(along, across) / f64::sqrt(driven * asked).max(1e-300)
    };
    let best = |s| (0..=LAGS).map(|lag| of(s, lag)).max_by(|a, b| follows(*a).total_cmp(&follows(*b)));
    let logs = signals.iter().filter_map(best).filter(|sums| follows(*sums) >= FOLLOWS);
    let all = logs.fold([0.0; 7], |all, of| std::array::from_fn(|i| all[i] + of[i]));
    let (follows, turn, n) = (follows(all), f64::atan2(all[3], all[2]), all[4] as usize);
    // What wheels that are wired in another order make of a command is no frame: frames are quarter turns.
    let quarter = (turn / std::f64::consts::FRAC_PI_2).round() * std::f64::consts::FRAC_PI_2;
    if n < FEWEST || follows < FOLLOWS || quarter == 0.0 || (turn - quarter).abs() > 0.4 {
        return None;
    }
    // Where turns are the other way round, too, no frame is wrong but what positive speed of a wheel means.
    let back = quarter.abs() > 3.0;
    if back && all[5] < -FOLLOWS * all[6] {
        let [column, sense, remedy] = OTHER_SENSE;
        let what = format!("commands say the opposite of what the wheels drive, ways and turns alike: {sense}");
        return Some(Mistake::new(OTHER_SENSE_KIND, column, what, remedy.to_owned()));
    }
    let what = format!("commands point {:.0} degrees from where the wheels drive", turn.to_degrees());
    let remedy = if back {
        "change the signs of cmd_vx and cmd_vy; or, where commanded turns are the other way round, too, those of all encoders"
    } else if (turn.to_degrees() + 90.0).abs() < 30.0 {
        "they look like x forward, y left (ROS REP-103): here x is to the right and y forward, so write cmd_vx = -y and \
         cmd_vy = x"
    } else {
        "write cmd_vx to the right and cmd_vy forward"
    };
    Some(Mistake::new("command-frame", "cmd_vx", what, remedy.to_owned()))
}
