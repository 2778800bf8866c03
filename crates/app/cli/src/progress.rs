//! Progress on standard error: a bar with an estimate on a terminal, and elsewhere only what must be known.

use std::io::{IsTerminal, Write};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};
use twintac_store::Outcome;
use twintac_text::visible;
use twintac_work::Progress;

/// One bar at a time, and lines above it.
#[derive(Debug, Default)]
pub(crate) struct Bars(Mutex<Option<ProgressBar>>);

impl Bars {
    fn with(&self, act: impl FnMut(&ProgressBar)) {
        let bar = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        bar.iter().for_each(act);
    }
}

impl Progress for Bars {
    fn started(&self, work: &str, n_steps: usize) {
        let bar = bar(work, n_steps);
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = Some(bar);
    }

    fn more_steps(&self, n_steps: usize) {
        self.with(|bar| bar.inc_length(n_steps as u64));
    }

    fn step(&self, state: &str) {
        self.with(|bar| {
            if !state.is_empty() {
                bar.set_message(visible(state).into_owned());
            }
            bar.inc(1);
        });
    }

    fn finished(&self) {
        let bar = self.0.lock().unwrap_or_else(PoisonError::into_inner).take();
        bar.iter().for_each(ProgressBar::finish_and_clear);
    }

    /// Only on a terminal.
    fn stage(&self, name: &str, outcome: Outcome) {
        let word = match outcome {
            Outcome::Ran => "done",
            Outcome::Kept => "kept",
        };
        if std::io::stderr().is_terminal() {
            self.note(&format!("{name:>11} {word}"));
        }
    }

    fn note(&self, text: &str) {
        let bar = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        match &*bar {
            Some(bar) => bar.suspend(|| say(text)),
            None => say(text),
        }
    }
}

/// A bar draws nothing where standard error is not a terminal.
fn bar(work: &str, n_steps: usize) -> ProgressBar {
    let template = "{prefix:>10} [{bar:30}] {pos}/{len} {msg} {elapsed}, {eta} left";
    let style = ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar());
    let bar = ProgressBar::new(n_steps as u64).with_style(style.progress_chars("=> "));
    bar.set_prefix(work.to_owned());
    bar.enable_steady_tick(Duration::from_millis(500));
    bar
}

/// A line on standard error, wherever that goes.
pub(crate) fn say(line: &str) {
    let _ = writeln!(std::io::stderr(), "{}", visible(line));
}
