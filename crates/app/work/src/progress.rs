//! Following long work, and stopping it.

use std::ops::ControlFlow;

use twintac_store::Outcome;

use crate::WorkError;

/// Hears how work goes that takes from seconds to minutes. Calls come from any thread, those of one piece of work in between its
/// [`started`](Self::started) and [`finished`](Self::finished). There is one piece of work at a time. A method that is not written does
/// nothing.
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
    /// Work starts. `n_steps` is 0 where steps come to light on the way.
    fn started(&self, work: &str, n_steps: usize) {
        let _ = (work, n_steps);
    }

    /// The work takes so many steps more.
    fn more_steps(&self, n_steps: usize) {
        let _ = n_steps;
    }

    /// A step is done. `state` says in a few words how things stand; it may be empty.
    fn step(&self, state: &str) {
        let _ = state;
    }

    /// Whether the work should end before its next step, with [`WorkError::Stopped`]. What is done is kept.
    fn is_stopped(&self) -> bool {
        false
    }

    /// The work is finished, or has failed.
    fn finished(&self) {}

    /// A stage of a run is done.
    fn stage(&self, name: &str, outcome: Outcome) {
        let _ = (name, outcome);
    }

    /// A person should know this, a sentence.
    fn note(&self, text: &str) {
        let _ = text;
    }
}

/// Hears nothing.
#[derive(Clone, Copy, Debug, Default)]
pub struct Silent;

impl Progress for Silent {}

/// A piece of work; dropped, it is finished.
pub struct Work<'a>(&'a dyn Progress);

impl<'a> Work<'a> {
    /// Tells that work starts. `n_steps` is 0 where steps come to light on the way.
    pub fn start(progress: &'a dyn Progress, work: &str, n_steps: usize) -> Self {
        progress.started(work, n_steps);
        Self(progress)
    }

    /// A step is done; how things stand, in a few words.
    pub fn step(&self, state: &str) {
        self.0.step(state);
    }

    /// A step is done; whether to go on.
    pub fn advance(&self) -> ControlFlow<()> {
        self.step("");
        if self.0.is_stopped() {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    }

    /// Nothing, unless the work should end.
    ///
    /// # Errors
    /// [`WorkError::Stopped`].
    pub fn go_on(&self) -> Result<(), WorkError> {
        go_on(self.0)
    }
}

/// Nothing, unless work should end.
///
/// # Errors
/// [`WorkError::Stopped`].
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
