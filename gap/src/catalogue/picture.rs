//! A picture an effect: what it changes in what is logged, by the simulator itself.

use model::effects::Applied;
use model::manoeuvre::{Manoeuvre, simulate};
use plot::{Axis, Color, Figure, Panel, Series};
use runs::Run;
use runs::frames::{Pose, wrap_angle};
use runs::robot::{Effect as Written, EffectParameter, ImuMount, Robot, SensorName};

use crate::units::{short, si as unit};
use links::effect::{Effect, Form, Link};

/// Manoeuvres that a picture may be of.
const DRIVES: [Manoeuvre; 6] =
    [Manoeuvre::Square, Manoeuvre::Star, Manoeuvre::Spin, Manoeuvre::StopAndGo, Manoeuvre::Creep, Manoeuvre::FullDuty];
/// Sizes as multiples of the least that is worth a name: the first that shows is drawn.
const SIZES: [f64; 8] = [1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0];
/// Root mean square of the change, as a share of that of the signal, that an eye sees.
const SHOWS: f64 = 0.12;
/// Ticks over which speeds and duties are averaged: a tenth of a second, against the steps of the counter.
const AVERAGED: usize = 100;
/// Share of its bounds that a parameter may use up.
const WITHIN: f64 = 0.7;
/// Parameters that the legend has room for.
const NAMED: usize = 2;
/// Points of a curve: no more show at this width.
const POINTS: usize = 150;
/// Time of a signal that is drawn, s: the whole of a drive would be a hedge.
const SHOWN_S: f64 = 3.0;

/// Values of effects that are replayed, which have no least size.
const EXACT: [(&str, &[(&str, f64)]); 6] = [
    ("command-latency", &[("latency_s", 0.1)]),
    ("pi-gain", &[("kp_scale", -0.8), ("ki_scale", 0.0)]),
    ("integrator-windup", &[("limit_duty", 3.0)]),
    ("quantisation", &[("duty_quantum", 0.1)]),
    ("sample-order", &[("signal", 0.0), ("shift_ticks", 8.0)]),
    ("wheel-order", &[("cable_1", 2.0), ("cable_2", 1.0), ("cable_3", 3.0)]),
];

/// What is drawn of a run.
struct Signal {
    label: String,
    unit: &'static str,
    /// Whether the points are a map instead of values over time.
    map: bool,
    /// Size below which a signal is not one: a quarter of what is usual in a drive.
    least: f64,
    points: Vec<[f64; 2]>,
}

fn signals(run: &Run, robot: &Robot, link: Link) -> Vec<Signal> {
    let over = |label: String, unit, least, points| Signal { label, unit, map: false, least, points };
    let column = |values: &[f64]| -> Vec<[f64; 2]> {
        let mean = |k: usize| {
            let part = &values[k.saturating_sub(AVERAGED)..=k];
            part.iter().sum::<f64>() / part.len() as f64
        };
        (0..run.len()).map(|k| [run.t[k], mean(k)]).collect()
    };
    if link == Link::Motion {
        let seen = || run.camera.iter().map(|sample| (run.t[sample.tick], sample.pose));
        let map = seen().map(|(_, pose)| [pose.x, pose.y]).collect();
        let mut before = run.camera.first().map_or(0.0, |sample| sample.pose.theta);
        let mut turned = before;
        let heading = seen().map(|(t, pose)| {
            turned += wrap_angle(pose.theta - before);
            before = pose.theta;
            [t, turned.to_degrees()]
        });
        let heading = heading.collect();
        return vec![
            Signal { label: "path as the camera sees it".to_owned(), unit: "m", map: true, least: 0.15, points: map },
            over("heading seen".to_owned(), "°", 20.0, heading),
        ];
    }
    if link.is_inertial() {
        let axes = |columns: &Option<[Vec<f64>; 3]>| columns.iter().flatten().map(|c| column(c)).collect::<Vec<_>>();
        let named = |points: Vec<Vec<[f64; 2]>>, what: &str, unit, least| {
            let signal = |(points, axis)| over(format!("{what}_{axis}"), unit, least, points);
            points.into_iter().zip(["x", "y", "z"]).map(signal).collect::<Vec<_>>()
        };
        let mut all = named(axes(&run.gyro), "gyro", "rad/s", 0.5);
        all.extend(named(axes(&run.acceleration), "acc", "m/s²", 0.3).into_iter().take(2));
        return all;
    }
    let wheels = 0..run.duty.len();
    if link == Link::Command {
        let steps = |i: usize| run.t.iter().zip(&run.reference[i]).map(|(t, v)| [*t, *v]).collect();
        return wheels.map(|i| over(format!("set point {}", i + 1), "rad/s", 5.0, steps(i))).collect();
    }
    let speeds = wheels.clone().filter(|_| link == Link::Drive).map(|i| {
        let per = 1.0 / (robot.counts_per_wheel_rad() * AVERAGED as f64 * robot.tick_s());
        let speed = |k: usize| (run.counts[i][k] - run.counts[i][k.saturating_sub(AVERAGED)]) as f64 * per;
        let points = (0..run.len()).map(|k| [run.t[k], speed(k)]).collect();
        over(format!("speed of wheel {}", i + 1), "rad/s", 1.0, points)
    });
    let duties = wheels.clone().map(|i| over(format!("duty {}", i + 1), "", 0.03, column(&run.duty[i])));
    speeds.chain(duties).collect()
}

