//! The `controller` link: set points and encoder counts to duty, by replay of the speed loop.

use runs::robot::Robot;
use runs::ticks::{Gaps, Ticks};
use runs::{Columns, CountSource, Log};

use crate::evidence::{Evidence, Interval};
use crate::exact::{ExactLink, FIRST, Finding, Replay, quantum};
use crate::parts::parts;
use crate::thresholds::Thresholds;
use crate::words;
use links::effect::Link;
use replay::{Replayed, replay, totals};

mod counts;
mod replay;
mod told;

pub(crate) use counts::with_other_counts;

/// How far the arithmetic of another controller may stray: fixed-point or single-precision numbers, that an
/// integrator adds up.
const SLACK: f64 = 5e-5;
/// Last steps of the searches for an integrator's limit (duty) and for gains (relative).
const FINE_LIMIT: f64 = 0.01;
const FINEST_GAIN: f64 = 0.000_5;

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
    /// Counts a wheel turn that speeds are reckoned with, in those of the file.
    counts: f64,
    /// Largest duty that is given.
    most: f64,
    /// Output from which the integrator is held.
    held_from: f64,
}

impl Law {
    /// The nominal rules, without gains.
    const PLAIN: Self = Self {
        kp: 0.0,
        ki: 0.0,
        windup: None,
        duty_quantum: 0.0,
        shift: [0, 0],
        counts: 1.0,
        most: 1.0,
        held_from: 1.0,
    };
    /// Effects of this link.
    const EFFECTS: [&str; 4] = ["pi-gain", "integrator-windup", "quantisation", "sample-order"];

    /// The law of `robot.toml` with the effects that it states.
    fn stated(robot: &Robot, duty_quantum: f64) -> Self {
        let value = |effect: &str, parameter: &str| robot.effect(effect).and_then(|e| e.value(parameter));
        let scale = |parameter| 1.0 + value("pi-gain", parameter).unwrap_or(0.0);
        let mut shift = [0, 0];
        if let (Some(signal), Some(ticks)) = (value("sample-order", "signal"), value("sample-order", "shift_ticks")) {
            shift = shifted(signal, ticks.max(0.0) as usize);
        }
        Self {
            kp: robot.pi.kp * scale("kp_scale"),
            ki: robot.pi.ki * scale("ki_scale"),
            windup: value("integrator-windup", "limit_duty"),
            duty_quantum: value("quantisation", "duty_quantum").unwrap_or(duty_quantum),
            shift,
            counts: 1.0 + value(ENCODER_SCALE, LOOP_SCALE).unwrap_or(0.0),
            ..Self::PLAIN
        }
    }
}

/// Ages of counts and set points in ticks, of `sample-order`: of counts, of set points, or of both, as where duties are
/// logged late.
fn shifted(signal: f64, ticks: usize) -> [usize; 2] {
    [signal != 1.0, signal != 0.0].map(|older| if older { ticks } else { 0 })
}

/// The one effect that says how many counts a wheel turn has, and the number that the controller takes for it.
pub(crate) const ENCODER_SCALE: &str = "encoder-scale";
pub(crate) const LOOP_SCALE: &str = "loop_scale";

/// What is read here.
const COLUMNS: Columns =
    Columns { reference: true, counts: true, duty: true, measured: true, sensors: true, ..Columns::NONE };

/// Replays the duties of every run and wheel; says why where it cannot.
pub(crate) fn analyse(
    robot: &Robot,
    logs: &[Log],
    thresholds: &Thresholds,
    remarks: &mut Vec<String>,
) -> Option<ExactLink> {
    let logs = with_loops(robot, logs);
    if logs.is_empty() {
        return None;
    }
    let link = words::controller(robot, &logs).or_law(thresholds.differs[1], remarks, || {
        let logs = at_rate(robot, logs.clone(), thresholds);
        (!logs.is_empty()).then(|| analyse_law(robot, &logs, thresholds))
    })?;
    if !is_replayed(&link, thresholds) && logs.iter().any(|log| has_speeds_alone(log)) {
        remarks.push(NOT_THE_LOOPS.to_owned());
        return None;
    }
    Some(link)
}

