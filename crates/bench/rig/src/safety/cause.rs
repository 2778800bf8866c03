//! Causes for which the supervisor stops.

/// Why the supervisor stopped a press. The first cause stays. Later ones do not replace it.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Cause {
    /// A requested or measured value is beyond a limit, or is NaN.
    #[error("{limit} is {found} {unit}, the limit is {allowed} {unit}")]
    LimitExceeded {
        /// Which limit, such as `force` or `goal's depth`.
        limit: &'static str,
        /// The requested or measured value.
        found: f64,
        /// The limit.
        allowed: f64,
        /// Unit of both.
        unit: &'static str,
    },
    /// A requested or measured position is outside the workspace, or is NaN.
    #[error("{what} ({:.2}, {:.2}, {:.2}) mm is outside the workspace", position_mm.x, position_mm.y, position_mm.z)]
    OutsideWorkspace {
        /// The name of the position, such as `goal` or `robot`.
        what: &'static str,
        /// The position, mm.
        position_mm: glam::DVec3,
    },
    /// A stream was silent for longer than allowed.
    #[error("nothing from {stream} for {silence_s:.3} s, at most {longest_silence_s:.3} s are allowed")]
    StreamSilent {
        /// Name of the stream.
        stream: String,
        /// How long it has been silent, s.
        silence_s: f64,
        /// Longest silence allowed, s.
        longest_silence_s: f64,
    },
    /// The robot reports an error.
    #[error("the robot reports an error")]
    RobotInError,
    /// A device reports an error, or cannot be reached.
    #[error("{stream}: {problem}")]
    DeviceError {
        /// Name of its stream.
        stream: String,
        /// What is wrong.
        problem: String,
    },
    /// Data of a stream are missing.
    #[error("{stream}: {records} records lost")]
    DataLost {
        /// Name of the stream.
        stream: String,
        /// How many.
        records: u64,
    },
    /// A person asked to stop.
    #[error("stopped by the operator")]
    Operator,
}
