//! Axes that would gain work as they turn: what drives them, or what counts them, has the wrong sign.

use runs::is_from_speeds;
use runs::robot::{Robot, Support};

use super::samples::SETTLED_S;
use super::signals::Signals;
use super::{Mistake, short};

/// Parts of the angles of a log in which both ways are compared.
const PARTS: usize = 20;
/// Moments each way from which a part tells, and parts from which anything is said.
const MOMENTS: usize = 3;
const FEWEST: usize = 8;
/// Standard deviations of chance, and share of the parts, by which an axis gains work, not loses it: 20 parts of one sign are
/// chance in a million drives. Of a winch whose currents had the wrong sign 0.95 to 1.00 of the parts gained in seven logs of
/// eight, by 7 standard deviations and more; in one a hand lifted the load.
const CHANCE: f64 = 5.0;
const ALIKE: f64 = 0.8;
/// Share of what drives from which a difference is none of the sensor's: currents read off by some per cent with their sense. The
/// winch had 0.10 to 0.22, one whose torque a regulator held 0.01.
const GAINED: f64 = 0.05;

/// What an axis is driven more forwards than backwards, in the parts of its angles through which it goes both ways: a load that
/// hangs, a weight beside the shaft or a spring give back what they took, friction and back-EMF do not.
#[derive(Default)]
struct Ways {
    more: Vec<f64>,
    driven: f64,
    moments: usize,
}

impl Ways {
    fn add(&mut self, s: &Signals, axis: usize) {
        let (Some(drive), Some(speed)) = (s.duty.get(axis), s.speed.get(axis)) else { return };
        let angles = speed.iter().scan(0.0, |angle, w| {
            *angle += w * s.span_s;
            Some(*angle)
        });
        // In steady turning neither an inertia nor a sensor that is late by some rows has a part in it.
        let rows = angles.zip(speed).zip(drive.iter().zip(&s.acceleration[axis]));
        let steady: Vec<(f64, f64, f64)> = rows
            .filter(|((_, w), (drive, a))| drive.is_finite() && **w != 0.0 && a.abs() * SETTLED_S <= w.abs())
            .map(|((angle, w), (drive, _))| (angle, *w, *drive))
            .collect();
        let (from, to) =
            steady.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), row| (a.min(row.0), b.max(row.0)));
        if from >= to {
            return;
        }
        let mut parts = [[(0.0, 0_usize); 2]; PARTS];
        for (angle, w, drive) in &steady {
            let part = (((angle - from) / (to - from) * PARTS as f64) as usize).min(PARTS - 1);
            let way = &mut parts[part][usize::from(*w < 0.0)];
            *way = (way.0 + drive, way.1 + 1);
            self.driven += drive.abs();
        }
        self.moments += steady.len();
        let both = parts.iter().filter(|[forwards, back]| forwards.1.min(back.1) >= MOMENTS);
        self.more.extend(both.map(|[forwards, back]| forwards.0 / forwards.1 as f64 - back.0 / back.1 as f64));
    }

    /// Share of what drives that is less forwards than backwards, where that is beyond chance.
    fn gained(&self) -> Option<f64> {
        let n = self.more.len() as f64;
        if self.more.len() < FEWEST {
            return None;
        }
        let mean = self.more.iter().sum::<f64>() / n;
        let scatter = (self.more.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (n - 1.0) / n).sqrt();
        let gaining = self.more.iter().filter(|x| **x < 0.0).count() as f64;
        let share = -mean / (self.driven / self.moments as f64);
        (mean < -CHANCE * scatter && gaining >= ALIKE * n && share >= GAINED).then_some(share)
    }
}

/// Axes on blocks that are driven less the way they turn than the other way, at the same places: no axis gives out work for as
/// long as it turns. A load that hangs hides that from signs alone, for it is driven one way throughout.
pub(super) fn gained(robot: &Robot, signals: &[Signals], stem: &str, before: &[Mistake]) -> Vec<Mistake> {
    if robot.support != Support::Blocks {
        return Vec::new();
    }
    let counted = if is_from_speeds(robot) { "speed" } else { "enc" };
    let of = |axis: usize| {
        let mut ways = Ways::default();
        signals.iter().for_each(|s| ways.add(s, axis));
        let share = ways.gained()?;
        let what = format!(
            "at the same places the axis is driven {} % less forwards than backwards: it would give out work for as long as it turns, \
             where friction takes some",
            short(100.0 * share)
        );
        let remedy = format!(
            "change its sign, or that of {counted}_{} where that counts the wrong way (scale = -1 in the map); logs in which \
             something else moves the axis, as a hand, are to be left out",
            axis + 1
        );
        Some(Mistake::new("drive-reversed", &format!("{stem}_{}", axis + 1), what, remedy))
    };
    let axes = signals.iter().map(|s| s.duty.len().min(s.speed.len())).max().unwrap_or(0);
    let known = |i: &usize| before.iter().any(|m| m.is_reversed(*i));
    (0..axes).filter(|i| !known(i)).filter_map(of).collect()
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, StandardNormal};

    use super::*;

    /// A weight of 1 that is lifted and let down three times; friction takes `rubs` each way, and the sensor scatters by `noise`.
    fn lifted(rubs: f64, noise: f64, sense: f64) -> Signals {
        let mut rng = ChaCha8Rng::seed_from_u64(7);
        let mut scatter = || -> f64 { StandardNormal.sample(&mut rng) };
        let speed: Vec<f64> = (0..600).map(|k| if k % 200 < 100 { 6.0 } else { -6.0 }).collect();
        let drive = speed.iter().map(|w: &f64| sense * (1.0 + rubs * w.signum() + noise * scatter())).collect();
        Signals {
            log: "run_1".to_owned(),
            span_s: 0.06,
            acceleration: vec![vec![0.0; speed.len()]],
            speed: vec![speed],
            reference: Vec::new(),
            duty: vec![drive],
            command: Vec::new(),
            current: Vec::new(),
            volts: Vec::new(),
            supply: Vec::new(),
        }
    }

    #[test]
    fn a_lifted_weight_that_gains_work_has_the_wrong_sign() {
        let robot = Robot { support: Support::Blocks, ..Robot::racbot() };
        let of = |s: Signals| gained(&robot, &[s], "current", &[]);
        let found = of(lifted(0.08, 0.1, -1.0));
        assert_eq!(found.len(), 1);
        assert!(found[0].sentence().contains("16.48 % less forwards"), "{}", found[0].sentence());
        assert!(of(lifted(0.08, 0.1, 1.0)).is_empty());
        // Without friction there is no telling, and less than the sensor's own differences is none.
        assert!(of(lifted(0.0, 0.1, -1.0)).is_empty());
        assert!(of(lifted(0.02, 0.01, -1.0)).is_empty());
    }
}
