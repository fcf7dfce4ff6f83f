//! A folder of plain files answers as sysfs does, as far as a card at rest goes.

use super::*;
use crate::pci::slot::Ids;
use std::os::unix::fs::symlink;

/// BAR 0 lies 0x80 into its page, as a BIOS may put it.
const TABLE: &str = "0x00000000febf0080 0x00000000febf00ff 0x0000000000040200\n\
    0x000000000000c100 0x000000000000c17f 0x0000000000040101\n\
    0x000000000000c000 0x000000000000c0ff 0x0000000000040101\n\
    0x000000000000c200 0x000000000000c2ff 0x0000000000040101\n\
    0x00000000febe0000 0x00000000febeffff 0x0000000000040200\n\
    0x00000000febd0000 0x00000000febdffff 0x0000000000040200\n";

fn card(enabled: &str) -> (tempfile::TempDir, Slot) {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    fs::write(at("enable"), enabled).unwrap();
    fs::write(at("resource"), TABLE).unwrap();
    for bar in Bar::ALL {
        let bytes = if bar.is_memory() { bar.size().max(4096) } else { bar.size() };
        fs::write(at(&format!("resource{}", bar.index())), vec![0; bytes as usize]).unwrap();
    }
    let slot = Slot { name: "0000:00:05.0".to_owned(), folder: folder.path().to_owned(), ids: Ids::MESA_4I65 };
    (folder, slot)
}

#[test]
fn windows_are_mapped_at_the_right_place_and_checked() {
    let (folder, slot) = card("0\n");
    let mut card = SysfsCard::open(&slot, Use::Drive).unwrap();
    assert_eq!(fs::read_to_string(folder.path().join("enable")).unwrap(), "1");
    card.write32(Bar::Bridge, 0x54, 0x1234_5678).unwrap();
    card.write8(Bar::Memory32, 8, 0xA5).unwrap();
    assert_eq!(card.read32(Bar::Bridge, 0x54).unwrap(), 0x1234_5678);
    assert_eq!(card.read32(Bar::Memory32, 8).unwrap(), 0xA5);
    let bridge = fs::read(folder.path().join("resource0")).unwrap();
    assert_eq!(bridge[0xD4..0xD8], [0x78, 0x56, 0x34, 0x12]);
    for (offset, says) in [(0x80, "beyond the window"), (0x52, "not aligned"), (u32::MAX - 3, "beyond the window")] {
        assert!(card.read32(Bar::Bridge, offset).unwrap_err().to_string().contains(says));
        assert!(card.write32(Bar::Bridge, offset, 0).unwrap_err().to_string().contains(says));
    }
    assert!(card.read32(Bar::Ports16, 0).unwrap_err().to_string().contains("BAR 2 is not open"));
}

#[test]
fn ports_stand_in_for_memory_that_cannot_be_mapped() {
    let (folder, slot) = card("1\n");
    let unmapped = TABLE.lines().enumerate().map(|(bar, line)| if bar == 0 || bar == 5 { "0x0 0x0 0x0" } else { line });
    fs::write(folder.path().join("resource"), unmapped.collect::<Vec<_>>().join("\n")).unwrap();
    let mut card = SysfsCard::open(&slot, Use::Drive).unwrap();
    assert!(!card.has(Bar::Bridge) && card.has(Bar::BridgePorts) && card.has(Bar::Ports16));
    card.write32(Bar::BridgePorts, 0x54, 7).unwrap();
    card.write8(Bar::Ports16, 0, 9).unwrap();
    assert_eq!(card.read32(Bar::BridgePorts, 0x54).unwrap(), 7);
    assert_eq!(fs::read(folder.path().join("resource2")).unwrap()[0], 9);
    assert!(card.read32(Bar::BridgePorts, 0x29).unwrap_err().to_string().contains("not aligned"));
    assert!(card.read32(Bar::Ports32, 0x800).unwrap_err().to_string().contains("beyond the window"));
}

#[test]
fn one_program_drives_and_others_may_look() {
    let (_folder, slot) = card("1\n");
    let driving = SysfsCard::open(&slot, Use::Drive).unwrap();
    assert!(SysfsCard::open(&slot, Use::Drive).unwrap_err().to_string().contains("in use by another program"));
    SysfsCard::open(&slot, Use::Look).unwrap();
    drop(driving);
    SysfsCard::open(&slot, Use::Drive).unwrap();
}

#[test]
fn what_stands_in_the_way_is_named() {
    let (folder, slot) = card("1\n");
    symlink("../../../bus/pci/drivers/plx_pci", folder.path().join("driver")).unwrap();
    let message = SysfsCard::open(&slot, Use::Drive).unwrap_err().to_string();
    assert!(message.contains("held by the kernel driver plx_pci") && message.contains("unbind"), "{message}");
    fs::remove_file(folder.path().join("driver")).unwrap();

    fs::remove_file(folder.path().join("resource1")).unwrap();
    let short = TABLE.replacen("febf00ff", "febf008f", 1);
    fs::write(folder.path().join("resource"), short).unwrap();
    let message = SysfsCard::open(&slot, Use::Drive).unwrap_err().to_string();
    assert!(message.contains("16 bytes instead of 128") && message.contains("ports"), "{message}");

    fs::remove_file(folder.path().join("enable")).unwrap();
    let message = SysfsCard::open(&slot, Use::Drive).unwrap_err().to_string();
    assert!(message.contains("enable") && message.contains("the card is gone"), "{message}");

    let denied = OpenError::File { path: "x".into(), cause: io::ErrorKind::PermissionDenied.into() };
    assert!(denied.to_string().contains("udev rule"));
}
