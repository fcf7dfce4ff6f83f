//! Weak form: test functions, and the unexplained torque of each.

use std::ops::Range;
use std::sync::{Arc, OnceLock};

use estimation::parallel::each;
use estimation::sums::dot;
use nalgebra::{DMatrix, DVector, DVectorView, DVectorViewMut};
use runs::robot::Support;

use super::answers::Answers;
use super::kept::KeptRows;
use super::laid::{Laid, Shape, TestFunction};
use super::{Ahead, DriveModel, Mechanics};
use crate::effect::{Play, Sizes};
use crate::inertial::Sensor;
use crate::pieces::{Pieces, by_segment};
use crate::segment::Segment;
use crate::thresholds;

/// Length of a test function in ticks at least.
const FEWEST_TICKS: f64 = 12.0;
/// Length of a cluster, s, and in half test functions at least.
const CLUSTER_S: f64 = 1.0;
const CLUSTER_HALVES: f64 = 8.0;
/// Clusters that logs are cut into where they are too short for as many of that length, and their least length in half test
/// functions. Flipped signs of n clusters tell chances from 2^(1 - n) up: of five none is called a name, of eight one in 128.
/// In `docs/measured/blind-axes.md` single logs of ten to forty time constants are named so; cut into sixteen, what the model of
/// a lifted robot leaves beside a dry friction was named as a dead band.
const CLUSTERS: f64 = 8.0;
const SHORT_HALVES: f64 = 3.0;
/// Clusters at most; beyond, they are longer.
const MOST_CLUSTERS: f64 = 400.0;
/// Share of a test function a wheel may be that slow.
const STUCK_SHARE: f64 = 0.35;

/// The drive link of a data set.
pub struct DriveLink<'a> {
    /// The pieces of the runs.
    pub pieces: &'a Pieces<'a>,
    /// Torque per wheel acceleration of the robot that the link was made with: the unit of residuals.
    pub(super) inertia: DMatrix<f64>,
    /// Standard deviation of the unexplained torque of one test function, Nm, one a wheel.
    pub noise: Vec<f64>,
    /// What torques and speeds are large beside.
    pub sizes: Sizes,
    pub(super) test_functions: Vec<TestFunction>,
    pub(super) laid: Vec<OnceLock<Arc<Laid>>>,
    pub(super) kept: KeptRows,
    /// What an inertial sensor tells where wheels slip.
    pub(super) felt: Option<BodyFelt>,
    /// What stands beside every effect; see [`DriveLink::answer`].
    pub(super) answers: Option<Answers>,
    /// See [`DriveLink::sizes_with_play`].
    pub(super) play: OnceLock<Option<Play>>,
}

/// An inertial sensor, and the noise of what it tells of a test function: to the right and forward, m/s².
pub(super) struct BodyFelt {
    pub(super) sensor: Sensor,
    pub(super) noise: [f64; 2],
}

/// Unexplained torques.
#[derive(Debug, Clone)]
pub struct DriveResiduals {
    /// Index of the run, one a test function.
    pub run: Vec<usize>,
    /// Segment and middle tick of each test function.
    pub at: Vec<(usize, usize)>,
    /// Torque, Nm, `[test function][wheel]`; what would have to be added to the model.
    pub torque: Vec<Vec<f64>>,
    /// Weight, `[test function][wheel]`.
    pub weights: Vec<Vec<f64>>,
}

impl<'a> DriveLink<'a> {
    /// Lays test functions of the length that is settled for these logs over the segments.
    pub fn new(pieces: &'a Pieces<'a>, nominal: &DriveModel) -> Option<Self> {
        Self::with_test_functions(pieces, nominal, pieces.driving().test_function_s)
    }

