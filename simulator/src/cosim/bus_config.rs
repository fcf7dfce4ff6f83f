//! The local bus among a design's ports.

/// Where the bus is and how patient its master.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BusConfig {
    /// Input: address strobe, active low.
    pub ads_n: String,
    /// Input: burst last, active low.
    pub blast_n: String,
    /// Input: high for a write.
    pub lw_r: String,
    /// Output: ready, active low.
    pub ready_n: String,
    /// The tri-state bus; where the design has no such port, `lad_in`, `lad_out` and `lad_drive`
    /// (this name and the suffixes) stand for it.
    pub lad: String,
    /// Clocks a word may wait for READY# before it is an error.
    pub max_wait: u32,
    /// Idle clocks between two cycles; 0 is back to back.
    pub gap: u32,
}

impl Default for BusConfig {
    fn default() -> Self {
        let name = |name: &str| name.to_owned();
        Self {
            ads_n: name("ads_n"),
            blast_n: name("blast_n"),
            lw_r: name("lw_r"),
            ready_n: name("ready_n"),
            lad: name("lad"),
            max_wait: 256,
            gap: 1,
        }
    }
}
