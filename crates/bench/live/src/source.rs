//! Frames from a thread of their own.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, TrySendError, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use embedded_hal::delay::DelayNs;
use embedded_hal::i2c::I2c;
use phystac::Clock;

use crate::{FrameReader, LiveError, Reading};

/// Failures in a row after which a sensor is given up, and the time to rest after each: 2 s.
const MOST_FAILURES: u32 = 40;
const REST: Duration = Duration::from_millis(50);

/// How long a sensor may be silent: longer than it may fail, so that a failure is told with its cause.
const SILENCE: Duration = Duration::from_secs(3);

/// How long the thread may take to end.
const LEAVE: Duration = Duration::from_secs(1);

/// A thread that reads a sensor as fast as it goes, and never waits for whom it reads for.
#[derive(Debug)]
pub struct FrameSource {
    readings: Receiver<Reading>,
    shared: Arc<Shared>,
    thread: Option<JoinHandle<Result<(), LiveError>>>,
    /// When the last frame was taken, or the thread was started.
    heard: Instant,
}

/// What became of the frames so far.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// Frames that were read.
    pub read: u64,
    /// Of these, frames that found no room and are lost.
    pub missed: u64,
    /// Times that the bus gave no frame.
    pub failed: u64,
    /// Why, the last time.
    pub last_failure: Option<String>,
}

#[derive(Debug, Default)]
struct Shared {
    is_over: AtomicBool,
    read: AtomicU64,
    missed: AtomicU64,
    failed: AtomicU64,
    last_failure: Mutex<Option<String>>,
}

impl FrameSource {
    /// Frames that may wait, where nothing else is known: two seconds of a sensor.
    pub const USUAL_CAPACITY: usize = 256;

    /// Starts to read. `capacity` frames may wait to be taken; those that come while so many do are counted as missed.
    ///
    /// # Errors
    /// [`LiveError::Thread`]: there is no thread.
    pub fn start<I2C, D, C, const N: usize>(
        reader: FrameReader<I2C, D, C, N>,
        capacity: usize,
    ) -> Result<Self, LiveError>
    where
        I2C: I2c + Send + 'static,
        D: DelayNs + Send + 'static,
        C: Clock + Send + 'static,
    {
        let (sender, readings) = sync_channel(capacity);
        let shared = Arc::new(Shared::default());
        let its_shared = Arc::clone(&shared);
        let thread = std::thread::Builder::new()
            .name("frames".to_owned())
            .spawn(move || run(reader, &sender, &its_shared))
            .map_err(|error| LiveError::Thread {
                problem: error.to_string(),
            })?;
        Ok(Self {
            readings,
            shared,
            thread: Some(thread),
            heard: Instant::now(),
        })
    }

    /// The next frame, or `None` if none comes for so long.
    ///
    /// # Errors
    /// [`LiveError::Bus`]: the sensor was given up, having failed for 2 s on end or been silent for 3 s. [`LiveError::Thread`].
    pub fn next(&mut self, timeout: Duration) -> Result<Option<Reading>, LiveError> {
        match self.readings.recv_timeout(timeout) {
            Ok(reading) => {
                self.heard = Instant::now();
                Ok(Some(reading))
            }
            Err(RecvTimeoutError::Timeout) if self.heard.elapsed() >= SILENCE => Err(LiveError::Bus {
                problem: format!("none came for {} s", SILENCE.as_secs()),
            }),
            Err(RecvTimeoutError::Timeout) => Ok(None),
            Err(RecvTimeoutError::Disconnected) => {
                let ended = self.thread.take().map(JoinHandle::join);
                match ended {
                    Some(Ok(Err(error))) => Err(error),
                    _ => Err(LiveError::Thread {
                        problem: "it has ended".to_owned(),
                    }),
                }
            }
        }
    }

    /// What became of the frames so far.
    #[must_use]
    pub fn tally(&self) -> Tally {
        let shared = &self.shared;
        let last_failure = shared.last_failure.lock().unwrap_or_else(PoisonError::into_inner);
        Tally {
            read: shared.read.load(Ordering::Relaxed),
            missed: shared.missed.load(Ordering::Relaxed),
            failed: shared.failed.load(Ordering::Relaxed),
            last_failure: last_failure.clone(),
        }
    }
}

/// Ends the thread, after the frame that it is reading. On a bus that hangs it is left to itself.
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
            let _ = thread.join(); // nobody is left to hear how it went
        }
    }
}

fn run<I2C: I2c, D: DelayNs, C: Clock, const N: usize>(
    mut reader: FrameReader<I2C, D, C, N>,
    sender: &SyncSender<Reading>,
    shared: &Shared,
) -> Result<(), LiveError> {
    let mut failures = 0;
    while !shared.is_over.load(Ordering::Relaxed) {
        match reader.read() {
            Ok(reading) => {
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
    reader.stop()
}
