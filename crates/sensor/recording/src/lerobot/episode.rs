//! Presses as LeRobot counts them.

use crate::Press;

/// What was written.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct LeRobotSummary {
    /// Presses.
    pub episodes: usize,
    /// Frames of all presses.
    pub frames: usize,
    /// Indenters.
    pub tasks: usize,
    /// Frames a second.
    pub fps: u64,
    /// The rate that frames were resampled from, Hz; `None` if they came evenly at a whole rate.
    pub resampled_from_hz: Option<f64>,
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
