//! Progress on standard error, where that is a terminal.

use indicatif::{ProgressBar, ProgressStyle};

/// A bar that goes away when it is dropped.
#[derive(Debug)]
pub(crate) struct Progress(ProgressBar);

impl Progress {
    /// A bar for so many steps.
    pub(crate) fn new(what: impl Into<String>, steps: u64) -> Self {
        // indicatif draws nothing where standard error is no terminal.
        let bar = ProgressBar::new(steps).with_message(what.into());
        let style = ProgressStyle::with_template("{msg:32!} [{bar:30}] {percent:>3} % {eta:>4}");
        Self(bar.with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()).progress_chars("=> ")))
    }

    /// Another name, for the next part of the work.
    pub(crate) fn rename(&self, what: &'static str) {
        self.0.set_message(what);
    }

    /// So many steps are done.
    pub(crate) fn at(&self, done: u64) {
        self.0.set_position(done);
    }

    /// One more step is done, by any thread.
    pub(crate) fn step(&self) {
        self.0.inc(1);
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.0.finish_and_clear();
    }
}
