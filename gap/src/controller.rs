//! The `controller` link: set points and encoder counts to duty, by replay of the speed loop.

use model::robot::Robot;
use model::run::Run;

use crate::effect::Link;
use crate::exact::{ExactLink, Finding, quantum};

/// Share of ticks that may differ by more than rounding.
const WRONG_SHARE: f64 = 0.005;
/// A hypothesis must remove this share of the error's square.
const REMOVED: f64 = 0.8;
/// Rates that differ by more cannot be replayed.
const RATE_TOLERANCE: f64 = 0.05;

/// One way the loop may have run.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Law {
    kp: f64,
    ki: f64,
    /// Limit of an integrator that is not held; `None` for the nominal rule.
    windup: Option<f64>,
    duty_quantum: f64,
    /// Ticks by which the counts and the set points used are older than logged.
    shift: [usize; 2],
}

/// Replays the duties of every run and wheel.
pub(crate) fn analyse(robot: &Robot, runs: &[Run]) -> Option<ExactLink> {
    let n = robot.wheel_count();
    let usable = |r: &&Run| {
        r.reference.len() == n
            && r.counts.len() == n
            && r.duty.len() == n
            && r.tick_s().is_some_and(|t| (t * robot.control_rate_hz - 1.0).abs() < RATE_TOLERANCE)
    };
    let runs: Vec<&Run> = runs.iter().filter(usable).collect();
    if runs.is_empty() {
        return None;
    }
    let logged = quantum(runs.iter().flat_map(|r| r.duty.iter().flatten()));
    let step = robot.duty_quantum.unwrap_or(if logged > 0.0 { logged.min(0.001) } else { 0.0 });
    let floor = 0.5 * step.max(logged.min(0.001)) + 1e-5;
    let nominal = Law { kp: robot.pi.kp, ki: robot.pi.ki, windup: None, duty_quantum: step, shift: [0, 0] };
    let all: Vec<usize> = (0..n).collect();
    let rms = |law: &Law| -> Vec<f64> { all.iter().map(|i| replay(robot, &runs, *i, law, floor).0).collect() };
    let before = rms(&nominal);
    let wrong = all.iter().map(|i| replay(robot, &runs, *i, &nominal, floor).1).fold(0.0, f64::max);
    let mut link = ExactLink {
        link: Link::Controller,
        unit: "duty",
        floor,
        after: before.clone(),
        before,
        wrong_share: wrong,
        finding: None,
        unexplained: false,
    };
    let total = |e: &[f64]| e.iter().map(|x| x * x).sum::<f64>();
    let start = total(&link.before);
    if wrong <= WRONG_SHARE {
        return Some(link);
    }
    let mut best: (f64, Option<Finding>, Vec<f64>) = (start, None, link.before.clone());
    let mut offer = |law: Law, name: &'static str, parameters: Vec<(String, f64, [f64; 2])>| {
        let e = rms(&law);
        if total(&e) < best.0 * 0.999 {
            best = (total(&e), Some(Finding { link: Link::Controller, name, wheels: Vec::new(), parameters }), e);
        }
    };
    let exact = |name: &str, v: f64| (name.to_owned(), v, [v, v]);
    for signal in 0..2 {
        for ticks in 1..=4 {
            let mut shift = [0, 0];
            shift[signal] = ticks;
            let parameters = vec![exact("signal", signal as f64), exact("shift_ticks", ticks as f64)];
            offer(Law { shift, ..nominal }, "sample-order", parameters);
        }
    }
    for coarse in [
        0.002,
        0.004,
        0.005,
        0.008,
        0.01,
        0.0125,
        0.016,
        0.02,
        0.025,
        0.03,
        0.04,
        0.05,
        0.0625,
        0.1,
        logged,
        spacing(&runs),
    ] {
        if coarse > step {
            offer(Law { duty_quantum: coarse, ..nominal }, "quantisation", vec![exact("duty_quantum", coarse)]);
        }
    }
    let limits: Vec<f64> = (1..=40).map(|k| 0.1 * f64::from(k)).chain([1e9]).collect();
    let windup = limits
        .iter()
        .map(|l| (total(&rms(&Law { windup: Some(*l), ..nominal })), *l))
        .min_by(|a, b| a.0.total_cmp(&b.0));
    if let Some((_, coarse)) = windup {
        let fine = (-10..=10).map(|k| coarse + 0.01 * f64::from(k)).filter(|l| *l > 0.0);
        let limit = fine
            .map(|l| (total(&rms(&Law { windup: Some(l), ..nominal })), l))
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .map_or(coarse, |b| b.1);
        let ci = [limit - 0.01, limit + 0.01];
        offer(Law { windup: Some(limit), ..nominal }, "integrator-windup", vec![("limit_duty".to_owned(), limit, ci)]);
    }
    let gains = fit_gains(&nominal, |law| total(&rms(law)));
    let named = |name: &str, v: f64| (name.to_owned(), v, [v - 0.002, v + 0.002]);
    let parameters =
        vec![named("kp_scale", gains.kp / nominal.kp - 1.0), named("ki_scale", gains.ki / nominal.ki.max(1e-12) - 1.0)];
    offer(gains, "pi-gain", parameters);
    if best.0 < (1.0 - REMOVED) * start {
        link.after = best.2;
        link.finding = best.1;
    } else {
        link.unexplained = true;
    }
    Some(link)
}

