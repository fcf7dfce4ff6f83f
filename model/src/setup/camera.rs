//! The camera and the wheels: a free similarity between what both say of the same stretches.
//!
//! With a displacement by the counts as a complex number p and that of the camera, turned into the body by its heading, as
//! b, the best b = c·p has a scale |c| and a turn arg c; a marker at m beside the centre adds m·q, where q is i times the
//! chord of the camera's turn. Turns compare by a factor of their own. The heading is read in radians and degrees, counter-clockwise and clockwise, y up and down, the wheels in every signed order: what fits tells
//! how the log is to be read.

use std::f64::consts::{PI, TAU};

use nalgebra::{Complex, Matrix3, Vector3};
use runs::Log;
use runs::frames::Twist;
use runs::geometry::Geometry;
use runs::robot::{Robot, Support};

use super::orders::{self, moved, orders, words};
use super::samples::{STRETCH_S, Sample, of_camera};
use super::slips::Slips;
use super::{Mistake, OTHER_SENSE, OTHER_SENSE_KIND, TRUE_RATIO, common_ratio, counts, is_true, short};

/// Fewest stretches with motion that tell anything.
const FEWEST: usize = 20;
/// Most stretches of all logs together: with four wheels each is looked at in 3072 ways.
const MOST: usize = 3000;
/// Length of stretches where those of [`STRETCH_S`] fit no reading, s: encoder rates of a robot that a person drove left 84 % of
/// its turns unexplained in 0.15 s, 48 % in 0.4 s, and 20 % in 1 s.
const LONG_S: f64 = 1.0;
/// Share of the camera's motion that a way to read the log may leave more than the best one and still count as equal:
/// skews, slip and lags of the worst robots leave a few hundredths.
const EQUAL: (f64, f64) = (1.6, 0.04);
/// Share of the motion that is left at most where the log is read as it was meant.
const FITS: f64 = 0.35;
/// Share of the motion from which it does not follow from the counts by a factor: of a wrong size of a robot's file 0.002 to 0.01
/// is left, of one whose wheels slipped through most starts 0.32, which had a factor of 1.56.
const BY_FACTOR: f64 = 0.1;
/// Share of the squared way of the wheels below which a robot did not turn, or did nothing else: what a camera's noise or
/// a marker beside the centre then make of the rest says nothing.
const LITTLE: f64 = 0.02;
/// The same of the way that a camera sees of a robot which by the counts only turns: a marker half way to the rim has a
/// fifth, and skewed wheels lead a robot astray that spins.
const ASTRAY: f64 = 0.2;
/// Share of the camera's turn that the best way to read a log leaves at most, from which the robot turned: noise follows
/// no wheels. Orders of the wheels that say it did not turn must then answer for that, too.
const TURNED: f64 = 0.5;
/// Share of the squared turns by the counts that ways do not follow, from which both are told apart.
const ALONG: f64 = 0.2;
/// Distance of a marker from the centre at most, in those of the farthest wheel.
const ARM: f64 = 2.0;
/// Acceleration of a rim that no floor passes on to a robot, m/s²: a coefficient of friction of 1.
const GRAVITY: f64 = 9.81;
/// Moments at which rims must gain more than that. A count that was lost makes one, of up to 25 m/s² in the example set; on
/// the full-duty manoeuvre of the library, whose starts no floor would hold, the third has 10.3 of 11.4 m/s².
const STARTS: usize = 3;
/// How many things are wrong where positive speed turns every wheel the other way than the file says: one sense that was taken
/// for the other, not a cable a wheel. A mirrored camera that is half a turn off, the same on two wheels, is more usual.
const ONE_SENSE: f64 = 1.6;
/// Turn of the body frame that marker plates and skews may have, rad.
const TRUE_TURN: f64 = 0.6;

/// What wheels that are the robot's mirror image may be as well.
const MIRRORED: &str = "; or, which looks the same, the poses are mirrored: y points to the other side and headings grow clockwise, \
                        in a map [frame] y = \"down\" with headings = \"clockwise\"";

/// How the columns of the camera are read.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct Reading {
    degrees: bool,
    clockwise: bool,
    down: bool,
    /// Ways of the wheels are along the field's axes, as a driver has them who drives by those.
    field: bool,
}

