//! Which cards there are, and which one is meant.

use std::fmt;
use std::fs;
use std::path::{Path, PathBuf};

/// Where Linux shows its PCI devices.
pub const SYSFS_DEVICES: &str = "/sys/bus/pci/devices";

/// The four numbers by which a PCI card is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ids {
    /// Who made the bridge: 10b5 for PLX.
    pub vendor: u16,
    /// Which bridge: 9030.
    pub device: u16,
    /// Vendor of the card.
    pub subsystem_vendor: u16,
    /// Which board of that vendor.
    pub subsystem_device: u16,
}

impl Ids {
    /// Mesa 4I65: a PLX PCI9030 with Mesa's number for the card (LinuxCNC, `hm2_pci.h`).
    pub const MESA_4I65: Self =
        Self { vendor: 0x10B5, device: 0x9030, subsystem_vendor: 0x10B5, subsystem_device: 0x3132 };
    /// Mesa 5I20: the same bridge and FPGA on other pins.
    pub const MESA_5I20: Self = Self { subsystem_device: 0x3131, ..Self::MESA_4I65 };

    fn same_bridge(self) -> bool {
        (self.vendor, self.device) == (Self::MESA_4I65.vendor, Self::MESA_4I65.device)
    }
}

impl fmt::Display for Ids {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:04x}:{:04x}, card ", self.vendor, self.device)?;
        write!(f, "{:04x}:{:04x}", self.subsystem_vendor, self.subsystem_device)
    }
}

/// A device that sysfs shows.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Slot {
    /// Its name there: `domain:bus:device.function`.
    pub name: String,
    /// In sysfs, below /sys/bus/pci/devices.
    pub folder: PathBuf,
    /// Its numbers.
    pub ids: Ids,
}

/// No card, or not the one that was meant.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum FindError {
    /// sysfs cannot be read.
    #[error("{}: {cause}; is sysfs mounted?", .path.display())]
    Sysfs {
        /// What was read.
        path: PathBuf,
        /// Why it failed.
        cause: String,
    },
    /// No 4I65.
    #[error("no Mesa 4I65 ({}) among {devices} PCI devices{near}", Ids::MESA_4I65)]
    None {
        /// Devices seen.
        devices: usize,
        /// What looks like one and is none.
        near: String,
    },
    /// Several, and none was named.
    #[error("{} Mesa 4I65: {}; name one with --card SLOT", .slots.len(), .slots.join(", "))]
    Several {
        /// Their names.
        slots: Vec<String>,
    },
    /// Nothing in the named slot.
    #[error("no PCI device in slot {slot}; Mesa 4I65 are in: {}", if .slots.is_empty() { "none".to_owned() } else { .slots.join(", ") })]
    NoSuchSlot {
        /// The slot asked for.
        slot: String,
        /// Where cards are.
        slots: Vec<String>,
    },
    /// Another device in the named slot.
    #[error("{slot} is {found}, not a Mesa 4I65 ({}){hint}", Ids::MESA_4I65)]
    OtherDevice {
        /// The slot asked for.
        slot: String,
        /// Identification numbers that are read there.
        found: Ids,
        /// What that may be.
        hint: &'static str,
    },
}

/// Every PCI device below a folder, by name.
///
/// # Errors
/// [`FindError::Sysfs`] where the folder cannot be read. A device that vanishes meanwhile is left out.
pub fn devices(folder: &Path) -> Result<Vec<Slot>, FindError> {
    let failed = |cause: std::io::Error| FindError::Sysfs { path: folder.to_owned(), cause: cause.to_string() };
    let mut slots = Vec::new();
    for entry in fs::read_dir(folder).map_err(failed)? {
        let entry = entry.map_err(failed)?;
        let number = |file: &str| {
            let text = fs::read_to_string(entry.path().join(file)).ok()?;
            u16::from_str_radix(text.trim().trim_start_matches("0x"), 16).ok()
        };
        let (Some(vendor), Some(device), Some(subsystem_vendor), Some(subsystem_device)) =
            (number("vendor"), number("device"), number("subsystem_vendor"), number("subsystem_device"))
        else {
            continue;
        };
        let ids = Ids { vendor, device, subsystem_vendor, subsystem_device };
        slots.push(Slot { name: entry.file_name().to_string_lossy().into_owned(), folder: entry.path(), ids });
    }
    slots.sort_by(|a, b| a.name.cmp(&b.name));
    Ok(slots)
}

