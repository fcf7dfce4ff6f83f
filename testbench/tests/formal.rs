//! Every proof of `testbench::formal` on the committed Verilog.

use hdl::design::COMMITTED_VERILOG;
use measured::Table;
use testbench::formal::{FormalError, Mutant, PROOFS, Proof};

const TABLE: Table<'_> = Table {
    name: "proofs",
    title: "Claims proven on the committed Verilog, by temporal induction, for every input and reachable state",
    command: "cargo test --release -p testbench --test formal",
    columns: &["block", "claim", "assertions", "induction depth", "mutants, all refuted"],
};

fn run(name: &str) {
    let proof = PROOFS.iter().find(|proof| proof.name == name).expect("a proof of this name");
    let proven = proof.run(COMMITTED_VERILOG).unwrap_or_else(|error| panic!("{error}"));
    assert!(!proof.mutants.is_empty(), "a claim without a mutant may be empty");
    println!("{}: {:.1} s, mutants {:.1} s", proof.name, proven.time.as_secs_f64(), proven.mutants_time.as_secs_f64());
    let counts = [proven.assertions.to_string(), proven.depth.to_string(), proof.mutants.len().to_string()];
    TABLE.check_row(&[&[proof.name.to_owned(), proof.claim.to_owned()], &counts[..]].concat());
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

proofs!(pwm safety gate monitor kicker snapshot commit bus registers timebase imu_spi radio receiver sequencer multiplier divider);

const COUNTER: &str = "module counter (\n    input wire clock,\n    output reg [3:0] q\n);\n    initial q = 0;\n\
    \x20   always @(posedge clock) q <= q == 9 ? 0 : q + 1;\nendmodule\n";
const PROOF: Proof = Proof {
    name: "counter",
    claim: "below ten",
    module: "counter",
    checker: "always @(*) assert (q < 10);\n",
    inside: &[],
    depth: 3,
    cut: &[],
    free: &[],
    shrink: &[],
    mutants: &[Mutant { what: "one too far", from: "q == 9", to: "q == 10" }],
};

#[test]
fn a_claim_is_proven_and_its_mutant_refuted() {
    let proven = PROOF.run(COUNTER).unwrap();
    assert_eq!((proven.depth, proven.assertions), (1, 1));
}

#[test]
fn a_false_claim_a_lame_mutant_and_a_misplaced_one_are_errors() {
    let run = |proof: Proof| proof.run(COUNTER).unwrap_err();
    let wrong = Proof { checker: "always @(*) assert (q < 2);\n", ..PROOF };
    assert!(run(wrong).to_string().contains("from power-up"));
    let weak = Proof { mutants: &[Mutant { what: "none", from: "q == 9", to: "q >= 9" }], ..PROOF };
    assert!(matches!(run(weak), FormalError::Survived { .. }));
    let misplaced = Proof { mutants: &[Mutant { what: "none", from: "q == 7", to: "q == 8" }], ..PROOF };
    assert!(matches!(run(misplaced), FormalError::NoPlace { count: 0, .. }));
    let unknown = Proof { module: "other", ..PROOF };
    assert!(matches!(run(unknown), FormalError::NoModule { .. }));
    let open = Proof { checker: "always @(*) assert (q != 12);\n", depth: 1, ..PROOF };
    assert!(run(open).to_string().contains("does not close"));
    let garbled = Proof { checker: "always assert q;\n", ..PROOF };
    assert!(matches!(run(garbled), FormalError::Tool(_)));
}
