//! Where the model and the data part, in words.

use crate::exact::ExactLink;
use crate::units;
use estimation::statistics::rms;
use links::drive::{DriveLink, DriveResiduals};
use links::effect::Link;
use links::inertial::Fit;
use links::motion::{MotionLink, WindowResiduals};

/// Where the model and the data part.
#[derive(Debug, Clone, PartialEq)]
pub struct Located {
    /// Where the disagreement shows.
    pub link: Link,
    /// Signal, such as `enc_3`.
    pub signal: String,
    /// RMS residual in units of the noise floor.
    pub excess: f64,
    /// In words.
    pub place: String,
}

/// Signals whose residual is below this many floors are not listed.
const WORTH: f64 = 1.3;

/// The motion link: x, y and heading.
pub(crate) fn motion(link: &MotionLink, windows: &[WindowResiduals]) -> Vec<Located> {
    let names = ["cam_x", "cam_y", "cam_theta"];
    let units = [("mm", 1e3), ("mm", 1e3), ("degrees", 57.295_779_5)];
    (0..link.axes())
        .filter_map(|i| {
            let used = |w: &WindowResiduals| {
                w.residuals.iter().zip(&w.weights).filter(|(_, w)| **w > 0.0).map(|(r, _)| r[i]).collect::<Vec<_>>()
            };
            let excess = rms(windows.iter().flat_map(used));
            let per_window: Vec<f64> = windows.iter().map(|w| rms(used(w))).collect();
            let bad = per_window.iter().filter(|r| **r > 1.5).count();
            let worst = windows.iter().zip(&per_window).max_by(|a, b| a.1.total_cmp(b.1))?;
            let place = format!(
                "{} is off by {:.2} {} (noise {:.2}) in {bad} of {} windows of {:.0} s, most in run {} at {:.1} s",
                names[i],
                excess * link.unit()[i] * units[i].1,
                units[i].0,
                link.unit()[i] * units[i].1,
                windows.len(),
                link.window_s,
                worst.0.run + 1,
                worst.0.t[0]
            );
            (excess > WORTH).then(|| Located { link: Link::Motion, signal: names[i].to_owned(), excess, place })
        })
        .collect()
}

/// The links to the inertial sensor: each axis.
pub(crate) fn inertial(fits: &[Fit]) -> Vec<Located> {
    let of = |f: &Fit| {
        let (run, t, worst) = f.worst;
        let place = format!(
            "{} is off by {:.4} {} (floor {:.4}), most in run {} at {t:.1} s ({worst:.1} floors)",
            f.channel.column(),
            f.rms,
            f.channel.unit(),
            f.floor,
            run + 1
        );
        Located { link: f.channel.link(), signal: f.channel.column().to_owned(), excess: f.floors, place }
    };
    fits.iter().filter(|f| f.floors > WORTH).map(of).collect()
}