    /// Lays test functions of a length in s over the segments.
    pub fn with_test_functions(pieces: &'a Pieces<'a>, nominal: &DriveModel, test_function_s: f64) -> Option<Self> {
        let inertia = nominal.mechanics()?.inertia;
        let n = nominal.wheels.len();
        let mut test_functions = Vec::new();
        let mut longest = 0.0_f64;
        let mut reached = vec![[f64::INFINITY, f64::NEG_INFINITY]; n];
        for (index, s) in pieces.iter().enumerate() {
            if s.duty.len() != n || s.angle.len() != n || s.t.len() < 2 * FEWEST_TICKS as usize {
                continue;
            }
            let end = s.t[s.t.len() - 1];
            longest = longest.max(s.stretch[1] - s.stretch[0]).max(end - s.t[0]);
            for (i, [low, high]) in reached.iter_mut().enumerate() {
                for angle in &s.angle[i] {
                    *low = low.min(s.zero[i] + angle);
                    *high = high.max(s.zero[i] + angle);
                }
            }
            let tick = (end - s.t[0]) / (s.t.len() - 1) as f64;
            let length = test_function_s.max(FEWEST_TICKS * tick);
            // One grid over the whole stretch.
            let mut start = s.t[0];
            if s.span[0].is_finite() {
                start = s.stretch[0] + 0.5 * length * ((s.span[0] - s.stretch[0]) / (0.5 * length)).ceil();
            }
            while start + length <= end && start < s.span[1] {
                test_functions.extend(TestFunction::new(&s, index, start, length, n));
                start += 0.5 * length;
            }
        }
        if test_functions.is_empty() {
            return None;
        }
        number(&mut test_functions, pieces.seconds());
        let sizes = Sizes::of(pieces.robot());
        let mut link = Self {
            pieces,
            inertia,
            noise: vec![1.0; n],
            sizes,
            test_functions,
            laid: (0..pieces.kept()).map(|_| OnceLock::new()).collect(),
            kept: KeptRows::default(),
            felt: None,
            answers: None,
            play: OnceLock::new(),
        };
        link.sizes = Sizes::driven(pieces.robot(), link.motors_gave(nominal), pieces.speed());
        if pieces.robot().support == Support::Blocks {
            link.sizes.moved_nm = thresholds::PEAK_OF_RMS * link.took(nominal);
        }
        link.sizes.test_function_s = link.length();
        link.sizes.run_s = longest;
        link.sizes.reach_rad = reached.iter().map(|[low, high]| 0.5 * (high - low)).fold(0.0, f64::max);
        Some(link)
    }

    /// Torque that the motors of a model gave where wheels turned, RMS, Nm at the wheel shaft.
    fn motors_gave(&self, model: &DriveModel) -> f64 {
        let g = model.gear_ratio;
        let torques = self.means(self.noise.len(), |s, k, out| {
            for (i, (slot, a)) in out.iter_mut().zip(&model.axes).enumerate() {
                let volts = s.duty[i][k] * model.supply_at(s, k) - a.back_emf * g * s.speed[i][k];
                *slot = g * a.torque_constant * volts / a.resistance;
            }
        });
        let counted = torques.iter().enumerate().flat_map(|(i, wheel)| self.counted(i).map(|b| wheel[b]));
        estimation::statistics::rms(counted)
    }

    /// Torque that the measured accelerations took of a model where wheels turned, RMS, Nm at the wheel shaft.
    fn took(&self, model: &DriveModel) -> f64 {
        let done = self.done(model);
        let of = |(torque, b): (&DVector<f64>, &TestFunction)| -> Vec<f64> {
            torque.iter().zip(&b.weights).filter(|(_, weight)| **weight > 0.0).map(|(torque, _)| *torque).collect()
        };
        estimation::statistics::rms(done.iter().zip(&self.test_functions).flat_map(of))
    }

    /// What the test functions tell of the motors' torques: how many count, times the squared ratio of those torques to
    /// the noise, over all wheels.
    pub fn tells(&self, model: &DriveModel) -> f64 {
        let given = self.motors_gave(model).powi(2);
        let of = |i: usize| self.counted(i).count() as f64 * given / self.noise[i].powi(2).max(f64::MIN_POSITIVE);
        (0..self.noise.len()).map(of).sum()
    }

    /// From now on every model is compared beside what the speed loops answered.
    pub fn answer(&mut self, answers: Answers) {
        self.answers = Some(answers);
    }

    /// What is left beside the answers, if there are any.
    pub(super) fn beside_answers(&self, left: &DriveResiduals) -> Option<DriveResiduals> {
        self.answers.as_ref().map(|answers| answers.beside(self, left))
    }

    /// Leaves out test functions in which a wheel slips by what the motion link found, at more than so many times the speed
    /// with which it turns when it turns: Newton's law in wheel coordinates needs wheels that roll.
    pub fn mask_slip(&mut self, motion: &crate::motion::MotionModel, rolling: f64) {
        if !motion.changes_angles() {
            return;
        }
        for range in self.by_segment() {
            let s = self.pieces.get(self.test_functions[range.start].segment);
            let changed = motion.angles(&s);
            for test_function in &mut self.test_functions[range] {
                let end = test_function.first + test_function.intervals;
                let slips = (0..s.angle.len()).any(|i| {
                    // What a filter holds back did not slip.
                    let off = |k: usize| changed[i][k] - s.angle[i][k] - motion.reading_filter_s * s.speed[i][k];
                    (off(end) - off(test_function.first)).abs()
                        > rolling * s.turning * 0.5 * (s.t[end] - s.t[test_function.first])
                });
                if slips {
                    test_function.slips = true;
                    test_function.weights.fill(0.0);
                }
            }
        }
    }

