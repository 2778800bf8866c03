//! Progress reports of long work, and stopping it.

use std::ops::ControlFlow;

use twintac_store::Outcome;

use crate::WorkError;

/// Receives progress reports of work that takes seconds to minutes. Calls come from any thread.
/// Those of one piece of work come between its [`started`](Self::started) and
/// [`finished`](Self::finished). There is one piece of work at a time. The default of each method
/// does nothing.
///
/// ```
/// use std::sync::atomic::{AtomicUsize, Ordering};
/// use twintac_work::Progress;
///
/// #[derive(Default)]
/// struct Steps(AtomicUsize);
///
/// impl Progress for Steps {
///     fn step(&self, _state: &str) {
///         self.0.fetch_add(1, Ordering::Relaxed);
///     }
/// }
/// ```
pub trait Progress: Send + Sync {
    /// Work starts. `n_steps` is 0 if the number of steps is found during the work.
    fn started(&self, work: &str, n_steps: usize) {
        let _ = (work, n_steps);
    }

    /// The work has this many more steps.
    fn more_steps(&self, n_steps: usize) {
        let _ = n_steps;
    }

    /// A step is done. `state` describes the state in a few words; it may be empty.
    fn step(&self, state: &str) {
        let _ = state;
    }

    /// Whether the work should end before its next step, with [`WorkError::Stopped`]. Complete
    /// results are kept.
    fn is_stopped(&self) -> bool {
        false
    }

    /// The work is finished, or has failed.
    fn finished(&self) {}

    /// A stage of a run is done.
    fn stage(&self, name: &str, outcome: Outcome) {
        let _ = (name, outcome);
    }

    /// A message that a person should read, one sentence.
    fn note(&self, text: &str) {
        let _ = text;
    }
}

/// Ignores all reports.
#[derive(Clone, Copy, Debug, Default)]
pub struct Silent;

impl Progress for Silent {}

/// A piece of work. It reports its end when it is dropped.
pub struct Work<'a>(&'a dyn Progress);

impl<'a> Work<'a> {
    /// Reports that work starts. `n_steps` is 0 if the number of steps is found during the work.
    pub fn start(progress: &'a dyn Progress, work: &str, n_steps: usize) -> Self {
        progress.started(work, n_steps);
        Self(progress)
    }

    /// Reports that a step is done, with the state in a few words.
    pub fn step(&self, state: &str) {
        self.0.step(state);
    }

    /// Reports that a step is done, and returns whether to continue.
    pub fn advance(&self) -> ControlFlow<()> {
        self.step("");
        if self.0.is_stopped() {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    }

    /// Returns `Ok` if the work should continue.
    ///
    /// # Errors
    /// [`WorkError::Stopped`] if it should end.
    pub fn go_on(&self) -> Result<(), WorkError> {
        go_on(self.0)
    }
}

/// Returns `Ok` if work should continue.
///
/// # Errors
/// [`WorkError::Stopped`] if it should end.
pub fn go_on(progress: &dyn Progress) -> Result<(), WorkError> {
    if progress.is_stopped() {
        return Err(WorkError::Stopped);
    }
    Ok(())
}

impl Drop for Work<'_> {
    fn drop(&mut self) {
        self.0.finished();
    }
}
