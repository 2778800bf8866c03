//! Presses as LeRobot counts them.

use crate::Press;

/// What was written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
pub struct LeRobotSummary {
    /// Presses.
    pub episodes: usize,
    /// Frames of all presses.
    pub frames: usize,
    /// Indenters.
    pub tasks: usize,
}

/// A press as an episode.
pub(super) struct Episode<'a> {
    pub(super) press: &'a Press,
    pub(super) task: usize,
    /// Number of its first frame.
    pub(super) first: usize,
    /// Number of its file of frames.
    pub(super) file: usize,
}
