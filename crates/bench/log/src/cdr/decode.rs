//! Decodes bytes to values. The content is not trusted: each element is checked against the bytes
//! that are left.

use super::ENCAPSULATION;

/// Decodes one message. Returns `None` if its bytes end too early or are not valid.
pub(crate) struct Decoder<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Decoder<'a> {
    pub(crate) fn new(message: &'a [u8]) -> Option<Self> {
        let bytes = message.strip_prefix(&ENCAPSULATION)?;
        Some(Self { bytes, at: 0 })
    }

    /// Decodes a message of another program, which may set options in its first bytes. The options
    /// are not needed for reading.
    pub(crate) fn of_others(message: &'a [u8]) -> Option<Self> {
        let [first, second, _, _] = ENCAPSULATION;
        match message.split_first_chunk()? {
            ([one, other, _, _], bytes) if [*one, *other] == [first, second] => Some(Self { bytes, at: 0 }),
            _ => None,
        }
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

    pub(crate) fn i8(&mut self) -> Option<i8> {
        self.take().map(i8::from_le_bytes)
    }

    pub(crate) fn i16(&mut self) -> Option<i16> {
        self.take().map(i16::from_le_bytes)
    }

    pub(crate) fn u16(&mut self) -> Option<u16> {
        self.take().map(u16::from_le_bytes)
    }

    pub(crate) fn f32(&mut self) -> Option<f32> {
        self.take().map(f32::from_le_bytes)
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

    /// Skips a text of any content.
    pub(crate) fn skip_text(&mut self) -> Option<()> {
        let length = usize::try_from(self.u32()?).ok()?;
        self.skip(length, 1)
    }

    /// Skips `length` numbers of `size` bytes.
    pub(crate) fn skip(&mut self, length: usize, size: usize) -> Option<()> {
        if length > 0 {
            let end = self
                .at
                .next_multiple_of(size)
                .checked_add(length.checked_mul(size)?)?;
            self.at = (end <= self.bytes.len()).then_some(end)?;
        }
        Some(())
    }

    /// A sequence of the stated length, or `None`. Memory grows only with the bytes that exist.
    pub(crate) fn sequence<T>(&mut self, take: impl Fn(&mut Self) -> Option<T>) -> Option<Vec<T>> {
        let length = self.u32()?;
        let mut elements = Vec::new();
        for _ in 0..length {
            elements.push(take(self)?);
        }
        Some(elements)
    }
}
