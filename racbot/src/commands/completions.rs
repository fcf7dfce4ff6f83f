//! `racbot completions`

use crate::terminal::{Answer, Failure};
use clap::{Args, CommandFactory};
use clap_complete::{Shell, generate};
use serde_json::json;

/// Options of `completions`.
#[derive(Args, Debug)]
#[command(after_help = "racbot completions bash > ~/.local/share/bash-completion/completions/racbot")]
pub(crate) struct Options {
    /// Shell that is to understand the script
    #[arg(value_enum)]
    shell: Shell,
}

impl Options {
    pub(crate) fn run(&self) -> Result<Answer, Failure> {
        let mut script = Vec::new();
        generate(self.shell, &mut crate::Cli::command(), "racbot", &mut script);
        let text = String::from_utf8(script).map_err(Failure::data)?;
        let json = json!({ "shell": self.shell.to_string(), "script": text });
        Ok(Answer { text, json, wrong: None })
    }
}
