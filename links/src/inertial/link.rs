//! Windows of a sensor's signals: floors, residuals and their derivatives.

use estimation::parallel::{each, numbered};
use nalgebra::{DMatrix, DVector};

use super::ride::Ride;
use super::{Felt, Integral};
use crate::effect::{Effect, Link};
use crate::motion::{MotionModel, Path};
use crate::pieces::{MOST_CLUSTERS, Pieces, by_segment};
use crate::segment::Segment;
use estimation::normal_equations::Cluster;
use estimation::statistics::{median, rms};

/// Distance of two nodes, s: a count of an encoder, which is what the wheels' turn is not known to, is then a
/// hundredth of the turn of a robot that turns slowly (1 rad/s).
pub const NODES_S: f64 = 0.05;
/// Ticks between two nodes at least.
const FEWEST_TICKS: usize = 2;
/// Increments of a window: two seconds, in which a robot both turns and does not.
const INCREMENTS: usize = 40;
/// Increments of a window at least that say more than its nuisance.
const FEWEST: usize = 4;
/// Wandering of a gyroscope's bias within a log, rad/s: 14 K of warming up at 0.005 °/s per K (data sheet of the
/// ICM-42688-P) and as much again.
const WANDERS: f64 = 0.002_4;
/// Share of the turn by each wheel that its contact is not known to: the width of a contact, as for geometry elsewhere.
const CONTACT: f64 = 0.005;
/// What a data sheet leaves open of a good sensor (ICM-42688-P, typical, and 0.5° of soldering), which is no gap: relative
/// scale, and angle of an axis, rad.
const TOLERANCE: [f64; 2] = [0.005, 0.008_7];
/// Increments with turning wheels from which the floor is taken of these alone.
const ENOUGH: usize = 40;

/// An axis of the sensor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Channel(usize);

impl Channel {
    /// Axes of the gyroscope, then those of the accelerometer that a floor moves along.
    const ALL: [Self; 5] = [Self(0), Self(1), Self(2), Self(3), Self(4)];

    /// Its column in a log.
    pub fn column(self) -> &'static str {
        ["gyro_x", "gyro_y", "gyro_z", "acc_x", "acc_y"][self.0]
    }

    /// The link it belongs to.
    pub fn link(self) -> Link {
        if self.0 < 3 { Link::Gyroscope } else { Link::Accelerometer }
    }

    /// rad/s of a rate, m/s² of an acceleration.
    pub fn unit(self) -> &'static str {
        if self.0 < 3 { "rad/s" } else { "m/s²" }
    }

    fn of(self, felt: &Felt) -> Option<&Integral> {
        if self.0 < 3 { felt.gyro[self.0].as_ref() } else { felt.force[self.0 - 3].as_ref() }
    }

    /// Standard deviation of what is the same in all of a window: rad/s, m/s².
    fn wanders(self) -> f64 {
        // Gravity stands in every tilt of a robot, and a bias of 20 mg beside it.
        if self.0 < 3 { WANDERS } else { f64::INFINITY }
    }
}

/// How well a model fits one axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fit {
    /// Channel of the sensor.
    pub channel: Channel,
    /// Residual in noise floors.
    pub floors: f64,
    /// The floor, rad/s or m/s², over a node's interval.
    pub floor: f64,
    /// Residual, rad/s or m/s².
    pub rms: f64,
    /// Run (from 0) and time (s) of the worst window, and its residual in floors.
    pub worst: (usize, f64, f64),
}

/// The links to the sensor of a data set.
pub struct InertialLink<'a> {
    pieces: &'a Pieces<'a>,
    windows: Vec<Window>,
    channels: Vec<Channel>,
}

/// Consecutive increments of one segment.
struct Window {
    segment: usize,
    run: usize,
    /// Ticks of the nodes.
    nodes: Vec<usize>,
    /// Time at each node, s.
    t: Vec<f64>,
    axes: Vec<Axis>,
}

/// What one axis gained in a window.
struct Axis {
    channel: Channel,
    /// NaN where it was not measured.
    measured: Vec<f64>,
    /// Standard deviation of each.
    sigma: Vec<f64>,
}

