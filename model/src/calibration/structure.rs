//! Which sizes, angles and clocks of a robot the camera asks for: stepwise selection with cross-validation (Hastie,
//! Tibshirani and Friedman, The Elements of Statistical Learning, sections 3.3 and 7.10).
//!
//! Parts come in while they predict stretches of the logs better that had no part in their fit, first those of the
//! robot as a whole, then those of single wheels; then those go, or give way to simpler ones, without which these
//! stretches are predicted as well. Of parts that predict alike the one with the fewest parameters stays: a common
//! radius before one for every wheel, a turned marker plate before wheels that are all turned alike.

use nalgebra::{Cholesky, DMatrix, DVector};
use runs::Run;
use runs::robot::Robot;

use super::{KinematicModel, KinematicParameter};
use crate::fit::{FitError, FitOptions, WindowEquations, clocks, window_equations};

/// Blocks into which the logs are cut, where they are long enough, and the folds these make. More blocks are no more
/// independent of each other; five folds are usual.
const BLOCKS: usize = 40;
const FOLDS: usize = 5;
/// From this many runs, what is said of single wheels must also hold in runs that had no part in the fit: a floor or a
/// manoeuvre of one run passes for a turned wheel more easily than for a larger robot.
const RUNS: usize = 3;
/// A part comes in from this many standard errors of its gain over the blocks, and parts this close to the best are
/// as good as it (the one-standard-error rule).
const ALIKE: f64 = 1.0;
/// It stays from this many: with eight parts and eight blocks or more (Student's t), a robot that needs none keeps
/// one in at most one of twelve data sets.
const KEPT: f64 = 3.0;
/// Blocks from which that holds. With fewer of them hardly anything is held out, and a radius passes for a skew.
pub(super) const FEWEST_BLOCKS: usize = 8;
/// Or it stays if without it so much more is left in the held-out blocks: where a few manoeuvres alone show a part, its
/// gain varies from block to block however large it is.
const LARGE: f64 = 0.25;
/// Moves at most: every part once in and once out.
const MOVES: usize = 16;
/// In units of [`KinematicParameter::scale`], a parameter beyond this is no robot's: 45°, 45 %, 90 mm, 0.2 s.
const ABSURD: f64 = 45.0;
/// Places of a marker in distances of the wheels from the centre, where that is more: a tall robot with two wheels 0.2 m apart had
/// its own 0.126 m before the axle, and many have their axle at one end.
const BEYOND_WHEELS: f64 = 4.0;

/// What may differ between a robot and its file, as far as wheels and camera tell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Part {
    /// The radius that all wheels share.
    WheelRadius,
    /// A radius for each wheel.
    EachRadius,
    /// The distance of all contact points from the centre.
    BodyRadius,
    /// Rollers that give way sideways.
    Sideways,
    /// A skew for each wheel.
    Skews,
    /// Where on the robot the camera's marker is, m.
    MarkerPlace,
    /// How far the marker is turned against the robot, rad.
    MarkerHeading,
    /// A latency that all runs share.
    Latency,
    /// A latency for each run.
    Clocks,
}

impl Part {
    const ALL: [Self; 9] = [
        Self::WheelRadius,
        Self::EachRadius,
        Self::BodyRadius,
        Self::Sideways,
        Self::Skews,
        Self::MarkerPlace,
        Self::MarkerHeading,
        Self::Latency,
        Self::Clocks,
    ];

    fn parameters(self, wheels: usize, runs: usize) -> Vec<KinematicParameter> {
        use KinematicParameter as P;
        match self {
            Self::WheelRadius => vec![P::WheelRadiusCommon],
            Self::EachRadius => (0..wheels).map(P::WheelRadius).collect(),
            Self::BodyRadius => vec![P::BodyRadius],
            Self::Sideways => vec![P::Sideways],
            Self::Skews => (0..wheels).map(P::Skew).collect(),
            Self::MarkerPlace => vec![P::MarkerX, P::MarkerY],
            Self::MarkerHeading => vec![P::MarkerHeading],
            Self::Latency => vec![P::CameraLatency],
            Self::Clocks => (0..runs).map(P::CameraClock).collect(),
        }
    }

    /// What holds all of this and more, or is the same thing to the camera.
    fn instead_of(self) -> Option<Self> {
        match self {
            Self::WheelRadius => Some(Self::EachRadius),
            Self::EachRadius => Some(Self::WheelRadius),
            Self::Skews => Some(Self::MarkerHeading),
            Self::MarkerHeading => Some(Self::Skews),
            Self::Latency => Some(Self::Clocks),
            Self::Clocks => Some(Self::Latency),
            Self::BodyRadius | Self::Sideways | Self::MarkerPlace => None,
        }
    }

