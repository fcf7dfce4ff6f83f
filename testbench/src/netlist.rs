//! The netlist of the real family: what yosys makes of a design for the Spartan-II, as a design again.
//!
//! ```text
//! Verilog ──► yosys by the flow's script ────► cells (LUT4, MUXCY, FDRE, RAMB4…) ──┬─► simulation
//!                       models: yosys' own cells_sim.v, and cells/ramb4.v of ours ───┘
//!                                                                                  └─► longest paths
//! ```
//!
//! Yosys has no model of the block memory; `cells/ramb4.v` is ours and has a test. A read that
//! meets a write of the other port gives garbage there, because the device promises nothing.

mod paths;

pub use paths::{Path, Paths};

use bitstream::flow::synthesis;
use simulator::cosim::{CosimError, folder};
use std::collections::BTreeMap;
use std::path::PathBuf;

/// The model of the block memories.
pub const BLOCK_MEMORY: &str = include_str!("../cells/ramb4.v");

/// A synthesised design.
#[derive(Clone, Debug)]
pub struct Netlist {
    /// The netlist with the models of all its cells: a design of the same ports.
    pub verilog: String,
    /// How often every cell occurs.
    pub cells: BTreeMap<String, usize>,
    /// The graph for [`Paths`].
    graph: serde_json::Value,
    top: String,
}

impl Netlist {
    /// Synthesises `top` as the flow does, once per content.
    ///
    /// # Errors
    /// A missing yosys, or a design that it does not take.
    pub fn of(verilog: &str, top: &str) -> Result<Self, CosimError> {
        let script = format!(
            "read_verilog design.v; {}; write_verilog -noattr netlist.v; write_json netlist.json",
            synthesis::commands(top)
        );
        let maps = synthesis::maps();
        let inputs: Vec<&str> =
            [verilog, &script].into_iter().chain(maps.iter().map(|(_, text)| text.as_str())).collect();
        let folder = folder::cached(&format!("netlist-{top}"), &inputs, |folder| {
            folder::write(&folder.join("design.v"), verilog)?;
            maps.iter().try_for_each(|(name, text)| folder::write(&folder.join(name), text))?;
            folder::must("yosys", &["-q", "-p", &script], folder, top).map(|_| ())
        })?;
        let read = |name: &str| {
            let path = folder.join(name);
            std::fs::read_to_string(&path).map_err(CosimError::file("read", &path))
        };
        let graph: serde_json::Value = serde_json::from_str(&read("netlist.json")?)
            .map_err(|error| CosimError::file("understand", &folder.join("netlist.json"))(error.into()))?;
        let mut cells = BTreeMap::new();
        for cell in graph["modules"][top]["cells"].as_object().into_iter().flatten() {
            *cells.entry(cell.1["type"].as_str().unwrap_or("").to_owned()).or_default() += 1;
        }
        let mut verilog = [&read("netlist.v")?, &models(cells.keys())?, BLOCK_MEMORY].join("\n");
        verilog.extend(cells.keys().filter_map(|cell| block_memory(cell)));
        Ok(Self { verilog, cells, graph, top: top.into() })
    }

    /// The netlist as yosys has it, JSON.
    #[must_use]
    pub fn json(&self) -> String {
        self.graph.to_string()
    }

    /// The longest paths between flip-flops, memories and pins.
    #[must_use]
    pub fn paths(&self) -> Paths {
        Paths::of(&self.graph["modules"][&self.top])
    }
}

/// The block memory of this name, `RAMB4_Sn` or `RAMB4_Sn_Sm`, around [`BLOCK_MEMORY`].
#[must_use]
pub fn block_memory(cell: &str) -> Option<String> {
    let widths = cell.strip_prefix("RAMB4_S")?.split("_S").map(str::parse).collect::<Result<Vec<u32>, _>>().ok()?;
    let both: &[(&str, u32)] = match widths[..] {
        [width] => &[("", width)],
        [a, b] => &[("A", a), ("B", b)],
        _ => return None,
    };
    let address = |width: u32| 12 - width.ilog2();
    let (mut header, mut pins, mut sizes) = (Vec::new(), Vec::new(), String::new());
    for (port, inner) in ["a", "b"].into_iter().enumerate() {
        let Some((name, width)) = both.get(port) else {
            pins.push(format!(
                ".do{inner}(), .addr{inner}({0}'d0), .di{inner}({1}'d0), .en{inner}(1'b0), .clk{inner}(1'b0), \
                 .rst{inner}(1'b0), .we{inner}(1'b0)",
                address(widths[0]),
                widths[0]
            ));
            sizes += &format!(", .WB({}), .AB({})", widths[0], address(widths[0]));
            continue;
        };
        let (word, line) = (width - 1, address(*width) - 1);
        header.push(format!(
            "output wire [{word}:0] DO{name}, input wire [{line}:0] ADDR{name}, input wire [{word}:0] DI{name}, \
             input wire EN{name}, input wire CLK{name}, input wire RST{name}, input wire WE{name}"
        ));
        pins.push(
            ["do", "addr", "di", "en", "clk", "rst", "we"]
                .map(|pin| format!(".{pin}{inner}({}{name})", pin.to_uppercase()))
                .join(", "),
        );
        sizes += &format!(", .W{0}({width}), .A{0}({1})", inner.to_uppercase(), address(*width));
    }
    let rows: Vec<_> = (0..16).map(|row| format!("INIT_0{row:X}")).collect();
    let initial = rows.iter().map(|row| format!("{row} = 256'd0")).collect::<Vec<_>>().join(", ");
    let joined = rows.into_iter().rev().collect::<Vec<_>>().join(", ");
    Some(format!(
        "\nmodule {cell} #(\n    parameter [255:0] {initial}\n) (\n    {}\n);\n    ramb4 #(.INIT({{{joined}}}){sizes}) memory (\n        {}\n    );\nendmodule\n",
        header.join(",\n    "),
        pins.join(",\n        ")
    ))
}

/// Where yosys keeps its models: beside itself.
fn models_file() -> PathBuf {
    let folders = std::env::var_os("PATH").unwrap_or_default();
    let beside = |folder: PathBuf| folder.join("../share/yosys/xilinx/cells_sim.v");
    let all: Vec<_> = std::env::split_paths(&folders).map(beside).collect();
    all.iter().find(|path| path.is_file()).cloned().unwrap_or_else(|| "/usr/share/yosys/xilinx/cells_sim.v".into())
}

/// Yosys' own simulation models of these cells, without their timing of another family.
fn models<'a>(cells: impl Iterator<Item = &'a String>) -> Result<String, CosimError> {
    let path = models_file();
    let all = std::fs::read_to_string(&path).map_err(CosimError::file("read", &path))?;
    let mut text = String::new();
    for cell in cells.filter(|cell| !cell.starts_with("RAMB4")) {
        let begin = [" ", "("].iter().find_map(|next| all.find(&format!("\nmodule {cell}{next}")));
        let model = begin.and_then(|begin| Some(&all[begin..begin + all[begin..].find("\nendmodule")?]));
        let Some(model) = model else {
            let (tool, what) = ("yosys".to_owned(), format!("no simulation model of the cell {cell}"));
            return Err(CosimError::Tool { tool, what, folder: path, output: String::new() });
        };
        match (model.find("specify"), model.rfind("endspecify")) {
            (Some(from), Some(to)) => text.extend([&model[..from], &model[to + "endspecify".len()..]]),
            _ => text.push_str(model),
        }
        text.push_str("\nendmodule\n");
    }
    Ok(text)
}