/// The drive link: each wheel, by direction, speed and time. `unit` is the torque of a unit of what drives the motors, Nm at the
/// wheel shaft, its unit and its name.
pub(crate) fn drive(
    link: &DriveLink,
    residuals: &DriveResiduals,
    floor: &[f64],
    (unit_nm, unit, driven): (f64, &str, &str),
) -> Vec<Located> {
    let speeds = link.means(floor.len(), |s, k, out| out.iter_mut().zip(&s.speed).for_each(|(x, w)| *x = w[k]));
    (0..floor.len())
        .filter_map(|i| {
            let speed = &speeds[i];
            let used: Vec<(usize, f64)> =
                residuals.torque.iter().enumerate().filter(|(b, _)| residuals.weights[*b][i] > 0.0).map(|(b, t)| (b, t[i])).collect();
            let excess = rms(used.iter().map(|u| u.1)) / floor[i];
            if used.is_empty() || excess < WORTH {
                return None;
            }
            let mean = |keep: &dyn Fn(usize) -> bool| {
                let part: Vec<f64> = used.iter().filter(|(b, _)| keep(*b)).map(|(_, t)| *t).collect();
                if part.is_empty() { 0.0 } else { 1e3 * part.iter().sum::<f64>() / part.len() as f64 }
            };
            let (ahead, back) = (mean(&|b| speed[b] > 0.0), mean(&|b| speed[b] < 0.0));
            let mut fast: Vec<f64> = used.iter().map(|(b, _)| speed[*b].abs()).collect();
            let middle = estimation::statistics::median(&mut fast);
            let along = |keep: &dyn Fn(usize) -> bool| {
                let part: Vec<f64> = used.iter().filter(|(b, _)| keep(*b)).map(|(b, t)| t * speed[*b].signum()).collect();
                if part.is_empty() { 0.0 } else { 1e3 * part.iter().sum::<f64>() / part.len() as f64 }
            };
            let (slow_part, fast_part) = (along(&|b| speed[b].abs() < middle), along(&|b| speed[b].abs() >= middle));
            let half = used.len() / 2;
            let (early, late) = (along(&|b| b < used[half].0), along(&|b| b >= used[half].0));
            let which = directions([ahead, back], floor[i] * 500.0);
            let against = -along(&|_| true) * 1e-3;
            // Against the rotation by most of it: that much more duty is needed.
            let place = if against.abs() > 0.4 * excess * floor[i] {
                let more = if against > 0.0 { "more" } else { "less" };
                let when = match (early.abs(), late.abs()) {
                    (e, l) if l > 2.0 * e => "mostly late in the runs",
                    (e, l) if e > 2.0 * l => "mostly early in the runs",
                    _ => "from the start",
                };
                let speeds = match (slow_part.abs(), fast_part.abs()) {
                    (s, f) if f > 1.7 * s => ", growing with speed",
                    (s, f) if s > 1.7 * f => ", most when slow",
                    _ => "",
                };
                format!(
                    "the drive of wheel {} needs {}{} {more} {driven} than the model ({} of friction), {which}, {when}{speeds}",
                    i + 1,
                    units::short(against.abs() / unit_nm),
                    if unit.is_empty() { String::new() } else { format!(" {unit}") },
                    units::torque(against)
                )
            } else {
                format!(
                    "the drive of wheel {} is off by {} RMS (floor {}), {which}: {} forwards, {} backwards",
                    i + 1,
                    units::torque(excess * floor[i]),
                    units::torque(floor[i]),
                    units::torque(1e-3 * ahead),
                    units::torque(1e-3 * back)
                )
            };
            Some(Located { link: Link::Drive, signal: format!("enc_{}", i + 1), excess, place })
        })
        .collect()
}

/// Where a drive is off by more than `least`, by its means forwards and backwards, mNm.
fn directions(means: [f64; 2], least: f64) -> &'static str {
    match means.map(|mean| mean.abs() > least) {
        [true, true] if means[0] * means[1] > 0.0 => "one way, wherever it turns",
        [true, true] => "in both directions",
        [true, false] => "turning forwards only",
        [false, true] => "turning backwards only",
        [false, false] => "in no direction alone",
    }
}

/// A deterministic link.
pub(crate) fn exact(link: &ExactLink) -> Vec<Located> {
    let signal = |i: usize| match link.link {
        Link::Timing => "t".to_owned(),
        Link::Command => format!("ref_{}", i + 1),
        _ => format!("duty_{}", i + 1),
    };
    if link.finding.is_none() && !link.unexplained {
        return Vec::new();
    }
    link.before
        .iter()
        .enumerate()
        .filter(|(_, e)| **e > 0.0)
        .map(|(i, e)| Located {
            link: link.link,
            signal: signal(i),
            excess: 1.0 + e / link.floor,
            place: format!("{} differs by {e:.4} {} RMS beyond rounding", signal(i), link.unit),
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_say_where_a_drive_is_off() {
        for (means, wanted) in [
            ([-51.4, -50.6], "one way, wherever it turns"),
            ([-20.0, 18.0], "in both directions"),
            ([20.0, -18.0], "in both directions"),
            ([-20.0, 1.0], "turning forwards only"),
            ([1.0, -20.0], "turning backwards only"),
            ([3.0, -3.0], "in no direction alone"),
        ] {
            assert_eq!(directions(means, 5.0), wanted, "{means:?}");
        }
    }
}
