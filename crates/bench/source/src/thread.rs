//! Reads frames on a separate thread.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, TrySendError, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use crate::{Reading, SourceError, TactileSource};

/// Failures in a row after which a sensor is given up, with the rest time after each: 2 s in all.
const MOST_FAILURES: u32 = 40;
const REST: Duration = Duration::from_millis(50);

/// Longest silence of a sensor. It is longer than the time of the failures, so that a failure is
/// reported with its cause.
const SILENCE: Duration = Duration::from_secs(3);

/// Longest time that the thread may take to end.
const LEAVE: Duration = Duration::from_secs(1);

/// A thread that reads a sensor as fast as possible, and never waits for its user.
#[derive(Debug)]
pub struct FrameSource {
    readings: Receiver<Reading>,
    shared: Arc<Shared>,
    thread: Option<JoinHandle<Result<(), SourceError>>>,
    /// When the last frame was taken, or the thread was started.
    heard: Instant,
}

/// Counts of the frames so far.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// Frames that were read.
    pub read: u64,
    /// Of these, frames that found no room in the channel and are lost.
    pub missed: u64,
    /// How many times the source gave an error and no frame.
    pub failed: u64,
    /// The latest of these errors.
    pub last_failure: Option<String>,
    /// What was on the connection besides frames, one sentence each.
    pub remarks: Vec<String>,
}

#[derive(Debug, Default)]
struct Shared {
    is_over: AtomicBool,
    read: AtomicU64,
    missed: AtomicU64,
    failed: AtomicU64,
    last_failure: Mutex<Option<String>>,
    remarks: Mutex<Vec<String>>,
}

impl FrameSource {
    /// Usual number of frames that may wait in the channel: two seconds of a sensor.
    pub const USUAL_CAPACITY: usize = 256;

    /// Starts to read. `capacity` frames may wait to be taken. A frame that comes while the channel
    /// is full is counted as missed.
    ///
    /// # Errors
    /// [`SourceError::Thread`]: the thread could not be started.
    pub fn start(source: impl TactileSource + 'static, capacity: usize) -> Result<Self, SourceError> {
        let (sender, readings) = sync_channel(capacity);
        let shared = Arc::new(Shared::default());
        let its_shared = Arc::clone(&shared);
        let thread = std::thread::Builder::new()
            .name("frames".to_owned())
            .spawn(move || run(source, &sender, &its_shared))
            .map_err(|error| SourceError::Thread {
                problem: error.to_string(),
            })?;
        Ok(Self {
            readings,
            shared,
            thread: Some(thread),
            heard: Instant::now(),
        })
    }

    /// The next frame, or `None` if none comes within `timeout`.
    ///
    /// # Errors
    /// [`SourceError::Wire`]: the sensor was given up, after failures for 2 s or silence for 3 s.
    /// [`SourceError::Thread`].
    pub fn next(&mut self, timeout: Duration) -> Result<Option<Reading>, SourceError> {
        match self.readings.recv_timeout(timeout) {
            Ok(reading) => {
                self.heard = Instant::now();
                Ok(Some(reading))
            }
            Err(RecvTimeoutError::Timeout) if self.heard.elapsed() >= SILENCE => {
                let silence = format!("none came for {} s", SILENCE.as_secs());
                let said: Vec<String> = std::iter::once(silence).chain(self.tally().remarks).collect();
                Err(SourceError::Wire {
                    problem: said.join("; "),
                })
            }
            Err(RecvTimeoutError::Timeout) => Ok(None),
            Err(RecvTimeoutError::Disconnected) => {
                let ended = self.thread.take().map(JoinHandle::join);
                match ended {
                    Some(Ok(Err(error))) => Err(error),
                    _ => Err(SourceError::Thread {
                        problem: "it has ended".to_owned(),
                    }),
                }
            }
        }
    }

    /// Counts of the frames so far.
    #[must_use]
    pub fn tally(&self) -> Tally {
        let shared = &self.shared;
        let last_failure = shared.last_failure.lock().unwrap_or_else(PoisonError::into_inner);
        Tally {
            read: shared.read.load(Ordering::Relaxed),
            missed: shared.missed.load(Ordering::Relaxed),
            failed: shared.failed.load(Ordering::Relaxed),
            last_failure: last_failure.clone(),
            remarks: shared
                .remarks
                .lock()
                .unwrap_or_else(PoisonError::into_inner)
                .clone(),
        }
    }
}

/// Ends the thread after the frame that it is reading. If the bus hangs, the thread is not waited
/// for.
impl Drop for FrameSource {
    fn drop(&mut self) {
        self.shared.is_over.store(true, Ordering::Relaxed);
        let end = Instant::now() + LEAVE;
        let mut heard = Ok(());
        while heard.is_ok() {
            let left = end.saturating_duration_since(Instant::now());
            heard = self.readings.recv_timeout(left).map(drop);
        }
        if heard == Err(RecvTimeoutError::Disconnected)
            && let Some(thread) = self.thread.take()
        {
            let _ = thread.join(); // nobody can be told the result
        }
    }
}

fn run(
    mut source: impl TactileSource,
    sender: &SyncSender<Reading>,
    shared: &Shared,
) -> Result<(), SourceError> {
    let mut failures = 0;
    while !shared.is_over.load(Ordering::Relaxed) {
        let read = source.next_frame(REST);
        *shared.remarks.lock().unwrap_or_else(PoisonError::into_inner) = source.remarks();
        match read {
            Ok(None) if source.is_over() => return Err(SourceError::Over),
            Ok(None) => {}
            Ok(Some(reading)) => {
                failures = 0;
                shared.read.fetch_add(1, Ordering::Relaxed);
                match sender.try_send(reading) {
                    Ok(()) => {}
                    Err(TrySendError::Full(_)) => {
                        shared.missed.fetch_add(1, Ordering::Relaxed);
                    }
                    Err(TrySendError::Disconnected(_)) => break,
                }
            }
            Err(error) => {
                failures += 1;
                shared.failed.fetch_add(1, Ordering::Relaxed);
                *shared.last_failure.lock().unwrap_or_else(PoisonError::into_inner) = Some(error.to_string());
                if failures == MOST_FAILURES {
                    return Err(error);
                }
                std::thread::sleep(REST);
            }
        }
    }
    source.stop()
}
