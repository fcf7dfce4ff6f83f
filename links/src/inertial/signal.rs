//! A sensor's samples as logged, integrated over time: held rows, gaps, limits of the range.

/// Longest pause between two samples that is bridged by a straight line, in sampling periods of the sensor, ...
const BRIDGED_PERIODS: f64 = 4.0;
/// ... and in seconds at least: the rate of a robot hardly changes in this time.
const BRIDGED_S: f64 = 0.02;
/// Turn by the wheels, rad, during which a sensor that repeats itself to the last digit is stuck.
const STUCK_RAD: f64 = 0.05;
/// Fresh samples in a row at the largest value of an axis that are its limit, not chance.
const AT_LIMIT: usize = 3;

/// The integral of one axis, and where it is not known.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Integral {
    /// From the first tick, at each tick.
    sum: Vec<f64>,
    /// Intervals without a value, up to each tick.
    broken: Vec<u32>,
}

impl Integral {
    /// What is gained from one tick to another; NaN where a part of it was not measured.
    pub fn between(&self, from: usize, to: usize) -> f64 {
        if self.broken[from] == self.broken[to] { self.sum[to] - self.sum[from] } else { f64::NAN }
    }

    /// What was gained from one tick to another by readings so much later, s; NaN where a part of it was not measured.
    pub fn between_late(&self, t: &[f64], from: usize, to: usize, late: f64) -> f64 {
        if late == 0.0 {
            return self.between(from, to);
        }
        let interval = |k: usize| {
            let time = t[k] + late;
            let next = t.partition_point(|t| *t <= time);
            (next > 0 && next < t.len()).then(|| (next - 1, (time - t[next - 1]) / (t[next] - t[next - 1])))
        };
        let Some(((a, from), (b, to))) = interval(from).zip(interval(to)) else { return f64::NAN };
        if self.broken[a] != self.broken[b + 1] {
            return f64::NAN;
        }
        let at = |k: usize, share: f64| self.sum[k] + share * (self.sum[k + 1] - self.sum[k]);
        at(b, to) - at(a, from)
    }
}

/// Integrates the axes of a sensor; `turn` is what the wheels turn the robot from each tick to the next, rad. An axis
/// without a sample is `None`.
///
/// Rows that repeat the one before are no samples of their own: a sensor slower than the log stands in several.
pub(super) fn integrate(t: &[f64], axes: &[Vec<f64>; 3], turn: &[f64]) -> [Option<Integral>; 3] {
    let fresh = fresh(axes, t.len());
    let mut steps: Vec<f64> = fresh.windows(2).map(|w| t[w[1]] - t[w[0]]).collect();
    let period = if steps.is_empty() { 0.0 } else { estimation::statistics::median(&mut steps) };
    let bridged = (BRIDGED_PERIODS * period).max(BRIDGED_S);
    let turned: Vec<f64> = std::iter::once(0.0)
        .chain(turn.iter().scan(0.0, |sum, x| {
            *sum += x.abs();
            Some(*sum)
        }))
        .collect();
    [0, 1, 2].map(|axis| {
        let values = &axes[axis];
        let own: Vec<usize> = fresh.iter().copied().filter(|k| values[*k].is_finite()).collect();
        let limited = limited(values, &own);
        let mut out = Integral { sum: vec![0.0; t.len()], broken: vec![0; t.len()] };
        let (mut next, mut sum, mut broken) = (0, 0.0, 0);
        for k in 1..t.len() {
            // The two samples round this interval.
            while next < own.len() && own[next] < k {
                next += 1;
            }
            let (before, after) = (next.checked_sub(1).map(|i| own[i]), own.get(next).copied());
            let known = before.zip(after).filter(|(a, b)| {
                let absent = (*a + 1..*b).any(|k| values[k].is_nan());
                let held = t[*b] - t[*a] > bridged && (absent || turned[*b] - turned[*a] > STUCK_RAD);
                !held && !limited[next] && !limited[next - 1]
            });
            if let Some((a, b)) = known {
                let share = (0.5 * (t[k - 1] + t[k]) - t[a]) / (t[b] - t[a]);
                sum += (values[a] + share * (values[b] - values[a])) * (t[k] - t[k - 1]);
            } else {
                broken += 1;
            }
            (out.sum[k], out.broken[k]) = (sum, broken);
        }
        (own.len() > 1).then_some(out)
    })
}

