//! Axes that do not do what they are asked for: that stand still, or turn against what drives them.

use runs::is_from_speeds;
use runs::robot::{Robot, Support};

use super::signals::Signals;
use super::{Mistake, short};

/// Share of the turns asked for by set points up to which an axis stands still: encoders that are not connected count a
/// few edges of noise, and a motor that is on does not stay that far behind.
const STILL: f64 = 0.05;
/// Turns that must have been asked for, rad.
const ASKED: f64 = std::f64::consts::TAU;
/// Balance of the ways with and against a drive, -1 to 1, from which it is the other way round, in all moments and in those in
/// which the axis does not lose speed. A motor that brakes goes against its axis for a part of the time, and of axes that mostly
/// gain and lose speed the first says nothing: right drives had -0.19 to 1.00 (four wheels of `data/real`, the manoeuvres of the
/// example set), ones the other way round -0.59 to -1.00 (a motor between two speeds). What gains speed is driven: right drives of
/// nine recordings had 0.8 to 1.00 there in one of the two ways at least (0.15 under noise that hardly turns a motor), the others
/// -0.69 to -1.00. A weight that is let down slowly goes against its motor there, too, but lifted it does not.
const AGAINST: f64 = -0.4;
const GAINING: f64 = -0.5;
/// Share of an axis's way that it must be driven each way for that.
const EACH_WAY: f64 = 0.1;
/// Moments each way from which anything is said.
const FEWEST: usize = 25;
/// Cosine of duties and what is missing to the set points, from which a wheel that turns against its duties is dragged by the
/// others and braked by its loop. A loop that drives, or brakes, gave 0.67 to 0.83 (four wheels, two of them swapped); signs
/// that are wrong make it negative.
const BRAKED: f64 = 0.5;

/// Axes that stand still though set points ask for turns.
pub(super) fn still(robot: &Robot, signals: &[Signals]) -> Vec<Mistake> {
    let axes = signals.iter().map(|s| s.reference.len().min(s.speed.len())).max().unwrap_or(0);
    let stem = if is_from_speeds(robot) { "speed" } else { "enc" };
    let of = |i: usize| {
        let (mut turned, mut asked) = (0.0, 0.0);
        for s in signals.iter().filter(|s| i < s.reference.len()) {
            let both = s.speed[i].iter().zip(&s.reference[i]).filter(|(w, r)| w.is_finite() && r.is_finite());
            for (speed, reference) in both {
                turned += speed.abs() * s.span_s;
                asked += reference.abs() * s.span_s;
            }
        }
        (asked > ASKED && turned < STILL * asked).then(|| {
            let what = format!(
                "it stands still: set points ask for {} turns, and it counts {}",
                short(asked / std::f64::consts::TAU),
                short(turned / std::f64::consts::TAU)
            );
            let remedy = if stem == "enc" {
                "the encoder was not connected or not read (map speed_ in place of enc_ where speeds are logged), or the motors \
                 were off: leave such logs out"
            } else {
                "the speed was not read, or the motors were off: leave such logs out"
            };
            Mistake::new("axis-still", &format!("{stem}_{}", i + 1), what, remedy.to_owned())
        })
    };
    (0..axes).filter_map(of).collect()
}

/// Cosine of an axis's speeds and set points, -1 to 1, below which it turns the other way than it is asked to: a loop follows
/// its set points or lags behind them, and a lag of a quarter of a period makes 0. Reasoned.
const UNASKED: f64 = -0.8;

/// Axes that turn the other way than their set points ask.
pub(super) fn unasked(robot: &Robot, signals: &[Signals], before: &[Mistake]) -> Vec<Mistake> {
    let axes = signals.iter().map(|s| s.reference.len().min(s.speed.len())).max().unwrap_or(0);
    let counted = if is_from_speeds(robot) { "speed" } else { "enc" };
    let of = |i: usize| {
        let rows =
            signals.iter().filter(|s| i < s.reference.len()).flat_map(|s| s.speed[i].iter().zip(&s.reference[i]));
        (cosine(rows.map(|(speed, reference)| (*speed, *reference))) < UNASKED).then(|| {
            let what = "the axis turns the other way than its set points ask".to_owned();
            let remedy = format!(
                "change the sign of {counted}_{n} (scale = -1 in the map), or that of ref_{n} and what drives it",
                n = i + 1
            );
            Mistake::new("drive-reversed", &format!("{counted}_{}", i + 1), what, remedy)
        })
    };
    let known = |i: &usize| before.iter().any(|m| m.is_reversed(*i));
    (0..axes).filter(|i| !known(i)).filter_map(of).collect()
}

/// Of both ways in which an axis is driven: the way with the drive less that against it, all of the way, moments; the first two
/// of the moments in which it does not lose speed.
type Ways = [[f64; 5]; 2];

