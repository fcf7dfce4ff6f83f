//! How fast the simulator is; only optimised builds are judged.

use std::time::Instant;

use truth::{Kind, draw, simulate};

#[test]
fn runs_are_simulated_at_twenty_times_real_time_or_faster() {
    let case = draw(1, &Kind::EffectFree).unwrap();
    let seconds: f64 = case.drives.iter().map(truth::Drive::seconds).sum();
    let start = Instant::now();
    let logs = simulate(&case);
    let ratio = seconds / start.elapsed().as_secs_f64();
    println!("{} runs, {seconds:.1} s: {ratio:.0} times real time", logs.len());
    if !cfg!(debug_assertions) {
        assert!(ratio > 20.0, "only {ratio:.1} times real time");
    }
}
