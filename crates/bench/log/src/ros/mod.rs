//! What stands in the file for ROS 2 and its friends.
//!
//! Each reading is there twice: whole, in messages of our own (`sample`), in the units of this project, which is what is read back; and in
//! the standard messages (`standard`), which every viewer knows, in theirs.

mod definition;
mod sample;
mod standard;
#[cfg(test)]
mod tests;
mod topics;

pub(crate) use definition::{DEFINITIONS, SCHEMA_ENCODING};
pub(crate) use topics::{MESSAGE_ENCODING, Topics, stream_of};

use crate::cdr::{Decoder, Encoder};
use crate::{Body, Event, Stream};

pub(crate) const NS_PER_S: u64 = 1_000_000_000;

/// Takes one message of a stream apart; `None` if its bytes are not such a message.
pub(crate) fn decode(stream: Stream, bytes: &[u8]) -> Option<Body> {
    let d = &mut Decoder::new(bytes)?;
    match stream {
        Stream::Tactile => sample::take_tactile(d).map(Body::Tactile),
        Stream::Wrench => sample::take_wrench(d).map(Body::Wrench),
        Stream::Pose => sample::take_pose(d).map(Body::Pose),
        Stream::Event => serde_json::from_str::<Event>(d.string()?).ok().map(Body::Event),
    }
}

/// `std_msgs/Header`; `unix_ns` is on the wall clock. ROS has 31 bits for seconds: later stamps stay at the last one.
fn put_header(e: &mut Encoder<'_>, unix_ns: u64, frame: &str) {
    e.i32(i32::try_from(unix_ns / NS_PER_S).unwrap_or(i32::MAX));
    e.u32((unix_ns % NS_PER_S) as u32); // less than 2^30
    e.string(frame);
}

fn take_header(d: &mut Decoder<'_>) -> Option<()> {
    d.i32()?;
    d.u32()?;
    d.string().map(|_| ())
}