/// Root mean square of the change as a share of that of the signal, and where it is largest.
fn change(nominal: &Signal, changed: &Signal) -> (f64, usize) {
    let apart = |[a, b]: [[f64; 2]; 2]| {
        let x = if nominal.map { a[0] - b[0] } else { 0.0 };
        x * x + (a[1] - b[1]).powi(2)
    };
    let n = nominal.points.len().min(changed.points.len());
    let differences: Vec<f64> = (0..n).map(|k| apart([nominal.points[k], changed.points[k]])).collect();
    let middle = [0, 1].map(|axis| nominal.points.iter().map(|p| p[axis]).sum::<f64>() / n as f64);
    let size: f64 = nominal.points.iter().map(|p| apart([*p, middle])).sum();
    let largest = (0..n).max_by(|a, b| differences[*a].total_cmp(&differences[*b])).unwrap_or(0);
    ((differences.iter().sum::<f64>() / size.max(nominal.least.powi(2) * n as f64)).sqrt(), largest)
}

fn run(manoeuvre: Manoeuvre, values: &[(String, f64)], name: &str, link: Link) -> Option<Run> {
    let imu = SensorName::new("icm-42688-p").filter(|_| link.is_inertial()).map(ImuMount::upright);
    let robot = Robot { imu, ..Robot::racbot() };
    let parameters = values.iter().map(|(name, value)| {
        let parameter = EffectParameter { value: *value, ..EffectParameter::default() };
        (name.clone(), parameter)
    });
    let written = Written { name: name.to_owned(), parameters: parameters.collect(), ..Written::default() };
    let effects = if values.is_empty() { Vec::new() } else { vec![written] };
    let mut applied = Applied::of(&Robot { effects, ..robot.clone() });
    applied.camera.noise = [0.0; 3];
    simulate(manoeuvre, &applied, &robot, Pose::new(0.4, -0.3, 0.5), 1).ok()
}

/// Values of a form at a multiple of the least that is worth a name; of several wheels only the first has it.
fn sized(form: &Form, times: f64) -> Vec<(String, f64)> {
    let others = form.wheels.iter().skip(1).map(|wheel| (wheel + 1).to_string());
    let others: Vec<String> = others.collect();
    let free = form.free.iter().filter(|p| !p.name.split('_').any(|part| others.iter().any(|o| o == part)));
    let free = free.map(|p| {
        let own = match (p.below, p.start) {
            (Some(limit), _) => limit / times,
            (None, Some(start)) => start,
            _ if p.material.is_finite() && p.material > 0.0 => times * p.material,
            _ => times * p.scale,
        };
        (p.name.clone(), own.clamp(WITHIN * p.bounds[0], WITHIN * p.bounds[1]))
    });
    form.fixed.iter().cloned().chain(free).collect()
}

