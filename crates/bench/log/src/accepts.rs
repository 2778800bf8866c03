//! Checks of messages before they are written.

use crate::{Body, Description, LogError, Message};

/// The properties of the description that every message must match.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Accepts {
    taxels: usize,
    start_unix_ns: u64,
}

impl Accepts {
    pub(crate) fn new(description: &Description) -> Self {
        Self {
            taxels: description.taxels.len(),
            start_unix_ns: description.start_unix_ns,
        }
    }

    /// Returns the message's time on the wall clock, ns, if the message can be written.
    ///
    /// # Errors
    /// [`LogError::Invalid`]: a frame with another number of taxels, an event that cannot be JSON,
    /// or a time beyond 64 bits.
    pub(crate) fn check(&self, message: &Message) -> Result<u64, LogError> {
        let invalid = |what, problem: String| Err(LogError::Invalid { what, problem });
        match &message.body {
            Body::Tactile(frame) if frame.taxels.len() != self.taxels => {
                let (found, expected) = (frame.taxels.len(), self.taxels);
                let problem = format!("has {found} taxels, expected {expected}");
                return invalid("tactile frame", problem);
            }
            Body::Event(event) if !event.is_finite() => {
                return invalid("event", "a number is not finite".to_owned());
            }
            _ => {}
        }
        match self.start_unix_ns.checked_add(message.bench_ns) {
            Some(unix_ns) => Ok(unix_ns),
            None => invalid("bench_ns", "the time is beyond 64 bits".to_owned()),
        }
    }
}
