use super::*;
use proptest::prelude::*;
use std::collections::BTreeMap;
use std::vec::Vec;

fn words() -> RecordedWords {
    let gains = PiGains {
        kp: ProportionalGain::from_num(16),
        ki: IntegralGain::from_num(0.086),
        kff: FeedForwardGain::from_num(0.01),
        lower: -Duty::ONE,
        upper: Duty::ONE,
    };
    let mut inverse = InverseMatrix::default();
    for (k, entry) in inverse.iter_mut().flatten().enumerate() {
        *entry = Coefficient::from_bits(1_000 * (k as i32 - 5));
    }
    let set_points = Some(SetPointWords { inverse, exponents: [23, 23, 19], slew: SlewLimits::NONE });
    RecordedWords { gains, tick_period: 33_333, speed_mode: SpeedMode::CountAndTime, set_points }
}

fn by_name(words: &RecordedWords) -> BTreeMap<&'static str, i64> {
    let mut names = BTreeMap::new();
    words.each(|name, word| assert!(names.insert(name, word).is_none(), "{name} stands twice"));
    names
}

#[test]
fn words_go_there_and_back_and_bad_ones_are_named() {
    let words = words();
    let named = by_name(&words);
    assert_eq!(RecordedWords::find(|n| named.get(n).copied()), Ok(words));
    let plain = RecordedWords { set_points: None, ..words };
    assert_eq!(RecordedWords::find(|n| by_name(&plain).get(n).copied()), Ok(plain));
    for name in named.keys().filter(|n| !["kff", "inverse_1_x"].contains(n)) {
        let missing = RecordedWords::find(|n| named.get(n).copied().filter(|_| n != *name)).unwrap_err();
        assert_eq!((missing.name, missing.value), (*name, None));
        let large = RecordedWords::find(|n| if n == *name { Some(1 << 40) } else { named.get(n).copied() });
        assert_eq!(large.unwrap_err().name, *name);
    }
}

/// Duties of a loop from a state, for inputs that saturate it now and then.
fn log(gains: &PiGains, mut state: PiState, inputs: &[(i32, i32)]) -> Vec<(Speed, Speed, Duty)> {
    let step = |&(reference, speed): &(i32, i32)| {
        let (reference, speed) = (Speed::from_bits(reference), Speed::from_bits(speed));
        (reference, speed, state.step(gains, reference, speed))
    };
    inputs.iter().map(step).collect()
}

fn different(replay: &mut LoopReplay, log: &[(Speed, Speed, Duty)]) -> Vec<usize> {
    let step = |(k, (r, s, d)): (usize, &(Speed, Speed, Duty))| {
        matches!(replay.step(*r, *s, Some(*d)), Compared::Different(_)).then_some(k)
    };
    log.iter().enumerate().filter_map(step).collect()
}

proptest! {
    /// Whatever the integrator was before the log or after a gap, or moved to in between.
    #[test]
    fn replay_finds_the_integrator_and_wrong_words(
        inputs in prop::collection::vec((-3_000_000..3_000_000_i32, -3_000_000..3_000_000_i32), 40..200),
        integral in -(1 << 24)..1 << 24_i32, at in 20..39_usize, flip in 0..20_u32,
    ) {
        let gains = words().gains;
        let good = log(&gains, PiState { integral: Duty::from_bits(integral) }, &inputs);
        let mut replay = LoopReplay::new(gains);
        prop_assert!(different(&mut replay, &good).is_empty());
        // Ticks that nobody saw.
        let mut replay = LoopReplay::new(gains);
        prop_assert!(different(&mut replay, &good[..at - 9]).is_empty());
        replay.lose();
        prop_assert!(different(&mut replay, &good[at..]).is_empty());
        // One word with one bit changed, where the integrator is known for certain.
        let known = good[..at].iter().any(|(_, _, d)| d.to_bits().unsigned_abs() < 1 << 24);
        let mut bad = good.clone();
        bad[at].2 = Duty::from_bits(bad[at].2.to_bits() ^ 1 << flip);
        let found = different(&mut LoopReplay::new(gains), &bad);
        prop_assert!(!known || found == [at], "{found:?}");
        // An integrator that was moved, away from the limits: one word differs, then all agree again.
        let gentle: Vec<_> = inputs.iter().map(|(r, s)| (r / 100, s / 100)).collect();
        let from = |integral: i32| log(&gains, PiState { integral: Duty::from_bits(integral) }, &gentle);
        let both: Vec<_> = from(integral / 4)[..at].iter().chain(&from(integral / 8 + 77)[at..]).copied().collect();
        prop_assert_eq!(different(&mut LoopReplay::new(gains), &both), [at]);
    }
}