/// Distance between neighbouring values of the duties, by a line through all levels.
fn spacing(runs: &[&Run]) -> f64 {
    let mut values: Vec<f64> = runs
        .iter()
        .flat_map(|r| r.duty.iter().flatten())
        .map(|d| d.abs())
        .filter(|d| *d > 1e-6 && *d < 0.999)
        .collect();
    values.sort_by(f64::total_cmp);
    values.dedup_by(|a, b| (*a - *b).abs() < 1e-7);
    let Some(mut q) = values.first().copied() else { return 0.0 };
    // From the lowest level up, so that every next one is counted rightly.
    let (mut kk, mut kv) = (0.0, 0.0);
    for v in values {
        let k = (v / q).round();
        if k >= 1.0 {
            kk += k * k;
            kv += k * v;
            q = kv / kk;
        }
    }
    q
}

/// Pattern search over both gains, steps from 20 % down to 0.05 %.
fn fit_gains(nominal: &Law, cost: impl Fn(&Law) -> f64) -> Law {
    let mut best = (cost(nominal), *nominal);
    let mut step = 0.2;
    while step > 0.000_5 {
        let mut better = false;
        for (p, i) in [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0), (1.0, 1.0), (-1.0, -1.0)] {
            let (_, now) = best;
            let law = Law { kp: now.kp * (1.0 + step * p), ki: now.ki * (1.0 + step * i), ..now };
            let c = cost(&law);
            if c < best.0 {
                best = (c, law);
                better = true;
            }
        }
        if !better {
            step *= 0.4;
        }
    }
    best.1
}

/// RMS of what is beyond rounding, and the share of ticks that are.
fn replay(robot: &Robot, runs: &[&Run], wheel: usize, law: &Law, floor: f64) -> (f64, f64) {
    let rate = robot.control_rate_hz;
    let per_count = rate / robot.counts_per_wheel_rad();
    // A guess of the rounding shifts the highest level by some thousandths of it.
    let tolerance = floor;
    let (mut square, mut wrong, mut all) = (0.0, 0.0, 0.0_f64);
    for run in runs {
        let (reference, counts, duty) = (&run.reference[wheel], &run.counts[wheel], &run.duty[wheel]);
        let mut integral = None;
        for k in 0..run.len() {
            let at = k.saturating_sub(law.shift[0]);
            let before = k.checked_sub(law.shift[0] + 1);
            let moved = before.map_or(0, |b| counts[at].wrapping_sub(counts[b]));
            let error = reference[k.saturating_sub(law.shift[1])] - moved as f64 * per_count;
            if !(error.is_finite() && duty[k].is_finite()) {
                integral = None;
                continue;
            }
            let proportional = law.kp * error;
            // A log that starts in motion starts with whatever the integrator held.
            let i = integral.unwrap_or(if k == 0 { 0.0 } else { duty[k] - proportional - law.ki * error / rate });
            let candidate = i + law.ki * error / rate;
            let unlimited = proportional + candidate;
            let next = match law.windup {
                Some(limit) => candidate.clamp(-limit, limit),
                None if unlimited.abs() > 1.0 && error * unlimited > 0.0 => i,
                None => candidate,
            };
            integral = Some(next);
            let mut u = (proportional + next).clamp(-1.0, 1.0);
            if law.duty_quantum > 0.0 {
                u = (u / law.duty_quantum).round() * law.duty_quantum;
            }
            let e = ((u - duty[k]).abs() - tolerance).max(0.0);
            square += e * e;
            all += 1.0;
            wrong += f64::from(u8::from(e > 1e-9));
        }
    }
    ((square / all.max(1.0)).sqrt(), wrong / all.max(1.0))
}