/// Ticks with a sample that is not the one before again.
fn fresh(axes: &[Vec<f64>; 3], ticks: usize) -> Vec<usize> {
    let row = |k: usize| [0, 1, 2].map(|i| axes[i].get(k).copied().unwrap_or(f64::NAN));
    let mut last: Option<[f64; 3]> = None;
    let is_fresh = |k: &usize| {
        let now = row(*k);
        let there = now.iter().any(|x| x.is_finite());
        let again = last.is_some_and(|last| last.map(f64::to_bits) == now.map(f64::to_bits));
        if there {
            last = Some(now);
        }
        there && !again
    };
    (0..ticks).filter(is_fresh).collect()
}

/// Which samples are at the limit of the range.
fn limited(values: &[f64], own: &[usize]) -> Vec<bool> {
    let mut out = vec![false; own.len()];
    for side in [1.0, -1.0] {
        let most = own.iter().map(|k| side * values[*k]).fold(f64::NEG_INFINITY, f64::max);
        let mut first = 0;
        while first < own.len() {
            let run = own[first..].iter().take_while(|k| side * values[**k] == most).count();
            // A sensor at rest has no limit in sight.
            if run >= AT_LIMIT && most > 1.0 {
                out[first..first + run].fill(true);
            }
            first += run.max(1);
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    const TICK: f64 = 0.001;

    fn times(n: usize) -> Vec<f64> {
        (0..n).map(|k| k as f64 * TICK).collect()
    }

    fn z(values: Vec<f64>) -> [Vec<f64>; 3] {
        let none = vec![f64::NAN; values.len()];
        [none.clone(), none, values]
    }

    #[test]
    fn a_slow_sensor_that_stands_in_several_rows_is_integrated_along_its_samples() {
        let t = times(1001);
        // 100 Hz, held over ten rows: a ramp from 0 to 2 rad/s.
        let held = t.iter().map(|t| 2.0 * (t * 100.0 + 1e-9).floor() / 100.0).collect();
        let [x, _, z] = integrate(&t, &z(held), &vec![0.002; 1000]);
        assert_eq!(x, None);
        let turned = z.unwrap().between(0, 1000);
        // By its rows alone it would be 0.99.
        assert!((turned - 1.0).abs() < 1e-3, "{turned}");
    }

    #[test]
    fn what_was_not_measured_is_not_invented() {
        let t = times(1000);
        let with = |change: &dyn Fn(usize) -> Option<f64>| {
            let ramp = (0..1000).map(|k| change(k).unwrap_or(1.0 + 0.001 * k as f64)).collect();
            let [_, _, z] = integrate(&t, &z(ramp), &[0.001; 999]);
            z.unwrap()
        };
        let whole = with(&|_| None);
        assert!((whole.between(100, 900) - 1.2).abs() < 1e-3);
        let short = with(&|k| (300..310).contains(&k).then_some(f64::NAN));
        assert!((short.between(100, 900) - whole.between(100, 900)).abs() < 1e-9);
        let long = with(&|k| (300..400).contains(&k).then_some(f64::NAN));
        assert!(
            long.between(100, 900).is_nan() && long.between(100, 299).is_finite() && long.between(401, 900).is_finite()
        );
        let stuck = with(&|k| (300..400).contains(&k).then_some(1.3));
        assert!(stuck.between(100, 900).is_nan(), "the wheels turned 0.1 rad meanwhile");
        let clipped = with(&|k| (k >= 700).then_some(1.7));
        assert!(clipped.between(600, 900).is_nan() && clipped.between(100, 690).is_finite());
    }
}
