//! Runs yosys: Verilog to a netlist of this family's cells.

use super::{FlowError, Progress, Stage};
use std::path::Path;
use std::process::{Command, Stdio};

/// What abc does with the logic between flip-flops. First it is rebuilt to be shallow (`if -g`), then mapped again and again,
/// which wins back the tables that this took: one round left 7 ends in 10 of those that were too slow, five half.
const MAPPING: &str = "+strash;&get,-n;&fraig,-x;&put;scorr;dc2;strash;if,-g,-K,6;\
    strash;dch,-f;if;mfs2;strash;dch,-f;if;mfs2;strash;dch,-f;if;mfs2;\
    strash;dch,-f;if;mfs2;strash;dch,-f;if;mfs2;lutpack,-S,1";

/// What yosys does between reading a design and writing its netlist. Cells are mapped with carry chains, block
/// memories, buffers of pads and of clocks; without multiplexers of tables, which take more tables here than
/// multiplexers made of tables do. The step `map_luts` is that of `synth_xilinx`, but for what abc is told.
#[must_use]
pub fn commands(top: &str) -> String {
    let synth = format!("synth_xilinx -family xcv -top {top} -flatten -nowidelut");
    format!(
        "{synth} -run begin:map_luts; opt_expr -mux_undef -noclkinv; abc -lut 4 -script {MAPPING}; clean; \
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
    std::fs::write(file("design.v"), verilog)
        .map_err(|error| failed(format!("{}: {error}", file("design.v").display())))?;
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