impl<'a> InertialLink<'a> {
    /// Cuts the segments into windows, floors measured about a model; `None` if no log has a sensor beside its encoders.
    pub fn new(pieces: &'a Pieces<'a>, model: &MotionModel) -> Option<Self> {
        let mut windows = Vec::new();
        for (index, s) in pieces.iter().enumerate() {
            if let Some(felt) = s.felt.as_ref().filter(|_| !s.angle.is_empty()) {
                windows.extend(cut(index, &s, felt));
            }
        }
        let there = |c: &Channel| windows.iter().any(|w: &Window| w.axes.iter().any(|a| a.channel == *c));
        let channels: Vec<Channel> = Channel::ALL.into_iter().filter(there).collect();
        let mut link = Self { pieces, windows, channels };
        link.measure_floors(model)?;
        (!link.channels.is_empty()).then_some(link)
    }

    /// Whether a link has an axis here.
    pub fn has(&self, link: Link) -> bool {
        self.channels.iter().any(|c| c.link() == link)
    }

    /// Whether an effect shows in its axes.
    pub fn shows(&self, effect: &dyn Effect) -> bool {
        [Some(effect.link()), effect.also()].into_iter().flatten().any(|link| self.has(link))
    }

    /// Scatter of what is left from increment to increment, and what the contacts of the wheels are not known to.
    fn measure_floors(&mut self, model: &MotionModel) -> Option<()> {
        let forces = self.has(Link::Accelerometer);
        let columns = model.columns()?;
        // What is left open of each increment of each axis.
        let mut open: Vec<Vec<[f64; 6]>> = Vec::with_capacity(self.windows.len());
        // Second differences of what is left, where wheels turned and elsewhere.
        let mut seconds: Vec<[Vec<f64>; 2]> = vec![Default::default(); self.channels.len()];
        for range in by_segment(&self.windows, |w| w.segment) {
            let s = self.pieces.get(self.windows[range.start].segment);
            let path = Path::new(model, &s)?;
            let ride = Ride::new(&path, model, &s, forces);
            for w in &self.windows[range] {
                let turned = |k: usize, i: usize| (s.angle[i][w.nodes[k + 1]] - s.angle[i][w.nodes[k]]).abs();
                let contact = |k: usize| {
                    let parts = columns.iter().enumerate().map(|(i, c)| (CONTACT * c[2] * turned(k, i)).powi(2));
                    parts.sum::<f64>().sqrt()
                };
                let steps = w.nodes.len() - 1;
                let predicted = w.predicted(&ride, model);
                open.push((0..steps).map(|k| left_open(&predicted[k], contact(k))).collect());
                for a in &w.axes {
                    let left: Vec<f64> = (0..steps).map(|k| a.measured[k] - predicted[k][a.channel.0]).collect();
                    let slot = self.channels.iter().position(|c| *c == a.channel)?;
                    for (k, d) in left.windows(3).enumerate().filter(|(_, d)| d.iter().all(|x| x.is_finite())) {
                        let moves = (0..columns.len()).any(|i| turned(k + 1, i) > 0.05);
                        seconds[slot][usize::from(moves)].push((d[0] - 2.0 * d[1] + d[2]).abs());
                    }
                }
            }
        }
        let scatter: Vec<f64> = seconds
            .into_iter()
            .map(|[still, moving]| {
                let mut all = if moving.len() >= ENOUGH { moving } else { [still, moving].concat() };
                // The median of a normal variable's size is 0.6745, and three neighbours add up to six variances.
                median(&mut all) / 0.674_5 / 6.0_f64.sqrt()
            })
            .collect();
        let robot = self.pieces.robot();
        let count = columns.iter().map(|c| (c[2] / robot.counts_per_wheel_rad()).powi(2)).sum::<f64>().sqrt();
        let roll = columns.iter().map(|c| c[0].hypot(c[1]) / robot.counts_per_wheel_rad()).fold(0.0, f64::max);
        for (w, open) in self.windows.iter_mut().zip(open) {
            for a in &mut w.axes {
                let slot = self.channels.iter().position(|c| *c == a.channel)?;
                // A log without noise still has counts, of which either node has a part.
                let least = if a.channel.link() == Link::Gyroscope { count } else { roll / NODES_S } / 6.0_f64.sqrt();
                let floor = scatter[slot].max(least);
                a.sigma = open.iter().map(|open| floor.hypot(open[a.channel.0])).collect();
            }
        }
        Some(())
    }

