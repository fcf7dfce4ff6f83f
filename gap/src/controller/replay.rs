//! The speed loop along a log, its integrator known between bounds.
//!
//! Where a log begins, and after ticks that it lacks, nobody knows the integrator. Every duty that follows
//! narrows it down to what its rounding leaves, and then the law is as exact as if it had been known.

use runs::robot::Robot;
use runs::ticks::Ticks;
use runs::{Log, Run};

use super::{COLUMNS, Law, SLACK};
use crate::evidence;
use crate::parts::parts;

/// Integrator of one axis: somewhere from `low` to `high`.
#[derive(Debug, Clone, Copy)]
struct Integral {
    low: f64,
    high: f64,
}

impl Integral {
    const UNKNOWN: Self = Self { low: f64::NEG_INFINITY, high: f64::INFINITY };

    fn is_known(self) -> bool {
        self.low.is_finite() && self.high.is_finite()
    }

    /// One tick of the law, and the duties before rounding that are possible.
    fn step(&mut self, law: &Law, error: f64, rate: f64) -> [f64; 2] {
        let (proportional, more) = (law.kp * error, law.ki * error / rate);
        let Self { low, high } = *self;
        if let Some(limit) = law.windup {
            self.low = (low + more).clamp(-limit, limit);
            self.high = (high + more).clamp(-limit, limit);
        } else {
            // Along the error; held from a bound on outwards, by the integrator before its part of this tick or after:
            // loops do either.
            let sign = if error > 0.0 { 1.0 } else { -1.0 };
            let [inner, outer] = if error > 0.0 { [low, high] } else { [-high, -low] };
            let (bound, part) = (law.held_from - sign * proportional, sign * more);
            let gone = (inner <= bound).then(|| [inner + part, outer.min(bound) + part]);
            let held = (outer > bound - part).then(|| [inner.max(bound - part), outer]);
            let ends = || gone.iter().chain(&held);
            let inner = ends().map(|e| e[0]).fold(f64::INFINITY, f64::min);
            let outer = ends().map(|e| e[1]).fold(f64::NEG_INFINITY, f64::max);
            (self.low, self.high) = if error > 0.0 { (inner, outer) } else { (-outer, -inner) };
        }
        [proportional + self.low, proportional + self.high]
    }

    /// What a logged duty says of the integrator after its tick.
    fn narrow(&mut self, proportional: f64, duty: f64, half: f64, most: f64) {
        let low = if duty - half <= -most { self.low } else { self.low.max(duty - half - proportional) };
        let high = if duty + half >= most { self.high } else { self.high.min(duty + half - proportional) };
        if low <= high {
            (self.low, self.high) = (low, high);
        }
    }
}

/// One wheel's loop on its way along a log.
struct Wheel {
    integral: Integral,
    square: f64,
    wrong: u64,
    all: u64,
}

/// What a replay says of one wheel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Replayed {
    /// RMS of what is beyond rounding, duty.
    pub(super) rms: f64,
    /// Ticks that were compared.
    pub(super) ticks: u64,
    /// Those that differ by more than rounding.
    pub(super) wrong: u64,
}

impl Replayed {
    /// Share of the ticks that differ.
    pub(super) fn wrong_share(&self) -> f64 {
        self.wrong as f64 / self.ticks.max(1) as f64
    }
}

/// Ticks that were compared and that differ, summed over wheels.
pub(super) fn totals(wheels: &[Replayed]) -> evidence::Ticks {
    let [all, wrong] = wheels.iter().fold([0, 0], |[all, wrong], w| [all + w.ticks, wrong + w.wrong]);
    evidence::Ticks { all, wrong }
}

