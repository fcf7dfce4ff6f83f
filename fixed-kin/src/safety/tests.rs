//! Requirements on the safety block, stated on causes and outputs.

use super::*;
use proptest::prelude::*;

const QUIET: Inputs = Inputs {
    emergency_stop: false,
    arm_write: false,
    arm_data: 0,
    pet: false,
    watchdog_timeout: 1_000,
    encoder_fault: false,
    commit_fault: false,
    external_fault: false,
    clear_faults: 0,
    stall_fault: false,
    tick: false,
    set_point_timeout: 3,
};
const PET: Inputs = Inputs { pet: true, ..QUIET };
const ARM: [Inputs; 2] = [
    Inputs { arm_write: true, arm_data: ARM_FIRST, ..QUIET },
    Inputs { arm_write: true, arm_data: ARM_SECOND, ..QUIET },
];

fn run(safety: &mut Safety, inputs: &Inputs, clocks: u32) -> Outputs {
    let mut out = safety.outputs;
    for _ in 0..clocks {
        out = safety.clock(inputs);
    }
    out
}

/// Released, petted, cleared and armed.
fn armed() -> Safety {
    let mut safety = Safety::default();
    run(&mut safety, &QUIET, 40);
    safety.clock(&PET);
    safety.clock(&Inputs { clear_faults: u8::MAX, ..QUIET });
    safety.clock(&ARM[0]);
    let out = safety.clock(&ARM[1]);
    // The same word once more would be refused.
    assert_eq!(out, Outputs { armed: true, off: false, stops: true, stopped: false, ..Outputs::default() });
    safety
}

#[test]
fn power_up_is_bitten_and_stopped() {
    let mut safety = Safety::default();
    let out = safety.clock(&PET);
    assert!(!out.armed);
    assert_eq!(out.faults, Fault::Watchdog.mask() | Fault::EmergencyStop.mask());
    assert_eq!(out.first_fault, out.faults);
}

#[test]
fn an_open_emergency_stop_is_never_released() {
    let mut safety = Safety::default();
    for _ in 0..200 {
        for inputs in [PET, ARM[0], ARM[1]] {
            let out = safety.clock(&Inputs { emergency_stop: true, ..inputs });
            assert!(!out.armed);
        }
    }
}

/// Arms anew with the time-out of these inputs, which is in force some clocks after it came.
fn armed_again(safety: &mut Safety, pet: &Inputs) {
    run(safety, pet, 3);
    for word in ARM {
        safety.clock(&Inputs { arm_write: true, arm_data: word.arm_data, ..*pet });
    }
    assert!(safety.clock(pet).armed);
}

#[test]
fn the_watchdog_bites_exactly_at_the_time_out() {
    for timeout in [1, 2, 3, 100, 5_000] {
        let mut safety = armed();
        let quiet = Inputs { watchdog_timeout: timeout, ..QUIET };
        let pet = Inputs { pet: true, ..quiet };
        armed_again(&mut safety, &pet);
        for _ in 0..5 {
            assert!(run(&mut safety, &quiet, timeout - 1).armed, "pets {timeout} apart are enough");
            assert!(safety.clock(&pet).armed);
        }
        assert!(run(&mut safety, &quiet, timeout).armed);
        let out = safety.clock(&quiet);
        assert_eq!((out.armed, out.setpoints_valid, out.first_fault), (false, false, 1), "timeout {timeout}");
    }
}

#[test]
fn a_shorter_time_out_disarms_until_it_is_in_force_and_zero_always_bites() {
    let mut safety = armed();
    assert!(run(&mut safety, &Inputs { watchdog_timeout: TIMEOUT_MASK, ..PET }, 1).armed);
    let short = Inputs { watchdog_timeout: 5, ..QUIET };
    let out = run(&mut safety, &short, 2);
    assert_eq!((out.armed, out.faults), (false, 0));
    armed_again(&mut safety, &Inputs { pet: true, ..short });
    assert!(run(&mut safety, &short, 5).armed);
    assert!(!safety.clock(&short).armed);
    let mut safety = armed();
    let zero = Inputs { watchdog_timeout: 0, ..PET };
    assert!(!run(&mut safety, &zero, 2).armed);
    for inputs in [ARM[0], ARM[1]] {
        assert!(!safety.clock(&Inputs { watchdog_timeout: 0, pet: true, ..inputs }).armed);
    }
}

