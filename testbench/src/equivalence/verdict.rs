//! What the proof counts, and what it could not prove.

/// Start values of the text's flip-flops.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub struct Starts {
    /// The netlist's are the same.
    pub equal: usize,
    /// The netlist's differ.
    pub different: usize,
    /// The text leaves it open: that none of these reaches a pin undefined, simulation with four states shows.
    pub open: usize,
}

/// What was compared, and what is not proven equal.
#[derive(Clone, Debug, Default, Eq, PartialEq)]
pub struct Equivalence {
    /// Next states of flip-flops, in bits.
    pub flip_flops: usize,
    /// Data, address and enable pins of block memories, in bits.
    pub pins: usize,
    /// Levels and enables of pads, in bits.
    pub pads: usize,
    /// Clauses of what holds after a read met a write.
    pub clauses: usize,
    /// Memories of the text.
    pub memories: usize,
    /// Block memories that hold them.
    pub blocks: usize,
    /// Start values of memories, in bits.
    pub contents: usize,
    /// How flip-flops begin.
    pub starts: Starts,
    /// Whatever differs, or is not proven, by name.
    pub differences: Vec<String>,
}

impl Equivalence {
    pub(super) fn differ(&mut self, what: String) {
        self.differences.push(what);
    }

    /// Whether all is proven.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.differences.is_empty() && self.starts.different == 0
    }
}
