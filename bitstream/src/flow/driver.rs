//! Where nets are driven, as the proof asks for them.

/// Where a net is driven.
#[derive(Clone, Debug, Eq, Ord, PartialEq, PartialOrd)]
pub struct Driver {
    /// Name of the net.
    pub net: String,
    /// Column and row.
    pub at: (u8, u8),
    /// Element, such as `SLICE[1]` or `BRAM`.
    pub element: String,
    /// Pin of it, such as `XQ`; `CF` and `CG` are the carries out of its halves.
    pub pin: String,
    /// The cell of a flip-flop.
    pub flip_flop: Option<String>,
}
