//! A module compiled with Verilator.
//!
//! The module is wrapped so that its ports have plain names (`i0`, `o0`, `c0`), the wrapper becomes
//! C++, and the C++ a program that speaks the protocol of `harness.cpp`. The folder's name carries
//! a hash of everything that went in, so an unchanged design is not built again.

use super::folder;
use super::layout::{Clocks, Layout};
use super::ports::{Direction, Ports};
use super::{CosimError, Session};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

const HARNESS: &str = include_str!("harness.cpp");

/// `fast`: registers start at what their `initial` says, and an X never decides a branch; Icarus
/// is there for X. The warnings are silenced here because the lint gate judges them.
const VERILATOR: [&str; 17] = [
    "--cc",
    "--exe",
    "--build",
    "-j",
    "2",
    "-O3",
    "--x-assign",
    "fast",
    "--x-initial",
    "fast",
    "-Wno-fatal",
    "-Wno-WIDTH",
    "-Wno-DECLFILENAME",
    "-Wno-UNUSED",
    "--top-module",
    "cosim_harness",
    "--Mdir",
];

/// A module as a program.
#[derive(Clone, Debug)]
pub struct Verilated {
    name: String,
    program: PathBuf,
    layout: Layout,
}

impl Verilated {
    /// Compiles `top` of a Verilog text; `name` shows in messages and folder names.
    ///
    /// # Errors
    /// If Verilator or the compiler is missing or fails, or the build folder cannot be written.
    pub fn build(name: &str, verilog: &str, top: &str, ports: &Ports) -> Result<Self, CosimError> {
        let layout = Layout::of(ports);
        let wrapper = wrapper(top, ports);
        let header = header(&layout);
        let flags = VERILATOR.join(" ");
        let content = [verilog, &wrapper, &header, HARNESS, &flags];
        let folder = folder::cached(&plain(name), &content, |folder| {
            folder::write(&folder.join("design.v"), verilog)?;
            folder::write(&folder.join("wrapper.v"), &wrapper)?;
            folder::write(&folder.join("ports.h"), &header)?;
            folder::write(&folder.join("harness.cpp"), HARNESS)?;
            compile(folder, name)
        })?;
        let program = folder.join("obj").join("Vcosim_harness");
        Ok(Self { name: name.into(), program, layout })
    }

    /// The columns of stimulus and response.
    #[must_use]
    pub fn layout(&self) -> &Layout {
        &self.layout
    }

    /// Powers up a fresh copy.
    ///
    /// # Errors
    /// If the program does not start.
    pub fn start(&self) -> Result<Session, CosimError> {
        Session::start(&self.name, &self.program, self.layout.clone())
    }

    /// Runs a fresh copy over a stimulus: one row a step, one word for each input, all clocks
    /// rising on every step. Gives one row of outputs a step, read after the edge.
    ///
    /// # Errors
    /// If the stimulus does not divide into rows or the program ends early.
    pub fn run(&self, stimulus: &[u32]) -> Result<Vec<u32>, CosimError> {
        self.run_with(&Clocks::Together, stimulus)
    }

    /// As [`Self::run`], with the clocks as told.
    ///
    /// # Errors
    /// As [`Self::run`].
    pub fn run_with(&self, clocks: &Clocks, stimulus: &[u32]) -> Result<Vec<u32>, CosimError> {
        let mut session = self.start()?;
        session.set_clocks(clocks)?;
        session.run_batch(stimulus)
    }
}

fn compile(folder: &Path, name: &str) -> Result<(), CosimError> {
    let objects = folder.join("obj");
    std::fs::create_dir_all(&objects).map_err(CosimError::file("create", &objects))?;
    let library = library()?;
    for object in LIBRARY {
        let to = objects.join(object);
        std::fs::copy(library.join("obj").join(object), &to).map_err(CosimError::file("copy an object to", &to))?;
    }
    make(folder, name, &LIBRARY)
}

/// The objects of Verilator's own library, the same for every model: half of what a small one takes to compile.
const LIBRARY: [&str; 2] = ["verilated.o", "verilated_threads.o"];

/// A folder with [`LIBRARY`], compiled once for a version of Verilator: that of an empty model.
fn library() -> Result<PathBuf, CosimError> {
    let version = folder::must("verilator", &["--version"], Path::new("."), "its version")?;
    let content = [&*String::from_utf8_lossy(&version.stdout), &VERILATOR.join(" ")];
    folder::cached("verilator-library", &content, |folder| {
        folder::write(&folder.join("design.v"), "")?;
        folder::write(&folder.join("wrapper.v"), "module cosim_harness (input wire c0); endmodule\n")?;
        folder::write(&folder.join("harness.cpp"), "int main() { return 0; }\n")?;
        make(folder, "Verilator's library", &[])
    })
}