    /// Leaves out what a wheel did while it may have stuck to a friction of this model that is not small beside the
    /// noise: then it is anything up to its size, in either direction. Returns the share of the test functions that
    /// went. Where most would go, for wheels that hardly ever turn freely, all stay. `sticks` is the torque of that
    /// friction in standard deviations of the noise.
    pub fn mask_sticking(&mut self, model: &DriveModel, sticks: f64) -> f64 {
        let Some(first) = self.test_functions.first() else { return 0.0 };
        let friction = model.standing_friction(&self.pieces.get(first.segment));
        let stuck = |b: &TestFunction, i: usize| b.stuck[i] * friction[i] > sticks * self.noise[i];
        let turned = |b: &TestFunction, i: usize| b.weights[i] > 0.0;
        let each = || self.test_functions.iter().flat_map(|b| (0..b.weights.len()).map(move |i| (b, i)));
        let all = each().filter(|(b, i)| turned(b, *i)).count();
        let gone = each().filter(|(b, i)| turned(b, *i) && stuck(b, *i)).count();
        if gone == 0 || 2 * gone > all {
            return 0.0;
        }
        let noise = &self.noise;
        for b in &mut self.test_functions {
            for i in 0..b.weights.len() {
                if b.stuck[i] * friction[i] > sticks * noise[i] {
                    b.weights[i] = 0.0;
                }
            }
        }
        gone as f64 / all as f64
    }

    /// Leaves out test functions at these times (index of the run, s).
    pub fn mask_times(&mut self, out: impl Fn(usize, f64) -> bool) {
        for range in self.by_segment() {
            let s = self.pieces.get(self.test_functions[range.start].segment);
            for test_function in &mut self.test_functions[range] {
                if out(s.run, s.t[test_function.middle()]) {
                    test_function.weights.fill(0.0);
                }
            }
        }
    }

    /// Segment and middle tick of the test functions that count for no wheel.
    pub fn masked(&self) -> Vec<(usize, usize)> {
        let out = self.test_functions.iter().filter(|b| b.weights.iter().all(|w| *w == 0.0));
        out.map(|b| (b.segment, b.middle())).collect()
    }

    /// Length of a test function, s.
    pub fn length(&self) -> f64 {
        self.first_test_function(|s, b| s.t[b.first + b.intervals] - s.t[b.first])
    }

    /// Ticks that make up a time.
    pub fn tick_count(&self, seconds: f64) -> usize {
        self.first_test_function(|s, b| {
            let length = s.t[b.first + b.intervals] - s.t[b.first];
            (seconds / length.max(1e-9) * b.intervals as f64).ceil()
        }) as usize
    }

    fn first_test_function(&self, of: impl Fn(&Segment, &TestFunction) -> f64) -> f64 {
        self.test_functions.first().map_or(0.0, |b| of(&self.pieces.get(b.segment), b))
    }

    /// Number of test functions.
    pub fn len(&self) -> usize {
        self.test_functions.len()
    }

    /// Whether there is nothing to compare.
    pub fn is_empty(&self) -> bool {
        self.test_functions.is_empty()
    }

    /// Test functions of each segment.
    pub(super) fn by_segment(&self) -> Vec<Range<usize>> {
        by_segment(&self.test_functions, |b| b.segment)
    }

    /// The test functions of one segment.
    pub(super) fn laid(&self, s: &Segment, range: &Range<usize>) -> Arc<Laid> {
        let own = &self.test_functions[range.clone()];
        match own.first().and_then(|b| self.laid.get(b.segment)) {
            // By one thread alone: while it waited for others it might be given work that waits for it.
            Some(kept) => {
                let new = || Arc::new(Laid::new(own, s, own.iter().map(|b| b.shape(s)).collect()));
                kept.get_or_init(new).clone()
            }
            None => Arc::new(Laid::new(own, s, each(own, &|b| b.shape(s)))),
        }
    }

