//! The bytes of a file from first to last. Some of them can be read again.

use std::io::{self, Read};

/// Number of bytes that are read at once during a search.
const BLOCK_BYTES: u64 = 64 << 10;

/// Reads once, and computes the checksum of what was read since the last [`Self::begin_section`].
#[derive(Debug)]
pub(super) struct Source<R> {
    inner: R,
    /// Bytes that were given back, and the index of the first one that is left.
    ahead: Vec<u8>,
    at: usize,
    checksum: crc32fast::Hasher,
}

impl<R: Read> Source<R> {
    pub(super) fn new(inner: R) -> Self {
        Self {
            inner,
            ahead: Vec::new(),
            at: 0,
            checksum: crc32fast::Hasher::new(),
        }
    }

    /// Appends bytes to a buffer, which grows only with bytes that exist. False if they end too
    /// early.
    pub(super) fn read(&mut self, length: u64, buffer: &mut Vec<u8>) -> io::Result<bool> {
        let start = buffer.len();
        let waiting = &self.ahead[self.at..];
        let from_ahead = waiting.len().min(usize::try_from(length).unwrap_or(usize::MAX));
        buffer.extend_from_slice(&waiting[..from_ahead]);
        self.at += from_ahead;
        let left = length - from_ahead as u64;
        let come = (&mut self.inner).take(left).read_to_end(buffer)?;
        self.checksum.update(&buffer[start..]);
        Ok(come as u64 == left)
    }

    /// Skips bytes. False if they end too early.
    pub(super) fn skip(&mut self, length: u64) -> io::Result<bool> {
        let (mut left, mut block) = (length, Vec::new());
        while left > 0 {
            block.clear();
            let next = left.min(BLOCK_BYTES);
            if !self.read(next, &mut block)? {
                return Ok(false);
            }
            left -= next;
        }
        Ok(true)
    }

    /// Restarts the checksum.
    pub(super) fn begin_section(&mut self) {
        self.checksum.reset();
    }

    /// The checksum of the section up to here.
    pub(super) fn checksum(&self) -> crc32fast::Hasher {
        self.checksum.clone()
    }

    /// Moves to the first position in `seen` or after it at which `is_found` returns true.
    /// `is_found` gets at least `lookahead` bytes, except at the end of the file. False if there is
    /// no such position.
    pub(super) fn go_to(
        &mut self,
        seen: Vec<u8>,
        lookahead: usize,
        is_found: impl Fn(&[u8]) -> bool,
    ) -> io::Result<bool> {
        let mut window = seen;
        loop {
            let is_last = !self.read(BLOCK_BYTES, &mut window)?;
            let places = if is_last {
                window.len()
            } else {
                (window.len() + 1).saturating_sub(lookahead)
            };
            if let Some(place) = (0..places).find(|place| is_found(&window[*place..])) {
                window.drain(..place);
                window.extend_from_slice(&self.ahead[self.at..]);
                (self.ahead, self.at) = (window, 0);
                return Ok(true);
            }
            if is_last {
                return Ok(false);
            }
            window.drain(..places);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_looked_for_is_read_next_wherever_it_is() {
        for place in [0, 5, 65_530, 65_536, 200_000] {
            let mut bytes = vec![1; 300_000];
            bytes[place..place + 4].copy_from_slice(&[9, 8, 7, 6]);
            let mut source = Source::new(&bytes[..]);
            let mut seen = Vec::new();
            source.read(place.min(3) as u64, &mut seen).unwrap();
            assert!(
                source
                    .go_to(seen, 4, |bytes| bytes.starts_with(&[9, 8, 7, 6]))
                    .unwrap()
            );
            let mut next = Vec::new();
            assert!(source.read(6, &mut next).unwrap());
            assert_eq!(next, [9, 8, 7, 6, 1, 1], "{place}");
            assert!(source.skip(300_000 - place as u64 - 6).unwrap());
            assert!(!source.skip(1).unwrap());
        }
        assert!(
            !Source::new(&[1; 9][..])
                .go_to(Vec::new(), 4, |bytes| bytes[0] == 9)
                .unwrap()
        );
    }
}
