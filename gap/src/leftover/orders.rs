//! Order analysis: what repeats with the angle of a wheel.
//!
//! The unexplained acceleration of every tick is multiplied by cos and sin of n times the wheel's
//! angle and averaged over blocks of a quarter of a second. Noise (that of counts grows with the
//! fourth power of the frequency) is taken from all orders at the same frequency, so that a block
//! counts by what it can say. Counters start anywhere, so phases are free in every piece of a log.

use model::plant::GRAVITY;
use std::borrow::Cow;
use std::f64::consts::{PI, TAU};

use super::Structure;
use crate::thresholds::Thresholds;
use crate::units;
use estimation::parallel::each;
use estimation::sign_flips;
use estimation::statistics::{chi2_upper, median};
use links::drive::{DriveLink, DriveModel};
use links::segment::Segment;

/// Length of a block, s.
const BLOCK_S: f64 = 0.25;
/// Frequencies a block can tell apart from the drive itself and from the noise of counts, Hz.
const RANGE_HZ: [f64; 2] = [3.0, 120.0];
/// Slowest wheel, rad/s.
const SLOWEST: f64 = 1.0;
/// Highest order looked at: rollers of a wheel; without them, cogs of a motor whose stator has 36 teeth and whose rotor 42
/// poles, which drives its load without a gear.
const HIGHEST: [usize; 2] = [40, 252];
/// No omni wheel has fewer rollers.
const FEWEST_ROLLERS: f64 = 6.0;
/// Ticks beyond which blocks are skipped.
const MOST_TICKS: usize = 150_000;
/// Bins a factor of ten of frequency, for the noise.
const BINS: f64 = 8.0;

/// A rolling radius that varies with the wheel's angle.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Ripple {
    /// Ripples a turn.
    pub count: usize,
    /// Wheel from 0, relative amplitude, standard deviation.
    pub wheels: Vec<(usize, f64, f64)>,
    /// Chance of the strongest, all places looked at paid for.
    pub p_value: f64,
}

/// One block of one wheel at one order.
#[derive(Clone, Copy)]
struct Block {
    segment: usize,
    /// First tick and the one after the last.
    ticks: (usize, usize),
    speed: f64,
    /// Mean of the acceleration times e^(−i n φ), and the same of the torque.
    demodulated: [[f64; 2]; 2],
}

/// What one wheel says at one order: chance of it in noise, amplitude, its deviation.
#[derive(Clone, Copy)]
struct Line {
    p: f64,
    /// How far it stands out; tells lines apart whose chances are too small to be told apart.
    strength: f64,
    amplitude: f64,
    sd: f64,
    /// Amplitude at the speeds looked at, rad/s² or Nm.
    reach: f64,
}

/// Looks through all orders of all wheels, with rollers or without; `slips` says of ticks of a segment whether a wheel slips
/// there.
pub(super) fn orders(
    link: &DriveLink,
    model: &DriveModel,
    rollers: bool,
    slips: &dyn Fn(usize, std::ops::Range<usize>) -> bool,
    drive_nm: f64,
    thresholds: &Thresholds,
) -> (Option<Ripple>, Vec<Structure>) {
    let n = link.noise.len();
    let mut candidates: Vec<f64> = (2..=HIGHEST[usize::from(!rollers)]).map(|k| k as f64).collect();
    // Whatever turns with the motor.
    candidates.extend((1..=6).map(|k| f64::from(k) * model.gear_ratio).filter(|o| (o - o.round()).abs() > 0.05));
    // Long logs are looked at here and there: a line is everywhere.
    let stride = 1 + link.pieces.ticks() / MOST_TICKS;
    let mut demodulated = vec![vec![Vec::new(); candidates.len()]; n];
    for (index, s) in link.pieces.iter().enumerate() {
        if s.duty.len() != n || s.angle.len() != n || s.t.len() <= 50 {
            continue;
        }
        let Some(raw) = link.raw(model, index) else { continue };
        for (wheel, slots) in demodulated.iter_mut().enumerate() {
            let new = demodulate(index, &s, &raw, wheel, &candidates, stride);
            let rolling = |blocks: Vec<Block>| blocks.into_iter().filter(|b| !slips(index, b.ticks.0..b.ticks.1));
            slots.iter_mut().zip(new).for_each(|(slot, blocks)| slot.extend(rolling(blocks)));
        }
    }
    // What a wheel carries, at its rim, as an acceleration of the wheel.
    let carried = GRAVITY * model.mass / n as f64 * model.wheel_radius_m;
    let bob = thresholds.bobs[usize::from(n > 3)] * carried / model.felt_inertia().max(f64::MIN_POSITIVE);
    let tests = 2.0 * n as f64 * candidates.len() as f64;
    let mut ripples: Vec<(usize, usize, Line)> = Vec::new();
    let mut structures = Vec::new();
    for (wheel, blocks) in demodulated.iter().enumerate() {
        let noise = [0, 1].map(|of| Noise::new(blocks, &candidates, of));
        let lines: Vec<[Line; 2]> = blocks
            .iter()
            .zip(&candidates)
            .map(|(b, o)| {
                [
                    line(b, *o, 0, &noise[0], thresholds.phases, |speed| o * speed * speed),
                    line(b, *o, 1, &noise[1], thresholds.phases, |_| 1.0),
                ]
            })
            .collect();
        let Some((best, _)) = lines.iter().enumerate().max_by(|a, b| {
            let most = |l: &[Line; 2]| l[0].strength.max(l[1].strength);
            most(a.1).total_cmp(&most(b.1))
        }) else {
            continue;
        };
        let [radius, torque] = lines[best];
        let order = candidates[best];
        let may_roll = (order - order.round()).abs() < 1e-9 && order >= FEWEST_ROLLERS;
        // Rollers push as they are handed over, and other wheels do not.
        let material = if rollers { thresholds.ripple[1] } else { thresholds.line[0] };
        if may_roll && radius.strength >= torque.strength && radius.p * tests < thresholds.false_alarm {
            if radius.amplitude >= thresholds.ripple[0] && radius.reach >= bob {
                ripples.push((wheel, order as usize, radius));
            }
        } else if !(may_roll && rollers)
            && torque.p * tests < thresholds.false_alarm
            && torque.amplitude >= material * drive_nm
        {
            let what = if rollers { "" } else { ": cogs of the motor, its brushes or teeth of the gear do so" };
            structures.push(Structure {
                text: format!(
                    "the torque of wheel {} repeats {} times a turn, amplitude {}{what}",
                    wheel + 1,
                    (1e2 * order).round() / 1e2,
                    units::torque(torque.amplitude)
                ),
                share: 1.0,
            });
        }
    }
    // Rollers are alike on all wheels: the count that shows best.
    let best = ripples.iter().max_by(|a, b| a.2.strength.total_cmp(&b.2.strength)).map(|r| (r.1, r.2.p));
    let ripple = best.map(|(count, p)| Ripple {
        count,
        wheels: ripples.iter().filter(|r| r.1 == count).map(|r| (r.0, r.2.amplitude, r.2.sd)).collect(),
        // Noise is normal in its middle; of the tail of χ² beyond what flips of signs resolve no log tells anything.
        p_value: (p * tests).max(sign_flips::LEAST),
    });
    (ripple, structures)
}

