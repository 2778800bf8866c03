//! A cursor over a `.msh` file that tracks its position.

use crate::MeshError;

/// How numbers are written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Encoding {
    Text,
    LittleEndian,
    BigEndian,
}

/// A position in a file, and the encoding of what follows.
pub(super) struct Input<'a> {
    bytes: &'a [u8],
    at: usize,
    pub(super) encoding: Encoding,
}

impl<'a> Input<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        Self {
            bytes,
            at: 0,
            encoding: Encoding::Text,
        }
    }

    /// Number of bytes read so far.
    pub(super) fn position(&self) -> usize {
        self.at
    }

    /// An error at this position: something else was expected.
    pub(super) fn error<T>(&self, expected: &str, found: impl Into<String>) -> Result<T, MeshError> {
        self.error_at(self.at, expected, found)
    }

    /// An error at another position: something else was expected.
    pub(super) fn error_at<T>(
        &self,
        at: usize,
        expected: &str,
        found: impl Into<String>,
    ) -> Result<T, MeshError> {
        let place = if self.encoding == Encoding::Text {
            format!(
                "line {}",
                1 + self.bytes[..at].iter().filter(|&&byte| byte == b'\n').count()
            )
        } else {
            format!("byte {at}")
        };
        Err(MeshError::File {
            place,
            expected: expected.to_owned(),
            found: found.into(),
        })
    }

    /// The next word of text, without moving past it; empty at the end of the file.
    fn peek(&self) -> (usize, &'a [u8]) {
        let rest = &self.bytes[self.at..];
        let skipped = rest.iter().take_while(|byte| byte.is_ascii_whitespace()).count();
        let length = rest[skipped..]
            .iter()
            .take_while(|byte| !byte.is_ascii_whitespace())
            .count();
        (self.at + skipped + length, &rest[skipped..skipped + length])
    }

    /// The next word of text, moving past it; `None` at the end of the file.
    pub(super) fn word(&mut self) -> Option<&'a [u8]> {
        let (end, word) = self.peek();
        self.at = end;
        (!word.is_empty()).then_some(word)
    }

    /// A number that is written as text, whatever the encoding.
    pub(super) fn text_number<N: std::str::FromStr>(&mut self, expected: &str) -> Result<N, MeshError> {
        let (end, word) = self.peek();
        match std::str::from_utf8(word).ok().and_then(|word| word.parse().ok()) {
            Some(number) => {
                self.at = end;
                Ok(number)
            }
            None => self.error_at(end - word.len(), expected, shown(word)),
        }
    }

    /// A quoted name, to the end of its line.
    pub(super) fn quoted(&mut self) -> Result<&'a [u8], MeshError> {
        let (end, word) = self.peek();
        let Some(&b'"') = word.first() else {
            return self.error("a name in quotes", shown(word));
        };
        let start = end - word.len() + 1;
        match self.bytes[start..].iter().position(|&byte| byte == b'"') {
            Some(length) => {
                self.at = start + length + 1;
                Ok(&self.bytes[start..start + length])
            }
            None => self.error("a closing quote", "the end of the file"),
        }
    }

    /// Moves past the end of the line, where binary data start.
    pub(super) fn end_line(&mut self) -> Result<(), MeshError> {
        let rest = &self.bytes[self.at..];
        let blanks = rest
            .iter()
            .take_while(|&&byte| byte.is_ascii_whitespace() && byte != b'\n')
            .count();
        match rest.get(blanks) {
            Some(b'\n') => {
                self.at += blanks + 1;
                Ok(())
            }
            other => self.error(
                "the end of the line",
                other.map_or("the end of the file".to_owned(), |b| shown(&[*b])),
            ),
        }
    }

    /// Moves past the line that ends a section.
    pub(super) fn skip_section(&mut self, name: &str) -> Result<(), MeshError> {
        let end = format!("\n$End{name}");
        // The line break before it may just have been passed.
        let from = self.at.saturating_sub(1);
        match self.bytes[from..]
            .windows(end.len())
            .position(|window| window == end.as_bytes())
        {
            Some(offset) => {
                self.at = from + offset + end.len();
                Ok(())
            }
            None => self.error(&format!("`$End{name}`"), "the end of the file"),
        }
    }

    /// Moves past `$End<name>`, which must come next.
    pub(super) fn end_section(&mut self, name: &str) -> Result<(), MeshError> {
        let (end, word) = self.peek();
        if word.strip_prefix(b"$End") == Some(name.as_bytes()) {
            self.at = end;
            return Ok(());
        }
        self.error_at(end - word.len(), &format!("`$End{name}`"), shown(word))
    }

    /// An integer of four bytes in binary files.
    pub(super) fn int(&mut self, expected: &str) -> Result<i64, MeshError> {
        match self.encoding {
            Encoding::Text => self.text_number(expected),
            Encoding::LittleEndian => Ok(i64::from(i32::from_le_bytes(self.raw(expected)?))),
            Encoding::BigEndian => Ok(i64::from(i32::from_be_bytes(self.raw(expected)?))),
        }
    }

    /// An integer of eight bytes in binary files.
    pub(super) fn size(&mut self, expected: &str) -> Result<u64, MeshError> {
        match self.encoding {
            Encoding::Text => self.text_number(expected),
            Encoding::LittleEndian => Ok(u64::from_le_bytes(self.raw(expected)?)),
            Encoding::BigEndian => Ok(u64::from_be_bytes(self.raw(expected)?)),
        }
    }

    /// A floating-point number.
    pub(super) fn real(&mut self, expected: &str) -> Result<f64, MeshError> {
        match self.encoding {
            Encoding::Text => self.text_number(expected),
            Encoding::LittleEndian => Ok(f64::from_le_bytes(self.raw(expected)?)),
            Encoding::BigEndian => Ok(f64::from_be_bytes(self.raw(expected)?)),
        }
    }

    /// Checks that the file is long enough for `count` items of `numbers_each` numbers, so that no
    /// count of a file is trusted.
    pub(super) fn fits(&self, count: u64, numbers_each: u64, expected: &str) -> Result<usize, MeshError> {
        // A number takes at least two bytes of text (a digit and a blank), or four bytes in binary.
        let least = if self.encoding == Encoding::Text { 2 } else { 4 };
        let left = (self.bytes.len() - self.at) as u64 + 1;
        let needed = count.saturating_mul(numbers_each.saturating_mul(least));
        match usize::try_from(count) {
            Ok(count) if needed <= left => Ok(count),
            _ => self.error(
                expected,
                format!("{count}, more than the rest of the file can hold"),
            ),
        }
    }

    pub(super) fn raw<const N: usize>(&mut self, expected: &str) -> Result<[u8; N], MeshError> {
        let bytes = self.bytes.get(self.at..).and_then(|rest| rest.first_chunk::<N>());
        match bytes {
            Some(bytes) => {
                self.at += N;
                Ok(*bytes)
            }
            None => self.error(expected, "the end of the file"),
        }
    }
}

/// Bytes as shown in a message, shortened.
pub(super) fn shown(word: &[u8]) -> String {
    if word.is_empty() {
        return "the end of the file".to_owned();
    }
    format!(
        "`{}`",
        String::from_utf8_lossy(&word[..word.len().min(40)]).escape_debug()
    )
}
