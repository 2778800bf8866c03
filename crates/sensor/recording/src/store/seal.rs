//! A checksum that detects damage anywhere in a Parquet file. The file remains a valid Parquet
//! file.
//!
//! A Parquet file is `PAR1 | pages | footer | footer length | PAR1`. Readers find the footer from
//! the end and the pages through the footer, so bytes between pages and footer are never read.
//! There the seal is placed: a mark and the SHA-256 of all other bytes. Files of other programs
//! have no seal and are read without this check.

use std::io::{self, Write};

use sha2::{Digest, Sha256};

const MAGIC: &[u8] = b"PAR1";
const MARK: &[u8] = b"twintac1";
const SEAL_BYTES: usize = MARK.len() + 32;

/// Passes a Parquet file on while it is written, and inserts the seal before its footer.
#[derive(Debug)]
pub(super) struct Sealing<W> {
    inner: W,
    digest: Sha256,
    /// The bytes held back after [`Self::hold`].
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

    /// Marks that all pages are written: bytes from now on are the end of the file.
    pub(super) fn hold(&mut self) {
        self.end = Some(Vec::new());
    }

    /// Inserts the seal into the end, and writes both.
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

/// Checks that this is a complete Parquet file and, if it has a seal, that no byte has changed.
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

/// Where the footer begins in the end of a complete Parquet file.
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
