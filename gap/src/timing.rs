//! The `timing` link: stamps of ticks and camera frames.

use runs::Log;
use runs::robot::Robot;

use crate::evidence::{Evidence, Interval};
use crate::exact::{ExactLink, Finding};
use crate::thresholds::Thresholds;
use links::effect::Link;
use links::motion::WindowResiduals;

/// Scatter of the stamps about a regular grid that rounding to a tick cannot give, in ticks, and
/// the least that matters, s.
const SCATTER_TICKS: f64 = 0.6;
const SCATTER_S: f64 = 0.001;
/// Frames of a log from which a grid is laid through their stamps.
const FEWEST_FRAMES: usize = 16;

/// Checks the camera's stamps against a regular grid.
pub(crate) fn analyse(robot: &Robot, logs: &[Log]) -> Option<ExactLink> {
    let (mut square, mut n, mut missing, mut frames) = (0.0, 0.0_f64, 0.0, 0.0_f64);
    let mut tick = 0.0_f64;
    for log in logs {
        let Some(stamps) = on_grid(log, robot) else { continue };
        tick = tick.max(log.tick_s().unwrap_or(0.0));
        for [stamp, regular] in &stamps {
            square += (regular - stamp).powi(2);
            n += 1.0;
        }
        let span = (stamps[stamps.len() - 1][1] - stamps[0][1]) * robot.camera_rate_hz;
        missing += (span.round() + 1.0 - stamps.len() as f64).max(0.0);
        frames += span.round() + 1.0;
    }
    if n == 0.0 {
        return None;
    }
    let scatter = (square / n).sqrt();
    let floor = (SCATTER_TICKS * tick).max(SCATTER_S);
    let named = scatter > floor;
    let lost = missing / frames.max(1.0);
    // From a fifth of a period on, stamps lie nearer to a neighbour's place and the scatter is more than it looks; from
    // a quarter on it hardly grows any more, whatever the truth.
    let folded = match scatter * robot.camera_rate_hz {
        periods if periods > 0.25 => 3.0,
        periods if periods > 0.2 => 1.5,
        _ => 1.0,
    };
    let error = 2.0 / (2.0 * n).sqrt();
    let ends = [scatter * (1.0 - error), scatter * (1.0 + error) * folded];
    let known = if folded > 1.0 { Interval::Bound(ends) } else { Interval::Ci95(ends) };
    let mut parameters = vec![("jitter_s".to_owned(), scatter, known)];
    if lost > 0.01 {
        let sd = (lost * (1.0 - lost) / frames).sqrt();
        let ends = [(lost - 2.0 * sd).max(0.0), lost + 2.0 * sd];
        // Of frames that overtake each other the log holds one: not all that is missing was dropped.
        let overtaken = overtaken(known.ends().map_or(scatter, |ends| ends[1]) * robot.camera_rate_hz);
        let known = if folded > 1.0 {
            Interval::Bound([(ends[0] - overtaken).max(0.0), ends[1]])
        } else {
            Interval::Ci95(ends)
        };
        parameters.push(("dropped".to_owned(), lost, known));
    }
    let evidence = Evidence::Test {
        method: "chi-squared of the stamps' scatter against rounding to ticks",
        p: estimation::statistics::chi2_upper(n * (scatter / floor).powi(2), n).max(f64::MIN_POSITIVE),
    };
    let after = if named { floor.min(scatter) } else { scatter };
    let is_stated = is_stated(robot, &parameters);
    let finding = (named && !is_stated).then(|| Finding {
        link: Link::Timing,
        name: "camera-timing",
        wheels: Vec::new(),
        parameters,
        evidence,
    });
    Some(ExactLink {
        link: Link::Timing,
        unit: "s",
        floor,
        before: vec![if is_stated { after } else { scatter }],
        after: vec![after],
        wrong_share: 0.0,
        finding,
        unexplained: false,
        replay: None,
    })
}

/// Takes the name back where frames come unevenly and nothing shows that their stamps do not say when; what is to be said.
///
/// A pose that was taken on the grid is off by what the robot moved until its stamp. `seen` is what camera and wheels
/// leave with all that is named there, in units of `noise`.
pub(crate) fn uneven(
    link: &mut ExactLink,
    (robot, logs): (&Robot, &[Log]),
    noise: [f64; 3],
    seen: &[WindowResiduals],
    thresholds: &Thresholds,
) -> Option<String> {
    let told = off_by_stamps(robot, logs, noise, seen);
    let [least, sigmas] = thresholds.stamps;
    let [shown, follows] = told.map_or([false; 2], |[share, error]| {
        [share > least && share > sigmas * error, share + sigmas * error < 1.0 - least]
    });
    if shown {
        return None;
    }
    let finding = link.finding.take()?;
    link.before.clone_from(&link.after);
    let value = |name: &str| finding.parameters.iter().find(|(p, ..)| p == name).map_or(0.0, |(_, v, _)| *v);
    let lost =
        if value("dropped") > 0.0 { format!(", {:.0} % missing", 100.0 * value("dropped")) } else { String::new() };
    let what = if follows {
        "their poses follow the stamps: frames came unevenly, and the stamps say when"
    } else {
        "the poses do not tell whether frames came so, or their stamps scatter: drive faster to tell"
    };
    Some(format!("The camera's stamps are {:.1} ms RMS off a regular grid{lost}; {what}.", 1e3 * value("jitter_s")))
}

