//! Consistent overhead byte stuffing (Cheshire and Baker, 1999): zeros occur between packets only.

use crate::buffer::Buffer;

/// The largest size of a stuffed packet of `bytes` bytes, with the zero after it.
pub(crate) const fn stuffed_bytes(bytes: usize) -> usize {
    bytes + bytes / 254 + 2
}

/// Appends a stuffed packet to a buffer, with a zero after it.
pub(crate) fn stuff<const B: usize>(packet: &[u8], out: &mut Buffer<B>) {
    let mut code_at = out.len();
    let mut code: u8 = 1;
    out.push(0);
    for (index, byte) in packet.iter().enumerate() {
        if *byte != 0 {
            out.push(*byte);
            code += 1;
        }
        let is_last = index + 1 == packet.len();
        // A block of 254 bytes stands for no zero. At the end of the packet no new block has to
        // begin.
        if *byte == 0 || (code == 0xFF && !is_last) {
            out.set(code_at, code);
            code_at = out.len();
            code = 1;
            out.push(0);
        }
    }
    out.set(code_at, code);
    out.push(0);
}

#[cfg(test)]
mod tests {
    extern crate std;

    use std::vec::Vec;

    use proptest::prelude::*;

    use super::*;

    fn stuffed(packet: &[u8]) -> Vec<u8> {
        let mut out = Buffer::<2048>::new();
        stuff(packet, &mut out);
        assert!(!out.is_full());
        out.as_bytes().to_vec()
    }

    /// Examples of the paper.
    #[test]
    fn packets_are_stuffed() {
        assert_eq!(stuffed(&[]), [1, 0]);
        assert_eq!(stuffed(&[0]), [1, 1, 0]);
        assert_eq!(stuffed(&[0x11, 0x22, 0, 0x33]), [3, 0x11, 0x22, 2, 0x33, 0]);
        let long: Vec<u8> = (1..=254).collect();
        assert_eq!(stuffed(&long), [&[0xFF][..], &long, &[0]].concat());
        let longer: Vec<u8> = (1..=255).collect();
        assert_eq!(stuffed(&longer), [&[0xFF][..], &long, &[2, 255, 0]].concat());
    }

    fn unstuffed(stuffed: &[u8]) -> Vec<u8> {
        let mut packet = Vec::new();
        let mut rest = &stuffed[..stuffed.len() - 1];
        while let Some((code, after)) = rest.split_first() {
            let n = usize::from(*code) - 1;
            packet.extend(&after[..n]);
            rest = &after[n..];
            if *code != 0xFF && !rest.is_empty() {
                packet.push(0);
            }
        }
        packet
    }

    proptest! {
        #[test]
        fn packets_come_back(packet in proptest::collection::vec(prop_oneof![Just(0_u8), any::<u8>()], 0..1000)) {
            let stuffed = stuffed(&packet);
            prop_assert_eq!(stuffed.iter().position(|byte| *byte == 0), Some(stuffed.len() - 1));
            prop_assert!(stuffed.len() <= stuffed_bytes(packet.len()));
            prop_assert_eq!(unstuffed(&stuffed), packet);
        }
    }
}
