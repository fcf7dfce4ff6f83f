//! Seeded random numbers: one independent stream for every purpose, and coloured noise.

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

/// What a stream of random numbers is for; adding a use never changes the numbers of another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Stream {
    /// Where wheels, mass and floor vary.
    Robot,
    /// Nuisances that every set has.
    Nuisance,
    /// The hidden effects.
    Effect,
    /// Which runs are driven.
    Excitation,
    /// Ablations of the finished data.
    Ablation,
    /// Tolerances of the inertial sensor.
    Part,
    /// Ground noise of run n.
    Ground(u32),
    /// Camera noise of run n.
    Camera(u32),
    /// Electronics of run n: supply noise, lost edges.
    Electronics(u32),
    /// The inertial sensor's noise in run n.
    Inertial(u32),
}

impl Stream {
    fn id(self) -> u64 {
        match self {
            Self::Robot => 1,
            Self::Nuisance => 2,
            Self::Effect => 3,
            Self::Excitation => 4,
            Self::Ablation => 5,
            Self::Part => 6,
            Self::Ground(run) => 1000 + 10 * u64::from(run),
            Self::Camera(run) => 1001 + 10 * u64::from(run),
            Self::Electronics(run) => 1002 + 10 * u64::from(run),
            Self::Inertial(run) => 1003 + 10 * u64::from(run),
        }
    }
}

/// The generator of one stream of one case.
#[must_use]
pub(crate) fn stream(seed: u64, purpose: Stream) -> ChaCha8Rng {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    rng.set_stream(purpose.id());
    rng
}

/// The seed of set `index` (from 0) of a bench with seed `seed`.
#[must_use]
pub fn set_seed(seed: u64, index: u64) -> u64 {
    let mut x = seed ^ index.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

/// The generator of a named purpose of one case.
pub(crate) fn named_stream(seed: u64, name: &str) -> ChaCha8Rng {
    let hash = name
        .bytes()
        .fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3));
    ChaCha8Rng::seed_from_u64(set_seed(seed, hash))
}

/// A standard normal number.
pub(crate) fn normal(rng: &mut ChaCha8Rng) -> f64 {
    StandardNormal.sample(rng)
}

/// Coloured noise (first-order Gauss–Markov): `x' = −x/T + white`, with a stated stationary standard deviation.
#[derive(Clone, Debug)]
pub(crate) struct Coloured {
    value: f64,
    keep: f64,
    fresh: f64,
}

impl Coloured {
    /// Noise of standard deviation `sd` and correlation time `time_s`, sampled every `step_s`.
    pub(crate) fn new(sd: f64, time_s: f64, step_s: f64, rng: &mut ChaCha8Rng) -> Self {
        let keep = (-step_s / time_s).exp();
        Self { value: sd * normal(rng), keep, fresh: sd * (1.0 - keep * keep).sqrt() }
    }

    /// The next sample.
    pub(crate) fn next(&mut self, rng: &mut ChaCha8Rng) -> f64 {
        self.value = self.keep * self.value + self.fresh * normal(rng);
        self.value
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coloured_noise_has_its_deviation_and_correlation() {
        let mut rng = stream(7, Stream::Ground(0));
        let mut noise = Coloured::new(0.2, 0.05, 0.001, &mut rng);
        let samples: Vec<f64> = (0..400_000).map(|_| noise.next(&mut rng)).collect();
        let power = samples.iter().map(|x| x * x).sum::<f64>() / samples.len() as f64;
        let lagged = samples.windows(51).map(|w| w[0] * w[50]).sum::<f64>() / samples.len() as f64;
        assert!((power.sqrt() - 0.2).abs() < 0.01, "deviation {}", power.sqrt());
        assert!((lagged / power - (-1.0_f64).exp()).abs() < 0.05, "correlation {}", lagged / power);
    }

    #[test]
    fn seeds_of_neighbouring_sets_differ() {
        let mut seeds: Vec<u64> = (0..1000).map(|i| set_seed(1, i)).collect();
        seeds.sort_unstable();
        seeds.dedup();
        assert_eq!(seeds.len(), 1000);
    }
}
