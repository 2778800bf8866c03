//! Splits a byte stream into frames.

use crate::{Device, RigError};

/// Cuts frames that say their own size out of a stream, however the stream's reads fall on them.
///
/// It never holds more than one frame, nor a frame larger than its bound. A stream without marks cannot be found again
/// once a size is wrong: the splitter then reports the same error for ever, and the connection has to be made anew.
#[derive(Clone, Debug)]
pub struct Splitter {
    device: Device,
    header_bytes: usize,
    /// Size of the whole frame, from its header.
    frame_bytes: fn(&[u8]) -> usize,
    smallest: usize,
    largest: usize,
    held: Vec<u8>,
}

impl Splitter {
    pub(crate) fn new(
        device: Device,
        header_bytes: usize,
        frame_bytes: fn(&[u8]) -> usize,
        smallest: usize,
        largest: usize,
    ) -> Self {
        debug_assert!(header_bytes <= smallest && smallest <= largest);
        Self {
            device,
            header_bytes,
            frame_bytes,
            smallest,
            largest,
            held: Vec::with_capacity(largest),
        }
    }

    /// Takes bytes off the front until a frame is whole; `None` when it needs more bytes. To be called until then.
    ///
    /// # Errors
    /// A frame that says to be smaller or larger than any can be.
    pub fn take(&mut self, bytes: &mut &[u8]) -> Result<Option<Vec<u8>>, RigError> {
        self.fill(self.header_bytes, bytes);
        if self.held.len() < self.header_bytes {
            return Ok(None);
        }
        let size = (self.frame_bytes)(&self.held);
        if !(self.smallest..=self.largest).contains(&size) {
            let expected = format!("{} to {} bytes", self.smallest, self.largest);
            return Err(RigError::malformed(self.device, "frame size", expected, size));
        }
        self.fill(size, bytes);
        if self.held.len() < size {
            return Ok(None);
        }
        let frame = self.held.clone();
        self.held.clear();
        Ok(Some(frame))
    }

    /// Bytes of memory that the stream holds on to.
    #[must_use]
    pub fn capacity(&self) -> usize {
        self.held.capacity()
    }

    fn fill(&mut self, upto: usize, bytes: &mut &[u8]) {
        let taken = upto.saturating_sub(self.held.len()).min(bytes.len());
        let (front, rest) = bytes.split_at(taken);
        self.held.extend_from_slice(front);
        *bytes = rest;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn splitter() -> Splitter {
        Splitter::new(Device::Robot, 1, |header| usize::from(header[0]), 2, 8)
    }

    #[test]
    fn frames_come_out_however_the_reads_fall() {
        let stream = [3, 1, 2, 2, 9, 4, 7, 7, 7];
        for size in 1..=stream.len() {
            let mut splitter = splitter();
            let mut frames = Vec::new();
            for mut chunk in stream.chunks(size) {
                while let Some(frame) = splitter.take(&mut chunk).unwrap() {
                    frames.push(frame);
                }
            }
            assert_eq!(frames, [vec![3, 1, 2], vec![2, 9], vec![4, 7, 7, 7]]);
        }
    }

    #[test]
    fn a_lost_stream_stays_lost() {
        let mut splitter = splitter();
        for mut bytes in [[9_u8, 0, 0].as_slice(), &[2, 1]] {
            let error = splitter.take(&mut bytes).unwrap_err().to_string();
            assert_eq!(error, "robot: frame size: expected 2 to 8 bytes, found 9");
        }
    }
}