/// A way to read a data set, and how well camera and wheels then agree.
struct Fit {
    reading: Reading,
    order: Vec<(usize, f64)>,
    /// Camera's displacement per displacement by the counts: scale and turn, rad.
    scale: f64,
    turn: f64,
    /// Relative standard error of that scale.
    error: f64,
    /// Whether the robot turns, by the counts, and by the camera; and whether it goes anywhere.
    turns: bool,
    seen_to_turn: bool,
    goes: bool,
    /// Share of the motion that is left.
    left: f64,
    /// The same of the way alone, and of the turn alone.
    left_way: f64,
    left_turn: f64,
    /// How many things would have to be wrong.
    wrong: f64,
}

pub(super) fn mistakes(robot: &Robot, logs: &[Log], before: &[Mistake]) -> Vec<Mistake> {
    let found = of_all(robot, logs, before);
    // A wrong order of the wheels, say, may look like such a mistake in a log that does not turn enough.
    let frames = |m: &Mistake| of_frames(m) || m.kind == "robot-file";
    if found.is_empty() || logs.len() < 2 || !found.iter().all(frames) {
        return found;
    }
    let some = of_some(robot, logs, before);
    if some.is_empty() { found } else { some }
}

/// What the camera's frame is wrong by in some logs where others that show it are right: one file of a session that was
/// recorded, or converted, otherwise.
fn of_some(robot: &Robot, logs: &[Log], before: &[Mistake]) -> Vec<Mistake> {
    let Some(geometry) = robot.geometry().ok().filter(|_| robot.support == Support::Floor) else { return Vec::new() };
    let own = logs.iter().filter_map(|log| {
        let seen = thinned(moving(robot, std::slice::from_ref(log), STRETCH_S)?);
        let fit = best(robot, &geometry, &seen).filter(|fit| fit.goes && fit.left <= FITS)?;
        let wrong = named(robot, &fit, spin(&geometry, &seen, &fit), before);
        Some((log.name.as_str(), wrong))
    });
    let own: Vec<(&str, Vec<Mistake>)> = own.collect();
    if own.iter().all(|(_, wrong)| !wrong.is_empty()) || own.iter().any(|(_, wrong)| !wrong.iter().all(of_frames)) {
        return Vec::new();
    }
    let mut told: Vec<(Mistake, Vec<&str>)> = Vec::new();
    for (name, mistake) in own.iter().flat_map(|(name, wrong)| wrong.iter().map(move |m| (*name, m))) {
        match told.iter_mut().find(|(other, _)| other.kind == mistake.kind) {
            Some((_, names)) => names.push(name),
            None => told.push((mistake.clone(), vec![name])),
        }
    }
    let count = own.len();
    let named = |(mistake, names): (Mistake, Vec<&str>)| {
        let what = format!("in {} ({} of {count} logs that show it) {}", names.join(", "), names.len(), mistake.what);
        Mistake { what, ..mistake }
    };
    told.into_iter().map(named).collect()
}

/// Whether a mistake is one of how the camera's poses are to be read.
fn of_frames(mistake: &Mistake) -> bool {
    ["heading-axis", "heading-degrees", "heading-clockwise", "camera-y-down", "camera-unit"].contains(&mistake.kind)
}

