//! The result of a press along a trajectory in time.

use twintac_depth_table::{PressFrame, SolveQuality};
use twintac_shape::Pose;
use twintac_softbody::Frame;

/// A table ends before its force falls below this fraction of the largest force so far.
pub const FORCE_MAY_FALL_TO: f64 = 0.9;

/// Forces below this one are ignored in that check, N.
const LEAST_N: f64 = 0.02;

/// A press along a trajectory in time.
#[derive(Clone, Debug, PartialEq)]
pub struct PressHistory {
    /// The indenter at first touch.
    pub gel_from_indenter_at_touch: Pose,
    /// A frame for each keyframe, up to the last one that was reached.
    pub frames: Vec<PressFrame>,
    /// Why the frames end before the keyframes do; `None` if they reach the last keyframe.
    pub failure: Option<String>,
}

impl PressHistory {
    /// Ends a press of increasing depth before its force falls: there the gel slides off the
    /// indenter, or past it.
    pub(crate) fn end_where_force_falls(&mut self) {
        let mut most_n = 0.0;
        let falls = |frame: &PressFrame| {
            most_n = f64::max(most_n, frame.force_n);
            most_n > LEAST_N && frame.force_n < FORCE_MAY_FALL_TO * most_n
        };
        if let Some(first) = self.frames.iter().position(falls) {
            let PressFrame {
                depth_mm, force_n, ..
            } = self.frames[first];
            self.failure = Some(format!(
                "at {depth_mm:.3} mm: the force falls to {force_n:.3} N, from {:.3} N at {:.3} mm: the gel slides off the indenter, or past it",
                self.frames[first - 1].force_n,
                self.frames[first - 1].depth_mm
            ));
            self.frames.truncate(first);
        }
    }
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
