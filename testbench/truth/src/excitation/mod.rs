//! What the robot drives: excitations drawn at random, as body-frame commands every 5 ms.

mod patterns;

use rand::RngExt;
use rand::seq::IndexedRandom;
use rand_chacha::ChaCha8Rng;

/// Time between two commands, s.
pub const COMMAND_PERIOD_S: f64 = 0.005;

/// A family of drives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pattern {
    /// Straight lines out and back in several directions, ramps of speed.
    Lines,
    /// A square of straight legs, turning slowly.
    Square,
    /// Circles: the direction of travel turns, the robot may turn too.
    Circle,
    /// Turns on the spot.
    Rotation,
    /// Rising frequency in all three freedoms.
    Sweep,
    /// Sums of sines in all three freedoms.
    Multisine,
    /// Steps of speed with rests between.
    StopAndGo,
    /// Steps beyond what motors and grip can follow.
    GoHard,
    /// Very slow motion with many reversals.
    Creep,
}

impl Pattern {
    /// Its name in the truth file.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Lines => "lines",
            Self::Square => "square",
            Self::Circle => "circle",
            Self::Rotation => "rot",
            Self::Sweep => "sweep",
            Self::Multisine => "multisine",
            Self::StopAndGo => "stopgo",
            Self::GoHard => "gohard",
            Self::Creep => "creep",
        }
    }
}

/// Patterns of a set: three to five runs. A usual set has one straight drive, one that turns, one rich in frequencies and
/// one with steps, in this order; others are drawn freely.
pub(crate) fn draw_patterns(rng: &mut ChaCha8Rng, translations_only: bool) -> Vec<Pattern> {
    use Pattern as P;
    let pools: [&[P]; 5] = if translations_only {
        [
            &[P::Lines, P::Square],
            &[P::Square, P::Circle],
            &[P::Lines, P::Sweep],
            &[P::StopAndGo, P::GoHard],
            &[P::Lines, P::Creep],
        ]
    } else {
        [
            &[P::Lines, P::Square],
            &[P::Circle, P::Rotation],
            &[P::Sweep, P::Multisine],
            &[P::StopAndGo, P::StopAndGo, P::GoHard],
            &[P::Creep, P::Circle, P::Multisine, P::Lines],
        ]
    };
    let count = *[3, 4, 4, 4, 5].choose(rng).unwrap_or(&4);
    let mut order: Vec<usize> = (0..count).collect();
    if count == 3 {
        // Leave out one of the first four; what remains still turns and translates.
        order = (0..4).collect();
        order.remove(rng.random_range(0..4));
    }
    order.into_iter().filter_map(|i| pools[i].choose(rng).copied()).collect()
}

/// Commands of one run of 6 to 8 s, at rest during its first and last 0.2 s.
pub(crate) fn draw_commands(pattern: Pattern, translations_only: bool, rng: &mut ChaCha8Rng) -> Vec<[f64; 3]> {
    let seconds = rng.random_range(6.0..8.0);
    let mut commands = patterns::commands(pattern, seconds, rng);
    if translations_only {
        for command in &mut commands {
            command[2] = 0.0;
        }
    }
    commands
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::noise::{Stream, stream};

    const ALL: [Pattern; 9] = [
        Pattern::Lines,
        Pattern::Square,
        Pattern::Circle,
        Pattern::Rotation,
        Pattern::Sweep,
        Pattern::Multisine,
        Pattern::StopAndGo,
        Pattern::GoHard,
        Pattern::Creep,
    ];

    #[test]
    fn every_run_lasts_six_to_eight_seconds_and_starts_and_ends_at_rest() {
        let mut rng = stream(1, Stream::Excitation);
        for pattern in ALL.into_iter().cycle().take(90) {
            let commands = draw_commands(pattern, false, &mut rng);
            let seconds = commands.len() as f64 * COMMAND_PERIOD_S;
            assert!((5.99..=8.01).contains(&seconds), "{pattern:?} {seconds}");
            assert!(commands[..40].iter().chain(&commands[commands.len() - 38..]).all(|c| *c == [0.0; 3]));
            let fastest = commands.iter().map(|c| c[0].hypot(c[1]) + 0.08 * c[2].abs()).fold(0.0, f64::max);
            assert!((0.01..2.2).contains(&fastest), "{pattern:?} {fastest}");
        }
    }

    #[test]
    fn translations_only_never_turn() {
        let mut rng = stream(2, Stream::Excitation);
        for _ in 0..20 {
            for pattern in draw_patterns(&mut rng, true) {
                assert!(draw_commands(pattern, true, &mut rng).iter().all(|c| c[2] == 0.0));
            }
        }
    }

    #[test]
    fn sets_have_three_to_five_runs() {
        let mut rng = stream(3, Stream::Excitation);
        let counts: Vec<usize> = (0..200).map(|_| draw_patterns(&mut rng, false).len()).collect();
        assert!((3..=5).all(|n| counts.contains(&n)) && counts.iter().all(|n| (3..=5).contains(n)));
    }
}