fn of_all(robot: &Robot, logs: &[Log], before: &[Mistake]) -> Vec<Mistake> {
    let Some(geometry) = robot.geometry().ok().filter(|_| robot.support == Support::Floor) else { return Vec::new() };
    let Some(moving) = moving(robot, logs, STRETCH_S) else { return Vec::new() };
    let gained = robot.wheel_radius_m * gained(&moving);
    let mut seen = thinned(moving);
    let mut found = best(robot, &geometry, &seen);
    // What noise of speeds or slip hides in short stretches, long ones may show.
    if found.as_ref().is_some_and(|fit| fit.left > FITS)
        && let Some(long) = self::moving(robot, logs, LONG_S).map(thinned)
        && let Some(fit) = best(robot, &geometry, &long).filter(|fit| fit.left <= FITS)
    {
        (seen, found) = (long, Some(fit));
    }
    let as_read = bodies(&seen, Reading::default());
    let fitted = |fit: &Fit| fit.left <= FITS && named(robot, fit, spin(&geometry, &seen, fit), before).is_empty();
    if !runs::is_dead_reckoning(robot) && !found.as_ref().is_some_and(fitted) {
        let counts = counts::of_single_wheels(robot, &geometry, &seen, &as_read);
        if !counts.is_empty() {
            return counts;
        }
    }
    let slips = found
        .as_ref()
        .filter(|fit| fit.left > FITS)
        .and_then(|fit| Some((Slips::of(&geometry, rim(&geometry), &seen, &as_read)?, fit.left)));
    if let Some((slips, left)) = slips {
        let (what, remedy) = slips.said(left);
        return vec![Mistake { nameable: true, ..Mistake::new("wheels-slip", "cam_x", what, remedy) }];
    }
    if let Some([least, most]) = found.as_ref().and_then(|fit| uneven(robot, &geometry, logs, fit)) {
        let (least, most) = (short(1.0 / most), short(1.0 / least));
        let what = format!(
            "the wheels turn {least} to {most} times as far as the camera sees the robot go, in each log another part, which no \
             factor in the file does: the wheels slip, as on a soft floor, or the logs are of several robots"
        );
        let remedy = "drive on a floor that holds, and give robots and floors a data set of their own";
        return vec![Mistake::new("wheels-slip", "cam_x", what, remedy.to_owned())];
    }
    let mut mistakes = found.map_or_else(Vec::new, |fit| named(robot, &fit, spin(&geometry, &seen, &fit), before));
    if gained > GRAVITY {
        // No slip turns ways round, or makes them a thousand times as long.
        for mistake in
            mistakes.iter_mut().filter(|m| !["heading-axis", "camera-unit", OTHER_SENSE_KIND].contains(&m.kind))
        {
            mistake.what += &format!(", or wheels slip: rims gain {} m/s², more than a floor holds", short(gained));
            mistake.nameable = true;
        }
    }
    mistakes
}

/// The least and the greatest of the scales that single logs have, each within its error, where wheels turn farther than the
/// robot goes and these are farther apart than scales of one robot: a diameter for a radius is the same in every log. On a
/// table twelve directions of one robot have 0.854 to 0.869 of what its wheels turn, on a soft floor 0.22 to 0.56.
fn uneven(robot: &Robot, geometry: &Geometry, logs: &[Log], all: &Fit) -> Option<[f64; 2]> {
    if all.left > FITS || is_true(all.scale) || all.scale > 1.0 || runs::is_dead_reckoning(robot) {
        return None;
    }
    let own = |log: &Log| {
        let samples = thinned(moving(robot, std::slice::from_ref(log), STRETCH_S)?);
        let seen = bodies(&samples, all.reading);
        let own = fit(geometry, rim(geometry), &samples, &seen, all.reading, all.order.clone());
        (own.goes && own.left_way <= FITS && own.scale < TRUE_RATIO).then_some(own)
    };
    let fits: Vec<Fit> = logs.iter().filter_map(own).collect();
    let least = fits.iter().map(|f| f.scale * (1.0 + 2.0 * f.error)).fold(f64::INFINITY, f64::min);
    let most = fits.iter().map(|f| f.scale * (1.0 - 2.0 * f.error)).fold(0.0, f64::max);
    (fits.len() > 2 && 2 * fits.len() >= logs.len() && most > TRUE_RATIO * least).then_some([least, most])
}

/// Distance of the outermost wheel from the centre, m.
fn rim(geometry: &Geometry) -> f64 {
    geometry.wheels().iter().map(|w| w.x_m.hypot(w.y_m)).fold(0.0, f64::max).max(1e-6)
}

/// Stretches of so many seconds in which the robot moves; `None` if they are too few to tell anything.
fn moving(robot: &Robot, logs: &[Log], stretch_s: f64) -> Option<Vec<Sample>> {
    let samples: Vec<Sample> = logs.iter().flat_map(|log| of_camera(robot, log, stretch_s)).collect();
    let most = |s: &Sample| s.turned.iter().map(|a| a.abs()).fold(0.0, f64::max);
    let mut ways: Vec<f64> = samples.iter().map(most).collect();
    ways.sort_by(f64::total_cmp);
    let usual = ways.get(ways.len() * 9 / 10).copied().unwrap_or(0.0);
    let moving: Vec<Sample> = samples.into_iter().filter(|s| most(s) > 0.2 * usual.max(1e-9)).collect();
    (moving.len() >= FEWEST).then_some(moving)
}

