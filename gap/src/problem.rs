//! A link as a regression problem: linearising it about a state, and fitting its active effects.

use std::collections::HashMap;
use std::sync::Arc;

use crate::state::{Active, State};
use crate::thresholds::Thresholds;
use estimation::normal_equations::{Cluster, NormalEquations};
use links::drive::{DriveLink, DriveModel, Side};
use links::effect::{Effect, Link, Parameter, Sizes};
use links::inertial::NODES_S;
use links::motion::{MotionLink, MotionModel};
use nalgebra::DVector;

/// A link of a data set that can be linearised about any state.
pub enum Problem<'a> {
    /// Encoders to camera.
    Motion(&'a MotionLink<'a>),
    /// Duty to encoders.
    Drive(&'a DriveLink<'a>),
}

/// Which parameter a column of the linearisation belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Owner {
    /// Effect of the state, by index, and parameter.
    Active(usize, usize),
    /// Candidate, by index, and parameter.
    Candidate(usize, usize),
    /// All that a switched-on effect of the state does, by index.
    Whole(usize),
}

/// A link's residuals and their derivatives at one state.
pub struct Linear {
    /// Condensed residuals and columns.
    pub equations: NormalEquations,
    /// Owner of each column.
    pub owners: Vec<Owner>,
}

impl Linear {
    /// The columns of one candidate.
    pub fn of_candidate(&self, candidate: usize) -> Vec<usize> {
        self.position(|o| matches!(o, Owner::Candidate(c, _) if c == candidate))
    }

    /// The columns of one active effect.
    pub fn of_active(&self, index: usize) -> Vec<usize> {
        self.position(|o| matches!(o, Owner::Active(c, _) if c == index))
    }

    /// The columns of all active effects.
    pub fn active(&self) -> Vec<usize> {
        self.position(|o| matches!(o, Owner::Active(..)))
    }

    /// A step along the columns of all active effects, each parameter held near 0 by so much information on it.
    ///
    /// ```
    /// fn length(linear: &gap::problem::Linear, state: &gap::state::State) -> f64 {
    ///     let step: gap::nalgebra::DVector<f64> = linear.step(state, &|_| 0.0);
    ///     step.norm()
    /// }
    /// ```
    pub fn step(&self, state: &State, held: &dyn Fn(&Parameter) -> f64) -> DVector<f64> {
        let near_nothing = |c: &usize| {
            let Owner::Active(index, j) = self.owners[*c] else { return [0.0; 2] };
            let active = &state.active[index];
            let p = &active.form.free[j];
            [held(p), -held(p) * active.values.get(&p.name)]
        };
        let columns = self.active();
        let held: Vec<[f64; 2]> = columns.iter().map(near_nothing).collect();
        self.equations.solve_held(&columns, &held)
    }

    fn position(&self, wanted: impl Fn(Owner) -> bool) -> Vec<usize> {
        (0..self.owners.len()).filter(|i| wanted(self.owners[*i])).collect()
    }
}

/// A direction in which a link is differentiated.
struct Move {
    /// From where; `None`: the state itself, predicted once for all.
    low: Option<State>,
    /// State at the upper end.
    high: State,
    /// The step between them.
    step: f64,
}

impl Move {
    /// To an effect as a whole, from the state or to it.
    fn whole(high: State, step: f64) -> Self {
        Self { low: None, high, step }
    }
}

const PLAY: &str = "gear-backlash";
/// Age of the counts, and of an inertial sensor's readings.
const COUNTS: &str = "encoder-lag";
const READINGS: &str = "imu-latency";
/// Steps of Gauss-Newton at most.
const STEPS: usize = 8;

