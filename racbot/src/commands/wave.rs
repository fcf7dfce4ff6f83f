//! `racbot wave`

use crate::terminal::{Answer, Failure, Target};
use clap::{Args, ValueEnum};
use serde_json::json;
use simulator::wave::{Scene, record};
use std::path::PathBuf;

/// Options of `wave`.
#[derive(Args, Debug)]
pub(crate) struct Options {
    /// What to show
    #[arg(value_enum)]
    scene: SceneChoice,

    /// File to write [default: out/SCENE.vcd, or the first free of out/SCENE-2.vcd ...]
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,

    #[command(flatten)]
    target: Target,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum SceneChoice {
    /// A burst read, a write, reserved words
    Bus,
    /// Commit, arm sequence, control ticks, PWM
    Arm,
    /// Wheels that are told to turn the other way
    Reversal,
    /// Charging, trigger pulse, lock-out
    Kick,
    /// Driving, then the emergency stop opens
    Stop,
    /// A robot without a PC: a frame on the radio's line that arms
    Radio,
}

impl Options {
    pub(crate) fn run(&self) -> Result<Answer, Failure> {
        let (scene, name) = match self.scene {
            SceneChoice::Bus => (Scene::Bus, "bus"),
            SceneChoice::Arm => (Scene::Arm, "arm"),
            SceneChoice::Reversal => (Scene::Reversal, "reversal"),
            SceneChoice::Kick => (Scene::Kick, "kick"),
            SceneChoice::Stop => (Scene::Stop, "stop"),
            SceneChoice::Radio => (Scene::Radio, "radio"),
        };
        let path = self.target.place(self.out.as_deref(), &format!("out/{name}.vcd"));
        self.target.check_free([&path])?;
        let (text, clocks) = record(scene).map_err(Failure::data)?;
        self.target.save(&path, &text)?;
        let shown = path.display();
        let text = format!("{shown}: {clocks} clocks of the chip's pins; open it with gtkwave or surfer\n");
        Ok(Answer { text, json: json!({ "file": path.to_string_lossy(), "clocks": clocks }), wrong: None })
    }
}