/// As many of them as are looked at.
fn thinned(samples: Vec<Sample>) -> Vec<Sample> {
    let every = samples.len().div_ceil(MOST);
    samples.into_iter().step_by(every).collect()
}

/// The way to read the logs that explains them as well as any, with the fewest things wrong.
fn best(robot: &Robot, geometry: &Geometry, moving: &[Sample]) -> Option<Fit> {
    let rim = rim(geometry);
    // Dead reckoning has no wheels that could be in another order.
    let mut orders = orders(robot.wheel_count());
    orders.truncate(if runs::is_dead_reckoning(robot) { 1 } else { orders.len() });
    let mut fits = Vec::new();
    for degrees in [false, true] {
        for (clockwise, down) in [(false, false), (true, false), (false, true), (true, true)] {
            let reading = Reading { degrees, clockwise, down, field: false };
            let seen = bodies(moving, reading);
            for order in &orders {
                fits.push(fit(geometry, rim, moving, &seen, reading, order.clone()));
            }
        }
    }
    if robot.wheel_count() > 2 || runs::is_dead_reckoning(robot) {
        let reading = Reading { field: true, ..Reading::default() };
        let seen = bodies(moving, reading);
        fits.push(fit(geometry, rim, moving, &seen, reading, orders.swap_remove(0)));
    }
    let turns_tell = fits.iter().any(|f| f.turns && f.seen_to_turn && f.left_turn < TURNED);
    if turns_tell {
        for f in fits.iter_mut().filter(|f| !f.turns) {
            f.left = 0.5 * (f.left + f.left_turn);
        }
    }
    // Turns that follow no reading are noise, which says nothing against one by which the robot turned.
    let told = |f: &Fit| if turns_tell || !f.goes { f.left } else { f.left.min(f.left_way) };
    let least = |of: &dyn Fn(&Fit) -> f64| fits.iter().map(of).fold(f64::INFINITY, f64::min);
    let (best, best_way) = (least(&told), least(&|f| f.left_way));
    // Noisy turns do not excuse a way that another reading leaves nothing of.
    let as_good = |left: f64, best: f64| left <= EQUAL.0 * best + EQUAL.1;
    let equal = |f: &Fit| as_good(told(f), best) && as_good(f.left_way, best_way);
    fits.into_iter().filter(equal).min_by(|a, b| (a.wrong + told(a)).total_cmp(&(b.wrong + told(b))))
}

/// The acceleration of a rim that logs have several times, rad/s²: the least of the [`STARTS`] greatest that are farther apart
/// than what one count changes.
fn gained(samples: &[Sample]) -> f64 {
    let mut sorted: Vec<&Sample> = samples.iter().collect();
    sorted.sort_by(|a, b| b.acceleration.total_cmp(&a.acceleration));
    let mut starts: Vec<&Sample> = Vec::new();
    for sample in sorted {
        if starts.len() == STARTS {
            break;
        }
        if starts.iter().all(|start| (start.t - sample.t).abs() > 3.0 * STRETCH_S) {
            starts.push(sample);
        }
    }
    starts.get(STARTS - 1).map_or(0.0, |sample| sample.acceleration)
}

/// Displacement in the body, or in the field where the wheels' ways are along that, and turn, by the camera.
fn body(s: &Sample, reading: Reading) -> ([f64; 2], f64) {
    let unit = if reading.degrees { PI / 180.0 } else { 1.0 };
    let sign = if reading.clockwise { -1.0 } else { 1.0 };
    let (from, to) = (sign * unit * s.from.theta, sign * unit * s.to.theta);
    let turn = (to - from + PI).rem_euclid(TAU) - PI;
    let (dx, dy) = (s.to.x - s.from.x, if reading.down { s.from.y - s.to.y } else { s.to.y - s.from.y });
    let (sin, cos) = if reading.field { (0.0, 1.0) } else { (from + 0.5 * turn).sin_cos() };
    ([cos * dx + sin * dy, cos * dy - sin * dx], turn)
}

fn bodies(samples: &[Sample], reading: Reading) -> Vec<([f64; 2], f64)> {
    samples.iter().map(|s| body(s, reading)).collect()
}

