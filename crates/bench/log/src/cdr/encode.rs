//! Encodes values to bytes.

use super::ENCAPSULATION;

/// Appends one message to a buffer.
pub(crate) struct Encoder<'a> {
    bytes: &'a mut Vec<u8>,
    origin: usize,
}

impl<'a> Encoder<'a> {
    pub(crate) fn new(bytes: &'a mut Vec<u8>) -> Self {
        bytes.extend(ENCAPSULATION);
        let origin = bytes.len();
        Self { bytes, origin }
    }

    fn put<const N: usize>(&mut self, number: [u8; N]) {
        let beyond = (self.bytes.len() - self.origin) % N;
        if beyond > 0 {
            self.bytes.extend([0; 8].iter().take(N - beyond));
        }
        self.bytes.extend(number);
    }

    pub(crate) fn i32(&mut self, number: i32) {
        self.put(number.to_le_bytes());
    }

    pub(crate) fn u32(&mut self, number: u32) {
        self.put(number.to_le_bytes());
    }

    pub(crate) fn i64(&mut self, number: i64) {
        self.put(number.to_le_bytes());
    }

    pub(crate) fn u64(&mut self, number: u64) {
        self.put(number.to_le_bytes());
    }

    pub(crate) fn f32(&mut self, number: f32) {
        self.put(number.to_le_bytes());
    }

    pub(crate) fn f64(&mut self, number: f64) {
        self.put(number.to_le_bytes());
    }

    /// Length including the terminating zero, text, zero.
    pub(crate) fn string(&mut self, text: &str) {
        self.length(text.len() + 1);
        self.bytes.extend(text.as_bytes());
        self.bytes.push(0);
    }

    /// Length, then the elements. No padding follows the length of an empty sequence.
    pub(crate) fn sequence<T>(
        &mut self,
        elements: impl ExactSizeIterator<Item = T>,
        mut put: impl FnMut(&mut Self, T),
    ) {
        self.length(elements.len());
        for element in elements {
            put(self, element);
        }
    }

    pub(crate) fn u8(&mut self, number: u8) {
        self.bytes.push(number);
    }

    fn length(&mut self, length: usize) {
        // Taxels are few, and names and events have less than 4 GB. A longer length is read as
        // damage.
        self.u32(u32::try_from(length).unwrap_or(u32::MAX));
    }
}
