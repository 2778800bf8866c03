//! Splits a byte stream into frames.

use crate::{Device, RigError};

/// Cuts a byte stream into frames that state their own size, wherever the reads of the stream begin
/// and end.
///
/// It never holds more than one frame, and never a frame larger than its bound. In a stream without
/// frame marks the next frame cannot be found after a wrong size. From then on the splitter reports
/// the same error, and the connection must be opened anew.
#[derive(Clone, Debug)]
pub struct Splitter {
    device: Device,
    header_bytes: usize,
    /// Size of the whole frame, read from its header.
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

    /// Takes bytes from the front until a frame is complete. Returns `None` if more bytes are
    /// needed. Call it until it returns `None`.
    ///
    /// # Errors
    /// A frame whose stated size is smaller or larger than any valid frame.
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

    /// Bytes of memory that the splitter holds.
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
