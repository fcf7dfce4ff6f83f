//! A read that meets a write of the same word in the same clock: the device promises nothing, the Verilog gives the old
//! word. So what a block gives after such a clock counts as any value, another one on each side, and the proof must hold
//! nevertheless.
//!
//! That needs to know what state the circuit is in then. The clauses say it: they hold at the start, and if they hold before a
//! clock they hold after it, which is proven together with all else.

/// At least one of: no read of this memory met a write at the last clock; a flip-flop of the text has this value.
#[derive(Debug)]
pub(super) struct Clause {
    pub(super) memory: Option<&'static str>,
    pub(super) any: &'static [(&'static str, bool)],
}

/// The bus is not in both phases.
macro_rules! either_phase {
    ($one:literal, $other:literal) => {
        Clause {
            memory: None,
            any: &[(concat!("core.bus.", $one, ".q"), false), (concat!("core.bus.", $other, ".q"), false)],
        }
    };
}

/// The program's own memory is not among them: that no instruction reads a word whose store is under way depends on the
/// program, whose assembler looks at it; in simulation such a read gives garbage.
pub(super) const CLAUSES: &[Clause] = &[
    // What the copy of the registers gives is taken two clocks after a read began, and no write began in that clock: a
    // write of the bus is offered, and the radio's turn is only where the bus does not claim. The bus is in one phase.
    Clause { memory: Some("core.registers.kept.mem"), any: &[("core.bus.take.q", false)] },
    Clause { memory: None, any: &[("core.registers.writing.q", false), ("core.bus.pending.q", false)] },
    Clause { memory: None, any: &[("core.bus.claiming.q", true), ("core.bus.fetch.q", false)] },
    either_phase!("fetch", "pending"),
    either_phase!("fetch", "take"),
    either_phase!("fetch", "collect"),
    either_phase!("fetch", "offer"),
    either_phase!("fetch", "answer"),
    either_phase!("pending", "take"),
    either_phase!("pending", "collect"),
    either_phase!("pending", "offer"),
    either_phase!("pending", "answer"),
    either_phase!("take", "collect"),
    either_phase!("take", "offer"),
    either_phase!("take", "answer"),
    either_phase!("collect", "offer"),
    either_phase!("collect", "answer"),
    either_phase!("offer", "answer"),
    // The bus is given the word that was written, which a flip-flop keeps.
    Clause { memory: Some("core.sequencer.mirror.mem"), any: &[("core.sequencer.bus_hits.q", true)] },
    // A frame is played back when it is complete: then none is heard.
    Clause { memory: Some("core.radio.memory.mem"), any: &[("core.radio.playing.q", false)] },
    Clause { memory: None, any: &[("core.radio.playing.q", false), ("core.radio.listening.q", false)] },
];
