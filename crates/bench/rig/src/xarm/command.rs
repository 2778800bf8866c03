//! Commands and their payloads.

use super::bytes::{f32s, pose, pose_f32s, put_f32s};
use super::{Mode, ResponseState};
use crate::{Device, RigError, TcpPose};

/// A command to the robot.
#[derive(Clone, Debug, PartialEq)]
pub enum Command {
    /// Ask for the version of the firmware.
    GetVersion,
    /// Switch motors on or off.
    MotionEnable {
        /// Which joint, counted from 1. [`Command::ALL_AXES`] for all.
        axis: u8,
        /// On or off.
        on: bool,
    },
    /// Change the state.
    SetState(SetState),
    /// Ask for the state.
    GetState,
    /// Ask for the number of commands that wait.
    GetCommandCount,
    /// Ask for the codes of error and warning.
    GetErrors,
    /// Clear the error.
    CleanError,
    /// Clear the warning.
    CleanWarning,
    /// Change the mode.
    SetMode {
        /// The mode.
        mode: Mode,
        /// How collisions are detected in this mode. Firmware before 1.10 does not know this byte.
        detection: Option<u8>,
    },
    /// Move along a line.
    MoveLine {
        /// Where to, and how.
        to: MoveTo,
        /// Duration, s. 0: use the speed.
        time_s: f64,
    },
    /// Be at a pose now, in servo mode.
    ServoCartesian {
        /// The pose. The robot ignores its speed and acceleration.
        to: MoveTo,
        /// Whether the pose is given in the tool's frame and not in the base frame.
        in_tool_frame: bool,
    },
    /// Ask for the pose of the tool.
    GetPose,
    /// Ask for the angles of the joints.
    GetJoints,
    /// Any other command.
    Other {
        /// The function code.
        function: u8,
        /// The bytes after the function code.
        payload: Vec<u8>,
    },
}

/// Target and motion of a move.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MoveTo {
    /// The pose.
    pub pose: TcpPose,
    /// Speed, mm/s.
    pub speed_mm_per_s: f64,
    /// Acceleration, mm/s².
    pub acceleration_mm_per_s2: f64,
}

/// States that can be set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum SetState {
    /// Accept commands that move the robot.
    Motion = 0,
    /// Pause.
    Pause = 3,
    /// Stop at once.
    Stop = 4,
    /// Slow down, then stop.
    DecelerationStop = 6,
}

impl SetState {
    const ALL: [Self; 4] = [Self::Motion, Self::Pause, Self::Stop, Self::DecelerationStop];
}

impl MoveTo {
    /// Nine numbers. Moves and servo commands use the last one differently.
    fn encode(&self, last: f64) -> Vec<u8> {
        let mut payload = vec![0; 4 * 9];
        put_f32s(&mut payload, 0, &pose_f32s(&self.pose));
        let rest = [self.speed_mm_per_s, self.acceleration_mm_per_s2, last];
        put_f32s(&mut payload, 24, &rest.map(|number| number as f32));
        payload
    }

    fn decode(payload: &[u8]) -> Option<(Self, f64)> {
        let [speed, acceleration, last] = f32s(payload, 24)?.map(f64::from);
        let to = Self {
            pose: pose(f32s(payload, 0)?),
            speed_mm_per_s: speed,
            acceleration_mm_per_s2: acceleration,
        };
        Some((to, last))
    }
}

impl Command {
    /// All joints of [`Command::MotionEnable`].
    pub const ALL_AXES: u8 = 8;

    /// Its function code.
    #[must_use]
    pub fn function(&self) -> u8 {
        match self {
            Self::GetVersion => 1,
            Self::MotionEnable { .. } => 11,
            Self::SetState(_) => 12,
            Self::GetState => 13,
            Self::GetCommandCount => 14,
            Self::GetErrors => 15,
            Self::CleanError => 16,
            Self::CleanWarning => 17,
            Self::SetMode { .. } => 19,
            Self::MoveLine { .. } => 21,
            Self::ServoCartesian { .. } => 30,
            Self::GetPose => 41,
            Self::GetJoints => 42,
            Self::Other { function, .. } => *function,
        }
    }

