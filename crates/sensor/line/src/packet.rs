//! Numbers from packets.

use crate::description::{Binary, ByteOrder, Description};
use crate::heard::Passed;
use crate::row::Row;

/// Length of a packet's fields and its checksum, bytes.
pub(crate) fn len(description: &Description) -> usize {
    let fields = description.fields.iter();
    let bytes = fields.map(|field| field.repeats * field.number.map_or(0, |number| number.bytes()));
    bytes.sum::<usize>() + description.binary.checksum.map_or(0, |checksum| checksum.bytes())
}

/// Reads the numbers of a packet without its framing.
pub(crate) fn read(description: &Description, packet: &[u8], row: &mut Row) -> Result<(), Passed> {
    if packet.len() != len(description) {
        return Err(Passed::Torn);
    }
    let binary = &description.binary;
    let n_checked = packet.len() - binary.checksum.map_or(0, |checksum| checksum.bytes());
    let (fields, said) = packet.split_at(n_checked);
    if let Some(checksum) = binary.checksum {
        let mut whole = [0; 4];
        ordered(binary, said, &mut whole);
        if checksum.of(fields) != u32::from_le_bytes(whole) {
            return Err(Passed::Checksum);
        }
    }
    let mut rest = fields;
    for field in &description.fields {
        let Some(number) = field.number else { continue };
        for _ in 0..field.repeats {
            let (bytes, after) = rest.split_at(number.bytes());
            rest = after;
            let mut whole = [0; 8];
            ordered(binary, bytes, &mut whole);
            let value = number.read(&whole[..bytes.len()]);
            row.push(field.meaning, Some(value).filter(|value| value.is_finite()));
        }
    }
    Ok(())
}

/// Copies bytes so that the least significant byte is first.
fn ordered(binary: &Binary, bytes: &[u8], whole: &mut [u8]) {
    let n = bytes.len();
    whole[..n].copy_from_slice(bytes);
    if binary.order == ByteOrder::Big {
        whole[..n].reverse();
    }
}

/// Removes the stuffing of a packet without its final zero. `None` if it is not a stuffed packet.
pub(crate) fn unstuffed(stuffed: &[u8]) -> Option<Vec<u8>> {
    let mut packet = Vec::with_capacity(stuffed.len());
    let mut rest = stuffed;
    while let Some((&code, after)) = rest.split_first() {
        let n = usize::from(code).checked_sub(1)?;
        let block = after.get(..n)?;
        packet.extend_from_slice(block);
        rest = &after[n..];
        if code != 0xFF && !rest.is_empty() {
            packet.push(0);
        }
    }
    Some(packet)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The examples of Cheshire and Baker, Consistent Overhead Byte Stuffing (1999).
    #[test]
    fn stuffing_is_undone() {
        assert_eq!(unstuffed(&[1, 1]), Some(vec![0]));
        assert_eq!(
            unstuffed(&[3, 0x11, 0x22, 2, 0x33]),
            Some(vec![0x11, 0x22, 0, 0x33])
        );
        let mut long = vec![0xFF];
        long.extend(1..=254);
        assert_eq!(unstuffed(&long), Some((1..=254).collect()));
        assert_eq!(unstuffed(&[5, 1, 2]), None);
        assert_eq!(unstuffed(&[]), Some(vec![]));
    }
}
