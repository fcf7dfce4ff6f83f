//! The `command` link: body command to wheel set points, by the inverse kinematics.

use runs::geometry::Geometry;
use runs::robot::Robot;
use runs::ticks::Ticks;
use runs::{Columns, Log};

use crate::evidence::{self, Evidence, Interval};
use crate::exact::{ExactLink, Finding, quantum};
use crate::parts::parts;
use crate::thresholds::Thresholds;
use crate::words;
use links::effect::Link;

/// Longest latency looked for, s.
const LONGEST_S: f64 = 0.3;

/// Compares the logged set points with those the geometry makes of the logged commands.
pub(crate) fn analyse(
    robot: &Robot,
    geometry: &Geometry,
    logs: &[Log],
    thresholds: &Thresholds,
    remarks: &mut Vec<String>,
) -> Option<ExactLink> {
    let n = robot.wheel_count();
    let whole = |log: &&Log| log.layout().command.is_some() && log.layout().reference.len() == n;
    let logs: Vec<&Log> = logs.iter().filter(whole).collect();
    if logs.is_empty() {
        return None;
    }
    let law = || Some(analyse_matrix(robot, geometry, &logs, thresholds));
    words::command(robot, &logs).or_law(thresholds.differs[0], remarks, law)
}

/// What is read here.
const COLUMNS: Columns = Columns { command: true, reference: true, ..Columns::NONE };

/// Row of the inverse kinematics and sign of every set point.
type Order = Vec<(usize, f64)>;

/// How late commands act, in ticks of the log.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct Late {
    ticks: usize,
    /// Whether some act a tick later still: two clocks that slide past each other.
    or_one_more: bool,
}

impl Late {
    /// Of a latency: one that is no whole number of ticks is that of commands some of which act a tick later.
    fn of(latency_s: f64, tick_s: f64) -> Self {
        const WHOLE: f64 = 1e-6;
        let ticks = (latency_s / tick_s).max(0.0);
        let whole = (ticks + WHOLE).floor();
        Self { ticks: whole as usize, or_one_more: ticks - whole > WHOLE }
    }
}

/// Set points against those of the commands.
struct Compared {
    /// RMS beyond rounding of every axis, rad/s.
    rms: Vec<f64>,
    /// Set points that were compared, those that are wrong, and those that follow the command a tick older.
    all: u64,
    wrong: u64,
    older: u64,
}

impl Compared {
    fn square(&self) -> f64 {
        self.rms.iter().map(|x| x * x).sum()
    }

    fn ticks(&self) -> evidence::Ticks {
        evidence::Ticks { all: self.all, wrong: self.wrong }
    }
}

/// The logs and what their set points should be.
struct Matrix<'a> {
    robot: &'a Robot,
    logs: &'a [&'a Log<'a>],
    rows: Vec<[f64; 3]>,
    /// What rounding of commands and set points to a fixed step leaves, rad/s; to a number of digits see `digits`.
    tolerance: f64,
    /// Share of ticks that may differ.
    differs: f64,
    /// See [`Thresholds::digits`].
    digits: f64,
}

impl Matrix<'_> {
    fn compared(&self, order: &Order, late: Late) -> Compared {
        let n = order.len();
        let mut sums = vec![0.0; n];
        let (mut count, mut all, mut wrong, mut older) = (0.0_f64, 0, 0, 0);
        let back = late.ticks + usize::from(late.or_one_more);
        for (log, part) in self.logs.iter().flat_map(|log| parts(log, COLUMNS).map(move |part| (log, part))) {
            let run = &part.run;
            let Some(command) = &run.command else { continue };
            let ticks = Ticks::with_period(self.robot, run, log.tick_s());
            let mut steady = 0;
            for k in part.own.start.saturating_sub(back + 1)..part.own.end {
                // After a gap it is unknown what was commanded in it.
                steady = if ticks.since(k) == 1 { steady + 1 } else { 0 };
                if steady < back || k < part.own.start {
                    continue;
                }
                count += 1.0;
                for i in 0..n {
                    let (row, sign) = order[i];
                    let off = |ticks: usize| {
                        let terms = [0, 1, 2].map(|j| self.rows[row][j] * command[j][k - ticks]);
                        let expected = sign * terms.iter().sum::<f64>();
                        let digits = self.digits * terms.iter().map(|x| x.abs()).sum::<f64>();
                        ((run.reference[i][k] - expected).abs() - self.tolerance - digits).max(0.0)
                    };
                    let mut e = off(late.ticks);
                    if late.or_one_more && e > 0.0 {
                        let before = off(back);
                        older += u64::from(before == 0.0);
                        e = e.min(before);
                    }
                    if e.is_finite() {
                        sums[i] += e * e;
                        all += 1;
                        wrong += u64::from(e > 0.0);
                    }
                }
            }
        }
        let rms = sums.iter().map(|s| (s / count.max(1.0)).sqrt()).collect();
        Compared { rms, all, wrong, older }
    }

    /// With a stated latency; a few commands may have arrived within their tick and act in the next.
    fn stated(&self, order: &Order, late: Late) -> Compared {
        let or_one_more = self.compared(order, Late { or_one_more: true, ..late });
        if or_one_more.older as f64 <= self.differs * or_one_more.all as f64 {
            return or_one_more;
        }
        self.compared(order, late)
    }
}

