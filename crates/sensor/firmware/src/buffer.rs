//! A buffer of fixed size for bytes to the line.

use core::fmt;

/// A buffer of up to `B` bytes. Bytes that do not fit are left out, and [`is_full`](Self::is_full)
/// then returns true.
#[derive(Clone, Debug)]
pub struct Buffer<const B: usize> {
    bytes: [u8; B],
    len: usize,
    is_full: bool,
}

impl<const B: usize> Default for Buffer<B> {
    fn default() -> Self {
        Self::new()
    }
}

impl<const B: usize> Buffer<B> {
    /// An empty buffer.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            bytes: [0; B],
            len: 0,
            is_full: false,
        }
    }

    /// The bytes in the buffer.
    #[must_use]
    pub fn as_bytes(&self) -> &[u8] {
        self.bytes.get(..self.len).unwrap_or_default()
    }

    /// Whether bytes did not fit.
    #[must_use]
    pub const fn is_full(&self) -> bool {
        self.is_full
    }

    pub(crate) fn push(&mut self, byte: u8) {
        match self.bytes.get_mut(self.len) {
            Some(place) => {
                *place = byte;
                self.len += 1;
            }
            None => self.is_full = true,
        }
    }

    pub(crate) fn extend(&mut self, bytes: &[u8]) {
        for byte in bytes {
            self.push(*byte);
        }
    }

    pub(crate) const fn len(&self) -> usize {
        self.len
    }

    /// Overwrites a byte that is there.
    pub(crate) fn set(&mut self, index: usize, byte: u8) {
        if let Some(place) = self.bytes.get_mut(index) {
            *place = byte;
        }
    }
}

impl<const B: usize> fmt::Write for Buffer<B> {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        self.extend(text.as_bytes());
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use core::fmt::Write;

    use super::*;

    #[test]
    fn what_does_not_fit_is_left_out_and_said() {
        let mut buffer = Buffer::<4>::new();
        assert!(write!(buffer, "{}", 123).is_ok());
        assert_eq!((buffer.as_bytes(), buffer.is_full()), (b"123".as_slice(), false));
        buffer.extend(b"45");
        assert_eq!((buffer.as_bytes(), buffer.is_full()), (b"1234".as_slice(), true));
    }
}
