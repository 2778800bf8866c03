//! The result of a press along a trajectory in time.

use twintac_depth_table::{PressFrame, SolveQuality};
use twintac_shape::Pose;
use twintac_softbody::Frame;

/// A press along a trajectory in time.
#[derive(Clone, Debug, PartialEq)]
pub struct PressHistory {
    /// The indenter at first touch.
    pub gel_from_indenter_at_touch: Pose,
    /// A frame for each keyframe, up to the last one that was reached.
    pub frames: Vec<PressFrame>,
    /// Why the frames end before the keyframes do; `None` if they do not.
    pub failure: Option<String>,
}

pub(crate) fn solve_quality(frame: &Frame) -> SolveQuality {
    SolveQuality {
        iterations: frame.iterations,
        residual: frame.residual,
        penetration_mm: frame.penetration_mm,
        smallest_volume_ratio: frame.smallest_volume_ratio,
        wall_time_s: frame.wall_time_s,
    }
}
