//! Threads that end when they are dropped.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;

use crate::EmulateError;

/// A thread that is told to end, and is waited for, when this value is dropped.
#[derive(Debug)]
pub(crate) struct Worker {
    is_over: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

/// The flag that tells a thread to end.
#[derive(Clone, Debug)]
pub(crate) struct Over(Arc<AtomicBool>);

impl Worker {
    pub(crate) fn start(
        name: &'static str,
        body: impl FnOnce(&Over) + Send + 'static,
    ) -> Result<Self, EmulateError> {
        let is_over = Arc::new(AtomicBool::new(false));
        let over = Over(Arc::clone(&is_over));
        let thread = std::thread::Builder::new()
            .name(name.to_owned())
            .spawn(move || body(&over))
            .map_err(|source| EmulateError::System { what: name, source })?;
        Ok(Self {
            is_over,
            thread: Some(thread),
        })
    }

    pub(crate) fn has_ended(&self) -> bool {
        self.thread.as_ref().is_none_or(JoinHandle::is_finished)
    }
}

impl Over {
    pub(crate) fn is_over(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

impl Drop for Worker {
    fn drop(&mut self) {
        self.is_over.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            let _ = thread.join(); // a thread that panicked has reported it
        }
    }
}

/// Locks a mutex, also after a thread died while it held the lock. A physics that panics ends its
/// own thread and no other.
pub(crate) fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
