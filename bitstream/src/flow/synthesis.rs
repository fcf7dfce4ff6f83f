//! Runs yosys: Verilog to a netlist of this family's cells.

mod counters;
mod turned;

use super::{FlowError, Progress, Stage};
use std::path::Path;
use std::process::{Command, Stdio};

/// What abc does with the logic between flip-flops, once, again and again, and at the end. `if` maps for the fewest levels, then
/// for area; `mfs2` wins back tables and their inputs. Rebuilding for depth before (`if -g`) left some fifty tables more, and the
/// logic behind the longest comparisons no shallower.
const BEFORE: &str = "+strash;&get,-n;&fraig,-x;&put;scorr;dc2;strash;";
const ROUND: &str = "strash;dch,-f;if;mfs2;";
const ROUNDS: usize = 6;
const AFTER: &str = "lutpack,-S,1;lutpack,-S,3,-z;mfs2,-a,-e;lutpack";

/// Most bits of a comparison and of a sum that are left to tables. A comparison in tables takes a table a bit less one, but runs
/// through all of them.
const COMPARED_IN_TABLES: u32 = 5;
const ADDED_IN_TABLES: u32 = 3;
/// The answer of a comparison of more bits than [`SOON`] comes so many tables late. Before it is placed, 20 bits and the table before
/// them take 3.5 times what a table and its wire take. Told of 3, abc leaves four tables behind the kicker's longest comparison
/// and none of the paths between registers above 17.2 ns; told of nothing or of 2, five and 20.3 ns. Told of 4, it let others take 19.0 ns.
const SOON: u32 = 13;
const LATE: u32 = 3;

/// What [`commands`] reads beside the design: names and texts of files in the folder where yosys runs.
#[must_use]
pub fn maps() -> [(&'static str, String); 8] {
    [
        ("compare.v", include_str!("synthesis/compare.v").to_owned()),
        ("constants.v", include_str!("synthesis/constants.v").to_owned()),
        ("operands.v", include_str!("synthesis/operands.v").to_owned()),
        ("sums.v", include_str!("synthesis/sums.v").to_owned()),
        ("counters.il", counters::shapes()),
        ("counters.v", counters::map()),
        ("turned.il", turned::shapes()),
        ("turned.v", turned::map()),
    ]
}

/// What yosys does between reading a design and writing its netlist. Cells are mapped with carry chains, block
/// memories, buffers of pads and of clocks; without multiplexers of tables, which take more tables here than
/// multiplexers made of tables do. The steps `coarse` and `map_luts` are those of `synth_xilinx`, but for comparisons, loaded
/// counters and short sums in the first, and for what abc is told in the second. Where a multiplexer has nothing on one side
/// (`-mux_undef`), it goes before counters are looked for, which stand behind it.
#[must_use]
pub fn commands(top: &str) -> String {
    let synth = format!("synth_xilinx -family xcv -top {top} -flatten -nowidelut");
    let compared = format!("techmap -map compare.v -D TABLES={COMPARED_IN_TABLES} -D SOON={SOON} -D LEVELS={LATE}");
    let settled = "techmap -map constants.v t:VCC t:GND; opt_expr; opt_lut";
    let counted = format!("opt -mux_undef; extract -map counters.il {top}; techmap -map counters.v {top}");
    let turned = format!("extract -map turned.il {top}; techmap -map turned.v {top}");
    // Sums whose second operand comes from a register or a memory, and the first does not.
    let read = |operand: char| format!("@stored %co1:+[{operand}] */t:$add %i");
    let ordered = format!(
        "select -set stored */t:*dff* */t:$mem* %u %co1:+[Q,RD_DATA,DATA] */w:* %i; select -set first {}; select -set second {}; \
         techmap -map operands.v @second @first %d",
        read('A'),
        read('B')
    );
    // Written and read again, cells come to abc in another order: in the one case compared that left 20 tables fewer.
    let again = "write_rtlil cells.il; design -reset; read_rtlil cells.il";
    let mapping = [BEFORE, &ROUND.repeat(ROUNDS), AFTER].concat();
    let added = format!("techmap -map sums.v -D TABLES={ADDED_IN_TABLES}");
    format!(
        "{synth} -run begin:coarse; {compared}; {counted}; {turned}; {ordered}; alumacc; share; opt; memory -nomap; opt_clean; {added}; \
         {synth} -run map_memory:map_luts; opt_expr -mux_undef -noclkinv; {again}; abc -lut 4 -script {mapping}; {settled}; clean; \
         techmap -map +/xilinx/ff_map.v; techmap -map +/xilinx/lut_map.v -map +/xilinx/cells_map.v -D LUT_WIDTH=4; \
         xilinx_dffopt -lut4; opt_lut_ins -tech xilinx; {synth} -run finalize:check"
    )
}

/// The whole script, from `design.v` to `netlist.json`.
#[must_use]
pub fn script(top: &str) -> String {
    format!("read_verilog design.v; {}; write_json netlist.json", commands(top))
}

/// Synthesises a design in a folder of its own; the netlist as JSON.
///
/// # Errors
/// A missing yosys, or a design that it does not take, with its last words.
pub fn synthesise(verilog: &str, top: &str, folder: &Path, progress: &mut Progress<'_>) -> Result<String, FlowError> {
    progress.tell(Stage::Synthesis, 0, || format!("yosys, {} lines of Verilog", verilog.lines().count()));
    let file = |name: &str| folder.join(name);
    let failed = |what: String| FlowError::Synthesis { what };
    std::fs::create_dir_all(folder).map_err(|error| failed(format!("{}: {error}", folder.display())))?;
    for (name, text) in maps().iter().map(|(name, text)| (*name, text.as_str())).chain([("design.v", verilog)]) {
        std::fs::write(file(name), text).map_err(|error| failed(format!("{}: {error}", file(name).display())))?;
    }
    let run = Command::new("yosys")
        .args(["-q", "-p", &script(top)])
        .current_dir(folder)
        .stdin(Stdio::null())
        .output()
        .map_err(|error| match error.kind() {
            std::io::ErrorKind::NotFound => {
                failed("there is no yosys on this machine; install it (Debian: apt install yosys)".into())
            }
            _ => failed(format!("yosys: {error}")),
        })?;
    if !run.status.success() {
        let said = String::from_utf8_lossy(&run.stderr);
        let last: Vec<&str> = said.lines().rev().take(5).collect();
        return Err(failed(format!("yosys: {}", last.into_iter().rev().collect::<Vec<_>>().join("; "))));
    }
    std::fs::read_to_string(file("netlist.json"))
        .map_err(|error| failed(format!("{}: {error}", file("netlist.json").display())))
}

/// The version of yosys, as it says; other versions may make another netlist of the same source.
#[must_use]
pub fn version() -> Option<String> {
    let run = Command::new("yosys").arg("-V").output().ok()?;
    Some(String::from_utf8_lossy(&run.stdout).trim().to_owned())
}
