//! The same batch under Icarus Verilog: slow, but an independent reading of the language, and
//! four-valued: a signal that nobody ever drives shows.

use super::CosimError;
use super::folder;
use super::layout::{Clocks, Layout};
use super::ports::Ports;
use super::verilated::{plain, wrapper};
use std::fmt::Write as _;

/// Runs `top` of a Verilog text from power-up over a stimulus, rows as in
/// [`Verilated::run`](super::Verilated::run).
///
/// # Errors
/// If Icarus is missing or refuses the text, the stimulus does not divide into rows, or an output
/// is X or Z.
pub fn run(name: &str, verilog: &str, top: &str, ports: &Ports, stimulus: &[u32]) -> Result<Vec<u32>, CosimError> {
    run_with(name, verilog, top, ports, &Clocks::Together, stimulus)
}

/// As [`run`], with the clocks as told.
///
/// # Errors
/// As [`run`].
pub fn run_with(
    name: &str,
    verilog: &str,
    top: &str,
    ports: &Ports,
    clocks: &Clocks,
    stimulus: &[u32],
) -> Result<Vec<u32>, CosimError> {
    let layout = Layout::of(ports);
    let columns = layout.inputs.len() + usize::from(*clocks == Clocks::PerStep);
    layout.rows(stimulus.len(), columns)?;
    let bench = bench(&layout);
    let wrapper = wrapper(top, ports);
    let content = [verilog, &wrapper, &bench];
    let program = folder::cached(&format!("{}-icarus", plain(name)), &content, |folder| {
        folder::write(&folder.join("design.v"), verilog)?;
        folder::write(&folder.join("wrapper.v"), &wrapper)?;
        folder::write(&folder.join("bench.v"), &bench)?;
        let files = ["-g2001", "-s", "bench", "-o", "bench.vvp", "bench.v", "wrapper.v", "design.v"];
        folder::must("iverilog", &files, folder, name).map(|_| ())
    })?;
    let scratch = folder::fresh(&folder::root(), &format!("{}-run", plain(name)))?;
    folder::write(&scratch.join("stimulus.txt"), &rows(&layout, clocks, stimulus, columns))?;
    let bench = program.join("bench.vvp");
    let output = folder::must("vvp", &["-N", &bench.to_string_lossy()], &scratch, name)?;
    let answer = answers(name, &layout, &String::from_utf8_lossy(&output.stdout))?;
    let _ = std::fs::remove_dir_all(&scratch);
    Ok(answer)
}

/// One line a step: clock levels before and after, then the inputs, in hexadecimal.
fn rows(layout: &Layout, clocks: &Clocks, stimulus: &[u32], columns: usize) -> String {
    let all = (1u32 << layout.clocks.len()) - 1;
    let mut text = String::new();
    for (step, mut row) in stimulus.chunks(columns).enumerate() {
        let levels = match clocks {
            Clocks::PerStep => {
                let (levels, rest) = row.split_at(1);
                row = rest;
                levels[0]
            }
            Clocks::Repeat(pattern) if !pattern.is_empty() => pattern[step % pattern.len()].word(),
            _ => all,
        };
        let _ = write!(text, "{:x} {:x}", levels >> 16, levels & 0xffff);
        for (value, column) in row.iter().zip(&layout.inputs) {
            let _ = write!(text, " {:x}", value & (u32::MAX >> (32 - column.width)));
        }
        text.push('\n');
    }
    text
}

fn bench(layout: &Layout) -> String {
    let list = |n: usize, line: &dyn Fn(usize) -> String| (0..n).map(line).collect::<String>();
    let (inputs, outputs, clocks) = (layout.inputs.len(), layout.outputs.len(), layout.clocks.len());
    let pins: Vec<_> = (0..clocks)
        .map(|n| format!(".c{n}(levels[{n}])"))
        .chain((0..inputs).map(|n| format!(".i{n}(i{n})")))
        .chain((0..outputs).map(|n| format!(".o{n}(o{n})")))
        .collect();
    format!(
        "module bench;\n    reg [15:0] levels, before, after;\n{ins}{outs}\
    integer file, count;\n\
    cosim_harness harness ({pins});\n\
    initial begin\n\
        levels = 0;\n{zero}\
        file = $fopen(\"stimulus.txt\", \"r\");\n\
        count = $fscanf(file, \"%h %h\", before, after);\n\
        while (count == 2) begin\n{scan}\
            levels = before;\n            #1 levels = after;\n            #1 $display(\"{format}\"{shown});\n\
            count = $fscanf(file, \"%h %h\", before, after);\n\
        end\n        $finish;\n    end\nendmodule\n",
        ins = list(inputs, &|n| format!("    reg [{}:0] i{n};\n", layout.inputs[n].width - 1)),
        outs = list(outputs, &|n| format!("    wire [{}:0] o{n};\n", layout.outputs[n].width - 1)),
        pins = pins.join(", "),
        zero = list(inputs, &|n| format!("        i{n} = 0;\n")),
        scan = list(inputs, &|n| format!("            count = $fscanf(file, \"%h\", i{n});\n")),
        format = list(outputs, &|_| "%h ".into()),
        shown = list(outputs, &|n| format!(", o{n}")),
    )
}

fn answers(name: &str, layout: &Layout, text: &str) -> Result<Vec<u32>, CosimError> {
    let mut answer = Vec::new();
    for (step, line) in text.lines().enumerate() {
        for (digits, column) in line.split_whitespace().zip(&layout.outputs) {
            let value = u32::from_str_radix(digits, 16).map_err(|_| CosimError::Unknown {
                name: name.into(),
                port: column.name.clone(),
                value: digits.into(),
                step,
            })?;
            answer.push(value);
        }
    }
    Ok(answer)
}
