//! The `timing` link: stamps of ticks and camera frames.

use model::robot::Robot;
use model::run::Log;

use crate::effect::Link;
use crate::exact::{ExactLink, Finding};

/// Scatter of the stamps about a regular grid that rounding to a tick cannot give, in ticks, and
/// the least that matters, s.
const SCATTER_TICKS: f64 = 0.6;
const SCATTER_S: f64 = 0.001;

/// Checks the camera's stamps against a regular grid.
pub(crate) fn analyse(robot: &Robot, logs: &[Log]) -> Option<ExactLink> {
    let (mut square, mut n, mut missing, mut frames) = (0.0, 0.0_f64, 0.0, 0.0_f64);
    let mut tick = 0.0_f64;
    for log in logs.iter().filter(|log| log.camera().len() >= 16) {
        tick = tick.max(log.tick_s().unwrap_or(0.0));
        let stamps: Vec<f64> = log.camera().iter().map(|f| f.t).collect();
        let grid = grid(&stamps, robot.camera_rate_hz);
        for (g, s) in grid.iter().zip(&stamps) {
            square += (g - s).powi(2);
            n += 1.0;
        }
        let span = (grid[grid.len() - 1] - grid[0]) * robot.camera_rate_hz;
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
    let mut parameters =
        vec![("jitter_s".to_owned(), scatter, [scatter * (1.0 - error), scatter * (1.0 + error) * folded])];
    if lost > 0.01 {
        let sd = (lost * (1.0 - lost) / frames).sqrt();
        parameters.push(("dropped".to_owned(), lost, [(lost - 2.0 * sd).max(0.0), lost + 2.0 * sd]));
    }
    let finding = named.then(|| Finding { link: Link::Timing, name: "camera-timing", wheels: Vec::new(), parameters });
    let after = if named { floor.min(scatter) } else { scatter };
    Some(ExactLink {
        link: Link::Timing,
        unit: "s",
        floor,
        before: vec![scatter],
        after: vec![after],
        wrong_share: 0.0,
        finding,
        unexplained: false,
        replay: None,
    })
}

/// The regular grid nearest to the stamps: frame numbers by the rate, then a line, twice.
pub(crate) fn grid(stamps: &[f64], rate: f64) -> Vec<f64> {
    let m = stamps.len() as f64;
    let (mut period, mut origin) = (1.0 / rate, stamps[0]);
    let mut numbers: Vec<f64> = Vec::new();
    for _ in 0..3 {
        numbers = stamps.iter().map(|t| ((t - origin) / period).round()).collect();
        let (mean_n, mean_t) = (numbers.iter().sum::<f64>() / m, stamps.iter().sum::<f64>() / m);
        let sxx: f64 = numbers.iter().map(|n| (n - mean_n).powi(2)).sum();
        let sxy: f64 = numbers.iter().zip(stamps).map(|(n, t)| (n - mean_n) * (t - mean_t)).sum();
        if sxx > 0.0 && sxy > 0.0 {
            period = sxy / sxx;
        }
        origin = mean_t - period * mean_n;
    }
    numbers.iter().map(|n| origin + period * n).collect()
}
