//! When the next pose of a stream may be sent, and how far it may be from the last one.
//!
//! The limits are those of the manufacturer for the servo mode: at most 250 poses a second, steps
//! of at most 10 mm, at most 1000 mm/s.

use std::time::{Duration, Instant};

use crate::TcpPose;

/// Longest step from one pose to the next, mm.
pub const LONGEST_STEP_MM: f64 = 10.0;
pub(super) const PERIOD: Duration = Duration::from_millis(4);
const FASTEST_MM_PER_S: f64 = 1000.0;

/// State of a stream of poses.
#[derive(Clone, Copy, Debug)]
pub(super) struct PoseStream {
    pub(super) last: TcpPose,
    pub(super) sent: Instant,
    /// When the next pose may be sent.
    pub(super) due: Instant,
}

impl PoseStream {
    /// A stream that begins now at a pose.
    pub(super) fn at(last: TcpPose) -> Self {
        let sent = Instant::now();
        let due = sent + PERIOD;
        Self { last, sent, due }
    }
}

/// Longest step after the time `elapsed`, mm. The speed limit counts over at least one period.
pub(super) fn longest_step_mm(elapsed: Duration) -> f64 {
    LONGEST_STEP_MM.min(FASTEST_MM_PER_S * elapsed.max(PERIOD).as_secs_f64())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_limited_by_speed_and_then_by_length() {
        assert!((longest_step_mm(Duration::from_millis(2)) - 4.0).abs() < 1e-9);
        assert!((longest_step_mm(Duration::from_millis(6)) - 6.0).abs() < 1e-9);
        assert_eq!(longest_step_mm(Duration::from_secs(1)), 10.0);
    }
}