#[test]
fn the_emergency_stop_acts_after_the_stated_clocks_and_glitches_do_not() {
    let stop = Inputs { emergency_stop: true, ..QUIET };
    let mut safety = armed();
    for width in 1..=u32::from(EMERGENCY_STOP_FILTER) {
        run(&mut safety, &stop, width);
        assert!(run(&mut safety, &PET, 20).armed);
    }
    assert!(run(&mut safety, &stop, EMERGENCY_STOP_CLOCKS - 1).armed);
    let out = safety.clock(&stop);
    assert_eq!((out.armed, out.first_fault), (false, Fault::EmergencyStop.mask()));
}

#[test]
fn disarming_faults_act_in_one_clock_and_the_others_only_report() {
    let cases = [
        (Fault::Encoder, Inputs { encoder_fault: true, ..QUIET }),
        (Fault::Stall, Inputs { stall_fault: true, ..QUIET }),
        (Fault::External, Inputs { external_fault: true, ..QUIET }),
        (Fault::CommitChecksum, Inputs { commit_fault: true, ..QUIET }),
    ];
    for (fault, inputs) in cases {
        let mut safety = armed();
        let out = safety.clock(&inputs);
        assert_eq!(out.armed, !fault.disarms());
        assert_eq!((out.faults, out.first_fault), (fault.mask(), fault.mask()));
        let later = safety.clock(&Inputs { encoder_fault: true, ..PET });
        assert_eq!(later.first_fault, fault.mask());
        assert_eq!(later.faults, fault.mask() | Fault::Encoder.mask());
        let cleared = safety.clock(&Inputs { clear_faults: u8::MAX, encoder_fault: true, ..PET });
        assert_eq!((cleared.faults, cleared.first_fault), (Fault::Encoder.mask(), Fault::Encoder.mask()));
    }
}

#[test]
fn set_points_are_valid_from_the_first_pet_after_arming() {
    let mut safety = armed();
    assert!(!run(&mut safety, &QUIET, 10).setpoints_valid);
    assert!(safety.clock(&PET).setpoints_valid);
    let out = safety.clock(&Inputs { arm_write: true, ..PET });
    assert_eq!((out.armed, out.setpoints_valid), (false, false));
    assert!(!safety.clock(&PET).setpoints_valid);
    // A set point at the very clock of arming was made for a disarmed robot.
    safety.clock(&ARM[0]);
    let out = safety.clock(&Inputs { pet: true, ..ARM[1] });
    assert_eq!((out.armed, out.setpoints_valid), (true, false));
}

#[test]
fn set_points_time_out_without_disarming_and_come_back() {
    let mut safety = armed();
    let tick = Inputs { tick: true, ..QUIET };
    for timeout in [0, 1, 2, 30, u16::MAX] {
        let tick = Inputs { set_point_timeout: timeout, ..tick };
        let pet = Inputs { pet: true, set_point_timeout: timeout, ..QUIET };
        assert!(safety.clock(&pet).setpoints_valid);
        if timeout < 100 {
            for n in 1..=timeout {
                assert!(safety.clock(&tick).setpoints_valid, "tick {n} of {timeout}");
            }
            let out = safety.clock(&Inputs { tick: false, ..tick });
            assert_eq!((out.armed, out.setpoints_valid), (true, false));
        }
    }
}

#[test]
fn the_first_fault_stays_the_first() {
    let causes = [
        (Fault::Encoder, Inputs { encoder_fault: true, ..QUIET }),
        (Fault::Stall, Inputs { stall_fault: true, ..QUIET }),
        (Fault::CommitChecksum, Inputs { commit_fault: true, ..QUIET }),
        (Fault::External, Inputs { external_fault: true, ..QUIET }),
    ];
    for (first, cause) in causes {
        for (second, other) in causes {
            let mut safety = armed();
            safety.clock(&cause);
            run(&mut safety, &QUIET, 3);
            let out = safety.clock(&other);
            assert_eq!(out.first_fault, first.mask(), "{first:?} then {second:?}");
            assert_eq!(out.faults, first.mask() | second.mask());
            // Both at one clock are both first.
            let mut safety = armed();
            let both = Inputs {
                encoder_fault: cause.encoder_fault || other.encoder_fault,
                stall_fault: cause.stall_fault || other.stall_fault,
                commit_fault: cause.commit_fault || other.commit_fault,
                external_fault: cause.external_fault || other.external_fault,
                ..QUIET
            };
            assert_eq!(safety.clock(&both).first_fault, first.mask() | second.mask());
        }
    }
}

