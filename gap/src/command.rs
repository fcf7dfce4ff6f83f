//! The `command` link: body command to wheel set points, by the inverse kinematics.

use runs::geometry::Geometry;
use runs::robot::Robot;
use runs::ticks::Ticks;
use runs::{Columns, Log};

use crate::effect::Link;
use crate::evidence::{Evidence, Interval};
use crate::exact::{ExactLink, Finding, quantum};
use crate::parts::parts;
use crate::words;

/// Longest latency looked for, s.
const LONGEST_S: f64 = 0.3;
/// Share of ticks that may differ (a command that arrived within the tick).
const WRONG_SHARE: f64 = 0.01;
/// A hypothesis must remove this share of the error's square.
const REMOVED: f64 = 0.9;

/// Compares the logged set points with those the geometry makes of the logged commands.
pub(crate) fn analyse(
    robot: &Robot,
    geometry: &Geometry,
    logs: &[Log],
    remarks: &mut Vec<String>,
) -> Option<ExactLink> {
    let n = robot.wheel_count();
    let whole = |log: &&Log| log.layout().command.is_some() && log.layout().reference.len() == n;
    let logs: Vec<&Log> = logs.iter().filter(whole).collect();
    if logs.is_empty() {
        return None;
    }
    words::command(robot, &logs).or_law(WRONG_SHARE, remarks, || Some(analyse_matrix(robot, geometry, &logs)))
}

/// What is read here.
const COLUMNS: Columns = Columns { command: true, reference: true, ..Columns::NONE };

/// In floating point, by the geometry of `robot.toml`.
fn analyse_matrix(robot: &Robot, geometry: &Geometry, logs: &[&Log]) -> ExactLink {
    let n = robot.wheel_count();
    let references = Columns { reference: true, ..Columns::NONE };
    let quantum_ref = robot.ref_quantum.unwrap_or_else(|| quantum(logs, references, |r| &r.reference));
    let commands = Columns { command: true, ..Columns::NONE };
    let quantum_cmd = quantum(logs, commands, |r| r.command.as_ref().map_or(&[], |c| &c[..]));
    let rows: Vec<[f64; 3]> = (0..n).map(|i| [0, 1, 2].map(|j| geometry.inverse()[(i, j)])).collect();
    let steepest = rows.iter().map(|r| r.iter().map(|v| v.abs()).sum::<f64>()).fold(0.0, f64::max);
    let tolerance = 0.51 * quantum_ref + 0.51 * quantum_cmd * steepest + 1e-6;
    // RMS error of every axis, set points compared, and those that are wrong.
    let compared = |order: &[(usize, f64)], delay: f64| -> (Vec<f64>, [u64; 2]) {
        let mut sums = vec![0.0; n];
        let mut count = 0.0_f64;
        let (mut all, mut wrong) = (0, 0);
        for (log, part) in logs.iter().flat_map(|log| parts(log, COLUMNS).map(move |part| (log, part))) {
            let run = &part.run;
            let Some(command) = &run.command else { continue };
            let ticks = Ticks::with_period(robot, run, log.tick_s());
            let back = (delay / log.tick_s().unwrap_or(1.0)).round() as usize;
            let mut steady = 0;
            for k in part.own.start.saturating_sub(back + 1)..part.own.end {
                // Behind a gap nobody knows what was commanded in it.
                steady = if ticks.since(k) == 1 { steady + 1 } else { 0 };
                if steady < back || k < part.own.start {
                    continue;
                }
                let c = [0, 1, 2].map(|j| command[j][k - back]);
                count += 1.0;
                for i in 0..n {
                    let (row, sign) = order[i];
                    let expected = sign * (0..3).map(|j| rows[row][j] * c[j]).sum::<f64>();
                    let e = ((run.reference[i][k] - expected).abs() - tolerance).max(0.0);
                    if e.is_finite() {
                        sums[i] += e * e;
                        all += 1;
                        wrong += u64::from(e > 0.0);
                    }
                }
            }
        }
        (sums.iter().map(|s| (s / count.max(1.0)).sqrt()).collect(), [all, wrong])
    };
    let errors = |order: &[(usize, f64)], delay: f64| compared(order, delay).0;
    let straight = given_order(robot, n);
    let (before, [_, wrong_before]) = compared(&straight, 0.0);
    let replayed = |order: &[(usize, f64)], delay: f64| {
        let [ticks, wrong] = compared(order, delay).1;
        Evidence::Replay { ticks, wrong: [wrong_before, wrong] }
    };
    let size = references_rms(logs).max(1e-9);
    let total = |e: &[f64]| e.iter().map(|x| x * x).sum::<f64>();
    let wrong = wrong_share(logs, &rows, &straight, tolerance);
    let floor = tolerance;
    let mut link = ExactLink {
        link: Link::Command,
        unit: "rad/s",
        floor,
        after: before.clone(),
        before,
        wrong_share: wrong,
        finding: None,
        unexplained: false,
        replay: None,
    };
    if wrong <= WRONG_SHARE || total(&link.before).sqrt() < 1e-3 * size {
        return link;
    }
    // Every order and sign of the rows, and every latency.
    let mut best: (f64, Option<Finding>, Vec<f64>) = (total(&link.before), None, link.before.clone());
    for order in orders(n) {
        let e = errors(&order, 0.0);
        if total(&e) < best.0 * 0.999 {
            let wheels = (0..n).filter(|i| order[*i] != (*i, 1.0)).collect();
            let parameters = order
                .iter()
                .enumerate()
                .map(|(i, (row, sign))| {
                    let v = sign * (*row as f64 + 1.0);
                    (format!("axis_{}", i + 1), v, Interval::Exact)
                })
                .collect();
            let evidence = replayed(&order, 0.0);
            let finding = Finding { link: Link::Command, name: "wheel-order", wheels, parameters, evidence };
            best = (total(&e), Some(finding), e);
        }
    }
    let tick = logs[0].tick_s().unwrap_or(0.001);
    let most = (LONGEST_S / tick) as usize;
    let coarse = (most / 60).max(1);
    let at = |ticks: usize| total(&errors(&straight, ticks as f64 * tick));
    let start = (0..=most).step_by(coarse).map(|t| (at(t), t)).min_by(|a, b| a.0.total_cmp(&b.0)).map_or(0, |b| b.1);
    let range = start.saturating_sub(coarse)..=(start + coarse).min(most);
    if let Some((e, ticks)) = range.map(|t| (at(t), t)).min_by(|a, b| a.0.total_cmp(&b.0))
        && ticks > 0
        && e < best.0 * 0.999
    {
        let latency = ticks as f64 * tick;
        let parameters =
            vec![("latency_s".to_owned(), latency, Interval::Resolution([latency - 0.5 * tick, latency + 0.5 * tick]))];
        let evidence = replayed(&straight, latency);
        let finding =
            Finding { link: Link::Command, name: "command-latency", wheels: Vec::new(), parameters, evidence };
        best = (e, Some(finding), errors(&straight, latency));
    }
    if best.0 < (1.0 - REMOVED) * total(&link.before) {
        link.after = best.2;
        link.finding = best.1;
    } else {
        link.unexplained = true;
    }
    link
}

