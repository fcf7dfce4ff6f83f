//! The `racbot` command: one subcommand per thing one does with the robot, see `racbot help`.
//!
//! Exit codes: 0 done, whatever the verdict; 1 bad data; 2 wrong usage.

mod card;
mod commands;
#[cfg(feature = "simulation")]
mod demo;
#[cfg(feature = "vision")]
mod onboard;
mod terminal;

use clap::Parser;
use commands::Command;
use std::process::ExitCode;

/// Co-design of a RoboCup robot: its FPGA, the bit-true twin, the robot's model, and tools that hold
/// them against each other and against measured logs.
#[derive(Debug, Parser)]
#[command(name = "racbot", version, max_term_width = 100)]
struct Cli {
    /// Print the result as JSON instead of a table
    #[arg(long, global = true)]
    json: bool,

    #[command(subcommand)]
    command: Option<Command>,
}

fn main() -> ExitCode {
    let cli = Cli::parse();
    let Some(command) = cli.command.or_else(Command::preset) else {
        return terminal::print(&commands::help::<Cli>()).into();
    };
    match command.run(cli.json) {
        Ok(answer) => answer.print(cli.json).into(),
        Err(failure) => failure.print().into(),
    }
}
