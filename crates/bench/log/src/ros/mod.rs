//! The ROS 2 messages of a file.
//!
//! Each reading is written twice: completely, in messages of this project (`sample`), in its units,
//! which is what is read back; and in the standard messages (`standard`), which every viewer shows,
//! in their units.

mod definition;
mod header;
mod names;
mod sample;
mod standard;
#[cfg(test)]
mod tests;
mod topics;

#[cfg(test)]
pub(crate) use definition::DEFINITIONS;
pub(crate) use definition::SCHEMA_ENCODING;
pub use names::TopicNames;
pub(crate) use topics::{MESSAGE_ENCODING, Topics, stream_of};

use crate::cdr::Decoder;
use crate::{Body, Event, Stream};

/// Decodes one message of a stream. `None` if its bytes are no such message.
pub(crate) fn decode(stream: Stream, bytes: &[u8]) -> Option<Body> {
    let d = &mut Decoder::new(bytes)?;
    match stream {
        Stream::Tactile => sample::take_tactile(d).map(Body::Tactile),
        Stream::Wrench => sample::take_wrench(d).map(Body::Wrench),
        Stream::Pose => sample::take_pose(d).map(Body::Pose),
        Stream::Event => serde_json::from_str::<Event>(d.string()?).ok().map(Body::Event),
    }
}