/// Blocks of one wheel in a segment, one list an order.
fn demodulate(
    index: usize,
    s: &Segment,
    raw: &[Vec<Vec<f64>>; 2],
    wheel: usize,
    orders: &[f64],
    stride: usize,
) -> Vec<Vec<Block>> {
    let mut out = vec![Vec::new(); orders.len()];
    let rate = (s.t.len() - 1) as f64 / (s.t[s.t.len() - 1] - s.t[0]);
    let length = (BLOCK_S * rate).round() as usize;
    if length < 20 {
        return out;
    }
    let window: Vec<f64> = (0..length).map(|j| (PI * (j as f64 + 0.5) / length as f64).sin().powi(2)).collect();
    let total: f64 = window.iter().sum();
    let highest = RANGE_HZ[1].min(0.2 * rate);
    let starts = (s.own.start.max(1)..s.own.end.min(s.t.len().saturating_sub(length))).step_by(stride * (length / 2));
    let of_block = |first: &usize| -> Vec<(usize, Block)> {
        let ticks = *first..first + length;
        let speeds = &s.speed[wheel][ticks.clone()];
        let mean = speeds.iter().sum::<f64>() / length as f64;
        let steady = speeds.iter().all(|w| w * mean > 0.0 && w.abs() > 0.5 * mean.abs());
        let frequency = |order: f64| order * mean.abs() / TAU;
        let heard = |order: f64| (RANGE_HZ[0]..highest).contains(&frequency(order));
        if !steady || mean.abs() <= SLOWEST || !orders.iter().any(|o| heard(*o)) {
            return Vec::new();
        }
        let weighted = [0, 1].map(|of: usize| -> Vec<f64> {
            let own = &raw[of][wheel][ticks.clone()];
            let mean = own.iter().zip(&window).map(|(a, w)| a * w).sum::<f64>() / total;
            own.iter().zip(&window).map(|(a, w)| w * (a - mean) / total).collect()
        });
        let turned = |order: f64| -> Vec<(f64, f64)> {
            s.angle[wheel][ticks.clone()].iter().map(|angle| (order * angle).sin_cos()).collect()
        };
        let once = turned(1.0);
        // Whole orders come one after the other, each turned once more than the one before.
        let mut whole = (1.0, once.clone());
        let mut blocks = Vec::new();
        for (place, order) in orders.iter().enumerate() {
            let at = if *order == whole.0 + 1.0 && frequency(*order) < highest {
                whole.0 = *order;
                whole.1.iter_mut().zip(&once).for_each(|((sin, cos), (s, c))| {
                    (*sin, *cos) = (*sin * c + *cos * s, *cos * c - *sin * s);
                });
                heard(*order).then_some(Cow::Borrowed(&whole.1))
            } else {
                heard(*order).then(|| Cow::Owned(turned(*order)))
            };
            let Some(at) = at else { continue };
            let mut demodulated = [[0.0; 2]; 2];
            for ((sin, cos), (a, torque)) in at.iter().zip(weighted[0].iter().zip(&weighted[1])) {
                demodulated[0][0] += a * cos;
                demodulated[0][1] -= a * sin;
                demodulated[1][0] += torque * cos;
                demodulated[1][1] -= torque * sin;
            }
            let ticks = (ticks.start, ticks.end);
            blocks.push((place, Block { segment: index, ticks, speed: mean.abs(), demodulated }));
        }
        blocks
    };
    let starts: Vec<usize> = starts.collect();
    for (place, block) in each(&starts, &of_block).into_iter().flatten() {
        out[place].push(block);
    }
    out
}

