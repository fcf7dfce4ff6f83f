//! A project for Xilinx ISE 10.1, the last tool chain for the Spartan-II: one command to a bitstream.
//!
//! ```text
//! .v .prj .xst ─► xst ─► .ngc ─┐
//!                         .ucf ─┴► ngdbuild ─► map ─► par ─► trce (timing report)
//!                                                        └─► bitgen .ut ─► .bit
//! ```
//!
//! It was written after the tools' manuals and **has not been run**: ISE is not among what this repository may
//! install. The committed bitstream is made without it, by the crate `bitstream`.

use std::fmt::Write as _;

/// The device of the 4I65 in the slowest speed grade, so that the timing holds for every card.
pub const PART: &str = "xc2s200-5-pq208";

/// Options of synthesis, each with its reason.
const SYNTHESIS: [(&str, &str, &str); 15] = [
    ("ifmt", "Verilog", ""),
    ("ofmt", "NGC", ""),
    ("p", PART, ""),
    ("opt_mode", "Speed", "33 MHz with room"),
    ("opt_level", "2", ""),
    ("iobuf", "YES", "pads for every port of the top"),
    ("keep_hierarchy", "NO", "constants cross block borders"),
    ("fsm_extract", "NO", "states are what fixed-kin says they are"),
    ("shreg_extract", "NO", "synchronisers must be flip-flops, not shift registers in a LUT"),
    ("equivalent_register_removal", "NO", "as above"),
    ("register_balancing", "NO", "as above"),
    ("ram_extract", "YES", ""),
    ("ram_style", "Block", "the sequencer's memories and program"),
    ("async_to_sync", "NO", ""),
    ("slice_utilization_ratio", "100", ""),
];

/// Options of the bitstream, each with its reason.
const BITSTREAM: [(&str, &str, &str); 13] = [
    ("CRC", "Enable", "the device refuses a damaged stream"),
    ("StartUpClk", "CCLK", "the card clocks configuration with LCLK"),
    ("Persist", "No", "configuration pins become bus pins"),
    ("UnusedPin", "PullDown", "as in the files of the card's maker; charger and trigger are used pins"),
    ("ProgPin", "PullUp", ""),
    ("DonePin", "PullUp", ""),
    ("DonePipe", "No", ""),
    ("DriveDone", "No", ""),
    ("GTS_cycle", "6", "outputs go live last"),
    ("GWE_cycle", "5", "flip-flops may run before"),
    ("DONE_cycle", "4", ""),
    ("LCK_cycle", "NoWait", "no DLL is used"),
    ("Security", "None", ""),
];

/// `name.prj`: the list of sources.
#[must_use]
pub fn project(name: &str) -> String {
    format!("verilog work \"{name}.v\"\n")
}

/// `name.xst`: the script of synthesis. XST scripts know no comments, so the reasons stand in the
/// Makefile's head.
#[must_use]
pub fn synthesis(name: &str) -> String {
    let mut text = format!("run\n-ifn {name}.prj\n-ofn build/{name}.ngc\n-top {name}\n");
    for (option, value, _) in SYNTHESIS {
        let _ = writeln!(text, "-{option} {value}");
    }
    text
}

/// `name.ut`: the options of the bitstream; its user code is the content hash of the Verilog.
#[must_use]
pub fn bitstream(content_hash: u32) -> String {
    let mut text = String::from("-w\n");
    for (option, value, _) in BITSTREAM {
        let _ = writeln!(text, "-g {option}:{value}");
    }
    let _ = writeln!(text, "-g UserID:0x{content_hash:08X}");
    text
}

/// `Makefile`: `make` in `generated/` makes `build/name.bit`.
#[must_use]
pub fn makefile(name: &str) -> String {
    let mut reasons = String::new();
    for (option, value, reason) in SYNTHESIS.iter().chain(&BITSTREAM).filter(|(_, _, reason)| !reason.is_empty()) {
        let _ = writeln!(reasons, "#   {option} {value}: {reason}");
    }
    format!(
        "# {name}.bit for the Mesa 4I65 with Xilinx ISE 10.1 or older: source its settings32.sh, then `make`.\n\
         # NOT RUN where this file was made; `racbot bitstream build` needs none of it. Look at these first:\n\
         # warnings of xst about ignored `initial` values (registers must start as the Verilog says), and\n\
         # build/{name}.twr (all constraints met).\n\
         #\n\
         # Why the options are what they are:\n{reasons}\n\
         PART := {PART}\n\
         DESIGN := {name}\n\
         \n\
         all: build/$(DESIGN).bit build/$(DESIGN).twr\n\
         \n\
         build/$(DESIGN).ngc: $(DESIGN).v $(DESIGN).prj $(DESIGN).xst\n\
         \t@command -v xst >/dev/null || {{ echo 'xst not found: source settings32.sh of Xilinx ISE 10.1' >&2; exit 1; }}\n\
         \tmkdir -p build\n\
         \txst -ifn $(DESIGN).xst -ofn build/$(DESIGN).srp\n\
         \n\
         build/$(DESIGN).ngd: build/$(DESIGN).ngc $(DESIGN).ucf\n\
         \tngdbuild -dd build -p $(PART) -uc $(DESIGN).ucf build/$(DESIGN).ngc $@\n\
         \n\
         build/$(DESIGN)_map.ncd: build/$(DESIGN).ngd\n\
         \tmap -w -p $(PART) -pr b -o $@ $< build/$(DESIGN).pcf\n\
         \n\
         build/$(DESIGN).ncd: build/$(DESIGN)_map.ncd\n\
         \tpar -w -ol high $< $@ build/$(DESIGN).pcf\n\
         \n\
         build/$(DESIGN).twr: build/$(DESIGN).ncd\n\
         \ttrce -v 10 -o $@ $< build/$(DESIGN).pcf\n\
         \n\
         build/$(DESIGN).bit: build/$(DESIGN).ncd $(DESIGN).ut\n\
         \tbitgen -f $(DESIGN).ut $< $@ build/$(DESIGN).pcf\n\
         \n\
         clean:\n\
         \trm -rf build\n\
         \n\
         .PHONY: all clean\n"
    )
}
