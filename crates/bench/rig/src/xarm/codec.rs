//! Frames of the command socket: a big-endian header, then a function code and its payload.
//!
//! | offset | request | response |
//! |---|---|---|
//! | 0 | transaction, u16 from 1 | the same |
//! | 2 | protocol, u16 | the same |
//! | 4 | bytes that follow, u16 | the same |
//! | 6 | function code | the same; 0xFF where the robot speaks unasked |
//! | 7 | payload | state bits |
//! | 8 | | payload |

use super::{Answer, Command, ResponseState};
use crate::{Device, RigError, Splitter};

/// TCP port for commands.
pub const PORT: u16 = 502;
/// Protocol number of these frames. 0 is Modbus, 3 is the same with a heartbeat.
pub const PROTOCOL: u16 = 2;
/// Function code of unsolicited messages of the robot.
pub const FEEDBACK: u8 = 0xff;
/// Largest frame that is accepted. The longest known frame has 48 bytes.
pub const LARGEST_FRAME_BYTES: usize = 1024;
const HEADER_BYTES: usize = 6;

/// A command on its way to the robot.
#[derive(Clone, Debug, PartialEq)]
pub struct Request {
    /// Number of the request, from 1. The response has the same number.
    pub transaction: u16,
    /// The protocol's number, [`PROTOCOL`].
    pub protocol: u16,
    /// The command.
    pub command: Command,
}

/// What the robot answers.
#[derive(Clone, Debug, PartialEq)]
pub struct Response {
    /// The request's number.
    pub transaction: u16,
    /// The request's protocol.
    pub protocol: u16,
    /// The request's function code.
    pub function: u8,
    /// State of the robot.
    pub state: ResponseState,
    /// The answer's bytes.
    pub payload: Vec<u8>,
}

/// A message from the robot.
#[derive(Clone, Debug, PartialEq)]
pub enum Incoming {
    /// The answer to a request.
    Response(Response),
    /// An unsolicited message: the bytes after its function code.
    Feedback(Vec<u8>),
}

/// Splits the command socket's stream, in either direction, into frames.
#[must_use]
pub fn splitter() -> Splitter {
    let size = |header: &[u8]| HEADER_BYTES + usize::from(u16_at(header, 4));
    Splitter::new(
        Device::Robot,
        HEADER_BYTES,
        size,
        HEADER_BYTES + 1,
        LARGEST_FRAME_BYTES,
    )
}

impl Request {
    /// The request's frame.
    #[must_use]
    pub fn encode(&self) -> Vec<u8> {
        let mut rest = vec![self.command.function()];
        rest.extend(self.command.payload());
        frame(self.transaction, self.protocol, &rest)
    }

    /// The request that a frame holds.
    ///
    /// # Errors
    /// A frame that is not whole, a command with an unusable payload.
    pub fn decode(frame: &[u8]) -> Result<Self, RigError> {
        let (transaction, protocol, function, payload) = parts(frame)?;
        Ok(Self {
            transaction,
            protocol,
            command: Command::decode(function, payload)?,
        })
    }
}

impl Response {
    /// The response to a request.
    #[must_use]
    pub fn to(request: &Request, state: ResponseState, answer: &Answer) -> Self {
        Self {
            transaction: request.transaction,
            protocol: request.protocol,
            function: request.command.function(),
            state,
            payload: answer.encode(),
        }
    }

    /// The answer, if this is the response to `request`.
    ///
    /// # Errors
    /// Another transaction, protocol or function than that of the request, or a payload that is too
    /// short.
    pub fn answer(&self, request: &Request) -> Result<Answer, RigError> {
        for (field, expected, found) in [
            ("transaction", request.transaction, self.transaction),
            ("protocol", request.protocol, self.protocol),
            (
                "function",
                request.command.function().into(),
                self.function.into(),
            ),
        ] {
            if expected != found {
                return Err(RigError::malformed(Device::Robot, field, expected, found));
            }
        }
        Answer::decode(&request.command, &self.payload)
    }

    /// The response's frame.
    #[must_use]
    pub fn encode(&self) -> Vec<u8> {
        let mut rest = vec![self.function, self.state.0];
        rest.extend(&self.payload);
        frame(self.transaction, self.protocol, &rest)
    }
}

impl Incoming {
    /// The message in a frame from the robot.
    ///
    /// # Errors
    /// A frame that is not complete, or has no state.
    pub fn decode(frame: &[u8]) -> Result<Self, RigError> {
        let (transaction, protocol, function, rest) = parts(frame)?;
        if function == FEEDBACK {
            return Ok(Self::Feedback(rest.to_vec()));
        }
        let Some((state, payload)) = rest.split_first() else {
            return Err(RigError::malformed(
                Device::Robot,
                "response",
                "a state",
                "nothing",
            ));
        };
        Ok(Self::Response(Response {
            transaction,
            protocol,
            function,
            state: ResponseState(*state),
            payload: payload.to_vec(),
        }))
    }
}

/// Adds the header to a payload. What does not fit is cut off.
fn frame(transaction: u16, protocol: u16, rest: &[u8]) -> Vec<u8> {
    let rest = &rest[..rest.len().min(LARGEST_FRAME_BYTES - HEADER_BYTES)];
    let length = rest.len() as u16; // smaller than the largest frame
    let mut frame = Vec::with_capacity(HEADER_BYTES + rest.len());
    for number in [transaction, protocol, length] {
        frame.extend(number.to_be_bytes());
    }
    frame.extend(rest);
    frame
}

/// Transaction, protocol, function code, and what follows.
fn parts(frame: &[u8]) -> Result<(u16, u16, u8, &[u8]), RigError> {
    if frame.len() <= HEADER_BYTES || frame.len() > LARGEST_FRAME_BYTES {
        let expected = format!("{} to {LARGEST_FRAME_BYTES} bytes", HEADER_BYTES + 1);
        return Err(RigError::malformed(
            Device::Robot,
            "frame size",
            expected,
            frame.len(),
        ));
    }
    let (length, found) = (usize::from(u16_at(frame, 4)), frame.len() - HEADER_BYTES);
    if length != found {
        return Err(RigError::malformed(Device::Robot, "frame length", length, found));
    }
    Ok((u16_at(frame, 0), u16_at(frame, 2), frame[6], &frame[7..]))
}

/// The number at offset `at`. The bytes must reach that far.
fn u16_at(bytes: &[u8], at: usize) -> u16 {
    u16::from_be_bytes([bytes[at], bytes[at + 1]])
}

#[cfg(test)]
#[path = "codec_tests.rs"]
mod tests;