/// The picture of an effect whose link is this; `None` where the simulator does not have it.
pub(super) fn picture(name: &str, link: Link, effect: Option<&dyn Effect>) -> Option<String> {
    let exact = EXACT.iter().find(|(n, _)| *n == name).map(|(_, values)| {
        let values = values.iter().map(|(n, v)| ((*n).to_owned(), *v));
        values.collect::<Vec<_>>()
    });
    let link = if name == "wheel-order" { Link::Motion } else { link };
    let forms = effect.map_or_else(Vec::new, |effect| effect.forms(&Robot::racbot()));
    let sizes: Vec<Vec<(String, f64)>> = match exact {
        Some(values) => vec![values],
        // One wheel shows more than all.
        None => {
            let form = forms.iter().find(|form| form.wheels == [0]).or(forms.first())?;
            SIZES.iter().map(|times| sized(form, *times)).collect()
        }
    };
    let robot = Robot::racbot();
    let drives = if link == Link::Motion || link.is_inertial() { &DRIVES[..DRIVES.len() - 1] } else { &DRIVES[..] };
    // What comes late lies on the same path.
    let late = ["latency", "lag"].iter().any(|part| name.contains(part));
    let nominal: Vec<Vec<Signal>> =
        drives.iter().filter_map(|m| Some(signals(&run(*m, &[], "", link)?, &robot, link))).collect();
    let mut best: Option<(f64, Signal, usize, usize, usize)> = None;
    for (size, values) in sizes.iter().enumerate() {
        for (drive, manoeuvre) in drives.iter().enumerate() {
            let Some(run) = run(*manoeuvre, values, name, link) else { continue };
            for (number, changed) in signals(&run, &robot, link).into_iter().enumerate() {
                let (share, _) = change(&nominal[drive][number], &changed);
                if share.is_finite() && !(late && changed.map) && best.as_ref().is_none_or(|b| share > b.0) {
                    best = Some((share, changed, drive, number, size));
                }
            }
        }
        if best.as_ref().is_some_and(|b| b.0 > SHOWS) {
            break;
        }
    }
    let (share, changed, drive, number, size) = best?;
    if share < 1e-3 {
        return None;
    }
    let at = change(&nominal[drive][number], &changed).1;
    Some(draw(name, DRIVES[drive], &sizes[size], [&nominal[drive][number], &changed], at))
}

fn draw(
    name: &str,
    manoeuvre: Manoeuvre,
    values: &[(String, f64)],
    [nominal, changed]: [&Signal; 2],
    at: usize,
) -> String {
    let parts: Vec<String> = values
        .iter()
        .take(NAMED)
        .map(|(name, value)| {
            let unit = unit(name);
            let space = if unit.is_empty() { "" } else { " " };
            format!("{name} = {}{space}{unit}", short(*value))
        })
        .collect();
    let middle = nominal.points[at.min(nominal.points.len() - 1)][0];
    let last = nominal.points.last().map_or(0.0, |p| p[0]);
    let from = (middle - 0.5 * SHOWN_S).min(last - SHOWN_S).max(0.0);
    let cut = |signal: &Signal| {
        let shown = |p: &&[f64; 2]| signal.map || (from..=from + SHOWN_S).contains(&p[0]);
        let points: Vec<[f64; 2]> = signal.points.iter().filter(shown).copied().collect();
        let every = points.len().div_ceil(POINTS).max(1);
        points.into_iter().step_by(every).collect::<Vec<_>>()
    };
    let (x, y) = if nominal.map {
        (Axis::new("x", "m"), Axis::new("y", "m"))
    } else {
        (Axis::new("time", "s"), Axis::new(nominal.label.clone(), nominal.unit))
    };
    let panel = Panel::new(x, y).height(200.0);
    let panel = if nominal.map { panel.equal_aspect() } else { panel };
    let panel = panel
        .title(if nominal.map { nominal.label.clone() } else { String::new() })
        .with(Series::line("without", cut(nominal)).color(Color::Grey))
        .with(Series::line(parts.join(", "), cut(changed)).color(Color::Red));
    Figure::new(format!("{name}, driving: {}", manoeuvre.name())).with(panel).to_svg()
}