    /// Torques that the measured accelerations take of a model, Nm, one a test function.
    pub fn done(&self, model: &DriveModel) -> Vec<DVector<f64>> {
        let Some(Mechanics { inertia, .. }) = model.mechanics() else { return Vec::new() };
        let part = |range: &Range<usize>| {
            let s = self.pieces.get(self.test_functions[range.start].segment);
            self.laid(&s, range).measured.clone()
        };
        let measured = each(&self.by_segment(), &part).concat();
        measured.into_iter().map(|a| &inertia * a).collect()
    }

    /// The mechanics by which accelerations of a segment are judged: of speeds of the moment a straight line from row to row
    /// stands for what they were in between.
    pub(super) fn mechanics(&self, model: &DriveModel, s: &Segment) -> Option<Mechanics> {
        let mechanics = model.mechanics()?;
        let momentary = runs::is_from_speeds(self.pieces.robot()) && self.pieces.half_rows() == 0;
        if momentary { mechanics.between_rows(model, s.tick_s()) } else { Some(mechanics) }
    }

    /// Unexplained wheel acceleration at every inner tick of a segment, rad/s², and the torque it
    /// stands for, Nm, `[wheel][tick]`; as noisy as counts are, for what is averaged over many ticks.
    ///
    /// More than three wheels turn in ways that no body follows, against creep alone: Newton's law says
    /// nothing of those, and they are left out.
    pub fn raw(&self, model: &DriveModel, segment: usize) -> Option<[Vec<Vec<f64>>; 2]> {
        let (n, s) = (self.noise.len(), &*self.pieces.get(segment));
        let mechanics = self.mechanics(model, s)?;
        let ticks = s.t.len();
        let forces = model.forces(s);
        let given = mechanics.encoders_per_torque(model);
        let acceleration = |k: usize| &given * DVector::from_fn(n + 3, |of, _| forces[of][k]);
        let follow = &mechanics.response * &mechanics.inertia;
        let share: Vec<f64> = (0..n).map(|i| follow[(i, i)].max(0.1)).collect();
        let mut out = [vec![vec![0.0; ticks]; n], vec![vec![0.0; ticks]; n]];
        let mut before = acceleration(0);
        for k in 1..ticks - 1 {
            let now = acceleration(k);
            let (h, g) = (s.t[k] - s.t[k - 1], s.t[k + 1] - s.t[k]);
            let a = DVector::from_fn(n, |i, _| {
                let angle = &s.angle[i];
                let measured = ((angle[k + 1] - angle[k]) / g - (angle[k] - angle[k - 1]) / h) * 2.0 / (g + h);
                measured - (before[i] * h + now[i] * g) / (h + g)
            });
            let torque = &mechanics.inertia * &a;
            let a = &follow * a;
            for i in 0..n {
                out[0][i][k] = a[i] / share[i];
                out[1][i][k] = torque[i];
            }
            before = now;
        }
        Some(out)
    }

    /// Means of several quantities over every test function, `[quantity][test function]`; `of` writes them down for one
    /// tick.
    pub fn means(&self, quantities: usize, of: impl Fn(&Segment, usize, &mut [f64]) + Sync) -> Vec<Vec<f64>> {
        let part = |range: &Range<usize>| {
            let s = self.pieces.get(self.test_functions[range.start].segment);
            let laid = self.laid(&s, range);
            let mut values = vec![0.0; quantities * s.t.len()];
            for (k, row) in values.chunks_mut(quantities).enumerate() {
                of(&s, k, row);
            }
            let mut means = vec![vec![0.0; range.len()]; quantities];
            for (place, (b, shape)) in self.test_functions[range.clone()].iter().zip(&laid.shapes).enumerate() {
                for (j, w) in shape.force.iter().enumerate() {
                    let row = &values[(b.first + j) * quantities..][..quantities];
                    means.iter_mut().zip(row).for_each(|(mean, x)| mean[place] += w * x);
                }
            }
            means
        };
        let parts: Vec<Vec<Vec<f64>>> = each(&self.by_segment(), &part);
        (0..quantities).map(|q| parts.iter().flat_map(|p| &p[q]).copied().collect()).collect()
    }

    /// Something of the middle tick of every test function.
    pub fn at_middles<T: Send>(&self, of: impl Fn(&Segment, usize) -> T + Sync) -> Vec<T> {
        let part = |range: &Range<usize>| {
            let s = self.pieces.get(self.test_functions[range.start].segment);
            self.test_functions[range.clone()].iter().map(|b| of(&s, b.middle())).collect::<Vec<_>>()
        };
        each(&self.by_segment(), &part).into_iter().flatten().collect()
    }