    /// Whether it says something of each wheel.
    fn of_wheels(self) -> bool {
        matches!(self, Self::EachRadius | Self::Skews)
    }

    fn tells(self, robot: &Robot) -> bool {
        let differential = robot.geometry().is_ok_and(|g| g.is_differential());
        match self {
            // Wheels without rollers hold the robot sideways, and no camera sees along which line they point.
            Self::Sideways | Self::Skews => !differential,
            _ => true,
        }
    }
}

/// The parameters of parts, in the order of the parts.
pub(super) fn parameters(parts: &[Part], wheels: usize, runs: usize) -> Vec<KinematicParameter> {
    parts.iter().flat_map(|part| part.parameters(wheels, runs)).collect()
}

/// With one part more, and without what it stands for.
pub(super) fn with(parts: &[Part], part: Part) -> Vec<Part> {
    let kept = parts.iter().copied().filter(|p| *p != part && part.instead_of() != Some(*p));
    kept.chain([part]).collect()
}

/// The parts that these logs ask for, [`Part::Latency`] or [`Part::Clocks`] among them, and the blocks that the choice
/// was tested on.
///
/// # Errors
/// [`FitError`] if there is nothing to compare.
pub(super) fn choose(robot: &Robot, runs: &[Run], options: &FitOptions) -> Result<(Vec<Part>, usize), FitError> {
    let wheels = robot.wheel_count();
    let clocked = runs.len() > 1 && (runs.len() <= clocks::FEW_RUNS || clocks_differ(robot, runs, options)?);
    let of_clocks = |part: &Part| *part != Part::Clocks || clocked;
    let every: Vec<Part> = Part::ALL.into_iter().filter(|part| part.tells(robot) && of_clocks(part)).collect();
    let all = parameters(&every, wheels, runs.len());
    let model = KinematicModel::new(robot, all.clone());
    // Clocks set by hand would hide all else from other runs: one for each until the end.
    let mut chosen = vec![if clocked { Part::Clocks } else { Part::Latency }];
    let mut values = DVector::zeros(all.len());
    let mut blocks = 0;
    let mut stages = [false, true].into_iter().peekable();
    let wheels_at = robot.layout.wheels().iter().map(|w| w.x_m.hypot(w.y_m)).fold(0.0, f64::max);
    let most = |parameter: KinematicParameter| match parameter {
        KinematicParameter::MarkerX | KinematicParameter::MarkerY => {
            ABSURD.max(BEYOND_WHEELS * wheels_at / parameter.scale())
        }
        _ => ABSURD,
    };
    for _ in 0..MOVES {
        let at: Vec<f64> = values.iter().zip(&all).map(|(v, p)| v * p.scale()).collect();
        let equations = match window_equations(&model, runs, &at, options) {
            Err(FitError::NotFinite) if chosen.len() > 1 => break,
            other => other?,
        };
        let held = HeldOut::new(&equations, &all, &values, runs.len());
        blocks = held.blocks.len();
        let indices = |parts: &[Part]| held.indices(&parameters(parts, wheels, runs.len()));
        let try_out = |parts: Vec<Part>| {
            let losses = held.losses(&indices(&parts), Folds::Blocks);
            (parts, losses)
        };
        let in_other_runs = |parts: &[Part]| held.losses(&indices(parts), Folds::Runs);
        // What only a size that no robot has explains is no choice, and no end of choosing either: on a square, without turns,
        // a lever six times too long made 1 % more of the camera's motion than skews.
        let moved = |parts: &[Part]| -> Option<DVector<f64>> {
            let moved = &values + held.solve(&indices(parts), &held.total);
            let a_robots = moved.iter().zip(&all).all(|(moved, parameter)| moved.abs() <= most(*parameter));
            a_robots.then_some(moved)
        };
        let (_, now) = try_out(chosen.clone());
        let mut next = None;
        while let Some(of_wheels) = stages.peek().copied().filter(|_| next.is_none()) {
            let open: Vec<Part> = every.iter().copied().filter(|part| part.of_wheels() == of_wheels).collect();
            let choices = larger(&chosen, &open).into_iter().filter(|parts| moved(parts).is_some());
            let mut more: Vec<_> = choices.map(&try_out).collect();
            if of_wheels && runs.len() >= RUNS {
                let now = in_other_runs(&chosen);
                more.retain(|(parts, _)| held.holds_in_most_runs(&now, &in_other_runs(parts)));
            }
            next = held.best(&now, more, |parts| parameters(parts, wheels, runs.len()).len());
            if next.is_none() {
                stages.next();
            }
        }
        if next.is_none() {
            let fewer = simpler(&chosen).into_iter().filter(|parts| moved(parts).is_some()).map(&try_out);
            let needless = fewer.filter(|(_, losses)| !held.is_needed(losses, &now));
            let least = needless.min_by(|a, b| held.gain(&a.1, &now).total_cmp(&held.gain(&b.1, &now)));
            next = least.map(|(parts, _)| parts);
        }
        let Some(next) = next else { break };
        let Some(moved) = moved(&next) else { break };
        (chosen, values) = (next, moved);
    }
    Ok((chosen, blocks))
}