/// Why logged speeds from which the duties do not follow say nothing of the loop.
const NOT_THE_LOOPS: &str = "Controller: not compared. The duties do not follow from the logged speeds (speed_1..), which need \
     not be those that the loop measures: log counts, or the loop's speeds as meas_1...";

/// Whether the duties follow to the last digit, by the law of the file or by what was found.
fn is_replayed(link: &ExactLink, thresholds: &Thresholds) -> bool {
    let left = link.finding.as_ref().and_then(|f| f.evidence.wrong_share());
    link.wrong_share.min(left.unwrap_or(f64::INFINITY)) <= thresholds.differs[1]
}

/// Whether the speeds that a log has in place of counts stand for those that the loop measured.
fn has_speeds_alone(log: &Log) -> bool {
    log.layout().source.counts == CountSource::Speeds && log.layout().measured.is_empty()
}

/// Logs with all that a speed loop has; none where the file, as that of another machine may, says nothing of one.
fn with_loops<'a>(robot: &Robot, logs: &'a [Log<'a>]) -> Vec<&'a Log<'a>> {
    let n = robot.wheel_count();
    let no_loop = robot.pi.kp == 0.0 && robot.pi.ki == 0.0 && robot.pi.arithmetic.is_none();
    let whole = |log: &&Log| {
        let has = log.layout();
        !no_loop && has.reference.len() == n && has.counts.len() == n && has.duty.len() == n
    };
    logs.iter().filter(whole).collect()
}

/// Those of them with a row for every period of the loop.
fn at_rate<'a>(robot: &Robot, mut logs: Vec<&'a Log<'a>>, thresholds: &Thresholds) -> Vec<&'a Log<'a>> {
    logs.retain(|r| r.tick_s().is_some_and(|t| (t * robot.control_rate_hz - 1.0).abs() < thresholds.rate));
    logs
}

