//! `std_msgs/Header`.

use crate::cdr::{Decoder, Encoder};

pub(super) const NS_PER_S: u64 = 1_000_000_000;

/// `unix_ns` is on the wall clock. ROS has 31 bits for seconds: later stamps are clamped to the
/// last one.
pub(super) fn put_header(e: &mut Encoder<'_>, unix_ns: u64, frame: &str) {
    e.i32(i32::try_from(unix_ns / NS_PER_S).unwrap_or(i32::MAX));
    e.u32((unix_ns % NS_PER_S) as u32); // less than 2^30
    e.string(frame);
}

pub(super) fn take_header(d: &mut Decoder<'_>) -> Option<()> {
    d.i32()?;
    d.u32()?;
    d.string().map(|_| ())
}
