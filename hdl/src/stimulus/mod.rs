//! Seeded stimulus for the blocks, and what carries it to their ports.
//!
//! One generator serves three simulations: the twin in `fixed-kin`, the rust-hdl block and the
//! emitted Verilog. Each submodule has `stimulus(seed, clocks)`, a `hardware()` that is the
//! rust-hdl block behind the twin's interface, and the column names and words of its ports.

pub mod clock_monitor;
pub mod control;
pub mod encoder;
pub mod imu_spi;
pub mod interrupt;
pub mod kicker;
pub mod pwm;
pub mod radio;
pub mod safety;
pub mod stall;

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use std::fmt::{Debug, Display, Formatter};

/// A set of ports as words: one column each, in the order of the block's ports, without clocks.
pub trait Columns {
    /// Port names.
    const NAMES: &'static [&'static str];

    /// Appends one word per port.
    fn append_to(&self, row: &mut Vec<u32>);
}

/// Port names are the field names of the twin's structs.
macro_rules! columns {
    ($ports:ty { $($name:ident),+ $(,)? }) => {
        impl $crate::stimulus::Columns for $ports {
            const NAMES: &'static [&'static str] = &[$(stringify!($name)),+];

            fn append_to(&self, row: &mut Vec<u32>) {
                row.extend([$(u32::from(self.$name)),+]);
            }
        }
    };
}
pub(crate) use columns;

/// Where hardware and twin part.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Difference {
    /// Clock, from 0.
    pub clock: usize,
    /// Outputs of the hardware, as text.
    pub hardware: String,
    /// Outputs of the twin, as text.
    pub twin: String,
    /// Inputs at that clock, as text.
    pub inputs: String,
}

impl Display for Difference {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        let Self { clock, hardware, twin, inputs } = self;
        write!(f, "clock {clock}:\n  inputs   {inputs}\n  hardware {hardware}\n  twin     {twin}")
    }
}

impl std::error::Error for Difference {}

/// Plays `inputs` to both and compares all outputs at every clock.
///
/// # Errors
/// The first clock at which they differ.
pub fn compare<I: Debug, O: Debug + PartialEq>(
    inputs: &[I],
    mut hardware: impl FnMut(&I) -> O,
    mut twin: impl FnMut(&I) -> O,
) -> Result<(), Difference> {
    for (clock, inputs) in inputs.iter().enumerate() {
        let (hardware, twin) = (hardware(inputs), twin(inputs));
        if hardware != twin {
            return Err(Difference {
                clock,
                hardware: format!("{hardware:?}"),
                twin: format!("{twin:?}"),
                inputs: format!("{inputs:?}"),
            });
        }
    }
    Ok(())
}

/// The generator of a seed: the same numbers on every machine.
fn generator(seed: u64) -> ChaCha8Rng {
    ChaCha8Rng::seed_from_u64(seed)
}