/// In floating point, by the law of `robot.toml`.
fn analyse_law(robot: &Robot, logs: &[&Log], thresholds: &Thresholds) -> ExactLink {
    let differs = thresholds.differs[1];
    let ([logged, step, floor], nominal) = stated(robot, logs);
    let rms = |law: &Law| -> Vec<f64> { replay(robot, logs, law, floor).into_iter().map(|wheel| wheel.rms).collect() };
    let nominally = replay(robot, logs, &nominal, floor);
    let before: Vec<f64> = nominally.iter().map(|wheel| wheel.rms).collect();
    let wrong = nominally.iter().map(Replayed::wrong_share).fold(0.0, f64::max);
    let wrongly = totals(&nominally);
    let mut link = ExactLink {
        link: Link::Controller,
        unit: "duty",
        floor,
        after: before.clone(),
        before,
        wrong_share: wrong,
        finding: None,
        unexplained: false,
        replay: gaps(robot, logs).words().map(|gaps| Replay {
            remark: format!("Controller: {gaps}; after each the integrators are estimated anew from the duties."),
            ..Replay::default()
        }),
    };
    let total = |e: &[f64]| e.iter().map(|x| x * x).sum::<f64>();
    let start = total(&link.before);
    if wrong <= differs {
        return link;
    }
    let mut best: (f64, Option<Finding>, Vec<f64>) = (start, None, link.before.clone());
    let mut offer = |law: Law, name: &'static str, parameters: Vec<(String, f64, Interval)>| {
        let now = replay(robot, logs, &law, floor);
        let e: Vec<f64> = now.iter().map(|wheel| wheel.rms).collect();
        let with = totals(&now);
        // What it has nothing to go by for, as a delay after a gap, it leaves as wrong as it was.
        let compared = with.all as f64 / wrongly.all.max(1) as f64;
        let left = 1.0 - compared.min(1.0) * (1.0 - with.wrong_share() / wrongly.wrong_share());
        let mends = left <= thresholds.left_wrong;
        if mends && total(&e) < best.0 * 0.999 {
            let evidence = Evidence::Replay { nominal: wrongly, with };
            let finding = Finding { link: Link::Controller, name, wheels: Vec::new(), parameters, evidence };
            best = (total(&e), Some(finding), e);
        }
    };
    let exact = |name: &str, v: f64| (name.to_owned(), v, Interval::Exact);
    for signal in [0.0, 1.0, 2.0] {
        for ticks in 1..=4 {
            let shift = shifted(signal, ticks);
            let parameters = vec![exact("signal", signal), exact("shift_ticks", ticks as f64)];
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
        spacing(logs),
    ] {
        if coarse > step && are_multiples(logs, coarse, floor, differs) {
            offer(Law { duty_quantum: coarse, ..nominal }, "quantisation", vec![exact("duty_quantum", coarse)]);
        }
    }
    let limits: Vec<f64> = (1..=40).map(|k| 0.1 * f64::from(k)).chain([1e9]).collect();
    let windup = limits
        .iter()
        .map(|l| (total(&rms(&Law { windup: Some(*l), ..nominal })), *l))
        .min_by(|a, b| a.0.total_cmp(&b.0));
    if let Some((_, coarse)) = windup {
        let fine = (-10..=10).map(|k| coarse + FINE_LIMIT * f64::from(k)).filter(|l| *l > 0.0);
        let limit = fine
            .map(|l| (total(&rms(&Law { windup: Some(l), ..nominal })), l))
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .map_or(coarse, |b| b.1);
        let ci = Interval::Resolution([limit - FINE_LIMIT, limit + FINE_LIMIT]);
        offer(Law { windup: Some(limit), ..nominal }, "integrator-windup", vec![("limit_duty".to_owned(), limit, ci)]);
    }
    let gains = fit_gains(&nominal, |law| total(&rms(law)));
    let named = |name: &str, v: f64| {
        (name.to_owned(), v, Interval::Resolution([v - (1.0 + v) * FINEST_GAIN, v + (1.0 + v) * FINEST_GAIN]))
    };
    let parameters = vec![
        named("kp_scale", gains.kp / robot.pi.kp - 1.0),
        named("ki_scale", gains.ki / robot.pi.ki.max(1e-12) - 1.0),
    ];
    offer(gains, "pi-gain", parameters);
    // Where another law replays it all, two of them would.
    let replayed = best.1.as_ref().is_some_and(|f| f.evidence.wrong_share().is_some_and(|share| share <= differs));
    if !replayed && let Some((finding, left)) = counts::counted(robot, logs, &nominal, floor, wrongly, differs) {
        best = (total(&left), Some(finding), left);
    }
    if best.0 < (1.0 - thresholds.removes[1]) * start {
        link.after = best.2;
        link.finding = best.1;
    } else {
        // What a stated effect of this link leaves is its remainder, not a new structure.
        link.unexplained = Law::EFFECTS.iter().all(|name| robot.effect(name).is_none());
        if let Some(structure) = told::structure(robot, logs, &nominal, floor, &nominally, thresholds) {
            let replay = link.replay.take().unwrap_or_default();
            link.replay = Some(Replay { structure: Some(structure), ..replay });
        }
    }
    link
}

/// The step of the logged duties, that of the loop, what rounding leaves of them, and the law of `robot.toml`.
fn stated(robot: &Robot, logs: &[&Log]) -> ([f64; 3], Law) {
    let logged = quantum(logs, DUTIES, |r| &r.duty);
    let step = robot.duty_quantum.unwrap_or(if logged > 0.0 { logged.min(0.001) } else { 0.0 });
    ([logged, step, 0.5 * step.max(logged.min(0.001)) + SLACK], Law::stated(robot, step))
}

const DUTIES: Columns = Columns { duty: true, ..Columns::NONE };

