//! Whether the clocks of robot and camera were set against each other anew for every run, where there are many runs.
//!
//! A clock of each run is a parameter of each run, and hundreds of them cost more than all else that is fitted: `gap` took
//! 507 s of processor time with them and 72 s without on 425 runs, 86 minutes at 1 kHz. They are fitted if the age of the
//! frames, taken from each run alone, is not the same in all.

/// Runs up to which each has a clock of its own without asking. In `gap` a sample has as many pieces: of each run one.
pub const FEW_RUNS: usize = 32;
/// Age of a camera frame that matters, s: a robot at 1 m/s is then 3 mm off, twice a league camera's noise.
pub const MATTERS_S: f64 = 0.003;
/// Standard deviations that the age of one of hundreds of runs may be off by chance: with 425 of them in one of forty data
/// sets, which then only takes longer. Where one clock did for all, none was off by more than 1.4 ms, two of its standard
/// deviations (the same runs, skews of 4, -3 and 2 degrees not yet known).
const SIGMAS: f64 = 4.0;

/// The age of a run's frames with its standard deviation, s, from the information on it, the score and the sum of squares
/// of `n` residuals in units of the noise; `None` where the run tells nothing.
pub fn age(information: f64, score: f64, squares: f64, n: f64) -> Option<[f64; 2]> {
    (information > 0.0 && n > 0.0).then(|| [score / information, ((squares / n).max(1.0) / information).sqrt()])
}

/// Whether the frames of some run are older or younger than those of most, by more than `matters` and chance.
pub fn differ(ages: &[[f64; 2]], matters: f64) -> bool {
    let mut sorted: Vec<f64> = ages.iter().map(|[age, _]| *age).collect();
    let usual = estimation::statistics::median(&mut sorted);
    ages.iter().any(|[age, error]| (age - usual).abs() > matters + SIGMAS * error)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_clock_among_many_is_noticed() {
        let same: Vec<[f64; 2]> = (0..100).map(|k| [0.02 + 1e-4 * f64::from(k % 7), 5e-4]).collect();
        assert!(!differ(&same, MATTERS_S));
        let other = [&same[..], &[[0.04, 5e-4]]].concat();
        assert!(differ(&other, MATTERS_S));
        // A run that hardly moved knows no clock.
        let unsure = [&same[..], &[[0.04, 0.01]]].concat();
        assert!(!differ(&unsure, MATTERS_S));
        assert!(!differ(&[], MATTERS_S));
        assert_eq!(age(0.0, 1.0, 1.0, 3.0), None);
        assert_eq!(age(4.0, 2.0, 12.0, 3.0), Some([0.5, 1.0]));
    }
}
