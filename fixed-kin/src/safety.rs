//! Bit-true twin of the safety block: watchdog, arm sequence, emergency stop, fault registers.
//!
//! One [`Safety::clock`] is one rising edge of the FPGA clock; the outputs are those that hold
//! until the next edge. The all-zero state is the safe one: stopped, bitten, disarmed.
//!
//! Clocks from a cause to `armed` low, counting the edge that first sees the cause as the first:
//!
//! | cause | edges |
//! |---|---|
//! | a write to the arm register | 1 |
//! | `encoder_fault`, `external_fault` | 1 |
//! | no pet: after the edge of the last one | timeout + 1 |
//! | emergency stop pin | [`EMERGENCY_STOP_CLOCKS`] |

use crate::encoder::GlitchFilter;

/// First word of the arm sequence, `ARM1` in ASCII.
pub const ARM_FIRST: u32 = u32::from_be_bytes(*b"ARM1");
/// Second word of the arm sequence, `ARM2` in ASCII.
pub const ARM_SECOND: u32 = u32::from_be_bytes(*b"ARM2");

/// Filter setting of the emergency stop input: it must hold for 16 clocks, either way.
pub const EMERGENCY_STOP_FILTER: u8 = 15;
/// Edges from the first that samples the stop level to the one that switches off.
pub const EMERGENCY_STOP_CLOCKS: u32 = 2 + EMERGENCY_STOP_FILTER as u32 + 1 + 1;

/// Width mask of the watchdog time-out.
pub const TIMEOUT_MASK: u32 = 0x00FF_FFFF;

/// Bits of the fault registers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Fault {
    /// No valid set point for longer than the time-out. Disarms.
    Watchdog = 0,
    /// The emergency stop input is high or open. Disarms.
    EmergencyStop = 1,
    /// An encoder is broken. Disarms.
    Encoder = 2,
    /// A commit whose checksum was wrong; reported only, since nothing was taken over.
    CommitChecksum = 3,
    /// Link loss or another block's fault. Disarms.
    External = 4,
    /// A second arm word out of order or while a fault stood; reported only.
    ArmRefused = 5,
}

impl Fault {
    /// Every fault, in the order of its bit.
    pub const ALL: [Self; 6] =
        [Self::Watchdog, Self::EmergencyStop, Self::Encoder, Self::CommitChecksum, Self::External, Self::ArmRefused];

    /// The fault's bit in the registers.
    #[must_use]
    pub const fn mask(self) -> u8 {
        1 << self as u8
    }

    const fn when(self, condition: bool) -> u8 {
        if condition { self.mask() } else { 0 }
    }

    /// Whether the fault switches the outputs off and keeps them from being armed.
    #[must_use]
    pub const fn disarms(self) -> bool {
        !matches!(self, Self::CommitChecksum | Self::ArmRefused)
    }
}

/// Pins, strobes and registers the block sees at one clock.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Inputs {
    /// Raw pin: high or open = stop.
    pub emergency_stop: bool,
    /// Strobe: the arm register is written.
    pub arm_write: bool,
    /// What is written to it.
    pub arm_data: u32,
    /// Strobe: a valid set point was committed.
    pub pet: bool,
    /// Clocks a pet lasts, 24 bits; 0 = always bitten. A shorter one takes effect at once.
    pub watchdog_timeout: u32,
    /// Level: an encoder is broken.
    pub encoder_fault: bool,
    /// Strobe: a commit with a wrong checksum.
    pub commit_fault: bool,
    /// Level: link loss or another block's fault.
    pub external_fault: bool,
    /// Strobe: clears both fault registers; what still stands appears again at the same clock.
    pub clear_faults: bool,
}

/// Outputs of the block after a clock.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Outputs {
    /// The outputs of the card may be on.
    pub armed: bool,
    /// A set point has come since arming.
    pub setpoints_valid: bool,
    /// Sticky faults, bits as in [`Fault`].
    pub faults: u8,
    /// Those that came first since the last clearing.
    pub first_fault: u8,
}

/// State of the safety block.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Safety {
    /// Filters the inverted pin, so that the power-up state is "stopped".
    released: GlitchFilter,
    remaining: u32,
    first_word: bool,
    outputs: Outputs,
}

impl Safety {
    /// One clock.
    pub fn clock(&mut self, inputs: &Inputs) -> Outputs {
        let before = *self;
        let timeout = inputs.watchdog_timeout & TIMEOUT_MASK;
        self.released.clock(!inputs.emergency_stop, true, EMERGENCY_STOP_FILTER, false);
        self.remaining =
            if inputs.pet || before.remaining > timeout { timeout } else { before.remaining.saturating_sub(1) };

        let bitten = before.remaining == 0;
        let stopped = !before.released.value;
        let standing = bitten || stopped || inputs.encoder_fault || inputs.external_fault;
        let second_word = inputs.arm_write && inputs.arm_data == ARM_SECOND;
        let arms = second_word && before.first_word && !standing;
        let refused = second_word && !arms;

        self.first_word = !standing && if inputs.arm_write { inputs.arm_data == ARM_FIRST } else { before.first_word };
        self.outputs.armed = if inputs.arm_write { arms } else { before.outputs.armed && !standing };
        self.outputs.setpoints_valid =
            self.outputs.armed && (before.outputs.setpoints_valid || (before.outputs.armed && inputs.pet));

        let events = Fault::Watchdog.when(bitten)
            | Fault::EmergencyStop.when(stopped)
            | Fault::Encoder.when(inputs.encoder_fault)
            | Fault::CommitChecksum.when(inputs.commit_fault)
            | Fault::External.when(inputs.external_fault)
            | Fault::ArmRefused.when(refused);
        if inputs.clear_faults {
            self.outputs.faults = events;
            self.outputs.first_fault = events;
        } else {
            self.outputs.faults |= events;
            if before.outputs.first_fault == 0 {
                self.outputs.first_fault = events;
            }
        }
        self.outputs
    }
}

#[cfg(test)]
mod tests {
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
        clear_faults: false,
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
        safety.clock(&Inputs { clear_faults: true, ..QUIET });
        safety.clock(&ARM[0]);
        let out = safety.clock(&ARM[1]);
        assert_eq!(out, Outputs { armed: true, ..Outputs::default() });
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

    #[test]
    fn the_watchdog_bites_exactly_at_the_time_out() {
        for timeout in [1, 2, 3, 100, 5_000] {
            let mut safety = armed();
            let quiet = Inputs { watchdog_timeout: timeout, ..QUIET };
            let pet = Inputs { pet: true, ..quiet };
            assert!(run(&mut safety, &pet, 3).armed);
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
    fn a_shorter_time_out_counts_at_once_and_zero_always_bites() {
        let mut safety = armed();
        run(&mut safety, &Inputs { watchdog_timeout: TIMEOUT_MASK, ..PET }, 1);
        let short = Inputs { watchdog_timeout: 5, ..QUIET };
        assert!(run(&mut safety, &short, 6).armed);
        assert!(!safety.clock(&short).armed);
        let mut safety = armed();
        let zero = Inputs { watchdog_timeout: 0, ..PET };
        assert!(run(&mut safety, &zero, 1).armed);
        assert!(!safety.clock(&zero).armed);
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
            let cleared = safety.clock(&Inputs { clear_faults: true, encoder_fault: true, ..PET });
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
                clear_faults: clear,
                external_fault: external,
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
}
