//! A checksum that finds damage anywhere in a Parquet file, without making it less of a Parquet file.
//!
//! A Parquet file is `PAR1 | pages | footer | footer length | PAR1`. Readers find the footer from the end and the pages through
//! the footer, so that bytes between pages and footer are never looked at: there stand a mark and the SHA-256 of all the
//! other bytes. Files of other programs have no seal and are read without it.

use sha2::{Digest, Sha256};

const MAGIC: &[u8] = b"PAR1";
const MARK: &[u8] = b"twintac1";
const SEAL_BYTES: usize = MARK.len() + 32;

/// Puts the seal into a whole Parquet file.
pub(super) fn seal(mut file: Vec<u8>) -> Result<Vec<u8>, String> {
    let footer = footer_start(&file)?;
    let seal = [MARK, &digest(&file, &[])].concat();
    file.splice(footer..footer, seal);
    Ok(file)
}

/// Checks that this is a whole Parquet file and, if it has a seal, that no byte of it has changed.
pub(super) fn verify(file: &[u8]) -> Result<(), String> {
    let footer = footer_start(file)?;
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

/// Where the footer of a whole Parquet file starts.
fn footer_start(file: &[u8]) -> Result<usize, String> {
    if !file.starts_with(MAGIC) {
        return Err("it does not start as a Parquet file".to_owned());
    }
    let Some((rest, tail)) = file
        .split_last_chunk::<8>()
        .filter(|(_, tail)| tail.ends_with(MAGIC))
    else {
        return Err("it does not end as a Parquet file: it is truncated".to_owned());
    };
    let length = u32::from_le_bytes([tail[0], tail[1], tail[2], tail[3]]);
    let start = usize::try_from(length)
        .ok()
        .and_then(|length| rest.len().checked_sub(length));
    start
        .filter(|&start| start >= MAGIC.len())
        .ok_or_else(|| format!("its footer of {length} bytes is longer than the file"))
}