/// Mean square of demodulated noise by frequency.
struct Noise {
    bins: Vec<f64>,
}

impl Noise {
    fn new(blocks: &[Vec<Block>], orders: &[f64], of: usize) -> Self {
        let most = bin(RANGE_HZ[1] * 1.01) + 1;
        let mut powers: Vec<Vec<f64>> = vec![Vec::new(); most];
        for (list, order) in blocks.iter().zip(orders) {
            for b in list {
                let [c, s] = b.demodulated[of];
                powers[bin(order * b.speed / TAU).min(most - 1)].push(c * c + s * s);
            }
        }
        // The median of an exponential variable is ln 2 times its mean.
        let mut bins: Vec<f64> = powers
            .iter_mut()
            .map(|p| if p.len() < 12 { f64::INFINITY } else { median(p) / std::f64::consts::LN_2 })
            .collect();
        bins.iter_mut().filter(|b| **b <= 0.0).for_each(|b| *b = f64::INFINITY);
        Self { bins }
    }

    fn at(&self, f: f64) -> f64 {
        self.bins[bin(f).min(self.bins.len() - 1)]
    }
}

fn bin(f: f64) -> usize {
    (BINS * (f / RANGE_HZ[0]).log10()).max(0.0) as usize
}

/// Fits amplitude times `basis` to one wheel's blocks, phase free in every run.
fn line(blocks: &[Block], order: f64, of: usize, noise: &Noise, by_chance: f64, basis: impl Fn(f64) -> f64) -> Line {
    let mut runs: Vec<(usize, [f64; 2], f64)> = Vec::new();
    let mut phases: Vec<[f64; 3]> = Vec::new();
    let mut known = [0.0; 2];
    for b in blocks {
        let variance = noise.at(order * b.speed / TAU);
        if !variance.is_finite() {
            continue;
        }
        // A cosine of amplitude A has a demodulated mean of A/2.
        let x = 0.5 * basis(b.speed);
        known[0] += 4.0 * x * x / variance;
        known[1] += 1.0 / variance;
        let at = match runs.iter().position(|r| r.0 == b.segment) {
            Some(at) => at,
            None => {
                runs.push((b.segment, [0.0; 2], 0.0));
                phases.push([0.0; 3]);
                runs.len() - 1
            }
        };
        let (slot, phase) = (&mut runs[at], &mut phases[at]);
        let size = b.demodulated[of][0].hypot(b.demodulated[of][1]).max(1e-300);
        phase[2] += 1.0;
        for part in 0..2 {
            phase[part] += b.demodulated[of][part] / size;
        }
        for part in 0..2 {
            slot.1[part] += x * b.demodulated[of][part] / variance;
        }
        slot.2 += x * x / variance;
    }
    runs.retain(|r| r.2 > 0.0);
    if runs.is_empty() {
        return Line { p: 1.0, strength: 0.0, amplitude: 0.0, sd: f64::INFINITY, reach: 0.0 };
    }
    // Blocks overlap by half: two count as 1.33 (Welch 1967).
    let overlap = 1.5;
    let statistic: f64 = runs.iter().map(|r| (r.1[0].powi(2) + r.1[1].powi(2)) / r.2 / overlap).sum();
    // Rayleigh's test of the phases alone (Mardia and Jupp 2000), all pieces together.
    let rayleigh: f64 =
        phases.iter().filter(|p| p[2] > 0.0).map(|p| (p[0] * p[0] + p[1] * p[1]) / p[2] / overlap).sum();
    let by_phase = chi2_upper(2.0 * rayleigh, 2.0 * runs.len() as f64);
    let weight: f64 = runs.iter().map(|r| r.2).sum();
    let square: f64 = runs.iter().map(|r| (r.1[0].powi(2) + r.1[1].powi(2)) / r.2).sum::<f64>() / weight;
    let bias = runs.len() as f64 * overlap / weight;
    let agrees = by_phase < by_chance;
    Line {
        p: if agrees { chi2_upper(2.0 * statistic, 2.0 * runs.len() as f64) } else { 1.0 },
        strength: if agrees { statistic } else { 0.0 },
        amplitude: (square - bias).max(0.0).sqrt(),
        reach: ((square - bias).max(0.0) * known[0] / known[1]).sqrt(),
        sd: (0.5 * overlap / weight).sqrt(),
    }
}
