//! One file per subcommand: its options, what it calls, what it prints.

mod axes;
#[cfg(feature = "simulation")]
mod bitstream;
mod calibrate;
mod check;
mod completions;
#[cfg(feature = "simulation")]
mod convert;
#[cfg(feature = "simulation")]
mod demo;
mod drive;
mod driven;
#[cfg(feature = "simulation")]
mod fpga_options;
#[cfg(feature = "simulation")]
mod gap;
#[cfg(feature = "simulation")]
mod generate;
mod info;
mod init;
mod kick;
mod latency;
mod load;
mod man;
mod monitor;
#[cfg(feature = "simulation")]
mod options;
mod radio;
mod record;
#[cfg(feature = "simulation")]
mod replay;
mod serve;
#[cfg(feature = "simulation")]
mod simulate;
mod start;
#[cfg(feature = "vision")]
pub(crate) mod vision;
#[cfg(feature = "simulation")]
mod wave;

use crate::terminal::{Answer, Failure};
use clap::{CommandFactory, Subcommand};

/// What to do.
#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Everything once on the built-in virtual robot: this is what `racbot` alone does
    #[cfg(feature = "simulation")]
    Demo(demo::Options),
    /// Write the gateware: Verilog, pin constraints, register documents
    #[cfg(feature = "simulation")]
    Generate(generate::Options),
    /// Make and look into bitstreams of the card's device
    #[cfg(feature = "simulation")]
    Bitstream(bitstream::Options),
    /// Drive a virtual robot along set points, its speed loops in an FPGA
    #[cfg(feature = "simulation")]
    Simulate(simulate::Options),
    /// Feed a measured log through the FPGA and compare its duties with the logged ones
    #[cfg(feature = "simulation")]
    Replay(replay::Options),
    /// Find mistakes in how a data set is set up: units, axes, signs, orders, the wrong robot.toml
    Check(check::Options),
    /// Write a commented robot.toml from the angles of the wheels
    Init(Box<init::Options>),
    /// Bring other tools' logs into ours: any CSV, JSON, ROS 2 bags, SSL game logs, WPILib logs
    #[cfg(feature = "simulation")]
    Convert(convert::Options),
    /// Find the skew of the wheels
    Calibrate(calibrate::Options),
    /// Find where simulation and measured logs disagree, and name the missing effect
    #[cfg(feature = "simulation")]
    Gap(gap::Options),
    /// Load the FPGA of a card over PCI and verify what runs there
    Load(load::Options),
    /// Show what a card is doing; change nothing
    Info(info::Options),
    /// Drive a robot along set points, over a card
    Drive(Box<drive::Options>),
    /// Let software of the small-size league drive simulated robots, or the real one
    Serve(Box<serve::Options>),
    /// Charge and fire the kicker
    Kick(kick::Options),
    /// Drive a robot without a PC over a radio module
    Radio(radio::Options),
    /// Watch a card in the terminal
    Monitor(monitor::Options),
    /// Find the ball, lines and goals in pictures of an on-board camera
    #[cfg(feature = "vision")]
    Vision(vision::Options),
    /// Write a scene of the chip's life as a waveform (VCD)
    #[cfg(feature = "simulation")]
    Wave(wave::Options),
    /// Measure how late the timer wakes the control loop on this machine
    Latency(latency::Options),
    /// Print what a shell needs to complete racbot's words
    Completions(completions::Options),
    /// Write the manual pages
    Man(man::Options),
}

impl Command {
    /// What `racbot` alone does.
    pub(crate) fn preset() -> Option<Self> {
        #[cfg(feature = "simulation")]
        return Some(Self::Demo(demo::Options::default()));
        #[cfg(not(feature = "simulation"))]
        return None;
    }

    /// Does it; with `json` the answer is for a program.
    pub(crate) fn run(&self, json: bool) -> Result<Answer, Failure> {
        match self {
            #[cfg(feature = "simulation")]
            Self::Demo(options) => options.run(),
            #[cfg(feature = "simulation")]
            Self::Generate(options) => options.run(),
            #[cfg(feature = "simulation")]
            Self::Bitstream(options) => options.run(),
            #[cfg(feature = "simulation")]
            Self::Simulate(options) => options.run(),
            #[cfg(feature = "simulation")]
            Self::Replay(options) => options.run(),
            Self::Check(options) => options.run(),
            Self::Init(options) => options.run(),
            #[cfg(feature = "simulation")]
            Self::Convert(options) => options.run(),
            Self::Calibrate(options) => options.run(),
            #[cfg(feature = "simulation")]
            Self::Gap(options) => options.run(),
            Self::Load(options) => options.run(),
            Self::Info(options) => options.run(),
            Self::Drive(options) => options.run(),
            Self::Serve(options) => options.run(),
            Self::Kick(options) => options.run(),
            Self::Radio(options) => options.run(),
            Self::Monitor(options) => options.run(json),
            #[cfg(feature = "vision")]
            Self::Vision(options) => options.run(),
            #[cfg(feature = "simulation")]
            Self::Wave(options) => options.run(),
            Self::Latency(options) => options.run(),
            Self::Completions(options) => options.run(),
            Self::Man(options) => options.run(),
        }
    }
}

/// The help text.
pub(crate) fn help<C: CommandFactory>() -> String {
    C::command().render_help().to_string()
}