/// Compiles what is in `folder`, but for the objects that are `ready` there.
fn make(folder: &Path, name: &str, ready: &[&str]) -> Result<(), CosimError> {
    // The library part of Verilator runs once a process: not worth the compiler's time.
    let mut flags = "OPT_FAST=-O2 OPT_SLOW=-O0 OPT_GLOBAL=-O1".to_owned();
    flags.extend(ready.iter().map(|object| format!(" -o {object}")));
    let mut arguments = VERILATOR.to_vec();
    arguments.extend(["obj", "-MAKEFLAGS", &flags, "-CFLAGS", "-I..", "wrapper.v", "design.v", "harness.cpp"]);
    folder::must("verilator", &arguments, folder, name)?;
    Ok(())
}

/// A name that is safe in a path.
pub(crate) fn plain(name: &str) -> String {
    name.chars().map(|c| if c.is_ascii_alphanumeric() || c == '-' || c == '_' { c } else { '-' }).collect()
}

/// The Verilog around the module. Inside it, a tri-state port is a net with two drivers.
pub(crate) fn wrapper(top: &str, ports: &Ports) -> String {
    let (mut header, mut body, mut pins) = (Vec::new(), String::new(), Vec::new());
    let (mut inputs, mut outputs) = (0, 0);
    for port in &ports.list {
        let range = range(port.width);
        if let Some(n) = ports.clocks.iter().position(|c| *c == port.name) {
            header.push(format!("input wire c{n}"));
            pins.push(format!(".{}(c{n})", port.name));
            continue;
        }
        let net = match port.direction {
            Direction::In => format!("i{inputs}"),
            Direction::Out => format!("o{outputs}"),
            Direction::InOut => format!("z{inputs}"),
        };
        if port.direction != Direction::Out {
            header.push(format!("input wire {range}i{inputs}"));
        }
        if port.direction != Direction::In {
            header.push(format!("output wire {range}o{outputs}"));
        }
        if port.direction == Direction::InOut {
            header.push(format!("input wire i{}", inputs + 1));
            let (width, drive) = (port.width, inputs + 1);
            let _ = writeln!(body, "    wire {range}{net};");
            let _ = writeln!(body, "    assign {net} = i{drive} ? i{inputs} : {width}'bz;");
            let _ = writeln!(body, "    assign o{outputs} = {net};");
            inputs += 1;
        }
        inputs += u32::from(port.direction != Direction::Out);
        outputs += u32::from(port.direction != Direction::In);
        pins.push(format!(".{}({net})", port.name));
    }
    let separator = ",\n    ";
    let (header, pins) = (header.join(separator), pins.join(separator));
    format!("module cosim_harness (\n    {header}\n);\n{body}    {top} dut (\n    {pins});\nendmodule\n")
}

fn range(width: u32) -> String {
    if width == 1 { String::new() } else { format!("[{}:0] ", width - 1) }
}

/// The C++ that knows the ports.
fn header(layout: &Layout) -> String {
    let each = |n: usize, line: &dyn Fn(usize) -> String| (0..n).map(line).collect::<String>();
    let (inputs, outputs, clocks) = (layout.inputs.len(), layout.outputs.len(), layout.clocks.len());
    let masks = each(inputs, &|n| format!("{:#x}u, ", u32::MAX >> (32 - layout.inputs[n].width)));
    format!(
        "#include \"Vcosim_harness.h\"\n#include \"verilated.h\"\n#include <cstdint>\n\
         typedef Vcosim_harness Model;\n\
         static const uint32_t IN_COUNT = {inputs}, OUT_COUNT = {outputs}, ALL_CLOCKS = {all};\n\
         static const uint32_t MASK[] = {{{masks}0}};\n\
         static inline void apply(Model& m, const uint32_t* in) {{\n{apply}}}\n\
         static inline void sample(Model& m, uint32_t* out) {{\n{sample}}}\n\
         static inline void set_clocks(Model& m, uint32_t levels) {{\n{levels}}}\n",
        all = (1u32 << clocks) - 1,
        apply = each(inputs, &|n| format!("    m.i{n} = in[{n}] & MASK[{n}];\n")),
        sample = each(outputs, &|n| format!("    out[{n}] = m.o{n};\n")),
        levels = each(clocks, &|n| format!("    m.c{n} = levels >> {n} & 1;\n")),
    )
}
