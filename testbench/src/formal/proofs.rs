//! The claims, in the order of the README's table.

use super::{Mutant, Proof};

const fn proof(name: &'static str, module: &'static str, claim: &'static str, checker: &'static str) -> Proof {
    Proof { name, claim, module, checker, inside: &[], depth: 4, cut: &[], free: &[], shrink: &[], mutants: &[] }
}

const fn mutant(what: &'static str, from: &'static str, to: &'static str) -> Mutant {
    Mutant { what, from, to }
}

/// Every proof on `generated/rac4i65.v`.
pub const PROOFS: &[Proof] = &[
    Proof {
        mutants: &[
            mutant("turns at once", "& rested_q & ~pwm_pin_q", "& ~pwm_pin_q"),
            mutant("rises at once", "enable & (settled_q | rested_q)", "enable"),
            mutant("up and down together", "dir = pwm_pin_q & dir_pin_q", "dir = pwm_pin_q"),
            mutant("ignores the enable", "permitted & ~stops & running", "~stops & running"),
            mutant("outlasts the arming", "permitted & ~stops & running", "permitted & running"),
        ],
        ..proof(
            "pwm",
            "rac4i65_core_drives",
            "DIR changes only after PWM was low for the blanking time, PWM rises only as long after it; disabled = low; up/down: \
             never both",
            include_str!("../../proofs/pwm.v"),
        )
    },
    Proof {
        inside: &[("rac4i65_core_encoders_line_a", include_str!("../../proofs/filter.v"))],
        shrink: &[("stop_filter = 4'hf", "stop_filter = 4'h1"), ("LIMIT = 15", "LIMIT = 1")],
        mutants: &[
            mutant("a fault does not disarm", "stays_armed = is_armed_q & ~standing", "stays_armed = is_armed_q"),
            mutant("one word arms", "is_second_word & first_word_q & ~standing", "is_second_word & ~standing"),
            mutant("no watchdog", "standing = bitten | is_stopped", "standing = is_stopped"),
            mutant("the pins stay on", "is_off_d = (~stays_armed)", "is_off_d = (~is_armed_q)"),
            mutant("a stall does not count", " | stall_fault | external_fault", " | external_fault"),
            mutant("set points last for ever", "has_setpoint_q & ~stale", "has_setpoint_q"),
            mutant(
                "what is only still shown keeps from arming",
                "is_second_word & first_word_q & ~standing",
                "is_second_word & first_word_q & ~standing & ~(|sticky_q)",
            ),
            mutant(
                "any write clears every fault",
                "(sticky_q & ~clear_faults) | events",
                "(sticky_q & ~{8{|clear_faults}}) | events",
            ),
        ],
        ..proof(
            "safety",
            "rac4i65_core_safety",
            "disarmed 19 clocks after the emergency stop, 1 after a fault, time-out + 1 after the last commit; armed by \
             both words in order if and only if no cause stands from the one to the other; a fault bit falls only by its \
             own one",
            include_str!("../../proofs/safety.v"),
        )
    },
    Proof {
        cut: &[
            "rac4i65_core_bus",
            "rac4i65_core_registers",
            "rac4i65_core_timebase",
            "rac4i65_core_decoder",
            "rac4i65_core_commit",
            "rac4i65_core_snapshot",
            "rac4i65_core_safety",
            "rac4i65_core_kicker",
            "rac4i65_core_monitor",
            "rac4i65_core_sequencer",
            "rac4i65_core_encoders",
            "rac4i65_core_stalls",
            "rac4i65_core_trigonometry",
            "rac4i65_core_interrupt",
            "rac4i65_core_radio",
            "rac4i65_core_imu",
        ],
        mutants: &[
            mutant("a write meets a store", "radio_writes = radio_turn & ~blocked", "radio_writes = radio_turn"),
            mutant("two masters", "radio_turn = radio_offer & ~bus_claims", "radio_turn = radio_offer"),
            mutant("the host commands always", "(bus_write_2 & ~radio_selected)", "bus_write_2"),
            mutant("a dead clock keeps the bridges on", "shut = safety_off | ~alive", "shut = safety_off"),
            mutant("a dead clock keeps the pulses on", "if (~alive) begin", "if (1'b0) begin"),
            mutant(
                "a drive is not told",
                "drives_2(\n        .clock(lclk),\n        .enable(safety_armed),\n        .stops(safety_stops)",
                "drives_2(\n        .clock(lclk),\n        .enable(safety_armed),\n        .stops(1'b0)",
            ),
            mutant("discharges while armed", "kicker_discharge = shut & ~holds", "kicker_discharge = ~holds"),
            mutant("the trigger passes unarmed", "~(kicker_trigger & ~shut)", "~(kicker_trigger & alive)"),
        ],
        ..proof(
            "gate",
            "rac4i65_core",
            "not armed or LCLK dead: PWM low, bridges disabled, charger and trigger off at the pins, in the same clock; \
             discharge never beside them; one master at a time, and only the one in command",
            include_str!("../../proofs/gate.v"),
        )
    },
    Proof {
        free: &["toggle"],
        shrink: &[("good_limit = 8'hff", "good_limit = 8'h3")],
        mutants: &[mutant(
            "silence is forgiven",
            "silent_q == silent_limit",
            "silent_q == silent_zero & good_q == 8'hfe",
        )],
        ..proof(
            "monitor",
            "rac4i65_core_monitor",
            "everything off 35 crystal edges after LCLK stops; alive only after 256 changes",
            include_str!("../../proofs/monitor.v"),
        )
    },
    Proof {
        shrink: &[
            ("maximum_pulse = 14'b10011100010000", "maximum_pulse = 14'd3"),
            ("commutation_time = 20'h4e20", "commutation_time = 20'd4"),
            ("minimum_lockout = 20'h186a0", "minimum_lockout = 20'd6"),
            ("charge_gap = 10'b1111101000", "charge_gap = 10'd2"),
            (
                "FORMAL_PULSE = 10000, FORMAL_LOCKOUT = 100000, FORMAL_COMMUTATION = 20000",
                "FORMAL_PULSE = 3, FORMAL_LOCKOUT = 6, FORMAL_COMMUTATION = 4",
            ),
        ],
        mutants: &[
            mutant("no maximum", " | (short_coming >= maximum_pulse)", ""),
            mutant("no least lock-out", " & (coming_q >= minimum_lockout)", ""),
            mutant("charges while it fires", "~expired & may_charge", "~expired"),
            mutant(
                "fires on when disabled",
                "if (~enable | (microsecond & pulse_over)) begin",
                "if (microsecond & pulse_over) begin",
            ),
            mutant(
                "asked again, the charger has its time again",
                "if (~enable | stuffed | in_pulse) begin",
                "if (~charge_request | stuffed | in_pulse) begin",
            ),
            mutant(
                "the ball fires for what was set before",
                "arm_on_ball & (spent_q | ~enable | accepts)",
                "arm_on_ball & (spent_q | accepts)",
            ),
        ],
        ..proof(
            "kicker",
            "rac4i65_core_kicker",
            "pulse at most 10,000 strobes and 340,000 clocks, 100,000 strobes between pulses, charger off from before \
             the pulse to 20,000 strobes after it, nothing while disabled; all charging since full, a pulse or disarming \
             within the time-out; the ball fires once for a rise of arm-on-ball while armed",
            include_str!("../../proofs/kicker.v"),
        )
    },
    Proof {
        mutants: &[
            mutant("the held bank is written", "kept = held_bank_q", "kept = latest_q"),
            mutant("there are four banks", "if (latest_q == kept) begin", "if (1'b0) begin"),
            mutant("the latest is not finished", "if (done) begin", "if (tick) begin"),
            mutant("word 0 is of the bank held before", "held_bank_d = latest_q", "held_bank_d = held_bank_q"),
        ],
        ..proof(
            "snapshot",
            "rac4i65_core_snapshot",
            "word 0 is of the tick that finished last; from it to the last word all reads see its bank, which nobody writes",
            include_str!("../../proofs/snapshot.v"),
        )
    },
    Proof {
        shrink: &[("all_configuration = 6'b110100", "all_configuration = 6'd2"), ("WORDS = 52", "WORDS = 2")],
        mutants: &[
            mutant(
                "a word staged at the tick acts",
                "if (set_points_wait_q & ~stage_set_point) begin",
                "if (set_points_wait_q) begin",
            ),
            mutant("no checksum", "right = sum_right_q & (set_points_q", "right = (set_points_q"),
            mutant(
                "a word too many",
                "(configuration_q == all_configuration)",
                "(configuration_q >= all_configuration)",
            ),
        ],
        ..proof(
            "commit",
            "rac4i65_core_commit",
            "banks change only at a tick after an accepted commit (checksum, word count) with nothing staged since",
            include_str!("../../proofs/commit.v"),
        )
    },
    Proof {
        shrink: &[("held_limit = 6'b111111", "held_limit = 6'd3"), ("LONGEST = 65", "LONGEST = 5")],
        mutants: &[
            mutant("waits for ever", "if (write_busy & ~expired) begin", "if (write_busy) begin"),
            mutant("drives on", "if (ends) begin", "if (last_q) begin"),
        ],
        ..proof(
            "bus",
            "rac4i65_core_bus",
            "READY# at most 66 clocks after ADS# or the word before, never unasked; LAD driven only for owed read words",
            include_str!("../../proofs/bus.v"),
        )
    },
    Proof {
        mutants: &[
            mutant("no lock", "unlocked = ~armed", "unlocked = 1'b1"),
            mutant("any word fires", "fire = word_q == fire_word", "fire = 1'b1"),
        ],
        ..proof(
            "registers",
            "rac4i65_core_registers",
            "no locked setting changes while armed; strobes only from writes; a kick only by its word, a fault only by its \
             one",
            include_str!("../../proofs/registers.v"),
        )
    },
    Proof {
        mutants: &[
            mutant("no microseconds", "microsecond_ends_d = 1'b1", "microsecond_ends_d = 1'b0"),
            mutant("no shortest period", "if (tick_period < shortest) begin", "if (1'b0) begin"),
        ],
        ..proof(
            "timebase",
            "rac4i65_core_timebase",
            "25 to 34 clocks between microseconds whatever the register says, at least 1000 between ticks",
            include_str!("../../proofs/timebase.v"),
        )
    },
    Proof {
        cut: &["rac4i65_core_imu_words"],
        mutants: &[
            mutant(
                "waits for the sensor",
                "edge_now = run_q & (phase_q == half)",
                "edge_now = run_q & (phase_q == half) & miso",
            ),
            mutant(
                "reads although it is off",
                "begins_burst = starts_q & live_q & ~run_q",
                "begins_burst = starts_q & ~run_q",
            ),
            mutant(
                "the host breaks in",
                "begins_access = access & ~enable & ~live_q & ~run_q",
                "begins_access = access & ~run_q",
            ),
            mutant("starts in the middle of an access", "live_d = enable & (live_q | ~run_q)", "live_d = enable"),
            mutant("a word of two bits", "word_end = 5'b11110", "word_end = 5'b00010"),
            mutant("rests at the wrong level", "clock_high_d = idle_high;", "clock_high_d = 1'b0;"),
        ],
        ..proof(
            "imu_spi",
            "rac4i65_core_imu",
            "every tick has its burst if reading is on and none if it is off, over 970 clocks after the tick whatever the sensor \
             sends; whole words only, in the tick's bank; the line's clock rests while nobody is selected; an access takes at \
             most 136 clocks and no burst meets it",
            include_str!("../../proofs/imu_spi.v"),
        )
    },
    Proof {
        cut: &["rac4i65_core_radio_memory"],
        free: &["receiver"],
        // No bits but bytes: a right CRC in few clocks.
        shrink: &[
            ("gap = 5'b10100", "gap = 5'd2"),
            ("residue = 32'hdebb20e3", "residue = 32'hffffffff"),
            ("FORMAL_RESIDUE = 32'hdebb20e3", "FORMAL_RESIDUE = 32'hffffffff"),
        ],
        mutants: &[
            mutant("forgives damage", "(stage_q == at_end) & check_right_q", "stage_q == at_end"),
            mutant("any length", "refuses = ~length_fits", "refuses = 1'b0"),
            mutant("a broken byte is none", "refuses = receiver_broken & listening_q", "refuses = 1'b0"),
        ],
        ..proof(
            "radio",
            "rac4i65_core_radio",
            "no word reaches the core but of a frame between two silences with right head, robot, length, CRC and a new \
             number; not one more than it has, each held until taken",
            include_str!("../../proofs/radio.v"),
        )
    },
    Proof {
        shrink: &[("whole_bit = 9'b100100000", "whole_bit = 9'd1"), ("half_bit = 9'b10001111", "half_bit = 9'd0")],
        mutants: &[
            mutant("a low stop bit is one", "byte_done = sampling & stop & high", "byte_done = sampling & stop"),
            mutant("highest bit first", "(shift_q >> 32'h1) | top_bit", "(shift_q << 32'h1) | 8'h1"),
        ],
        ..proof(
            "receiver",
            "rac4i65_core_radio_receiver",
            "a byte is the eight bits before it, between a low start bit and a high stop bit",
            include_str!("../../proofs/receiver.v"),
        )
    },
    Proof {
        cut: &[
            "rac4i65_core_sequencer_memory",
            "rac4i65_core_sequencer_rom",
            "rac4i65_core_sequencer_multiplier",
            "rac4i65_core_sequencer_divider",
        ],
        mutants: &[
            mutant("clamps one way", "(sum_top != three_clear) & (sum_top != three_set)", "sum_top == 3'b001"),
            mutant("loses a write of the bus", "bus_blocked = stores_q", "bus_blocked = 1'b0"),
            mutant("a read that meets a write", "if (bus_hits_q) begin", "if (1'b0) begin"),
        ],
        ..proof(
            "sequencer",
            "rac4i65_core_sequencer",
            "sums and differences of any 31-bit values clamp to a word; no write of bus or program is lost, and a read that \
             meets one gives the new word",
            include_str!("../../proofs/sequencer.v"),
        )
    },
    Proof {
        mutants: &[mutant("no clamp", "fits = (top_5 == five_clear) | (top_5 == five_set)", "fits = 1'b1")],
        ..proof(
            "multiplier",
            "rac4i65_core_sequencer_multiplier",
            "no partial sum leaves 32 bits; the result is the 40-bit product clamped to a word",
            include_str!("../../proofs/multiplier.v"),
        )
    },
    Proof {
        mutants: &[
            mutant("overflow unseen", "overflow_d = 1'b1", "overflow_d = 1'b0"),
            mutant("sign lost", "if (negative_q) begin", "if (1'b0) begin"),
        ],
        ..proof(
            "divider",
            "rac4i65_core_sequencer_divider",
            "the quotient is a clamped word with the sign of the numerator, less one where that is negative, also for a zero divisor",
            include_str!("../../proofs/divider.v"),
        )
    },
];