/// Weight of a frame, what it is off by where its stamp scatters, and what it is off by, both in units of the noise.
type Frame = (f64, [f64; 3], [f64; 3]);

/// Share of what the robot moved between a frame's regular time and its stamp by which the poses are off, and its
/// standard error: 1 where stamps scatter about capture times, 0 where frames are taken when their stamps say.
fn off_by_stamps(robot: &Robot, logs: &[Log], noise: [f64; 3], seen: &[WindowResiduals]) -> Option<[f64; 2]> {
    let as_stamped = |log: &Log| log.camera().iter().map(|f| [f.t; 2]).collect();
    let stamps: Vec<_> = logs.iter().map(|log| on_grid(log, robot).unwrap_or_else(|| as_stamped(log))).collect();
    let (mut moved, mut mixed, mut square, mut n) = (0.0, 0.0, 0.0, 0.0_f64);
    for window in seen.iter().filter(|w| w.t.len() >= 4) {
        let frames = stamps.get(window.run)?;
        let last = window.t.len() - 1;
        let mut rows: Vec<Frame> = Vec::new();
        for (i, t) in window.t.iter().enumerate() {
            let at = frames.partition_point(|[stamp, _]| *stamp < *t);
            let Some([stamp, regular]) = frames.get(at).filter(|[stamp, _]| *stamp == *t) else { continue };
            let (a, b) = (i.saturating_sub(1), (i + 1).min(last));
            let (from, to) = (&window.predicted[a], &window.predicted[b]);
            let gained = [to.x - from.x, to.y - from.y, runs::frames::wrap_angle(to.theta - from.theta)];
            let by = (stamp - regular) / (window.t[b] - window.t[a]);
            rows.push((window.weights[i], [0, 1, 2].map(|j| -gained[j] * by / noise[j]), window.residuals[i]));
        }
        let whole: f64 = rows.iter().map(|r| r.0).sum();
        for j in 0..3 {
            // The pose of a window's start is fitted to all of its frames.
            let mean = |of: &dyn Fn(&Frame) -> f64| {
                rows.iter().map(|r| r.0 * of(r)).sum::<f64>() / whole.max(f64::MIN_POSITIVE)
            };
            let [u, r] = [mean(&|r| r.1[j]), mean(&|r| r.2[j])];
            for row in &rows {
                let [du, dr] = [row.1[j] - u, row.2[j] - r];
                moved += row.0 * du * du;
                mixed += row.0 * du * dr;
                square += row.0 * dr * dr;
                n += row.0;
            }
        }
    }
    let share = mixed / moved;
    let error = ((square - share * mixed).max(0.0) / n / moved).sqrt();
    (share.is_finite() && error.is_finite()).then_some([share, error])
}

/// Whether `robot.toml` states these values, each within what is known of it.
fn is_stated(robot: &Robot, parameters: &[(String, f64, Interval)]) -> bool {
    let Some(effect) = robot.effect("camera-timing") else { return false };
    parameters.iter().all(|(name, _, known)| {
        let stated = effect.value(name).unwrap_or(0.0);
        known.ends().is_some_and(|[low, high]| (low..=high).contains(&stated))
    })
}

/// Share of the frames that the next one overtakes where stamps scatter by so many periods, normally distributed.
fn overtaken(periods: f64) -> f64 {
    0.5 * estimation::statistics::chi2_upper(0.5 / (periods * periods).max(1e-300), 1.0)
}

/// Stamp and regular time of each frame of a log, s; `None` of one with too few frames to tell a grid.
fn on_grid(log: &Log, robot: &Robot) -> Option<Vec<[f64; 2]>> {
    let stamps: Vec<f64> = log.camera().iter().map(|f| f.t).collect();
    if stamps.len() < FEWEST_FRAMES {
        return None;
    }
    let regular = grid(&stamps, robot.camera_rate_hz);
    Some(stamps.into_iter().zip(regular).map(<[f64; 2]>::from).collect())
}

/// The regular grid that the stamps scatter about, one time a frame.
///
/// Frames are numbered in two ways, and the better grid counts: from frame to frame, which follows a clock that is fast
/// or slow, and all at once, which bears scatter of a third of a period. Stamps far from their own place are not given
/// to a neighbour's: numbers rise with every frame.
pub(crate) fn grid(stamps: &[f64], rate: f64) -> Vec<f64> {
    let sequential: Vec<f64> = std::iter::once(0.0)
        .chain(stamps.windows(2).scan(0.0, |n, w| {
            *n += ((w[1] - w[0]) * rate).round().max(1.0);
            Some(*n)
        }))
        .collect();
    let scatter = |grid: &[f64]| grid.iter().zip(stamps).map(|(g, s)| (g - s).powi(2)).sum::<f64>();
    let (stepwise, whole) = (line(stamps, &sequential).0, at_once(stamps, rate));
    if scatter(&stepwise) < scatter(&whole) { stepwise } else { whole }
}