#[test]
fn any_other_write_disarms_and_breaks_the_sequence() {
    for data in [0, 1, ARM_FIRST, ARM_SECOND, !ARM_FIRST, u32::MAX] {
        let write = Inputs { arm_write: true, arm_data: data, ..QUIET };
        let mut safety = armed();
        assert!(!safety.clock(&write).armed);
        if data != ARM_FIRST {
            let mut safety = armed();
            safety.clock(&ARM[0]);
            safety.clock(&write);
            assert!(data == ARM_SECOND || !safety.clock(&ARM[1]).armed);
        }
    }
}

#[test]
fn what_is_only_still_shown_keeps_nothing_from_arming() {
    let causes = [
        Inputs { encoder_fault: true, ..QUIET },
        Inputs { stall_fault: true, ..QUIET },
        Inputs { external_fault: true, ..QUIET },
        Inputs { commit_fault: true, ..QUIET },
        ARM[1],
    ];
    for cause in causes {
        let mut safety = armed();
        let shown = safety.clock(&cause).faults;
        assert_ne!(shown, 0);
        safety.clock(&ARM[0]);
        let out = safety.clock(&ARM[1]);
        assert_eq!((out.armed, out.faults), (true, shown), "{cause:?}");
    }
}

#[test]
fn a_written_one_clears_its_fault_alone_and_a_standing_one_comes_back() {
    let mut safety = armed();
    let both = Inputs { stall_fault: true, external_fault: true, ..QUIET };
    let (stall, external) = (Fault::Stall.mask(), Fault::External.mask());
    assert_eq!(safety.clock(&both).first_fault, stall | external);
    let out = safety.clock(&Inputs { clear_faults: external, ..QUIET });
    assert_eq!((out.faults, out.first_fault), (stall, stall));
    let out = safety.clock(&Inputs { clear_faults: u8::MAX, stall_fault: true, ..QUIET });
    assert_eq!((out.faults, out.first_fault), (stall, stall));
    assert_eq!(safety.clock(&Inputs { clear_faults: stall, ..QUIET }).faults, 0);
}

fn any_inputs() -> impl Strategy<Value = Inputs> {
    let word = prop_oneof![4 => Just(ARM_FIRST), 4 => Just(ARM_SECOND), 1 => any::<u32>()];
    let rare = || prop::bool::weighted(0.02);
    (rare(), prop::bool::weighted(0.4), word, prop::bool::weighted(0.3), 0..40_u32, rare(), rare(), rare(), rare())
        .prop_map(|(stop, arm_write, arm_data, pet, timeout, encoder, commit, external, clear)| Inputs {
            emergency_stop: stop,
            arm_write,
            arm_data,
            pet,
            watchdog_timeout: if timeout < 2 { timeout } else { 50 },
            encoder_fault: encoder,
            commit_fault: commit,
            clear_faults: if clear { u8::MAX } else { 0 },
            external_fault: external,
            ..QUIET
        })
}

proptest! {
    /// Statement over the whole history: armed means that the last two writes to the register
    /// were the two words in order, and that no disarming cause has been seen since.
    #[test]
    fn armed_has_a_complete_reason(stream in prop::collection::vec(any_inputs(), 0..600)) {
        let mut safety = Safety::default();
        run(&mut safety, &QUIET, 40);
        let mut words = [0, 0];
        let mut fault_since_first_word = true;
        let mut since_pet = u32::MAX;
        for inputs in stream {
            if inputs.arm_write {
                words = [words[1], inputs.arm_data];
                if inputs.arm_data == ARM_FIRST {
                    fault_since_first_word = false;
                }
            }
            let out = safety.clock(&inputs);
            if inputs.encoder_fault || inputs.external_fault {
                prop_assert!(!out.armed);
                fault_since_first_word = true;
            }
            if out.armed {
                prop_assert_eq!(words, [ARM_FIRST, ARM_SECOND]);
                prop_assert!(!fault_since_first_word);
                prop_assert!(since_pet <= 50, "{} clocks since the last pet", since_pet);
            }
            prop_assert!(out.armed || !out.setpoints_valid);
            prop_assert_eq!(out.first_fault & !out.faults, 0);
            prop_assert_eq!(out.first_fault == 0, out.faults == 0);
            since_pet = if inputs.pet { 0 } else { since_pet.saturating_add(1) };
        }
    }
}

#[test]
fn advancing_is_clocking() {
    for clocks in [0, 1, 5, 30, 995, 1_000, 1_005, 5_000] {
        for inputs in [QUIET, Inputs { emergency_stop: true, ..QUIET }, Inputs { watchdog_timeout: 7, ..QUIET }] {
            let mut slow = armed();
            let mut fast = slow;
            run(&mut slow, &inputs, clocks);
            fast.advance(&inputs, clocks);
            assert_eq!(fast, slow, "{clocks} clocks, {inputs:?}");
        }
    }
}