    /// Indices of the test functions that count for a wheel.
    pub(super) fn counted(&self, wheel: usize) -> impl Iterator<Item = usize> + '_ {
        (0..self.len()).filter(move |b| self.test_functions[*b].weights[wheel] > 0.0)
    }

    /// Weights, `[test function][wheel]`.
    pub fn weights(&self, test_function: usize) -> &[f64] {
        &self.test_functions[test_function].weights
    }

    /// Index of the cluster that `test_function` counts in.
    pub fn cluster(&self, test_function: usize) -> usize {
        self.test_functions[test_function].cluster
    }

    /// Segment and first tick of a test function.
    pub fn place(&self, test_function: usize) -> (usize, usize) {
        (self.test_functions[test_function].segment, self.test_functions[test_function].first)
    }
}

/// Adds a matrix times a vector, times a factor.
pub(super) fn add_product(sum: &mut [f64], matrix: &DMatrix<f64>, factor: f64, x: &[f64]) {
    let (rows, columns) = matrix.shape();
    DVectorViewMut::from_slice(sum, rows).gemv(factor, matrix, &DVectorView::from_slice(x, columns), 1.0);
}

/// Numbers the clusters of logs of so many seconds: short ones where the wheel that turns least turns no longer.
fn number(test_functions: &mut [TestFunction], seconds: f64) {
    let wheels = test_functions.first().map_or(0, |f| f.weights.len());
    let turns = |i: usize| test_functions.iter().map(|f| 0.5 * f.length * f.weights[i]).sum::<f64>();
    let least = (0..wheels).map(turns).filter(|t| *t > 0.0).fold(seconds, f64::min);
    let (mut cluster, mut opened) = (0, None);
    for f in test_functions {
        let usual = CLUSTER_S.max(0.5 * CLUSTER_HALVES * f.length).min(least / CLUSTERS);
        let cluster_s = usual.max(0.5 * SHORT_HALVES * f.length).max(seconds / MOST_CLUSTERS);
        if opened.is_none_or(|(segment, start)| segment != f.segment || f.start - start >= cluster_s) {
            cluster += 1;
            opened = Some((f.segment, f.start));
        }
        f.cluster = cluster;
    }
}

impl TestFunction {
    fn new(s: &Segment, segment: usize, start: f64, length: f64, wheels: usize) -> Option<Self> {
        // Ticks strictly inside, and one on either side, where the test function is 0.
        let first = s.t.partition_point(|t| *t <= start).saturating_sub(1);
        let end = s.t.partition_point(|t| *t < start + length);
        if end >= s.t.len() || end - first < 4 {
            return None;
        }
        let (weights, stuck) = (vec![0.0; wheels], vec![0.0; wheels]);
        let slips = false;
        let mut test_function =
            Self { segment, start, length, first, intervals: end - first, weights, stuck, slips, cluster: 0 };
        let force = test_function.shape(s).force;
        if !force.iter().all(|w| w.is_finite()) {
            return None;
        }
        for (i, (slot, share)) in test_function.weights.iter_mut().zip(&mut test_function.stuck).enumerate() {
            let slow = force.iter().zip(&s.speed[i][first..]).filter(|(_, w)| w.abs() < thresholds::STUCK * s.turning);
            let stuck: f64 = slow.map(|(f, _)| f).sum();
            let unlogged = s.unlogged.get(i).map_or(0.0, |shares| dot(&force, &shares[first..]));
            *slot = if stuck > STUCK_SHARE || unlogged > thresholds::UNLOGGED { 0.0 } else { 1.0 };
            *share = stuck;
        }
        Some(test_function)
    }

    /// Tick in the middle.
    pub(super) fn middle(&self) -> usize {
        self.first + self.intervals / 2
    }

    /// Acceleration of encoders against their wheels. The rotor, on which the encoder sits, moves in the play by itself.
    pub(super) fn offset(
        &self,
        shape: &Shape,
        (what, offset): &(Ahead, Vec<Vec<f64>>),
        mechanics: &Mechanics,
        model: &DriveModel,
    ) -> DVector<f64> {
        let n = offset.len();
        let ahead = DVector::from_fn(n, |i, _| {
            let own = &offset[i][self.first..];
            shape.angle.iter().zip(own).map(|(w, x)| w * (x - own[0])).sum::<f64>()
        });
        let rotors = DVector::from_fn(n, |i, _| model.moves_in_play(i) * ahead[i]);
        match what {
            Ahead::Rotor => ahead - &mechanics.response * rotors,
            Ahead::Reading => ahead,
        }
    }
}