/// Axes that turn backwards where they are driven forwards, and forwards where backwards, in all logs or in some.
pub(super) fn against(robot: &Robot, signals: &[Signals], stem: &str) -> Vec<Mistake> {
    let axes = signals.iter().map(|s| s.duty.len().min(s.speed.len())).max().unwrap_or(0);
    let counted = if is_from_speeds(robot) { "speed" } else { "enc" };
    let mistake = |i: usize| {
        let ways: Vec<Ways> = signals.iter().map(|s| ways(s, i)).collect();
        let all = ways.iter().fold([[0.0; 5]; 2], |sum, ways| {
            std::array::from_fn(|way| std::array::from_fn(|k| sum[way][k] + ways[way][k]))
        });
        // Some were wired another way, or logged by another program.
        let dragged = |s: &Signals| robot.support == Support::Floor && robot.wheel_count() > 1 && is_dragged(s, i);
        let against = signals.iter().zip(&ways).filter(|(s, ways)| is_against(ways) && !dragged(s));
        let some: Vec<&str> = against.map(|(s, _)| s.log.as_str()).collect();
        let others = format!("{counted}_{} where that counts the wrong way (scale = -1 in the map)", i + 1);
        let (which, remedy) = if is_against(&all) && !signals.iter().all(dragged) {
            (String::new(), format!("change its sign, or that of {others}"))
        } else if some.is_empty() {
            return None;
        } else {
            let which = format!(", in {} of {} logs ({})", some.len(), signals.len(), some.join(", "));
            (which, format!("convert these by a map with its sign changed, or that of {others}"))
        };
        let what = format!("the axis turns the other way than it drives, both ways{which}");
        Some(Mistake::new("drive-reversed", &format!("{stem}_{}", i + 1), what, remedy))
    };
    (0..axes).filter_map(mistake).collect()
}

fn ways(s: &Signals, axis: usize) -> Ways {
    let mut ways = [[0.0; 5]; 2];
    let Some(duty) = s.duty.get(axis) else { return ways };
    let rows = duty.iter().zip(&s.speed[axis]).zip(&s.acceleration[axis]);
    for ((duty, speed), acceleration) in rows.filter(|((d, w), _)| d.is_finite() && **d != 0.0 && **w != 0.0) {
        let with = speed * duty.signum();
        let gains = f64::from(u8::from(speed * acceleration >= 0.0));
        let moment = [with, with.abs(), 1.0, gains * with, gains * with.abs()];
        ways[usize::from(*duty < 0.0)].iter_mut().zip(moment).for_each(|(sum, x)| *sum += x);
    }
    ways
}

/// Whether duties have the sign of what is missing to the set points.
fn is_dragged(s: &Signals, axis: usize) -> bool {
    let (Some(duty), Some(reference)) = (s.duty.get(axis), s.reference.get(axis)) else { return false };
    let rows = duty.iter().zip(reference).zip(&s.speed[axis]);
    cosine(rows.map(|((duty, reference), speed)| (*duty, reference - speed))) > BRAKED
}

/// Of the rows in which both are there; not a number where one of them is never anything but 0.
fn cosine(rows: impl Iterator<Item = (f64, f64)>) -> f64 {
    let (mut both, mut one, mut other) = (0.0, 0.0, 0.0);
    for (a, b) in rows.filter(|(a, b)| a.is_finite() && b.is_finite()) {
        both += a * b;
        one += a * a;
        other += b * b;
    }
    both / (one * other).sqrt()
}

fn is_against(ways: &Ways) -> bool {
    let way = ways[0][1] + ways[1][1];
    ways.iter().all(|[with, all, n, gaining, gained]| {
        let told = *n >= FEWEST as f64 && *all >= EACH_WAY * way;
        told && *with <= AGAINST * all && *gaining <= GAINING * gained
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A wheel of a robot both ways, in a loop whose gain is 0.1: it turns faster than it is asked to, or is behind by a little.
    fn wheel(speed: f64, asked: f64, sense: f64) -> Signals {
        let of = |value: f64| vec![(0..200).map(|k| if k < 100 { value } else { -value }).collect::<Vec<f64>>(); 3];
        Signals {
            log: "run_1".to_owned(),
            span_s: 0.05,
            speed: of(speed),
            acceleration: of(0.1),
            reference: of(asked),
            duty: of(sense * 0.1 * (asked - speed)),
            command: Vec::new(),
            current: Vec::new(),
            volts: Vec::new(),
            supply: Vec::new(),
        }
    }

    #[test]
    fn a_wheel_that_the_others_drag_is_not_reversed() {
        let robot = Robot::racbot();
        assert!(against(&robot, &[wheel(12.0, 10.0, 1.0)], "duty").is_empty());
        assert_eq!(against(&robot, &[wheel(9.0, 10.0, -1.0)], "duty").len(), 3);
        let some = against(&robot, &[wheel(9.0, 10.0, -1.0), wheel(9.0, 10.0, 1.0), wheel(9.0, 10.0, 1.0)], "duty");
        assert!(some[0].sentence().contains("in 1 of 3 logs"), "{}", some[0].sentence());
    }
}
