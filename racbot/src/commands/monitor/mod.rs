//! `racbot monitor`

mod screen;
mod view;

use crate::card::{CardOptions, Pace, ReadyCard};
use crate::terminal::{Answer, Failure};
use clap::Args;
use driver::pci::Use;
use driver::realtime::stop_on_signals;
use driver::{Board, Observation, Scale, fault_names};
use screen::Screen;
use serde_json::{Value, json};
use std::io::IsTerminal;
use std::path::PathBuf;
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};
use view::View;

/// Options of `monitor`.
#[derive(Args, Debug)]
pub(crate) struct Options {
    #[command(flatten)]
    card: CardOptions,

    /// Show one picture and stop; also where the output is no terminal, and with --json
    #[arg(long)]
    once: bool,

    /// Time between two pictures in milliseconds
    #[arg(long, value_name = "MS", default_value_t = 100, value_parser = clap::value_parser!(u32).range(20..=10_000))]
    every_ms: u32,

    /// The robot, for its units [default: the paper's]
    #[arg(long, value_name = "FILE")]
    robot: Option<PathBuf>,
}

impl Options {
    pub(crate) fn run(&self, json: bool) -> Result<Answer, Failure> {
        let robot = super::driven::any_robot(self.robot.as_deref())?;
        let ReadyCard { name, registers, clock_hz, .. } = self.card.ready(Use::Look, &robot, Pace::Real)?;
        let about = |what: &dyn std::fmt::Display| Failure::data(format!("{name}: {what}"));
        let scale = Scale::new(&robot, clock_hz).map_err(|error| about(&error))?;
        let mut board = Board::new(registers);
        let view = View { name: &name, clock_hz, scale: &scale };
        let begun = Instant::now();
        if self.once || json || !std::io::stdout().is_terminal() {
            let seen = Observation::of(&mut board).map_err(|error| about(&error))?;
            let text = view.lines(&seen, begun.elapsed(), false).join("\n") + "\n";
            return Ok(Answer { text, json: to_json(&name, clock_hz, &seen, &scale), wrong: None });
        }
        let stop = stop_on_signals().map_err(Failure::data)?;
        let mut screen = Screen::enter().map_err(Failure::data)?;
        let every = Duration::from_millis(self.every_ms.into());
        let ended = loop {
            match Observation::of(&mut board) {
                Ok(seen) => screen.show(&view.lines(&seen, begun.elapsed(), true)).map_err(Failure::data)?,
                Err(error) => break Some(about(&error)),
            }
            if screen.quits(every).map_err(Failure::data)? || stop.load(Ordering::Relaxed) {
                break None;
            }
        };
        // The terminal is as it was before anything is said.
        drop(screen);
        ended.map_or_else(|| Ok(Answer::default()), Err)
    }
}

fn to_json(name: &str, clock_hz: f64, seen: &Observation, scale: &Scale) -> Value {
    let wheels = scale.wheels();
    json!({
        "card": name, "clock_hz": clock_hz, "armed": seen.status.armed,
        "set_points_valid": seen.status.set_points_valid, "emergency_stop": seen.status.emergency_stop,
        "ball": seen.status.ball, "faults": seen.faults, "fault_names": fault_names(seen.faults),
        "first_fault": seen.first_fault, "commits_accepted": seen.commits[0], "commits_rejected": seen.commits[1],
        "time": seen.time, "encoder_errors": seen.encoder_errors, "kicker_status": seen.kicker,
        "set_points": seen.set_points, "integrals": &seen.integrals[..wheels],
        "snapshot": seen.snapshot.map(|s| json!({
            "sequence": s.sequence, "counts": &s.counts[..wheels],
            "speeds_rad_s": s.speeds[..wheels].iter().map(|w| scale.speed(*w)).collect::<Vec<_>>(),
            "references_rad_s": s.references[..wheels].iter().map(|w| scale.speed(*w)).collect::<Vec<_>>(),
            "duties": s.duties[..wheels].iter().map(|d| f64::from(*d)).collect::<Vec<_>>(),
        })),
    })
}