/// Whether one clock does not do for all runs.
fn clocks_differ(robot: &Robot, runs: &[Run], options: &FitOptions) -> Result<bool, FitError> {
    let model = KinematicModel::new(robot, vec![KinematicParameter::CameraLatency]);
    let scale = KinematicParameter::CameraLatency.scale();
    let equations = window_equations(&model, runs, &[0.0], options)?;
    let age = |of_run: &[WindowEquations]| {
        let mut sum = WindowEquations::none(1, of_run[0].run);
        of_run.iter().for_each(|part| sum.add(part, 1.0));
        let n = 3.0 * (runs[sum.run].camera.len() as f64 - of_run.len() as f64);
        clocks::age(sum.information[(0, 0)] / (scale * scale), sum.score[0] / scale, sum.squares, n)
    };
    let ages: Vec<[f64; 2]> = equations.chunk_by(|a, b| a.run == b.run).filter_map(age).collect();
    Ok(clocks::differ(&ages, clocks::MATTERS_S))
}

/// The choices with one part more, or two: a marker off the centre can hide a radius, and a radius the marker.
fn larger(chosen: &[Part], every: &[Part]) -> Vec<Vec<Part>> {
    let fresh: Vec<Part> = every.iter().copied().filter(|part| !chosen.contains(part)).collect();
    let one = fresh.iter().map(|part| with(chosen, *part));
    let pairs = fresh.iter().enumerate().flat_map(|(i, a)| fresh[i + 1..].iter().map(move |b| (*a, *b)));
    let apart = pairs.filter(|(a, b)| a.instead_of() != Some(*b));
    one.chain(apart.map(|(a, b)| with(&with(chosen, a), b))).collect()
}

/// The choices with one part less or a simpler one in its place.
fn simpler(chosen: &[Part]) -> Vec<Vec<Part>> {
    let mut all = Vec::new();
    for part in chosen {
        let rest: Vec<Part> = chosen.iter().copied().filter(|p| p != part).collect();
        match part {
            Part::EachRadius | Part::Skews => {
                all.extend(part.instead_of().map(|simple| with(&rest, simple)));
                all.push(rest);
            }
            Part::Clocks => all.push(with(&rest, Part::Latency)),
            Part::Latency => {}
            _ => all.push(rest),
        }
    }
    all
}

/// What is held out at a time.
#[derive(Clone, Copy, PartialEq)]
enum Folds {
    /// The blocks of time whose numbers leave the same by [`FOLDS`].
    Blocks,
    /// One run, where there are several.
    Runs,
}

/// The equations of all parameters, cut into blocks of time and folds.
struct HeldOut<'a> {
    all: &'a [KinematicParameter],
    /// Where the equations were linearised.
    values: &'a DVector<f64>,
    runs: usize,
    /// Stretches, none across two runs.
    blocks: Vec<WindowEquations>,
    total: WindowEquations,
}

impl<'a> HeldOut<'a> {
    fn new(
        equations: &[WindowEquations],
        all: &'a [KinematicParameter],
        values: &'a DVector<f64>,
        runs: usize,
    ) -> Self {
        let per_block = equations.len().div_ceil(BLOCKS);
        let joined = |parts: &[WindowEquations]| {
            let mut sum = WindowEquations::none(all.len(), parts.first().map_or(0, |part| part.run));
            parts.iter().for_each(|part| sum.add(part, 1.0));
            sum
        };
        let of_runs = equations.chunk_by(|a, b| a.run == b.run);
        let blocks: Vec<_> = of_runs.flat_map(|of_run| of_run.chunks(per_block)).map(joined).collect();
        let total = joined(&blocks);
        Self { all, values, runs, blocks, total }
    }

    /// Places of parameters among all.
    fn indices(&self, parameters: &[KinematicParameter]) -> Vec<usize> {
        parameters.iter().filter_map(|p| self.all.iter().position(|q| q == p)).collect()
    }

