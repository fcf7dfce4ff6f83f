//! Which card a command works on.

use crate::terminal::Failure;
use clap::Args;
use driver::pci::{PciCard, SYSFS_DEVICES, SysfsCard, Use, find};
use std::path::Path;

/// Name that stands for the built-in card.
#[cfg(feature = "simulation")]
const VIRTUAL: &str = "virtual";

/// The card.
#[derive(Args, Clone, Debug, Default)]
pub(crate) struct CardOptions {
    /// PCI slot of the card, as lspci names it; without it the only Mesa 4I65 there is
    #[cfg_attr(feature = "simulation", doc = "(`virtual` is the built-in one, bit-true, with a robot behind it)")]
    #[arg(long, value_name = "SLOT")]
    pub(crate) card: Option<String>,
}

/// A card that was opened.
pub(crate) struct OpenCard {
    /// Its name: the slot.
    pub(crate) name: String,
    /// The card.
    pub(crate) card: Box<dyn PciCard>,
}

impl CardOptions {
    /// The built-in card is meant.
    #[cfg(feature = "simulation")]
    pub(crate) fn is_built_in(&self) -> bool {
        self.card.as_deref() == Some(VIRTUAL)
    }

    /// Opens the card, loaded or not. The built-in one is new, and not loaded.
    pub(crate) fn open(&self, purpose: Use) -> Result<OpenCard, Failure> {
        #[cfg(feature = "simulation")]
        if self.is_built_in() {
            use model::robot::Robot;
            use testbench::virtual_card::VirtualCard;
            let card = VirtualCard::new(&Robot::racbot()).map_err(Failure::data)?.in_host_time();
            return Ok(OpenCard { name: VIRTUAL.to_owned(), card: Box::new(card) });
        }
        let slot = find(Path::new(SYSFS_DEVICES), self.card.as_deref()).map_err(Failure::data)?;
        let card = SysfsCard::open(&slot, purpose).map_err(Failure::data)?;
        Ok(OpenCard { name: slot.name, card: Box::new(card) })
    }
}
