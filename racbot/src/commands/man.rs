//! `racbot man`

use crate::terminal::{Answer, Failure, Target};
use clap::{Args, CommandFactory};
use clap_mangen::Man;
use serde_json::json;
use std::path::PathBuf;

/// Options of `man`.
#[derive(Args, Debug)]
#[command(after_help = "racbot man ~/.local/share/man/man1, then: man racbot-gap")]
pub(crate) struct Options {
    /// Folder for the pages, one for racbot and one for each subcommand
    #[arg(value_name = "DIR")]
    folder: PathBuf,

    #[command(flatten)]
    target: Target,
}

impl Options {
    pub(crate) fn run(&self) -> Result<Answer, Failure> {
        let mut all = crate::Cli::command();
        all.build();
        let mut pages = vec![("racbot.1".to_owned(), all.clone())];
        for command in all.get_subcommands().filter(|command| command.get_name() != "help") {
            let name = format!("racbot-{}", command.get_name());
            pages.push((format!("{name}.1"), command.clone().display_name(&name)));
        }
        let files: Vec<PathBuf> = pages.iter().map(|(file, _)| self.folder.join(file)).collect();
        for (file, (_, command)) in files.iter().zip(pages) {
            let mut page = Vec::new();
            Man::new(command).render(&mut page).map_err(|error| Failure::about(file, error))?;
            self.target.save(file, &page)?;
        }
        let text = format!("{} pages in {}\n", files.len(), self.folder.display());
        Ok(Answer {
            text,
            json: json!({ "files": files.iter().map(|file| file.to_string_lossy()).collect::<Vec<_>>() }),
            wrong: None,
        })
    }
}
