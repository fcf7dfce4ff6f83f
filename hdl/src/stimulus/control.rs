//! Control ticks for the core: random walks with every corner of the arithmetic.

use fixed_kin::AXES;
use fixed_kin::control::{CONFIGURATION_WORDS, Configuration, IndexCapture, SetPointMode, TickInputs};
use fixed_kin::registers::MIN_TICK_PERIOD;
use fixed_kin::speed::{SpeedMode, TIME_BITS};
use fixed_kin::word::{WORD_MAX, WORD_MIN};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// One control tick.
#[derive(Clone, Copy, Debug)]
pub struct Scenario {
    /// Configuration in force.
    pub configuration: Configuration,
    /// What the core sees.
    pub inputs: TickInputs,
}

/// A word: corners, small ones, and all sizes between.
pub fn word(random: &mut ChaCha8Rng) -> i32 {
    match random.random_range(0..12) {
        0 => WORD_MIN,
        1 => WORD_MAX,
        2 => random.random_range(-2..=2),
        3 => 1 << random.random_range(0..29),
        4 => -(1 << random.random_range(0..29)),
        _ => random.random::<i32>() >> random.random_range(2..30),
    }
}

/// `ticks` control ticks: encoders that run, creep, tremble, stop past the time-out and wrap;
/// sane and wild configurations; every mode; arming and disarming.
#[must_use]
pub fn scenario(seed: u64, ticks: usize) -> Vec<Scenario> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut configuration = Configuration::default();
    let mut inputs = TickInputs { tick_period: 33_333, pwm_period: 1_667, armed: true, ..TickInputs::default() };
    let mut regime = [0_u32; AXES];
    let mask = (1 << TIME_BITS) - 1;
    (0..ticks)
        .map(|tick| {
            if tick % 16 == 0 {
                let wild = random.random_range(0..3) == 0;
                let words: [i32; CONFIGURATION_WORDS] = std::array::from_fn(|i| match (wild, i / AXES) {
                    (true, _) => word(&mut random),
                    (false, 0..=2) => random.random_range(-(1 << 17)..1 << 17),
                    (false, 3..=5) => random.random_range(-(1 << 25)..1 << 25),
                    (false, 6) => random.random_range(0..1 << 22),
                    (false, 7) => random.random_range(0..1 << 19),
                    (false, 8) => -random.random_range(0..=1 << 24),
                    (false, 9) => random.random_range(0..=1 << 24),
                    (false, 10) => random.random_range(-(1 << 16)..1 << 16),
                    (false, 11) => -random.random_range(0..=1 << 26),
                    (false, _) => random.random_range(0..=1 << 26),
                });
                configuration = Configuration::from_words(&words);
                inputs.speed_mode = if random.random() { SpeedMode::CountAndTime } else { SpeedMode::Difference };
                inputs.set_point_mode = if random.random() { SetPointMode::Twist } else { SetPointMode::Wheels };
                inputs.tick_period = match random.random_range(0..4) {
                    0 => MIN_TICK_PERIOD,
                    1 => 33_333,
                    2 => (1 << TIME_BITS) / 2 - 1,
                    _ => random.random_range(MIN_TICK_PERIOD..200_000),
                };
                inputs.pwm_period = [0, 1, 333, 1_667, 8_191][random.random_range(0..5)];
                inputs.odometry = random.random_range(0..8) != 0;
                inputs.armed = random.random_range(0..8) != 0;
                inputs.set_points_valid = random.random_range(0..8) != 0;
                regime = std::array::from_fn(|_| random.random_range(0..6));
            }
            inputs.now = (inputs.now + inputs.tick_period) & mask;
            for (axis, &regime) in regime.iter().enumerate() {
                step_encoder(&mut random, &mut inputs, axis, regime);
            }
            inputs.indices = std::array::from_fn(|axis| IndexCapture {
                event: random.random_range(0..6) == 0,
                clear: random.random(),
                count: inputs.encoders[axis].count.wrapping_add(random.random_range(0..2_000)),
            });
            inputs.set_points = std::array::from_fn(|_| match random.random_range(0..4) {
                0 => word(&mut random),
                _ => random.random_range(-(1 << 25)..1 << 25),
            });
            Scenario { configuration, inputs }
        })
        .collect()
}

fn step_encoder(random: &mut ChaCha8Rng, inputs: &mut TickInputs, axis: usize, regime: u32) {
    let mask = (1 << TIME_BITS) - 1;
    let sample = &mut inputs.encoders[axis];
    let counts = match regime {
        0 => 0,
        1 => random.random_range(-1..=1),
        2 => i32::from(random.random_range(0..10) == 0),
        3 => random.random_range(-32_768..32_768),
        _ => random.random_range(-300..300),
    };
    // A tremble moves the edge time and not the count.
    let trembles = counts == 0 && regime == 1;
    if counts != 0 || trembles {
        sample.count = sample.count.wrapping_add(counts as u16);
        sample.direction = if counts == 0 { random.random() } else { counts > 0 };
        let before = random.random_range(0..inputs.tick_period);
        sample.edge_time = inputs.now.wrapping_sub(before) & mask;
    }
}
