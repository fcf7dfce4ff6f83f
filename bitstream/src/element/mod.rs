//! Basic elements as the configuration sets them: one plain type each, read from and written to a
//! [`Configuration`].
//!
//! Names of attributes: Project Combine. What they do: Xilinx DS001 and DS003 (Virtex data sheet), and where those
//! are silent the experiment named at the field.

mod block_ram;
mod clock;
mod io;
mod slice;
mod tri_state;

pub use block_ram::{BlockRam, Port, PortWidth};
pub use clock::{ClockPad, Dll, GlobalBuffer};
pub use io::{Driver, InputBuffer, Io, PadRegister, Pull};
pub use slice::{Carry0, FOutput, GOutput, RamMode, Slice};
pub use tri_state::TriState;

use crate::configuration::{AttributeError, Configuration};
use crate::device::{Device, TileId};

/// A plain enum of the choices of an attribute, with their names in the table.
macro_rules! choices {
    ($(#[$doc:meta])* $name:ident { $($(#[$item:meta])* $variant:ident = $text:literal,)* }) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum $name { $($(#[$item])* $variant,)* }

        impl $name {
            /// Every choice, in the order in which they are declared.
            pub const ALL: &'static [Self] = &[$(Self::$variant,)*];

            /// Its name in the device's table.
            #[must_use]
            pub fn name(self) -> &'static str {
                match self { $(Self::$variant => $text,)* }
            }

            pub(crate) fn named(name: &str) -> Option<Self> {
                match name { $($text => Some(Self::$variant),)* _ => None }
            }
        }
    };
}
use choices;

/// Attributes of one element: `SLICE[1]` of a tile.
struct Place<'a> {
    device: &'a Device,
    tile: TileId,
    prefix: String,
}

impl<'a> Place<'a> {
    fn new(device: &'a Device, tile: TileId, prefix: String) -> Self {
        Self { device, tile, prefix }
    }

    fn name(&self, attribute: &str) -> String {
        format!("{}:{attribute}", self.prefix)
    }

    fn flag(&self, configuration: &Configuration, attribute: &str) -> Result<bool, AttributeError> {
        Ok(self.number(configuration, attribute)? != 0)
    }

    fn number(&self, configuration: &Configuration, attribute: &str) -> Result<u64, AttributeError> {
        configuration.number(self.device, self.tile, &self.name(attribute))
    }

    fn choice<T>(
        &self,
        configuration: &Configuration,
        attribute: &str,
        named: impl Fn(&str) -> Option<T>,
    ) -> Result<T, AttributeError> {
        let name = configuration.choice(self.device, self.tile, &self.name(attribute))?;
        named(name).ok_or_else(|| AttributeError::Unknown {
            tile: self.device.describe_tile(self.tile),
            attribute: format!("{}={name}", self.name(attribute)),
        })
    }

    fn is(&self, configuration: &Configuration, attribute: &str, choice: &str) -> Result<bool, AttributeError> {
        Ok(configuration.choice(self.device, self.tile, &self.name(attribute))? == choice)
    }

    fn set(
        &self,
        configuration: &mut Configuration,
        attribute: &str,
        value: impl Into<u64>,
    ) -> Result<(), AttributeError> {
        configuration.set_number(self.device, self.tile, &self.name(attribute), value.into())
    }

    fn choose(&self, configuration: &mut Configuration, attribute: &str, choice: &str) -> Result<(), AttributeError> {
        configuration.set_choice(self.device, self.tile, &self.name(attribute), choice)
    }
}
