//! What gives frames.

use std::time::Duration;

use twintac_log::TactileFrame;

use crate::SourceError;

/// A frame as it is handed out.
#[derive(Clone, Debug, PartialEq)]
pub struct Reading {
    /// Its number, of all that were asked for or sent: numbers that are missing were missed, or lost on the way.
    pub sequence: u64,
    /// When the taxels were triggered, s of the bench's clock.
    pub bench_s: f64,
    /// What they gave.
    pub frame: TactileFrame,
}

/// Gives frames of a tactile sensor, one after the other.
pub trait TactileSource: Send {
    /// The next frame, or `None` if none comes for so long. A source that is asked for each frame, such as a bus, takes as long as it takes.
    ///
    /// # Errors
    /// What stops all taxels. The next call begins anew.
    fn next_frame(&mut self, patience: Duration) -> Result<Option<Reading>, SourceError>;

    /// What was on the wire so far besides frames, a sentence each; empty if all was well.
    fn remarks(&self) -> Vec<String> {
        Vec::new()
    }

    /// Whether no further frame will come.
    fn is_over(&self) -> bool {
        false
    }

    /// Lets go of the wire.
    ///
    /// # Errors
    /// What the wire says.
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
