//! Replaces dates in files by a fixed one of the same length, so that the same board gives the same
//! bytes.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result};

/// Pattern of a date: `0` stands for any digit, `T` for itself or a blank, and other characters for
/// themselves.
const STAMP: &[u8] = b"0000-00-00T00:00:00";
const INSTEAD: &[u8] = b"1980-01-01T00:00:00";
/// The pattern in PDF files.
const PDF_STAMP: &[u8] = b"D:00000000000000";
const PDF_INSTEAD: &[u8] = b"D:19800101000000";

/// Replaces all dates of a file.
pub(crate) fn fix(path: &Path) -> Result<()> {
    let mut bytes = fs::read(path).with_context(|| format!("reading {}", path.display()))?;
    replace(&mut bytes);
    twintac_store::write_file(path, &bytes)?;
    Ok(())
}

fn replace(bytes: &mut [u8]) {
    for (form, instead) in [(STAMP, INSTEAD), (PDF_STAMP, PDF_INSTEAD)] {
        let mut at = 0;
        while at + form.len() <= bytes.len() {
            let here = &mut bytes[at..at + form.len()];
            if is_of_form(here, form) {
                for (byte, new) in here.iter_mut().zip(instead) {
                    *byte = if *byte == b' ' { b' ' } else { *new };
                }
                at += form.len();
            } else {
                at += 1;
            }
        }
    }
}

fn is_of_form(bytes: &[u8], form: &[u8]) -> bool {
    bytes.iter().zip(form).all(|(byte, form)| match form {
        b'0' => byte.is_ascii_digit(),
        b'T' => matches!(byte, b'T' | b' '),
        form => byte == form,
    })
}

#[cfg(test)]
mod tests {
    use super::replace;

    #[test]
    fn dates_become_one_date_and_nothing_else_changes() {
        let mut bytes = *b"G04 date 2026-11-27 01:04:22* (D:20261127010422Z) 2026-11-27T01:04:22+00:00 12:30";
        replace(&mut bytes);
        assert_eq!(
            bytes,
            *b"G04 date 1980-01-01 00:00:00* (D:19800101000000Z) 1980-01-01T00:00:00+00:00 12:30"
        );
    }
}
