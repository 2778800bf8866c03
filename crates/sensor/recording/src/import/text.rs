//! Text files as loggers write them: in any usual encoding, with lines before the header, and cut
//! off where the logger stopped.

use std::borrow::Cow;
use std::path::Path;

use crate::RecordingError;

/// Number of bytes that are examined to recognise UTF-16 without a byte-order mark.
const LOOKED_AT: usize = 64;

/// Formats of files that are not texts, and the bytes that they start with.
const PACKED: [(&str, &[u8]); 8] = [
    ("gzip", b"\x1f\x8b"),
    ("zip", b"PK\x03\x04"),
    ("Zstandard", b"\x28\xb5\x2f\xfd"),
    ("xz", b"\xfd7zXZ"),
    ("bzip2", b"BZh"),
    ("7z", b"7z\xbc\xaf"),
    ("HDF5", b"\x89HDF\r\n"),
    ("LZ4", b"\x04\x22\x4d\x18"),
];

/// The text of a file after the lines that are skipped.
pub(crate) struct Text {
    /// The text in UTF-8.
    bytes: Vec<u8>,
    start: usize,
    /// Number of lines before `start`.
    pub(crate) skipped_lines: u64,
    /// Whether the last line has no line end: the logger may have stopped in it.
    pub(crate) is_cut: bool,
    /// Notes for people on how it was read.
    pub(crate) notes: Vec<String>,
}

impl Text {
    /// Reads a file without its first lines.
    pub(crate) fn read(path: &Path, skip_lines: u64) -> Result<Self, RecordingError> {
        let mut bytes = std::fs::read(path).map_err(|source| RecordingError::read(path, source))?;
        let packed = PACKED.iter().find(|(_, start)| bytes.starts_with(start));
        if let Some((format, _)) = packed {
            return Err(RecordingError::Implausible {
                file: path.display().to_string(),
                problem: format!("is not a text, but packed ({format}); unpack it first"),
            });
        }
        let mut notes = Vec::new();
        if let Cow::Owned(decoded) = decode(&bytes, &mut notes) {
            bytes = decoded;
        }
        let end = bytes
            .iter()
            .rposition(|&byte| byte != 0)
            .map_or(0, |last| last + 1);
        let n_zeros = bytes.len() - end;
        if n_zeros > 0 {
            notes.push(format!(
                "ends with {n_zeros} bytes of zero, as after a crash; left out"
            ));
            bytes.truncate(end);
        }
        let mut start = if bytes.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 };
        let mut skipped_lines = 0;
        while skipped_lines < skip_lines && start < bytes.len() {
            let length = bytes[start..].iter().position(|&byte| byte == b'\n');
            start += length.map_or(bytes.len() - start, |length| length + 1);
            skipped_lines += 1;
        }
        Ok(Self {
            is_cut: bytes.last().is_some_and(|&byte| byte != b'\n' && byte != b'\r'),
            bytes,
            start,
            skipped_lines,
            notes,
        })
    }

    /// The text after the skipped lines.
    pub(crate) fn rest(&self) -> &[u8] {
        &self.bytes[self.start..]
    }
}

/// The text in UTF-8; borrowed if it already is UTF-8.
fn decode<'a>(bytes: &'a [u8], notes: &mut Vec<String>) -> Cow<'a, [u8]> {
    if let Some(is_little) = utf16_order(bytes) {
        notes.push("is UTF-16".to_owned());
        let unit = |pair: &[u8]| match (pair, is_little) {
            ([low, high], true) | ([high, low], false) => u16::from_be_bytes([*high, *low]),
            _ => 0,
        };
        let units = bytes.chunks(2).map(unit);
        let text: String = char::decode_utf16(units)
            .map(|character| character.unwrap_or(char::REPLACEMENT_CHARACTER))
            .filter(|&character| character != '\u{feff}')
            .collect();
        return Cow::Owned(text.into_bytes());
    }
    if std::str::from_utf8(bytes).is_ok() {
        return Cow::Borrowed(bytes);
    }
    notes.push("is not UTF-8; read as Latin-1".to_owned());
    let text: String = bytes.iter().map(|&byte| char::from(byte)).collect();
    Cow::Owned(text.into_bytes())
}

/// Whether UTF-16 text has its low byte first. `None` if the text is not UTF-16.
fn utf16_order(bytes: &[u8]) -> Option<bool> {
    match bytes {
        [0xff, 0xfe, ..] => return Some(true),
        [0xfe, 0xff, ..] => return Some(false),
        _ => (),
    }
    // Digits, separators and most letters of names have one zero byte.
    let pairs = bytes[..bytes.len().min(LOOKED_AT)].chunks_exact(2);
    let n_pairs = pairs.len();
    let count = |place: usize| {
        pairs
            .clone()
            .filter(|pair| pair[place] == 0 && pair[1 - place] != 0)
            .count()
    };
    let most = |place: usize| n_pairs > 1 && 4 * count(place) >= 3 * n_pairs;
    match [most(0), most(1)] {
        [false, true] => Some(true),
        [true, false] => Some(false),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_packed_is_said() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("log.csv");
        for (format, start) in PACKED {
            std::fs::write(&path, start).unwrap();
            let error = Text::read(&path, 0).err().unwrap().to_string();
            assert!(
                error.contains(format) && error.ends_with("unpack it first"),
                "{error}"
            );
        }
    }

    #[test]
    fn encodings_are_told_apart() {
        let text = "Zeit,Druck µ\n1.5,2\n";
        let utf16 = |order: fn(u16) -> [u8; 2]| text.encode_utf16().flat_map(order).collect::<Vec<u8>>();
        let with_mark = |mark: [u8; 2], text: Vec<u8>| [mark.to_vec(), text].concat();
        let latin: Vec<u8> = text.chars().map(|character| character as u8).collect();
        for (bytes, notes) in [
            (text.as_bytes().to_vec(), 0),
            (utf16(u16::to_le_bytes), 1),
            (utf16(u16::to_be_bytes), 1),
            (with_mark([0xff, 0xfe], utf16(u16::to_le_bytes)), 1),
            (with_mark([0xfe, 0xff], utf16(u16::to_be_bytes)), 1),
            (latin, 1),
        ] {
            let mut found = Vec::new();
            assert_eq!(decode(&bytes, &mut found), text.as_bytes());
            assert_eq!(found.len(), notes, "{found:?}");
        }
    }
}