impl Problem<'_> {
    /// Between which two stages of the robot it compares.
    pub fn link(&self) -> Link {
        match self {
            Self::Motion(_) => Link::Motion,
            Self::Drive(_) => Link::Drive,
        }
    }

    /// Whether ways are compared, and no single frames.
    pub fn is_along_ways(&self) -> bool {
        matches!(self, Self::Motion(link) if link.ways.is_some())
    }

    /// Whether an inertial sensor takes part.
    pub fn is_felt(&self) -> bool {
        matches!(self, Self::Motion(link) if link.inertial.is_some())
    }

    /// The link's candidates: every form of every effect fitted there, in the sizes of its logs.
    pub fn candidates(&self, state: &State, catalogue: &[Arc<dyn Effect>]) -> Vec<Active> {
        let sizes = match self {
            Self::Motion(link) => Sizes::of(&state.robot).at_speed(link.pieces.speed()).seen(link.pieces.seen_m()),
            Self::Drive(link) => sizes_with_play(link, state, catalogue),
        };
        let mut all = crate::candidates::candidates_in(state, catalogue, self.link(), &sizes);
        if let Self::Motion(MotionLink { inertial: Some(link), .. }) = self {
            // One regression for all that the wheels are seen by.
            let felt = |e: &dyn Effect| link.shows(e);
            all.extend(crate::candidates::candidates_of(state, catalogue, self.link(), &sizes, felt));
        }
        if matches!(self, Self::Motion(link) if !link.pieces.have_duties()) {
            // What lags by its mass: where no drive is compared, nobody vouches for a mass.
            all.retain(|a| a.effect.name() != "wheel-creep");
        }
        all.retain(|a| !a.effect.stands_for_several());
        if let Some(younger) = self.younger(state, &all) {
            all.retain(|a| a.effect.name() != younger);
        }
        all
    }

    /// The candidate that makes an inertial sensor's readings older than the counts, or younger where no camera is.
    pub fn age<'b>(&self, all: &'b [Active]) -> Option<&'b Active> {
        let named = |name: &str| all.iter().find(|a| a.effect.name() == name);
        let Self::Motion(MotionLink { inertial: Some(_), pieces, .. }) = self else { return None };
        named(READINGS).or_else(|| if pieces.have_frames() { None } else { named(COUNTS) })
    }

    /// Of counts and an inertial sensor alone, without a camera, what is not the older: what shows is the difference of their
    /// ages, and both together undo each other.
    fn younger(&self, state: &State, all: &[Active]) -> Option<&'static str> {
        let Self::Motion(link) = self else { return None };
        if link.inertial.is_none() || link.pieces.have_frames() {
            return None;
        }
        let there = |name: &str| state.active.iter().any(|a| a.effect.name() == name);
        if there(COUNTS) || there(READINGS) {
            return Some(if there(COUNTS) { READINGS } else { COUNTS });
        }
        let age = all.iter().find(|a| a.effect.name() == READINGS)?;
        let [early, late] = [-0.5, 0.5].map(|nodes| {
            let mut other = state.clone();
            other.active.push(age.moved(0, nodes * NODES_S));
            self.linearise_nothing(&other).plain().0
        });
        Some(if late <= early { COUNTS } else { READINGS })
    }

    /// What may be named in place of several candidates.
    pub fn in_place(&self, state: &State, catalogue: &[Arc<dyn Effect>]) -> Vec<Active> {
        let mut all = crate::candidates::candidates(state, catalogue, self.link());
        let several = state.robot.wheel_count() > 1;
        let one = |a: &Active| a.form.wheels.is_empty() || several && a.form.wheels.len() == 1;
        all.retain(|a| a.effect.stands_for_several() && a.form.free.len() == 1 && one(a));
        all
    }

    /// Residuals and the derivatives by all active parameters of this link and all candidates.
    pub fn linearise(&self, state: &State, candidates: &[Active]) -> Linear {
        let mut owners = Vec::new();
        let mut moves: Vec<Move> = Vec::new();
        for index in state.fitted_on(self.link()) {
            let a = &state.active[index];
            for (j, p) in a.form.free.iter().enumerate() {
                let h = 0.05 * p.scale;
                owners.push(Owner::Active(index, j));
                let [low, high] = [-h, h].map(|by| state.with(index, a.moved(j, by)));
                moves.push(Move { low: Some(low), high, step: 2.0 * h });
            }
        }
        for index in state.fitted_on(self.link()).into_iter().filter(|i| state.active[*i].switched()) {
            let mut off = state.clone();
            off.active.remove(index);
            owners.push(Owner::Whole(index));
            // Backwards, which turns the sign round.
            moves.push(Move::whole(off, -1.0));
        }
        // Forms of one effect share parameters: each is worked out once.
        let mut known: HashMap<(&str, String, &str), usize> = HashMap::new();
        let mut column_of: Vec<usize> = (0..moves.len()).collect();
        for (c, candidate) in candidates.iter().enumerate() {
            if candidate.switched() {
                // One column for the whole effect: off to on.
                owners.push(Owner::Candidate(c, 0));
                let mut on = state.clone();
                on.active.push(candidate.clone());
                column_of.push(moves.len());
                moves.push(Move::whole(on, 1.0));
                continue;
            }
            for (j, p) in candidate.form.free.iter().enumerate() {
                let h = p.scale;
                owners.push(Owner::Candidate(c, j));
                let shared = (candidate.effect.name(), format!("{:?}", candidate.form.fixed), p.name.as_str());
                let column = *known.entry(shared).or_insert(moves.len());
                column_of.push(column);
                if column < moves.len() {
                    continue;
                }
                let side = |by: f64| {
                    let mut s = state.clone();
                    s.active.push(candidate.moved(j, by));
                    s
                };
                // One-sided where the negative makes no sense, or tells nothing new.
                let both = p.bounds[0] < 0.0 && !(self.link() == Link::Drive && candidate.effect.is_load());
                let low = both.then(|| side(-h));
                let step = if low.is_some() { 2.0 * h } else { h };
                moves.push(Move { low, high: side(h), step });
            }
        }
        let columns = moves.len();
        let clusters: Vec<Cluster> = match self {
            Self::Motion(link) => {
                let side = |m: &Move| (m.low.as_ref().map(|low| low.motion(None)), m.high.motion(None), m.step);
                let sides: Vec<(Option<MotionModel>, MotionModel, f64)> = moves.iter().map(side).collect();
                link.linearise(&state.motion(None), &sides)
            }
            Self::Drive(link) => {
                let side =
                    |m: Move| Side { low: m.low.map(|low| low.drive(None)), high: m.high.drive(None), step: m.step };
                let sides: Vec<Side> = moves.into_iter().map(side).collect();
                link.linearise(&state.drive(None), &sides)
            }
        };
        let clusters = if column_of.iter().copied().eq(0..columns) {
            clusters
        } else {
            clusters.into_iter().map(|c| c.spread(&column_of)).collect()
        };
        Linear { equations: NormalEquations::new(clusters), owners }
    }

    /// Whether an effect changes what the motors have to move.
    pub fn changes_inertia(&self, state: &State, effect: &Active) -> bool {
        let inertia = |state: &State| state.drive(None).mechanics().map(|m| m.inertia);
        let mut with = state.clone();
        with.active.push(effect.moved(0, effect.form.free[0].scale));
        inertia(state) != inertia(&with)
    }

    /// Whether one state does worse than another where an effect cannot buy anything: in a free simulation, or, if it
    /// changes what is to be moved, in the torque of its own inertia.
    pub fn runs_away(&self, state: &State, other: &State, thresholds: &Thresholds) -> bool {
        let Self::Drive(link) = self else { return false };
        let models = [state, other].map(|s| s.drive(None));
        let [one, other] = models.each_ref().map(|m| m.mechanics().map(|m| m.inertia));
        one != other && worse(&models, &|m| links::drive::in_own_torque(link, m), 0.0)
            || self.goes_astray(&models, thresholds)
    }

    /// The same of free simulations alone: for what does the same as something that was looked at already.
    pub fn strays(&self, state: &State, other: &State, thresholds: &Thresholds) -> bool {
        self.goes_astray(&[state, other].map(|s| s.drive(None)), thresholds)
    }

    fn goes_astray(&self, models: &[DriveModel; 2], thresholds: &Thresholds) -> bool {
        let Self::Drive(link) = self else { return false };
        worse(models, &|m| links::drive::runaway(link, m), thresholds.runaway)
    }

    /// Whether an effect of a state opens the gap far beyond that of `start` if it alone is taken out: then the others
    /// undo most of what it does, and neither they nor it are the cause.
    pub fn is_cancelled(&self, state: &State, index: usize, start: &State, thresholds: &Thresholds) -> bool {
        let open = |state: &State| {
            let (square, n) = self.linearise_nothing(state).plain();
            // What is unknown of the loads of a light axis is as much larger in the torque of a heavy one.
            let own = match self {
                Self::Drive(link) => links::drive::in_own_torque(link, &state.drive(None)),
                Self::Motion(_) => None,
            };
            (own.map_or(square, |own| square.min(own.iter().sum())) - n, n)
        };
        let mut without = state.clone();
        without.active.remove(index);
        let (before, n) = open(start);
        open(&without).0 > thresholds.cancels * before.max(n)
    }

    /// Sum of squares of the residuals of a state.
    pub fn loss(&self, state: &State) -> f64 {
        self.linearise_nothing(state).loss()
    }

    /// Residuals alone.
    pub fn linearise_nothing(&self, state: &State) -> NormalEquations {
        let clusters = match self {
            Self::Motion(link) => link.linearise(&state.motion(None), &[]),
            Self::Drive(link) => link.linearise(&state.drive(None), &[]),
        };
        NormalEquations::new(clusters)
    }

    /// Fits the active effects of this link by Gauss-Newton, in place; the loss reached.
    pub fn fit(&self, state: &mut State) -> f64 {
        self.fit_held(state, &|_| 0.0)
    }

    /// The same with each parameter held near 0 by so much information on it; the loss reached has the price of that.
    pub fn fit_held(&self, state: &mut State, held: &dyn Fn(&Parameter) -> f64) -> f64 {
        let price = |a: &Active| a.form.free.iter().map(|p| held(p) * a.values.get(&p.name).powi(2)).sum::<f64>();
        let objective =
            |state: &State| self.loss(state) + state.active.iter().filter(|a| !a.given).map(price).sum::<f64>();
        let mut loss = objective(state);
        for _ in 0..STEPS {
            let linear = self.linearise(state, &[]);
            let columns = linear.active();
            if columns.is_empty() {
                break;
            }
            let step = linear.step(state, held);
            let mut accepted = false;
            let mut largest = 0.0_f64;
            for halving in 0..5 {
                let factor = 0.5_f64.powi(halving);
                let mut trial = state.clone();
                largest = 0.0;
                for (x, owner) in step.iter().zip(columns.iter().map(|c| linear.owners[*c])) {
                    let Owner::Active(index, j) = owner else { continue };
                    let p = state.active[index].form.free[j].clone();
                    let now = state.active[index].values.get(&p.name);
                    // Halved from the bound on, where it leads beyond: else no halving of a long step leaves the bound.
                    let next = now + factor * ((now + x).clamp(p.bounds[0], p.bounds[1]) - now);
                    largest = largest.max((next - now).abs() / p.scale);
                    trial.active[index].values.set(&p.name, next);
                }
                let reached = objective(&trial);
                if reached.is_finite() && reached <= loss * (1.0 + 1e-9) {
                    accepted = reached < loss * (1.0 - 1e-6);
                    loss = reached;
                    *state = trial;
                    break;
                }
            }
            if !accepted || largest < 1e-4 {
                break;
            }
        }
        loss
    }
}

