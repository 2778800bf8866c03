//! A log that is written while the test setup runs.

mod recorded;
mod shared;
mod thread;

use std::path::Path;
use std::sync::Arc;
use std::sync::mpsc::{SyncSender, TrySendError, sync_channel};
use std::thread::JoinHandle;

use crate::accepts::Accepts;
use crate::sink::LogFile;
use crate::{Description, LogError, LogWriter, Message, Sink, Stream};
use shared::Shared;
use thread::Command;

pub use recorded::Recorded;

/// Room for events beyond the usual capacity: the end of a press must not be lost because the disk
/// is slow.
const EVENT_ROOM: usize = 256;

/// Writes a log on a separate thread, so that a slow disk does not delay the test setup.
///
/// Its memory is bounded: at most `capacity` messages wait, and events have additional room. A
/// message that does not fit is refused with an error and marked in the log as a gap.
#[derive(Debug)]
pub struct Recorder {
    sender: LogSender,
    thread: Option<JoinHandle<Result<Recorded, LogError>>>,
}

/// Hands messages to a [`Recorder`]. Copies hand them to the same recorder.
#[derive(Clone, Debug)]
pub struct LogSender {
    commands: SyncSender<Command>,
    shared: Arc<Shared>,
    accepts: Accepts,
    capacity: usize,
}

impl Recorder {
    /// Usual number of messages that may wait: more than one second of a force sensor at its full
    /// rate of 7 kHz.
    pub const USUAL_CAPACITY: usize = 8192;

    /// Begins a log at `path`, `<path>.partial` until it is finished.
    ///
    /// # Errors
    /// As [`LogFile::create`] and [`LogWriter::new`].
    pub fn create(path: &Path, description: &Description) -> Result<Self, LogError> {
        Self::start(LogFile::create(path)?, description, Self::USUAL_CAPACITY)
    }

    /// Begins a log on any sink; `capacity` messages may wait.
    ///
    /// # Errors
    /// As [`LogWriter::new`]; no thread can be started.
    pub fn start(
        sink: impl Sink + Send + 'static,
        description: &Description,
        capacity: usize,
    ) -> Result<Self, LogError> {
        let file = sink.name();
        let writer = LogWriter::new(sink, description)?;
        let (commands, receiver) = sync_channel(capacity + EVENT_ROOM);
        let shared = Arc::new(Shared::default());
        let its_shared = Arc::clone(&shared);
        let thread = std::thread::Builder::new()
            .name("log".to_owned())
            .spawn(move || thread::run(writer, &receiver, &its_shared))
            .map_err(|source| LogError::Write { file, source })?;
        let sender = LogSender {
            commands,
            shared,
            accepts: Accepts::new(description),
            capacity,
        };
        Ok(Self {
            sender,
            thread: Some(thread),
        })
    }

    /// A sender for this log.
    #[must_use]
    pub fn sender(&self) -> LogSender {
        self.sender.clone()
    }

    /// Writes all waiting messages and finishes the log. Its senders refuse messages from now on.
    ///
    /// # Errors
    /// [`LogError::Write`]: the log could not be written to its end. What was flushed before is
    /// readable.
    pub fn finish(mut self) -> Result<Recorded, LogError> {
        self.close().unwrap_or_else(|| {
            Err(LogError::Stopped {
                why: "its thread has ended".to_owned(),
            })
        })
    }

    fn close(&mut self) -> Option<Result<Recorded, LogError>> {
        let thread = self.thread.take()?;
        self.sender.shared.stop("it was finished");
        // Waits for room. Fails if the thread has ended before; its result then says why.
        let _ = self.sender.commands.send(Command::Finish);
        thread.join().ok()
    }
}

/// Finishes the log as far as possible.
impl Drop for Recorder {
    fn drop(&mut self) {
        let _ = self.close();
    }
}

impl LogSender {
    /// Hands a message over, and never waits.
    ///
    /// # Errors
    /// [`LogError::Invalid`]: this message cannot be written; see [`LogWriter::write`].
    /// [`LogError::Behind`]: too many messages wait, and this one is lost; later ones may be
    /// accepted. [`LogError::Stopped`]: no more messages are accepted.
    pub fn send(&self, message: Message) -> Result<(), LogError> {
        let _running = self.shared.running()?;
        self.accepts.check(&message)?;
        let stream = message.stream();
        let room = match stream {
            Stream::Event => self.capacity + EVENT_ROOM,
            _ => self.capacity,
        };
        let bench_ns = message.bench_ns;
        let sent = match self.shared.reserve(room) {
            true => self.commands.try_send(Command::Write(message)),
            false => Err(TrySendError::Full(Command::Write(message))),
        };
        match sent {
            Ok(()) => Ok(()),
            Err(TrySendError::Full(_)) => {
                self.shared.lose(stream, bench_ns);
                let queued = self.shared.queued();
                Err(LogError::Behind { stream, queued })
            }
            Err(TrySendError::Disconnected(_)) => Err(LogError::Stopped {
                why: "its thread has ended".to_owned(),
            }),
        }
    }

    /// Number of messages that wait to be written.
    #[must_use]
    pub fn queued(&self) -> usize {
        self.shared.queued()
    }
}