    /// Residuals and the derivatives of the prediction along each pair of models, as those of the camera. A cluster is a
    /// window, or several in long logs.
    pub fn linearise(&self, model: &MotionModel, sides: &[(Option<MotionModel>, MotionModel, f64)]) -> Vec<Cluster> {
        let together = self.windows.len().div_ceil(MOST_CLUSTERS);
        let forces = self.has(Link::Accelerometer);
        let mut clusters: Vec<Cluster> = Vec::new();
        for range in by_segment(&self.windows, |w| w.segment) {
            let s = self.pieces.get(self.windows[range.start].segment);
            let Some(path) = Path::new(model, &s) else { return Vec::new() };
            let own = &self.windows[range];
            let base = Ride::new(&path, model, &s, forces);
            let base: Vec<Vec<[f64; 6]>> = own.iter().map(|w| w.predicted(&base, model)).collect();
            let predict = |other: &MotionModel| {
                path.of(other).map(|p| {
                    let ride = Ride::new(&p, other, &s, forces);
                    own.iter().map(|w| w.predicted(&ride, other)).collect::<Vec<_>>()
                })
            };
            // `[side][window][increment]`
            let columns: Vec<Vec<Vec<[f64; 6]>>> = each(sides, &|(low, high, step)| {
                let low = low.as_ref().map_or_else(|| Some(base.clone()), predict);
                let Some((low, high)) = low.zip(predict(high)) else {
                    return own.iter().map(|w| vec![[0.0; 6]; w.nodes.len() - 1]).collect();
                };
                let slope = |(a, b): (&[f64; 6], &[f64; 6])| std::array::from_fn(|i| (b[i] - a[i]) / step);
                let window = |(a, b): (&Vec<[f64; 6]>, &Vec<[f64; 6]>)| a.iter().zip(b).map(slope).collect();
                low.iter().zip(&high).map(window).collect()
            });
            let cluster = |i: usize| {
                let columns: Vec<&[[f64; 6]]> = columns.iter().map(|c| &c[i][..]).collect();
                own[i].cluster(&base[i], &columns)
            };
            let part: Vec<Cluster> = numbered(own.len(), &cluster);
            Cluster::append(&mut clusters, part, together);
        }
        clusters
    }

    /// How well a model fits each axis of a link.
    pub fn fits(&self, model: &MotionModel, link: Link) -> Vec<Fit> {
        let forces = self.has(Link::Accelerometer);
        let mut sums = vec![([0.0; 4], (0, 0.0, 0.0)); Channel::ALL.len()];
        for range in by_segment(&self.windows, |w| w.segment) {
            let s = self.pieces.get(self.windows[range.start].segment);
            let Some(path) = Path::new(model, &s) else { continue };
            let ride = Ride::new(&path, model, &s, forces);
            for w in &self.windows[range] {
                let predicted = w.predicted(&ride, model);
                for a in w.axes.iter().filter(|a| a.channel.link() == link) {
                    let (white, n) = a.white(&w.t, |k| a.measured[k] - predicted[k][a.channel.0]);
                    let square = white.iter().map(|x| x * x).sum::<f64>();
                    let lasted = w.t[1] - w.t[0];
                    let floor = rms(a.sigma.iter().copied()) / lasted;
                    let (sum, worst) = &mut sums[a.channel.0];
                    sum[0] += square;
                    sum[1] += n;
                    sum[2] += floor * floor * n;
                    // The nuisance is no residual.
                    let raw = white.iter().zip(a.used()).map(|(x, k)| (x * a.sigma[k] / lasted).powi(2));
                    sum[3] += raw.sum::<f64>();
                    let own = (square / n.max(1.0)).sqrt();
                    if own > worst.2 {
                        *worst = (w.run, w.t[0], own);
                    }
                }
            }
        }
        let fit = |channel: &Channel| {
            let ([square, n, floor, raw], worst) = sums[channel.0];
            let root = |x: f64| (x / n.max(1.0)).sqrt();
            Fit { channel: *channel, floors: root(square), floor: root(floor), rms: root(raw), worst }
        };
        self.channels.iter().filter(|c| c.link() == link).map(fit).collect()
    }
}

/// What an increment may be off by without a gap, by the wheels' contacts and a good sensor's tolerances.
fn left_open(gained: &[f64; 6], contact: f64) -> [f64; 6] {
    let [scale, angle] = TOLERANCE;
    let [x, y] = [gained[3], gained[4]];
    let across = angle * gained[2];
    [across, across, contact.hypot(scale * gained[2]), (scale * x).hypot(angle * y), (scale * y).hypot(angle * x), 0.0]
}

