//! A checksum that finds damage anywhere in a Parquet file, without making it less of a Parquet file.
//!
//! A Parquet file is `PAR1 | pages | footer | footer length | PAR1`. Readers find the footer from the end and the pages through
//! the footer, so that bytes between pages and footer are never looked at: there stand a mark and the SHA-256 of all the
//! other bytes. Files of other programs have no seal and are read without it.

use std::io::{self, Write};

use sha2::{Digest, Sha256};

const MAGIC: &[u8] = b"PAR1";
const MARK: &[u8] = b"twintac1";
const SEAL_BYTES: usize = MARK.len() + 32;

/// Passes a Parquet file on as it is written, and puts the seal before its footer.
#[derive(Debug)]
pub(super) struct Sealing<W> {
    inner: W,
    digest: Sha256,
    /// What is held back from [`Self::hold`] on.
    end: Option<Vec<u8>>,
}

impl<W: Write> Sealing<W> {
    pub(super) fn new(inner: W) -> Self {
        Self {
            inner,
            digest: Sha256::new(),
            end: None,
        }
    }

    /// What is written from now on is the file's end: all pages are written.
    pub(super) fn hold(&mut self) {
        self.end = Some(Vec::new());
    }

    /// Puts the seal into the end, and passes both on.
    pub(super) fn finish(mut self) -> io::Result<W> {
        let end = self.end.unwrap_or_default();
        let footer = footer_start(&end).map_err(io::Error::other)?;
        let (indices, footer) = end.split_at(footer);
        let digest = self.digest.chain_update(&end).finalize();
        for bytes in [indices, MARK, &digest, footer] {
            self.inner.write_all(bytes)?;
        }
        Ok(self.inner)
    }
}

impl<W: Write> Write for Sealing<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if let Some(end) = &mut self.end {
            end.extend_from_slice(bytes);
            return Ok(bytes.len());
        }
        let n_written = self.inner.write(bytes)?;
        self.digest.update(&bytes[..n_written]);
        Ok(n_written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.inner.flush()
    }
}

/// Checks that this is a whole Parquet file and, if it has a seal, that no byte of it has changed.
pub(super) fn verify(file: &[u8]) -> Result<(), String> {
    if !file.starts_with(MAGIC) {
        return Err("it does not start as a Parquet file".to_owned());
    }
    let footer = footer_start(file)?;
    if footer < MAGIC.len() {
        return Err("its footer is longer than the file".to_owned());
    }
    let Some((before, sealed)) = footer
        .checked_sub(SEAL_BYTES)
        .map(|start| (&file[..start], &file[start..footer]))
    else {
        return Ok(());
    };
    match sealed.strip_prefix(MARK) {
        Some(expected) if expected != digest(before, &file[footer..]) => {
            Err("its checksum does not match: it was damaged after it was written".to_owned())
        }
        _ => Ok(()),
    }
}

fn digest(before: &[u8], after: &[u8]) -> [u8; 32] {
    Sha256::new()
        .chain_update(before)
        .chain_update(after)
        .finalize()
        .into()
}

/// Where the footer starts in the end of a whole Parquet file.
fn footer_start(end: &[u8]) -> Result<usize, String> {
    let Some((rest, tail)) = end
        .split_last_chunk::<8>()
        .filter(|(_, tail)| tail.ends_with(MAGIC))
    else {
        return Err("it does not end as a Parquet file: it is truncated".to_owned());
    };
    let length = u32::from_le_bytes([tail[0], tail[1], tail[2], tail[3]]);
    usize::try_from(length)
        .ok()
        .and_then(|length| rest.len().checked_sub(length))
        .ok_or_else(|| format!("its footer of {length} bytes is longer than the file"))
}