    /// Its name in messages for people.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::GetVersion => "get version",
            Self::MotionEnable { .. } => "enable motion",
            Self::SetState(_) => "set state",
            Self::GetState => "get state",
            Self::GetCommandCount => "get command count",
            Self::GetErrors => "get errors",
            Self::CleanError => "clean error",
            Self::CleanWarning => "clean warning",
            Self::SetMode { .. } => "set mode",
            Self::MoveLine { .. } => "move",
            Self::ServoCartesian { .. } => "servo",
            Self::GetPose => "get pose",
            Self::GetJoints => "get joints",
            Self::Other { .. } => "other command",
        }
    }

    /// The bytes after the function code.
    #[must_use]
    pub fn payload(&self) -> Vec<u8> {
        match self {
            Self::MotionEnable { axis, on } => vec![*axis, u8::from(*on)],
            Self::SetState(state) => vec![*state as u8],
            Self::SetMode { mode, detection } => std::iter::once(*mode as u8).chain(*detection).collect(),
            Self::MoveLine { to, time_s } => to.encode(*time_s),
            Self::ServoCartesian { to, in_tool_frame } => to.encode(f64::from(u8::from(*in_tool_frame))),
            Self::Other { payload, .. } => payload.clone(),
            Self::GetVersion
            | Self::GetState
            | Self::GetCommandCount
            | Self::GetErrors
            | Self::CleanError
            | Self::CleanWarning
            | Self::GetPose
            | Self::GetJoints => Vec::new(),
        }
    }

    /// Decodes a command from a function code and a payload. An unknown code gives
    /// [`Command::Other`]. Bytes after the payload are ignored.
    ///
    /// # Errors
    /// A known command whose payload is too short or names an unknown state or mode.
    pub fn decode(function: u8, payload: &[u8]) -> Result<Self, RigError> {
        let known = match (function, payload) {
            (1, _) => Some(Self::GetVersion),
            (11, [axis, on, ..]) => Some(Self::MotionEnable {
                axis: *axis,
                on: *on != 0,
            }),
            (12, [code, ..]) => SetState::ALL
                .into_iter()
                .find(|state| *state as u8 == *code)
                .map(Self::SetState),
            (13, _) => Some(Self::GetState),
            (14, _) => Some(Self::GetCommandCount),
            (15, _) => Some(Self::GetErrors),
            (16, _) => Some(Self::CleanError),
            (17, _) => Some(Self::CleanWarning),
            (19, [code, rest @ ..]) => Mode::from_code(*code).map(|mode| Self::SetMode {
                mode,
                detection: rest.first().copied(),
            }),
            (21, _) => MoveTo::decode(payload).map(|(to, time_s)| Self::MoveLine { to, time_s }),
            (30, _) => MoveTo::decode(payload).map(|(to, last)| Self::ServoCartesian {
                to,
                in_tool_frame: last != 0.0,
            }),
            (41, _) => Some(Self::GetPose),
            (42, _) => Some(Self::GetJoints),
            (11 | 12 | 19, []) | (11, [_]) => None,
            _ => Some(Self::Other {
                function,
                payload: payload.to_vec(),
            }),
        };
        known.ok_or_else(|| {
            let expected = format!("the payload of function {function}");
            let found = format!(
                "{} bytes: {:02x?}",
                payload.len(),
                &payload[..payload.len().min(8)]
            );
            RigError::malformed(Device::Robot, "command", expected, found)
        })
    }

    /// State bits that the response to this command may have. Queries and commands that clear
    /// errors work in any state. Commands that prepare motion tolerate a robot that is not ready.
    /// Commands that move the robot tolerate none.
    pub(super) fn tolerates(&self) -> ResponseState {
        let not_ready = ResponseState::NOT_READY | ResponseState::WARNING;
        match self {
            Self::MoveLine { .. } | Self::ServoCartesian { .. } => ResponseState::default(),
            Self::MotionEnable { .. } | Self::SetMode { .. } | Self::SetState(SetState::Motion) => not_ready,
            _ => not_ready | ResponseState::ERROR,
        }
    }
}
