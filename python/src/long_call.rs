//! Calls that take from a second to hours. A thread of their own does the work, while the calling
//! thread handles Python's signals and reports progress.

use std::panic::resume_unwind;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::Duration;

use pyo3::exceptions::PyUserWarning;
use pyo3::prelude::*;
use twintac::Progress;

use crate::pool::in_parallel;
use crate::shared::Shared;

/// Longest delay before Ctrl-C is handled.
const PATIENCE: Duration = Duration::from_millis(50);

/// Messages of the working thread.
enum Message<T> {
    /// A message that a person should read.
    Note(String),
    /// Progress of the work.
    Step {
        work: String,
        done: usize,
        total: usize,
        state: String,
    },
    /// The work is done.
    Done(T),
}

/// Does work without reporting progress. After Ctrl-C the work runs on, and its result is dropped.
pub(crate) fn long_call<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce() -> T + Send + 'static,
) -> PyResult<T> {
    long_call_on(py, Arc::new(Shared::new(())), |()| work())
}

/// The same with exclusive access to a value, which lasts until the work is done, also after
/// Ctrl-C.
pub(crate) fn long_call_on<V: Send + 'static, T: Send + 'static>(
    py: Python<'_>,
    value: Arc<Shared<V>>,
    work: impl FnOnce(&mut V) -> T + Send + 'static,
) -> PyResult<T> {
    let (sender, receiver) = channel();
    let worker = std::thread::spawn(move || {
        let mut held = value.hold();
        let value = &mut *held;
        let done = in_parallel(|| work(value));
        drop(held);
        drop(sender.send(Message::Done(done)));
    });
    match listen(py, receiver, None)? {
        Some(done) => Ok(done),
        None => end(py, worker),
    }
}

/// Does work that reports to `progress`, as `listener` in `_progress.py` interprets it. After
/// Ctrl-C the work ends before its next step.
pub(crate) fn followed<T: Send + 'static>(
    py: Python<'_>,
    progress: Option<&Bound<'_, PyAny>>,
    work: impl FnOnce(Arc<dyn Progress>) -> T + Send + 'static,
) -> PyResult<T> {
    let listener = py
        .import("twintac._progress")?
        .getattr("listener")?
        .call1((progress,))?;
    let (sender, receiver) = channel();
    let stops = Arc::new(AtomicBool::new(false));
    let teller = Teller {
        sender: sender.clone(),
        work: Mutex::default(),
        done: AtomicUsize::new(0),
        total: AtomicUsize::new(0),
        stops: Arc::clone(&stops),
    };
    let worker = std::thread::spawn(move || {
        let done = in_parallel(|| work(Arc::new(teller)));
        drop(sender.send(Message::Done(done)));
    });
    match listen(
        py,
        receiver,
        Some(&listener).filter(|listener| !listener.is_none()),
    ) {
        Ok(Some(done)) => Ok(done),
        Ok(None) => end(py, worker),
        Err(interrupt) => {
            stops.store(true, Ordering::Relaxed);
            let _ = py.detach(|| worker.join());
            Err(interrupt)
        }
    }
}

/// Receives messages until the work is done, or until a signal or the listener raises an exception.
/// Returns `None` if the work panicked.
fn listen<T: Send>(
    py: Python<'_>,
    mut receiver: Receiver<Message<T>>,
    listener: Option<&Bound<'_, PyAny>>,
) -> PyResult<Option<T>> {
    loop {
        let heard;
        (receiver, heard) = py.detach(move || {
            let heard = receiver.recv_timeout(PATIENCE);
            (receiver, heard)
        });
        match (heard, listener) {
            (Ok(Message::Done(done)), _) => return Ok(Some(done)),
            (Ok(Message::Note(text)), _) => {
                let text = std::ffi::CString::new(text)?;
                PyErr::warn(py, &py.get_type::<PyUserWarning>(), &text, 1)?;
            }
            (
                Ok(Message::Step {
                    work,
                    done,
                    total,
                    state,
                }),
                Some(listener),
            ) => {
                listener.call1((work, done, total, state))?;
            }
            (Ok(Message::Step { .. }) | Err(RecvTimeoutError::Timeout), _) => {}
            (Err(RecvTimeoutError::Disconnected), _) => return Ok(None),
        }
        py.check_signals()?;
    }
}

/// Continues the worker's panic.
fn end<T>(py: Python<'_>, worker: JoinHandle<()>) -> PyResult<T> {
    match py.detach(|| worker.join()) {
        Err(panic) => resume_unwind(panic),
        Ok(()) => unreachable!("a thread that did not panic has sent what it did"),
    }
}

/// Sends progress to the calling thread.
struct Teller<T> {
    sender: Sender<Message<T>>,
    work: Mutex<String>,
    done: AtomicUsize,
    total: AtomicUsize,
    stops: Arc<AtomicBool>,
}

impl<T> Teller<T> {
    fn tell(&self, done: usize, state: &str) {
        let step = Message::Step {
            work: self.work.lock().unwrap_or_else(PoisonError::into_inner).clone(),
            done,
            total: self.total.load(Ordering::Relaxed),
            state: state.to_owned(),
        };
        let _ = self.sender.send(step); // after an interrupt there is no receiver
    }
}

impl<T: Send> Progress for Teller<T> {
    fn started(&self, work: &str, n_steps: usize) {
        work.clone_into(&mut self.work.lock().unwrap_or_else(PoisonError::into_inner));
        self.done.store(0, Ordering::Relaxed);
        self.total.store(n_steps, Ordering::Relaxed);
        self.tell(0, "");
    }

    fn more_steps(&self, n_steps: usize) {
        self.total.fetch_add(n_steps, Ordering::Relaxed);
    }

    fn step(&self, state: &str) {
        let done = self.done.fetch_add(1, Ordering::Relaxed) + 1;
        self.tell(done, state);
    }

    fn is_stopped(&self) -> bool {
        self.stops.load(Ordering::Relaxed)
    }

    /// Work can have fewer steps than announced; the total is corrected.
    fn finished(&self) {
        let done = self.done.load(Ordering::Relaxed);
        self.total.store(done, Ordering::Relaxed);
        self.tell(done, "");
    }

    fn note(&self, text: &str) {
        let _ = self.sender.send(Message::Note(text.to_owned()));
    }
}
