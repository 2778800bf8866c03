//! Values that steps change: one thread at a time uses them.

use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError, TryLockError};
use std::time::Duration;

use pyo3::prelude::*;

use crate::error::unusable;

/// Interval at which a waiting thread tries again.
const PATIENCE: Duration = Duration::from_micros(200);

/// A value that Python threads share. A thread waits until the others are done with it; Ctrl-C ends
/// the wait.
pub(crate) struct Shared<T> {
    value: Mutex<T>,
    /// The process whose thread used it last.
    process: AtomicU32,
}

impl<T: Send> Shared<T> {
    pub(crate) fn new(value: T) -> Self {
        Self {
            value: Mutex::new(value),
            process: AtomicU32::new(0),
        }
    }

    /// Works with the value while other Python threads run.
    ///
    /// Raises `Error` in a forked process if another thread was working with the value at the time
    /// of the fork.
    pub(crate) fn work<R: Send>(&self, py: Python<'_>, work: impl FnOnce(&mut T) -> R + Send) -> PyResult<R> {
        let mut held = self.lock(py)?;
        let value = &mut *held;
        Ok(py.detach(|| work(value)))
    }

    /// Reads the value, or changes it in negligible time.
    ///
    /// Raises `Error` as `work` does.
    pub(crate) fn look<R>(&self, py: Python<'_>, look: impl FnOnce(&mut T) -> R) -> PyResult<R> {
        Ok(look(&mut *self.lock(py)?))
    }

    /// For a thread that is not Python's: waits until the others are done.
    pub(crate) fn hold(&self) -> MutexGuard<'_, T> {
        let held = self.value.lock().unwrap_or_else(PoisonError::into_inner);
        self.process.store(std::process::id(), Ordering::Release);
        held
    }

    fn lock(&self, py: Python<'_>) -> PyResult<MutexGuard<'_, T>> {
        let process = std::process::id();
        loop {
            match self.value.try_lock() {
                Ok(held) => {
                    self.process.store(process, Ordering::Release);
                    return Ok(held);
                }
                Err(TryLockError::Poisoned(held)) => return Ok(held.into_inner()),
                Err(TryLockError::WouldBlock) if self.process.load(Ordering::Acquire) != process => {
                    let problem = "was at work in another thread when this process was forked, and can't be \
                                   used here: make one in this process";
                    return Err(unusable(py, "self", problem));
                }
                Err(TryLockError::WouldBlock) => {
                    py.detach(|| std::thread::sleep(PATIENCE));
                    py.check_signals()?;
                }
            }
        }
    }
}