fn fit(
    geometry: &Geometry,
    rim: f64,
    samples: &[Sample],
    seen: &[([f64; 2], f64)],
    reading: Reading,
    order: Vec<(usize, f64)>,
) -> Fit {
    let (mut pp, mut pb, mut bb) = (0.0_f64, Complex::<f64>::ZERO, 0.0_f64);
    let (mut qq, mut pq, mut qb) = (0.0_f64, Complex::<f64>::ZERO, Complex::<f64>::ZERO);
    let (mut ww, mut wt, mut tt) = (0.0_f64, 0.0_f64, 0.0_f64);
    let mut turned = vec![0.0; order.len()];
    for (s, ([bx, by], turn)) in samples.iter().zip(seen) {
        let p = by_counts(geometry, &order, s, &mut turned);
        let (way, b) = (Complex::new(p.vx, p.vy), Complex::new(*bx, *by));
        let q = Complex::new(0.0, 2.0 * (0.5 * turn).sin());
        pp += way.norm_sqr();
        pb += way.conj() * b;
        bb += b.norm_sqr();
        qq += q.norm_sqr();
        pq += way.conj() * q;
        qb += q.conj() * b;
        ww += p.omega * p.omega;
        wt += p.omega * turn;
        tt += turn * turn;
    }
    // Along one curve ways and turns are one, and a marker stays unknown.
    let own = pp * qq - pq.norm_sqr();
    let marker = if own > ALONG * pp * qq { (qb * pp - pq.conj() * pb) / own } else { Complex::ZERO };
    let marker = if marker.norm() < ARM * rim { marker } else { Complex::ZERO };
    // What the marker leaves of the camera's ways.
    let (bb, pb) = (bb - 2.0 * (marker.conj() * qb).re + marker.norm_sqr() * qq, pb - marker * pq);
    let left_t = if bb > 0.0 { 1.0 - pb.norm_sqr() / (pp * bb).max(1e-300) } else { 1.0 };
    let scale = pb.norm() / pp.max(1e-300);
    let error = (left_t.max(0.0) / (1.0 - left_t).max(1e-9) / (2.0 * samples.len() as f64)).sqrt();
    // A turn must be positive: a negative one is another reading.
    let left_r = if tt > 0.0 { 1.0 - wt.max(0.0).powi(2) / (ww * tt).max(1e-300) } else { 1.0 };
    // Lengths by the counts say how much of the motion is a turn.
    let share = |of: f64, other: f64| of / (of + other).max(1e-300);
    let (turned_rim, seen_rim) = (rim * rim * ww, rim * rim * tt);
    let turns = share(turned_rim, pp) > LITTLE;
    let seen_to_turn = share(seen_rim, bb) > LITTLE;
    // Ways in another unit may be tiny beside the turns, and yet follow those by the counts.
    let drives = share(pp, turned_rim) > LITTLE;
    let goes = share(bb, seen_rim) > if drives { LITTLE } else { ASTRAY } || drives && left_t < FITS;
    let left = match (goes, turns) {
        (true, true) => 0.5 * (left_t + left_r),
        (false, true) => left_r,
        (_, false) => left_t,
    };
    let image = reading.clockwise && reading.down;
    let camera = if image { 1.0 } else { f64::from(u8::from(reading.clockwise)) + f64::from(u8::from(reading.down)) };
    let only_turns = turns && !goes;
    let (scale, turn) = if only_turns { (wt / ww.max(1e-300), 0.0) } else { (scale, pb.arg()) };
    let quarter = if turn.abs() > TRUE_TURN { 0.5 } else { 0.0 };
    let swapped = order.iter().enumerate().filter(|(i, (w, _))| w != i).count() as f64;
    let reversed = order.iter().filter(|(_, sign)| *sign < 0.0).count() as f64;
    let reversed = if orders::all_reversed(&order) { ONE_SENSE } else { 1.2 * reversed };
    let wrong = camera
        + f64::from(u8::from(reading.degrees))
        + f64::from(u8::from(reading.field))
        + quarter
        + 0.6 * swapped
        + reversed;
    Fit {
        reading,
        order,
        scale,
        turn,
        error,
        turns,
        seen_to_turn,
        goes,
        left,
        left_way: left_t,
        left_turn: left_r,
        wrong,
    }
}

