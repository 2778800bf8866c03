use proptest::prelude::*;

use super::{Decoder, Encoder};

fn encoded(put: impl FnOnce(&mut Encoder<'_>)) -> Vec<u8> {
    let mut bytes = Vec::new();
    put(&mut Encoder::new(&mut bytes));
    bytes
}

#[test]
fn golden_bytes() {
    // A `std_msgs/Header` with the stamp 1 s 2 ns and the frame `ab`, then a double, as at the
    // start of a WrenchStamped.
    let bytes = encoded(|e| {
        e.i32(1);
        e.u32(2);
        e.string("ab");
        e.f64(1.0);
    });
    let golden = [
        &[0, 1, 0, 0][..],
        &[1, 0, 0, 0],
        &[2, 0, 0, 0],
        &[3, 0, 0, 0, b'a', b'b', 0],
        &[0], // padding to a multiple of eight after the encapsulation
        &[0, 0, 0, 0, 0, 0, 0xF0, 0x3F],
    ];
    assert_eq!(bytes, golden.concat());
}

#[test]
fn every_number_is_aligned_to_its_size_counted_from_behind_the_encapsulation() {
    let bytes = encoded(|e| {
        e.u8(7);
        e.u64(8);
        e.u8(9);
        e.u32(10);
        e.u8(11);
        e.i64(-1);
    });
    assert_eq!(bytes.len(), 4 + 40);
    let places: Vec<(usize, u8)> = (4..)
        .zip(bytes[4..].iter().copied())
        .map(|(at, byte)| (at - 4, byte))
        .filter(|(_, byte)| *byte != 0)
        .collect();
    let ones = (32..40).map(|at| (at, 0xFF));
    let expected: Vec<(usize, u8)> = [(0, 7), (8, 8), (16, 9), (20, 10), (24, 11)]
        .into_iter()
        .chain(ones)
        .collect();
    assert_eq!(places, expected);
}

#[test]
fn an_empty_sequence_has_no_padding_and_an_empty_string_its_zero() {
    let empty = encoded(|e| {
        e.sequence(std::iter::empty(), Encoder::u64);
        e.u32(5);
    });
    assert_eq!(empty, [0, 1, 0, 0, 0, 0, 0, 0, 5, 0, 0, 0]);
    let full = encoded(|e| e.sequence([1_u64].into_iter(), Encoder::u64));
    assert_eq!(full, [0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0]);
    assert_eq!(encoded(|e| e.string("")), [0, 1, 0, 0, 1, 0, 0, 0, 0]);
}

#[test]
fn alignment_does_not_depend_on_where_the_message_stands() {
    let mut bytes = vec![1, 2, 3];
    let mut e = Encoder::new(&mut bytes);
    e.u8(1);
    e.f64(2.0);
    assert_eq!(
        bytes[3..],
        encoded(|e| {
            e.u8(1);
            e.f64(2.0);
        })
    );
}

#[test]
fn a_sequence_that_claims_too_much_is_none() {
    let bytes = [0, 1, 0, 0, 0xFF, 0xFF, 0xFF, 0xFF, 1, 2, 3];
    assert_eq!(Decoder::new(&bytes).unwrap().sequence(Decoder::u8), None);
    assert_eq!(Decoder::new(&bytes).unwrap().string(), None);
    assert!(Decoder::new(&[0, 0, 0, 0]).is_none(), "big-endian");
}

proptest! {
    #[test]
    fn what_was_put_is_taken(
        small in any::<u8>(), whole in any::<i32>(), large in any::<u64>(), real in -1e300..1e300_f64, text in "\\PC*",
        numbers in prop::collection::vec(any::<i64>(), 0..5),
    ) {
        let bytes = encoded(|e| {
            e.u8(small);
            e.i32(whole);
            e.string(&text);
            e.u64(large);
            e.sequence(numbers.iter().copied(), Encoder::i64);
            e.f64(real);
        });
        let mut d = Decoder::new(&bytes).unwrap();
        prop_assert_eq!(d.u8(), Some(small));
        prop_assert_eq!(d.i32(), Some(whole));
        prop_assert_eq!(d.string(), Some(text.as_str()));
        prop_assert_eq!(d.u64(), Some(large));
        prop_assert_eq!(d.sequence(Decoder::i64), Some(numbers));
        prop_assert_eq!(d.f64(), Some(real));
        prop_assert_eq!(d.u8(), None);
    }
}
