//! `racbot kick`

use crate::card::{CardOptions, ReadyCard};
use crate::terminal::{Answer, Failure, entry};
use clap::Args;
use driver::drive::{Kick, Plan};
use driver::pci::Use;
use driver::realtime::stop_on_signals;
use driver::{Board, Settings};
use serde_json::json;
use std::path::PathBuf;

/// Options of `kick`.
#[derive(Args, Debug)]
pub(crate) struct Options {
    #[command(flatten)]
    card: CardOptions,

    /// Trigger pulse in microseconds, up to 10000; with a triac that is not the strength of the kick
    #[arg(long, value_name = "US", default_value_t = 5_000, value_parser = clap::value_parser!(u16).range(1..=10_000))]
    pulse_us: u16,

    /// How long to charge before, in seconds
    #[arg(long, value_name = "S", default_value_t = 2.0)]
    charge_s: f64,

    /// The robot [default: the paper's]
    #[arg(long, value_name = "FILE")]
    robot: Option<PathBuf>,
}

impl Options {
    pub(crate) fn run(&self) -> Result<Answer, Failure> {
        if !(0.0..=16.0).contains(&self.charge_s) {
            return Err(Failure::usage(format!("--charge-s: {} is not between 0 and 16 seconds", self.charge_s)));
        }
        let robot = super::driven::any_robot(self.robot.as_deref())?;
        let ReadyCard { name, registers, clock_hz, mut clock, .. } =
            self.card.ready(Use::Drive, &robot, self.card.pace())?;
        let about = |what: &dyn std::fmt::Display| Failure::data(format!("{name}: {what}"));
        let scale = Plan::new(&robot, &[]).scale(clock_hz).map_err(|error| about(&error))?;
        let stop = stop_on_signals().map_err(Failure::data)?;
        let kick = Kick { pulse_us: self.pulse_us, charge_s: self.charge_s };
        let kicked = kick
            .kick(Board::new(registers), &mut clock, &scale, &Settings::default(), &stop)
            .map_err(|error| about(&error))?;
        let limit = if kicked.charge_timed_out { ", which ran into its time-out" } else { "" };
        let stood = if kicked.stood.is_notable() {
            entry("note", &format!("cleared before arming: {}", kicked.stood))
        } else {
            String::new()
        };
        let text = format!(
            "card     {name}\ncharged  {} s{limit}\nkicked   {} us, seen {:.1} ms after the request; outputs off\n{stood}",
            self.charge_s,
            self.pulse_us,
            kicked.after.as_secs_f64() * 1e3
        );
        let json = json!({
            "card": name, "charge_s": self.charge_s, "pulse_us": self.pulse_us,
            "seen_after_s": kicked.after.as_secs_f64(), "charge_timed_out": kicked.charge_timed_out,
            "cleared_faults": kicked.stood.faults, "cleared_stalls": kicked.stood.stalls,
            "cleared_encoder_errors": kicked.stood.encoder_errors,
        });
        Ok(Answer { text, json, wrong: None })
    }
}
