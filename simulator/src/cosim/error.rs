//! What can go wrong between a Verilog text and its answers.

use super::ports::PortError;
use std::path::PathBuf;

/// An error of the co-simulation.
#[derive(Debug, thiserror::Error)]
pub enum CosimError {
    /// A program that is not installed.
    #[error("`{tool}` is not installed or not on PATH; on Debian: apt-get install {package}")]
    MissingTool {
        /// Program that was called.
        tool: String,
        /// The Debian package that has it.
        package: &'static str,
    },
    /// A program of a Python package that is not installed.
    #[error(
        "`{tool}` is not on PATH; ./test.sh installs it from PyPI into target/python, then: PATH=target/python/bin:$PATH"
    )]
    MissingPythonTool {
        /// Program that was called.
        tool: String,
    },
    /// A program that ran and failed.
    #[error("{tool} failed on {what} (files kept in {}):\n{output}", folder.display())]
    Tool {
        /// Program that was called.
        tool: String,
        /// What it was given.
        what: String,
        /// Where the files are.
        folder: PathBuf,
        /// What it printed.
        output: String,
    },
    /// A file or folder that cannot be used.
    #[error("cannot {action} {}: {source}", path.display())]
    File {
        /// What was tried.
        action: &'static str,
        /// File or folder.
        path: PathBuf,
        /// Why not.
        source: std::io::Error,
    },
    /// The ports of the module do not fit.
    #[error(transparent)]
    Ports(#[from] PortError),
    /// A port name that the module does not have.
    #[error("no {kind} port `{name}`; there are: {available}")]
    NoPort {
        /// Input or output.
        kind: &'static str,
        /// The name that was asked for.
        name: String,
        /// The names that exist.
        available: String,
    },
    /// A stimulus of the wrong shape.
    #[error(
        "a stimulus of {words} words does not divide into rows of {columns}; a row is one word for each of: {names}"
    )]
    Shape {
        /// Words given.
        words: usize,
        /// Words in a row.
        columns: usize,
        /// Names of the inputs, in their order.
        names: String,
    },
    /// The simulation stopped answering.
    #[error("the simulation of {name} ended early ({source}); it printed: {output}")]
    Ended {
        /// Design that the program runs.
        name: String,
        /// What reading or writing said.
        source: std::io::Error,
        /// What it printed to its error stream.
        output: String,
    },
    /// An output that is neither 0 nor 1.
    #[error("{name}: output `{port}` is `{value}` at step {step}: a signal was never given a value")]
    Unknown {
        /// Design with the undefined value.
        name: String,
        /// Output that carries it.
        port: String,
        /// The digits as printed.
        value: String,
        /// The step, from 0.
        step: usize,
    },
    /// A local bus cycle that went wrong.
    #[error("local bus operation {index} ({operation}): {reason}, at clock {clock}")]
    Bus {
        /// Which operation of the list, from 0.
        index: usize,
        /// Its kind, with address and length.
        operation: String,
        /// What happened.
        reason: &'static str,
        /// Clock at which it happened, from 0.
        clock: u64,
    },
    /// A Verilog text that does not pass the gate.
    #[error("{name}: {} finding(s) that may hide a wrong circuit:\n{}", findings.len(), findings.join("\n"))]
    Lint {
        /// Design that was checked.
        name: String,
        /// The findings, one a line.
        findings: Vec<String>,
    },
}

impl CosimError {
    /// For `map_err` on file operations.
    pub fn file(action: &'static str, path: impl Into<PathBuf>) -> impl FnOnce(std::io::Error) -> Self {
        let path = path.into();
        move |source| Self::File { action, path, source }
    }
}
