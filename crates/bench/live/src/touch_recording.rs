//! Records frames as they come.

use std::path::{Path, PathBuf};

use twintac_log::{Body, Event, LogError, LogSender, Message, Recorder, Stream, export_frames};
use twintac_source::Reading;

use crate::{About, LiveError};

/// Largest number of file names that are tried.
const MOST_FILES: u32 = 10_000;

/// A log of frames that is being written.
#[derive(Debug)]
pub struct TouchRecording {
    recorder: Recorder,
    sender: LogSender,
    path: PathBuf,
    frames: u64,
    /// Number and time of the last frame.
    last: Option<(u64, f64)>,
}

impl TouchRecording {
    /// Begins `touch-0001.mcap` in a folder, or the first free number after it.
    ///
    /// # Errors
    /// [`LiveError::Log`].
    pub fn begin(folder: &Path, about: &About) -> Result<Self, LiveError> {
        let name = |number: u32| folder.join(format!("touch-{number:04}.mcap"));
        let mut path = name(1);
        for number in 1..MOST_FILES {
            path = name(number);
            match Self::create(&path, about) {
                Err(LiveError::Log(LogError::Exists { .. })) => {}
                begun => return begun,
            }
        }
        let file = path.display().to_string();
        Err(LogError::Exists { file }.into())
    }

    /// Begins a file; its name ends in `.partial` until it is finished.
    ///
    /// # Errors
    /// [`LiveError::Log`]: it exists already, or cannot be written.
    pub fn create(path: &Path, about: &About) -> Result<Self, LiveError> {
        let recorder = Recorder::create(path, &about.description())?;
        Ok(Self {
            sender: recorder.sender(),
            recorder,
            path: path.to_owned(),
            frames: 0,
            last: None,
        })
    }

    /// Its file.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Frames that were handed over.
    #[must_use]
    pub fn frames(&self) -> u64 {
        self.frames
    }

    /// Hands a frame to the log, and never waits. Frames that are missing before it are marked.
    ///
    /// # Errors
    /// [`LiveError::Log`]: the disk is too slow, which the log marks as a gap, or fails.
    pub fn push(&mut self, reading: &Reading) -> Result<(), LiveError> {
        if let Some((sequence, last_s)) = self.last
            && reading.sequence > sequence + 1
        {
            let gap = Event::Gap {
                stream: Some(Stream::Tactile),
                cause: "frames were missed, or the bus gave none".to_owned(),
                from_ns: bench_ns(last_s),
                to_ns: bench_ns(reading.bench_s),
                lost: Some(reading.sequence - sequence - 1),
            };
            self.sender.send(Message::at_s(last_s, Body::Event(gap)))?;
        }
        self.sender.send(Message::at_s(
            reading.bench_s,
            Body::Tactile(reading.frame.clone()),
        ))?;
        self.last = Some((reading.sequence, reading.bench_s));
        self.frames += 1;
        Ok(())
    }

    /// Writes the waiting frames, gives the file its final name, and writes a table of its frames
    /// beside it, with the ending `.parquet`. Returns the number of frames.
    ///
    /// # Errors
    /// [`LiveError::Log`].
    pub fn finish(self) -> Result<u64, LiveError> {
        self.recorder.finish()?;
        let table = self.path.with_extension("parquet");
        Ok(export_frames(&self.path, &table)?.frames)
    }
}

fn bench_ns(bench_s: f64) -> u64 {
    (1e9 * bench_s).round() as u64 // negative gives 0
}
