//! One planned press.

use glam::DQuat;
use serde::{Deserialize, Serialize};

/// A straight press: approach, hold, retreat.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PressPlan {
    /// Unique in its protocol: `<part>-<indenter>#<number>`; without the part's name if it has
    /// none.
    pub name: String,
    /// Name of the indenter in the sensor description.
    pub indenter: String,
    /// x of the indenter's origin in the gel's frame, mm.
    pub x_mm: f64,
    /// y of the indenter's origin in the gel's frame, mm.
    pub y_mm: f64,
    /// Tilt and yaw of the indenter.
    pub rotation: DQuat,
    /// Height above the first touch at which the press starts and ends, mm.
    pub clearance_mm: f64,
    /// Depth below the first touch, mm.
    pub depth_mm: f64,
    /// Speed of approach and retreat, mm/s.
    pub speed_mm_per_s: f64,
    /// Time at full depth, s.
    pub hold_s: f64,
}

impl PressPlan {
    /// Time, s, and depth below the first touch, mm (negative above), at a frame rate, from the
    /// start to the end of the press.
    #[must_use]
    pub fn trajectory(&self, rate_hz: f64) -> Vec<(f64, f64)> {
        let travel_s = (self.clearance_mm + self.depth_mm) / self.speed_mm_per_s;
        let duration_s = 2.0 * travel_s + self.hold_s;
        let n_frames = (duration_s * rate_hz).ceil() as usize + 1;
        (0..n_frames)
            .map(|frame| {
                let time_s = frame as f64 / rate_hz;
                let moving_s = if time_s <= travel_s {
                    time_s
                } else {
                    (duration_s - time_s).min(travel_s)
                };
                (
                    time_s,
                    (moving_s * self.speed_mm_per_s - self.clearance_mm).max(-self.clearance_mm),
                )
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_press_goes_down_holds_and_comes_back() {
        let plan = PressPlan {
            name: "ball#0".into(),
            indenter: "ball".into(),
            x_mm: 0.0,
            y_mm: 0.0,
            rotation: DQuat::IDENTITY,
            clearance_mm: 0.5,
            depth_mm: 1.5,
            speed_mm_per_s: 2.0,
            hold_s: 0.5,
        };
        let trajectory = plan.trajectory(50.0);
        assert_eq!(trajectory.first(), Some(&(0.0, -0.5)));
        let deepest = trajectory
            .iter()
            .filter(|(_, depth)| (*depth - 1.5).abs() < 1e-9)
            .count();
        assert_eq!(deepest, 26, "half a second at 50 Hz, both ends counted");
        assert!((trajectory.last().unwrap().1 + 0.5).abs() < 1e-9);
        assert!(
            trajectory
                .windows(2)
                .all(|pair| (pair[1].1 - pair[0].1).abs() < 0.04 + 1e-9)
        );
    }
}