/// Every tick of a log: the ticks around it, its place among them, and how many before it follow without a gap.
pub(super) fn walk(robot: &Robot, log: &Log, mut each: impl FnMut(&Run, &Ticks, usize, usize)) {
    let mut steady = 0;
    for part in parts(log, COLUMNS) {
        let ticks = Ticks::with_period(robot, &part.run, log.tick_s());
        for k in part.own {
            steady = if ticks.since(k) == 1 { steady + 1 } else { 0 };
            each(&part.run, &ticks, k, steady);
        }
    }
}

/// Replays every wheel's loop.
pub(super) fn replay(robot: &Robot, logs: &[&Log], law: &Law, floor: f64) -> Vec<Replayed> {
    let rate = robot.control_rate_hz;
    let per_count = rate / (robot.counts_per_wheel_rad() * law.counts);
    let half = floor.max(0.5 * law.duty_quantum + SLACK);
    let rounded = |u: f64| {
        let u = u.clamp(-law.most, law.most);
        if law.duty_quantum > 0.0 { (u / law.duty_quantum).round() * law.duty_quantum } else { u }
    };
    let wheel = |_| Wheel { integral: Integral::UNKNOWN, square: 0.0, wrong: 0, all: 0 };
    let mut wheels: Vec<Wheel> = (0..robot.wheel_count()).map(wheel).collect();
    for log in logs {
        wheels.iter_mut().for_each(|w| w.integral = Integral::UNKNOWN);
        walk(robot, log, |run, ticks, k, steady| {
            for (wheel, state) in wheels.iter_mut().enumerate() {
                // Speeds in place of counts are the best that is known of what the loop measured.
                let speed = |k: usize| match run.measured.get(wheel).or(run.speed.get(wheel)) {
                    Some(measured) => measured[k],
                    None => ticks.moved(wheel, k).map_or(f64::NAN, |counts| counts as f64 * per_count),
                };
                if steady == 0 {
                    state.integral = Integral::UNKNOWN;
                }
                let error = match law.shift {
                    [counts, references] if counts.max(references) <= steady => {
                        run.reference[wheel][k - references] - speed(k - counts)
                    }
                    _ => f64::NAN,
                };
                if !error.is_finite() {
                    state.integral = Integral::UNKNOWN;
                    continue;
                }
                let known = state.integral.is_known();
                let [low, high] = state.integral.step(law, error, rate).map(rounded);
                let logged = run.duty[wheel][k];
                if !logged.is_finite() {
                    continue;
                }
                // A guess of the rounding shifts the highest level by some thousandths of it.
                let e = ((low - logged).max(logged - high).max(0.0) - floor).max(0.0);
                if e == 0.0 {
                    state.integral.narrow(law.kp * error, logged, half, law.most);
                }
                if known {
                    state.square += e * e;
                    state.all += 1;
                    state.wrong += u64::from(e > 1e-9);
                }
            }
        });
    }
    let figures = |w: &Wheel| Replayed { rms: (w.square / w.all.max(1) as f64).sqrt(), ticks: w.all, wrong: w.wrong };
    wheels.iter().map(figures).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use model::effects::Applied;
    use model::manoeuvre::{Manoeuvre, simulate};
    use runs::frames::Pose;
    use runs::robot::{Effect, EffectParameter};
    use std::borrow::Cow;

    /// A drive whose duties are rounded as loggers do, without every row that `keep` refuses.
    fn log(truth: &Robot, keep: impl Fn(usize) -> bool) -> Run {
        let nominal = Robot { effects: Vec::new(), ..truth.clone() };
        let mut run = simulate(Manoeuvre::Chirp, &Applied::of(truth), &nominal, Pose::default(), 3).unwrap();
        run.camera.clear();
        run.has_camera = false;
        let rows: Vec<usize> = (0..run.len()).filter(|k| keep(*k)).collect();
        let pick = |column: &mut Vec<f64>| *column = rows.iter().map(|k| column[*k]).collect();
        run.reference.iter_mut().chain(&mut run.duty).chain(&mut run.supply_v).for_each(pick);
        run.command.iter_mut().flatten().for_each(pick);
        pick(&mut run.t);
        run.counts.iter_mut().for_each(|c| *c = rows.iter().map(|k| c[*k]).collect());
        run
    }

    fn robot() -> Robot {
        Robot { duty_quantum: Some(0.001), ..Robot::racbot() }
    }

    fn nominal(robot: &Robot) -> Law {
        Law { kp: robot.pi.kp, ki: robot.pi.ki, duty_quantum: 0.001, ..Law::PLAIN }
    }

    const FLOOR: f64 = 0.000_5 + SLACK;

    #[test]
    fn a_log_with_gaps_that_begins_in_motion_is_replayed_to_the_last_digit() {
        let robot = robot();
        let run = log(&robot, |k| k > 2_345 && k % 331 != 0 && !(4_000..4_017).contains(&k));
        let ticks = Ticks::new(&robot, &run).gaps();
        assert!(ticks.pauses > 10 && ticks.missing > 30, "{ticks:?}");
        let replayed = replay(&robot, &[&Log::from(Cow::Owned(run))], &nominal(&robot), FLOOR);
        assert!(replayed.iter().all(|w| (w.rms, w.wrong) == (0.0, 0) && w.ticks > 1000), "{replayed:?}");
    }

    /// The same with rows of the camera alone after some ticks, 0.4 ticks later.
    fn with_rows_of_the_camera(mut run: Run, after: impl Fn(usize) -> bool) -> Run {
        let tick_s = run.tick_s().unwrap();
        let rows: Vec<(usize, bool)> =
            (0..run.len()).flat_map(|k| [Some((k, false)), after(k).then_some((k, true))]).flatten().collect();
        let of = |column: &[f64], seen: &dyn Fn(f64) -> f64| -> Vec<f64> {
            rows.iter().map(|(k, camera)| if *camera { seen(column[*k]) } else { column[*k] }).collect()
        };
        run.t = of(&run.t, &|t| t + 0.4 * tick_s);
        let columns = run.reference.iter_mut().chain(&mut run.duty).chain(&mut run.supply_v);
        columns.chain(run.command.iter_mut().flatten()).for_each(|c| *c = of(c, &|_| f64::NAN));
        let gaps: Vec<usize> = (0..rows.len()).filter(|row| rows[*row].1).collect();
        for (counts, own) in run.counts.iter_mut().zip(&mut run.count_gaps) {
            *counts = rows.iter().map(|(k, _)| counts[*k]).collect();
            own.clone_from(&gaps);
        }
        run
    }

    /// A tick that is missing before one was taken for a late one, for it was made up for by the row of the camera.
    #[test]
    fn rows_of_a_camera_are_no_ticks() {
        let robot = robot();
        let run = log(&robot, |k| k % 331 != 0);
        let replayed = |run: &Run| replay(&robot, &[&Log::from(Cow::Borrowed(run))], &nominal(&robot), FLOOR);
        let seen = with_rows_of_the_camera(run.clone(), |k| k % 5 == 0 || k % 330 < 2);
        assert_eq!(replayed(&seen), replayed(&run));
        assert!(replayed(&run).iter().all(|w| (w.rms, w.wrong) == (0.0, 0) && w.ticks > 1000));
    }

    fn with_kp(robot: &Robot, scale: f64) -> Robot {
        let scale = EffectParameter { value: scale, ..EffectParameter::default() };
        let parameters = vec![("kp_scale".to_owned(), scale)];
        let effect = Effect { name: "pi-gain".to_owned(), parameters, ..Effect::default() };
        Robot { effects: vec![effect], ..robot.clone() }
    }

    /// Between gaps of which none is four ticks from the next a delay of three replays nothing, and so nothing wrong.
    #[test]
    fn what_has_next_to_nothing_to_replay_explains_nothing() {
        let robot = robot();
        let run = log(&with_kp(&robot, 0.3), |k| k % 4 != 0);
        let log = [Log::from(Cow::Owned(run))];
        let link =
            super::super::analyse(&robot, &log, &crate::thresholds::Thresholds::default(), &mut Vec::new()).unwrap();
        assert!(link.wrong_share > 0.1);
        assert!(link.finding.as_ref().is_none_or(|f| f.name != "sample-order"), "{:?}", link.finding);
    }

    #[test]
    fn a_wrong_gain_shows_between_gaps_as_well() {
        let robot = robot();
        let run = log(&with_kp(&robot, 0.05), |k| k % 331 != 0);
        let law = nominal(&robot);
        let run = Log::from(Cow::Owned(run));
        let wheel = replay(&robot, &[&run], &law, FLOOR)[0];
        assert!(wheel.rms > 0.001 && wheel.wrong_share() > 0.1, "{wheel:?}");
        let wheel = replay(&robot, &[&run], &Law { kp: 1.05 * law.kp, ..law }, FLOOR)[0];
        assert_eq!((wheel.rms, wheel.wrong), (0.0, 0));
    }

    #[test]
    fn bounds_hold_the_integrator_wherever_it_is_held() {
        let law = Law { kp: 0.02, ki: 30.0, ..Law::PLAIN };
        let pi = model::pi::PiLaw { kp: law.kp, ki: law.ki, rate_hz: 1000.0, duty_quantum: 0.0, integral_limit: None };
        let (mut truth, mut bounds) = (0.4, Integral { low: -0.9, high: 1.3 });
        for k in 0..3_000 {
            let error = 20.0 * (f64::from(k) * 0.37).sin() + 9.0 * (f64::from(k) * 0.011).sin();
            pi.step(&mut truth, error, 0.0);
            let [low, high] = bounds.step(&law, error, 1000.0);
            assert!(bounds.low <= truth + 1e-9 && truth <= bounds.high + 1e-9, "{k}: {truth} in {bounds:?}");
            assert!(low <= high);
        }
    }
    /// Duties of a loop that looks at its integrator before the part of a tick, or after, as in a stiff loop on steps.
    fn saturating(before: bool, error: impl Fn(usize) -> f64, law: &Law, rate: f64) -> Vec<f64> {
        let mut integral = 0.0;
        let step = |k| {
            let (e, part) = (error(k), law.ki * error(k) / rate);
            let looked = law.kp * e + integral + if before { 0.0 } else { part };
            integral += if looked.abs() > 1.0 && e * looked > 0.0 { 0.0 } else { part };
            (law.kp * e + integral).clamp(-1.0, 1.0)
        };
        (0..4_000).map(step).collect()
    }

    #[test]
    fn loops_that_look_before_they_add_or_after_both_replay() {
        let law = Law { kp: 0.03, ki: 0.25, ..Law::PLAIN };
        // The integrator leads into saturation again and again.
        let error = |k: usize| 24.0 * (k as f64 * 0.21).sin() + 6.0 * (k as f64 * 0.037).sin();
        for before in [false, true] {
            let duty = saturating(before, error, &law, 50.0);
            let most = duty.iter().filter(|u| u.abs() == 1.0).count();
            assert!((100..1_000).contains(&most), "{most}");
            let mut integral = Integral { low: 0.0, high: 0.0 };
            let mut wide = 0;
            for (k, duty) in duty.iter().enumerate() {
                let [low, high] = integral.step(&law, error(k), 50.0).map(|u| u.clamp(-1.0, 1.0));
                assert!(low - SLACK <= *duty && *duty <= high + SLACK, "{before} {k}: {duty} in {low} to {high}");
                integral.narrow(law.kp * error(k), *duty, SLACK, 1.0);
                wide += usize::from(integral.high - integral.low > 4.0 * SLACK && duty.abs() + SLACK < 1.0);
            }
            assert_eq!(wide, 0, "what comes after saturation tells the integrator");
        }
    }
}