/// The card in the named slot, or the only one. `slot` may leave out the domain, as `lspci` does.
///
/// # Errors
/// [`FindError`] where there is none, or more than one and no name.
pub fn find(folder: &Path, slot: Option<&str>) -> Result<Slot, FindError> {
    let devices = devices(folder)?;
    let cards: Vec<&Slot> = devices.iter().filter(|slot| slot.ids == Ids::MESA_4I65).collect();
    let names = || cards.iter().map(|card| card.name.clone()).collect::<Vec<_>>();
    if let Some(wanted) = slot {
        let full = if wanted.matches(':').count() == 1 { format!("0000:{wanted}") } else { wanted.to_owned() };
        let found = devices.iter().find(|slot| slot.name.eq_ignore_ascii_case(&full));
        return match found {
            None => Err(FindError::NoSuchSlot { slot: wanted.to_owned(), slots: names() }),
            Some(slot) if slot.ids == Ids::MESA_4I65 => Ok(slot.clone()),
            Some(slot) => {
                Err(FindError::OtherDevice { slot: slot.name.clone(), found: slot.ids, hint: hint(slot.ids) })
            }
        };
    }
    match cards[..] {
        [card] => Ok(card.clone()),
        [] => {
            let near = devices.iter().find(|slot| slot.ids.same_bridge()).map_or(String::new(), |slot| {
                format!("; {} has the same bridge but is {}{}", slot.name, slot.ids, hint(slot.ids))
            });
            Err(FindError::None { devices: devices.len(), near })
        }
        _ => Err(FindError::Several { slots: names() }),
    }
}

fn hint(ids: Ids) -> &'static str {
    if ids == Ids::MESA_5I20 {
        ": a Mesa 5I20, which has the same FPGA on other pins"
    } else if ids.same_bridge() {
        ": its EEPROM may be empty or another card's"
    } else {
        ""
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tree(cards: &[(&str, Ids)]) -> tempfile::TempDir {
        let folder = tempfile::tempdir().unwrap();
        for (name, ids) in cards {
            let device = folder.path().join(name);
            fs::create_dir(&device).unwrap();
            for (file, number) in [
                ("vendor", ids.vendor),
                ("device", ids.device),
                ("subsystem_vendor", ids.subsystem_vendor),
                ("subsystem_device", ids.subsystem_device),
            ] {
                fs::write(device.join(file), format!("{number:#06x}\n")).unwrap();
            }
        }
        folder
    }

    const BRIDGE: Ids = Ids { vendor: 0x8086, device: 0x1237, subsystem_vendor: 0x1af4, subsystem_device: 0x1100 };
    const BLANK: Ids = Ids { subsystem_vendor: 0, subsystem_device: 0, ..Ids::MESA_4I65 };

    #[test]
    fn the_only_card_is_found_and_a_slot_may_be_short() {
        let tree = tree(&[("0000:00:00.0", BRIDGE), ("0000:00:05.0", Ids::MESA_4I65), ("0000:00:06.0", BLANK)]);
        for slot in [None, Some("0000:00:05.0"), Some("00:05.0")] {
            assert_eq!(find(tree.path(), slot).unwrap().name, "0000:00:05.0");
        }
    }

    #[test]
    fn what_is_not_the_card_is_named() {
        let cards = [("0000:00:00.0", BRIDGE), ("0000:02:01.0", Ids::MESA_5I20), ("0000:02:02.0", BLANK)];
        let tree = tree(&cards);
        let says = |slot: Option<&str>| find(tree.path(), slot).unwrap_err().to_string();
        assert!(says(None).contains("among 3 PCI devices; 0000:02:01.0 has the same bridge"), "{}", says(None));
        assert!(says(Some("02:01.0")).contains("5I20"));
        assert!(says(Some("02:02.0")).contains("10b5:9030, card 0000:0000"));
        assert!(says(Some("02:03.0")).contains("no PCI device in slot 02:03.0"));
        assert!(find(Path::new("/no/such"), None).unwrap_err().to_string().contains("/no/such"));
    }

    #[test]
    fn several_cards_want_a_name() {
        let tree = tree(&[("0000:02:01.0", Ids::MESA_4I65), ("0000:02:02.0", Ids::MESA_4I65)]);
        let message = find(tree.path(), None).unwrap_err().to_string();
        assert_eq!(message, "2 Mesa 4I65: 0000:02:01.0, 0000:02:02.0; name one with --card SLOT");
        assert_eq!(find(tree.path(), Some("0000:02:02.0")).unwrap().name, "0000:02:02.0");
    }
}
