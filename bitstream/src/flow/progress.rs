//! What the flow tells whoever waits for it.

/// A stage of the flow.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Stage {
    /// Yosys is at work.
    Synthesis,
    /// Mapping and packing.
    Pack,
    /// Annealing; most of the time.
    Place,
    /// Rounds of negotiated congestion.
    Route,
    /// Setting bits.
    Bits,
    /// Decoding the bits and proving them.
    Proof,
}

impl Stage {
    /// In a word, for the bar.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Synthesis => "synthesis",
            Self::Pack => "pack",
            Self::Place => "place",
            Self::Route => "route",
            Self::Bits => "bits",
            Self::Proof => "proof",
        }
    }
}

/// Takes the stage, how much of it is done in percent, and a line about it.
type Callback<'a> = &'a mut dyn FnMut(Stage, u32, &str);

/// Is told the stage, how much of it is done in percent, and a line about it.
pub struct Progress<'a>(Option<Callback<'a>>);

impl<'a> Progress<'a> {
    /// Tells this callback.
    pub fn new(callback: &'a mut dyn FnMut(Stage, u32, &str)) -> Self {
        Self(Some(callback))
    }

    /// Tells nobody.
    #[must_use]
    pub fn silent() -> Self {
        Self(None)
    }

    pub(super) fn tell(&mut self, stage: Stage, percent: u32, line: impl FnOnce() -> String) {
        if let Some(callback) = &mut self.0 {
            callback(stage, percent, &line());
        }
    }
}
