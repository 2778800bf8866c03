//! Presses as episodes of LeRobot.

use crate::Press;

/// Summary of a written data set.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct LeRobotSummary {
    /// Number of presses.
    pub episodes: usize,
    /// Number of frames of all presses.
    pub frames: usize,
    /// Number of indenters.
    pub tasks: usize,
    /// Frames per second.
    pub fps: u64,
    /// The rate that frames were resampled from, Hz. `None` if they were evenly spaced at a whole
    /// rate.
    pub resampled_from_hz: Option<f64>,
}

/// A press as an episode.
pub(super) struct Episode<'a> {
    pub(super) press: &'a Press,
    pub(super) task: usize,
    /// Index of its first frame.
    pub(super) first: usize,
    /// Index of its file of frames.
    pub(super) file: usize,
}
