//! The trait of sources of frames.

use std::time::Duration;

use twintac_log::TactileFrame;

use crate::SourceError;

/// A frame as a source returns it.
#[derive(Clone, Debug, PartialEq)]
pub struct Reading {
    /// The number of the frame, counting all that were requested or sent. A number that is missing
    /// was missed, or lost on the way.
    pub sequence: u64,
    /// When the taxels were triggered, s of the bench clock.
    pub bench_s: f64,
    /// The readings of the taxels.
    pub frame: TactileFrame,
}

/// Gives frames of a tactile sensor, one after the other.
pub trait TactileSource: Send {
    /// The next frame, or `None` if none comes within `patience`. A source that must request each
    /// frame, such as a bus, takes as long as that takes.
    ///
    /// # Errors
    /// An error that affects all taxels. The next call starts again.
    fn next_frame(&mut self, patience: Duration) -> Result<Option<Reading>, SourceError>;

    /// What was on the connection so far besides frames, one sentence each. Empty if all was well.
    fn remarks(&self) -> Vec<String> {
        Vec::new()
    }

    /// Whether no further frame will come.
    fn is_over(&self) -> bool {
        false
    }

    /// Releases the connection.
    ///
    /// # Errors
    /// An error of the connection.
    fn stop(&mut self) -> Result<(), SourceError> {
        Ok(())
    }
}

impl<S: TactileSource + ?Sized> TactileSource for Box<S> {
    fn next_frame(&mut self, patience: Duration) -> Result<Option<Reading>, SourceError> {
        (**self).next_frame(patience)
    }

    fn remarks(&self) -> Vec<String> {
        (**self).remarks()
    }

    fn is_over(&self) -> bool {
        (**self).is_over()
    }

    fn stop(&mut self) -> Result<(), SourceError> {
        (**self).stop()
    }
}