fn gaps(robot: &Robot, logs: &[&Log]) -> Gaps {
    let counts = Columns { counts: true, ..Columns::NONE };
    let mut all = Gaps::default();
    for log in logs {
        for part in parts(log, counts) {
            all += Ticks::with_period(robot, &part.run, log.tick_s()).gaps_in(part.own);
        }
    }
    all
}

/// Whether the duties lie on multiples of a step, but for a share of them and the ends of their range. Where they do not, no
/// rounding to it made them, however well it hides what else the loop did.
fn are_multiples(logs: &[&Log], step: f64, floor: f64, differs: f64) -> bool {
    let (mut all, mut off) = (0_usize, 0_usize);
    for log in logs {
        let part = log.part(0..log.len().min(FIRST), DUTIES);
        for duty in part.duty.iter().flatten().filter(|d| d.abs() > floor && d.abs() < 1.0 - floor) {
            all += 1;
            off += usize::from((duty - (duty / step).round() * step).abs() > floor);
        }
    }
    off as f64 <= differs * all as f64
}

/// Most duties that are looked at for their levels.
const LEVELS: usize = 1_000_000;

/// Distance between neighbouring values of the duties, by a line through all levels.
fn spacing(logs: &[&Log]) -> f64 {
    let mut values: Vec<f64> = Vec::new();
    for log in logs {
        let part = log.part(0..log.len().min(FIRST), DUTIES);
        let levels = part.duty.iter().flatten().map(|d| d.abs()).filter(|d| *d > 1e-6 && *d < 0.999);
        values.extend(levels.take(LEVELS - values.len()));
    }
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

/// Pattern search over both gains, steps from 20 % down to 0.05 %; longer again where a short one helped, as along a valley.
fn fit_gains(nominal: &Law, cost: impl Fn(&Law) -> f64) -> Law {
    /// Factor of a step that did not help.
    const SHORTER: f64 = 0.4;
    const LONGEST: f64 = 0.2;
    /// Share of the cost that a step must take away: a gain that is best at 0 is halved for ever, for less each time.
    const TELLS: f64 = 1e-6;
    let mut best = (cost(nominal), *nominal);
    let mut step = LONGEST;
    while step > FINEST_GAIN {
        let mut better = false;
        for (p, i) in [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0), (1.0, 1.0), (-1.0, -1.0)] {
            let (_, now) = best;
            let law = Law { kp: now.kp * (1.0 + step * p), ki: now.ki * (1.0 + step * i), ..now };
            let c = cost(&law);
            if c < (1.0 - TELLS) * best.0 {
                best = (c, law);
                better = true;
            }
        }
        step = if better { LONGEST.min(step / SHORTER) } else { step * SHORTER };
    }
    best.1
}

#[cfg(test)]
mod tests {
    use std::borrow::Cow;

    use runs::Run;

    use super::*;

    #[test]
    fn a_rounding_that_the_duties_do_not_show_is_none() {
        let multiples = |logged: &dyn Fn(usize) -> f64, step: f64| {
            let duty: Vec<f64> = (0..1000).map(logged).collect();
            let t = (0..duty.len()).map(|k| 0.001 * k as f64).collect();
            let log = Log::from(Cow::Owned(Run { t, duty: vec![duty], ..Run::default() }));
            are_multiples(&[&log], step, 0.000_5 + SLACK, Thresholds::default().differs[1])
        };
        let thousandths = |k: usize| 0.001 * (k as f64 - 500.0);
        assert!(multiples(&thousandths, 0.001) && !multiples(&thousandths, 0.002) && !multiples(&thousandths, 0.0625));
        // As a logger of three digits has sixteenths; what saturates lies on no level.
        let sixteenths = |k: usize| if k.is_multiple_of(7) { 1.0 } else { (62.5 * (k % 16) as f64).round() / 1000.0 };
        assert!(multiples(&sixteenths, 0.0625) && !multiples(&sixteenths, 0.1));
    }
}