/// Root mean square of the residuals of all axes, in floors.
pub fn overall(fits: &[Fit]) -> f64 {
    rms(fits.iter().map(|f| f.floors))
}

fn cut(segment: usize, s: &Segment, felt: &Felt) -> Vec<Window> {
    let tick = (s.t[s.t.len() - 1] - s.t[0]) / (s.t.len() - 1) as f64;
    let every = ((NODES_S / tick).round() as usize).max(FEWEST_TICKS);
    let nodes: Vec<usize> = s.own.clone().step_by(every).collect();
    let window = |first: usize| {
        let nodes = nodes[first..(first + INCREMENTS + 1).min(nodes.len())].to_vec();
        let axis = |channel: Channel| {
            let integral = channel.of(felt)?;
            let measured: Vec<f64> = nodes.windows(2).map(|w| integral.between(w[0], w[1])).collect();
            let there = measured.iter().filter(|x| x.is_finite()).count();
            (there >= FEWEST).then_some(Axis { channel, measured, sigma: Vec::new() })
        };
        let axes: Vec<Axis> = Channel::ALL.into_iter().filter_map(axis).collect();
        let t = nodes.iter().map(|k| s.t[*k]).collect();
        (!axes.is_empty()).then_some(Window { segment, run: s.run, nodes, t, axes })
    };
    (0..nodes.len()).step_by(INCREMENTS).filter_map(window).collect()
}

impl Window {
    /// What a model predicts for each increment.
    fn predicted(&self, ride: &Ride, model: &MotionModel) -> Vec<[f64; 6]> {
        let delay = model.sensor.latency_s - model.encoder_lag_s;
        self.nodes.windows(2).map(|w| ride.gained(&model.sensor, delay, w[0], w[1])).collect()
    }

    fn cluster(&self, base: &[[f64; 6]], columns: &[&[[f64; 6]]]) -> Cluster {
        let mut whole: Option<Cluster> = None;
        for a in &self.axes {
            let i = a.channel.0;
            let (residual, n) = a.white(&self.t, |k| a.measured[k] - base[k][i]);
            let mut jacobian = DMatrix::zeros(residual.len(), columns.len());
            for (slots, column) in jacobian.as_mut_slice().chunks_exact_mut(residual.len()).zip(columns) {
                slots.copy_from_slice(&a.white(&self.t, |k| column[k][i]).0);
            }
            let own = Cluster::new(self.run, self.t[0], n, &DVector::from_vec(residual), &jacobian);
            match &mut whole {
                Some(whole) => whole.add(&own),
                None => whole = Some(own),
            }
        }
        let nothing = || Cluster::new(self.run, self.t[0], 0.0, &DVector::zeros(0), &DMatrix::zeros(0, columns.len()));
        whole.unwrap_or_else(nothing)
    }
}

impl Axis {
    /// Increments that were measured.
    fn used(&self) -> impl Iterator<Item = usize> {
        self.measured.iter().enumerate().filter(|(_, x)| x.is_finite()).map(|(k, _)| k)
    }

    /// Values of the increments that were measured, made white: in units of their noise, and less along what a bias
    /// that wanders from window to window would do. And how many they count as.
    fn white(&self, t: &[f64], value: impl Fn(usize) -> f64) -> (Vec<f64>, f64) {
        let mut out: Vec<f64> = self.used().map(|k| value(k) / self.sigma[k]).collect();
        let bias: Vec<f64> = self.used().map(|k| (t[k + 1] - t[k]) / self.sigma[k]).collect();
        let square: f64 = bias.iter().map(|x| x * x).sum();
        let wide = self.channel.wanders().powi(2) * square;
        let shrunk = if wide.is_finite() { 1.0 - 1.0 / (1.0 + wide).sqrt() } else { 1.0 };
        let along = out.iter().zip(&bias).map(|(x, b)| x * b).sum::<f64>() / square.max(1e-300);
        out.iter_mut().zip(&bias).for_each(|(x, b)| *x -= shrunk * along * b);
        let n = (out.len() as f64 - (1.0 - (1.0 - shrunk).powi(2))).max(0.0);
        (out, n)
    }
}
