//! Every proof of `testbench::formal` on the committed Verilog.

use hdl::design::COMMITTED_VERILOG;
use testbench::formal::PROOFS;

fn run(name: &str) {
    let proof = PROOFS.iter().find(|proof| proof.name == name).expect("a proof of this name");
    let proven = proof.run(COMMITTED_VERILOG).unwrap_or_else(|error| panic!("{error}"));
    assert!(!proof.mutants.is_empty(), "a claim without a mutant may be empty");
    println!(
        "| {} | {} | {} assertions, induction over {} | {} refuted | {:.1} s, mutants {:.1} s |",
        proof.name,
        proof.claim,
        proven.assertions,
        proven.depth,
        proof.mutants.len(),
        proven.time.as_secs_f64(),
        proven.mutants_time.as_secs_f64()
    );
}

macro_rules! proofs {
    ($($name:ident)*) => {
        $(#[test]
        fn $name() {
            run(stringify!($name));
        })*

        #[test]
        fn no_proof_is_forgotten() {
            let run = [$(stringify!($name)),*];
            let all: Vec<_> = PROOFS.iter().map(|proof| proof.name).collect();
            assert_eq!(run[..], all[..]);
        }
    };
}

proofs!(pwm safety gate monitor kicker snapshot commit bus registers timebase sequencer multiplier divider);
