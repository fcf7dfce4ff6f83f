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

/// The program's own memory is not among them: that no instruction reads a word whose store is under way depends on the
/// program, whose assembler looks at it; in simulation such a read gives garbage.
pub(super) const CLAUSES: &[Clause] = &[
    // The bus is given the word that was written, which a flip-flop keeps.
    Clause { memory: Some("core.sequencer.mirror.mem"), any: &[("core.sequencer.bus_hits.q", true)] },
    // A frame is played back when it is complete: then none is heard.
    Clause { memory: Some("core.radio.memory.mem"), any: &[("core.radio.playing.q", false)] },
    Clause { memory: None, any: &[("core.radio.playing.q", false), ("core.radio.listening.q", false)] },
];
