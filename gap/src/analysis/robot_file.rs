//! The robot's file at both ends of an analysis: completed by the logs, and with what was found.

use std::sync::Arc;

use runs::robot::{Effect as RobotEffect, EffectParameter, Robot, Support};
use runs::{Columns, Log, Logs, as_logged};

use super::found::Named;
use super::order::TWO_SIDED;
use crate::evidence::Interval;
use crate::options::Options;
use crate::parts::{Part, parts};
use crate::state::Active;
use links::effect::{Effect, Values};

/// The robot with what its file leaves to the logs. A motor behind a current controller, or one that is never used
/// up to its speed, has no no-load speed by which to call an effect large: it is then taken as four times the
/// fastest turn in the logs, which is how robots are driven.
pub(super) fn completed(robot: &Robot, logs: &[Log]) -> Robot {
    const USUAL: f64 = 4.0;
    const UNUSUAL: f64 = 20.0;
    let source = logs.first().map(|log| log.layout().source).unwrap_or_default();
    let robot = &as_logged(robot, source, logs.iter().find_map(Log::tick_s));
    let columns = Columns { counts: true, ..Columns::NONE };
    let of_part = |part: Part| part.run.counts.iter().map(|c| fastest(&part.run.t, c)).fold(0.0, f64::max);
    let fastest = logs.iter().flat_map(|log| parts(log, columns)).map(of_part);
    let fastest = fastest.fold(0.0, f64::max) / robot.counts_per_wheel_rad();
    let unusual = fastest > 0.0 && robot.no_load_wheel_speed(robot.supply_v) > UNUSUAL * fastest;
    let mut completed = robot.clone();
    if unusual {
        completed.top_speed_rad_s = Some(USUAL * fastest);
    }
    if robot.camera_rate_hz <= 0.0 {
        let between = |log: &Log| -> Vec<f64> { log.camera().windows(2).map(|f| f[1].t - f[0].t).collect() };
        let mut apart: Vec<f64> = logs.iter().flat_map(between).collect();
        apart.sort_by(f64::total_cmp);
        // Stamps are rounded to ticks, and frames get lost: the mean of what lies about the median.
        let median = apart.get(apart.len() / 2).copied().unwrap_or(1.0 / 60.0);
        apart.retain(|x| (x / median - 1.0).abs() < 0.4);
        let sum: f64 = apart.iter().sum();
        completed.camera_rate_hz = if sum > 0.0 { apart.len() as f64 / sum } else { 1.0 / median };
    }
    completed
}

/// Most counts a second over 50 ms.
fn fastest(t: &[f64], counts: &[i64]) -> f64 {
    let mut first = 0;
    let mut most = 0.0_f64;
    for k in 1..t.len().min(counts.len()) {
        while first + 1 < k && t[k] - t[first + 1] >= 0.05 {
            first += 1;
        }
        if t[k] - t[first] >= 0.05 {
            most = most.max(counts[k].abs_diff(counts[first]) as f64 / (t[k] - t[first]));
        }
    }
    most
}

/// The effects that the robot's file carries already.
pub(super) fn given(robot: &Robot, catalogue: &[Arc<dyn Effect>]) -> Vec<Active> {
    robot
        .effects
        .iter()
        .filter_map(|e| {
            let effect = catalogue.iter().find(|c| c.name() == e.name)?.clone();
            let values = Values(e.parameters.iter().map(|(n, p)| (n.clone(), p.value)).collect());
            let link = effect.link();
            Some(Active {
                effect,
                form: links::effect::Form::default(),
                values,
                immaterial: false,
                link,
                given: true,
                together: false,
            })
        })
        .collect()
}

/// The file of a robot with effects: the one it came from with these effects, if that is to be found.
pub(super) fn robot_text(set: &Logs, options: &Options, robot: &Robot) -> String {
    let file = options.robot_file.clone().unwrap_or_else(|| set.folder.join("robot.toml"));
    // A log of one axis speaks of a part of the robot.
    let nominal = |r: &Robot| match r.support {
        Support::Floor => Robot { effects: Vec::new(), ..r.clone() },
        Support::Blocks => Robot { effects: Vec::new(), ..r.first_axes(robot.wheel_count()) },
    };
    std::fs::read_to_string(&file)
        .ok()
        .filter(|text| Robot::parse_partial(text, &file).is_ok_and(|r| nominal(&r) == nominal(robot)))
        .and_then(|text| Robot::edited(&text, &robot.effects, &file).ok())
        .unwrap_or_else(|| robot.to_toml())
}

/// The robot with the named effects in its file, each with its evidence.
pub(super) fn with_effects(robot: &Robot, named: &[Named], alternatives: &[Vec<String>], runs: &[String]) -> Robot {
    let mut out = robot.clone();
    for n in named {
        let mut other = toml::Table::new();
        let strings = |v: &[String]| toml::Value::Array(v.iter().map(|s| toml::Value::String(s.clone())).collect());
        other.insert("runs".to_owned(), strings(runs));
        other.insert("gain".to_owned(), toml::Value::Float((n.gain * 1e4).round() / 1e4));
        other.insert("evidence".to_owned(), toml::Value::String(n.evidence.kind().to_owned()));
        if let Some(p) = n.evidence.p_value() {
            other.insert("p_value".to_owned(), toml::Value::Float(p));
        }
        let twins: Vec<String> =
            alternatives.iter().filter(|a| a.contains(&n.name)).flatten().filter(|x| **x != n.name).cloned().collect();
        if !twins.is_empty() {
            other.insert("cannot_be_told_from".to_owned(), strings(&twins));
        }
        if !n.conditional_on.is_empty() {
            other.insert("conditional_on".to_owned(), strings(&n.conditional_on));
        }
        let parameters: Vec<(String, EffectParameter)> = n
            .parameters
            .iter()
            .map(|(name, value, interval)| {
                let mut parameter = EffectParameter { value: *value, ..EffectParameter::default() };
                match interval {
                    Interval::Ci95(ends) => parameter.ci95 = Some(*ends),
                    known => {
                        if let (Some(key), Some(ends)) = (known.key(), known.ends()) {
                            let ends = ends.map(toml::Value::Float).to_vec();
                            parameter.other.insert(key.to_owned(), toml::Value::Array(ends));
                        }
                    }
                }
                (name.clone(), parameter)
            })
            .collect();
        let mut effect = RobotEffect { name: n.name.clone(), wheels: n.wheels.clone(), parameters, other };
        if let Some(at) = out.effects.iter().position(|e| e.name == n.name) {
            let before = out.effects.remove(at);
            if TWO_SIDED.contains(&n.name.as_str()) {
                // The other side of it stays.
                let news: Vec<String> = effect.parameters.iter().map(|(name, _)| name.clone()).collect();
                effect.parameters.extend(before.parameters.into_iter().filter(|(name, _)| !news.contains(name)));
                effect.wheels.extend(before.wheels);
                effect.wheels.sort_unstable();
                effect.wheels.dedup();
            }
        }
        out.effects.push(effect);
    }
    out
}

/// The robot without an effect; `None` if it has none of this name.
pub fn undo(robot: &Robot, name: &str) -> Option<Robot> {
    let mut out = robot.clone();
    out.effects.retain(|e| e.name != name);
    (out.effects.len() < robot.effects.len()).then_some(out)
}
