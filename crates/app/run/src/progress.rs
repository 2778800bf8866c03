//! Progress on standard error: a bar with an estimate on a terminal, and elsewhere only what must be known.

use std::io::{IsTerminal, Write};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};

/// A bar for `n_steps` steps of one stage. It draws nothing where standard error is not a terminal.
pub fn bar(stage: &str, n_steps: u64) -> ProgressBar {
    let template = "{prefix:>10} [{bar:30}] {pos}/{len} {msg} {elapsed}, {eta} left";
    let style = ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar());
    let bar = ProgressBar::new(n_steps).with_style(style.progress_chars("=> "));
    bar.set_prefix(stage.to_owned());
    bar.enable_steady_tick(Duration::from_millis(500));
    bar
}

/// A line about what happened, on a terminal only.
pub fn note(line: &str) {
    if std::io::stderr().is_terminal() {
        say(line);
    }
}

/// A line that is to be known wherever standard error goes.
pub fn say(line: &str) {
    let _ = writeln!(std::io::stderr(), "{line}");
}
