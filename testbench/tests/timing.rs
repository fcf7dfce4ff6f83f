//! Timing as far as open tools can say: longest paths on the Spartan-II netlist, and place and route
//! of the same Verilog for two families of today.

use hdl::design::{COMMITTED_VERILOG, NAME};
use testbench::netlist::Netlist;
use testbench::place::Device;

#[test]
fn the_spartan_ii_netlist_has_short_paths() {
    let netlist = Netlist::of(COMMITTED_VERILOG, NAME).unwrap_or_else(|error| panic!("{error}"));
    let paths = netlist.paths();
    println!("most LUT levels:    {}", paths.by_levels);
    println!("most carry chains:  {}", paths.by_chains);
    for path in paths.per_register.iter().take(5) {
        println!("  {path}");
    }
    assert!(paths.by_levels.levels <= 8, "{}", paths.by_levels);
    assert!(paths.by_chains.chains <= 1, "{}", paths.by_chains);
    assert_eq!(paths.loops, 0);
    assert!(paths.per_register.len() > 300, "{} registers", paths.per_register.len());
}

fn reaches(device: Device, megahertz: f64) {
    // The core, whose bus is not tri-state: neither family has pins of the card's kind.
    let top = format!("{NAME}_core");
    let placed = device.place(COMMITTED_VERILOG, &top, megahertz as u32, None);
    let placed = placed.unwrap_or_else(|error| panic!("{error}"));
    let clock = |name: &str| *placed.megahertz.get(name).unwrap_or_else(|| panic!("no clock {name}: {placed:?}"));
    let used: Vec<_> = placed.cells.iter().filter(|(_, (used, _))| *used > 0).collect();
    println!("{device:?}: LCLK {:.1} MHz, crystal {:.1} MHz, {used:?}", clock("lclk"), clock("synclk"));
    assert!(clock("lclk") >= megahertz, "{device:?}: LCLK reaches {:.2} MHz of {megahertz}", clock("lclk"));
    assert!(clock("synclk") >= 50.0, "{device:?}: the crystal's clock reaches {:.2} MHz of 50", clock("synclk"));
}

#[test]
fn placed_on_ice40_it_reaches_40_megahertz() {
    reaches(Device::Ice40Hx8k, 40.0);
}

#[test]
fn placed_on_ecp5_it_reaches_60_megahertz() {
    reaches(Device::Ecp5U85, 60.0);
}