/// Displacement by the counts, the wheels in some order; `turned` is room for their turns.
fn by_counts(geometry: &Geometry, order: &[(usize, f64)], s: &Sample, turned: &mut [f64]) -> Twist {
    for (i, (wheel, sign)) in order.iter().enumerate() {
        turned[*wheel] = sign * s.turned[i];
    }
    geometry.twist(turned)
}

/// Camera's turn per turn by the counts beside what skewed wheels make of ways: true turns are a linear function of turns
/// and ways by the counts. `None` where a robot hardly turns, or drives one curve, along which turns and ways are one.
fn spin(geometry: &Geometry, samples: &[Sample], fit: &Fit) -> Option<f64> {
    if !fit.turns {
        return None;
    }
    if !fit.goes {
        return Some(fit.scale);
    }
    let (mut information, mut score) = (Matrix3::zeros(), Vector3::zeros());
    let mut turned = vec![0.0; fit.order.len()];
    for s in samples {
        let p = by_counts(geometry, &fit.order, s, &mut turned);
        let row = Vector3::new(p.omega, p.vx, p.vy);
        information += row * row.transpose();
        score += row * body(s, fit.reading).1;
    }
    let unit = information.diagonal().map(|x| x.sqrt().max(1e-300));
    let scaled = information.component_div(&(unit * unit.transpose()));
    // A direction without motion, such as sideways on two wheels, asks for nothing.
    let inverse = (scaled + Matrix3::identity() * 1e-9).try_inverse()?;
    let own = 1.0 / inverse[(0, 0)];
    let solved = inverse * score.component_div(&unit);
    (own > ALONG).then(|| solved[0] / unit[0])
}

