//! The wire format of ROS 2 messages: CDR, little-endian, each number aligned to its own size.
//!
//! Source: Object Management Group, DDS Interoperability Wire Protocol (formal/2022-04-01), section
//! 10, with the plain encoding (`CDR_LE`) of Common Object Request Broker Architecture 3.3, part 2,
//! section 9.3.

mod decode;
mod encode;
#[cfg(test)]
mod tests;

pub(crate) use decode::Decoder;
pub(crate) use encode::Encoder;

/// Marks little-endian plain CDR without options. Alignment counts from the byte after it.
const ENCAPSULATION: [u8; 4] = [0, 1, 0, 0];
