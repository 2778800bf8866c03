//! Progress on standard error: a bar with an estimate on a terminal, and a line a minute elsewhere;
//! and notes.

use std::fmt;
use std::io::{IsTerminal, Write};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use indicatif::{HumanDuration, ProgressBar, ProgressState, ProgressStyle};
use twintac_store::Outcome;
use twintac_text::visible;
use twintac_work::Progress;

/// Interval of lines if standard error is not a terminal.
const QUIET: Duration = Duration::from_secs(60);

/// The piece of work in progress. Notes appear above its bar.
#[derive(Debug, Default)]
pub(crate) struct Bars(Mutex<Option<Shown>>);

/// A piece of work that is displayed.
#[derive(Debug)]
struct Shown {
    bar: ProgressBar,
    /// When the last line was printed; `None` on a terminal.
    told: Option<Instant>,
}

impl Bars {
    fn with(&self, act: impl FnOnce(&mut Shown)) {
        let mut shown = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        shown.as_mut().map(act);
    }
}

impl Shown {
    /// Prints a line about the progress if the last one is old enough.
    fn tell(&mut self) {
        if self.told.is_none_or(|told| told.elapsed() < QUIET) {
            return;
        }
        self.told = Some(Instant::now());
        say(&line(&self.bar));
    }
}

impl Progress for Bars {
    fn started(&self, work: &str, n_steps: usize) {
        let shown = Shown {
            bar: bar(work, n_steps),
            told: (!std::io::stderr().is_terminal()).then(Instant::now),
        };
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = Some(shown);
    }

    fn more_steps(&self, n_steps: usize) {
        self.with(|shown| shown.bar.inc_length(n_steps as u64));
    }

    fn step(&self, state: &str) {
        self.with(|shown| {
            if !state.is_empty() {
                shown.bar.set_message(visible(state).into_owned());
            }
            shown.bar.inc(1);
            shown.tell();
        });
    }

    fn finished(&self) {
        let shown = self.0.lock().unwrap_or_else(PoisonError::into_inner).take();
        shown.iter().for_each(|shown| shown.bar.finish_and_clear());
    }

    /// Printed only on a terminal.
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
        let shown = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        match &*shown {
            Some(shown) => shown.bar.suspend(|| say(text)),
            None => say(text),
        }
    }
}

/// A progress bar. It draws nothing if standard error is not a terminal.
fn bar(work: &str, n_steps: usize) -> ProgressBar {
    let template = "{prefix:>10} [{bar:30}] {pos}/{len} {msg} {elapsed}, {left} left";
    let style = ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar());
    let style = style.with_key("left", |state: &ProgressState, out: &mut dyn fmt::Write| {
        let left = left(state.elapsed(), state.pos(), state.len().unwrap_or(0));
        let _ = match left {
            Some(left) => write!(out, "{}", HumanDuration(left)),
            None => write!(out, "?"),
        };
    });
    let bar = ProgressBar::new(n_steps as u64).with_style(style.progress_chars("=> "));
    bar.set_prefix(work.to_owned());
    bar.enable_steady_tick(Duration::from_millis(500));
    bar
}

/// The progress of a piece of work as a line.
fn line(bar: &ProgressBar) -> String {
    let minutes = |time: Duration| time.as_secs().div_ceil(60);
    let (done, all) = (bar.position(), bar.length().unwrap_or(0));
    let (work, after) = (bar.prefix(), minutes(bar.elapsed()));
    let left = left(bar.elapsed(), done, all);
    let left = left.map_or(String::new(), |left| {
        format!(", about {} min left", minutes(left))
    });
    let state = bar.message();
    let state = if state.is_empty() {
        state
    } else {
        format!(" ({state})")
    };
    format!("{work}: {done} of {all}{state} after {after} min{left}")
}

/// The remaining time, if each step takes the average time of the finished ones.
fn left(elapsed: Duration, done: u64, all: u64) -> Option<Duration> {
    (done > 0).then(|| elapsed.mul_f64(all.saturating_sub(done) as f64 / done as f64))
}

/// Prints a line on standard error.
pub(crate) fn say(line: &str) {
    let _ = writeln!(std::io::stderr(), "{}", visible(line));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_says_how_far_the_work_is_once_a_minute() {
        let mut shown = Shown {
            bar: bar("recording", 280).with_elapsed(Duration::from_secs(150)),
            told: Instant::now().checked_sub(QUIET),
        };
        shown.bar.inc(70);
        let line = line(&shown.bar);
        // It does not depend on when the finished steps were done.
        assert_eq!(line, "recording: 70 of 280 after 3 min, about 8 min left");
        let begun = bar("fitting", 30);
        assert_eq!(super::line(&begun), "fitting: 0 of 30 after 0 min");
        begun.set_message("deviation 1.870 %");
        assert_eq!(
            super::line(&begun),
            "fitting: 0 of 30 (deviation 1.870 %) after 0 min"
        );
        let before = shown.told;
        shown.tell();
        assert_ne!(shown.told, before);
        let told = shown.told;
        shown.tell();
        assert_eq!(shown.told, told);
    }
}
