//! States and modes of the robot.

use std::fmt;

/// The state byte of every response.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ResponseState(
    /// The bits.
    pub u8,
);

impl ResponseState {
    /// An error is not cleared.
    pub const ERROR: Self = Self(0x40);
    /// A warning is not cleared.
    pub const WARNING: Self = Self(0x20);
    /// The robot is not ready to move.
    pub const NOT_READY: Self = Self(0x10);
    /// The result is not valid.
    pub const INVALID: Self = Self(0x08);

    /// Whether any of these bits is set.
    #[must_use]
    pub fn has(self, bits: Self) -> bool {
        self.0 & bits.0 != 0
    }

    /// All bits except these.
    #[must_use]
    pub fn without(self, bits: Self) -> Self {
        Self(self.0 & !bits.0)
    }
}

impl std::ops::BitOr for ResponseState {
    type Output = Self;

    fn bitor(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
}

/// What the robot is doing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MotionState {
    /// Moving.
    Moving,
    /// Ready, at rest.
    Ready,
    /// Paused.
    Paused,
    /// Stopped: no command moves the robot until its state is set to motion again.
    Stopped,
    /// Any other state, by its code. The robot does not move.
    NotReady(u8),
}

impl MotionState {
    /// The state of a code.
    #[must_use]
    pub fn from_code(code: u8) -> Self {
        match code {
            1 => Self::Moving,
            2 => Self::Ready,
            3 => Self::Paused,
            4 => Self::Stopped,
            other => Self::NotReady(other),
        }
    }

    /// The code of the state.
    #[must_use]
    pub fn code(self) -> u8 {
        match self {
            Self::Moving => 1,
            Self::Ready => 2,
            Self::Paused => 3,
            Self::Stopped => 4,
            Self::NotReady(code) => code,
        }
    }
}

impl fmt::Display for MotionState {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Moving => f.write_str("moving"),
            Self::Ready => f.write_str("ready"),
            Self::Paused => f.write_str("paused"),
            Self::Stopped => f.write_str("stopped"),
            Self::NotReady(code) => write!(f, "not ready ({code})"),
        }
    }
}

/// How the robot takes commands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Mode {
    /// Plans moves to positions.
    Position = 0,
    /// Follows the latest pose that was sent.
    Servo = 1,
    /// Is led by hand.
    Teach = 2,
    /// Follows joint velocities.
    JointVelocity = 4,
    /// Follows velocities of the tool.
    CartesianVelocity = 5,
    /// Replans during motion, in joint space.
    OnlineJoint = 6,
    /// Replans during motion, in Cartesian space.
    OnlineCartesian = 7,
}

impl Mode {
    /// The mode of a code, if there is one.
    #[must_use]
    pub fn from_code(code: u8) -> Option<Self> {
        Some(match code {
            0 => Self::Position,
            1 => Self::Servo,
            2 => Self::Teach,
            4 => Self::JointVelocity,
            5 => Self::CartesianVelocity,
            6 => Self::OnlineJoint,
            7 => Self::OnlineCartesian,
            _ => return None,
        })
    }
}