/// Looks anew for the play by which a search for that begins, beside what else was found: dry friction holds a wheel in it.
/// Returns whether it does, and nobody looked for that before.
pub(crate) fn look_for_play(link: &mut DriveLink, found: &State, catalogue: &[Arc<dyn Effect>]) -> bool {
    let mut beside = found.clone();
    beside.active.retain(|a| a.effect.name() != PLAY);
    let held = |sizes: Sizes| sizes.play.is_some_and(|play| play.load_friction_nm > 0.0);
    let before = held(sizes_with_play(link, &beside, catalogue));
    link.forget_play();
    held(sizes_with_play(link, &beside, catalogue)) && !before
}

/// The sizes of a drive's logs, with the play of its gears by which a search for that begins.
fn sizes_with_play(link: &DriveLink, state: &State, catalogue: &[Arc<dyn Effect>]) -> Sizes {
    let play = catalogue.iter().find(|e| e.name() == PLAY);
    let form = play.and_then(|play| play.forms_in(&state.robot, &link.sizes).into_iter().next());
    play.zip(form).map_or(link.sizes, |(play, form)| link.sizes_with_play(play.as_ref(), &form, &|| state.drive(None)))
}

/// Whether the first of two models is worse by some measure of them, one a run.
fn worse([one, other]: &[DriveModel; 2], of: &dyn Fn(&DriveModel) -> Option<Vec<f64>>, sigmas: f64) -> bool {
    match (of(one), of(other)) {
        (Some(one), Some(other)) => links::drive::further(&one, &other, sigmas),
        (None, _) => true,
        (_, None) => false,
    }
}
