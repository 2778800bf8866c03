//! Plays the frames of a log again.

use std::path::Path;
use std::time::{Duration, Instant};

use twintac_log::{Body, Description, LogReader, TactileFrame};

use crate::{Reading, SourceError, TactileSource};

/// Plays the frames of a log, at the pace of the recording or without waiting.
#[derive(Debug)]
pub struct ReplaySource {
    description: Description,
    frames: Vec<(f64, TactileFrame)>,
    played: usize,
    /// When playing began. `None` if it does not wait.
    begun: Option<Instant>,
}

impl ReplaySource {
    /// Reads a log (MCAP). Plays it at the pace of the recording if `at_its_pace`, else as fast as
    /// frames are requested.
    ///
    /// # Errors
    /// A log that cannot be read, or has no frames.
    pub fn open(path: &Path, at_its_pace: bool) -> Result<Self, SourceError> {
        let mut log = LogReader::open(path)?;
        let description = log.description().clone();
        let mut frames = Vec::new();
        for message in &mut log {
            let message = message?;
            if let Body::Tactile(frame) = message.body {
                frames.push((message.bench_ns as f64 * 1e-9, frame));
            }
        }
        if frames.is_empty() {
            return Err(SourceError::Open {
                wire: path.display().to_string(),
                problem: "it has no frames of a tactile sensor".to_owned(),
            });
        }
        Ok(Self {
            description,
            frames,
            played: 0,
            begun: at_its_pace.then(Instant::now),
        })
    }

    /// The description in the log.
    #[must_use]
    pub fn description(&self) -> &Description {
        &self.description
    }
}

impl TactileSource for ReplaySource {
    fn next_frame(&mut self, patience: Duration) -> Result<Option<Reading>, SourceError> {
        let Some((bench_s, frame)) = self.frames.get(self.played) else {
            return Ok(None);
        };
        if let Some(begun) = self.begun {
            let due = Duration::from_secs_f64((bench_s - self.frames[0].0).max(0.0));
            let left = due.saturating_sub(begun.elapsed());
            std::thread::sleep(left.min(patience));
            if left > patience {
                return Ok(None);
            }
        }
        let sequence = self.played as u64;
        self.played += 1;
        Ok(Some(Reading {
            sequence,
            bench_s: *bench_s,
            frame: frame.clone(),
        }))
    }

    fn is_over(&self) -> bool {
        self.played == self.frames.len()
    }
}