/// In floating point, by the geometry of `robot.toml` and the order and latency that it states.
fn analyse_matrix(robot: &Robot, geometry: &Geometry, logs: &[&Log], thresholds: &Thresholds) -> ExactLink {
    let differs = thresholds.differs[0];
    let n = robot.wheel_count();
    let references = Columns { reference: true, ..Columns::NONE };
    let quantum_ref = robot.ref_quantum.unwrap_or_else(|| quantum(logs, references, |r| &r.reference));
    let commands = Columns { command: true, ..Columns::NONE };
    let quantum_cmd = quantum(logs, commands, |r| r.command.as_ref().map_or(&[], |c| &c[..]));
    let rows: Vec<[f64; 3]> = (0..n).map(|i| [0, 1, 2].map(|j| geometry.inverse()[(i, j)])).collect();
    let steepest = rows.iter().map(|r| r.iter().map(|v| v.abs()).sum::<f64>()).fold(0.0, f64::max);
    let tolerance = 0.51 * quantum_ref + 0.51 * quantum_cmd * steepest + 1e-6;
    let matrix = Matrix { robot, logs, rows, tolerance, differs, digits: thresholds.digits };
    let tick = logs[0].tick_s().unwrap_or(0.001);
    let filed = robot.effect("command-latency").and_then(|e| e.value("latency_s")).map(|s| Late::of(s, tick));
    let straight = given_order(robot, n);
    let stated = matrix.stated(&straight, filed.unwrap_or_default());
    let mut link = ExactLink {
        link: Link::Command,
        unit: "rad/s",
        floor: tolerance + thresholds.digits * references_rms(logs),
        after: stated.rms.clone(),
        before: stated.rms.clone(),
        wrong_share: stated.ticks().wrong_share(),
        finding: None,
        unexplained: false,
        replay: None,
    };
    if link.wrong_share <= differs || stated.square().sqrt() < 1e-3 * references_rms(logs).max(1e-9) {
        return link;
    }
    let finding = |name: &'static str, wheels, parameters, found: &Compared| {
        let evidence = Evidence::Replay { nominal: stated.ticks(), with: found.ticks() };
        Finding { link: Link::Command, name, wheels, parameters, evidence }
    };
    // Every order and sign of the rows, and every latency.
    let mut best: (f64, Option<Finding>, Vec<f64>) = (stated.square() * 0.999, None, Vec::new());
    for order in orders(n) {
        let found = matrix.compared(&order, filed.unwrap_or_default());
        if found.square() < best.0 {
            let wheels = (0..n).filter(|i| order[*i] != (*i, 1.0)).collect();
            let axis = |(i, (row, sign)): (usize, &(usize, f64))| {
                (format!("axis_{}", i + 1), sign * (*row as f64 + 1.0), Interval::Exact)
            };
            let parameters = order.iter().enumerate().map(axis).collect();
            best = (found.square(), Some(finding("wheel-order", wheels, parameters, &found)), found.rms);
        }
    }
    if let Some((late, found)) = latency(&matrix, &straight, (LONGEST_S / tick) as usize)
        && late != filed.unwrap_or_default()
        && found.square() < best.0
    {
        let older = if late.or_one_more { found.older as f64 / found.all as f64 } else { 0.0 };
        let ends = if late.or_one_more { [0.0, 1.0] } else { [-0.5, 0.5] };
        let interval = Interval::Resolution(ends.map(|end| (late.ticks as f64 + end) * tick));
        let parameters = vec![("latency_s".to_owned(), (late.ticks as f64 + older) * tick, interval)];
        best = (found.square(), Some(finding("command-latency", Vec::new(), parameters, &found)), found.rms);
    }
    if best.1.is_some() && best.0 < (1.0 - thresholds.removes[0]) * stated.square() {
        link.after = best.2;
        link.finding = best.1;
    } else {
        // What a stated effect of this link leaves is its remainder, not a new structure.
        link.unexplained = filed.is_none();
    }
    link
}

/// The latency that leaves least, and what it leaves. One that leaves most set points without a command that old
/// is none: their errors would be those of the few that have one.
fn latency(matrix: &Matrix, order: &Order, most: usize) -> Option<(Late, Compared)> {
    /// Share of the set points that must have a command so old.
    const COMPARED: f64 = 0.5;
    let all = matrix.compared(order, Late::default()).all as f64;
    let at = |late: Late| Some(matrix.compared(order, late)).filter(|c| c.all as f64 >= COMPARED * all);
    let least = |ticks: &mut dyn Iterator<Item = usize>| {
        let whole = |ticks| Late { ticks, or_one_more: false };
        ticks.filter_map(|t| Some((whole(t), at(whole(t))?))).min_by(|a, b| a.1.square().total_cmp(&b.1.square()))
    };
    let coarse = (most / 60).max(1);
    let start = least(&mut (0..=most).step_by(coarse))?.0.ticks;
    let whole = least(&mut (start.saturating_sub(coarse)..=(start + coarse).min(most)))?;
    // Two ticks in turn explain more than one; they must explain it all.
    let in_turn = [whole.0.ticks.checked_sub(1), Some(whole.0.ticks)].into_iter().flatten();
    let in_turn = in_turn.filter_map(|ticks| {
        let late = Late { ticks, or_one_more: true };
        Some((late, at(late)?))
    });
    let better = in_turn.min_by(|a, b| a.1.square().total_cmp(&b.1.square()));
    match better {
        Some(better)
            if whole.1.ticks().wrong_share() > matrix.differs && better.1.ticks().wrong_share() <= matrix.differs =>
        {
            Some(better)
        }
        _ => Some(whole),
    }
}

/// Row and sign of every set point, as the robot's file has them.
fn given_order(robot: &Robot, n: usize) -> Order {
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
