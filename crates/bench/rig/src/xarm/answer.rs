//! The content of a response.

use super::bytes::{f32s, pose, pose_f32s, put_f32s};
use super::{Command, MotionState};
use crate::{Device, RigError, TcpPose};

/// Length of the version text, bytes.
const VERSION_BYTES: usize = 40;

/// The answer to a command.
#[derive(Clone, Debug, PartialEq)]
pub enum Answer {
    /// The command was carried out. There is no data.
    Done,
    /// The firmware's version, as text.
    Version(String),
    /// What the robot is doing.
    State(MotionState),
    /// Number of commands that wait.
    CommandCount(u16),
    /// Codes of the error and of the warning. 0 for none.
    Errors {
        /// The error.
        error: u8,
        /// The warning.
        warning: u8,
    },
    /// Pose of the tool.
    Pose(TcpPose),
    /// Angles of the joints, radians. Joints that the arm lacks are 0.
    Joints([f32; 7]),
}

impl Answer {
    /// Decodes the answer to a command from the payload of a response. Further bytes are ignored,
    /// because newer firmware may add fields.
    ///
    /// # Errors
    /// A payload that is too short.
    pub fn decode(command: &Command, payload: &[u8]) -> Result<Self, RigError> {
        let known = match (command, payload) {
            (Command::GetVersion, _) => Some(Self::Version(text(payload))),
            (Command::GetState, [code, ..]) => Some(Self::State(MotionState::from_code(*code))),
            (Command::GetCommandCount, [high, low, ..]) => {
                Some(Self::CommandCount(u16::from_be_bytes([*high, *low])))
            }
            (Command::GetErrors, [error, warning, ..]) => Some(Self::Errors {
                error: *error,
                warning: *warning,
            }),
            (Command::GetPose, _) => f32s(payload, 0).map(|numbers| Self::Pose(pose(numbers))),
            (Command::GetJoints, _) => f32s(payload, 0).map(Self::Joints),
            (Command::GetState | Command::GetCommandCount | Command::GetErrors, _) => None,
            _ => Some(Self::Done),
        };
        known.ok_or_else(|| {
            let expected = format!("the answer to {}", command.name());
            RigError::malformed(
                Device::Robot,
                "payload",
                expected,
                format!("{} bytes", payload.len()),
            )
        })
    }

    /// The response's payload.
    #[must_use]
    pub fn encode(&self) -> Vec<u8> {
        match self {
            Self::Done => Vec::new(),
            Self::Version(version) => {
                let whole_characters = version.floor_char_boundary(VERSION_BYTES - 1);
                let mut payload = version.as_bytes()[..whole_characters].to_vec();
                payload.resize(VERSION_BYTES, 0);
                payload
            }
            Self::State(state) => vec![state.code()],
            Self::CommandCount(count) => count.to_be_bytes().to_vec(),
            Self::Errors { error, warning } => vec![*error, *warning],
            Self::Pose(pose) => floats(&pose_f32s(pose)),
            Self::Joints(joints) => floats(joints),
        }
    }
}

fn floats(numbers: &[f32]) -> Vec<u8> {
    let mut payload = vec![0; 4 * numbers.len()];
    put_f32s(&mut payload, 0, numbers);
    payload
}

/// Text up to the first NUL, at most as long as a version text.
pub(super) fn text(bytes: &[u8]) -> String {
    let bytes = &bytes[..bytes.len().min(VERSION_BYTES)];
    let text = bytes.split(|byte| *byte == 0).next().unwrap_or_default();
    String::from_utf8_lossy(text).into_owned()
}