fn named(robot: &Robot, fit: &Fit, spin: Option<f64>, before: &[Mistake]) -> Vec<Mistake> {
    let mut found = Vec::new();
    let new = |kind, column: &str, what: String, remedy: &str| Mistake::new(kind, column, what, remedy.to_owned());
    if fit.left > FITS {
        let what = format!(
            "however it is read, {:.0} % of what the camera saw does not follow from the counts: the robot.toml of another \
             robot, or wheels and camera of different drives",
            100.0 * fit.left
        );
        return vec![new(
            "robot-file",
            "robot.toml",
            what,
            "take the file of the robot that drove; check [[wheel]] against it (wheels that steer are none of its robots)",
        )];
    }
    if fit.reading.field {
        let what =
            "the ways by the counts point along the field's axes, not the robot's: velocities that were commanded, or \
                    reckoned, in the field's frame"
                .to_owned();
        let remedy = "turn them into the robot's frame by its heading before they become wheel speeds or an odometry";
        return vec![new("command-frame", "cmd_vx", what, remedy)];
    }
    if fit.reading.degrees {
        let what = "headings follow the wheels only as degrees".to_owned();
        found.push(new(
            "heading-degrees",
            "cam_theta",
            what,
            "write radians (times 0.0174533), or name the unit to `racbot convert`",
        ));
    }
    // Those of the forward axis that were turned to the x axis as if they grew the other way are half a turn off as well.
    let half_a_turn = PI - fit.turn.abs() < TRUE_TURN && fit.reading.clockwise && !fit.reading.down;
    match (fit.reading.clockwise, fit.reading.down) {
        (true, false) => {
            let what = "headings grow clockwise".to_owned();
            let remedy = if half_a_turn {
                "write them counter-clockwise: in a map of `racbot convert` [frame] or [truth.frame] headings = \"clockwise\"; \
                 else change their sign and add half a turn"
            } else {
                "write them counter-clockwise: change their sign"
            };
            found.push(new("heading-clockwise", "cam_theta", what, remedy));
        }
        (down_too, true) => {
            let what = if down_too {
                "the camera sees the drive mirrored: y grows downwards, as in an image, and headings clockwise"
            } else {
                "y grows downwards, as in an image"
            };
            let remedy = if down_too { "change the signs of cam_y and cam_theta" } else { "change the sign of cam_y" };
            found.push(new("camera-y-down", "cam_y", what.to_owned(), remedy));
        }
        _ => {}
    }
    let changed = moved(&fit.order);
    let counts_alone = (0..fit.order.len())
        .all(|i| fit.order[i].0 == i && before.iter().any(|m| m.is_reversed(i)) == changed.contains(&i));
    if orders::all_reversed(&fit.order) && !counts_alone {
        // Where commands say so, too, it is told already.
        let told = before.iter().any(|m| m.kind == OTHER_SENSE_KIND);
        found.extend((!told).then(|| {
            let what = format!("camera and wheels say the opposite, ways and turns alike: {}", OTHER_SENSE[1]);
            new(OTHER_SENSE_KIND, OTHER_SENSE[0], what, OTHER_SENSE[2])
        }));
    } else if !changed.is_empty() {
        let what = format!("camera and counts agree only if {}", words(&fit.order));
        let column = format!("enc_{}", changed[0] + 1);
        // A wheel that is driven and counted the other way is a matter of cables, which has a name; counts alone are not.
        if counts_alone {
            let what = format!("{what}, against what drives it");
            let remedy = "change the sign of these counts alone (scale = -1 in the map)";
            found.push(new("encoder-order", &column, what, remedy));
        } else {
            let mut remedy = "mend the wiring, the columns of the log or the order of [[wheel]]".to_owned();
            if robot.geometry().is_ok_and(|geometry| orders::mirrors(&geometry, &fit.order)) {
                remedy += MIRRORED;
            }
            found.push(Mistake { nameable: true, ..new("encoder-order", &column, what, &remedy) });
        }
    }
    if fit.turn.abs() > TRUE_TURN && !half_a_turn {
        let what = format!(
            "the camera's heading is {:.0} degrees from that of the body's x axis, which points to the right",
            -fit.turn.to_degrees()
        );
        let remedy = format!(
            "write the heading of the x axis (that of the forward axis less 90 degrees; in a map of `racbot convert` [frame] \
             or [truth.frame] x = \"forward\" or \"right\", or offset = {:.3} of cam_theta), or, where [[wheel]] has x \
             forward, write x_m = -y, y_m = x and drive_rad + pi/2",
            fit.turn
        );
        found.push(new("heading-axis", "cam_theta", what, &remedy));
    }
    let spin = spin.unwrap_or(fit.scale);
    let told = |kinds: &[&str]| before.iter().any(|m| kinds.contains(&m.kind));
    let distances = ["wheel-diameter", "encoder-counts", "gear-ratio", "speed-unit"];
    // Where distances by the counts are wrong, too, turns tell how far.
    let own = if is_true(spin) { 1.0 } else { spin.clamp(0.05, 20.0) };
    let unit = [(1000.0, "millimetres"), (100.0, "centimetres")];
    // A unit taken for the next one, where the turns are right.
    let taken =
        [(10.0, "centimetres that were taken for millimetres"), (0.1, "millimetres that were taken for centimetres")];
    if let Some((by, which)) = taken.into_iter().find(|(by, _)| is_true(fit.scale * by) && is_true(spin)) {
        let what = format!("the camera's distances are {} times those of the counts: {which}", short(fit.scale));
        let remedy = format!("write metres (multiply cam_x and cam_y by {by}), or name their unit to `racbot convert`");
        found.push(Mistake::new("camera-unit", "cam_x", what, remedy));
        return found;
    }
    let twice = unit.iter().find(|(u, _)| is_true(fit.scale * u / own));
    if let Some((unit, name)) = twice.filter(|_| is_true(spin)) {
        let what = format!(
            "the camera's distances are {} times those of the counts: metres that were taken for {name}",
            short(fit.scale)
        );
        let remedy =
            format!("write cam_x and cam_y as they were logged (multiply them by {unit}), whatever their header says");
        found.push(Mistake::new("camera-unit", "cam_x", what, remedy));
    } else if let Some((unit, name)) = unit.iter().find(|(u, _)| is_true(fit.scale / (own * u))) {
        let what = format!("the camera's distances are {} times those of the counts: {name}", short(fit.scale));
        let remedy = format!("write metres (divide cam_x and cam_y by {unit}), or name the unit to `racbot convert`");
        found.push(Mistake::new("camera-unit", "cam_x", what, remedy));
    } else if !is_true(fit.scale) || !is_true(spin) {
        let common = (fit.scale / spin).ln().abs() < 0.25;
        match common_ratio(robot, fit.scale).filter(|_| common) {
            Some(_) if told(&distances) => {}
            Some(mistake) => found.push(or_slip(robot, fit, mistake)),
            None if is_true(fit.scale) => found.push(of_turns(robot, spin)),
            None if common => found.push(or_slip(robot, fit, of_all_distances(robot, fit))),
            None => {
                let what = format!(
                    "the camera sees {} times the distance and {} times the turn that the counts say: the robot.toml of \
                     another robot?",
                    short(fit.scale),
                    short(spin)
                );
                let remedy = match (runs::is_dead_reckoning(robot), runs::is_from_speeds(robot)) {
                    (true, _) => ODOMETRY,
                    (_, true) => "check wheel_radius_m and the unit of the speeds",
                    _ => "check wheel_radius_m, gear_ratio and encoder_counts_per_motor_rev",
                };
                found.push(new("robot-file", "robot.toml", what, remedy));
            }
        }
    }
    found
}