/// Numbers that rise by at least one a frame and fit the nominal rate best, twice, and the line through them.
fn at_once(stamps: &[f64], rate: f64) -> Vec<f64> {
    let (sin, cos) = stamps.iter().map(|t| (std::f64::consts::TAU * t * rate).sin_cos()).fold((0.0, 0.0), |a, b| {
        let (s, c): (f64, f64) = b;
        (a.0 + s, a.1 + c)
    });
    let (mut period, mut origin) = (1.0 / rate, sin.atan2(cos) / (std::f64::consts::TAU * rate));
    let mut grid = Vec::new();
    for _ in 0..3 {
        let free: Vec<f64> = stamps.iter().enumerate().map(|(k, t)| (t - origin) / period - k as f64).collect();
        // The best rising whole numbers are those of the best rising line, rounded.
        let numbers: Vec<f64> = rising(&free).iter().enumerate().map(|(k, x)| x.round() + k as f64).collect();
        (grid, [period, origin]) = line(stamps, &numbers);
    }
    grid
}

/// The stamps' line over their numbers, its slope and its value at 0.
fn line(stamps: &[f64], numbers: &[f64]) -> (Vec<f64>, [f64; 2]) {
    let m = stamps.len() as f64;
    let (mean_n, mean_t) = (numbers.iter().sum::<f64>() / m, stamps.iter().sum::<f64>() / m);
    let sxx: f64 = numbers.iter().map(|n| (n - mean_n).powi(2)).sum();
    let sxy: f64 = numbers.iter().zip(stamps).map(|(n, t)| (n - mean_n) * (t - mean_t)).sum();
    let period = if sxx > 0.0 { sxy / sxx } else { 0.0 };
    let origin = mean_t - period * mean_n;
    (numbers.iter().map(|n| origin + period * n).collect(), [period, origin])
}

/// The never falling sequence nearest to another (pooling of adjacent violators; Ayer et al. 1955).
fn rising(values: &[f64]) -> Vec<f64> {
    let mut pools: Vec<(f64, usize)> = Vec::new();
    for v in values {
        let mut pool = (*v, 1);
        while let Some(last) = pools.pop_if(|last| last.0 >= pool.0) {
            let n = last.1 + pool.1;
            pool = ((last.0 * last.1 as f64 + pool.0 * pool.1 as f64) / n as f64, n);
        }
        pools.push(pool);
    }
    pools.into_iter().flat_map(|(v, n)| std::iter::repeat_n(v, n)).collect()
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};

    use super::*;

    /// Scatter of a grid fitted to frames at 60 Hz that scatter by `jitter` s; a share `lost` of them is missing, and
    /// the clock is fast by `drift`.
    fn found(jitter: f64, lost: f64, drift: f64) -> f64 {
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(7);
        let mut square = 0.0;
        let mut count = 0.0;
        for _ in 0..4 {
            let mut stamps: Vec<f64> = Vec::new();
            for k in 0..420 {
                let scatter: f64 = (0..12).map(|_| rng.random::<f64>()).sum::<f64>() - 6.0;
                let t = 0.013 + f64::from(k) / 60.0 * (1.0 + drift) + jitter * scatter;
                if rng.random::<f64>() >= lost {
                    stamps.push((t * 1000.0).round() / 1000.0);
                }
            }
            stamps.sort_by(f64::total_cmp);
            count += stamps.len() as f64;
            square += grid(&stamps, 60.0).iter().zip(&stamps).map(|(g, s)| (g - s).powi(2)).sum::<f64>();
        }
        (square / count).sqrt()
    }

    #[test]
    fn frames_overtake_each_other_where_stamps_scatter_by_half_a_period() {
        for (periods, share) in [(0.1, 0.0), (0.5, 0.0786), (1.0, 0.2398)] {
            assert!((overtaken(periods) - share).abs() < 1e-3, "{periods}: {}", overtaken(periods));
        }
    }

    #[test]
    fn scatter_is_measured_whatever_is_lost() {
        for (jitter, lost, share) in [(0.003, 0.0, 0.05), (0.003, 0.2, 0.05), (0.006, 0.0, 0.08), (0.005, 0.1, 0.15)] {
            let found = found(jitter, lost, 0.0);
            assert!((found / jitter - 1.0).abs() < share, "{found} instead of {jitter}, {lost} lost");
        }
        for drift in [0.0, 0.012, -0.012] {
            assert!(found(0.0, 0.1, drift) < 4e-4, "a regular clock scatters by {}", found(0.0, 0.1, drift));
        }
    }
}
