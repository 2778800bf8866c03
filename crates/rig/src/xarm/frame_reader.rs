//! Reads whole frames from a connection.

use std::io::ErrorKind;
use std::time::Instant;

use super::Wire;
use crate::{Device, RigError, Splitter};

/// A connection, and what of it was read but not used yet.
#[derive(Debug)]
pub(super) struct FrameReader<W> {
    pub(super) wire: W,
    splitter: Splitter,
    chunk: Vec<u8>,
    /// The part of the chunk that was read and not split yet.
    rest: std::ops::Range<usize>,
}

impl<W: Wire> FrameReader<W> {
    pub(super) fn new(wire: W, splitter: Splitter) -> Self {
        Self {
            wire,
            splitter,
            chunk: vec![0; 4096],
            rest: 0..0,
        }
    }

    /// The next frame; `None` if it is not whole by the deadline.
    pub(super) fn next(&mut self, deadline: Instant) -> Result<Option<Vec<u8>>, RigError> {
        loop {
            let mut bytes = &self.chunk[self.rest.clone()];
            let frame = self.splitter.take(&mut bytes);
            self.rest.start = self.rest.end - bytes.len();
            if let Some(frame) = frame? {
                return Ok(Some(frame));
            }
            let Some(left) = deadline.checked_duration_since(Instant::now()) else {
                return Ok(None);
            };
            self.wire
                .limit_reads(left)
                .map_err(|found| transport("setting a time-out", found))?;
            match self.wire.read(&mut self.chunk) {
                Ok(0) => return Err(transport("receiving", ErrorKind::UnexpectedEof.into())),
                Ok(size) => self.rest = 0..size,
                Err(found) => match found.kind() {
                    ErrorKind::WouldBlock | ErrorKind::TimedOut | ErrorKind::Interrupted => {}
                    _ => return Err(transport("receiving", found)),
                },
            }
        }
    }
}

pub(super) fn transport(what: &str, source: std::io::Error) -> RigError {
    RigError::Transport {
        device: Device::Robot,
        what: what.to_owned(),
        source,
    }
}