    /// The change of all parameters that fits these best and takes the others to zero.
    fn solve(&self, free: &[usize], sums: &WindowEquations) -> DVector<f64> {
        let mut change = -self.values;
        free.iter().for_each(|i| change[*i] = 0.0);
        let fixed = &sums.score - &sums.information * &change;
        let n = free.len();
        // What the data do not tell stays where it is.
        let unknown = FitOptions::default().unknown_beyond.powi(-2);
        let entry = |i: usize, j: usize| sums.information[(free[i], free[j])] + if i == j { unknown } else { 0.0 };
        let solved = Cholesky::new(DMatrix::from_fn(n, n, entry))
            .map_or_else(|| DVector::zeros(n), |c| c.solve(&DVector::from_fn(n, |i, _| fixed[free[i]])));
        free.iter().zip(solved.iter()).for_each(|(i, v)| change[*i] = *v);
        change
    }

    /// Sums of squares of every block beyond those at the point of linearisation, by parameters that others fix.
    fn losses(&self, free: &[usize], folds: Folds) -> Vec<f64> {
        let mut losses = vec![0.0; self.blocks.len()];
        let fold_of = |b: usize| if folds == Folds::Runs { self.blocks[b].run } else { b % FOLDS };
        let count = if folds == Folds::Runs { self.runs } else { FOLDS };
        for fold in 0..count {
            let mut rest = self.total.clone();
            let own: Vec<usize> = (0..self.blocks.len()).filter(|b| fold_of(*b) == fold).collect();
            own.iter().for_each(|b| rest.add(&self.blocks[*b], -1.0));
            let mut change = self.solve(free, &rest);
            if folds == Folds::Runs {
                self.set_clock(&mut change, free, fold);
            }
            own.iter().for_each(|b| losses[*b] = self.blocks[*b].loss(&change));
        }
        losses
    }

    /// The clock of a run that is held out follows from that run alone: no other knows it.
    fn set_clock(&self, change: &mut DVector<f64>, free: &[usize], run: usize) {
        let clock = self.all.iter().position(|p| *p == KinematicParameter::CameraClock(run));
        let Some(clock) = clock.filter(|c| free.contains(c)) else { return };
        let mut own = WindowEquations::none(self.all.len(), run);
        self.blocks.iter().filter(|b| b.run == run).for_each(|b| own.add(b, 1.0));
        change[clock] = 0.0;
        let information = own.information[(clock, clock)];
        if information > 0.0 {
            change[clock] = (own.score[clock] - own.information.row(clock).transpose().dot(change)) / information;
        }
    }

    /// Standard errors by which `after` is better than `before` over the blocks.
    fn gain(&self, before: &[f64], after: &[f64]) -> f64 {
        standard_errors(before.iter().zip(after).map(|(b, a)| b - a))
    }

    /// Whether `with` is better than `without` beyond chance, and not worse in half of the runs.
    fn is_needed(&self, without: &[f64], with: &[f64]) -> bool {
        let sum = |losses: &[f64]| losses.iter().sum::<f64>();
        let large = sum(without) - sum(with) > LARGE * (self.total.squares + sum(with));
        (large || self.gain(without, with) > KEPT) && self.holds_in_most_runs(without, with)
    }

    /// Whether `with` is worse than `without` beyond chance in fewer than half of the runs. A run in which the robot
    /// does what it does in no other says little, however far it is off.
    fn holds_in_most_runs(&self, without: &[f64], with: &[f64]) -> bool {
        let gains = || self.blocks.iter().zip(without).zip(with).map(|((block, b), a)| (block.run, b - a));
        let of_run = |run: usize| standard_errors(gains().filter(|(r, _)| *r == run).map(|(_, gain)| gain));
        2 * (0..self.runs).filter(|run| of_run(*run) < -ALIKE).count() < self.runs
    }

    /// Of the candidates that are better than `now`, the smallest that is as good as the best.
    fn best(
        &self,
        now: &[f64],
        candidates: Vec<(Vec<Part>, Vec<f64>)>,
        size: impl Fn(&[Part]) -> usize,
    ) -> Option<Vec<Part>> {
        let sum = |losses: &[f64]| losses.iter().sum::<f64>();
        let better: Vec<_> = candidates.into_iter().filter(|(_, losses)| self.gain(now, losses) > ALIKE).collect();
        let (_, best) = better.iter().min_by(|a, b| sum(&a.1).total_cmp(&sum(&b.1)))?;
        let alike = better.iter().filter(|(_, losses)| self.gain(losses, best) <= ALIKE);
        let smallest = alike.min_by_key(|(parts, _)| size(parts));
        smallest.map(|(parts, _)| parts.clone())
    }
}

/// Mean over its standard error.
fn standard_errors(values: impl Iterator<Item = f64> + Clone) -> f64 {
    let n = values.clone().count() as f64;
    let mean = values.clone().sum::<f64>() / n;
    let variance = values.map(|v| (v - mean).powi(2)).sum::<f64>() / (n - 1.0).max(1.0);
    if variance > 0.0 { mean / (variance / n).sqrt() } else { 0.0 }
}
