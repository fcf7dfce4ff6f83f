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

use clap::{Arg, CommandFactory, FromArgMatches, Parser};
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
    let matches = negatives(Cli::command()).get_matches();
    let cli = Cli::from_arg_matches(&matches).unwrap_or_else(|error| error.exit());
    let Some(command) = cli.command.or_else(Command::preset) else {
        return terminal::print(&commands::help::<Cli>()).into();
    };
    match command.run(cli.json) {
        Ok(answer) => answer.print(cli.json).into(),
        Err(failure) => failure.print().into(),
    }
}

/// Takes `-5` for a number wherever a value is due: what is wrong with it, its command knows.
fn negatives(command: clap::Command) -> clap::Command {
    let taken = |arg: Arg| if arg.get_action().takes_values() { arg.allow_negative_numbers(true) } else { arg };
    command.mut_args(taken).mut_subcommands(negatives)
}
