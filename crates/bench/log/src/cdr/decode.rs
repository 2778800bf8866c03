//! Bytes in, values out. Nothing is believed: each element asks for its bytes.

use super::ENCAPSULATION;

/// Takes one message apart; `None` where its bytes end too early or make no sense.
pub(crate) struct Decoder<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Decoder<'a> {
    pub(crate) fn new(message: &'a [u8]) -> Option<Self> {
        let bytes = message.strip_prefix(&ENCAPSULATION)?;
        Some(Self { bytes, at: 0 })
    }

    fn take<const N: usize>(&mut self) -> Option<[u8; N]> {
        self.at = self.at.next_multiple_of(N);
        let number = self.bytes.get(self.at..)?.first_chunk()?;
        self.at += N;
        Some(*number)
    }

    pub(crate) fn u8(&mut self) -> Option<u8> {
        self.take().map(u8::from_le_bytes)
    }

    pub(crate) fn i32(&mut self) -> Option<i32> {
        self.take().map(i32::from_le_bytes)
    }

    pub(crate) fn u32(&mut self) -> Option<u32> {
        self.take().map(u32::from_le_bytes)
    }

    pub(crate) fn i64(&mut self) -> Option<i64> {
        self.take().map(i64::from_le_bytes)
    }

    pub(crate) fn u64(&mut self) -> Option<u64> {
        self.take().map(u64::from_le_bytes)
    }

    pub(crate) fn f64(&mut self) -> Option<f64> {
        self.take().map(f64::from_le_bytes)
    }

    pub(crate) fn string(&mut self) -> Option<&'a str> {
        let length = usize::try_from(self.u32()?).ok()?;
        let text = self.bytes.get(self.at..)?.get(..length)?;
        self.at += length;
        std::str::from_utf8(text.strip_suffix(&[0])?).ok()
    }

    /// A sequence as long as it says, or none: memory grows with the bytes that are there.
    pub(crate) fn sequence<T>(&mut self, take: impl Fn(&mut Self) -> Option<T>) -> Option<Vec<T>> {
        let length = self.u32()?;
        let mut elements = Vec::new();
        for _ in 0..length {
            elements.push(take(self)?);
        }
        Some(elements)
    }
}