/// A common factor of all distances, of which no factor makes what the camera saw where wheels slip.
fn or_slip(robot: &Robot, fit: &Fit, mut mistake: Mistake) -> Mistake {
    if fit.left > BY_FACTOR && !runs::is_dead_reckoning(robot) {
        let left = 100.0 * fit.left;
        mistake.what += &format!(", or wheels slip: no factor makes {left:.0} % of what the camera saw of the counts");
        mistake.nameable = true;
    }
    mistake
}

/// What to look at where dead reckoning is off as a whole.
const ODOMETRY: &str = "check the units of odom_x, odom_y and odom_theta";

/// Turns alone that are wrong by a factor: the wheels act as if they stood elsewhere.
fn of_turns(robot: &Robot, spin: f64) -> Mistake {
    let what = format!("the robot turns {} times as far as the counts say, but drives as far", short(spin));
    if runs::is_dead_reckoning(robot) {
        return Mistake::new("robot-file", "odom_theta", what, ODOMETRY.to_owned());
    }
    let track = robot.geometry().ok().filter(Geometry::is_differential).map(|geometry| {
        let levers = || geometry.wheels().iter().map(|w| w.traction_row()[2]);
        levers().fold(f64::NEG_INFINITY, f64::max) - levers().fold(f64::INFINITY, f64::min)
    });
    let Some(track) = track else {
        let remedy = format!(
            "check the distances of the wheels from the centre (a diameter?): these turns are of {} times what stands there",
            short(1.0 / spin)
        );
        return Mistake::new("robot-file", "[[wheel]]", what, remedy);
    };
    let acts = short(track / spin);
    let what = format!("{what}: a track of {} m acts as one of {acts} m", short(track));
    let dragged = if spin < 1.0 {
        "; tyres that are dragged sideways in a turn, as those of a skid-steered robot, act wider apart than they stand: write the \
         track that acts"
    } else {
        ""
    };
    let remedy =
        format!("measure the track, and write x_m and y_m of every [[wheel]] for {acts} m if that is it{dragged}");
    Mistake::new("robot-file", "[[wheel]]", what, remedy)
}

/// Ways and turns by the counts that are wrong by one factor which is that of no mistake made often.
fn of_all_distances(robot: &Robot, fit: &Fit) -> Mistake {
    let (factor, size) = if fit.scale > 1.0 { (fit.scale, "short") } else { (1.0 / fit.scale, "long") };
    let what = format!(
        "all distances and turns by the counts are {} times too {size} (95 %: {} to {})",
        short(factor),
        short(factor * (1.0 - 2.0 * fit.error)),
        short(factor * (1.0 + 2.0 * fit.error)),
    );
    let radius = short(robot.wheel_radius_m * fit.scale);
    let remedy = if runs::is_dead_reckoning(robot) {
        ODOMETRY.to_owned()
    } else if runs::is_from_speeds(robot) {
        format!(
            "measure a wheel, and write wheel_radius_m = {radius} if that is its radius; else the speeds are of another \
             shaft or unit: multiply them by {}",
            short(fit.scale)
        )
    } else {
        format!(
            "measure a wheel, and write wheel_radius_m = {radius} if that is its radius; else gear_ratio = {} or \
             encoder_counts_per_motor_rev = {}",
            short(robot.gear_ratio / fit.scale),
            short(robot.encoder_counts_per_motor_rev / fit.scale),
        )
    };
    Mistake::new("robot-file", "robot.toml", what, remedy)
}
