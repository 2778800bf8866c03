//! The streams of a log.

use serde::{Deserialize, Serialize};

/// The kind of data to which a message belongs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Stream {
    /// Tactile frames.
    Tactile,
    /// Wrench readings.
    Wrench,
    /// Robot poses.
    Pose,
    /// Events.
    Event,
}

impl Stream {
    pub(crate) const ALL: [Self; 4] = [Self::Tactile, Self::Wrench, Self::Pose, Self::Event];
}

impl std::fmt::Display for Stream {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Tactile => "tactile",
            Self::Wrench => "wrench",
            Self::Pose => "pose",
            Self::Event => "event",
        })
    }
}