/// Row and sign of every set point, as the robot's file has them.
fn given_order(robot: &Robot, n: usize) -> Vec<(usize, f64)> {
    let given = robot.effect("wheel-order");
    let axis = |i: usize| given.and_then(|e| e.value(&format!("axis_{}", i + 1))).unwrap_or(i as f64 + 1.0);
    let row = |axis: f64| ((axis.abs().round() as usize).clamp(1, n) - 1, if axis < 0.0 { -1.0 } else { 1.0 });
    (0..n).map(|i| row(axis(i))).collect()
}

/// RMS of all set points.
fn references_rms(logs: &[&Log]) -> f64 {
    let (mut square, mut count) = (0.0, 0.0_f64);
    for part in logs.iter().flat_map(|log| parts(log, COLUMNS)) {
        for reference in part.run.reference.iter().flat_map(|r| &r[part.own.clone()]) {
            square += reference.abs().max(0.0).powi(2);
            count += 1.0;
        }
    }
    (square / count.max(1.0)).sqrt()
}

fn wrong_share(logs: &[&Log], rows: &[[f64; 3]], order: &[(usize, f64)], tolerance: f64) -> f64 {
    let (mut wrong, mut all) = (0.0, 0.0_f64);
    for part in logs.iter().flat_map(|log| parts(log, COLUMNS)) {
        let run = &part.run;
        let Some(command) = &run.command else { continue };
        for k in part.own.clone() {
            for (i, (row, sign)) in order.iter().enumerate() {
                let expected = sign * (0..3).map(|j| rows[*row][j] * command[j][k]).sum::<f64>();
                let e = (run.reference[i][k] - expected).abs();
                if e.is_finite() {
                    all += 1.0;
                    wrong += f64::from(u8::from(e > tolerance));
                }
            }
        }
    }
    wrong / all.max(1.0)
}

/// Every order of `n` wheels with every sign: 48 for three.
pub(crate) fn orders(n: usize) -> Vec<Vec<(usize, f64)>> {
    if n > 4 {
        return Vec::new();
    }
    let mut permutations: Vec<Vec<usize>> = vec![Vec::new()];
    for _ in 0..n {
        permutations = permutations
            .into_iter()
            .flat_map(|p| (0..n).filter(|i| !p.contains(i)).map(|i| [p.clone(), vec![i]].concat()).collect::<Vec<_>>())
            .collect();
    }
    let signs = 1_usize << n;
    permutations
        .iter()
        .flat_map(|p| {
            (0..signs)
                .map(|s| p.iter().enumerate().map(|(i, w)| (*w, if s >> i & 1 == 1 { -1.0 } else { 1.0 })).collect())
        })
        .collect()
}
