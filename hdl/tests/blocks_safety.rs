//! Safety: rust-hdl simulation = twin, clock by clock on all outputs.

use fixed_kin::safety::{Fault, Inputs, Safety};
use hdl::stimulus::{compare, safety};

const CLOCKS: usize = if cfg!(debug_assertions) { 30_000 } else { 2_000_000 };

#[test]
fn simulation_equals_twin() {
    let mut twin = Safety::default();
    let rows = safety::stimulus(2, CLOCKS);
    compare(&rows, safety::hardware(), |row| twin.clock(row)).unwrap_or_else(|e| panic!("{e}"));
}

#[test]
fn the_stimulus_reaches_the_corners() {
    let mut twin = Safety::default();
    let mut before = twin.clock(&Inputs::default());
    let mut armings = 0;
    let mut valid = 0;
    let mut causes = [0; Fault::ALL.len()];
    for row in safety::stimulus(2, 2_000_000) {
        let after = twin.clock(&row);
        armings += u32::from(after.armed && !before.armed);
        valid += u32::from(after.setpoints_valid);
        for (count, fault) in causes.iter_mut().zip(Fault::ALL) {
            let new = after.faults & !before.faults & fault.mask() != 0;
            *count += u32::from(new && before.armed && (after.armed != fault.disarms() || fault == Fault::ArmRefused));
        }
        before = after;
    }
    assert!(armings > 1_000 && valid > 10_000, "{armings} armings, {valid} clocks with set points");
    // An armed block never sees a refusal: the write of the first word has disarmed it.
    assert!(causes[..4].iter().all(|&n| n > 20), "faults while armed: {causes:?}");
}
