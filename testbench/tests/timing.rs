//! Timing as far as open tools can say: longest paths on the Spartan-II netlist, and place and route
//! of the same Verilog for two families of today.

use hdl::design::{COMMITTED_VERILOG, NAME};
use measured::Table;
use testbench::netlist::Netlist;
use testbench::place::Device;

#[test]
fn the_spartan_ii_netlist_has_short_paths() {
    let netlist = Netlist::of(COMMITTED_VERILOG, NAME).unwrap_or_else(|error| panic!("{error}"));
    let paths = netlist.paths();
    let table = Table {
        name: "paths",
        title: "Longest paths of the Spartan-II netlist",
        command: "cargo test --release -p testbench --test timing",
        columns: &["longest by", "LUT levels", "carry chains"],
    };
    for (by, path) in [("LUT levels", &paths.by_levels), ("carry chains", &paths.by_chains)] {
        println!("{path}");
        table.check_row_within(&[by.to_owned(), path.levels.to_string(), path.chains.to_string()], 0.2);
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
    let table = Table {
        name: "placed",
        title: "The core placed and routed by nextpnr for two families of today",
        command: "cargo test --release -p testbench --test timing",
        columns: &["device", "LCLK, MHz", "crystal, MHz", "logic cells used", "of"],
    };
    let (_, (cells, of)) = used.iter().max_by_key(|(_, (used, _))| *used).expect("cells");
    let megahertz_of = |name| format!("{:.1}", clock(name));
    table.check_row_within(
        &[format!("{device:?}"), megahertz_of("lclk"), megahertz_of("synclk"), cells.to_string(), of.to_string()],
        0.15, // versions of nextpnr
    );
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
